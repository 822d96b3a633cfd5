"""A study as it runs, and its shards."""

import csv
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from skisnow import carve, load_snow, read_ski
from skisnow._support.errors import OutputError, ParameterError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.carving.question import CARVE_KEYS
from skisnow.cli import main
from skisnow.studies import (
    Shard,
    StudyState,
    StudyTable,
    merge_shards,
    read_study,
    read_table,
    run_shard,
    run_study,
    study_state,
)
from tests.coded import Coded, coded, raises
from tests.key_names import GREATEST_EDGE_DEPTH

TEXT = """
out = "table.csv"
[fixed]
published = "race-piste"
unloading_ratio = 10
elements = 40
[grid]
ski = ["slalom", "no-such-ski"]
load_N = [400, 800]
edge_angle_deg = [0, 30, 95]
"""


def test_rows_are_the_equilibria_in_the_order_of_the_grid(study_file: Path) -> None:
    study = read_study(study_file)
    table = run_study(study, workers=1)
    assert [(row["ski"], row["load_N"], row["edge_angle_deg"]) for row in table.rows] == [
        (point["ski"], point["load_N"], point["edge_angle_deg"]) for point in study.points
    ]
    row = table.rows[4]
    alone = carve(
        read_ski("slalom"),
        load_snow("race-piste"),
        edge_angle=math.radians(30.0),
        load=800.0,
        unloading_ratio=10.0,
        elements=40,
    )
    assert row["turn_radius_boot_m"] == alone.turn_radius_boot
    assert row["side_force_limit_N"] == alone.side_force_limit
    assert row["total_force_N"] == pytest.approx(math.hypot(800.0, row["side_force_N"]), rel=1e-12)
    assert alone.edge_depth is not None
    assert row[GREATEST_EDGE_DEPTH] == pytest.approx(1e3 * float(alone.edge_depth.max()), rel=1e-12)
    assert row["H_V_N_per_mm3"] == pytest.approx(0.2067, rel=1e-3)  # 2A/cos² 55° of the publication
    flat = table.rows[0]
    assert (flat["side_force_N"], flat["turn_radius_boot_m"]) == (0.0, None)


def test_bad_points_have_their_reason_and_stop_nothing(study_file: Path) -> None:
    rows = run_study(read_study(study_file), workers=1).rows
    steep = [row for row in rows if row["edge_angle_deg"] == 95.0]
    assert {row["outcome"] for row in steep} == {"error"}
    assert all("from 0 to 85" in row["reason"] for row in steep)
    unknown = [row for row in rows if row["ski"] == "no-such-ski" and row not in steep]
    assert all(row["outcome"] == "error" and "'no-such-ski'" in row["reason"] for row in unknown)
    good = [row for row in rows if row["ski"] == "slalom" and row["edge_angle_deg"] < 90]
    assert len(good) == 4
    assert all(row["outcome"] != "error" for row in good)


def test_table_is_the_same_bytes_for_one_and_for_two_workers(study_file: Path) -> None:
    study = read_study(study_file)
    run_study(study, workers=1)
    alone = study.out.read_bytes()
    study.out.unlink()
    run_study(study, workers=2)
    assert study.out.read_bytes() == alone
    assert sorted(path.name for path in study_file.parent.iterdir()) == ["study.toml", "table.csv"]


def test_table_is_tidy_and_comes_back_as_it_was(study_file: Path) -> None:
    study = read_study(study_file)
    table = run_study(study, workers=1)
    with study.out.open(newline="", encoding="utf-8") as stream:
        head, *lines = list(csv.reader(stream))
    assert tuple(head[: len(CARVE_KEYS)]) == tuple(CARVE_KEYS)
    assert {len(line) for line in lines} == {len(head)}
    assert len(lines) == 12
    assert "nan" not in study.out.read_text(encoding="utf-8").casefold()
    back = read_table(study.out, study.subject.keys, varied=study.varied)
    assert back.rows == table.rows


