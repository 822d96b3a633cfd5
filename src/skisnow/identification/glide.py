"""Passage times of a body that glides straight down a slope.

    m v' = m g sin α - μ(v) m (g cos α + κ v²) - ½ ρ C_dA v²,   s' = v,   μ(v) = μ_0 + μ_1 v

s is the arc length along the slope's surface, α(s) its inclination, κ(s) its curvature, above 0 in a hollow, where the
snow presses more. After Kaps, Nachbauer and Mössner (1996).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from .._support.arrays import FloatArray, IntArray
from .._support.errors import ParameterError
from ..scenario import Plane, Slope, Terrain

LEAST_STEPS: Final = 200
"""Minimum number of time steps of a run; the forces change over tens of seconds."""
LONGEST_WAIT: Final = 5.0
"""Longest simulated time, in durations of the measured run."""
CRAWL_SPEED: Final = 0.1
"""Speed (m/s) after the longest time, assumed so that the times of cells that were not reached have a gradient."""
LONGEST_STEP_ON_PROFILE: Final = 0.02
"""Longest time step (s) on a profile: 0.4 m at 20 m/s. A step also ends at every point of the profile."""


@dataclass(frozen=True, slots=True, eq=False)
class SlopeLine:
    """The slope along the path from the start, in n pieces with a linearly changing gradient.

    The points of a profile do not define where it bends between them. Each segment has its gradient at its middle, and
    between the middles the gradient changes linearly (modelling assumption). The bend is then distributed between two
    middles and never has the wrong sign, as it would with cubics through the points.

    arc_length: (n + 1,) m: the beginnings of the pieces, the first at 0, and the end of the last one; infinite for a
        plane.
    x: (n + 1,) m: the horizontal distances of these places.
    gradient: (2, n): dz/dx at the beginning of each piece, and d²z/dx² (1/m); of planes one column for each body, or
        one for all.
    """

    arc_length: FloatArray
    x: FloatArray
    gradient: FloatArray

    @property
    def length(self) -> float:
        """Length (m); infinite for a plane."""
        return float(self.arc_length[-1])

    def at(self, piece: IntArray, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sine and cosine of the inclination, positive downwards, and curvature (1/m), above 0 in a hollow."""
        own = self.gradient if math.isinf(self.length) else self.gradient[:, piece]
        bend = own[1]
        gradient = own[0] + bend * (x - self.x[piece])
        stretch = np.hypot(1.0, gradient)
        return -gradient / stretch, 1.0 / stretch, bend / stretch**3


def slope_line(slope: Slope, start: float) -> SlopeLine:
    """The slope along the fall line from x = `start` (m).

    Raises ParameterError: the slope is a grid: its fall line is not straight.

    >>> line = slope_line(Plane(math.radians(30.0)), 0.0)
    >>> sine, _, curvature = line.at(np.zeros(1, int), np.zeros(1))
    >>> round(float(sine[0]), 9), float(curvature[0]), line.length
    (0.5, 0.0, inf)
    """
    if isinstance(slope, Plane):
        return planes(np.array([slope.angle]))
    if isinstance(slope, Terrain):
        raise ParameterError(
            'Photo-cell times are computed along one line, and slope.kind = "grid" does not define one. Give the '
            'heights along the line: slope.kind = "profile"'
        ).tag("no_line")
    middle = 0.5 * (slope.x[1:] + slope.x[:-1])
    of_segment = np.diff(slope.height) / np.diff(slope.x)
    ahead = middle > start
    x = np.concatenate([[start], middle[ahead], slope.x[-1:]])
    gradient = np.concatenate([np.interp([start], middle, of_segment), of_segment[ahead], of_segment[-1:]])
    line = SlopeLine(np.zeros(len(x)), x, np.stack([gradient[:-1], np.diff(gradient) / np.diff(x)]))
    place, weight = np.polynomial.legendre.leggauss(10)  # Gauss's rule for the lengths of the pieces
    centre, half = 0.5 * (x[1:] + x[:-1]), 0.5 * np.diff(x)
    stretch = [1.0 / line.at(np.arange(len(centre)), centre + half * share)[1] for share in place]
    lengths = half * np.tensordot(weight, stretch, axes=1)
    return replace(line, arc_length=np.concatenate([[0.0], np.cumsum(lengths)]))


def planes(angle: FloatArray) -> SlopeLine:
    """Planes inclined by the angles (rad), one for each body."""
    ends = np.array([0.0, math.inf])
    zero = np.zeros_like(angle)
    return SlopeLine(ends, ends, np.stack([-np.tan(angle), zero]))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Glide:
    """Parameters of k gliding bodies, (k,) each.

    friction, friction_by_speed: μ_0, and μ_1 (s/m).
    drag_per_mass: ½ ρ C_dA / m (1/m).
    speed: speed at the start (m/s).
    gravity: gravity (m/s²).
    """

    friction: FloatArray
    friction_by_speed: FloatArray
    drag_per_mass: FloatArray
    speed: FloatArray
    gravity: FloatArray

    def rates(self, line: SlopeLine, piece: IntArray, state: FloatArray) -> FloatArray:
        """Rates of x, arc length and speed, (3, k), in a state of these (m, m, m/s); the normal force is at least 0."""
        x, _, speed = state
        sine, cosine, curvature = line.at(piece, x)
        squared = speed**2
        pressed = np.maximum(self.gravity * cosine + curvature * squared, 0.0)
        friction = (self.friction + self.friction_by_speed * speed) * pressed
        return np.array([speed * cosine, speed, self.gravity * sine - friction - self.drag_per_mass * squared])


