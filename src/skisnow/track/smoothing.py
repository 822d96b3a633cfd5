"""Smoothed tracks: place, velocity and acceleration with standard errors, and the resolution of the smoothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.errors import ParameterError
from .._support.units import ShownFields
from .local_cubic import FEWEST_POINTS, TERMS, WeightedValues, local_cubic
from .track import GAP_FACTOR, Track

SHORTEST_INTERVAL: Final = 1e-6
"""Time (s) between points, as the median, below which it is not one of a receiver (modelling assumption)."""
SHORTEST_WINDOW: Final = 0.8
"""Default length (s) of the window where points are dense. Modelling assumption: a slalom turn takes 0.8 to 1 s."""
MOST_IN_WINDOW: Final = 10_000
"""Maximum number of points in a window; more than any receiver records."""
POINTS_IN_WINDOW: Final = 8.0
"""Default length of the window in intervals between points, where that is longer. Modelling assumption: five points
to spare."""
_SURPRISING: Final = 0.999
"""Probability of the scatter of a window, given the noise, above which its own scatter is used instead."""
_LOWEST_PLACE_NOISE: Final = 1e-9
"""Smallest noise (m), so that rounding errors of a track without noise are not a signal."""
_LOWEST_RATE_NOISE: Final = 1e-4
"""Smallest noise of velocities times half a window, in shares of that of places: with less, few velocities would hide
the places from the normal equations."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SmoothedTrack(ShownFields):
    """A track in the plane of its frame as locally fitted cubics, one around each point.

    place, velocity, acceleration: (n, 2), m, m/s, m/s²; NaN where a window has fewer than six usable points.
    covariance: (n, 3, 3), covariance of place, velocity and acceleration of one coordinate; both coordinates have the
        same one and are independent.
    part: (n,), number of the stretch without a gap of each point.
    usable: (n,), points that were fitted.
    place_noise, speed_noise: standard deviation of a coordinate (m) and of a component of the recorded velocity (m/s)
        about the fits, without drifts slower than the window; None if no velocities were recorded.
    resolution: length of the window, and its transfer function.
    """

    place: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    covariance: FloatArray
    part: IntArray
    usable: BoolArray
    place_noise: float
    speed_noise: float | None
    resolution: Resolution


def smooth_track(track: Track, *, window: float | None = None, place_noise: float | None = None) -> SmoothedTrack:
    """Fit cubics to the track's places and recorded velocities.

    track: at least six usable points.
    window: length of the window (s). None: eight intervals between points, at least 0.8 s.
    place_noise: standard deviation of a coordinate (m). None: from the scatter about the fits.
    Raises ParameterError: too few points, or a window or a noise that is not above 0.

    If the track states a standard deviation for each point, it gives the weights. The size of the noise is estimated
    from the scatter, because most of the stated error is a slow drift that does not bend the path. Windows are moved
    inwards at the ends of a part, so that they keep their length.
    """
    _require_positive("window", "s", window)
    _require_positive("place_noise", "m", place_noise)
    usable = track.usable & np.isfinite(track.time)
    latest = np.maximum.accumulate(np.where(usable, track.time, -np.inf))
    usable[1:] &= track.time[1:] > latest[:-1]
    if np.count_nonzero(usable) < FEWEST_POINTS:
        raise ParameterError("{name}: {count} usable points; a smoothed track needs {fewest}. Give a longer track").tag(
            "too_few_points", name=track.name, count=np.count_nonzero(usable), fewest=FEWEST_POINTS
        )
    step = _median_step(track.time[usable])
    if step < SHORTEST_INTERVAL:
        raise ParameterError(
            "{name}: the points are {interval:.3g} s apart. Allowed: at least {least:g} s. Check the column of times "
            "and its unit"
        ).tag("too_many_points", name=track.name, interval=step, least=SHORTEST_INTERVAL)
    length = max(SHORTEST_WINDOW, POINTS_IN_WINDOW * step) if window is None else window
    part = parts(track, usable)
    windows = window_bounds(track.time, part, length)
    count = windows[1] - windows[0]
    if count.max() > MOST_IN_WINDOW:  # the time of the fits grows with this number
        at, most = int(np.argmax(count)), MOST_IN_WINDOW
        raise ParameterError(
            "{name}: {count} points are within {length:.3g} s of {time:.6g} s. Allowed: at most {most}. Check the "
            "column of times, or give fewer points"
        ).tag("too_many_points", name=track.name, count=count[at], length=length, time=track.time[at], most=most)
    place, rate = _places(track, usable), _weighted_velocities(track, usable)
    noises = _noises(track.time, windows, length / 2.0, place, rate)
    noises = (noises[0] if place_noise is None else place_noise, noises[1])
    place = WeightedValues(place.values, place.weight / noises[0] ** 2)
    rate = None if rate is None or noises[1] is None else WeightedValues(rate.values, rate.weight / noises[1] ** 2)
    half = length / 2.0
    fits = local_cubic(track.time, windows, half, place, rate)
    fits.coefficients[:, 0] += place.values  # the fits count from each point's own place
    to_si = np.array([1.0, 1.0 / half, 2.0 / half**2])
    derivatives = fits.coefficients[:, :3] * to_si[:, None]
    # the variance of a window counts instead of the noise if it is significantly larger
    degrees = np.maximum(2.0 * (fits.place_count + fits.rate_count - TERMS), 1.0)
    scatter = (fits.place_misfit + fits.rate_misfit) / degrees
    excess = np.where(scatter > chi2.ppf(_SURPRISING, degrees) / degrees, scatter, 1.0)
    covariance = fits.covariance[:, :3, :3] * np.outer(to_si, to_si) * excess[:, None, None]
    typical = (noises[0], None if rate is None else noises[1])
    resolution = Resolution.of_window(length, step, *typical)
    at, velocity, acceleration = np.moveaxis(derivatives, 1, 0)
    return SmoothedTrack(at, velocity, acceleration, covariance, part, usable, *typical, resolution)


