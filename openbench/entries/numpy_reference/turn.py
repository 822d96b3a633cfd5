"""The turn in NumPy: a rigid body by the velocity form of Verlet's method, equal steps, one look at the snow each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .ground import Ground, Shape

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Fineness:
    """Step (s), spacing of lines and cells on them (m)."""

    step: float
    spacing: float
    cell: float


def solve(case: dict[str, Any], fineness: Fineness) -> dict[str, list[float] | None]:
    """Place, heading and speed at the times, on each snow."""
    rows = [row for ratio in case["snow"]["unloading_ratio_1"] for row in run(case, fineness, ratio)]
    return {
        "place_m": [v for x, y, _, _ in rows for v in (x, y)],
        "heading_rad": [heading for _, _, heading, _ in rows],
        "speed_m_per_s": [speed for *_, speed in rows],
    }


class Sledge:
    """Place, axes and motion of the body, and the snow under it."""

    def __init__(self, case: dict[str, Any], fineness: Fineness, ratio: float) -> None:
        body, motion = case["body"], case["motion"]
        slope = math.radians(motion["slope_deg"])
        self.mass, self.inertia = float(body["mass_kg"]), np.array(body["inertia_kg_m2"])
        self.gravity = motion["gravity_m_per_s2"] * np.array([math.sin(slope), 0.0, -math.cos(slope)])
        self.drag, self.boots = body["drag_kg_per_m"], np.array(body["boots_m"])
        angle = math.radians(body["edge_angle_deg"])
        c, s = math.cos(angle), math.sin(angle)
        self.edged = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
        self.place, self.axes = (
            np.array(motion["start_place_m"]),
            about(np.array([0.0, 0.0, math.radians(motion["start_heading_deg"])])),
        )
        self.velocity, self.turning = motion["start_speed_m_per_s"] * self.axes[:, 0], np.zeros(3)
        snow = case["snow"] | {"unloading_ratio_1": ratio}
        far = (
            motion["start_speed_m_per_s"] * motion["time_s"][-1]
            + 0.5 * 9.81 * math.sin(slope) * motion["time_s"][-1] ** 2
        )
        self.ground = Ground(
            Shape.of(body), snow, len(self.boots), ends=(-1.5, far + 1.5), spacing=fineness.spacing, cell=fineness.cell
        )
        self.pushed, self.turned = self.felt()

    def felt(self) -> tuple[FloatArray, FloatArray]:
        """Acceleration and angular acceleration where it is; the snow takes note."""
        arms = self.boots @ self.axes.T
        moves = np.column_stack([self.velocity + np.cross(self.turning, arms), np.tile(self.turning, (len(arms), 1))])
        turned = np.tile(self.axes @ self.edged, (len(arms), 1, 1))
        points, forces = self.ground.act(self.place + arms, turned, moves)
        drag = -self.drag * np.linalg.norm(self.velocity) * self.velocity
        push = self.gravity + (forces.sum(axis=0) + drag) / self.mass
        own = self.axes.T @ np.cross(points - self.place, forces).sum(axis=0)
        spin = self.axes.T @ self.turning
        return push, self.axes @ ((own - np.cross(spin, self.inertia * spin)) / self.inertia)

    def step(self, h: float) -> None:
        """Place by the acceleration at the start, velocity by the mean of both ends."""
        push, turn, velocity, turning = self.pushed, self.turned, self.velocity, self.turning
        self.place = self.place + h * velocity + 0.5 * h * h * push
        self.axes = about(h * turning + 0.5 * h * h * turn) @ self.axes
        self.velocity, self.turning = velocity + h * push, turning + h * turn
        self.pushed, self.turned = self.felt()
        self.velocity, self.turning = (
            velocity + 0.5 * h * (push + self.pushed),
            turning + 0.5 * h * (turn + self.turned),
        )


def run(case: dict[str, Any], fineness: Fineness, ratio: float) -> list[tuple[float, float, float, float]]:
    """x, y, heading and speed at the times."""
    sledge, rows, now = Sledge(case, fineness, ratio), [], 0.0
    for time in case["motion"]["time_s"]:
        steps = round((time - now) / fineness.step)
        for _ in range(steps):
            sledge.step((time - now) / steps)
        now = time
        heading = math.atan2(sledge.axes[1, 0], sledge.axes[0, 0])
        rows.append((float(sledge.place[0]), float(sledge.place[1]), heading, float(np.linalg.norm(sledge.velocity))))
    return rows


def about(turn: FloatArray) -> FloatArray:
    """Rotation about a vector by its length (rad), Rodrigues."""
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = turn / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)
