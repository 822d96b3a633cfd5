"""Comparison of a simulated track with a measured one, with unknown start, heading and time if requested."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import Final, get_args

import numpy as np

from .._support.errors import ParameterError, require_range
from .._support.messages import Message, joined, template
from .._support.units import DEGREE
from ..track.slope_frame import STEEPEST, LaidTracks, lay_for_fit
from ..track.track import Track, inexact_sentence
from .alignment import OFFSETS, Motion, fit_motion, require_offsets
from .distances import (
    OffsetSeries,
    Polyline,
    arc_length_offsets,
    compared_points,
    distance_statistics,
    nearest_offsets,
    time_offsets,
    track_polyline,
)
from .nearest_place import Path
from .result import (
    Clock,
    Comparison,
    Distances,
    FittedOffsets,
    TimeFrom,
    common_clock,
    fit_time,
    missing_time_reason,
)

FARTHEST: Final = 1000.0
"""Largest distance (m) between the tracks; beyond it they are from different slopes."""
_PLACED: Final = frozenset({"start", "heading"})
SOLUTION_SD: Final = {"fixed": 0.02, "float": 0.3, "code": 3.0}
"""Standard deviation (m) of a place by kind of solution (modelling assumption: orders of magnitude)."""
MOST_COMPARED: Final = 0.9
"""Compared share of the measured track below which a warning is given."""
REPORTED_ERROR: Final = 2.0 * DEGREE
"""Half of the 95 % interval of a fitted heading above which a warning says so."""
DEFINITIONS: Final = {
    "nearest": "from each place of the measured track to the nearest place of the simulated one, whenever that was "
    "passed; places ahead of the simulated track's ends are left out",
    "arc_length": "between the places that both tracks reach after the same arc length from their first points, up to "
    "the length of the shorter",
    "time": "between the places where both are at the same time, counted from {origin}, while both are on their way",
}
"""Definition of each distance."""
_KIND_WORDS: Final = {"nearest": Message("nearest"), "arc_length": Message("arc length"), "time": Message("time")}


def compare_tracks(
    simulated: Track,
    measured: Track,
    *,
    fit: Collection[str] = (),
    time_from: TimeFrom | None = None,
    from_above: bool = False,
    known_to: float | None = None,
    slope_angle: float | None = None,
) -> Comparison:
    """Compare a simulated track with a measured one.

    Parameters
    ----------
    simulated, measured
        Tracks in the same frame; two tracks in degrees are compared from the measured one's origin. Points that
        `Track.usable` excludes are ignored and counted in a warning.
    fit
        Unknown offsets of the simulated track that are fitted: "start", "heading", "time" (default: none).
    time_from
        Zero of equal time. "clock": the dates of the files, or their seconds if neither has a date; "first_point": the
        first point of each track (default: the clock, or first points if only one track has a date).
    from_above
        True to ignore heights (default: heights are used if both tracks have them).
    known_to
        Accuracy of the places (m), at least 0 (default: the less accurate of both by `place_accuracy`).
    slope_angle : rad
        Inclination of the slope of one track's x and y, if start and heading are fitted to a track on a map (default:
        that of the run, else that of the other track's heights).

    Returns
    -------
    Comparison
        Its numbers do not depend on how densely a path of straight pieces is sampled.

    Raises
    ------
    ParameterError
        A track has fewer than two places, the tracks are nowhere within 1 km, or an option is unknown.
    FitError
        The offsets cannot be fitted.

    See Also
    --------
    skisnow.read_track : a measured track.
    skisnow.track_summary : distance, speed, runs and turns of one track.

    References
    ----------
    The page docs/methods/tracks.md.
    """
    require_offsets(fit)
    if time_from not in (None, *get_args(TimeFrom)):
        raise ParameterError("time is counted from first_point or clock, not from {time_from!r}").tag(
            "unknown_time_origin", time_from=time_from
        )
    require_range("known_to", known_to or 0.0, 0.0, math.inf, below=True)
    require_range("slope_angle", slope_angle or 0.0, 0.0, STEEPEST)
    if simulated.origin is not None and measured.origin is not None and simulated.origin != measured.origin:
        simulated = simulated.at_origin(measured.origin)
    placed, together = set(fit) >= _PLACED, (simulated.axes == "east_north_up") == (measured.axes == "east_north_up")
    laid = lay_for_fit(simulated, measured, slope_angle) if placed else LaidTracks(simulated, measured)
    dimensions, seen = _view(laid, from_above=from_above, heights_agree=together or laid.angle is not None)
    lines = track_polyline(laid.simulated, dimensions=dimensions), track_polyline(laid.measured, dimensions=dimensions)
    clock = common_clock(simulated, measured, time_from)
    names = (simulated.name, measured.name)
    warnings = [*_track_warnings(simulated, dimensions), *_track_warnings(measured, dimensions), *laid.warnings]
    if not together and not placed:
        frames = _frames_sentence(simulated, measured)
        warnings.append(Message("{frames}; their coordinates are compared as they stand", frames=frames))
    plain = _compare_lines(lines, clock, names, seen)
    if fit:
        plain = _fit_and_compare(plain, set(fit), clock)
    places = plain.measured.at_arc_length(np.linspace(0.0, plain.measured.length, 1001))
    nearest = float(Path(plain.simulated.place).nearest(places).distance.min())
    if nearest > FARTHEST:
        raise ParameterError(
            "{first} and {second} have nothing in common: they are nowhere nearer than {nearest:.4g} "
            "km ({farthest:g} km is allowed). Bring both into one frame, or fit start and heading"
        ).tag("nothing_common", first=names[0], second=names[1], nearest=nearest / 1000.0, farthest=FARTHEST / 1000.0)
    fitted = plain.fitted
    if placed and fitted is not None:
        turned = fitted.turned if measured.axes == "east_north_up" else -fitted.turned
        azimuth = None if together else (0.5 * math.pi - turned) % math.tau
        fitted = replace(fitted, slope_angle=laid.angle, azimuth=azimuth)
        if not together:
            direction = _direction_sentence(fitted, laid, simulated, measured)
            warnings.append(joined([_frames_sentence(simulated, measured), direction], "; "))
    return replace(
        plain,
        fitted=fitted,
        axes=measured.axes,
        warnings=(*warnings, *_result_warnings(plain)),
        in_one_frame=together or placed,
        known_to=max(map(place_accuracy, (simulated, measured))) if known_to is None else known_to,
    )


def _view(laid: LaidTracks, *, from_above: bool, heights_agree: bool) -> tuple[int, Message]:
    """Number of coordinates to compare (2: from above, 3: in space), and the reason in words."""
    if from_above:
        return 2, Message("from above, as asked")
    if not heights_agree:
        return 2, Message("from above: heights in two frames are not the same")
    for track in (laid.simulated, laid.measured):
        usable, flat = int(track.usable.sum()), int((track.usable & ~np.isfinite(track.place[:, 2])).sum())
        if flat:
            return 2, Message(
                "from above: {flat} of the {usable} points of {name} have no height",
                flat=flat,
                usable=usable,
                name=track.name,
            )
    return 3, Message("in space, heights included")


def _compare_lines(lines: tuple[Polyline, Polyline], clock: Clock, names: tuple[str, str], seen: Message) -> Comparison:
    """Comparison by all three distances; `seen`: whether heights are used, in words."""
    simulated, measured = lines
    offsets = nearest_offsets(Path(simulated.place), measured)
    back = distance_statistics(nearest_offsets(Path(measured.place), simulated))
    return Comparison(
        simulated=simulated,
        measured=measured,
        names=names,
        seen=seen,
        nearest=_make_distances(
            "nearest",
            offsets,
            Message("all of the measured track lies ahead of the simulated one's ends: nothing is beside it"),
        ),
        arc_length=_make_distances(
            "arc_length", arc_length_offsets(simulated, measured), Message("neither has a length")
        ),
        time=_at_equal_time(simulated, measured, clock),
        largest_from_simulated=None if back is None else back.max,
    )


def _make_distances(name: str, offsets: OffsetSeries | None, otherwise: Message, *, origin: str = "") -> Distances:
    """Distances by the definition `name`; `otherwise`: reason if there are none; `origin`: zero of the clock."""
    numbers = None if offsets is None else distance_statistics(offsets)
    definition = DEFINITIONS[name].format(origin=origin)
    return Distances(definition, offsets, numbers, None if numbers else otherwise)


def _at_equal_time(simulated: Polyline, measured: Polyline, clock: Clock) -> Distances:
    """Distances at equal times, or the reason why they cannot be computed."""
    reason = clock.reason or missing_time_reason(simulated, "simulated") or missing_time_reason(measured, "measured")
    offsets = None if reason else time_offsets(simulated, measured, later=clock.ahead)
    if not reason and offsets is None:
        begins = measured.time[0] + clock.ahead - simulated.time[0]
        reason = Message(
            "they are not on their way at one time (the measured one begins {begins:.6g} s later); let time be counted "
            "from each track's first point, or fit the time",
            begins=begins,
        )
    otherwise = reason or Message("the measured track stands still while both are on their way")
    return _make_distances("time", offsets, otherwise, origin=clock.origin)


def _fit_and_compare(plain: Comparison, fit: set[str], clock: Clock) -> Comparison:
    """Comparison after the offsets in `fit` are fitted; `plain` is the comparison without the fit."""
    simulated, motion = plain.simulated, Motion(np.zeros(plain.dimensions), 0.0)
    if fit & {"start", "heading"}:
        motion = fit_motion(simulated, plain.measured, start="start" in fit, heading="heading" in fit)
        simulated = motion.applied(simulated)
    later, fitted_clock = 0.0, clock
    if "time" in fit:
        reason = missing_time_reason(simulated, plain.names[0]) or missing_time_reason(plain.measured, plain.names[1])
        if reason:
            raise ParameterError("{reason}; remove time from the fit").tag("no_times", reason=reason)
        later = fit_time(simulated, plain.measured) - clock.ahead
        fitted_clock = Clock(clock.ahead + later, f"{clock.origin}, with the fitted offset")
    moved_comparison = _compare_lines((simulated, plain.measured), fitted_clock, plain.names, plain.seen)
    fitted = FittedOffsets(
        what=tuple(word for word in OFFSETS if word in fit),
        moved=tuple(motion.moved.tolist()),
        turned=motion.turned,
        later=later,
        undetermined=motion.undetermined,
        rms=motion.rms if math.isfinite(motion.rms) else None,
        rival=motion.rival,
        before=plain,
        turned_error=motion.turned_error,
    )
    return replace(moved_comparison, fitted=fitted)


def _track_warnings(track: Track, dimensions: int) -> Iterator[Message]:
    """Warnings of points that are not compared, and of inexact places."""
    if without := int((~compared_points(track, dimensions=dimensions)).sum()):
        flags = [Message("{count} {code}", count=count, code=code) for code, count in track.flagged.items()]
        yield Message(
            "{name}: {without} of {points} points are not compared ({flags})",
            name=track.name,
            without=without,
            points=len(track),
            flags=flags or Message("no place"),
        )
    if inexact := inexact_sentence(track.name, track.solution):
        yield inexact


def _frames_sentence(simulated: Track, measured: Track) -> Message:
    """Sentence that two tracks have different frames."""
    return Message(
        "the tracks are not in one frame ({first}: {first_frame}; {second}: {second_frame})",
        first=simulated.name,
        first_frame=simulated.frame,
        second=measured.name,
        second_frame=measured.frame,
    )


def _direction_sentence(fitted: FittedOffsets, laid: LaidTracks, simulated: Track, measured: Track) -> Message:
    """Sentence on the direction of x of the track in the slope's axes, and on the inclination of the slope."""
    name = (simulated if measured.axes == "east_north_up" else measured).name
    error = Message("other directions fit too")
    if fitted.turned_error is not None:
        error = Message("± {error:.2g}°", error=fitted.turned_error / DEGREE)
    azimuth = (fitted.azimuth or 0.0) / DEGREE
    if not laid.angle:
        return Message(
            "laid on the map from above, x of {name} points {azimuth:.1f}° from north ({error})",
            name=name,
            azimuth=azimuth,
            error=error,
        )
    return Message(
        "laid on the map on a slope of {angle:.1f}° ({source}), x of {name} points {azimuth:.1f}° from north ({error})",
        angle=laid.angle / DEGREE,
        source=laid.source,
        name=name,
        azimuth=azimuth,
        error=error,
    )


