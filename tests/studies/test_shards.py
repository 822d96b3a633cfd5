"""A study in parts: put together it is the table of one run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.cli import main
from skisnow.studies import Shard, merge_shards, read_study, run_shard, run_study
from tests.coded import raises

TEXT = """
out = "table.csv"
[fixed]
published = "race-piste"
unloading_ratio = 10
elements = 40
[grid]
ski = ["slalom", "no-such-ski"]
load_N = [400, 800]
edge_angle_deg = [30, 45, 95]
"""


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


def test_missing_parts_and_foreign_ones_are_refused(study_file: Path) -> None:
    out = study_file.parent / "merged.csv"
    first = run_shard(study_file, "1/3", workers=1)
    with raises(ParameterError, "missing", missing=8, count=12, first=2):
        merge_shards(out, [first, first])
    study_file.write_text(TEXT.replace("[400, 800]", "[400, 900]"), encoding="utf-8")
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


def test_rows_of_a_point_that_differ_are_refused(study_file: Path) -> None:
    parts = [run_shard(study_file, word, workers=1) for word in ("1/2", "2/2", "1/1")]
    kept = KeptRows.read(parts[2])
    (text,) = (text for number, text in kept.texts() if number == 3)
    kept._database.execute("delete from rows where number = 3")
    kept.add([(3, text.replace("800.0", "801.0"))])
    kept.close()
    with raises(ParameterError, "contradiction", each=4):
        merge_shards(study_file.parent / "merged.csv", parts)


@pytest.mark.parametrize("word", ["0/3", "4/3", "3", "a/b", "1/0", "1/20000"])
def test_what_is_no_part_is_refused(word: str) -> None:
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
