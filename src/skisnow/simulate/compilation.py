"""The compiled loops of a run, made once on a machine in processes of their own, and loaded by every run.

Numba compiles a function when it is first called, and keeps what it made. Left to itself it would do so in the process
that runs, and three things would be wrong:

- the outer functions that call an inner one bring a copy of it each, and a process runs the first that it comes to. One
  that compiles comes to others than one that loads, and the last digits of its run would differ from those of the next;
- a run would hold the memory that compiling took;
- a function is made anew when its own file changes, not when one does that it calls: after an update of the program
  old and new code would run side by side. Here a change of any file of the loops throws away all that was kept.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeAlias

import llvmlite.binding
import numba
import numpy as np

from ..errors import OutputError
from ..files import write_file
from . import motion
from .motion.advance import observe
from .motion.fast import fast_step
from .motion.forces import feel
from .motion.history import new_history, note
from .motion.outputs import advance_outputs, is_roomy
from .motion.path import energy_in_snow, follow, press
from .motion.ros2 import ros2_step
from .motion.settle import settle
from .scenario import Scenario, read_scenario

Call: TypeAlias = tuple[Any, tuple[Any, ...]]
"""A compiled function, and arguments as a run hands them over."""

_SETTINGS: Any = numba.config
_BEFORE: Final = (("forces", "paths"), ("rest", "look"))
"""What is made side by side, each in a process, before the steps; later ones load what earlier ones kept."""
_NAME: Final = "skisnow-compiled"
"""Files beside what Numba keeps: of what was made from which state of the program, one for each kind of machine."""


def require_compiled(scenario: Scenario) -> None:
    """Make what a run of this scenario needs, where it is not kept from before or from another state of the program.

    Where that cannot be done, in a folder that cannot be written or a program that cannot start Python, nothing is:
    the run then compiles for itself.
    """
    _require("fixed" if scenario.solver.fixed or scenario.solver.method == "fast" else "controlled")


def throw_away_older_code() -> None:
    """For programs that call single loops outside a run: nothing made from another state of the program is loaded."""
    if not _SETTINGS.DISABLE_JIT:
        kept = _Kept(Path(settle.stats.cache_path))
        with contextlib.suppress(OSError, OutputError), kept.alone():
            kept.throw_away_older()


@cache
def _require(steps: str) -> None:
    if _SETTINGS.DISABLE_JIT or getattr(sys, "frozen", False) or not sys.executable:
        return
    kept = _Kept(Path(settle.stats.cache_path))
    with contextlib.suppress(OSError, OutputError, subprocess.CalledProcessError):
        if steps not in kept.parts():
            kept.folder.mkdir(parents=True, exist_ok=True)
            with kept.alone():
                _make(kept, (*_BEFORE, (steps,)))


@dataclass(frozen=True, slots=True)
class _Kept:
    """The folder in which Numba keeps what it made."""

    folder: Path

    def parts(self) -> set[str]:
        """Those made from this state of the program for this machine."""
        found = _read(self._file)
        there = found.get("state") == _state() and any(self.folder.glob("*.nbi"))
        return set(found["made"]) if there else set()

    def add(self, parts: Iterable[str]) -> None:
        """Write down what was made."""
        write_file(self._file, json.dumps({"state": _state(), "made": sorted(self.parts().union(parts))}))

    def throw_away_older(self) -> None:
        """Remove all that was, or may have been, made from another state of the program.

        What Numba keeps from now on is of this one, whether or not all of it gets made.
        """
        notes = list(self.folder.glob(f"{_NAME}-*.json"))
        if notes and all(_read(note).get("state") == _state() for note in notes):
            return
        for path in (*notes, *self.folder.glob("*.nbi"), *self.folder.glob("*.nbc")):
            path.unlink(missing_ok=True)
        self.add(())

    @contextlib.contextmanager
    def alone(self) -> Iterator[None]:
        """Wait while another process makes the same. Where the system has no such lock nothing is done."""
        with (self.folder / f"{_NAME}.lock").open("wb") as file:
            if sys.platform != "win32":
                import fcntl

                with contextlib.suppress(OSError):  # a file system without locks
                    fcntl.flock(file.fileno(), fcntl.LOCK_EX)
            yield

    @property
    def _file(self) -> Path:
        return self.folder / f"{_NAME}-{_machine()}.json"


def _read(note: Path) -> dict[str, Any]:
    try:
        found = json.loads(note.read_bytes())
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) and isinstance(found.get("made"), list) else {}


@cache
def _state() -> str:
    """Tells one state of the loops from every other."""
    digest = hashlib.sha256()
    for path in sorted(Path(motion.__file__).parent.glob("*.py")):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _machine() -> str:
    """Tells one processor, Python and compiler from every other, as Numba does."""
    host = llvmlite.binding.get_host_cpu_name(), llvmlite.binding.get_host_cpu_features().flatten()
    chosen = _SETTINGS.CPU_NAME, _SETTINGS.CPU_FEATURES
    told = repr((sys.version, numba.__version__, llvmlite.__version__, host, chosen))
    return hashlib.sha256(told.encode()).hexdigest()[:16]


def _make(kept: _Kept, waves: Sequence[Sequence[str]]) -> None:
    """Make what is missing, each part in a process."""
    kept.throw_away_older()
    for wave in waves:
        with contextlib.ExitStack() as ended:
            started = [ended.enter_context(_process(name)) for name in wave if name not in kept.parts()]
            for process in started:
                if process.wait():
                    raise subprocess.CalledProcessError(process.returncode, process.args)
        kept.add(wave)


@contextlib.contextmanager
def _process(part: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process that makes one part; it does not outlive the block."""
    # it finds its modules where this process does
    program = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import make_part; make_part(*sys.argv[1:])"
    words, quiet = [sys.executable, "-c", program, part, _state()], subprocess.DEVNULL
    with subprocess.Popen(words, stdin=quiet, stdout=quiet, stderr=quiet) as process:
        try:
            yield process
        finally:
            process.kill()


