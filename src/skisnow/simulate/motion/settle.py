"""Static start: depth, roll, pitch and bend in equilibrium, place and heading held."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import MAKING
from .equations import add_forces, channel_rows, copy_pose, move
from .forces import Forces, feel
from .lines import ABOVE, Lines
from .model import Model, Snow, State, World
from .ros2 import Room
from .system import Factored, add_band, backwards, cholesky, factor, forwards, solve_corner

FloatArray: TypeAlias = npt.NDArray[np.float64]

LONGEST_STEP: Final = 0.004
"""Of Newton's method (m)."""
MOST_STEPS: Final = 5000
"""A few dozen are the rule; more than a thousand at edge angles from 55° where the edge holds strongly."""
SETTLED: Final = 1e-10
"""Last Newton step (m) that counts as equilibrium."""


@compiled(**MAKING)
def settle(
    model: Model, snow: Snow, world: World, lines: Lines, state: State, start: Forces, system: Factored, room: Room,
    calm: State,
) -> float:  # fmt: skip
    """Move `state` to equilibrium by Newton's method and return its last step (m); `calm` is working space."""
    vector = room.first
    size = 1e9
    scale = 1.0
    for _ in range(MOST_STEPS):
        # for a constant in place of a value Numba compiles a function anew
        feel(model, snow, lines, state, size > 0.0, size > 0.0, start)
        lines.flag[:, ABOVE] = 0  # Newton's steps are no motion: edges hold where they come to rest
        vector.rigid[:] = 0.0
        vector.bend[:] = 0.0
        add_forces(model, world, state, start, 1.0, vector)
        add_band(model.stiffness, state.bend[0], -1.0, vector.bend[0])
        add_band(model.stiffness, state.bend[1], -1.0, vector.bend[1])
        channel_rows(model, lines, state, system.rows)
        # so stiff a system has next to no inertia: M is what keeps it definite off the snow
        held = factor(model, start, system.rows, 1e6, 1e6, system)
        if not held:
            return 1e9
        forwards(system, vector)
        _solve_free(system.corner, vector.rigid)
        backwards(system, vector)
        for a in range(6):
            vector.rigid[a] *= 1e6
        size = 0.0
        for a in range(6):
            size = max(size, abs(vector.rigid[a]) * (1.0 if a < 3 else 0.5))
        for k in range(2):
            for i in range(vector.bend.shape[1]):
                vector.bend[k, i] *= 1e6
                if (i - 5) % 3 == 0:
                    size = max(size, abs(vector.bend[k, i]))
        scale = min(1.0, LONGEST_STEP / size)
        move(state, vector.rigid, vector.bend, scale, calm)
        copy_pose(calm, state)
        if size < SETTLED:
            break
    return size


@compiled(**MAKING)
def _solve_free(corner: FloatArray, right: FloatArray) -> None:
    """Solve for height, roll and pitch alone, from the Cholesky factor of the whole corner."""
    whole = np.zeros((6, 6))
    for a in range(6):
        for b in range(6):
            for c in range(min(a, b) + 1):
                left = 1.0 / corner[a, a] if a == c else corner[a, c]
                top = 1.0 / corner[b, b] if b == c else corner[b, c]
                whole[a, b] += left * top
    inner, free = np.zeros((3, 3)), np.zeros(3)
    for a in range(3):
        free[a] = right[a + 2]
        for b in range(3):
            inner[a, b] = whole[a + 2, b + 2]
    cholesky(inner)
    solve_corner(inner, free)
    for a in range(6):
        right[a] = free[a - 2] if 2 <= a < 5 else 0.0
