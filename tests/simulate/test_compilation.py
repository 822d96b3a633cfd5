"""Compiled loops: made before a run, all of them, and thrown away when the program changes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from skisnow import machine_code
from skisnow.simulate import compilation

from ..test_machine_code import DAMAGES, Damage

PROGRAM = r"""
import hashlib, json, re, resource, sys
from pathlib import Path

from skisnow.simulate import compilation
from skisnow.simulate.scenario import read_scenario
from skisnow.simulate.judge.simulated_run import simulated_run

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
@pytest.mark.slow
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


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where code is kept in this test, with two files of it."""
    there = tmp_path / "0123-abc"
    for module in (machine_code, compilation):
        monkeypatch.setattr(module, "folder", lambda: there)
    for name in ("settle-1.nbc", "feel-2.nbc"):
        machine_code.keep(there / name, name.encode())
    return there


def test_what_was_made_is_written_down(folder: Path) -> None:
    assert compilation.parts_made() == set()
    compilation._write_down(["forces", "paths"])
    assert compilation.parts_made() == {"forces", "paths"}
    (folder / "feel-2.nbc").unlink()
    assert compilation.parts_made() == set()


@pytest.mark.parametrize("name", ["made", "feel-2.nbc"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_damage_is_seen_before_a_run(name: str, damage: Damage, folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    machine_code.keep(folder / "feel-2.nbc", bytes(200))
    compilation._write_down(["forces" * 20])
    whole = (folder / name).read_bytes()
    (folder / name).write_bytes(damage(whole))
    assert compilation.parts_made() == set()
    assert len(caplog.records) == 1
    assert not (folder / name).exists()


def test_a_note_of_another_kind_counts_for_nothing(folder: Path) -> None:
    machine_code.keep(folder / "made", b"{")
    assert compilation.parts_made() == set()


def test_a_process_that_fails_is_not_noted(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The processes see that the program is not in the state they were asked for."""
    monkeypatch.setattr(compilation, "SOURCES", "not this")
    with pytest.raises(subprocess.CalledProcessError):
        compilation._make((("forces", "paths"), ("fixed",)))
    assert compilation.parts_made() == set()
    assert not (folder / "made").exists()


@pytest.mark.parametrize("trouble", [OSError("read-only"), subprocess.CalledProcessError(1, "python")])
def test_trouble_is_left_to_the_run(trouble: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nothing can be kept, or Python not started, a run compiles for itself."""

    asked = []

    def failing(waves: object) -> None:
        asked.append(waves)
        raise trouble

    monkeypatch.setattr(compilation, "_make", failing)
    monkeypatch.setattr(compilation, "parts_made", set)
    compilation._require.__wrapped__("fixed")
    assert asked == [(("forces", "paths"), ("rest", "look"), ("fixed",))]
