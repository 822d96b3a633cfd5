"""A day on a slope split into runs and lifts, from height and speed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Final, Literal

import numpy as np

from .._support.arrays import FloatArray
from .._support.messages import Message
from .._support.units import STANDARD_GRAVITY, ShownFields
from .curvature import TrackMotion, running_mean, segments
from .track import Track

LEAST_HEIGHT: Final = 15.0
"""Height (m) that makes a descent a run and an ascent a lift. Modelling assumption: above the wander of a receiver's
height."""
HEIGHT_WINDOW: Final = 15.0
"""Length (s) of the running mean over the height that finds tops and bottoms (modelling assumption)."""
STANDING: Final = 1.0
"""Speed (m/s) below which a skier counts as standing (modelling assumption)."""
LONGEST_STOP: Final = 30.0
"""Without heights, a stop (s) after which another run begins (modelling assumption)."""
LEAST_DISTANCE: Final = 10.0
"""A run's length (m) at least (modelling assumption)."""
_ZONE: Final = 0.02
"""Share of a descent that counts as its top and as its bottom, at least 1 m of height."""
_SPARSE: Final = 10
"""One height in so many points is enough to tell tops from bottoms (modelling assumption)."""
_LEVEL_SHARE: Final = 0.01
"""Heights that differ by less than this share of the distance travelled are none: the slope's own third axis."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A run or a lift: from the point number ``first`` to ``last``, both in it.

    first, last: numbers of points.
    start, end: times (s).
    distance: m, along the track.
    descent: height at the start less that at the end (m), negative for a lift; None without heights.
    max_speed: highest speed (m/s); None if none is known.
    distance_interval, max_speed_interval: ends of the 95 % intervals; None for what the device recorded.
    gaps: number of gaps inside.
    """

    first: int
    last: int
    start: float
    end: float
    distance: float
    descent: float | None
    max_speed: float | None
    gaps: int
    distance_interval: tuple[float, float] | None = None
    max_speed_interval: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True, repr=False)
class Day(ShownFields):
    """Runs and lifts in the order of time, the method of the split, and remarks on unknown quantities."""

    runs: tuple[Stretch, ...]
    lifts: tuple[Stretch, ...]
    split_by: Literal["height", "motion"]
    remarks: tuple[Message, ...]


def split_day(track: Track, motion: TrackMotion) -> Day:
    """Find runs and lifts.

    track: the track; its third axis is the height unless its axes are those of a slope.

    The height's running mean has tops and bottoms that differ by 15 m at least. An ascent between them is a lift,
    unless the speed at its foot would carry anyone up there, v²/(2g). Between two lifts, what descends is a run: from
    the last moment at the top at which the speed was below 1 m/s to the first such moment at the bottom; a stop in
    between does not end it. Top and bottom are the first and last 2 % of the descent's height, at least 1 m. Where the
    heights differ by less than 15 m, or there are none, every stretch in motion is a run; stops up to 30 s do not end
    it. An ascent between two segments of the file separates runs, but it is not listed as a lift.
    """
    height, remarks = height_or_reason(track, motion)
    if height is None:
        return Day(tuple(_moving_stretches(track, motion, None)), (), "motion", remarks)
    smooth = running_mean(track.time, height, HEIGHT_WINDOW, segments(track))
    corners = turning_points(smooth, LEAST_HEIGHT)
    changes = np.diff(smooth[corners])
    if not np.any(np.abs(changes) >= LEAST_HEIGHT):
        words = Message(
            "The height changes by less than {height:g} m: every stretch in motion is taken as a run.",
            height=LEAST_HEIGHT,
        )
        return Day(tuple(_moving_stretches(track, motion, height)), (), "motion", (*remarks, words))
    ascents = [
        (low, high)
        for low, high, rise in zip(corners[:-1], corners[1:], changes, strict=True)
        # v²/(2g): height to which the speed at the foot carries
        if rise >= max(LEAST_HEIGHT, float(np.nan_to_num(motion.speed[low]) ** 2 / (2.0 * STANDARD_GRAVITY)))
    ]
    rises = np.where(np.diff(segments(track)) > 0, 0.0, np.diff(smooth))  # nothing between two segments of the file
    climbs = [_climb(smooth, low, high) for low, high in ascents if np.sum(rises[low:high]) >= LEAST_HEIGHT]
    lifts = [_make_stretch(track, motion, height, *climb) for climb in climbs]
    edges = [0, *chain.from_iterable(ascents), len(track) - 1]  # of the areas before, between and after the ascents
    spans = (_descent(motion, smooth, corners, area) for area in zip(edges[::2], edges[1::2], strict=True))
    runs = [_make_stretch(track, motion, height, *ends) for ends in spans if ends is not None]
    # a run is longer than its descent: a height that drifts at rest is none
    runs = [run for run in runs if run.distance >= max(LEAST_DISTANCE, run.descent or 0.0)]
    return Day(tuple(runs), tuple(lifts), "height", remarks)


