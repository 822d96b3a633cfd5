"""`skisnow study` as a user meets it, killed and interrupted too."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from skisnow._support.errors import SkisnowError
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.cli import main

TEXT = """
out = "tables/table.csv"
[fixed]
ski = "slalom"
published = "race-piste"
unloading_ratio = 10
elements = 300
[grid]
load_N = { from = 300, to = 1500, n = 8 }
edge_angle_deg = { from = 10, to = 60, n = 8 }
"""
SMALL = TEXT.replace("1500, n = 8", "1500, n = 2").replace("60, n = 8", "60, n = 3").replace("300\n[", "100\n[")
POINTS = 8 * 8
Printed = pytest.CaptureFixture[str]


def study_in(folder: Path, text: str) -> Path:
    folder.mkdir()
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_table_counts_and_progress(tmp_path: Path, capsys: Printed) -> None:
    path = study_in(tmp_path / "a", SMALL)
    assert main(["study", str(path), "--workers", "1"]) == 0
    out, _ = capsys.readouterr()
    assert "table.csv: points 6" in out
    assert [each.name for each in (tmp_path / "a" / "tables").iterdir()] == ["table.csv"]
    assert main(["study", str(path)]) == 0
    assert capsys.readouterr().err


@pytest.mark.parametrize(("which", "suffix"), [("radius", "png"), pytest.param("grip", "pdf", marks=pytest.mark.slow)])
def test_maps_are_drawn(which: str, suffix: str, tmp_path: Path) -> None:
    path, figure = study_in(tmp_path / "a", SMALL), tmp_path / f"map.{suffix}"
    assert main(["study", str(path), "--workers", "1", "--map", which, "--figure", str(figure)]) == 0
    first = figure.read_bytes()
    assert first[:5] in (b"\x89PNG\r", b"<?xml", b"%PDF-")
    assert main(["study", str(path), "--map", which, "--figure", str(figure)]) == 0
    assert figure.read_bytes() == first


@pytest.mark.parametrize("which", [pytest.param("radius", marks=pytest.mark.slow), "grip"])
def test_a_map_in_german(which: str, tmp_path: Path) -> None:
    path, figure = study_in(tmp_path / "a", SMALL), tmp_path / "map.svg"
    words = ["--map", which, "--figure", str(figure), "--language", "de"]
    assert main(["study", str(path), "--workers", "1", *words]) == 0
    text = figure.read_text("utf-8")
    assert "Kantwinkel" in text and "hält" in text
    for english in ("edge", "load", "turn radius", "holds", "slips", "grip", "force"):
        assert english not in text


ANGLES = "{ from = 10, to = 60, n = 3 }"


def test_studies_after_a_finished_one(tmp_path: Path, capsys: Printed) -> None:
    """A study with errors only, or with a wrong fixed value, exits with 1 and keeps the table; another one moves it."""
    path = study_in(tmp_path / "a", SMALL)
    assert main(["study", str(path), "--workers", "1"]) == 0
    finished = (tmp_path / "a/tables/table.csv").read_bytes()
    for old, new, words in (
        (ANGLES, "[90, 95]", ("points 4 (error 4)", "row 1: ", "edge_angle_deg", "85")),
        ("race-piste", "race-pist", ("'race-piste'?",)),
    ):
        capsys.readouterr()
        path.write_text(SMALL.replace(old, new), encoding="utf-8")
        assert main(["study", str(path), "--workers", "1"]) == 1
        printed = "".join(capsys.readouterr())
        assert all(word in printed for word in words)
        assert [(each.name, each.read_bytes()) for each in (tmp_path / "a/tables").iterdir()] == [
            ("table.csv", finished)
        ]
    path.write_text(SMALL.replace("to = 60", "to = 50"), encoding="utf-8")
    assert main(["study", str(path), "--workers", "1"]) == 0
    assert "table.previous.csv" in capsys.readouterr().err
    assert sorted(each.name for each in (tmp_path / "a/tables").iterdir()) == ["table.csv", "table.previous.csv"]


def test_warnings_of_points_are_counted_and_the_first_is_reported(tmp_path: Path, capsys: Printed) -> None:
    path = study_in(tmp_path / "a", SMALL.replace(ANGLES, "[0.5, 30, 0.785]"))
    assert main(["study", str(path), "--workers", "1"]) == 0
    told = "warning: 4 points carry warnings; the first, row 1: edge_angle_deg is 0.5: that looks like radians"
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words", "code"),
    [
        (SMALL.replace("load_N", "laod_N"), [], "unknown_name"),
        (SMALL, ["--figure", "map.jpg"], "unknown_ending"),
        (SMALL.replace("tables/table.csv", "study.toml"), [], "wrong_ending"),
    ],
)
def test_bad_input_is_rejected(
    text: str, words: list[str], code: str, tmp_path: Path, noted_errors: list[SkisnowError]
) -> None:
    assert main(["study", str(study_in(tmp_path / "a", text)), *words]) == 1
    assert noted_errors[-1].code == code
    assert not (tmp_path / "a" / "tables" / "table.csv").exists()


def started(path: Path, *words: str) -> subprocess.Popen[bytes]:
    words = (sys.executable, "-m", "skisnow", "study", str(path), *words)
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def wait_for(condition: Callable[[], bool], patience_s: float = 120.0) -> None:
    end = time.monotonic() + patience_s
    while not condition():
        assert time.monotonic() < end, "it did not come to pass"
        time.sleep(0.01)


def kept_in(partial: Path, copy: Path) -> int:
    """Rows in a file that another process has; it is looked at in a copy."""
    copy.mkdir(exist_ok=True)
    for name in (partial.name, f"{partial.name}-wal"):
        if (place := partial.with_name(name)).exists():
            shutil.copyfile(place, copy / name)
    try:
        return len(KeptRows.read(copy / partial.name))
    except SkisnowError:  # it was copied in the middle of a writing, or is not there yet
        return 0


def alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text("ascii").rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
@pytest.mark.parametrize(
    ("how", "code"),
    [
        (signal.SIGKILL, -signal.SIGKILL),
        pytest.param(signal.SIGINT, 130, marks=pytest.mark.slow),
        pytest.param(signal.SIGTERM, 143, marks=pytest.mark.slow),
    ],
)
def test_killed_and_interrupted_studies_go_on_to_the_same_bytes(tmp_path: Path, how: signal.Signals, code: int) -> None:
    broken, whole = study_in(tmp_path / "broken", TEXT), study_in(tmp_path / "whole", TEXT)
    partial = broken.parent / "tables" / "table.csv.partial"
    first = started(broken, "--workers", "2")
    wait_for(lambda: kept_in(partial, tmp_path / "copy") > 3 or first.poll() is not None)
    workers = [int(word) for word in Path(f"/proc/{first.pid}/task/{first.pid}/children").read_text("ascii").split()]
    os.kill(first.pid, how)
    _, err = first.communicate(timeout=300)
    assert first.returncode == code, err.decode()
    assert b"Traceback" not in err
    assert how == signal.SIGKILL or b"resource_tracker" not in err
    kept = kept_in(partial, tmp_path / "copy")
    assert 3 <= kept < POINTS
    assert not (broken.parent / "tables" / "table.csv").exists()
    assert workers
    wait_for(lambda: not any(alive(worker) for worker in workers), 20.0)
    assert main(["study", str(broken), "--workers", "1"]) == 0
    assert main(["study", str(whole), "--workers", "1"]) == 0
    tables = [path.parent / "tables" / "table.csv" for path in (broken, whole)]
    assert tables[0].read_bytes() == tables[1].read_bytes()
    assert not partial.exists()
