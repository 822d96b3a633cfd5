"""Compiled loops: made before a run, all of them, and thrown away when the program changes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from skisnow.simulate import compilation

PROGRAM = r"""
import hashlib, json, re, resource, sys
from pathlib import Path

from skisnow.simulate import compilation
from skisnow.simulate.scenario import read_scenario
from skisnow.simulate.simulated_run import simulated_run

unit = 1024.0 if sys.platform != "darwin" else 1.0
for changes in json.loads(sys.argv[1]):
    run = simulated_run(read_scenario("carved-46m", changes={"run.duration_s": 0.3, **changes}))
    print(hashlib.sha256(run.place.tobytes()).hexdigest())
outer = "follow settle observe energy_in_snow is_roomy advance_outputs".split()
missed = [name for name in outer if getattr(compilation, name).stats.cache_misses]
peaks = [resource.getrusage(who).ru_maxrss * unit / 1e6 for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
status = Path("/proc/self/status")
if status.exists():  # getrusage counts what the parent held when it started this process
    peaks[0] = float(re.search(r"VmHWM:\s*(\d+) kB", status.read_text())[1]) * 1024 / 1e6
print(json.dumps([missed, *peaks]))
"""
FIXED: dict[str, object] = {"solver.fixed": True, "solver.step_ms": 1.0}
FAST: dict[str, object] = {**FIXED, "solver.method": "fast"}
MOST_MB = 400.0


def told(cases: list[dict[str, object]], **environment: str) -> tuple[list[str], list[str], float, float]:
    """Of runs in a process of their own: digests of their tracks, what it compiled itself, and memory (MB).

    Of the process, and of the largest that it started.
    """
    words = [sys.executable, "-c", PROGRAM, json.dumps(cases)]
    done = subprocess.run(words, check=True, capture_output=True, text=True, env={**os.environ, **environment})
    *digests, last = done.stdout.splitlines()
    missed, own, largest = json.loads(last)
    return digests, missed, own, largest


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no module resource")
def test_a_run_compiles_nothing() -> None:
    """What is made beforehand is what every kind of run calls."""
    _, missed, own, _ = told([{}, FIXED, FAST])
    assert missed == []
    assert own < MOST_MB


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no module resource")
def test_first_run_on_a_machine(tmp_path: Path) -> None:
    """It has the last digit of later ones, in whatever order, and holds no memory of the compiling."""
    first, missed, own, largest = told([{}, FIXED, FAST], NUMBA_CACHE_DIR=str(tmp_path))
    assert missed == []
    assert max(own, largest) < MOST_MB
    again, missed, _, started = told([FAST, FIXED, {}], NUMBA_CACHE_DIR=str(tmp_path))
    assert missed == []
    assert started == 0.0
    assert again == first[::-1]


def in_folder(path: Path) -> compilation._Kept:
    """With one thing that Numba kept."""
    (path / "settle.settle-29.py311.nbi").write_bytes(b"")
    return compilation._Kept(path)


def names(path: Path) -> set[str]:
    """Of all files but the notes."""
    return {each.name for each in path.iterdir() if each.suffix != ".json"}


def test_what_was_made_is_written_down(tmp_path: Path) -> None:
    kept = in_folder(tmp_path)
    assert kept.parts() == set()
    kept.add(["forces"])
    kept.add(["paths", "rest"])
    assert kept.parts() == {"forces", "paths", "rest"}
    (tmp_path / "settle.settle-29.py311.nbi").unlink()  # somebody has emptied the folder but for the note
    assert kept.parts() == set()


def test_other_code_is_thrown_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = in_folder(tmp_path)
    for name in ("settle.settle-29.py311.1.nbc", "settle.pyc"):
        (tmp_path / name).write_bytes(b"")
    kept.throw_away_older()  # nothing tells what it was made from
    assert names(tmp_path) == {"settle.pyc"}
    kept = in_folder(tmp_path)  # made by a run for itself: nothing was noted but the state
    kept.throw_away_older()
    assert names(tmp_path) == {"settle.pyc", "settle.settle-29.py311.nbi"}
    kept.add(["forces"])
    kept.throw_away_older()
    assert kept.parts() == {"forces"}
    monkeypatch.setattr(compilation, "_machine", lambda: "another")
    kept.throw_away_older()  # another machine of the same home, with the same program
    assert names(tmp_path) == {"settle.pyc", "settle.settle-29.py311.nbi"}
    assert kept.parts() == set()
    monkeypatch.setattr(compilation, "_state", lambda: "changed")
    kept.throw_away_older()
    assert names(tmp_path) == {"settle.pyc"}


@pytest.mark.parametrize("content", [b"", b"[]", b'{"state": 1}', b"\xff", b'{"made": 3}'])
def test_a_spoiled_note_counts_for_nothing(tmp_path: Path, content: bytes) -> None:
    kept = in_folder(tmp_path)
    kept.add(["forces"])
    (note,) = tmp_path.glob("*.json")
    note.write_bytes(content)
    assert kept.parts() == set()
    kept.throw_away_older()
    assert names(tmp_path) == set()
    assert compilation._read(note)["made"] == []


def test_a_process_that_fails_is_not_noted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The processes see that the program is not in the state they were asked for. What a run then keeps stays."""
    monkeypatch.setattr(compilation, "_state", lambda: "not this")
    for _ in range(2):
        kept = in_folder(tmp_path)
        with pytest.raises(subprocess.CalledProcessError):
            compilation._make(kept, (("forces", "paths"), ("fixed",)))
        assert kept.parts() == set()
    assert names(tmp_path) == {"settle.settle-29.py311.nbi"}


@pytest.mark.parametrize("trouble", [OSError("read-only"), subprocess.CalledProcessError(1, "python")])
def test_trouble_is_left_to_the_run(trouble: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing can be kept, or Python not started, a run compiles for itself."""

    asked = []

    def failing(_: object, waves: object) -> None:
        asked.append(waves)
        raise trouble

    monkeypatch.setattr(compilation, "_make", failing)
    monkeypatch.setattr(compilation._Kept, "parts", lambda _: set())
    compilation._require.__wrapped__("fixed")
    assert asked == [(("forces", "paths"), ("rest", "look"), ("fixed",))]
