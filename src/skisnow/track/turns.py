"""Turns of a track, and the switch points at which the curvature significantly changes its sign."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from .._support.arrays import FloatArray
from .._support.units import DEGREE
from .curvature import INTERVAL_FACTOR, TrackMotion

SIGNIFICANCE: Final = 3.0
"""Smallest curvature of a turn, in its standard errors (modelling assumption)."""
STRAIGHT: Final = 500.0
"""Radius (m) above which a path counts as straight (modelling assumption)."""
LEAST_ANGLE: Final = 10.0 * DEGREE
"""Smallest turned angle (rad) of a turn (modelling assumption)."""
LONGEST_STRAIGHT: Final = 2.0
"""Longest straight stretch (s) inside a turn, or two lengths of the smoothing's window if longer (assumption)."""


@dataclass(frozen=True, slots=True)
class Turn:
    """A stretch with one sign of curvature.

    start, end: times (s), at the switch point where another turn adjoins.
    direction: "left" or "right" as seen along the track.
    turned_angle, turned_angle_sd: change of heading (rad), positive left, and its standard error.
    least_radius: m, 1 / the largest curvature of the smoothed track; above 0.
    least_radius_interval: minimum and maximum (m) of its 95 % interval due to noise.
    least_radius_time: time of the largest curvature (s).
    mean_radius: length over turned angle (m).
    length: m, along the track.
    share_passed: share of the amplitude that the smoothing leaves of a curvature shaped as half a sine over the turn:
        the true minimum radius is about ``share_passed`` times the given one.
    """

    start: float
    end: float
    direction: Literal["left", "right"]
    turned_angle: float
    turned_angle_sd: float
    least_radius: float
    least_radius_interval: tuple[float, float]
    least_radius_time: float
    mean_radius: float
    length: float
    share_passed: float


@dataclass(frozen=True, slots=True)
class _Piece:
    """Piece of a turn: points from ``first`` to ``last`` with a significant curvature of one sign: 1 left, −1 right."""

    first: int
    last: int
    sign: int


def find_turns(
    motion: TrackMotion, *, first: int = 0, last: int | None = None, least_angle: float = LEAST_ANGLE
) -> tuple[Turn, ...]:
    """Find the turns between two points.

    first, last: numbers of the first and the last point (default: the whole track).
    least_angle: smallest turned angle (rad) of a turn. Pieces that turn less are omitted, and two turns to the same
        side with only such a piece between them are merged.

    A turn begins where the curvature is 3 standard errors and 1/(500 m) from 0, and goes on, whatever the curvature is
    in between, to the last such point before one of the other sign or a straight stretch of 2 s (two windows, if
    longer). Two turns that follow each other meet in the switch point: where the curvature, as a straight line fitted
    to the points between them, passes 0. A gap or a rest ends a turn.
    """
    end = len(motion.time) - 1 if last is None else last
    patience = max(LONGEST_STRAIGHT, 2.0 * motion.smoothed.resolution.window)
    pieces = _merge_pieces(motion, list(_pieces(motion, first, end, patience)), least_angle, patience)
    starts = [motion.time[piece.first] for piece in pieces]
    ends = [motion.time[piece.last] for piece in pieces]
    for number, (one, other) in enumerate(pairwise(pieces)):
        if one.sign != other.sign and _are_adjacent(motion, one, other, patience):
            ends[number] = starts[number + 1] = _switch_time(motion, one.last, other.first)
    spans = zip(pieces, starts, ends, strict=True)
    return tuple(_make_turn(motion, piece, float(start), float(end)) for piece, start, end in spans)


def _pieces(motion: TrackMotion, first: int, last: int, patience: float) -> Iterator[_Piece]:
    """Pieces of turns: stretches of points with a significant curvature of one sign, without rests or gaps."""
    with np.errstate(invalid="ignore"):
        curved = np.abs(motion.curvature) > np.maximum(SIGNIFICANCE * motion.curvature_sd, 1.0 / STRAIGHT)
    sure = np.flatnonzero((curved & motion.smoothed.usable)[first : last + 1]) + first
    if not len(sure):
        return
    signs = np.sign(motion.curvature[sure])
    rests = np.concatenate([[0], np.cumsum(np.isnan(motion.curvature) & motion.smoothed.usable)])
    ends = (
        (np.diff(signs) != 0)
        | (np.diff(motion.time[sure]) > patience)
        | (np.diff(motion.smoothed.part[sure]) > 0)
        | (np.diff(rests[sure]) > 0)
    )
    cuts = np.flatnonzero(ends)
    for begin, end in zip(np.r_[0, cuts + 1], np.r_[cuts, len(sure) - 1], strict=True):
        yield _Piece(int(sure[begin]), int(sure[end]), int(signs[begin]))


