"""A body that glides straight down a slope: when it passes which station.

    m v' = m g sin α - μ(v) m (g cos α + κ v²) - ½ ρ C_dA v²,   s' = v,   μ(v) = μ_0 + μ_1 v

s is the length of the way along the slope's surface, α(s) its inclination, κ(s) its curvature, above 0 in a hollow,
where the snow presses more. After Kaps, Nachbauer and Mössner (1996).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ..simulate.scenario import Plane, Profile

FloatArray = npt.NDArray[np.float64]

TABLE_SPACING: Final = 0.02
"""Spacing (m) of the tables of a profile's inclination and curvature."""
STEPS: Final = 200
"""Time steps over a run at least: the terms change over tens of seconds (Choice)."""
WAIT: Final = 5.0
"""How many times as long as a run took its body is waited for."""
CRAWL: Final = 0.1
"""Speed (m/s) of a body that does not get there in that time, so that a search is told the way."""
LONGEST_STEP_ON_PROFILE: Final = 0.02
"""(s): 0.4 m at 20 m/s, less than the points of a profile lie apart (Choice)."""


@dataclass(frozen=True, slots=True, eq=False)
class SlopeLine:
    """The slope along the way, from the start on.

    Attributes
    ----------
    way
        (n,) m, from 0 in equal steps; a plane has one entry.
    sine, cosine
        (n,) of the inclination, positive downwards.
    curvature
        (n,) 1/m, above 0 in a hollow.
    """

    way: FloatArray
    sine: FloatArray
    cosine: FloatArray
    curvature: FloatArray

    @property
    def length(self) -> float:
        """How far it goes (m); a plane has no end."""
        return math.inf if len(self.way) == 1 else float(self.way[-1])

    def at(self, way: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sine, cosine and curvature there."""
        if len(self.way) == 1:
            return self.sine, self.cosine, self.curvature
        place = np.clip(way / self.way[1], 0.0, len(self.way) - 1.000001)
        number = place.astype(np.int64)
        rest = place - number
        sine, cosine, curvature = (
            table[number] * (1.0 - rest) + table[number + 1] * rest
            for table in (self.sine, self.cosine, self.curvature)
        )
        return sine, cosine, curvature


def slope_line(slope: Plane | Profile, start: float) -> SlopeLine:
    """The slope along the fall line from x = `start` (m) on.

    >>> line = slope_line(Plane(math.radians(30.0)), 0.0)
    >>> round(float(line.sine[0]), 9), float(line.curvature[0]), line.length
    (0.5, 0.0, inf)
    """
    if isinstance(slope, Plane):
        return SlopeLine(np.zeros(1), np.array([math.sin(slope.angle)]), np.array([math.cos(slope.angle)]), np.zeros(1))
    end = slope.ends[1]
    x = np.linspace(start, end, max(2, math.ceil((end - start) / (TABLE_SPACING / 2.0)) + 1))
    gradient = slope.gradients(x)
    stretch = np.hypot(1.0, gradient)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (stretch[1:] + stretch[:-1]) * np.diff(x))])
    curvature = second_derivatives(slope, x) / stretch**3
    even = np.linspace(0.0, way[-1], max(2, math.ceil(way[-1] / TABLE_SPACING) + 1))
    tables = (np.interp(even, way, table) for table in (-gradient / stretch, 1.0 / stretch, curvature))
    return SlopeLine(even, *tables)


def second_derivatives(slope: Profile, x: FloatArray) -> FloatArray:
    """d²z/dx² of the profile's cubics (1/m)."""
    piece = np.clip(np.searchsorted(slope.x, x, side="right") - 1, 0, len(slope.x) - 2)
    cubic, square = slope.coefficients[0], slope.coefficients[1]
    return np.asarray(6.0 * cubic[piece] * (x - slope.x[piece]) + 2.0 * square[piece])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Glide:
    """Bodies that glide at once, one entry each, (k,).

    Attributes
    ----------
    friction, friction_by_speed
        μ_0, and μ_1 (s/m).
    drag_per_mass
        ½ ρ C_dA / m (1/m).
    speed
        At the start (m/s).
    gravity
        (m/s²).
    """

    friction: FloatArray
    friction_by_speed: FloatArray
    drag_per_mass: FloatArray
    speed: FloatArray
    gravity: FloatArray

    def acceleration(self, line: SlopeLine, way: FloatArray, speed: FloatArray) -> FloatArray:
        """(m/s²) of each; the snow presses but does not pull."""
        sine, cosine, curvature = line.at(way)
        pressed = np.maximum(self.gravity * cosine + curvature * speed**2, 0.0)
        friction = (self.friction + self.friction_by_speed * speed) * pressed
        return np.asarray(self.gravity * sine - friction - self.drag_per_mass * speed**2)


def passage_times(line: SlopeLine, glide: Glide, station: FloatArray, longest: float) -> FloatArray:
    """When each body passes each station.

    Parameters
    ----------
    line
        The slope along the way.
    glide
        k bodies.
    station
        (n,) or (k, n) m, rising, from 0 on.
    longest
        About how long the runs take (s); the step follows from it, and so many times `WAIT` is waited.

    Returns
    -------
    array
        (k, n) s. A body that stops before, or is not there after the wait, is taken to crawl on at 0.1 m/s from then:
        later than any that gets there, and the later the farther it is from there.

    Notes
    -----
    Runge-Kutta of fourth order in time, which a start from rest does not trouble as ∫ ds/v would; between the steps a
    cubic through places and speeds.
    """
    k = len(glide.speed)
    stations = np.broadcast_to(np.asarray(station, float), (k, np.shape(station)[-1]))
    h = longest / STEPS if len(line.way) == 1 else min(longest / STEPS, LONGEST_STEP_ON_PROFILE)
    way, speed = _histories(line, glide, h, float(stations.max()), WAIT * longest)
    found = [_passages(way[:, j], speed[:, j], h, stations[j]) for j in range(k)]
    crawling = WAIT * longest + (stations - way[-1][:, None]) / CRAWL
    return np.where(np.isfinite(found), found, crawling)


def _histories(line: SlopeLine, glide: Glide, h: float, last: float, longest: float) -> tuple[FloatArray, FloatArray]:
    way, speed = np.zeros_like(glide.speed), glide.speed.astype(float)
    ways, speeds = [way], [speed]
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(math.ceil(longest / h)):
            way, speed = _stepped(line, glide, way, speed, h)
            ways.append(way)
            speeds.append(speed)
            if not np.any((way < last) & (speed > 0.0)):
                break
    return np.array(ways), np.array(speeds)


def _stepped(
    line: SlopeLine, glide: Glide, way: FloatArray, speed: FloatArray, h: float
) -> tuple[FloatArray, FloatArray]:
    a1 = glide.acceleration(line, way, speed)
    v2 = speed + 0.5 * h * a1
    a2 = glide.acceleration(line, way + 0.5 * h * speed, v2)
    v3 = speed + 0.5 * h * a2
    a3 = glide.acceleration(line, way + 0.5 * h * v2, v3)
    v4 = speed + h * a3
    a4 = glide.acceleration(line, way + h * v3, v4)
    moved = way + h / 6.0 * (speed + 2.0 * v2 + 2.0 * v3 + v4)
    faster = np.maximum(speed + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4), 0.0)
    return np.maximum(moved, way), faster


def _passages(way: FloatArray, speed: FloatArray, h: float, station: FloatArray) -> FloatArray:
    """Times (s) at the stations, by Newton's method on the cubic of each step."""
    number = np.searchsorted(way, station, side="left") - 1
    reached = number < len(way) - 1
    at = np.clip(number, 0, len(way) - 2)
    first, last = way[at], way[at + 1]
    begin, end = h * speed[at], h * speed[at + 1]
    share = np.clip(np.divide(station - first, last - first, out=np.zeros_like(station), where=last > first), 0.0, 1.0)
    for _ in range(6):
        u = share
        place = (
            first * (1.0 + 2.0 * u) * (1.0 - u) ** 2
            + begin * u * (1.0 - u) ** 2
            + last * u**2 * (3.0 - 2.0 * u)
            + end * u**2 * (u - 1.0)
        )
        slope = (last - first) * 6.0 * u * (1.0 - u) + begin * (1.0 - u) * (1.0 - 3.0 * u) + end * u * (3.0 * u - 2.0)
        step = np.divide(station - place, slope, out=np.zeros_like(station), where=slope > 0.0)
        share = np.clip(u + step, 0.0, 1.0)
    return np.where(reached, h * (at + share), np.inf)
