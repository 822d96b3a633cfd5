"""Speed and length of a track without recorded speeds, with 95 % intervals.

Samples of the path are drawn from its distribution given the places; every number is computed for each sample.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import lapack

from .._support.arrays import FloatArray, IntArray
from .._support.units import CONFIDENCE
from .path_model import STATES, PathFit, PathModel, TimeScales
from .posterior import WeightedParameters, likely_parameters

FloatSamples = npt.NDArray[np.float32]

LONGEST_STEP: Final = 0.25
"""Maximum time (s) between nodes, or a quarter of the interval between points if that is longer."""
SHORTEST_STEP: Final = 0.05
"""Points closer in time (s) than this are averaged."""
EXCERPT: Final = 240
"""Points from which the parameters of the motion are estimated."""
WINDOW: Final = 5_000
"""Points of a part that are fitted at a time."""
OVERLAP: Final = 40
"""Points on each side that two windows share."""
RESOLVED: Final = 2.0
"""Correlation time of the acceleration, in intervals between points.

Points do not resolve faster changes. With a shorter time each sample has a speed noise that no point contradicts, and
the maximum of a noisy series is too high. With a longer one the path cannot follow the changes that points resolve.
"""
SPEED_TIMES: Final = (0.3, 2.0)
"""Minimum and maximum of that time (s) (modelling assumption)."""
LEAST_HEIGHTS: Final = 0.1
"""Share of points with a height from which heights count (modelling assumption)."""
HEIGHT_ERROR: Final = 0.3
"""Noise (m/s) of the vertical speed that is accepted (modelling assumption)."""
LONGEST_WINDOW: Final = 15.0
"""Maximum time (s) over which a vertical speed is averaged (modelling assumption)."""
_MOST_NUMBERS: Final = 5e6
"""Numbers in the samples of a track."""
_SAMPLES: Final = (60, 600)
_FITS: Final = (1, 24)
"""Minimum and maximum number of parameters for which the path is fitted."""
_NODES_FITTED: Final = 40_000
"""Nodes times fits, from which fewer parameters are used."""
_PARTS_FITTED: Final = 200
"""Parts times fits, from which fewer parameters are used."""
_HEADING, _SPEED = 2, 5


class Interval(NamedTuple):
    """An estimate, and the ends of its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class PathEstimate:
    """Random samples of the speed along a track that are consistent with its places.

    time: (n,) s, times of the nodes.
    step: (n - 1,) s, between nodes; 0 between parts of the track.
    speed: (s, n) m/s, horizontal speed, a row for each sample.
    climb: (n,) m/s or None, vertical speed; None without heights.
    across: (n - 1,) m, straight path between parts of the track.
    """

    time: FloatArray
    step: FloatArray
    speed: FloatSamples
    climb: FloatArray | None
    across: FloatArray

    def speed_at(self, time: FloatArray) -> FloatArray:
        """Mean of the speed (m/s) at times; NaN outside of the nodes."""
        return np.interp(time, self.time, np.maximum(self.speed.mean(axis=0), 0.0), left=np.nan, right=np.nan)

    def speed_sd_at(self, time: FloatArray) -> FloatArray:
        """Standard deviation of the speed (m/s) at times; NaN outside of the nodes."""
        return np.interp(time, self.time, self.speed.std(axis=0), left=np.nan, right=np.nan)

    def arc_length_at(self, time: FloatArray) -> FloatArray:
        """Mean length (m) of the path, with its heights, up to times."""
        steps = np.mean(self._lengths(slice(None), with_heights=True), axis=0)
        return np.interp(time, self.time, np.concatenate([[0.0], np.cumsum(np.maximum(steps, 0.0))]))

    def max_speed(self, start: float = -np.inf, end: float = np.inf) -> Interval | None:
        """Highest horizontal speed (m/s) between two times (s); None if nothing is known there."""
        inside = self._nodes_inside(start, end)
        if not self.speed[:, inside].size:
            return None
        return _interval(np.maximum(self.speed[:, inside].max(axis=1), 0.0))

    def length(self, start: float = -np.inf, end: float = np.inf, *, with_heights: bool = True) -> Interval:
        """Length (m) of the path between two times (s)."""
        inside = self._nodes_inside(start, end)
        return _interval(np.maximum(self._lengths(inside, with_heights=with_heights).sum(axis=1), 0.0))

    def _nodes_inside(self, start: float, end: float) -> slice:
        """Slice of the nodes from one time to another (s), both included."""
        first, last = np.searchsorted(self.time, [start - 1e-9, end + 1e-9]).tolist()
        return slice(first, last)

    def _lengths(self, inside: slice, *, with_heights: bool) -> FloatArray:
        """Lengths (s, m - 1) of the steps between nodes."""
        speed = self.speed[:, inside].astype(float)
        if with_heights and self.climb is not None:
            speed = np.copysign(np.hypot(speed, self.climb[inside]), speed)
        first, last, _ = inside.indices(len(self.time))
        steps = slice(first, max(last - 1, first))
        return (speed[:, 1:] + speed[:, :-1]) / 2.0 * self.step[steps] + self.across[steps]