def test_finished_study_is_not_computed_again(study_file: Path) -> None:
    study = read_study(study_file)
    assert study_state(study) is StudyState.NEW
    table = run_study(study, workers=1)
    assert study_state(study) is StudyState.FINISHED
    written = study.out.stat().st_mtime_ns
    KeptRows.opened(study.partial, study.fingerprint()).close()  # as a kill between the two last steps leaves it
    told: list[int] = []
    again = run_study(study, workers=1, progress=lambda done, _: told.append(done))
    assert again.rows == table.rows
    assert again.varied == ("ski", "load_N", "edge_angle_deg")
    assert not told
    assert study.out.stat().st_mtime_ns == written
    assert not study.partial.exists()


def test_finished_points_of_a_changed_study_are_rejected(study_file: Path) -> None:
    KeptRows.opened(read_study(study_file).partial, read_study(study_file).fingerprint()).close()
    study_file.write_text(TEXT.replace("[400, 800]", "[400, 900]"), encoding="utf-8")
    changed = read_study(study_file)
    with raises(ParameterError, "another_study"):
        run_study(changed, workers=1)
    changed.partial.unlink()
    assert len(run_study(changed, workers=1).rows) == 12


def test_table_of_another_study_is_kept_beside_and_anything_else_is_not_replaced(study_file: Path) -> None:
    run_study(read_study(study_file), workers=1)
    first = read_study(study_file).out.read_bytes()
    second = b""
    for load, name in ((900, "table.previous.csv"), (1000, "table.previous-2.csv")):
        study_file.write_text(TEXT.replace("[400, 800]", f"[{load}]"), encoding="utf-8")
        study = read_study(study_file)
        assert study_state(study) is StudyState.ANOTHER
        assert study.place_for_previous() == study_file.parent / name
        assert len(run_study(study, workers=1).rows) == 6
        second = second or study.out.read_bytes()
    assert (study_file.parent / "table.previous.csv").read_bytes() == first
    assert (study_file.parent / "table.previous-2.csv").read_bytes() == second
    study.out.write_text("experiment,site\nP1,A\n", encoding="utf-8")
    with raises(ParameterError, "wrong_kind"):
        run_study(study, workers=1)
    assert study.out.read_text(encoding="utf-8").startswith("experiment")


def test_an_earlier_table_that_cannot_be_moved_is_reported(study_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run_study(read_study(study_file), workers=1)
    before = read_study(study_file).out.read_bytes()
    study_file.write_text(TEXT.replace("[400, 800]", "[900]"), encoding="utf-8")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "rename", full)
    with raises(OutputError, "cannot_write", reason="No space left on device"):
        run_study(read_study(study_file), workers=1)
    assert read_study(study_file).out.read_bytes() == before


def test_an_unforeseen_error_is_the_reason_of_its_point(study_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("by nothing")

    monkeypatch.setattr("skisnow.studies.subjects.answer_question", broken)
    (row, *_) = run_study(read_study(study_file), workers=1).rows
    assert (row["outcome"], row["reason"]) == ("error", "unexpected " + "ZeroDivisionError: by nothing")
    assert (row["ski"], row["load_N"]) == ("slalom", 400.0)


def test_outcomes_are_counted_the_most_frequent_first() -> None:
    rows = [{"outcome": name} for name in ("error", "carves", "skids", "carves", "error", "carves", "rests")]
    table = StudyTable((), rows, ())
    assert list(table.counts().items()) == [("carves", 3), ("error", 2), ("rests", 1), ("skids", 1)]


@pytest.mark.parametrize("there", [True, False])
def test_table_in_which_no_point_could_be_asked_is_not_written(study_file: Path, there: bool) -> None:
    if there:
        run_study(read_study(study_file), workers=1)
    before = sorted((path.name, path.read_bytes()) for path in study_file.parent.glob("table*"))
    study_file.write_text(TEXT.replace("[0, 30, 95]", "[95]"), encoding="utf-8")
    table = run_study(read_study(study_file), workers=1)
    assert (len(table.rows), table.answers()) == (4, [])
    assert sorted((path.name, path.read_bytes()) for path in study_file.parent.glob("table*")) == before


def test_no_workers_are_rejected_for_a_finished_study_too(study_file: Path) -> None:
    run_study(read_study(study_file), workers=1)
    with raises(ParameterError, "too_few_workers", workers=0):
        run_study(read_study(study_file), workers=0)


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda lines: [*lines, "junk"], coded("wrong_kind", n_cells=1)),
        (lambda lines: [*lines, f"{lines[-1]},7"], "wrong_kind"),
        (
            lambda lines: [lines[0], lines[1].replace(",400.0,", ",heavy,"), *lines[2:]],
            coded("wrong_kind", name="load_N", text="heavy"),
        ),
        (lambda _: ["station_mm,width_mm", "0,60", "10,61,3"], "wrong_kind"),
    ],
)
def test_damage_has_its_line(study_file: Path, damage: Callable[[list[str]], list[str]], told: str | Coded) -> None:
    study = read_study(study_file)
    run_study(study, workers=1)
    lines = study.out.read_text(encoding="utf-8").splitlines()
    study.out.write_text("\n".join(damage(lines)) + "\n", encoding="utf-8")
    with raises(ParameterError, told):
        study_state(study)