def _result_warnings(comparison: Comparison) -> Iterator[Message]:
    """Warnings of a short compared part, of a poorly determined heading, of another place that fits about as well."""
    whole, fitted = comparison.measured.length, comparison.fitted
    for name in DEFINITIONS:
        numbers = getattr(comparison, name).numbers
        if numbers is not None and numbers.compared < MOST_COMPARED * whole:
            yield Message(
                "{kind}: only {compared:.4g} of the {whole:.4g} m of the measured track could be compared",
                kind=_KIND_WORDS[name],
                compared=numbers.compared,
                whole=whole,
            )
    error, rival = (None, None) if fitted is None else (fitted.turned_error, fitted.rival)
    if error is not None and error > REPORTED_ERROR:
        yield Message(
            "the fitted heading is uncertain: ± {error:.2g}° (95 %). Give the direction in which the slope falls, or "
            "compare a longer stretch",
            error=error / DEGREE,
        )
    if fitted is not None and rival is not None and fitted.rms is not None:
        yield Message(
            _OTHER_PLACE_WITHOUT_INTERVAL if error is None else _OTHER_PLACE,
            other_x=float(rival.moved[0]),
            other_y=float(rival.moved[1]),
            other_turned=rival.turned / DEGREE,
            x=fitted.moved[0],
            y=fitted.moved[1],
            turned=fitted.turned / DEGREE,
            other_rms=rival.rms,
            rms=fitted.rms,
            share=100 * rival.share,
        )