def passage_times(line: SlopeLine, glide: Glide, station: FloatArray, longest: float) -> FloatArray:
    """Times at which each body passes each cell.

    line: the slope along the path.
    glide: k bodies.
    station: (n,) or (k, n) m, rising, at least 0.
    longest: approximate duration of the runs (s); it sets the time step, and `LONGEST_WAIT` times it is simulated.
    Returns: (k, n) s. For a cell that a body has not reached in the longest time, the body is assumed to continue at
        0.1 m/s: the time is later than any time of a cell that was reached, and grows with the missing distance.

    Runge-Kutta method of fourth order in time, which also works for a start from rest, unlike ∫ ds/v. The curvature of
    a profile jumps between its pieces, so a step ends at each jump. Passages between steps are interpolated by a cubic
    through places and speeds.
    """
    k = len(glide.speed)
    stations = np.broadcast_to(np.asarray(station, float), (k, np.shape(station)[-1]))
    h = longest / LEAST_STEPS if math.isinf(line.length) else min(longest / LEAST_STEPS, LONGEST_STEP_ON_PROFILE)
    time, arc_length, speed = _histories(line, glide, h, float(stations.max()), LONGEST_WAIT * longest)
    times = [_photo_cell_times(time[:, j], arc_length[:, j], speed[:, j], stations[j]) for j in range(k)]
    crawling = LONGEST_WAIT * longest + (stations - arc_length[-1][:, None]) / CRAWL_SPEED
    return np.where(np.isfinite(times), times, crawling)


def _histories(
    line: SlopeLine, glide: Glide, h: float, last: float, longest: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times, arc lengths and speeds after each of m steps, (m, k) each; a body stays at its last cell."""
    k = len(glide.speed)
    piece, time = np.zeros(k, np.int64), np.zeros(k)
    state = np.stack([np.full(k, line.x[0]), np.zeros(k), glide.speed.astype(float)])
    history = [(time, state)]
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(math.ceil(longest / h) + len(line.arc_length)):
            step = np.where((state[1] < last) & (time < longest), h, 0.0)
            state, piece, share = _step_on(line, glide, piece, state, step)
            time = time + share * step
            history.append((time, state))
            if not np.any((state[1] < last) & (state[2] > 0.0) & (time < longest)):
                break
    arc_length, speed = np.array([state[1:] for _, state in history]).transpose(1, 0, 2)
    return np.array([time for time, _ in history]), arc_length, speed


def _step_on(
    line: SlopeLine, glide: Glide, piece: IntArray, state: FloatArray, h: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray]:
    """State and piece after a step, and the share of the step that was taken: it ends at the end of a piece."""
    share = np.ones_like(h)
    moved = _runge_kutta(line, glide, piece, state, h)
    end = line.arc_length[piece + 1]
    passes = moved[1] >= end
    if passes.any():
        shorter = _share(state[1], moved[1], h * state[2], h * moved[2], end)
        share = np.where(passes, shorter, 1.0)
        again = _runge_kutta(line, glide, piece, state, share * h)
        at_end = np.array([line.x[piece + 1], end, again[2]])
        moved = np.where(passes, at_end, moved)
        piece = np.minimum(piece + passes, len(line.arc_length) - 2)
    return moved, piece, share


def _runge_kutta(line: SlopeLine, glide: Glide, piece: IntArray, state: FloatArray, h: FloatArray) -> FloatArray:
    """State after one step h (s) of the classical Runge-Kutta method; the speed stays at 0 or above."""
    first = glide.rates(line, piece, state)
    second = glide.rates(line, piece, state + 0.5 * h * first)
    third = glide.rates(line, piece, state + 0.5 * h * second)
    fourth = glide.rates(line, piece, state + h * third)
    moved = state + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    moved[2] = np.maximum(moved[2], 0.0)
    return np.where(moved[1] < state[1], np.array([state[0], state[1], moved[2]]), moved)


def _photo_cell_times(time: FloatArray, arc_length: FloatArray, speed: FloatArray, station: FloatArray) -> FloatArray:
    """Times (s) at which a simulated glide passes photo cells at stations (m); infinite if it does not."""
    number = np.searchsorted(arc_length, station, side="left") - 1
    reached = number < len(arc_length) - 1
    at = np.clip(number, 0, len(arc_length) - 2)
    h = time[at + 1] - time[at]
    share = _share(arc_length[at], arc_length[at + 1], h * speed[at], h * speed[at + 1], station)
    return np.where(reached, time[at] + h * share, np.inf)


def _share(first: FloatArray, last: FloatArray, begin: FloatArray, end: FloatArray, place: FloatArray) -> FloatArray:
    """Share of the interval at which the cubic from `first` to `last`, with slopes `begin` and `end`, is at `place`."""
    u = np.clip(np.divide(place - first, last - first, out=np.zeros_like(first), where=last > first), 0.0, 1.0)
    for _ in range(6):
        at = (
            first * (1.0 + 2.0 * u) * (1.0 - u) ** 2
            + begin * u * (1.0 - u) ** 2
            + last * u**2 * (3.0 - 2.0 * u)
            + end * u**2 * (u - 1.0)
        )
        slope = (last - first) * 6.0 * u * (1.0 - u) + begin * (1.0 - u) * (1.0 - 3.0 * u) + end * u * (3.0 * u - 2.0)
        step = np.divide(place - at, slope, out=np.zeros_like(first), where=slope > 0.0)
        u = np.clip(u + step, 0.0, 1.0)
    return u