def test_infinite_ratio_may_be_written_as_a_text(study_file: Path) -> None:
    text = TEXT.replace("_ratio = 10", '_ratio = "inf"').replace(', "no-such-ski"', "").replace("[0, 30, 95]", "[30]")
    study_file.write_text(text, encoding="utf-8")
    as_text = read_study(study_file).points
    study_file.write_text(text.replace('"inf"', "inf"), encoding="utf-8")
    assert as_text == read_study(study_file).points
    assert {row["unloading_ratio"] for row in run_study(read_study(study_file), workers=1).rows} == {1000.0}


def test_at_rest_and_carving_are_in_one_table(study_file: Path) -> None:
    text = 'out = "t.csv"\n[fixed]\nski = "paper-tool"\nH_V_N_per_mm3 = 0.04\nS_f_N_per_mm2 = 0.3\nclamp_length_m = 0\n'
    grid = "unloading_ratio = 1\nload_N = 490\nedge_angle_deg = 45\n[grid]\nat_rest = [true, false]\n"
    study_file.write_text(text + grid, encoding="utf-8")
    rests, carves = run_study(read_study(study_file), workers=1).rows
    # sqrt(2 × 490/(0.04 × 200)) mm; the side force bends a rigid tool no deeper
    assert rests[GREATEST_EDGE_DEPTH] == pytest.approx(math.sqrt(122.5), rel=1e-5)
    assert carves[GREATEST_EDGE_DEPTH] == pytest.approx(math.sqrt(122.5), rel=1e-5)
    assert (rests["side_force_N"], carves["side_force_N"]) == (0.0, pytest.approx(490.0))


SHARDED_STUDY = TEXT.replace("[0, 30, 95]", "[30, 45, 95]")


def whole(study_file: Path) -> bytes:
    table = read_study(study_file).out
    run_study(study_file, workers=1)
    found = table.read_bytes()
    table.unlink()
    return found


def test_parts_put_together_are_the_table_of_one_run(study_file: Path) -> None:
    wanted, out = whole(study_file), study_file.parent / "merged.csv"
    parts = [run_shard(study_file, f"{number}/3", workers=1) for number in (3, 1, 2)]
    assert [part.name for part in parts] == [f"table.csv.shard-{number}-of-3" for number in (3, 1, 2)]
    table = merge_shards(out, parts)
    assert out.read_bytes() == wanted
    assert table.counts() == run_study(study_file, workers=1).counts()
    assert merge_shards(out, parts).rows == table.rows  # it is there already
    assert all(part.is_file() for part in parts)
    again: list[tuple[int, int]] = []
    run_shard(study_file, "1/3", workers=1, progress=lambda *told: again.append(told))
    assert again == [(4, 4)]


