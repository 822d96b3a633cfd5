"""Equations of motion of sledge and skis: everything that accelerates them, but for the skis' stiffness and damping.

Velocities are those of the sledge's frame (Hamel's equations): with the momentum p and the angular momentum L about
the moving origin, p' = f - ω × p and L' = τ - ω × L - v × p. The mass matrix is constant; of the kinetic energy's
dependence on the bend its largest part is kept, the momentum of a bent ski that turns: the skis feel v × ω, whatever
the frame they are seen from.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN
from .forces import Forces
from .lines import Lines
from .model import PADDING, Model, State, World
from .system import Vector
from .tangent import CHANNELS

FloatArray: TypeAlias = npt.NDArray[np.float64]


@compiled(**PLAIN, fastmath={"contract"})
def add_forces(model: Model, world: World, state: State, snow: Forces, scale: float, out: Vector) -> None:
    """Add scale × all generalised forces but stiffness and damping."""
    R, v = state.turn, state.velocity
    g = world.gravity
    g0 = R[0, 0] * g[0] + R[1, 0] * g[1] + R[2, 0] * g[2]
    g1 = R[0, 1] * g[0] + R[1, 1] * g[1] + R[2, 1] * g[2]
    g2 = R[0, 2] * g[0] + R[1, 2] * g[1] + R[2, 2] * g[2]
    p0, p1, p2, p3, p4, p5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(6):
        M, u = model.rigid[b], v[b]
        p0, p1, p2, p3, p4, p5 = (
            p0 + M[0] * u, p1 + M[1] * u, p2 + M[2] * u, p3 + M[3] * u, p4 + M[4] * u, p5 + M[5] * u
        )  # fmt: skip
    # gravity, and what the skis feel of the turning of the velocity: v × ω
    w0, w1, w2 = g0 + v[1] * v[5] - v[2] * v[4], g1 + v[2] * v[3] - v[0] * v[5], g2 + v[0] * v[4] - v[1] * v[3]
    b0, b1, b2 = 0.0, 0.0, 0.0
    for k in range(2):
        B, bend, rate = model.coupling[k], out.bend[k], state.bend_rate[k]
        for i in range(len(B)):
            u = rate[i + PADDING]
            b0 += B[i, 0] * u
            b1 += B[i, 1] * u
            b2 += B[i, 2] * u
            p3 += B[i, 3] * u
            p4 += B[i, 4] * u
            p5 += B[i, 5] * u
            bend[i + PADDING] += scale * (snow.bend[k, i + PADDING] + B[i, 0] * w0 + B[i, 1] * w1 + B[i, 2] * w2)
    # its counterpart on the sledge: -ω × b on the velocity, v × b on the turning, with b the momentum of bending
    out.rigid[0] -= scale * (v[4] * b2 - v[5] * b1)
    out.rigid[1] -= scale * (v[5] * b0 - v[3] * b2)
    out.rigid[2] -= scale * (v[3] * b1 - v[4] * b0)
    out.rigid[3] += scale * (v[1] * b2 - v[2] * b1)
    out.rigid[4] += scale * (v[2] * b0 - v[0] * b2)
    out.rigid[5] += scale * (v[0] * b1 - v[1] * b0)
    p0, p1, p2 = p0 + b0, p1 + b1, p2 + b2
    m, c = model.total_mass, model.first_moment
    # air drag at the centre of pressure
    high = world.drag_height
    a0, a1, a2 = v[0] + v[4] * high, v[1] - v[3] * high, v[2]
    speed = np.sqrt(a0 * a0 + a1 * a1 + a2 * a2)
    drag = -world.drag * speed
    out.rigid[0] += scale * (snow.rigid[0] + m * g0 + drag * a0 - (v[4] * p2 - v[5] * p1))
    out.rigid[1] += scale * (snow.rigid[1] + m * g1 + drag * a1 - (v[5] * p0 - v[3] * p2))
    out.rigid[2] += scale * (snow.rigid[2] + m * g2 + drag * a2 - (v[3] * p1 - v[4] * p0))
    out.rigid[3] += scale * (
        snow.rigid[3] + c[1] * g2 - c[2] * g1 - high * drag * a1
        - (v[4] * p5 - v[5] * p4) - (v[1] * p2 - v[2] * p1)
    )  # fmt: skip
    out.rigid[4] += scale * (
        snow.rigid[4] + c[2] * g0 - c[0] * g2 + high * drag * a0
        - (v[5] * p3 - v[3] * p5) - (v[2] * p0 - v[0] * p2)
    )  # fmt: skip
    out.rigid[5] += scale * (snow.rigid[5] + c[0] * g1 - c[1] * g0 - (v[3] * p4 - v[4] * p3) - (v[0] * p1 - v[1] * p0))


@compiled(**PLAIN)
def drag_power(world: World, velocity: FloatArray) -> float:
    """Power (W) that the air takes at the centre of pressure."""
    high = world.drag_height
    a0, a1, a2 = velocity[0] + velocity[4] * high, velocity[1] - velocity[3] * high, velocity[2]
    return world.drag * (a0 * a0 + a1 * a1 + a2 * a2) ** 1.5


@compiled(**PLAIN)
def channel_rows(model: Model, lines: Lines, state: State, rows: FloatArray) -> None:
    """Fill in how depth, roll and place across of each ski's sections follow from the rigid body: (2, CHANNELS, 6)."""
    ring = len(lines.flag) // 2
    R = state.turn
    for k in range(2):
        row = k * ring + (lines.first[k] + lines.count[k] // 2) % ring
        m0, m1, m2 = lines.frame[row, 9], lines.frame[row, 10], lines.frame[row, 11]
        n0 = R[0, 0] * m0 + R[1, 0] * m1 + R[2, 0] * m2
        n1 = R[0, 1] * m0 + R[1, 1] * m1 + R[2, 1] * m2
        n2 = R[0, 2] * m0 + R[1, 2] * m1 + R[2, 2] * m2
        size = 1.0 / np.sqrt(n1 * n1 + n2 * n2)
        t1, t2 = n2 * size, -n1 * size  # n × forwards
        y, z = model.middle[k, 1], model.middle[k, 2]
        for a in range(CHANNELS):
            for b in range(6):
                rows[k, a, b] = 0.0
        rows[k, 0, 0], rows[k, 0, 1], rows[k, 0, 2] = -n0, -n1, -n2
        rows[k, 3, 1], rows[k, 3, 2] = t1, t2
        rows[k, 0, 3], rows[k, 0, 4], rows[k, 0, 5] = -(y * n2 - z * n1), -z * n0, y * n0
        rows[k, 3, 3] = y * t2 - z * t1
        rows[k, 1, 4], rows[k, 1, 5] = n2, -n1
        rows[k, 2, 3] = -1.0
        rows[k, 4, 4], rows[k, 4, 5] = -t2, t1
        # forwards: t × n
        d0, d1, d2 = t1 * n2 - t2 * n1, t2 * n0, -t1 * n0
        rows[k, 5, 0], rows[k, 5, 1], rows[k, 5, 2] = d0, d1, d2
        rows[k, 5, 3], rows[k, 5, 4], rows[k, 5, 5] = y * d2 - z * d1, z * d0, -y * d0


@compiled(**PLAIN, fastmath={"contract"})
def move(state: State, rigid: FloatArray, bend: FloatArray, scale: float, out: State) -> None:
    """Fill `out` with place, turn and bend after scale × the increments, in the frame of `state`."""
    R = state.turn
    for a in range(3):
        out.place[a] = state.place[a] + scale * (R[a, 0] * rigid[0] + R[a, 1] * rigid[1] + R[a, 2] * rigid[2])
    x, y, z = scale * rigid[3], scale * rigid[4], scale * rigid[5]
    angle2 = x * x + y * y + z * z
    if angle2 > 1e-8:
        angle = np.sqrt(angle2)
        s, c = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle2
    else:  # the next terms are below 1e-18
        s, c = 1.0 - angle2 / 6.0, 0.5 - angle2 / 24.0
    a00, a11, a22 = 1.0 - c * (y * y + z * z), 1.0 - c * (x * x + z * z), 1.0 - c * (x * x + y * y)
    a01, a10 = c * x * y - s * z, c * x * y + s * z
    a02, a20 = c * x * z + s * y, c * x * z - s * y
    a12, a21 = c * y * z - s * x, c * y * z + s * x
    for a in range(3):
        b0, b1, b2 = R[a, 0], R[a, 1], R[a, 2]
        out.turn[a, 0] = b0 * a00 + b1 * a10 + b2 * a20
        out.turn[a, 1] = b0 * a01 + b1 * a11 + b2 * a21
        out.turn[a, 2] = b0 * a02 + b1 * a12 + b2 * a22
    for k in range(2):
        for i in range(bend.shape[1]):
            out.bend[k, i] = state.bend[k, i] + scale * bend[k, i]


@compiled(**PLAIN)
def copy_pose(source: State, target: State) -> None:
    """Copy place, turn and bend. Loops: Numba compiles the assignment of arrays together with words for its errors."""
    for a in range(3):
        target.place[a] = source.place[a]
        for b in range(3):
            target.turn[a, b] = source.turn[a, b]
    for k in range(2):
        for i in range(source.bend.shape[1]):
            target.bend[k, i] = source.bend[k, i]


@compiled(**PLAIN)
def copy_state(source: State, target: State) -> None:
    """Copy a state."""
    copy_pose(source, target)
    for a in range(6):
        target.velocity[a] = source.velocity[a]
    for k in range(2):
        for i in range(source.bend_rate.shape[1]):
            target.bend_rate[k, i] = source.bend_rate[k, i]
