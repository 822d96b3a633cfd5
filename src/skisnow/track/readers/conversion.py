"""Conversion of a recording to a track: validation, selection of points with a fix, projection, flags."""

from __future__ import annotations

from dataclasses import fields, replace
from datetime import UTC, datetime, timedelta
from typing import Any, Final

import numpy as np

from ..._support.arrays import BoolArray, FloatArray
from ..._support.messages import Message
from ..projection import GeodeticPoint, east_north_up, rotate_to_origin
from ..track import Track, point_flags
from .recording import GEODETIC, LOCAL, MOTION, Recording, track_error
from .text import spread_times


def build_track(recording: Recording, *, origin: GeodeticPoint | None = None) -> Track:
    """Convert a recording to a track: validate it, project it about its origin, and compute flags.

    Raises FieldDataError: there is no point, no point has a place, times run backwards, a number is out of range, or an
        origin is given for a file in local metres.
    """
    _require_points(recording)
    recording, fix = fixed_points(recording, _fix(recording))
    _require_in_range(recording)
    _require_time(recording)
    place, velocity, at = _projected(recording, fix, origin)
    negative = np.isfinite(recording.speed) & (recording.speed < 0.0)
    time, rounded = spread_times(recording.time - recording.time[0], place[:, :2])
    time = time - time[0]
    speed, notes = _checked_speed(recording, np.where(negative, np.nan, recording.speed), time, place[:, :2])
    solution = None if recording.solution is None else np.where(fix, recording.solution, "")
    flags = point_flags(
        time,
        place,
        fix,
        negative,
        solution=solution,
        segment=recording.segment,
        rounded=rounded,
        not_finite=recording.not_finite,
    )
    kept: dict[str, Any] = {item.name: getattr(recording, item.name) for item in fields(Track)}
    projected = f"east, north, up in m from {at}: the plane that touches WGS84 there; heights {recording.heights}"
    return replace(
        Track(**kept),
        time=time,
        place=place,
        speed=speed,
        frame=recording.frame if at is None else projected,
        velocity=velocity,
        solution=solution,
        flags=flags,
        axes="east_north_up" if recording.is_geodetic else recording.axes,
        origin=at,
        left_out={words: count for words, count in recording.left_out.items() if count},
        notes=(*recording.notes, *notes),
    )


_PAIR: Final = (1.0, 2.0)
"""Least and most seconds between two points whose speed is compared with the recorded one."""
_MOVING: Final = 3.0
"""m/s by places above which speeds are compared."""
_FEWEST_PAIRS: Final = 5
_OTHER_UNIT: Final = 2.1
"""Minimum ratio of the recorded speed to that of the places in another unit: 2.2 mph or 3.6 km/h are 1 m/s.

Seen from above a path on 45° is 1.4 times shorter, and so is an arc of 3 rad than its chord.
"""
_KINDS: Final = ("as the device gives it", "along the path")
"""Kinds of speeds whose unit is not part of a binary format or a sentence."""
_STRAIGHT: Final = 10.0
"""Percentile of the ratios: on the straightest parts the chord is the path."""


def _checked_speed(
    recording: Recording, speed: FloatArray, time: FloatArray, place: FloatArray
) -> tuple[FloatArray, tuple[Message, ...]]:
    """Speeds (n,) (m/s) that fit the places, and notes; all NaN if a device without a speed sensor wrote zeros.

    time: (n,) s. place: (n, 2) m.
    Raises FieldDataError: the speeds of a format that states no unit do not fit the places and times.
    """
    placed = np.flatnonzero(np.isfinite(place).all(axis=1) & np.isfinite(speed))
    if not len(placed):
        return speed, ()
    after = np.searchsorted(time[placed], time[placed] + _PAIR[0])
    begin, end = placed[after < len(placed)], placed[after[after < len(placed)]]
    begin, end = begin[time[end] - time[begin] <= _PAIR[1]], end[time[end] - time[begin] <= _PAIR[1]]
    by_places = np.hypot(*(place[end] - place[begin]).T) / (time[end] - time[begin])
    moving = by_places > _MOVING
    if np.count_nonzero(moving) < _FEWEST_PAIRS:
        return speed, ()
    if not np.any(speed > 0.0):
        return np.full(len(speed), np.nan), (
            Message("All recorded speeds are 0, although the places move. They are estimated from the places."),
        )
    ratio = float(np.percentile((speed[begin] + speed[end])[moving] / 2.0 / by_places[moving], _STRAIGHT))
    if ratio > _OTHER_UNIT and recording.speed_kind in _KINDS:
        value = Message("{ratio:.2g} times the speed of the places", ratio=ratio)
        allowed = Message("speeds in m/s (km/h: 3.6, mph: 2.2), times in s")
        raise track_error("unknown_unit", recording.name, allowed, column="speed", value=value)
    return speed, ()


def _fix(recording: Recording) -> BoolArray:
    """True (n,) for points with a place; devices write latitude 0 and longitude 0 without one."""
    horizontal = recording.place[:, :2]
    fix = np.asarray(np.isfinite(horizontal).all(axis=1))
    if recording.is_geodetic:
        fix &= np.any(horizontal != 0.0, axis=1)
    return fix if recording.fix is None else fix & recording.fix


def _projected(
    recording: Recording, fix: BoolArray, origin: GeodeticPoint | None
) -> tuple[FloatArray, FloatArray | None, GeodeticPoint | None]:
    """Places, velocities and origin: in east, north, up where the file has latitude and longitude, else as recorded."""
    if not recording.is_geodetic:
        if origin is not None:
            allowed = Message("an origin with a file that has latitude and longitude")
            action = Message("The file has local metres only; leave the origin out.")
            raise track_error("no_place_on_earth", recording.name, allowed, action, value=str(origin))
        return recording.place, recording.velocity, None
    at = origin
    if at is None:  # the first point; if its height is missing, with the first recorded height
        points = recording.place[fix]
        heights = [*points[np.isfinite(points[:, 2]), 2].tolist(), 0.0]
        at = GeodeticPoint(float(points[0, 0]), float(points[0, 1]), heights[0])
    velocity = recording.velocity
    if velocity is not None:
        velocity = rotate_to_origin(velocity, recording.place, origin=at)
    return east_north_up(recording.place, origin=at), velocity, at


