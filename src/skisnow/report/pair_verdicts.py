"""Verdicts on two skis and two runs: the difference, its interval where one exists, and whether it is certain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from .._support.errors import SkisnowError
from .._support.messages import Message
from .._support.units import DEGREE
from .._support.user_files import is_file, read_json
from ..track.track import Track

Json = dict[str, Any]
RADII: Final = ("turn_radius_boot_m", "turn_radius_boot_other_spread_m", "turn_radius_chord_m", "turn_radius_median_m")
"""Definitions of the radius of a carved turn, that of the verdict first."""
_SAME: Final = 5e-4  # relative difference below which two numbers count as equal: they are computed no better
_SAME_TIME: Final = 5e-3  # difference (s) of two runs below which they count as equally fast


def ski_verdict(first: Mapping[str, Any], other: Mapping[str, Any], names: tuple[str, str]) -> Message:
    """Which of two skis carves the tighter turn in the same snow.

    Both skis are in one snow: its errors change both radii, so the interval of their ratio comes from the difference
    of the relative changes. It is certain if the interval excludes 0 and all definitions of the radius agree.

    first, other: answers in the JSON of `skisnow carve`.
    """
    radii = [(first[key], other[key]) for key in RADII if first[key] is not None and other[key] is not None]
    if not radii or first[RADII[0]] is None or other[RADII[0]] is None:
        return Message("{a} and {b} cannot be compared: not both have a carved turn.", a=names[0], b=names[1])
    (one, two), *_ = radii
    if abs(two / one - 1.0) < _SAME:
        return Message("{a} and {b} carve the same radius, {radius:.3g} m.", a=names[0], b=names[1], radius=one)
    tight, wide, by_name = (other, first, names[::-1]) if two < one else (first, other, names)
    interval, half = _interval(tight, wide)
    percent = 100.0 * (wide[RADII[0]] / tight[RADII[0]] - 1.0)
    comparison = Message(
        "{a} turns tighter than {b}: the radius of {b} is larger by {percent:.2g} %{interval}",
        a=by_name[0], b=by_name[1], percent=percent, interval=interval,
    )  # fmt: skip
    if any((b - a) * (two - one) < 0.0 for a, b in radii):
        return Message(
            "{comparison}: not certain, as another definition of the radius says the opposite.", comparison=comparison
        )
    if half is None:
        return Message("{comparison}; the snow has no interval, so this difference has none.", comparison=comparison)
    if half < percent:
        return Message("{comparison}: certain, as far as the snow decides.", comparison=comparison)
    return Message("{comparison}: not certain, as the snow is not known better.", comparison=comparison)


def _interval(tight: Mapping[str, Any], wide: Mapping[str, Any]) -> tuple[str, float | None]:
    """Ends of the 95 % interval of the difference (%) in brackets, and half of it; "" and None without one."""
    changes = [side.get("radius_changes_by_snow_m") or [] for side in (tight, wide)]
    if not changes[0] or len(changes[0]) != len(changes[1]):
        return "", None
    ratio = wide[RADII[0]] / tight[RADII[0]]
    relative = [b / wide[RADII[0]] - a / tight[RADII[0]] for a, b in zip(*changes, strict=True)]
    percent, half = 100.0 * (ratio - 1.0), 100.0 * ratio * math.hypot(*relative)
    return Message(" [{low:+.2g}, {high:+.2g}]", low=percent - half, high=percent + half), half


def run_verdict(first: Track, other: Track) -> Message | None:
    """Which of two computed runs is faster over the length that both ran; None without such a length."""
    ways = [
        np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(run.place, axis=0), axis=1))]) for run in (first, other)
    ]
    length = min(way[-1] for way in ways)
    if not np.isfinite(length) or length <= 0.0:
        return None
    one, two = (
        float(np.interp(length, way, run.time - run.time[0])) for way, run in zip(ways, (first, other), strict=True)
    )
    if abs(one - two) < _SAME_TIME:
        return Message(
            "{a} and {b} are equally fast over the {length:.4g} m that both ran, within {limit:g} s.",
            a=first.name, b=other.name, length=length, limit=_SAME_TIME,
        )  # fmt: skip
    fast, slow = (first, other) if one < two else (other, first)
    return Message(
        "{a} is faster than {b} by {seconds:.2f} s over the {length:.4g} m that both ran. Computed runs have no "
        "scatter, so there is no interval; simulate --verify shows how exact each run is.",
        a=fast.name, b=slow.name, seconds=abs(one - two), length=length,
    )  # fmt: skip


def read_compared(path: Path) -> Track:
    """Track of a file, or of a run's folder with the angle of its slope, under the name by which the user called it."""
    from ..track.read import read_track

    file = path / "track.csv" if path.is_dir() else path
    track = read_track(file)
    return replace(track, name=str(path), slope_angle=_slope_angle_from_summary(file) if track.axes == "file" else None)


def _slope_angle_from_summary(file: Path) -> float | None:
    """Slope angle (rad) of the run that wrote a track.csv, 0 unless its slope is a plane; None for any other file."""
    summary = file.with_name("summary.json")
    if file.name != "track.csv" or not is_file(summary):
        return None
    try:
        slope = read_json(summary)["scenario"]["slope"]
        return float(slope["angle_deg"]) * DEGREE if slope["kind"] == "plane" else 0.0
    except (SkisnowError, KeyError, TypeError, ValueError):  # another program's summary, or a damaged one
        return None


def time_verdict(first: Track, other: Track) -> Message | None:
    """Which of two computed runs is faster; None if one of the tracks was measured."""
    return None if None in (first.slope_angle, other.slope_angle) else run_verdict(first, other)