_OTHER_PLACE: Final = template(
    "the place of the simulated track is uncertain: moved by {other_x:.1f} and {other_y:.1f} m and turned by "
    "{other_turned:.0f}°, instead of {x:.1f} and {y:.1f} m and {turned:.0f}°, it is about as near (rms "
    "{other_rms:.4g} m instead of {rms:.4g} m, {share:.0f} % compared). Give the direction in which the slope falls, "
    "or compare a longer stretch"
)
_OTHER_PLACE_WITHOUT_INTERVAL: Final = template(
    "the place of the simulated track is uncertain: moved by {other_x:.1f} and {other_y:.1f} m and turned by "
    "{other_turned:.0f}°, instead of {x:.1f} and {y:.1f} m and {turned:.0f}°, it is about as near (rms "
    "{other_rms:.4g} m instead of {rms:.4g} m, {share:.0f} % compared). The heading has no interval. Give the "
    "direction in which the slope falls, or compare a longer stretch"
)


def place_accuracy(track: Track) -> float:
    """Standard deviation (m) of a place: the median of the stated ones, else by kind of solution; 0 if unmeasured.

    A place in latitude and longitude without a stated accuracy is assumed to be a code solution, as in GPX files of
    watches.
    """
    usable = track.usable
    if track.place_sd is not None:
        stated = track.place_sd[usable, :2]
        if np.isfinite(stated).any():
            return float(np.nanmedian(stated))
    if track.solution is not None:
        kinds = [SOLUTION_SD[kind] for kind in track.solution[usable].tolist() if kind]
        if kinds:
            return float(np.median(kinds))
    return SOLUTION_SD["code"] if track.origin is not None else 0.0