def _require_points(recording: Recording) -> None:
    """Reject a recording without any point, or without one that has a place and a fix."""
    if not len(recording.time):
        value = ", ".join(f"{count} {words}" for words, count in recording.left_out.items() if count) or None
        action = Message("The file has no point; was anything recorded?")
        raise track_error("empty_file", recording.name, Message("at least one point"), action, value=value)
    fix = _fix(recording)
    if not np.any(fix):
        action = Message("None of the {points} points has one; was the receiver under a roof?", points=len(fix))
        raise track_error("no_place", recording.name, Message("at least one point with a place and a fix"), action)


def _require_time(recording: Recording) -> None:
    """Reject a recording in which the time falls from one point to the next."""
    falls = np.flatnonzero(np.diff(recording.time) < 0.0)
    if len(falls):
        point = int(falls[0]) + 1
        allowed = Message("a time not before the previous point's, {time}", time=_time_text(recording, point - 1))
        action = Message("Sort the points, or split the file where another recording begins.")
        place, value = recording.places_in_file[point], _time_text(recording, point)
        raise track_error("time_backwards", recording.name, allowed, action, place=place, column="time", value=value)


def _time_text(recording: Recording, point: int) -> str:
    """Time of a point as a text: date and time in UTC, or seconds if the recording has no date."""
    seconds = float(recording.time[point] - recording.time[0])
    if recording.start is None:
        return f"{seconds + recording.first_time:.12g} s"
    return datetime.fromtimestamp(
        recording.start.replace(tzinfo=recording.start.tzinfo or UTC).timestamp() + seconds, UTC
    ).strftime("%Y-%m-%d %H:%M:%S.%f")


def _require_in_range(recording: Recording) -> None:
    """Reject numbers that are impossible for a ski run in any unit; they could overflow."""
    places = GEODETIC if recording.is_geodetic else LOCAL
    checked = [(recording.columns.get(axis, key.field), recording.place[:, place], key)
               for place, (axis, key) in enumerate(zip("xyz", places, strict=True))]  # fmt: skip
    columns = ((name, getattr(recording, name), quantity) for name, quantity in MOTION.items())
    for column, values, quantity in (*checked, *columns):
        outside = np.argwhere(quantity.outside(np.zeros(0) if values is None else values))
        if not len(outside):
            continue
        point = int(outside[0][0])
        place, value = recording.places_in_file[point], f"{values[tuple(outside[0])]:.12g}"
        allowed = Message("a number {allowed} {unit}", allowed=quantity.allowed, unit=quantity.unit)
        action = Message("Correct the value; is it in another unit, or in another column?")
        raise track_error("out_of_range", recording.name, allowed, action, place=place, column=column, value=value)


BEFORE: Final = Message("points before the first fix")
AFTER: Final = Message("points after the last fix")
OUT_OF_ORDER: Final = Message("points without a fix whose time is not between the points with a fix around them")
_ARRAYS: Final = ("time", "place", "speed", "velocity", "place_sd", "speed_sd", "odometer", "fix", "solution",
                  "segment", "not_finite")  # fmt: skip


def fixed_points(recording: Recording, fix: BoolArray) -> tuple[Recording, BoolArray]:
    """The recording from its first to its last point with a fix, and the fix of its points.

    recording: as read.
    fix: (n,) bool, True for points with a fix; at least one is.
    """
    numbers = np.flatnonzero(fix)
    first, last = int(numbers[0]), int(numbers[-1])
    inside = np.zeros(len(fix), dtype=bool)
    inside[first : last + 1] = True
    ordered = fix | _between_neighbours(recording.time, fix)
    counts = {BEFORE: first, AFTER: len(fix) - 1 - last, OUT_OF_ORDER: int(np.count_nonzero(inside & ~ordered))}
    kinds = dict.fromkeys((*recording.left_out, *counts))
    left_out = {words: recording.left_out.get(words, 0) + counts.get(words, 0) for words in kinds}
    used = inside & ordered
    columns = {name: getattr(recording, name) for name in _ARRAYS}
    arrays: dict[str, Any] = {name: None if values is None else values[used] for name, values in columns.items()}
    shift = float(arrays["time"][0] - recording.time[0])
    selected = replace(
        recording,
        **arrays,
        places_in_file=[where for where, is_used in zip(recording.places_in_file, used, strict=True) if is_used],
        start=None if recording.start is None else recording.start + timedelta(seconds=shift),
        first_time=recording.first_time if recording.start is not None else recording.first_time + shift,
        left_out=left_out,
    )
    return selected, fix[used]


def _between_neighbours(time: FloatArray, fix: BoolArray) -> BoolArray:
    """True for points whose time is between those of the points with a fix before and after them."""
    fixed_time = np.where(fix, time, np.nan)
    numbers = np.arange(len(time))
    before = np.maximum.accumulate(np.where(fix, numbers, -1))
    after = np.minimum.accumulate(np.where(fix, numbers, len(time))[::-1])[::-1]
    earliest, latest = fixed_time[np.maximum(before, 0)], fixed_time[np.minimum(after, len(time) - 1)]
    with np.errstate(invalid="ignore"):
        is_between = (time >= earliest) & (time <= latest)
    return np.asarray(is_between & (before >= 0) & (after < len(time)))
