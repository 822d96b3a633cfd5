"""Fast mode: linearly implicit Euler, order 1; one look at the snow and one solution a step.

The matrix is kept over several steps. (M - h ∂F/∂v - h² ∂F/∂x) (v₁ - v₀) = h F + h² ∂F/∂x v₀ and x₁ = x₀ + h v₁.
Brought to v₁, damping and tangent drop out of the right side: W v₁ = M v₀ + h (F - K u₀), with F all forces
but stiffness and damping of the skis.
"""

from __future__ import annotations

from typing import Final

import numba

from .equations import add_forces, move
from .forces import Forces
from .model import PADDING, Model, State, World
from .ros2 import Room
from .system import Factored, add_band, add_mass, solve

STEPS_PER_TANGENT: Final = 4
"""Steps over which the matrix is kept."""


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def fast_step(
    model: Model, world: World, state: State, start: Forces, system: Factored, h: float, room: Room, out: State
) -> None:
    """Fill `out` with the state after a step h (s) from the forces in `start`, with the factors of W in `system`."""
    vector = room.first
    vector.rigid[:] = 0.0
    vector.bend[:] = 0.0
    add_forces(model, world, state, start, h, vector)
    add_mass(model, state.velocity, state.bend_rate, 1.0, vector)
    add_band(model.stiffness, state.bend[0], -h, vector.bend[0])
    add_band(model.stiffness, state.bend[1], -h, vector.bend[1])
    solve(system, vector)
    for a in range(6):
        out.velocity[a] = vector.rigid[a]
    for k in range(2):
        for i in range(PADDING, state.bend.shape[1] - PADDING):
            out.bend_rate[k, i] = vector.bend[k, i]
    move(state, vector.rigid, vector.bend, h, out)
