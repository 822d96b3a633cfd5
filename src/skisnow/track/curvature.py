"""Arc length, speed, heading, curvature and turn radius along a track, with standard errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.stats import norm

from .._support.arrays import FloatArray, IntArray
from .._support.units import CONFIDENCE, ShownFields
from .path_estimate import PathEstimate, estimate_path
from .smoothing import SmoothedTrack, smooth_track
from .track import Track

SpeedSource: TypeAlias = Literal["recorded", "fitted"]
ArcLengthSource: TypeAlias = Literal["odometer", "recorded speed", "places"]

LEAST_SPEED: Final = 1.0
"""Smallest speed (m/s) with a heading (modelling assumption: slower than walking; places drift at rest)."""
CERTAIN: Final = 3.0
"""Smallest speed with a heading, in standard errors of the speed."""
LONGEST_HOLE: Final = 1.5
"""Longest time (s) between recorded speeds that is interpolated (modelling assumption: the shortest turns)."""
INTERVAL_FACTOR: Final = float(norm.ppf(0.5 + CONFIDENCE / 2.0))
"""Standard errors on each side of a 95 % interval."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TrackMotion(ShownFields):
    """A track's motion at each of its points, seen along the third axis of its frame.

    time: (n,) s, times of the points.
    arc_length: (n,) m, length of the track from its first point.
    speed: (n,) m/s, recorded speed, otherwise the speed of the estimated path.
    heading, heading_sd: (n,) rad, angle from the frame's first axis, positive towards the second, without jumps; NaN at
        rest.
    curvature, curvature_sd: (n,) 1/m, positive to the left.
    turn_radius, turn_radius_sd: (n,) m, 1 / curvature with its sign; the standard error is that of small errors,
        infinite where the curvature is 0.
    smoothed: smoothed places, velocities and accelerations, with noise and resolution.
    speed_source, arc_length_source: source of most of the speeds, and of the arc length.
    path: estimate of speed and length from places, for a track without recorded speeds; otherwise None.
    """

    time: FloatArray
    arc_length: FloatArray
    speed: FloatArray
    heading: FloatArray
    heading_sd: FloatArray
    curvature: FloatArray
    curvature_sd: FloatArray
    turn_radius: FloatArray
    turn_radius_sd: FloatArray
    smoothed: SmoothedTrack
    speed_source: SpeedSource
    arc_length_source: ArcLengthSource
    path: PathEstimate | None = None


def track_motion(track: Track, *, window: float | None = None, place_noise: float | None = None) -> TrackMotion:
    """Smooth a track and compute its motion.

    track, window, place_noise: as in `skisnow.track.smoothing.smooth_track`.
    Raises ParameterError: too few points, or a window or a noise that is not above 0.

    With x', y' and x'', y'' of the local cubics:  φ = atan2(y', x'),  κ = (x' y'' − y' x'') / (x'² + y'²)^(3/2).
    Errors are propagated to first order. Smoothing decreases the curvature of turns in a constant direction;
    ``smoothed.resolution`` gives by how much. The standard errors do not include this.
    """
    smoothed = smooth_track(track, window=window, place_noise=place_noise)
    fitted = np.linalg.norm(smoothed.velocity, axis=1)
    recorded, speed_source = _recorded_speed(track)
    path = None
    if speed_source == "fitted":
        use, segment = smoothed.usable, segments(track)
        path = estimate_path(track.time[use], track.place[use], smoothed.part[use], segment[use])
    computed = fitted if path is None else path.speed_at(np.maximum.accumulate(track.time))
    speed = np.where(np.isfinite(recorded), recorded, computed)
    arc_length, arc_length_source = _arc_length(track, smoothed, speed, speed_source, path)
    with np.errstate(invalid="ignore"):  # points that move fast enough to have a heading
        moving = (fitted >= LEAST_SPEED) & (fitted >= CERTAIN * np.sqrt(smoothed.covariance[:, 1, 1]))
    heading, heading_sd = np.full(len(fitted), np.nan), np.full(len(fitted), np.nan)
    heading[moving] = np.unwrap(np.arctan2(smoothed.velocity[moving, 1], smoothed.velocity[moving, 0]))
    heading_sd[moving] = np.sqrt(smoothed.covariance[moving, 1, 1]) / fitted[moving]
    curvature, curvature_sd = _curvature(smoothed, np.where(moving, fitted, np.nan))
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = 1.0 / curvature
        radius_sd = np.where(curvature == 0.0, np.inf, curvature_sd / curvature**2)
    return TrackMotion(
        track.time, arc_length, speed, heading, heading_sd, curvature, curvature_sd, radius, radius_sd, smoothed,
        speed_source, arc_length_source, path,
    )  # fmt: skip


def _recorded_speed(track: Track) -> tuple[FloatArray, SpeedSource]:
    """Speed (n,) recorded or from the recorded velocity, otherwise NaN; and the source of most speeds.

    Speeds recorded less often than places are interpolated over at most `LONGEST_HOLE`.
    """
    speed = track.speed.astype(float)
    if track.velocity is not None:
        whole = np.linalg.norm(np.nan_to_num(track.velocity), axis=1)
        has_velocity = np.isfinite(track.velocity[:, :2]).all(axis=1)
        speed = np.where(np.isnan(speed) & has_velocity, whole, speed)
    placed = np.flatnonzero(np.isfinite(speed) & track.usable)
    if len(placed) < 2:
        return speed, "fitted"
    time = np.maximum.accumulate(track.time)
    holes = np.diff(time[placed])
    step = np.searchsorted(time[placed], time, side="right") - 1
    inside = (step >= 0) & (step < len(holes))
    close = np.zeros(len(time), dtype=bool)
    close[inside] = holes[step[inside]] <= max(LONGEST_HOLE, 2.0 * float(np.median(np.diff(time))))
    speed = np.where(np.isnan(speed) & close, np.interp(time, time[placed], speed[placed]), speed)
    recorded = np.isfinite(speed)
    source: SpeedSource = "recorded" if 2 * np.count_nonzero(recorded) >= len(track) else "fitted"
    return speed, source