def estimate_path(time: FloatArray, place: FloatArray, part: IntArray, segment: IntArray) -> PathEstimate | None:
    """Estimate the path through places.

    time: (n,) s, rising.
    place: (n, 3) m, finite x and y; heights NaN if unknown.
    part, segment: (n,), number of the part without a gap, and of the segment of the file, of each point.
    Returns: None if no part has three points or no path can be fitted.
    """
    rng = np.random.default_rng(0)
    pieces = [_average_close_points(time[part == number], place[part == number]) for number in np.unique(part)]
    interval = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    scales = TimeScales(max(LONGEST_STEP, interval / 4.0), float(np.clip(RESOLVED * interval, *SPEED_TIMES)))
    pieces = [piece for piece in pieces if len(piece[0]) > 1]
    if not pieces:
        return None
    excerpt = _excerpt(pieces, scales)
    weighted = likely_parameters(excerpt) if np.any(excerpt.place != 0.0) else []
    if not weighted:
        return None
    nodes = sum(int(np.sum(np.maximum(1, np.ceil(np.diff(at) / scales.longest_step)))) + 1 for at, _ in pieces)
    samples = int(np.clip(_MOST_NUMBERS / nodes, *_SAMPLES))
    fits = min(_NODES_FITTED / nodes, _PARTS_FITTED / len(pieces))
    drawn = _draw_parameters(weighted, int(np.clip(fits, *_FITS)), samples, rng)
    samples_of_pieces = [_piece_samples(at, where, scales, drawn, rng) for at, where in pieces]
    drawn_pieces = [piece for piece in samples_of_pieces if piece is not None]
    if len(drawn_pieces) < len(pieces):
        return None
    node_times = np.concatenate([at for at, _ in drawn_pieces])
    step = np.diff(node_times)
    step[np.cumsum([len(at) for at, _ in drawn_pieces])[:-1] - 1] = 0.0
    across = np.zeros(len(step))  # straight lines over the gaps between the parts
    height = np.where(np.isfinite(place[:, 2]), place[:, 2], 0.0)
    lengths = np.linalg.norm(np.diff(np.column_stack([place[:, :2], height]), axis=0), axis=1)
    for gap in np.flatnonzero((np.diff(part) != 0) & (np.diff(segment) == 0)):
        before = min(max(int(np.searchsorted(node_times, time[gap] + 1e-9)) - 1, 0), len(across) - 1)
        across[before] += lengths[gap]
    speed = np.concatenate([of_piece for _, of_piece in drawn_pieces], axis=1)
    return PathEstimate(node_times, step, speed, _vertical_speed(time, place[:, 2], part, node_times), across)