def test_parts_that_overlap_are_taken_once(study_file: Path) -> None:
    wanted, out = whole(study_file), study_file.parent / "merged.csv"
    parts = [run_shard(study_file, word, workers=1) for word in ("1/2", "2/4", "4/4", "1/1")]
    merge_shards(out, parts)
    assert out.read_bytes() == wanted


def test_missing_parts_and_foreign_ones_are_rejected(study_file: Path) -> None:
    out = study_file.parent / "merged.csv"
    first = run_shard(study_file, "1/3", workers=1)
    with raises(ParameterError, "missing", missing=8, count=12, first=2):
        merge_shards(out, [first, first])
    study_file.write_text(SHARDED_STUDY.replace("[400, 800]", "[400, 900]"), encoding="utf-8")
    (study_file.parent / "other").mkdir()
    other = study_file.parent / "other" / "study.toml"
    other.write_text(study_file.read_text(encoding="utf-8"), encoding="utf-8")
    foreign = run_shard(other, "2/3", workers=1)
    with raises(ParameterError, "another_study"):
        merge_shards(out, [first, foreign])
    with raises(ParameterError, "another_study"):
        run_shard(study_file, "1/3", workers=1)
    with raises(ParameterError, "cannot_read"):
        merge_shards(out, [study_file.parent / "absent"])
    KeptRows.opened(study_file.parent / "plain", "f").close()
    with raises(ParameterError, "unknown_name"):
        merge_shards(out, [study_file.parent / "plain"])
    with raises(ParameterError, "unknown_name"):
        merge_shards(out, [])
    assert not out.exists()


def test_rows_of_a_point_that_differ_are_rejected(study_file: Path) -> None:
    parts = [run_shard(study_file, word, workers=1) for word in ("1/2", "2/2", "1/1")]
    kept = KeptRows.read(parts[2])
    (text,) = (text for number, text in kept.texts() if number == 3)
    kept._database.execute("delete from rows where number = 3")
    kept.add([(3, text.replace("800.0", "801.0"))])
    kept.close()
    with raises(ParameterError, "contradiction", each=4):
        merge_shards(study_file.parent / "merged.csv", parts)


@pytest.mark.parametrize("word", ["0/3", "4/3", "3", "a/b", "1/0", "1/20000"])
def test_an_invalid_part_is_rejected(word: str) -> None:
    with raises(ParameterError, "out_of_range"):
        Shard.of(word)


def test_parts_by_the_command_line(study_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wanted, out = whole(study_file), study_file.parent / "merged.csv"
    for number in (1, 2):
        assert main(["study", str(study_file), "--shard", f"{number}/2", "--workers", "1"]) == 0
        assert f"table.csv.shard-{number}-of-2: points 6 of 12" in capsys.readouterr().out
    parts = [str(study_file.parent / f"table.csv.shard-{number}-of-2") for number in (1, 2)]
    assert main(["study", "--merge", str(out), *parts]) == 0
    assert "points 12 (error 8" in capsys.readouterr().out
    assert out.read_bytes() == wanted
    assert main(["study", str(study_file), "--shard", "3/2"]) == 1
    assert "'3/2'" in capsys.readouterr().err
    for words in ([str(study_file), str(study_file)], ["--merge", str(out), *parts, "--figure", "map.png"]):
        with pytest.raises(SystemExit):
            main(["study", *words])
    assert main(["study", str(study_file), "--shard", "1/2", "--figure", "map.png"]) == 1


@pytest.mark.slow
def test_eight_parts_that_start_at_once_just_start(study_file: Path) -> None:
    wanted = whole(study_file)
    command = [sys.executable, "-m", "skisnow", "study", str(study_file), "--workers", "1", "--shard"]
    started = [subprocess.Popen([*command, f"{number}/8"], stderr=subprocess.PIPE) for number in range(1, 9)]
    told = [each.communicate()[1].decode() for each in started]
    assert [each.returncode for each in started] == [0] * 8, told
    out = study_file.parent / "merged.csv"
    merge_shards(out, sorted(study_file.parent.glob("*.shard-*-of-8")))
    assert out.read_bytes() == wanted
