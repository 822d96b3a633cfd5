"""A study's table that a spreadsheet program saved again."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import OutputError, ParameterError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.carving.question import CARVE_KEYS
from skisnow.studies import Study, StudyState, read_study, read_table, run_study, study_state
from skisnow.studies.run import kept_rows
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


def test_a_table_is_read_as_it_was_computed(study: Study) -> None:
    fresh = run_study(study, workers=1)
    read = read_table(study.out, study.subject.keys, varied=study.varied)
    assert (read.rows, read.varied, read.counts()) == (fresh.rows, fresh.varied, fresh.counts())
    assert fresh.csv() == study.out.read_text(encoding="utf-8") == read.csv()
    assert [type(value) for value in read.rows[1].values()] == [type(value) for value in fresh.rows[1].values()]
    assert study_state(study) is StudyState.FINISHED
    assert run_study(study, workers=1).rows == fresh.rows
    assert [row["outcome"] == "error" for row in fresh.rows].index(True) == 2
    study.file.write_text(
        study.file.read_text(encoding="utf-8").replace("load_N = 700", "load_N = 701"), encoding="utf-8"
    )
    run_study(read_study(study.file), workers=1)
    assert study.out.with_name("table.previous.csv").is_file()


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda lines: [*lines, "junk"], coded("wrong_kind", n_cells=1)),
        (
            lambda lines: [lines[0], lines[1].replace(",700.0,", ",heavy,"), *lines[2:]],
            coded("wrong_kind", name="load_N", text="heavy"),
        ),
    ],
)
def test_damage_of_a_table(study: Study, damage: Callable[[list[str]], list[str]], told: str | Coded) -> None:
    run_study(study, workers=1)
    lines = study.out.read_text(encoding="utf-8").splitlines()
    study.out.write_bytes(("\n".join(damage(lines)) + "\n").encode("utf-8", "surrogateescape"))
    with raises(ParameterError, told):
        study_state(study)


def test_a_table_of_a_spreadsheet_program_with_its_separator(study: Study) -> None:
    study.out.write_text("sep=;\noutcome;study;load_N\n" + "carves;f;1,5\n" * 30, encoding="utf-8-sig")
    assert read_table(study.out, study.subject.keys).rows == [{"outcome": "carves", "study": "f", "load_N": 1.5}] * 30


def test_study_of_errors_alone_has_its_rows_and_no_file(study: Study) -> None:
    study.file.write_text(study.file.read_text(encoding="utf-8").replace("[0.5, 30, 95]", "[94, 95]"), encoding="utf-8")
    table = run_study(read_study(study.file), workers=1)
    assert [row["outcome"] for row in table.rows] == ["error"] * 8
    assert not study.out.exists()


def test_what_is_no_table_is_not_replaced(study: Study) -> None:
    study.out.write_bytes(b"what somebody wrote" * 100)
    with raises(ParameterError, "wrong_kind"):
        run_study(study, workers=1)
    assert study.out.read_bytes().startswith(b"what somebody wrote")


def test_a_run_that_another_overtook_computes_nothing(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another run finishes between the look at the table and the opening of the kept points."""
    opened = KeptRows.opened

    def late(*words: Any, **named: Any) -> KeptRows:
        study.out.write_text("outcome,study\ncarves,f\n", encoding="utf-8")
        return opened(*words, **named)

    monkeypatch.setattr(KeptRows, "opened", late)
    with raises(OutputError, "in_use"):
        run_study(study, workers=1)


def test_kept_rows_of_a_study_say_what_it_is(study: Study) -> None:
    kept = kept_rows(study, study.partial, study.fingerprint())
    assert json.loads(kept.about()["columns"]) == [*study.columns[:-1]]
    assert (kept.about()["points"], json.loads(kept.about()["kinds"])["load_N"]) == ("12", "number")
    kept.remove()
