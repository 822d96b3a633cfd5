"""How long a step may be where snow and body take turns, as programs do that couple FMUs: by the snow's hardness.

    python examples/explicit_coupling.py

A rigid sledge of 80 kg glides on two skis, flat or on their edges. The contact says what acts at the poses at a step's
beginning; by semi-implicit Euler the body goes on with that ("in turn"), or with what acted a step before ("at once").
Printed is the longest step of a ladder with which the force on the skis swings by less than a tenth of the weight.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skisnow.contact import Runner, SnowContact, SnowField

FloatArray = npt.NDArray[np.float64]
MASS, INERTIA, SPEED = 80.0, np.array([3.0, 6.0, 8.0]), 8.0
GRAVITY = 9.81
HEIGHT, STANCE = 0.2, 0.5  # of the centre of mass over the bases, between the boots (m)
HARDNESSES = (0.04, 0.2, 1.0, 10.0, 90.0)  # N/mm³: soft piste to ice
LADDER = [2.0 / 2**k for k in range(6)]  # ms
DURATION, SWING, EDGED = 0.4, 0.1, math.radians(45.0)
ALONG = np.array([0.8, 0.7, -0.8])
FEET = np.array([[0.0, side * STANCE / 2.0, -HEIGHT] for side in (1.0, -1.0)])


def turned(axes: FloatArray, by: FloatArray) -> FloatArray:
    """Axes after a rotation, by Cayley's formula, which keeps them orthonormal."""
    half = np.cross(np.eye(3), 0.5 * by)
    return np.linalg.solve(np.eye(3) - half, np.eye(3) + half) @ axes


def swing(hardness: float, step: float, *, edge_angle: float, late: bool) -> float:
    """Standard deviation of the force on the skis over the weight, in the second half of a run."""
    runner = Runner(ALONG, np.full(3, 0.035), np.array([0.02, 0.0, 0.0]))  # the tip bends up
    load, length = MASS * GRAVITY / 2.0, float(ALONG[1] - ALONG[2])
    depth = load / (hardness * 1e9 * length * 0.07)  # at rest
    if edge_angle:
        depth = math.sqrt(2.0 * load * math.tan(edge_angle) / (hardness * 1e9 * length))
    contact = SnowContact(SnowField(hardness * 1e9, 5e5, 10.0), [runner, runner])
    c, s = math.cos(edge_angle), math.sin(edge_angle)
    edged = np.array([[[1, 0, 0], [0, c, k * s], [0, -k * s, c]] for k in (1.0, -1.0)])  # both on their inner edges
    place, axes, motion = (
        np.array([0.0, 0.0, HEIGHT + 0.035 * s - depth]),
        np.eye(3),
        np.array([SPEED, 0, 0, 0, 0, 0.0]),
    )
    before, forces = np.array([0.0, 0.0, MASS * GRAVITY, 0.0, 0.0, 0.0]), []
    for _ in range(round(DURATION / step)):
        arms = FEET @ axes.T
        moves = np.column_stack([motion[:3] + np.cross(motion[3:], arms), np.tile(motion[3:], (2, 1))])
        found = contact.force(place + arms, axes @ edged, moves, step).wrench
        contact.update(place + arms, axes @ edged, step)
        now = np.concatenate([found[:, :3].sum(0), (found[:, 3:] + np.cross(arms, found[:, :3])).sum(0)])
        acts = before if late else now
        motion = motion + step * (acts / np.array([MASS] * 3 + INERTIA.tolist()) - np.array([0, 0, GRAVITY, 0, 0, 0]))
        place, axes, before = place + step * motion[:3], turned(axes, step * motion[3:]), now
        forces.append(now[2] / (MASS * GRAVITY))
        if not abs(place[2]) < 1.0:
            return math.inf
    return float(np.std(forces[len(forces) // 2 :]))


def longest_step(hardness: float, *, edge_angle: float, late: bool) -> float | None:
    """The longest step (ms) that serves, None where it would be below the ladder."""
    served = (ms for ms in LADDER if swing(hardness, 1e-3 * ms, edge_angle=edge_angle, late=late) < SWING)
    return next(served, None)


def table() -> str:
    """Of all hardnesses."""
    rows = ["H_V (N/mm³)   flat, in turn   flat, at once   45°, in turn   45°, at once   (ms)"]
    for hardness in HARDNESSES:
        found = [
            longest_step(hardness, edge_angle=angle, late=late) for angle in (0.0, EDGED) for late in (False, True)
        ]
        said = [f"below {LADDER[-1]:.2g}" if each is None else f"{each:.2g}" for each in found]
        rows.append("{:>11g} {:>15} {:>15} {:>14} {:>14}".format(hardness, *said))
    return "\n".join(rows)


if __name__ == "__main__":
    print(table())
