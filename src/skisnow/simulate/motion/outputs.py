"""From output to output in one call, until something asks for a look: each call from Python hands over all arrays anew.

That costs as much as a step of the fast mode.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .advance import GOES_ON, PAUSED, Memory, advance_controlled, advance_fixed
from .archive import Archive
from .compiled import PLAIN
from .history import History, note
from .lines import CELLS, TOUCHED, Lines
from .model import Model, Snow, State, World
from .path import surface

FloatArray: TypeAlias = npt.NDArray[np.float64]

# beyond these a run may be about to end, and is looked at after each output: cosine of the lean, height of the boots
# (m), energy of motion, height and bend over that of the start (J)
UPRIGHT, SUNK, GAINED = 0.7, -0.2, 5.0


@compiled(**PLAIN)
def advance_outputs(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, memory: Memory, fast: bool, step: float,
    tolerance: float | None, moments: FloatArray, end: float, share: FloatArray, lost_before: float,
    held_first: float, history: History, row: int,
) -> tuple[int, int]:  # fmt: skip
    """Go to each of the `moments` (s) and note it from `row` on; how many were, and what it ended with.

    Paused, it is to be called again for the moments that are left.

    Steps have their error controlled by `tolerance` (m); with None they are fixed. Numba compiles what the one needs
    and leaves the other out. `end`: x of the slope's end (m). The others as in `advance_fixed` and `note`.
    """
    for i in range(len(moments)):
        if tolerance is None:
            trouble = advance_fixed(model, snow, world, lines, archive, memory, fast, step, moments[i])
        else:
            trouble = advance_controlled(model, snow, world, lines, archive, memory, tolerance, moments[i])
        if trouble == PAUSED:
            return i, trouble
        note(model, snow, world, lines, archive, memory, share, lost_before, held_first, history, row + i)
        if trouble != GOES_ON or not _goes_well(model, world, lines, archive, memory.state, end, history, row + i):
            return i + 1, trouble
    return len(moments), GOES_ON


@compiled(**PLAIN)
def _goes_well(
    model: Model, world: World, lines: Lines, archive: Archive, state: State, end: float, history: History, row: int
) -> bool:  # fmt: skip
    """Whether nothing can end the run here, and the archive has room for the next output."""
    height, gradient = surface(world, state.place[0])
    leaning = (state.turn[2, 2] - gradient * state.turn[0, 2]) / np.sqrt(1.0 + gradient * gradient)
    touches = 0
    for each in range(len(lines.flag)):
        touches |= lines.flag[each, TOUCHED]
    gained = 0.0
    for a in range(3):
        gained += history.energies[row, a] - history.energies[0, a]
    return bool(
        touches == 1
        and leaning > UPRIGHT
        and state.place[2] - height > SUNK
        and state.place[0] + model.tip < end
        and gained < GAINED
        and is_roomy(archive, len(lines.cells))
    )


@compiled(**PLAIN)
def is_roomy(archive: Archive, rows: int) -> bool:
    """Whether the archive has room for what so many rows of lines can leave from output to output."""
    pieces, places = len(archive.cell) - archive.used[0], len(archive.pool) - archive.used[1]
    return bool(pieces >= 2 * rows and places >= rows * CELLS)
