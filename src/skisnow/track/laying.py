"""A track in a slope's axes, laid on the horizontal map by the slope's angle.

Metres down a slope of angle α are cos α times as long on the map. Two tracks can be compared, and one fitted to the
other, only after this.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from .._support.units import DEGREE
from .track import Track

CLEARLY: Final = 3.0
"""Standard errors, and degrees, by which two inclinations must differ to count as different (modelling assumption)."""
_FEWEST: Final = 4


class Inclination(NamedTuple):
    """Angle of the plane through a track, and its standard error (rad)."""

    angle: float
    error: float

    def exceeds(self, angle: float) -> bool:
        """True if the track is clearly steeper than an angle (rad)."""
        return self.angle - angle > CLEARLY * max(self.error, DEGREE)


def lay_on_slope(track: Track, slope_angle: float) -> Track:
    """The track with x horizontal down the fall line, y to the left and z up.

    Parameters
    ----------
    track
        In the axes of a plane slope; a point without height is taken to be on the plane.
    slope_angle : rad
        Inclination of the slope.
    """
    x, y, z = track.place.T
    out = np.where(np.isnan(z), 0.0, z)
    sine, cosine = math.sin(slope_angle), math.cos(slope_angle)
    place = np.column_stack([cosine * x + sine * out, y, cosine * out - sine * x])
    frame = f"x horizontal down the fall line, y to the left, z up, on a slope of {slope_angle / DEGREE:.4g}°"
    return replace(track, place=place, slope_angle=0.0, frame=frame)


def inclination(track: Track) -> Inclination | None:
    """Inclination of the plane through the usable points; None with fewer than four heights.

    >>> x = np.linspace(0.0, 9.0, 10)
    >>> place = np.column_stack([x, x % 3.0, -np.tan(0.2) * x])
    >>> found = inclination(Track("made", x, place, x, "local", "made"))
    >>> round(found.angle, 12)
    0.2
    """
    known = track.usable & np.isfinite(track.place[:, 2])
    if known.sum() < _FEWEST:
        return None
    place = track.place[known] - track.place[known].mean(axis=0)
    left, sizes, right = np.linalg.svd(place[:, :2], full_matrices=False)
    if not sizes[0] > 0.0:
        return None
    slope = np.divide(left.T @ place[:, 2], sizes, out=np.zeros(2), where=sizes > 1e-9 * sizes[0])
    rest = place[:, 2] - place[:, :2] @ (right.T @ slope)
    error = float(np.sqrt((rest @ rest) / (len(rest) - 3))) / sizes
    slope[1] *= abs(slope[1]) > CLEARLY * error[1]  # across a narrow track
    return Inclination(math.atan(float(np.linalg.norm(slope))), float(error[0]))


class Laid(NamedTuple):
    """Two tracks after one of them was laid on the map.

    Attributes
    ----------
    simulated, measured
        The tracks.
    angle : rad or None
        Inclination by which one was laid; None if it is unknown or was not needed.
    source
        Where the inclination is from, in words.
    warnings
        Sentences on inclinations that disagree, or are unknown.
    """

    simulated: Track
    measured: Track
    angle: float | None = None
    source: str = ""
    warnings: tuple[str, ...] = ()


def lay_for_fit(simulated: Track, measured: Track, slope_angle: float | None) -> Laid:
    """Lay the track in a slope's axes on the map of the other one, before start and heading are fitted.

    The inclination is the one that is given, else that of the track's slope, else that of the other track's heights.

    Parameters
    ----------
    slope_angle : rad or None
        Inclination of the slope, if it is given.
    """
    if measured.axes != "east_north_up" == simulated.axes:
        swapped = lay_for_fit(measured, simulated, slope_angle)
        return swapped._replace(simulated=swapped.measured, measured=swapped.simulated)
    own, other = inclination(simulated), inclination(measured)
    falls = None if other is None else other.angle - (own.angle if own else 0.0)
    steeper = other is not None and other.exceeds(own.angle if own else 0.0)
    apart = measured.axes == "east_north_up" != simulated.axes
    angle, source = slope_angle, "as given"
    if angle is None and simulated.slope_angle is not None and (apart or steeper):
        angle, source = simulated.slope_angle, f"of {simulated.name}"
    if angle is None and falls is not None and other is not None and (steeper or (apart and other.error < DEGREE)):
        angle, source = max(falls, 0.0), f"from the heights of {measured.name}"
    if angle is None:
        return Laid(simulated, measured, warnings=(_unknown(simulated),) if apart else ())
    warnings: tuple[str, ...] = ()
    if other is not None and abs(other.angle - angle - _own_fall(simulated, own)) > CLEARLY * max(other.error, DEGREE):
        warnings = (
            f"{measured.name} falls by {other.angle / DEGREE:.1f}°, the slope by {angle / DEGREE:.1f}° ({source}): "
            "check the slope's angle and the heights, or compare from above",
        )
    return Laid(lay_on_slope(simulated, angle) if angle else simulated, measured, angle, source, warnings)


def _own_fall(track: Track, own: Inclination | None) -> float:
    """Inclination of a track in its own axes: of a track along a profile, whose z is the height."""
    return own.angle if own is not None and not track.slope_angle else 0.0


def _unknown(track: Track) -> str:
    return (
        f"the slope's angle is unknown: metres of {track.name} on the slope are compared with shorter metres on the "
        "map. Give the slope's angle"
    )
