"""A rigid sledge of one's own on two runners: implicit Euler around `SnowContact`, 2 m down a slope of 10 degrees.

    python examples/rigid_sledge_on_contact.py

Prints speed and energies. On a straight glide v² = v₀² + 2 g (sin α - μ cos α) s.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skisnow.contact import Runner, SnowContact, SnowField

FloatArray = npt.NDArray[np.float64]
SLOPE, FRICTION, HARDNESS, START = math.radians(10.0), 0.05, 2e8, 1.0
MASS, INERTIA, DT = 60.0, [3.0, 6.0, 8.0], 1e-3
GRAVITY = 9.81 * np.array([math.sin(SLOPE), 0.0, -math.cos(SLOPE)])  # x down the slope, z out of the snow
FEET = np.array([[0.0, 0.2, -0.1], [0.0, -0.2, -0.1]])  # of the boots from the centre of mass
ALONG = np.array([0.6, 0.4, -0.5])
RUNNER = Runner(ALONG, np.full(3, 0.03), np.array([0.02, 0.0, 0.0]))  # the tip bends up


def moved(place: FloatArray, turned: FloatArray, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The pose a step later; the rotation by Cayley's formula, which keeps it one."""
    half = np.cross(np.eye(3), 0.5 * DT * motion[3:])
    return place + DT * motion[:3], np.linalg.solve(np.eye(3) - half, np.eye(3) + half) @ turned


def glide(length: float) -> list[tuple[float, float, float, float]]:
    """Way (m), speed (m/s), energy of motion and place (J), work of friction (J), each step."""
    contact = SnowContact(SnowField(HARDNESS, 3e5, 10.0, friction=FRICTION), [RUNNER, RUNNER])
    sinks = MASS * 9.81 * math.cos(SLOPE) / (2 * HARDNESS * 0.06 * 0.9)
    place, turned, motion = np.array([0.0, 0.0, 0.1 - sinks]), np.eye(3), np.array([START, 0, 0, 0, 0, 0.0])
    inertia, rows, work = np.diag([MASS] * 3 + INERTIA), [], 0.0  # of a sledge that hardly turns
    while place[0] < length:
        new, matrix = motion.copy(), None
        for _ in range(3):  # Newton's iterations at the end of the step
            there, turns = moved(place, turned, new)
            arms = FEET @ turns.T
            of_boots = [
                np.block([[np.eye(3), -np.cross(np.eye(3), arm)], [np.zeros((3, 3)), np.eye(3)]]) for arm in arms
            ]
            asked = there + arms, np.array([turns, turns]), np.array([j @ new for j in of_boots]), DT
            if matrix is None:
                tangents = zip(of_boots, *contact.tangent(*asked), strict=True)
                matrix = inertia + sum(
                    j.T @ (DT * damping + DT**2 * stiffness) @ j for j, stiffness, damping in tangents
                )
            forces = zip(of_boots, contact.force(*asked).wrench, strict=True)
            force = np.append(MASS * GRAVITY, np.zeros(3)) + sum(j.T @ wrench for j, wrench in forces)
            new += np.linalg.solve(matrix, DT * force - inertia @ (new - motion))
        (place, turned), motion = moved(place, turned, new), new
        contact.update(place + FEET @ turned.T, np.array([turned, turned]), DT)
        sections = (contact.sections(0), contact.sections(1))
        rubbed = (s.mu * s.normal_force * (s.rub * s.sliding + s.rub_aside * s.sliding_aside) for s in sections)
        work += DT * float(sum(np.sum(each) for each in rubbed))
        rows.append((place[0], motion[0], 0.5 * motion @ inertia @ motion - MASS * GRAVITY @ place, work))
    return rows


if __name__ == "__main__":
    print("way (m)  speed (m/s)  kinetic and potential energy (J)  lost to friction (J)")
    for row in glide(2.0)[::50]:
        print("{:7.3f}  {:11.4f}  {:32.3f}  {:20.3f}".format(*row))
