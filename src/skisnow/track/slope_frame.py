"""Tracks and slopes: a measured track in a slope's axes, and a track in a slope's axes on the horizontal map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, Literal, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import DEGREE
from .track import Track

STEEPEST: Final = 75.0 * DEGREE
"""Steepest slope (rad), as for scenarios."""


def slope_axes(fall_line_azimuth: float, slope_angle: float) -> FloatArray:
    """Unit vectors x (down the fall line), y (left), z (out of the snow), (3, 3), one a row, in east, north, up.

    fall_line_azimuth: rad, compass direction in which the slope falls, clockwise from north.
    slope_angle: rad, inclination; 0 leaves z vertical.

    >>> slope_axes(0.0, math.pi / 6).round(3).tolist()
    [[0.0, 0.866, -0.5], [-1.0, 0.0, 0.0], [0.0, 0.5, 0.866]]
    """
    sine, cosine = math.sin(fall_line_azimuth), math.cos(fall_line_azimuth)
    fall, rise = math.cos(slope_angle), math.sin(slope_angle)
    axes = [[fall * sine, fall * cosine, -rise], [-cosine, sine, 0.0], [rise * sine, rise * cosine, fall]]
    return np.array(axes, dtype=float) + 0.0  # no negative zeros


def in_slope_frame(
    track: Track,
    *,
    fall_line_azimuth: float,
    slope_angle: float | None,
    origin: Sequence[float] | FloatArray = (0.0, 0.0, 0.0),
    missing_height: Literal["nan", "on_slope"] = "nan",
) -> Track:
    """The same track with x down the fall line, y to the left and z out of the snow.

    Parameters
    ----------
    track
        In east, north, up; of a track in the file's own metres x is taken as east, y as north, z as up.
    fall_line_azimuth : rad
        Compass direction in which the slope falls, clockwise from north (0 north, π/2 east).
    slope_angle : rad or None
        Inclination of a plane slope, from 0 to 75°. None for a measured profile: x is then the horizontal distance down
        the fall line and z the height, as on a profile of a scenario.
    origin : (3,) m
        Point with x = y = z = 0, in the track's frame (default: the track's origin).
    missing_height
        Treatment of points without height: "nan" gives NaN for x and z on an inclined plane; "on_slope" puts the point,
        and the velocity, in the slope's surface.

    Returns
    -------
    Track
        Standard deviations are rotated as if the errors of east, north and up were independent.

    Raises
    ------
    ParameterError
        The track is in a slope's frame already, or an argument is outside its range.

    See Also
    --------
    skisnow.read_track : the track to turn.

    References
    ----------
    The page docs/files/track.md.
    """
    if track.axes == "slope":
        raise ParameterError("the track {name} is in a slope's frame already: {frame}").tag(
            "already_on_slope", name=track.name, frame=track.frame
        )
    if not abs(fall_line_azimuth) <= 2.0 * math.pi:
        raise ParameterError(
            "the fall line's azimuth is {azimuth:g} rad; it must be from -2π to 2π. Is it in degrees?"
        ).tag("out_of_range", azimuth=fall_line_azimuth)
    if slope_angle is not None and not 0.0 <= slope_angle <= STEEPEST:
        raise ParameterError(
            "the slope angle is {slope_angle:g} rad; it must be from 0 to 75° = {steepest:.4g} rad"
        ).tag("out_of_range", slope_angle=slope_angle, steepest=STEEPEST)
    zero = np.asarray(origin, float)
    if zero.shape != (3,) or not np.isfinite(zero).all():
        raise ParameterError("the origin of a slope is {value!r}; it must be three finite numbers in m").tag(
            "not_a_number", value=origin
        )
    angle = slope_angle or 0.0
    axes = slope_axes(fall_line_azimuth, angle)
    place = _rotate(track.place - zero, axes, missing_height)
    velocity = None if track.velocity is None else _rotate(track.velocity, axes, missing_height)
    place_sd = None
    if track.place_sd is not None:
        parts = np.where(axes[None] == 0.0, 0.0, (axes[None] * track.place_sd[:, None, :]) ** 2)
        place_sd = np.asarray(np.sqrt(parts.sum(axis=-1)))
    words = "x horizontal distance down the fall line, y to the left, z height"
    if slope_angle is not None:
        words = f"x down the fall line, y to the left, z out of a plane slope of {slope_angle / DEGREE:.6g}°"
    frame = (
        f"{words}, in m; fall line towards {fall_line_azimuth / DEGREE:.6g}° from north; origin at "
        f"({', '.join(f'{value:g}' for value in zero)}) m of: {track.frame}"
    )
    track = replace(track, place=place, velocity=velocity, place_sd=place_sd)
    return replace(track, axes="slope", slope_angle=angle, frame=frame)


def _rotate(vectors: FloatArray, axes: FloatArray, missing_height: str) -> FloatArray:
    """Components along the axes; a missing vertical component gives NaN only where it contributes."""
    horizontal = vectors[:, :2]
    vertical = vectors[:, 2]
    if missing_height == "on_slope":  # in the surface z = 0: up = -(z_east east + z_north north)/z_up
        vertical = np.where(np.isnan(vertical), -(horizontal @ axes[2, :2]) / axes[2, 2], vertical)
    parts = [np.where(axis[2] == 0.0, 0.0, axis[2] * vertical) for axis in axes]
    return np.asarray(horizontal @ axes[:, :2].T + np.stack(parts, axis=-1))


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
    """Track in horizontal axes: x horizontal down the fall line, y to the left and z up.

    track: in the axes of a plane slope; a point without height is taken to be on the plane.
    slope_angle: rad, inclination of the slope.
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
    points = track.usable & np.isfinite(track.place[:, 2])
    if points.sum() < _FEWEST:
        return None
    place = track.place[points] - track.place[points].mean(axis=0)
    left, sizes, right = np.linalg.svd(place[:, :2], full_matrices=False)
    if not sizes[0] > 0.0:
        return None
    slope = np.divide(left.T @ place[:, 2], sizes, out=np.zeros(2), where=sizes > 1e-9 * sizes[0])
    rest = place[:, 2] - place[:, :2] @ (right.T @ slope)
    error = float(np.sqrt((rest @ rest) / (len(rest) - 3))) / sizes
    slope[1] *= abs(slope[1]) > CLEARLY * error[1]  # across a narrow track
    return Inclination(math.atan(float(np.linalg.norm(slope))), float(error[0]))