def height_or_reason(track: Track, motion: TrackMotion) -> tuple[FloatArray | None, tuple[Message, ...]]:
    """Height (n,) (m), interpolated over holes; or None with a sentence that explains why it is unknown."""
    recorded = np.isfinite(track.place[:, 2])
    if track.axes == "slope":
        return None, (Message("The track's third axis is that of the slope, not the height: descents are unknown."),)
    if np.count_nonzero(recorded) < max(2, len(track) // _SPARSE):
        return None, (
            Message("No heights in the track: lifts cannot be distinguished from runs, descents are unknown."),
        )
    height = np.interp(np.arange(len(track)), np.flatnonzero(recorded), track.place[recorded, 2])
    arc_length = float(motion.arc_length[-1] - motion.arc_length[0])
    if track.axes == "file" and np.ptp(height) < _LEVEL_SHARE * arc_length:
        return None, (
            Message("The third axis hardly changes: it is taken as the slope's own, and descents are unknown."),
        )
    return height, ()


def _climb(smooth: FloatArray, low: int, high: int) -> tuple[int, int]:
    """First and last point of a lift, from the last at the bottom to the first at the top, without waiting times."""
    margin = max(1.0, _ZONE * float(smooth[high] - smooth[low]))
    inside = smooth[low : high + 1]
    bottom = np.flatnonzero(inside <= smooth[low] + margin)
    top = np.flatnonzero(inside >= smooth[high] - margin)
    return low + int(bottom[-1]), low + int(top[0])


def _descent(
    motion: TrackMotion, smooth: FloatArray, corners: list[int], area: tuple[int, int]
) -> tuple[int, int] | None:
    """First and last point of the run in an area between lifts; None without a descent."""
    inside = [corner for corner in corners if area[0] <= corner <= area[1]]
    falls = [(high, low) for high, low in pairwise(inside) if smooth[high] - smooth[low] >= LEAST_HEIGHT]
    if not falls:
        return None
    top, bottom = falls[0][0], falls[-1][1]
    margin = max(1.0, _ZONE * float(smooth[top] - smooth[bottom]))
    heights = smooth[top : bottom + 1]
    leaves = top + int(np.flatnonzero(heights >= smooth[top] - margin)[-1])
    arrives = top + int(np.flatnonzero(heights <= smooth[bottom] + margin)[0])
    slow = np.flatnonzero(motion.speed < STANDING)
    before = slow[(slow >= area[0]) & (slow <= leaves)]
    after = slow[(slow >= max(arrives, leaves)) & (slow <= area[1])]
    return int(before[-1]) if len(before) else area[0], int(after[0]) if len(after) else area[1]


def _moving_stretches(track: Track, motion: TrackMotion, height: FloatArray | None) -> Iterator[Stretch]:
    """Stretches of 10 m or more in motion, stops up to 30 s included; `height` (m): for their descents."""
    moving = np.flatnonzero((motion.speed >= STANDING) & track.usable)
    if not len(moving):
        return
    breaks = np.flatnonzero(np.diff(track.time[moving]) > LONGEST_STOP)
    firsts, lasts = moving[np.r_[0, breaks + 1]], moving[np.r_[breaks, len(moving) - 1]]
    for first, last in zip(firsts.tolist(), lasts.tolist(), strict=True):
        stretch = _make_stretch(track, motion, height, first, last)
        if stretch.distance >= LEAST_DISTANCE:
            yield stretch


def _make_stretch(track: Track, motion: TrackMotion, height: FloatArray | None, first: int, last: int) -> Stretch:
    """Stretch from point `first` to `last` with distance (m), descent (None without heights), and highest speed."""
    inside = slice(first, last + 1)
    start, end = float(track.time[first]), float(track.time[last])
    distance, distance_interval = float(motion.arc_length[last] - motion.arc_length[first]), None
    if motion.path is not None and motion.arc_length_source == "places":
        distance, *ends = motion.path.length(start, end)
        distance_interval = ends[0], ends[1]
    speed, speed_interval = max_speed(track, motion, inside)
    descent = None if height is None else float(height[first] - height[last])
    gaps = int(np.count_nonzero(np.diff(motion.smoothed.part[inside])))
    return Stretch(first, last, start, end, distance, descent, speed, gaps, distance_interval, speed_interval)


def max_speed(track: Track, motion: TrackMotion, inside: slice) -> tuple[float | None, tuple[float, float] | None]:
    """Highest speed (m/s) in a stretch, recorded or of the estimated path, and the ends of its 95 % interval."""
    if motion.path is not None:
        times = track.time[inside]
        speed = motion.path.max_speed(float(times[0]), float(times[-1]))
        return (None, None) if speed is None else (speed.value, (speed.low, speed.high))
    speeds = motion.speed[inside][track.usable[inside]]
    speeds = speeds[np.isfinite(speeds)]
    return float(speeds.max()) if len(speeds) else None, None


def turning_points(values: FloatArray, least: float) -> list[int]:
    """Indices of the first value, of alternating highest and lowest values, and of the last value.

    values: (n,), finite.
    least: two neighbouring turning points but the first and the last differ at least by this.

    >>> turning_points(np.array([0.0, 5.0, 4.5, 9.0, 1.0, 1.5, 0.0, 6.0]), 2.0)
    [0, 3, 6, 7]
    """
    signs = np.sign(np.diff(values))
    moving = np.flatnonzero(signs)
    local_extremes = moving[np.flatnonzero(np.diff(signs[moving])) + 1].tolist()
    turning = [0]
    direction = high = low = 0
    for here in (*local_extremes, len(values) - 1):
        if direction >= 0 and values[here] > values[high]:
            high = here
        if direction <= 0 and values[here] < values[low]:
            low = here
        if direction >= 0 and values[high] - values[here] >= least:
            turning.append(high)
            direction, low = -1, here
        elif direction <= 0 and values[here] - values[low] >= least:
            turning.append(low)
            direction, high = 1, here
    if direction:
        turning.append(high if direction > 0 else low)
    return sorted({*turning, len(values) - 1})