def parts(track: Track, usable: BoolArray) -> IntArray:
    """Number of the part of each point: a new one begins after a gap, an impossible step and with a new segment.

    usable: points that count; the others get the number of the point before. A time without usable points that is as
        long as a gap is a gap, too.
    """
    begins = np.zeros(len(track), dtype=bool)
    for code in ("gap", "impossible_step", "new_segment"):
        begins |= track.flags.get(code, False)
    chosen = np.flatnonzero(usable)
    late = np.diff(track.time[chosen]) > GAP_FACTOR * _median_step(track.time[chosen])
    begins[chosen[1:][late]] = True
    return np.cumsum(begins).astype(np.int64)


def window_bounds(time: FloatArray, part: IntArray, length: float) -> tuple[IntArray, IntArray]:
    """First point of the window about each point and the one after its last, within the point's part."""
    rising = np.maximum.accumulate(time)
    begin = np.searchsorted(part, part, side="left")
    end = np.searchsorted(part, part, side="right")
    latest = np.maximum(rising[end - 1] - length, rising[begin])
    left = np.clip(rising - length / 2.0, rising[begin], latest)
    edge = 1e-9 * length  # points on the window's rim belong to it whatever their rounding
    first = np.maximum(np.searchsorted(rising, left - edge, side="left"), begin)
    last = np.minimum(np.searchsorted(rising, left + length + edge, side="right"), end)
    return first.astype(np.int64), last.astype(np.int64)


def _median_step(time: FloatArray) -> float:
    """Median of the steps between times (s)."""
    return float(np.median(np.diff(time)))


def _require_positive(name: str, unit: str, value: float | None) -> None:
    """Reject a number that is not above 0 and finite; None is accepted."""
    if value is not None and not (np.isfinite(value) and value > 0.0):
        raise ParameterError("{name} is {value:g} {unit}. Allowed: above 0").tag(
            "out_of_range", name=name, value=value, unit=unit
        )


def _places(track: Track, usable: BoolArray) -> WeightedValues:
    """Places with weights relative to the median, from the stated standard deviations if there are any."""
    weight = usable.astype(float)
    if track.place_sd is not None:
        stated = np.sqrt(np.mean(track.place_sd[:, :2] ** 2, axis=1))
        has_sd = usable & np.isfinite(stated) & (stated > 0.0)
        if has_sd.any():
            weight[has_sd] *= (np.median(stated[has_sd]) / stated[has_sd]) ** 2
    # an unknown place is replaced by the last known one, at the start by the next
    last = np.maximum.accumulate(np.where(usable, np.arange(len(usable)), -1))
    return WeightedValues(track.place[np.where(last < 0, int(np.argmax(usable)), last), :2], weight)


