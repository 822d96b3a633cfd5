"""A track in a slope's frame: x down the fall line, y to the left, z out of the snow."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Literal

import numpy as np

from .._support.errors import ParameterError
from .._support.units import DEGREE
from .track import Track

if TYPE_CHECKING:
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float64]

STEEPEST: Final = 75.0 * DEGREE
"""Steepest slope (rad), as for scenarios."""


def slope_axes(fall_line_azimuth: float, slope_angle: float) -> FloatArray:
    """Unit vectors x (down the fall line), y (left), z (out of the snow), (3, 3), one a row, in east, north, up.

    Parameters
    ----------
    fall_line_azimuth : rad
        Compass direction in which the slope falls, clockwise from north.
    slope_angle : rad
        Inclination; 0 leaves z vertical.

    >>> slope_axes(0.0, math.pi / 6).round(3).tolist()
    [[0.0, 0.866, -0.5], [-1.0, 0.0, 0.0], [0.0, 0.5, 0.866]]
    """
    sine, cosine = math.sin(fall_line_azimuth), math.cos(fall_line_azimuth)
    fall, rise = math.cos(slope_angle), math.sin(slope_angle)
    return (
        np.array(
            [[fall * sine, fall * cosine, -rise], [-cosine, sine, 0.0], [rise * sine, rise * cosine, fall]], dtype=float
        )
        + 0.0
    )


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
        Where x, y, z are zero, in the track's frame; left out, the track's own origin.
    missing_height
        What to do where the height is missing: "nan" gives x and z as NaN on an inclined plane, for they cannot be
        known; "on_slope" takes the point, and the vertical part of a velocity, to lie in the slope's surface.

    Returns
    -------
    Track
        Standard deviations are turned as if the errors of east, north and up did not depend on each other.

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
    _require(track, fall_line_azimuth, slope_angle, origin)
    angle = slope_angle or 0.0
    axes = slope_axes(fall_line_azimuth, angle)
    place = _turned(track.place - np.asarray(origin, float), axes, missing_height)
    velocity = None if track.velocity is None else _turned(track.velocity, axes, missing_height)
    place_sd = None if track.place_sd is None else _turned_sd(track.place_sd, axes)
    return dataclasses.replace(
        track,
        place=place,
        velocity=velocity,
        place_sd=place_sd,
        axes="slope",
        slope_angle=angle,
        frame=_words(track, fall_line_azimuth, slope_angle, origin),
    )


def _turned(vectors: FloatArray, axes: FloatArray, missing_height: str) -> FloatArray:
    """Components along the axes; a missing vertical part spoils only what it takes part in."""
    horizontal = vectors[:, :2]
    vertical = vectors[:, 2]
    if missing_height == "on_slope":  # in the surface z = 0: up = -(z_east east + z_north north)/z_up
        vertical = np.where(np.isnan(vertical), -(horizontal @ axes[2, :2]) / axes[2, 2], vertical)
    parts = [np.where(axis[2] == 0.0, 0.0, axis[2] * vertical) for axis in axes]
    return np.asarray(horizontal @ axes[:, :2].T + np.stack(parts, axis=-1))


def _turned_sd(sd: FloatArray, axes: FloatArray) -> FloatArray:
    parts = np.where(axes[None] == 0.0, 0.0, (axes[None] * sd[:, None, :]) ** 2)
    return np.asarray(np.sqrt(parts.sum(axis=-1)))


def _require(track: Track, azimuth: float, slope_angle: float | None, origin: Sequence[float] | FloatArray) -> None:
    if track.axes == "slope":
        raise ParameterError(f"the track {track.name} is in a slope's frame already: {track.frame}")
    if not abs(azimuth) <= 2.0 * math.pi:
        raise ParameterError(
            f"the fall line's azimuth is {azimuth:g} rad; it must be from -2π to 2π. Is it in degrees?"
        )
    if slope_angle is not None and not 0.0 <= slope_angle <= STEEPEST:
        raise ParameterError(f"the slope angle is {slope_angle:g} rad; it must be from 0 to 75° = {STEEPEST:.4g} rad")
    place = np.asarray(origin, float)
    if place.shape != (3,) or not np.isfinite(place).all():
        raise ParameterError(f"the origin of a slope is {origin!r}; it must be three finite numbers in m")


def _words(track: Track, azimuth: float, slope_angle: float | None, origin: Sequence[float] | FloatArray) -> str:
    east, north, up = (float(value) for value in origin)
    axes = (
        "x horizontal distance down the fall line, y to the left, z height"
        if slope_angle is None
        else f"x down the fall line, y to the left, z out of a plane slope of {slope_angle / DEGREE:.6g}°"
    )
    return (
        f"{axes}, in m; fall line towards {azimuth / DEGREE:.6g}° from north; origin at "
        f"({east:g}, {north:g}, {up:g}) m of: {track.frame}"
    )