def _merge_pieces(motion: TrackMotion, pieces: list[_Piece], least_angle: float, patience: float) -> list[_Piece]:
    """Remove pieces that turn too little, and merge neighbours to the same side with only such a piece between them."""
    merged: list[_Piece] = []
    for piece in pieces:
        if merged and merged[-1].sign == piece.sign and _are_adjacent(motion, merged[-1], piece, patience):
            merged[-1] = _Piece(merged[-1].first, piece.last, piece.sign)
        elif abs(motion.heading[piece.last] - motion.heading[piece.first]) >= least_angle:
            merged.append(piece)
    return merged


def _are_adjacent(motion: TrackMotion, one: _Piece, other: _Piece, patience: float) -> bool:
    """True if at most `patience` (s), without a rest or a gap, is between two pieces of turns."""
    between = slice(one.last, other.first + 1)
    moving = np.isfinite(motion.curvature[between]) | ~motion.smoothed.usable[between]
    together = motion.smoothed.part[one.last] == motion.smoothed.part[other.first]
    return bool(together and moving.all() and motion.time[other.first] - motion.time[one.last] <= patience)


def _switch_time(motion: TrackMotion, before: int, after: int) -> float:
    """Time (s) at which a line fitted to the curvatures between the end of a turn and the next one passes 0."""
    time, curvature = motion.time[before : after + 1], motion.curvature[before : after + 1]
    finite = np.isfinite(curvature)
    slope, value = np.polyfit(time[finite] - time[0], curvature[finite], 1)
    passes = time[0] - value / slope if slope != 0.0 else np.nan
    inside = np.isfinite(passes) and time[0] <= passes <= time[-1]
    return float(passes) if inside else float((time[0] + time[-1]) / 2.0)


def _make_turn(motion: TrackMotion, piece: _Piece, start: float, end: float) -> Turn:
    """Turn from `start` to `end` (s) with the sharpest point of a piece whose error is not unusually large."""
    points = np.arange(piece.first, piece.last + 1)
    points = points[np.isfinite(motion.curvature[points])]
    points = points[motion.curvature_sd[points] <= 2.0 * np.median(motion.curvature_sd[points])]
    sharpest = int(points[int(np.argmax(piece.sign * motion.curvature[points]))])
    headings, errors = _at_times(motion, (start, end))
    length = float(np.diff(np.interp((start, end), motion.time, motion.arc_length))[0])
    angle = float(headings[1] - headings[0])
    curvature, half = float(abs(motion.curvature[sharpest])), INTERVAL_FACTOR * float(motion.curvature_sd[sharpest])
    return Turn(
        start=start,
        end=end,
        direction="left" if piece.sign > 0 else "right",
        turned_angle=angle,
        turned_angle_sd=float(np.hypot(*errors)),
        least_radius=float(abs(motion.turn_radius[sharpest])),
        least_radius_interval=(1.0 / (curvature + half), 1.0 / (curvature - half) if curvature > half else np.inf),
        least_radius_time=float(motion.time[sharpest]),
        mean_radius=length / abs(angle) if angle else np.inf,
        length=length,
        share_passed=max(motion.smoothed.resolution.share_passed(2.0 * (end - start)), 0.0),
    )


def _at_times(motion: TrackMotion, times: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Heading and its standard error, interpolated between the points that have one."""
    start, end = times
    first = max(int(np.searchsorted(motion.time, start, side="left")) - 1, 0)
    last = int(np.searchsorted(motion.time, end, side="right"))
    around = slice(first, last + 1)
    has_heading = np.isfinite(motion.heading[around])
    time, heading, error = (values[around][has_heading] for values in (motion.time, motion.heading, motion.heading_sd))
    return np.interp(times, time, heading), np.interp(times, time, error)
