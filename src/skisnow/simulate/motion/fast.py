"""Fast mode: linearly implicit BDF2, order 2 whatever the tangent; one look at the snow and one solution a step.

With the last step's increments d₀ of the places and the forces F extrapolated to the step's end,

    M (3 v₁ - 4 v₀ + v₋₁)/(2h) = 2 F₀ - F₋₁ + ∂F/∂x (d₁ - d₀) + ∂F/∂v (v₁ - 2 v₀ + v₋₁),   3 d₁ - d₀ = 2h v₁.

Brought to v₁ - d₀/h, with β = 2h/3 and W = M - β ∂F/∂v - β² ∂F/∂x, the products with ∂F/∂x become products with the
constant M, and the matrix may be kept over several steps. Of the forces F only those but the skis' stiffness K and
damping δK are extrapolated: these are linear. A run begins with a step of the linearly implicit Euler method.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN
from .equations import add_forces, move
from .forces import Forces
from .model import PADDING, Model, State, World
from .system import Factored, Vector, add_band, add_mass, new_vector, solve

FloatArray: TypeAlias = npt.NDArray[np.float64]

REACH: Final = 2.0 / 3.0
"""β of the matrix, in steps."""


class Past(NamedTuple):
    """What a step hands on to the next, in the frame of the sledge at its end."""

    force: Vector  # but stiffness and damping, at the step's start
    velocity: Vector  # at the step's start
    moved: Vector  # increments of the places
    step: FloatArray  # (1,) its length (s), 0 at first
    sought: Vector  # working space
    rigid: FloatArray  # (6,) working space


def new_past(size: int) -> Past:
    """No step yet, for skis with that many unknowns."""
    vectors = [new_vector(size) for _ in range(4)]
    return Past(vectors[0], vectors[1], vectors[2], np.zeros(1), vectors[3], np.zeros(6))


@compiled(**PLAIN, fastmath={"contract"})
def fast_step(  # noqa: PLR0912 - one pass over the unknowns for each of its sums
    model: Model, world: World, state: State, start: Forces, system: Factored, h: float, past: Past, out: State
) -> None:  # fmt: skip
    """Fill `out` with the state after a step h (s) from the forces in `start`, with the factors of W in `system`.

    W has β = 2h/3 where the last step in `past` had the same length, else β = h: Euler's.
    """
    again = past.step[0] == h
    reach = REACH * h if again else h
    back = 1.0 / h if again else 0.0
    new, old = (2.0 * reach, -reach) if again else (reach, 0.0)
    w0, w1 = (4.0 / 3.0, -1.0 / 3.0) if again else (1.0, 0.0)
    sought, moved, before, force = past.sought, past.moved, past.velocity, past.force
    for a in range(6):
        sought.rigid[a] = old * force.rigid[a]
        past.rigid[a] = w0 * state.velocity[a] + w1 * before.rigid[a] - back * moved.rigid[a]
        force.rigid[a] = 0.0
    padded = state.bend.shape[1]
    bend = out.bend  # working space until the end
    for k in range(2):
        for i in range(padded):
            sought.bend[k, i] = old * force.bend[k, i]
            before.bend[k, i] = w0 * state.bend_rate[k, i] + w1 * before.bend[k, i] - back * moved.bend[k, i]
            force.bend[k, i] = 0.0
            bend[k, i] = state.bend[k, i]
            if again:
                bend[k, i] += (1.0 + model.damping / h) * moved.bend[k, i]
    add_forces(model, world, state, start, 1.0, force)
    add_mass(model, past.rigid, before.bend, 1.0, sought)
    for a in range(6):
        sought.rigid[a] += new * force.rigid[a]
    for k in range(2):
        for i in range(PADDING, padded - PADDING):
            sought.bend[k, i] += new * force.bend[k, i]
        add_band(model.stiffness, bend[k], -reach, sought.bend[k])
    solve(system, sought)
    keep, share = (1.0 / 3.0, 2.0 * h / 3.0) if again else (0.0, h)
    for a in range(6):
        out.velocity[a] = sought.rigid[a] + back * moved.rigid[a]
        before.rigid[a] = state.velocity[a]
    for k in range(2):
        for i in range(PADDING, padded - PADDING):
            out.bend_rate[k, i] = sought.bend[k, i] + back * moved.bend[k, i]
            before.bend[k, i] = state.bend_rate[k, i]
            moved.bend[k, i] = share * out.bend_rate[k, i] + keep * moved.bend[k, i]
    v, d = out.velocity, moved.rigid
    for a in range(3, 6):
        d[a] = share * v[a] + keep * d[a]
    x, y, z = d[3], d[4], d[5]
    if again:  # the velocity at the end, in the frame of the start
        v0, v1, v2 = _turned(x, y, z, v[0], v[1], v[2])
    else:
        v0, v1, v2 = v[0], v[1], v[2]
    d[0], d[1], d[2] = share * v0 + keep * d[0], share * v1 + keep * d[1], share * v2 + keep * d[2]
    move(state, d, moved.bend, 1.0, out)
    d[0], d[1], d[2] = _turned(-x, -y, -z, d[0], d[1], d[2])
    past.step[0] = h


@compiled(**PLAIN, inline="always")
def _turned(x: float, y: float, z: float, v0: float, v1: float, v2: float) -> tuple[float, float, float]:
    """A vector turned by a small rotation vector, to its second order."""
    a0, a1, a2 = y * v2 - z * v1, z * v0 - x * v2, x * v1 - y * v0
    return (
        v0 + a0 + 0.5 * (y * a2 - z * a1),
        v1 + a1 + 0.5 * (z * a0 - x * a2),
        v2 + a2 + 0.5 * (x * a1 - y * a0),
    )
