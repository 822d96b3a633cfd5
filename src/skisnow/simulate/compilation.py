"""The compiled loops of a run, made once on a machine in processes of their own, and loaded by every run.

Numba compiles a function when it is first called. Left to itself it would do so in the process that runs, and two
things would be wrong:

- the outer functions that call an inner one bring a copy of it each, and a process runs the first that it comes to. One
  that compiles comes to others than one that loads, and the last digits of its run would differ from those of the next;
- a run would hold the memory that compiling took.

What is kept, and of which state of the program, is a matter of `skisnow.machine_code`.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any, Final, TypeAlias

import numba
import numpy as np

from ..errors import OutputError
from ..machine_code import SOURCES, folder, keep, kept, place
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
_NOTE: Final = "made"
"""File beside the code: which parts were made, and the files that were there then."""


def require_compiled(scenario: Scenario) -> None:
    """Make what a run of this scenario needs, where it is not kept whole.

    Where that cannot be done, in a program that cannot start Python or on a full disk, nothing is: the run then
    compiles for itself.
    """
    _require("fixed" if scenario.solver.fixed or scenario.solver.method == "fast" else "controlled")


@cache
def _require(steps: str) -> None:
    if _SETTINGS.DISABLE_JIT or getattr(sys, "frozen", False) or not sys.executable:
        return
    with contextlib.suppress(OSError, OutputError, subprocess.CalledProcessError):
        if steps not in parts_made():
            folder().parent.mkdir(parents=True, exist_ok=True)
            with _alone():
                _make((*_BEFORE, (steps,)))


def parts_made() -> set[str]:
    """Those whose code is kept, every file of it whole. What is damaged is thrown away by this look."""
    try:
        parts, files = json.loads(kept(folder() / _NOTE) or b"[[], []]")
    except ValueError:
        return set()
    whole = [kept(folder() / name) is not None for name in files]
    return set(parts) if all(whole) else set()


def _write_down(parts: Sequence[str]) -> None:
    files = sorted(path.name for path in folder().glob("*.nbc"))
    keep(folder() / _NOTE, json.dumps([sorted(parts), files]).encode())


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """Wait while another process makes the same. Where the system has no such lock nothing is done."""
    with (folder().parent / "lock").open("wb") as file:
        if sys.platform != "win32":
            import fcntl

            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(file.fileno(), fcntl.LOCK_EX)
        yield


def _make(waves: Sequence[Sequence[str]]) -> None:
    """Make what is missing, each part in a process."""
    made = parts_made()
    for wave in waves:
        missing = [name for name in wave if name not in made]
        with contextlib.ExitStack() as ended:
            for process in [ended.enter_context(_process(name)) for name in missing]:
                if process.wait():
                    raise subprocess.CalledProcessError(process.returncode, process.args)
        made.update(missing)
        _write_down(sorted(made))


@contextlib.contextmanager
def _process(part: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process that makes one part; it does not outlive the block."""
    # it finds its modules where this process does
    program = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import make_part; make_part(*sys.argv[1:])"
    words, quiet = [sys.executable, "-c", program, part, SOURCES], subprocess.DEVNULL
    there = os.environ | {"NUMBA_CACHE_DIR": str(place())}
    with subprocess.Popen(words, stdin=quiet, stdout=quiet, stderr=quiet, env=there) as process:
        try:
            yield process
        finally:
            process.kill()


def make_part(name: str, sources: str) -> None:
    """Compile one part, or load what is kept of it; nothing is run. Other sources end the process."""
    if sources != SOURCES:
        sys.exit(1)
    for function, arguments in _calls(name):
        function.compile(tuple(function.typeof_pyval(each) for each in arguments))


def _calls(name: str) -> list[Call]:
    """What is compiled for one part, called as a run calls it."""
    from .judge.run_setup import laid_out  # which needs this module

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
