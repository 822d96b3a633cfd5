"""A study's table that a spreadsheet program saved again."""

import json
import sqlite3
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import OutputError, ParameterError, SkisnowError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.carving.question import CARVE_KEYS
from skisnow.parameters import Quantity
from skisnow.studies import Study, StudyState, StudyTable, read_study, read_table, run_study, study_state
from skisnow.studies.rows import ROWS_OF_A_BLOCK, TableRows
from skisnow.studies.run import StudyRows, kept_rows
from skisnow.studies.table import write_table
from tests.coded import Coded, coded, raises

PLAIN = """\
edge_angle_deg,at_rest,outcome,radius_m,tags,study
30.5,false,carves,12.25,"[1.0, 2.5]",a
45,true,sinks,,,b
"""
EXCEL = """\
edge_angle_deg;at_rest;outcome;radius_m;tags;study
30,5;FALSCH;carves;12,25;[1.0, 2.5];a
45;WAHR;sinks;;;b
""".replace("FALSCH", "FALSE").replace("WAHR", "TRUE")


@pytest.mark.parametrize(
    "data",
    [
        EXCEL.encode("utf-8-sig"),
        EXCEL.encode("cp1252"),
        f"sep=;\n{EXCEL}".encode(),
        EXCEL.replace(";", "\t").encode("utf-16"),
    ],
)
def test_decimal_commas_are_read_as_points(tmp_path: Path, data: bytes) -> None:
    plain, saved = tmp_path / "plain.csv", tmp_path / "saved.csv"
    plain.write_text(PLAIN, encoding="utf-8")
    saved.write_bytes(data)
    ours, theirs = (read_table(path, CARVE_KEYS) for path in (saved, plain))
    assert ours.rows == theirs.rows
    first = {"edge_angle_deg": 30.5, "at_rest": False, "outcome": "carves", "radius_m": 12.25}
    assert ours.rows[0] == {**first, "tags": [1.0, 2.5], "study": "a"}


def test_a_cell_that_is_no_number_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "saved.csv"
    path.write_text(f"sep=;\n{EXCEL.replace('12,25', 'zwölf')}", encoding="utf-8")
    with raises(ParameterError, "wrong_kind", name="radius_m", text="zwölf"):
        read_table(path, CARVE_KEYS)


COLUMNS = ("ski", "load_N", "at_rest", "outcome", "warnings", "study")
KEYS = {
    "ski": Quantity("ski", "", kind="text"),
    "load_N": Quantity("load_N", ""),
    "at_rest": Quantity("at_rest", "", kind="switch"),
}
COUNT = 2 * ROWS_OF_A_BLOCK + 5


def values() -> list[list[Any]]:
    return [["slalom", 700.0 + n, n % 2 == 0, "equilibrium", "", "f"] for n in range(COUNT)]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    path = tmp_path / "table.sqlite"
    write_table(path, TableRows(COLUMNS, values()))
    return path


def change(place: Path, statement: str) -> None:
    with closing(sqlite3.connect(place, isolation_level=None)) as database:
        database.executescript(statement)


def loads(place: Path) -> list[Any]:
    return [row["load_N"] for row in read_table(place, KEYS).rows]


def test_rows_that_another_program_removed_leave_the_others(place: Path) -> None:
    """Blocks are counted by rows, not by their numbers."""
    change(place, "delete from study where rowid <= 3 or rowid = 1500")
    wanted = [row[1] for number, row in enumerate(values(), start=1) if number > 3 and number != 1500]
    assert loads(place) == wanted


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        ("update study set outcome = x'00' where rowid = 1203", ("row 1203", "outcome")),
        ("update study set load_N = 'heavy' where rowid = 1203", ("row 1203", "load_N", "heavy")),
        ("update study set at_rest = x'00' where rowid = 1203", ("row 1203", "at_rest")),
        ("update study set warnings = cast(x'ff' as text) where rowid = 1203", ()),
        ("alter table study drop column outcome", ("outcome",)),
        ("alter table study rename to other", ("study",)),
        ("alter table study rename to other; create view study as select * from other", ("study",)),
    ],
)
def test_an_invalid_table_of_a_study_names_the_place(place: Path, statement: str, named: tuple[str, ...]) -> None:
    change(place, statement)
    with pytest.raises(ParameterError) as caught:
        loads(place)
    assert all(word in str(caught.value) for word in (place.name, *named))