def _weighted_velocities(track: Track, usable: BoolArray) -> WeightedValues | None:
    """Horizontal velocities (m/s) with weights by their stated accuracy; None if too few points have one."""
    if track.velocity is None:
        return None
    has_velocity = usable & np.isfinite(track.velocity[:, :2]).all(axis=1)
    if np.count_nonzero(has_velocity) < FEWEST_POINTS:
        return None
    weight = has_velocity.astype(float)
    if track.speed_sd is not None:
        stated = has_velocity & np.isfinite(track.speed_sd) & (track.speed_sd > 0.0)
        if stated.any():
            weight[stated] *= (np.median(track.speed_sd[stated]) / track.speed_sd[stated]) ** 2
    return WeightedValues(np.where(has_velocity[:, None], track.velocity[:, :2], 0.0), weight)


def _noises(
    time: FloatArray,
    windows: tuple[IntArray, IntArray],
    half: float,
    place: WeightedValues,
    rate: WeightedValues | None,
) -> tuple[float, float | None]:
    """Standard deviations (m) of places and (m/s) of velocities about their cubics; None if velocities are too few."""
    fits = local_cubic(time, windows, half, place, None)
    place_noise = max(_noise(fits.place_misfit, fits.place_count - TERMS), _LOWEST_PLACE_NOISE)
    if rate is None:
        return place_noise, None
    fits = local_cubic(time, windows, half, rate, None)
    if (fits.place_count < FEWEST_POINTS).all():
        return place_noise, None
    lowest = max(_LOWEST_PLACE_NOISE, _LOWEST_RATE_NOISE * place_noise) / half
    return place_noise, max(_noise(fits.place_misfit, fits.place_count - TERMS), lowest)


def _noise(misfit: FloatArray, freedom: IntArray) -> float:
    """Standard deviation from the median scatter of the windows, which is robust against single windows."""
    usable = np.isfinite(misfit) & (freedom > 0)
    if not usable.any():
        return 0.0
    degrees = 2.0 * freedom[usable]  # two coordinates
    return float(np.sqrt(np.median(misfit[usable] / chi2.ppf(0.5, degrees))))


@dataclass(frozen=True, slots=True)
class Resolution:
    """The transfer function of local cubics on evenly spaced points, away from ends and gaps.

    window: length of the window (s).
    offsets: times (s) of the points of a window from its middle.
    place_weights, rate_weights: the estimate of the acceleration is the sum of these times places (1/s²) and recorded
        velocities (1/s).
    """

    window: float
    offsets: tuple[float, ...]
    place_weights: tuple[float, ...]
    rate_weights: tuple[float, ...]

    @classmethod
    def of_window(cls, window: float, interval: float, place_noise: float, rate_noise: float | None) -> Resolution:
        """Resolution of a window (s), from the interval of points (s) and noises of places (m) and velocities."""
        each_side = int(np.floor(window / 2.0 / interval + 1e-9))
        stride = max(1, each_side // 200)  # a dense window's transfer function needs no more points
        tau = np.arange(-each_side, each_side + 1, stride) * interval
        powers = np.arange(4)
        rows = tau[:, None] ** powers / place_noise
        if rate_noise is not None:
            slopes = powers * tau[:, None] ** np.maximum(powers - 1, 0) / rate_noise
            rows = np.concatenate([rows, slopes])
        scale = (window / 2.0) ** powers
        weights = 2.0 * np.linalg.pinv(rows / scale)[2] / scale[2]
        place, rate = weights[: len(tau)] / place_noise, weights[len(tau) :]
        faster = () if rate_noise is None else tuple((rate / rate_noise).tolist())
        return cls(window, tuple(tau.tolist()), tuple(place.tolist()), faster)

    def share_passed(self, period: float) -> float:
        """Share of the amplitude of a curvature that swings with this period (s), on a path that is nearly straight."""
        angular = 2.0 * np.pi / period
        tau = np.array(self.offsets)
        passed = np.array(self.place_weights) @ np.cos(angular * tau)
        if self.rate_weights:
            passed -= angular * (np.array(self.rate_weights) @ np.sin(angular * tau))
        return float(-passed / angular**2)

    def period_passed(self, share: float) -> float:
        """Shortest period (s) of which this share of the amplitude passes, and of all longer ones more.

        share: between 0.1 and 0.99.
        """
        low, high = 0.4 * self.window, 0.4 * self.window
        while self.share_passed(high) < share:
            low, high = high, 1.05 * high
        return high if low == high else float(brentq(lambda period: self.share_passed(period) - share, low, high))

    @property
    def half_period(self) -> float:
        """Period (s) of which half of the amplitude is left: the resolution. Shorter swings are smoothed away."""
        return self.period_passed(0.5)
