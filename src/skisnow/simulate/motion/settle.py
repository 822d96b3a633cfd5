"""Static start: depth, roll, pitch and bend in equilibrium, place and heading held.

What an edge meets when the ski rolls or twists is not symmetric: the pressure turns with the base, the force on the
beam does not. The matrix W of the steps leaves that out, and on hard snow, or on steep edges, Newton's method with W
goes astray. Here W only brings the equations to metres: GMRES finds the step of Newton's method from differences of the
forces themselves, and the step is shortened until less is left to go.
"""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import MAKING, PLAIN
from .equations import add_forces, channel_rows, copy_pose, move
from .forces import Forces, feel
from .krylov import MOST_PRODUCTS, Products, begin, length, solution, take
from .lines import Lines
from .model import PADDING, Model, Snow, State, World
from .ros2 import Room
from .system import Factored, Vector, add_band, backwards, cholesky, factor, forwards, solve_corner

FloatArray: TypeAlias = npt.NDArray[np.float64]

LONGEST_STEP: Final = 0.02
"""Of Newton's method (m)."""
MOST_STEPS: Final = 40
"""Five to twenty are the rule."""
SETTLED: Final = 1e-10
"""Last Newton step (m) that counts as equilibrium."""
SMALL: Final = 1e-7
"""Step (m) from which on one that does not shrink any more is rounding."""
LEAST_SHARE: Final = 1e-6
"""Share of a step below which it leads nowhere."""
NEARBY: Final = 1e-7
"""Way (m) over which differences of forces are taken."""
EXACT: Final = 0.01
"""Share of what is to go that a step may leave."""
NO_INERTIA: Final = 1e6
"""Times the stiffness, beside the masses, which only keep the matrix definite off the snow."""
FAILED: Final = 1e9


@compiled(**MAKING)
def settle(
    model: Model, snow: Snow, world: World, lines: Lines, state: State, start: Forces, system: Factored, room: Room,
    calm: State,
) -> float:  # fmt: skip
    """Move `state` to equilibrium by Newton's method and return its last step (m); `calm` is working space."""
    size = 6 + 2 * len(model.mass)
    products = Products(
        np.zeros((MOST_PRODUCTS + 1, size)),
        np.zeros((MOST_PRODUCTS, MOST_PRODUCTS + 1)),
        np.zeros((MOST_PRODUCTS, 2)),
        np.zeros(MOST_PRODUCTS + 1),
    )
    none, to_go, there, step = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    longest, share = FAILED, 1.0
    for _ in range(MOST_STEPS):
        # for a constant in place of a value Numba compiles a function anew
        feel(model, snow, lines, state, longest > 0.0, longest < 0.0, start)
        channel_rows(model, lines, state, system.rows)
        if not factor(model, start, system.rows, NO_INERTIA, NO_INERTIA, system):
            return FAILED
        _look(model, snow, world, lines, state, start, system, room, calm, none, 0.0, to_go)
        before, left = longest, length(to_go)
        if left == 0.0:
            return 0.0
        begin(products, to_go)
        count, remains = 0, 1.0
        while remains > EXACT and count < MOST_PRODUCTS:
            way = NEARBY / _longest(products.direction[count])
            _look(model, snow, world, lines, state, start, system, room, calm, products.direction[count], way, there)
            for i in range(size):
                there[i] = (to_go[i] - there[i]) / way
            remains = take(products, count, there)
            count += 1
        solution(products, count, step)
        longest = _longest(step)
        share = min(1.0, 2.0 * share, LONGEST_STEP / longest)
        while share > LEAST_SHARE:
            _look(model, snow, world, lines, state, start, system, room, calm, step, share, there)
            if length(there) <= (1.0 - 0.1 * share) * left or longest < SMALL:
                break
            share *= 0.5
        if share <= LEAST_SHARE:
            break
        copy_pose(calm, state)
        if longest < SETTLED or (longest < SMALL and longest > 0.5 * before):
            break
    return longest


@compiled(**MAKING)
def _look(
    model: Model, snow: Snow, world: World, lines: Lines, state: State, start: Forces, system: Factored, room: Room,
    moved: State, step: FloatArray, share: float, to_go: FloatArray,
) -> None:  # fmt: skip
    """Fill `to_go` with the way to equilibrium that W sees (m), `moved` by a share of a step (m)."""
    vector, places = room.first, room.places
    _as_places(step, places)
    move(state, places.rigid, places.bend, share, moved)
    feel(model, snow, lines, moved, share > 2.0, share > 2.0, start)
    vector.rigid[:] = 0.0
    vector.bend[:] = 0.0
    add_forces(model, world, moved, start, 1.0, vector)
    for k in range(2):
        add_band(model.stiffness, moved.bend[k], -1.0, vector.bend[k])
    forwards(system, vector)
    _solve_free(system.corner, vector.rigid)
    backwards(system, vector)
    _as_metres(vector, to_go)


@compiled(**PLAIN, inline="always")
def _metres(unknown: int) -> float:
    """How far (m) one of an unknown of the rigid body or of the skis moves the base, about: angles have their arms."""
    if unknown < 6:
        return 1.0 if unknown < 3 else 0.5
    kind = unknown % 3
    return 1.0 if kind == 0 else 0.05 if kind == 1 else 0.03


@compiled(**PLAIN)
def _as_places(step: FloatArray, places: Vector) -> None:
    """Take a step (m) apart: rigid body and skis, each in its own unit."""
    n = (len(step) - 6) // 2
    for a in range(6):
        places.rigid[a] = step[a] / _metres(a)
    for k in range(2):
        for i in range(n):
            at = 6 + k * n + i
            places.bend[k, i + PADDING] = step[at] / _metres(at)


@compiled(**PLAIN)
def _as_metres(vector: Vector, out: FloatArray) -> None:
    """The other way round, for what W was solved for with its inertia."""
    n = (len(out) - 6) // 2
    for a in range(6):
        out[a] = NO_INERTIA * vector.rigid[a] * _metres(a)
    for k in range(2):
        for i in range(n):
            at = 6 + k * n + i
            out[at] = NO_INERTIA * vector.bend[k, i + PADDING] * _metres(at)


@compiled(**PLAIN)
def _longest(step: FloatArray) -> float:
    most = 0.0
    for i in range(len(step)):
        most = max(most, abs(step[i]))
    return most


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
