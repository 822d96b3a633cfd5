"""Snow that remembers, under rigid runners: lines across x that never move, on each of them cells along y.

Written for this set from the words of the cases alone. Lines x = (j + 1/2) Δ stand in space; each holds, over a window
around the place where a runner first met it, the largest depth so far of every cell. Runners do not meet each other's
tracks, and a runner's heading stays well away from y.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

Older: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray]
"""Depth (m) that the snow was pressed to before, by place x, y (m)."""

BLEND = float(np.sin(np.radians(2.0)))
"""Sine of the edge angle below which neither edge is the deeper one: the place of the shear moves to the middle."""
FADE = 0.01
"""Speed (m/s) below which friction fades."""


@dataclass(frozen=True)
class Shape:
    """A runner's tables from tail to tip: half width, height of the base, and their slopes along it."""

    station: FloatArray
    half_width: FloatArray
    height: FloatArray

    @classmethod
    def of(cls, body: dict[str, Any]) -> Shape:
        """From the tables of a case, which fall from tip to tail."""
        rows = [np.array(body[key])[::-1] for key in ("station_m", "width_m", "base_height_m")]
        return cls(rows[0], rows[1] / 2.0, rows[2])

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Half width, height, and the slope of each: straight between stations."""
        i = np.clip(np.searchsorted(self.station, s, side="right") - 1, 0, len(self.station) - 2)
        gap = self.station[i + 1] - self.station[i]
        z = s - self.station[i]
        flare = (self.half_width[i + 1] - self.half_width[i]) / gap
        rise = (self.height[i + 1] - self.height[i]) / gap
        return self.half_width[i] + flare * z, self.height[i] + rise * z, flare, rise


@dataclass
class Cut:
    """Where base and lines meet; one row for each line of each runner."""

    runner: IntArray
    line: IntArray
    share: FloatArray  # of the line's spacing that lies under the runner
    point: FloatArray  # of the deeper edge (n, 3)
    depth: FloatArray
    deepest: FloatArray  # of all across
    normal: FloatArray  # of the base, third component 1
    low: FloatArray
    high: FloatArray
    forward: FloatArray  # along the edge in the surface
    left: FloatArray


class Ground:
    """The memory of the snow, and its forces on runners of one shape."""

    def __init__(self, shape: Shape, snow: dict[str, float], runners: int, *, ends: tuple[float, float], spacing: float,
                 cell: float, window: float = 0.16, older: Older | None = None) -> None:  # fmt: skip
        self.shape, self.snow, self.runners, self.older = shape, snow, runners, older
        self.spacing, self.cell, self.met = spacing, cell, 0.0
        self.start = ends[0]
        lines, cells = int((ends[1] - ends[0]) / spacing) + 2, int(window / cell)
        self.memory = np.zeros((runners, lines, cells))
        self.first = np.full((runners, lines), np.iinfo(np.int64).min)
        self.anchor = np.full((runners, lines), np.nan)
        self.before = np.full((runners, lines, 2), np.nan)  # place and depth of the edge at the pose accepted last

    def meet(self, position: FloatArray, rotation: FloatArray) -> Cut:
        """Boots (k, 3) and rotations (k, 3, 3)."""
        parts = [self._meet(k, position[k], rotation[k]) for k in range(self.runners)]
        return Cut(*(np.concatenate([getattr(part, name) for part in parts]) for name in Cut.__dataclass_fields__))

    def _meet(self, k: int, c: FloatArray, rotation: FloatArray) -> Cut:
        x, t, r = rotation.T
        tail, tip = self.shape.station[[0, -1]]
        ends = np.sort([c[0] + tail * x[0], c[0] + tip * x[0]]) + np.array([-0.05, 0.05])
        lines = np.arange(int((ends[0] - self.start) / self.spacing), int((ends[1] - self.start) / self.spacing) + 1)
        at = self.start + (lines + 0.5) * self.spacing
        side = float(np.clip(-t[2] / BLEND, -1.0, 1.0))
        s = (at - c[0]) / x[0]
        for _ in range(4):
            half, height, _, _ = self.shape.at(s)
            s = s - (c[0] + s * x[0] + side * half * t[0] + height * r[0] - at) / x[0]
        length = self.spacing / abs(x[0])
        share = np.clip((tip - s) / length + 0.5, 0.0, 1.0) * np.clip((s - tail) / length + 0.5, 0.0, 1.0)
        met = share > 0.0
        s, lines, share = np.clip(s[met], tail, tip), lines[met], share[met]
        half, height, flare, rise = self.shape.at(s)
        axis = c + s[:, None] * x + height[:, None] * r
        point = axis + (side * half)[:, None] * t
        along = x + rise[:, None] * r + (side * flare)[:, None] * t
        normal = np.cross(along, t)
        normal = normal / normal[:, 2:]
        forward = along[:, :2] / np.linalg.norm(along[:, :2], axis=1)[:, None]
        wide = t[1] - along[:, 1] * t[0] / along[:, 0]
        depth, slope, y = -point[:, 2], normal[:, 1], point[:, 1]
        low, high = y - (1.0 + side) * half * wide, y + (1.0 - side) * half * wide
        with np.errstate(divide="ignore", invalid="ignore"):
            shore = y - depth / slope
        low = np.where(slope > 1e-12, np.maximum(low, shore), low)
        high = np.where(slope < -1e-12, np.minimum(high, shore), high)
        deepest = depth + half * (abs(t[2]) - side * -t[2])
        left = np.column_stack([-forward[:, 1], forward[:, 0]])
        return Cut(np.full(len(s), k), lines, share, point, depth, deepest, normal, low, high, forward, left)

    def act(self, position: FloatArray, rotation: FloatArray, velocity: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Accept a pose: what the snow does there, points (m) and forces (N), (m, 3) each."""
        cut = self.meet(position, rotation)
        force, offset = self._press(cut)
        grip = self._hold(cut)
        self.before[cut.runner, cut.line] = np.column_stack([cut.point[:, 1], cut.deepest])
        centre = cut.point + np.column_stack([0.0 * offset, offset, -cut.normal[:, 1] * offset])
        arm = centre - position[cut.runner]
        moves = velocity[cut.runner, :3] + np.cross(velocity[cut.runner, 3:], arm)
        sliding = np.sum(moves[:, :2] * cut.forward, axis=1)
        climb = np.sum(cut.normal[:, :2] * cut.forward, axis=1)
        rub = self.snow.get("friction_1", 0.0) * sliding / np.hypot(sliding, FADE)
        push = force * (climb - rub)
        pressed = np.column_stack([push[:, None] * cut.forward, force])
        held = np.column_stack([grip[:, None] * cut.left, 0.0 * grip])
        return np.concatenate([centre, cut.point]), np.concatenate([pressed, held])

    def _press(self, cut: Cut) -> tuple[FloatArray, FloatArray]:
        """Force of the pressure on each line (N), and how far from the edge it stands (m); the memory goes on."""
        hard, ratio = self.snow["snow_hardness_N_per_m3"], self.snow["unloading_ratio_1"]
        edge, before = cut.point[:, 1], self.before[cut.runner, cut.line]
        moved = (before[:, 1] > 0.0) & (cut.depth > 0.0)
        old = np.where(moved, before[:, 0], edge)
        wet = cut.high > cut.low
        low = np.floor(np.where(wet, np.minimum(cut.low, old), edge) / self.cell).astype(np.int64)
        high = np.floor(np.where(wet, np.maximum(cut.high, old), edge) / self.cell).astype(np.int64)
        number = low[:, None] + np.arange(int((high - low).max()) + 1)
        place = self._window(cut, number[:, 0], number[:, -1])[:, None] + np.arange(number.shape[1])
        a = np.maximum(number * self.cell, cut.low[:, None])
        b = np.minimum((number + 1) * self.cell, cut.high[:, None])
        wide = np.maximum(b - a, 0.0)
        depth = np.where(wide > 0.0, cut.depth[:, None] + cut.normal[:, 1:2] * (0.5 * (a + b) - edge[:, None]), -1.0)
        rows = cut.runner[:, None], cut.line[:, None], place
        deepest = np.maximum(self.memory[rows], depth)
        middle = (number + 0.5) * self.cell
        gone = edge - old
        with np.errstate(divide="ignore", invalid="ignore"):
            way = (middle - old[:, None]) / gone[:, None]
            path = before[:, 1:2] + way * (cut.depth - before[:, 1])[:, None]
        passed = moved[:, None] & (np.abs(gone) > 1e-12)[:, None] & (way > 0.0) & (way < 1.0)
        deepest = np.where(passed, np.maximum(deepest, path), deepest)
        pressure = np.maximum(hard * (deepest - ratio * (deepest - depth)), 0.0) * wide
        self.memory[rows] = deepest
        share = self.spacing * cut.share
        force = share * pressure.sum(axis=1)
        moment = share * np.sum(pressure * (0.5 * (a + b) - edge[:, None]), axis=1)
        return force, np.where(force > 0.0, moment / np.where(force > 0.0, force, 1.0), 0.0)

    def _window(self, cut: Cut, low: IntArray, high: IntArray) -> IntArray:
        """Column of the memory at which the cells of each line begin."""
        first = self.first[cut.runner, cut.line]
        cells = self.memory.shape[2]
        new = first == np.iinfo(np.int64).min
        first = np.where(new, (low + high - cells) // 2, first)
        self.first[cut.runner, cut.line] = first
        if self.older is not None and new.any():
            self._remember(cut.runner[new], cut.line[new])
        if np.any(low < first) or np.any(high >= first + cells):
            raise RuntimeError("a runner slips out of the window of snow that is remembered")
        return low - first

    def _remember(self, runner: IntArray, line: IntArray) -> None:
        assert self.older is not None
        x = (self.start + (line + 0.5) * self.spacing)[:, None]
        y = (self.first[runner, line][:, None] + np.arange(self.memory.shape[2]) + 0.5) * self.cell
        self.memory[runner, line] = before = self.older(np.asarray(x, float), np.asarray(y, float))
        self.met += float(np.sum(before**2))

    def groove(self, low: float, high: float) -> FloatArray:
        """Largest depth (m) on each line between two places x (m)."""
        return np.asarray(self._between(low, high).max(axis=2)[0])

    def energy(self, low: float = -np.inf, high: float = np.inf) -> float:
        """Lost in the grooves between two places x, older ones left out (J): 1/2 H (1 - H/k) depth² over the area."""
        lost = 0.5 * self.snow["snow_hardness_N_per_m3"] * (1.0 - 1.0 / self.snow["unloading_ratio_1"])
        return float(lost * (np.sum(self._between(low, high) ** 2) - self.met) * self.cell * self.spacing)

    def _between(self, low: float, high: float) -> FloatArray:
        x = self.start + (np.arange(self.memory.shape[1]) + 0.5) * self.spacing
        return np.asarray(self.memory[:, (x >= low) & (x < high)])

    def _hold(self, cut: Cut) -> FloatArray:
        """Force across the edge at each line (N)."""
        strength, reach = (
            self.snow.get("failure_shear_stress_N_per_m2", 0.0),
            self.snow.get("shear_displacement_m", 1.0),
        )
        y, depth = cut.point[:, 1], cut.deepest
        place, height = self.before[cut.runner, cut.line].T
        anchor = self.anchor[cut.runner, cut.line]
        with np.errstate(divide="ignore", invalid="ignore"):
            came = np.where(height <= 0.0, place + (y - place) * -height / (depth - height), y)
        anchor = np.where(np.isnan(anchor), came, anchor)
        aside = np.clip((anchor - y) * cut.left[:, 1], -reach, reach)
        wet = depth > 0.0
        self.anchor[cut.runner, cut.line] = np.where(wet, y + aside / cut.left[:, 1], np.nan)
        length = self.spacing * cut.share / np.abs(cut.forward[:, 0])
        return np.where(wet, strength * depth * length * aside / reach, 0.0)