def make_part(name: str, state: str) -> None:
    """Compile one part, or load what is kept of it; nothing is run. Another state of the program ends the process."""
    if state != _state():
        sys.exit(1)
    for function, arguments in _calls(name):
        function.compile(tuple(function.typeof_pyval(each) for each in arguments))


def _calls(name: str) -> list[Call]:
    """What is compiled for one part, called as a run calls it."""
    from .run_setup import laid_out  # which needs this module

    run = laid_out(read_scenario("carved-46m"))
    model, snow, world, lines, archive, memory = run.model, run.snow, run.world, run.lines, run.archive, run.memory
    state, start, system, room, after = memory.state, memory.start, memory.system, memory.room, memory.next
    history = new_history(1, len(model.node))
    calls: dict[str, Callable[[], list[Call]]] = {
        "forces": lambda: [(feel, (model, snow, lines, state, True, True, start))],
        "paths": lambda: [(follow, (model, snow, world, lines, archive, state)), (press, (snow, lines, archive))],
        "rest": lambda: [
            (settle, (model, snow, world, lines, state, start, system, room, after)),
            (ros2_step, (model, snow, world, lines, state, start, memory.stage, system, 1e-3, room, after)),
            (fast_step, (model, world, state, start, system, 1e-3, memory.past, after)),
        ],
        "look": lambda: [
            (observe, (model, snow, world, lines, archive, memory, True)),
            (energy_in_snow, (snow, lines, archive)),
            (is_roomy, (archive, len(lines.cells))),
            (note, (model, snow, world, lines, archive, memory, run.shares, 0.0, 0.0, history, 0)),
        ],
    }
    if name in calls:
        return calls[name]()
    tolerance = 1e-6 if name == "controlled" else None
    return [
        (
            advance_outputs,
            (model, snow, world, lines, archive, memory, False, 1e-3, tolerance, np.zeros(1), run.end, run.shares, 0.0,
             0.0, history, 0),
        )
    ]  # fmt: skip
