"""The edge line of a ski in snow, and the circles through it."""

from __future__ import annotations

import bisect
import functools
import math
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, IntArray
from ..ski.beam import ClampedSki, base_motion, beam_at_stations, beam_rows
from .solve import Solution

BOOT_REACH: Final = 0.40
"""Distance (m) before and behind the boot at which the circle of the boot's turn radius meets the edge line."""
MEDIAN_REACH: Final = 0.10
"""Distance (m) before and behind a place at which the circles of the median turn radius meet the edge line."""
_STEP: Final = 0.002  # m, between circles of the median turn radius
_BLUR: Final = 0.03  # relative distance from the median below which a radius counts in part, so that it is smooth
_STRAIGHTEST: Final = 20.0  # logarithm of a radius (m) that stands for edges that are straight or curve outwards
_NEWTON: Final = 6  # iterations from the nearest circle's radius to the last digits of the median
_STRAIGHT: Final = 1e-9  # m, sagitta below which a line has no radius


class MedianCircles(NamedTuple):
    """Median radius (m), points (3, k) of the circles near it, its derivatives by their radii and both end stations."""

    radius: float
    places: FloatArray
    weight: FloatArray
    by_front: float
    by_rear: float


class EdgeLine:
    """Edge of a bent and twisted ski, seen along the snow normal; x along the ski, y towards the inside of the turn.

    The edge at a station lies W/2 cos(ϑ + φ) + (h + w) sin ϑ towards the inside.
    """

    def __init__(self, model: ClampedSki, edge_angle: float, solution: Solution) -> None:
        self._model = model
        self._edge_angle = edge_angle
        self._u = solution.u
        self.station = model.stations.station

    @functools.cached_property
    def bend(self) -> tuple[FloatArray, FloatArray]:
        """Deflection (m) and twist (rad) at the stations."""
        return beam_at_stations(self._model, self._u)

    @functools.cached_property
    def position(self) -> FloatArray:
        """Position of the edge at the stations (m)."""
        stations = self._model.stations
        return self.across(stations.width, stations.base_height, *self.bend)

    def at(self, station: npt.ArrayLike) -> FloatArray:
        """Position (m) of the edge at stations (m)."""
        return self.across(*self.sections(np.atleast_1d(np.asarray(station, float))))

    def sections(self, station: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Width, height of the unloaded base, deflection (m) and twist (rad) at stations (m)."""
        width, base_height, rows = sections_at(self._model, tuple(station.tolist()))
        return (width, base_height, *base_motion(self._u, *rows))

    def across(
        self, width: FloatArray, base_height: FloatArray, deflection: FloatArray, twist: FloatArray
    ) -> FloatArray:
        """Position (m) of the edge, from width, base height, deflection (m) and twist (rad) of sections."""
        across = width / 2.0 * np.cos(self._edge_angle + twist)
        return np.asarray(across + (base_height + deflection) * math.sin(self._edge_angle))

    def radius_over(self, front: float, rear: float) -> float | None:
        """Radius (m) of the circle through the edge at `front`, the boot and `rear`; positive: the ends lead inwards.

        None where the boot is not between them, a station is beyond the ski, or the three lie on a line.
        """
        tip, tail = float(self._model.ski.station[0]), float(self._model.ski.station[-1])
        if not tail <= rear < 0.0 < front <= tip:
            return None
        y_front, y_boot, y_rear = self.at([front, 0.0, rear])
        return circle_radius((front, float(y_front)), (0.0, float(y_boot)), (rear, float(y_rear)))

    def radius_at_boot(self) -> float | None:
        """Radius (m) of the circle through the edge at the boot and 0.4 m before and behind it."""
        return self.radius_over(BOOT_REACH, -BOOT_REACH)

    def median_circles(self, front: float, rear: float) -> MedianCircles | None:
        """Median radius of circles through the edge at a place and 0.1 m on both sides, between two stations (m).

        None where these are too near, or no median curves inwards.
        """
        inner, outer = rear + MEDIAN_REACH, front - MEDIAN_REACH
        apart = round(MEDIAN_REACH / _STEP)
        first, last = math.ceil(inner / _STEP - 0.5), math.floor(outer / _STEP + 0.5)
        if last <= first:
            return None
        grid = _STEP * np.arange(first - apart, last + apart + 1)
        middle, away = np.arange(apart, len(grid) - apart), apart * np.array([[1], [0], [-1]])
        x, y = grid[middle + away], self.at(grid)[middle + away]
        # a circle counts for one step of the edge, those at the ends for their part of it
        length = np.clip((outer - x[1]) / _STEP + 0.5, 0.0, 1.0) * np.clip((x[1] - inner) / _STEP + 0.5, 0.0, 1.0)
        # curvature of the circle through each three points, positive if the middle one is below the chord
        twice_area = (x[0] - x[2]) * (y[1] - y[2]) - (x[1] - x[2]) * (y[0] - y[2])
        sides = [np.hypot(x[i] - x[j], y[i] - y[j]) for i, j in ((1, 0), (1, 2), (0, 2))]
        curvature = -2.0 * twice_area / (sides[0] * sides[1] * sides[2])
        level = -np.log(np.where(curvature > 0.0, curvature, math.exp(-_STRAIGHTEST)))

        def balance(median: float) -> tuple[float, FloatArray, FloatArray]:
            z = np.clip((level - median) / _BLUR, -1.0, 1.0)
            side, growth = z * (15.0 - 10.0 * z**2 + 3.0 * z**4) / 8.0, length * 1.875 * (1.0 - z**2) ** 2
            return float(length @ side), side, growth

        order = np.sort(level).tolist()
        median = order[bisect.bisect_left(range(len(order) - 1), 0.0, key=lambda n: -balance(order[n])[0])]
        for _ in range(_NEWTON):
            total, side, growth = balance(median)
            near = float(growth.sum())
            if near == 0.0:
                return None
            median += _BLUR * total / near
        if median > _STRAIGHTEST / 2.0:
            return None
        used, by_end = growth > 0.0, math.exp(median) * _BLUR / near / _STEP
        weight = growth[used] / near * np.exp(median - level[used])
        by_front, by_rear = by_end * side[-1] * (length[-1] < 1.0), -by_end * side[0] * (length[0] < 1.0)
        return MedianCircles(math.exp(median), x[:, used], weight, float(by_front), float(by_rear))

    def radius_median(self, front: float, rear: float) -> float | None:
        """Radius (m) of `median_circles`, if it exists."""
        circles = self.median_circles(front, rear)
        return None if circles is None else circles.radius

    def offset_from_circle(self) -> FloatArray:
        """Distance of the edge from the circle of `radius_at_boot` at each station (m), positive inside."""
        radius = self.radius_at_boot()
        if radius is None:
            raise ValueError("a straight edge line has no circle")
        y_front, y_rear = (float(y) for y in self.at([BOOT_REACH, -BOOT_REACH]))
        heading = math.atan2(y_front - y_rear, 2.0 * BOOT_REACH)
        middle_x, middle_y = 0.0, (y_front + y_rear) / 2.0
        # the centre is on the chord's normal, on the inner side
        chord = math.hypot(2.0 * BOOT_REACH, y_front - y_rear)
        away = math.copysign(math.sqrt(radius**2 - chord**2 / 4.0), radius)
        centre_x, centre_y = middle_x - away * math.sin(heading), middle_y + away * math.cos(heading)
        distance = np.hypot(self.station - centre_x, self.position - centre_y)
        return np.asarray(math.copysign(1.0, radius) * (abs(radius) - distance))

    def contact_ends(self, depth: FloatArray) -> tuple[float, float]:
        """Stations (m) of both ends of the contact, front first: where the edge depth passes zero, or tip and tail."""
        below = np.flatnonzero(depth > 0.0)
        return self._contact_end(depth, int(below[0]), -1), self._contact_end(depth, int(below[-1]), 1)

    def _contact_end(self, depth: FloatArray, last: int, outwards: int) -> float:
        """Station (m) where the depth passes 0 outside of station `last`, or the ski's end."""
        beyond = last + outwards
        if not 0 <= beyond < len(depth):
            return float(self._model.ski.station[0 if outwards < 0 else -1])
        share = depth[last] / (depth[last] - depth[beyond])
        return float(self.station[last] + share * (self.station[beyond] - self.station[last]))

    def greatest_slope(self) -> float:
        """Largest absolute slope (m/m) of the deflection along the ski, between its contact points."""
        front, rear = self._model.ski.contact_points
        inside = (self.station <= front) & (self.station >= rear)
        return float(np.max(np.abs(np.gradient(self.bend[0][inside], self.station[inside]))))


@functools.lru_cache(maxsize=128)
def sections_at(
    model: ClampedSki, stations: tuple[float, ...]
) -> tuple[FloatArray, FloatArray, tuple[IntArray, FloatArray, FloatArray]]:
    """Width, height of the unloaded base (m), and `beam_rows` at stations (m); cached for repeated stations."""
    ski = model.ski
    width, height = (np.interp(stations, ski.station[::-1], table[::-1]) for table in (ski.width, ski.base_height))
    return width, height, beam_rows(model, stations)


def circle_radius(front: tuple[float, float], middle: tuple[float, float], rear: tuple[float, float]) -> float | None:
    """Radius of the circle through three points, positive if the middle is below the chord (y); None if straight.

    >>> import math
    >>> round(circle_radius((3.0, 1.0), (0.0, 0.0), (-3.0, 1.0)), 12)
    5.0
    """
    a = math.dist(middle, front)
    b = math.dist(middle, rear)
    c = math.dist(front, rear)
    twice_area = (front[0] - rear[0]) * (middle[1] - rear[1]) - (middle[0] - rear[0]) * (front[1] - rear[1])
    if abs(twice_area) <= _STRAIGHT * c:
        return None
    return -a * b * c / (2.0 * twice_area)