def _average_close_points(time: FloatArray, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Times and places, averaged over points that are closer in time than the shortest step; the ends stay."""
    if len(time) < 2 or float(np.median(np.diff(time))) >= SHORTEST_STEP:
        return time, place
    cell = np.floor((time - time[0]) / SHORTEST_STEP + 1e-9).astype(np.int64)
    cell[0], cell[-1] = -1, cell[-1] + 1
    _, which, counts = np.unique(cell, return_inverse=True, return_counts=True)
    mean = [np.bincount(which, values) / counts for values in (time, *place.T)]
    return mean[0], np.column_stack(mean[1:])


def _excerpt(pieces: list[tuple[FloatArray, FloatArray]], scales: TimeScales) -> PathModel:
    """Model of the stretch with the longest path, of at most `EXCERPT` points."""
    best: tuple[float, FloatArray, FloatArray] | None = None
    for time, place in pieces:
        steps = np.hypot(*np.diff(place[:, :2], axis=0).T)
        path = np.concatenate([[0.0], np.cumsum(steps)])
        count = min(EXCERPT, len(time))
        covered = path[count - 1 :] - path[: len(path) - count + 1]
        first = int(np.argmax(covered))
        if count > 1 and (best is None or covered[first] > best[0]):
            best = float(covered[first]), time[first : first + count], place[first : first + count, :2]
    assert best is not None
    return PathModel(best[1], best[2] - best[2][0], scales)


def _draw_parameters(
    weighted: list[WeightedParameters], fits: int, samples: int, rng: np.random.Generator
) -> list[tuple[WeightedParameters, int]]:
    """Parameters drawn by their weights, and the number of samples for each: systematic resampling."""
    logs = np.array([parameters.log_weight for parameters in weighted])
    weights = np.exp(logs - logs.max())
    ends = np.cumsum(weights) / np.sum(weights)
    chosen = np.searchsorted(ends, (rng.random() + np.arange(fits)) / fits)
    numbers, counts = np.unique(np.minimum(chosen, len(weighted) - 1), return_counts=True)
    shares = np.maximum(1, np.round(samples * counts / fits)).astype(int)
    return [(weighted[number], int(share)) for number, share in zip(numbers, shares, strict=True)]


def _piece_samples(
    time: FloatArray,
    place: FloatArray,
    scales: TimeScales,
    drawn: list[tuple[WeightedParameters, int]],
    rng: np.random.Generator,
) -> tuple[FloatArray, FloatSamples] | None:
    """Times of the nodes of one part, and samples (s, n) of the speed there.

    A long part is fitted in windows that overlap; of each overlap, each window gives its half.
    """
    times, speeds = [], []
    for begin in range(0, max(len(time) - 1, 1), WINDOW):
        end = min(begin + WINDOW, len(time) - 1)
        first, last = max(begin - OVERLAP, 0), min(end + OVERLAP + 1, len(time))
        model = PathModel(time[first:last], place[first:last, :2] - place[first, :2], scales)
        nodes = slice(int(model.points[begin - first]), int(model.points[end - first]) + (end == len(time) - 1))
        speeds_of_window = []
        for (parameters, _), count in drawn:
            fit = model.fit(parameters, model.initial_state(parameters.place_noise))
            if fit is None:
                return None
            most = max(1, int(4e6 / fit.state.size))  # samples at a time
            for first_sample in range(0, count, most):
                speeds_of_window.append(_samples(fit, min(most, count - first_sample), rng)[:, nodes])
        times.append(model.time[nodes])
        speeds.append(np.concatenate(speeds_of_window))
    return np.concatenate(times), np.concatenate(speeds, axis=1)


def _samples(fit: PathFit, count: int, rng: np.random.Generator) -> FloatSamples:
    """Samples (count, n) of the speed.

    Laplace's approximation is linear: a sample whose heading differs by δ from the most probable path is longer by the
    share δ²/2 than its speeds are. They are multiplied by the mean of that share. A point at rest has speeds of both
    signs, so that noise makes no path.
    """
    noise = rng.standard_normal((fit.state.size, count))
    solved, _ = lapack.dtbtrs(fit.factor, noise, uplo="L", trans="T")
    change = solved.reshape(-1, STATES, count)
    speed = fit.state[:, _SPEED]
    moving = np.abs(speed)
    longer = np.minimum(change[:, _HEADING].T ** 2, 1.0) @ moving / (2.0 * max(float(np.sum(moving)), 1e-9))
    forward = np.where(speed < 0.0, -1.0, 1.0)
    return np.asarray(forward * (speed + change[:, _SPEED].T) * (1.0 + longer[:, None]), dtype=np.float32)


def _vertical_speed(time: FloatArray, height: FloatArray, part: IntArray, nodes: FloatArray) -> FloatArray | None:
    """Mean vertical speed (m/s) about each node; None if few points have a height.

    The mean is taken over two intervals, or over a longer time in which the height's noise adds 0.3 m/s.
    """
    known = np.isfinite(height)
    if np.count_nonzero(known) < max(2.0, LEAST_HEIGHTS * len(time)):
        return None
    noise = math.sqrt(float(np.mean(np.append(np.diff(height[known], 3), 0.0) ** 2)) / 20.0)
    window = max(2.0 * float(np.median(np.diff(time[known]))), min(noise / HEIGHT_ERROR, LONGEST_WINDOW))
    speed = np.zeros(len(nodes))
    for number in np.unique(part[known]):
        at, heights = time[known & (part == number)], height[known & (part == number)]
        inside = (nodes >= at[0]) & (nodes <= at[-1]) & (at[-1] > at[0])
        before, after = (np.clip(nodes[inside] + change, at[0], at[-1]) for change in (-window / 2.0, window / 2.0))
        speed[inside] = (np.interp(after, at, heights) - np.interp(before, at, heights)) / (after - before)
    return speed


def _interval(values: npt.NDArray[np.floating]) -> Interval:
    """The median, and the ends of the central 95 % of the samples."""
    outside = (1.0 - CONFIDENCE) / 2.0
    low, value, high = np.quantile(values.astype(float), (outside, 0.5, 1.0 - outside)).tolist()
    return Interval(value, low, high)