def _arc_length(
    track: Track, smoothed: SmoothedTrack, speed: FloatArray, speed_source: SpeedSource, path: PathEstimate | None
) -> tuple[FloatArray, ArcLengthSource]:
    """Arc length (n,) by the odometer, else by the recorded speed, else of the estimated path; and its source.

    The odometer is interpolated in time over gaps; it can begin above 0.
    """
    if track.odometer is not None and np.count_nonzero(np.isfinite(track.odometer)) >= 2:
        recorded, time = np.isfinite(track.odometer), np.maximum.accumulate(track.time)
        return np.interp(time, time[recorded], np.maximum.accumulate(track.odometer[recorded])), "odometer"
    if speed_source == "recorded":
        return integrated_arc_length(track, smoothed, speed), "recorded speed"
    if path is not None:
        return path.arc_length_at(np.maximum.accumulate(track.time)), "places"
    return places_arc_length(track, smoothed), "places"


def integrated_arc_length(track: Track, smoothed: SmoothedTrack, speed: FloatArray) -> FloatArray:
    """Integral (n,) (m) of the speed by the trapezoidal rule; straight over gaps, nothing between segments."""
    rising, chosen = np.maximum.accumulate(track.time), track.usable
    has_speed = np.isfinite(speed) & chosen
    if not has_speed.any():
        return np.zeros_like(rising)
    whole = np.interp(rising[chosen], rising[has_speed], speed[has_speed])
    steps = np.diff(rising[chosen]) * (whole[1:] + whole[:-1]) / 2.0
    gap = np.diff(smoothed.part[chosen]) > 0
    steps[gap] = np.linalg.norm(np.diff(track.place[chosen, :2], axis=0)[gap], axis=1)
    steps[np.diff(segments(track)[chosen]) > 0] = 0.0
    return np.interp(rising, rising[chosen], np.concatenate([[0.0], np.cumsum(steps)]))


def places_arc_length(track: Track, smoothed: SmoothedTrack) -> FloatArray:
    """Length (n,) (m) of the smoothed track, with the recorded heights if there are any.

    The path is straight over gaps, and nothing counts between segments.
    """
    chosen = smoothed.usable
    place = np.where(np.isfinite(smoothed.place), smoothed.place, track.place[:, :2])[chosen]
    steps = np.sum(np.diff(place, axis=0) ** 2, axis=1)
    recorded = np.where(chosen, track.place[:, 2], np.nan)
    height = running_mean(track.time, recorded, smoothed.resolution.window, segments(track))
    rises = np.nan_to_num(np.diff(height[chosen]))
    lengths = np.where(np.diff(segments(track)[chosen]) > 0, 0.0, np.sqrt(steps + rises**2))
    arc_length = np.concatenate([[0.0], np.cumsum(lengths)])
    rising = np.maximum.accumulate(track.time)
    return np.interp(rising, rising[chosen], arc_length)


def segments(track: Track) -> IntArray:
    """Number (n,) of the segment of each point, from 0: the file begins a new one after a pause."""
    begins = track.flags.get("new_segment")
    return np.zeros(len(track), dtype=np.int64) if begins is None else np.cumsum(begins).astype(np.int64)


def running_mean(time: FloatArray, values: FloatArray, window: float, segment: IntArray) -> FloatArray:
    """Mean (n,) of the known values of a segment within half a window (s) of each point, NaN if none is known."""
    finite = np.isfinite(values)
    rising = np.maximum.accumulate(time)
    first = np.searchsorted(rising, rising - window / 2.0, side="left")
    last = np.searchsorted(rising, rising + window / 2.0, side="right")
    first = np.maximum(first, np.searchsorted(segment, segment, side="left"))
    last = np.minimum(last, np.searchsorted(segment, segment, side="right"))
    base = float(np.mean(values[finite])) if finite.any() else 0.0
    sums = np.concatenate([[0.0], np.cumsum(np.where(finite, values - base, 0.0))])
    counts = np.concatenate([[0], np.cumsum(finite)])
    count = counts[last] - counts[first]
    mean = base + (sums[last] - sums[first]) / np.maximum(count, 1)
    return np.where(finite & (count > 0), mean, np.nan)


def _curvature(smoothed: SmoothedTrack, speed: FloatArray) -> tuple[FloatArray, FloatArray]:
    """κ and its standard error to first order in the errors of velocity and acceleration; NaN without a speed (m/s)."""
    (vx, vy), (ax, ay) = smoothed.velocity.T, smoothed.acceleration.T
    curvature = (vx * ay - vy * ax) / speed**3
    by_velocity = np.stack([ay, -ax]) / speed**3 - 3.0 * curvature * np.stack([vx, vy]) / speed**2
    by_acceleration = np.stack([-vy, vx]) / speed**3
    covariance = smoothed.covariance
    variance = (
        covariance[:, 1, 1] * np.sum(by_velocity**2, axis=0)
        + 2.0 * covariance[:, 1, 2] * np.sum(by_velocity * by_acceleration, axis=0)
        + covariance[:, 2, 2] * np.sum(by_acceleration**2, axis=0)
    )
    return curvature, np.sqrt(np.maximum(variance, 0.0))
