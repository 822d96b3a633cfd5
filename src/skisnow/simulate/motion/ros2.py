"""ROS2: linearly implicit Runge-Kutta method of order 2, whatever the tangent; damps stiff modes (L-stable).

Source: Verwer, Spee, Blom and Hundsdorfer (1999), SIAM J. Sci. Comput. 20: γ = 1 - 1/√2,
(I - γhJ) k₁ = f(y), (I - γhJ) k₂ = f(y + h k₁) - 2 k₁, y ← y + h (3 k₁ + k₂)/2.

Here M v' = F(x, v), x' = v, the matrix is W = M - γh ∂F/∂v - γ²h² ∂F/∂x. With k₁ + v/(γh) and k₂ + a/(γh),
a = x'₁ - 2 k₁ₓ, as the unknowns, the products with ∂F/∂x become products with the constant M. The turn of the sledge is
a rotation vector from the start of the step.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN
from .equations import add_forces, move
from .forces import Forces, feel
from .lines import Lines
from .model import PADDING, Model, Snow, State, World, new_state
from .system import Factored, Vector, add_band, add_mass, new_vector, solve

FloatArray: TypeAlias = npt.NDArray[np.float64]

GAMMA: Final = 1.0 - 1.0 / 2.0**0.5


class Room(NamedTuple):
    """Working space of a step."""

    first: Vector
    second: Vector
    places: Vector
    weights: Vector
    middle: State


def new_room(size: int) -> Room:
    """Room for skis with that many unknowns."""
    return Room(new_vector(size), new_vector(size), new_vector(size), new_vector(size), new_state(size))


@compiled(**PLAIN, fastmath={"contract"})
def ros2_step(
    model: Model, snow: Snow, world: World, lines: Lines, state: State, start: Forces, stage: Forces,
    system: Factored, h: float, room: Room, out: State,
) -> None:  # fmt: skip
    """Fill `out` with the state after a step h (s) from the forces in `start`, with the factors of W in `system`."""
    gh = GAMMA * h
    padded = state.bend.shape[1]
    first, second, places, weights, middle = room.first, room.second, room.places, room.weights, room.middle
    first.rigid[:] = 0.0
    first.bend[:] = 0.0
    add_forces(model, world, state, start, 1.0, first)
    add_mass(model, state.velocity, state.bend_rate, 1.0 / gh, first)
    add_band(model.stiffness, state.bend[0], -1.0, first.bend[0])
    add_band(model.stiffness, state.bend[1], -1.0, first.bend[1])
    solve(system, first)
    # now first = k₁ + v/(γh): the places' part of k₁ is γh times it, the velocities after the stage v + h k₁
    V = state.velocity
    for a in range(6):
        places.rigid[a] = gh * first.rigid[a]
        first.rigid[a] -= V[a] / gh
        middle.velocity[a] = V[a] + h * first.rigid[a]
    for k in range(2):
        for i in range(PADDING, padded - PADDING):
            places.bend[k, i] = gh * first.bend[k, i]
            first.bend[k, i] -= state.bend_rate[k, i] / gh
            middle.bend_rate[k, i] = state.bend_rate[k, i] + h * first.bend[k, i]
    move(state, places.rigid, places.bend, h, middle)
    neither = h < 0.0  # for a constant Numba compiles a function anew
    feel(model, snow, lines, middle, neither, neither, stage)
    # a = x'₁ - 2 k₁ₓ; x'₁ to second order in the rotation vector
    sought, p = room.weights, places
    v, q0, q1, q2 = middle.velocity, h * p.rigid[3], h * p.rigid[4], h * p.rigid[5]
    sought.rigid[0] = v[0] + q1 * v[2] - q2 * v[1] - 2.0 * p.rigid[0]
    sought.rigid[1] = v[1] + q2 * v[0] - q0 * v[2] - 2.0 * p.rigid[1]
    sought.rigid[2] = v[2] + q0 * v[1] - q1 * v[0] - 2.0 * p.rigid[2]
    sought.rigid[3] = v[3] + 0.5 * (q1 * v[5] - q2 * v[4]) - 2.0 * p.rigid[3]
    sought.rigid[4] = v[4] + 0.5 * (q2 * v[3] - q0 * v[5]) - 2.0 * p.rigid[4]
    sought.rigid[5] = v[5] + 0.5 * (q0 * v[4] - q1 * v[3]) - 2.0 * p.rigid[5]
    second.rigid[:] = 0.0
    second.bend[:] = 0.0
    add_forces(model, world, middle, stage, 1.0, second)
    damping = 2.0 * model.damping
    for k in range(2):
        for i in range(PADDING, padded - PADDING):
            middle.bend[k, i] += damping * p.bend[k, i]
        add_band(model.stiffness, middle.bend[k], -1.0, second.bend[k])
        for i in range(PADDING, padded - PADDING):
            middle.bend[k, i] = (middle.bend_rate[k, i] - 2.0 * p.bend[k, i]) / gh - 2.0 * first.bend[k, i]
    for b in range(6):
        middle.velocity[b] = sought.rigid[b] / gh - 2.0 * first.rigid[b]
    add_mass(model, middle.velocity, middle.bend, 1.0, second)
    solve(system, second)
    # second = k₂ + a/(γh); the places' part of k₂ is γh times it
    for b in range(6):
        weights.rigid[b] = 1.5 * p.rigid[b] + 0.5 * gh * second.rigid[b]
        k2 = second.rigid[b] - (middle.velocity[b] + 2.0 * first.rigid[b])
        out.velocity[b] = V[b] + h * (1.5 * first.rigid[b] + 0.5 * k2)
    for k in range(2):
        for i in range(PADDING, padded - PADDING):
            weights.bend[k, i] = 1.5 * p.bend[k, i] + 0.5 * gh * second.bend[k, i]
            k2 = second.bend[k, i] - (middle.bend[k, i] + 2.0 * first.bend[k, i])
            out.bend_rate[k, i] = state.bend_rate[k, i] + h * (1.5 * first.bend[k, i] + 0.5 * k2)
    move(state, weights.rigid, weights.bend, h, out)