class LaidTracks(NamedTuple):
    """Two tracks in a common horizontal map, after one of them was rotated onto it.

    simulated, measured: the tracks.
    angle: rad or None, inclination by which one was rotated; None if it is unknown or was not needed.
    source: source of the inclination, in words; None if `angle` is None.
    warnings: sentences on inclinations that disagree, or are unknown.
    """

    simulated: Track
    measured: Track
    angle: float | None = None
    source: Message | None = None
    warnings: tuple[Message, ...] = ()


def lay_for_fit(simulated: Track, measured: Track, slope_angle: float | None) -> LaidTracks:
    """Lay the track in a slope's axes on the map of the other one, before start and heading are fitted.

    The inclination is the one that is given, else that of the track's slope, else that of the other track's heights.

    slope_angle: rad or None, inclination of the slope, if it is given.
    """
    if measured.axes != "east_north_up" == simulated.axes:
        swapped = lay_for_fit(measured, simulated, slope_angle)
        return swapped._replace(simulated=swapped.measured, measured=swapped.simulated)
    own, other = inclination(simulated), inclination(measured)
    falls = None if other is None else other.angle - (own.angle if own else 0.0)
    steeper = other is not None and other.exceeds(own.angle if own else 0.0)
    apart = measured.axes == "east_north_up" != simulated.axes
    angle, source = slope_angle, Message("as given")
    if angle is None and simulated.slope_angle is not None and (apart or steeper):
        angle, source = simulated.slope_angle, Message("of {name}", name=simulated.name)
    if angle is None and falls is not None and other is not None and (steeper or (apart and other.error < DEGREE)):
        angle, source = max(falls, 0.0), Message("from the heights of {name}", name=measured.name)
    if angle is None:
        unknown = Message(
            "the slope's angle is unknown: metres of {name} on the slope are compared with shorter metres on the map. "
            "Give the slope's angle",
            name=simulated.name,
        )
        return LaidTracks(simulated, measured, warnings=(unknown,) if apart else ())
    warnings: tuple[Message, ...] = ()
    # in its own axes a track falls along a profile, whose z is the height, but not in a slope's axes
    own_fall = own.angle if own is not None and not simulated.slope_angle else 0.0
    if other is not None and abs(other.angle - angle - own_fall) > CLEARLY * max(other.error, DEGREE):
        warnings = (
            Message(
                "{name} falls by {fall:.1f}°, the slope by {angle:.1f}° ({source}): check the slope's angle and the "
                "heights, or compare from above",
                name=measured.name,
                fall=other.angle / DEGREE,
                angle=angle / DEGREE,
                source=source,
            ),
        )
    return LaidTracks(lay_on_slope(simulated, angle) if angle else simulated, measured, angle, source, warnings)