def test_damaged_pages_are_an_error(place: Path) -> None:
    sound = place.read_bytes()
    for begin in range(4096, len(sound), 4096):
        place.write_bytes(sound[:begin] + b"\xa5" * 64 + sound[begin + 64 :])
        with raises(ParameterError, "cannot_read"):
            loads(place)


TEXT = """
out = "table.csv"
[fixed]
published = "race-piste"
unloading_ratio = 10
elements = 40
[grid]
ski = ["slalom", "no-such\\nski"]
at_rest = [true, false]
edge_angle_deg = [0.5, 30, 95]
"""


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "study.toml"
    path.write_text(TEXT.replace("[fixed]", "[fixed]\nload_N = 700"), encoding="utf-8")
    return read_study(path)


@pytest.fixture
def large(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twelve rows are as a million."""
    monkeypatch.setattr("skisnow.studies.table.MOST_BYTES_AT_ONCE", 100)
    for module in ("rows", "table"):
        monkeypatch.setattr(f"skisnow.studies.{module}.ROWS_OF_A_BLOCK", 5)
    monkeypatch.setattr("skisnow.studies.table.ROWS_OF_A_GROUP", 7)


def small_table(study: Study) -> StudyTable:
    table = run_study(study, workers=1)
    return StudyTable(table.columns, list(table.rows), table.varied)


def test_a_million_rows_take_little_memory() -> None:
    """Rows of 40 numbers take 1.5 kB as a dict of floats, and here less than their digits in a file."""
    shares = np.random.default_rng(1).uniform(size=(20_000, 4))
    rows = TableRows([f"column {place}" for place in range(40)], ([*row, *range(36)] for row in shares.tolist()))
    assert sum(map(len, rows._blocks)) < 20_000 * 100
    assert list(rows[19_999].values()) == [*shares[-1], *range(36)]


def test_large_table_has_the_rows_of_a_small_one(study: Study, request: pytest.FixtureRequest) -> None:
    small = small_table(study)
    written = study.out.read_bytes()
    study.out.unlink()
    request.getfixturevalue("large")
    fresh = run_study(study, workers=1)
    assert study.out.read_bytes() == written
    read = read_table(study.out, study.subject.keys, varied=study.varied)
    for table in (fresh, read):
        assert table.rows == small.rows
        assert (table.rows[-1], table.rows[3:9:2]) == (small.rows[-1], small.rows[3:9:2])
        assert (table.counts(), table.answers(), table.csv()) == (small.counts(), small.answers(), written.decode())
        assert (table.varied, len(table.rows)) == (study.varied, 12)
    assert study_state(study) is StudyState.FINISHED
    assert small.tally() == fresh.tally() == read.tally()
    assert fresh.tally().first_failed == (3, small.rows[2]["reason"])


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda lines: [*lines, "junk"], coded("wrong_kind", n_cells=1)),
        (
            lambda lines: [lines[0], lines[1].replace(",700.0,", ",heavy,"), *lines[2:]],
            coded("wrong_kind", name="load_N", text="heavy"),
        ),
        (lambda lines: [*lines[:-1], lines[-1].replace("error", "\udce4")], "wrong_kind"),
    ],
)
@pytest.mark.usefixtures("large")
def test_damage_of_a_large_table(study: Study, damage: Callable[[list[str]], list[str]], told: str | Coded) -> None:
    run_study(study, workers=1)
    lines = study.out.read_text(encoding="utf-8").splitlines()
    study.out.write_bytes(("\n".join(damage(lines)) + "\n").encode("utf-8", "surrogateescape"))
    with raises(ParameterError, told):
        study_state(study)


def test_large_table_of_a_spreadsheet_program_is_rejected(study: Study, request: pytest.FixtureRequest) -> None:
    study.out.write_text("sep=;\noutcome;study;load_N\n" + "carves;f;1,5\n" * 30, encoding="utf-8-sig")
    assert read_table(study.out, study.subject.keys).rows == [{"outcome": "carves", "study": "f", "load_N": 1.5}] * 30
    request.getfixturevalue("large")
    with raises(ParameterError, "unknown_name"):
        read_table(study.out, study.subject.keys)


@pytest.mark.usefixtures("large")
def test_large_study_of_errors_alone_has_its_rows_and_no_file(study: Study) -> None:
    study.file.write_text(study.file.read_text(encoding="utf-8").replace("[0.5, 30, 95]", "[94, 95]"), encoding="utf-8")
    table = run_study(read_study(study.file), workers=1)
    assert [row["outcome"] for row in table.rows] == ["error"] * 8
    assert not study.out.exists()


@pytest.mark.parametrize("ending", [".sqlite", ".parquet"])
def test_other_forms_hold_the_same_table(ending: str, study: Study, request: pytest.FixtureRequest) -> None:
    if ending == ".parquet":
        pytest.importorskip("pyarrow", reason="tables in Parquet need the extra parquet")
    small = small_table(study)
    text = study.file.read_text(encoding="utf-8").replace("table.csv", f"table{ending}")
    study.file.write_text(text, encoding="utf-8")
    other = read_study(study.file)
    assert run_study(other, workers=1).rows == small.rows
    request.getfixturevalue("large")
    assert study_state(other) is StudyState.FINISHED
    found = run_study(other, workers=1)
    assert found.rows == small.rows
    assert found.rows[7] == small.rows[7]
    assert [type(value) for value in found.rows[1].values()] == [type(value) for value in small.rows[1].values()]
    assert found.tally() == small.tally()
    other.file.write_text(text.replace("load_N = 700", "load_N = 701"), encoding="utf-8")
    run_study(read_study(other.file), workers=1)
    assert other.out.with_name(f"table.previous{ending}").is_file()


def test_table_in_sqlite_is_asked_by_names(study: Study) -> None:
    study.file.write_text(study.file.read_text(encoding="utf-8").replace("table.csv", "table.sqlite"), encoding="utf-8")
    table = run_study(read_study(study.file), workers=1)
    database = sqlite3.connect(study.out.with_name("table.sqlite"))
    asked = "select load_N, at_rest from study where ski = 'slalom' and edge_angle_deg = 30"
    found = database.execute(asked).fetchall()
    database.close()
    assert found == [(700.0, 1), (700.0, 0)]
    assert isinstance(read_table(study.out.with_name("table.sqlite"), study.subject.keys).rows[0]["at_rest"], bool)
    assert table.counts()["error"] == 8


@pytest.mark.parametrize("ending", [".sqlite", ".parquet"])
def test_what_is_no_table_is_not_replaced(ending: str, study: Study) -> None:
    if ending == ".parquet":
        pytest.importorskip("pyarrow", reason="tables in Parquet need the extra parquet")
    text = study.file.read_text(encoding="utf-8").replace("table.csv", f"table{ending}")
    study.file.write_text(text, encoding="utf-8")
    other = read_study(study.file)
    other.out.write_bytes(b"what somebody wrote" * 100)
    with raises(ParameterError, "wrong_kind"):
        run_study(other, workers=1)
    assert other.out.read_bytes().startswith(b"what somebody wrote")


def test_parquet_without_its_library_is_reported_before_the_work(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    text = study.file.read_text(encoding="utf-8").replace("table.csv", "table.parquet")
    study.file.write_text(text, encoding="utf-8")
    with raises(ParameterError, "package_missing", module="pyarrow", extra="parquet"):
        run_study(read_study(study.file), workers=1)
    assert sorted(path.name for path in study.file.parent.iterdir()) == ["study.toml"]


def test_a_run_that_another_overtook_computes_nothing(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another run finishes between the look at the table and the opening of the kept points."""
    opened = KeptRows.opened

    def late(*words: Any, **named: Any) -> KeptRows:
        study.out.write_text("outcome,study\ncarves,f\n", encoding="utf-8")
        return opened(*words, **named)

    monkeypatch.setattr(KeptRows, "opened", late)
    with raises(OutputError, "in_use"):
        run_study(study, workers=1)


def test_rows_of_workers_need_the_files_of_the_study(study: Study, tmp_path: Path) -> None:
    own = tmp_path / "own.json"
    own.write_text("{}", encoding="utf-8")
    text = study.file.read_text(encoding="utf-8").replace('"no-such\\nski"', '"own.json"')
    study.file.write_text(text, encoding="utf-8")
    rows = StudyRows.of(read_study(study.file))
    rows.require_files()
    own.write_text("{ }", encoding="utf-8")
    with raises(SkisnowError, "different_files"):
        rows.require_files()


def test_kept_rows_of_a_study_say_what_it_is(study: Study) -> None:
    kept = kept_rows(study, study.partial, study.fingerprint())
    assert json.loads(kept.about()["columns"]) == [*study.columns[:-1]]
    assert (kept.about()["points"], json.loads(kept.about()["kinds"])["load_N"]) == ("12", "number")
    kept.remove()
