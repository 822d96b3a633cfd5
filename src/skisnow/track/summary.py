"""Summary of a track: points, flags, distance, speed, runs and turns, also as JSON."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Final

import numpy as np

from .._support.errors import ParameterError
from .._support.messages import Message, count_message
from .._support.units import DEGREE, Facts, Shown, amount
from .._support.user_files.json_text import json_number
from .curvature import TrackMotion, integrated_arc_length, places_arc_length, segments, track_motion
from .path_estimate import Interval
from .runs import Day, Stretch, max_speed, split_day
from .track import Track, solution_counts
from .turns import Turn, find_turns

SCHEMA_VERSION: Final = 1
_APART: Final = 0.03
"""Relative difference of two distances of a track above which a remark is given."""

_SOURCE_WORDS: Final = {
    "places": Message("places"),
    "recorded speed": Message("recorded speed"),
    "odometer": Message("odometer"),
}

Json = dict[str, Any]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class TrackSummary(Shown):
    """A track with its motion, runs, turns, distances and speeds.

    Attributes
    ----------
    track, motion, day
        The track, its motion, its runs and lifts.
    turns
        Turns within runs, in the order of time.
    distances
        Length of the whole track (m) by each method: "odometer", "recorded speed", "places".
    max_speed, max_speed_interval
        Highest horizontal or recorded speed of the whole track (m/s), None if unknown, and the ends of its 95 %
        interval: of the estimated path if no speeds are recorded, otherwise None.
    distance_interval
        Ends of the 95 % interval of the length by places (m); None with recorded speeds.
    horizontal_distance
        Length of the path seen from above (m), with its 95 % interval; None with recorded speeds.
    remarks
        Sentences on unknown and doubtful quantities.

    See Also
    --------
    skisnow.track_summary
    """

    track: Track
    motion: TrackMotion
    day: Day
    turns: tuple[Turn, ...]
    distances: dict[str, float]
    max_speed: float | None
    max_speed_interval: tuple[float, float] | None
    distance_interval: tuple[float, float] | None
    horizontal_distance: Interval | None
    remarks: tuple[Message, ...]

    def _repr_facts(self) -> Facts:
        """Title, and rows with points, distance, highest speed, runs, turns and remarks."""
        distances = ", ".join(f"{amount(distance, 'm')} by {name}" for name, distance in self.distances.items())
        rows = (
            ("points", str(len(self.track))),
            ("distance", f"{distances or 'unknown'}{_shown_interval(self.distance_interval, 'm')}"),
            ("highest speed", f"{amount(self.max_speed, 'm/s')}{_shown_interval(self.max_speed_interval, 'm/s')}"),
            ("runs", str(len(self.day.runs))),
            ("turns", str(len(self.turns))),
            ("remarks", f"{len(self.remarks)}{f': {self.remarks[0]}' if self.remarks else ''}"),
        )
        return Facts(f"of {self.track.name!r}", rows)


def track_summary(track: Track, *, window: float | None = None, place_noise: float | None = None) -> TrackSummary:
    """Summarise a track.

    Parameters
    ----------
    track
        At least six usable points.
    window
        Length of the smoothing's window (s) (default: eight intervals between points, at least 0.8 s).
    place_noise
        Standard deviation of a coordinate (m) (default: from the scatter about the smoothed track).

    Returns
    -------
    TrackSummary
        Distance, speed, runs, lifts and turns, with their uncertainties.

    Raises
    ------
    ParameterError
        Too few points, or a window or a noise that is not above 0.

    See Also
    --------
    skisnow.read_track : a track from a file.
    skisnow.compare : two tracks.

    References
    ----------
    * Savitzky and Golay (1964), "Smoothing and differentiation of data by simplified least squares procedures", Anal.
      Chem. 36, 1627-1639, doi 10.1021/ac60214a047.
    * Bell (1994), "The iterated Kalman smoother as a Gauss-Newton method", SIAM J. Optim. 4, 626-636,
      doi 10.1137/0804035.
    * The page docs/methods/tracks.md.
    """
    motion = track_motion(track, window=window, place_noise=place_noise)
    if not np.isfinite(motion.smoothed.velocity[:, 0]).any():
        raise ParameterError("{name}: no window of {window:g} s contains six usable points. Use a longer window").tag(
            "too_few_points", name=track.name, window=motion.smoothed.resolution.window
        )
    day = split_day(track, motion)
    turns = tuple(turn for run in day.runs for turn in find_turns(motion, first=run.first, last=run.last))
    distances = _distances_by_source(track, motion)
    length = None if motion.path is None else motion.path.length()
    return TrackSummary(
        track, motion, day, turns, distances, *max_speed(track, motion, slice(None)),
        length and length[1:],
        None if motion.path is None else motion.path.length(with_heights=False),
        (*track.notes, *_remarks(track, motion, distances), *day.remarks),
    )  # fmt: skip


def _shown_interval(interval: tuple[float, float] | None, unit: str) -> str:
    """Interval in brackets with its unit, after a space; "" for None."""
    return "" if interval is None else f" ({interval[0]:.5g} to {interval[1]:.5g} {unit})"


def _distances_by_source(track: Track, motion: TrackMotion) -> dict[str, float]:
    """Distances (m) of the track, each by its source: places, recorded speed, odometer."""
    if motion.path is not None and motion.arc_length_source == "places":
        return {"places": motion.path.length().value}
    ways = {"places": places_arc_length(track, motion.smoothed)}
    if motion.speed_source == "recorded":
        ways["recorded speed"] = integrated_arc_length(track, motion.smoothed, motion.speed)
    if motion.arc_length_source == "odometer":
        ways["odometer"] = motion.arc_length
    return {name: float(arc_length[-1] - arc_length[0]) for name, arc_length in ways.items()}


def _remarks(track: Track, motion: TrackMotion, distances: dict[str, float]) -> Iterator[Message]:
    """Remarks about omitted points, contradicting distances, missing speeds, segments and gaps."""
    for words, count in track.left_out.items():
        yield Message("Not used: {count} {words}.", count=count, words=words)
    chosen = distances[motion.arc_length_source]
    for name, distance in distances.items():
        if chosen > 0.0 and abs(distance - chosen) > _APART * chosen:
            yield Message(
                "The distance by {name}, {distance:.0f} m, is not that by {source}, {chosen:.0f} m; the latter counts.",
                name=_SOURCE_WORDS[name],
                distance=distance,
                source=_SOURCE_WORDS[motion.arc_length_source],
                chosen=chosen,
            )
    if motion.speed_source == "fitted":
        yield Message("No speeds in the track: they are estimated from the places.")
    pauses = int(segments(track)[-1])
    if pauses:
        yield Message("{segments} segments: nothing between them counts as path.", segments=pauses + 1)
    gaps = int(np.count_nonzero(np.diff(motion.smoothed.part))) - pauses
    if gaps > 0:
        yield count_message(
            "{count} gap: nothing is smoothed across, and the path over it is straight.",
            "{count} gaps: nothing is smoothed across, and the path over it is straight.",
            count=gaps,
        )


def summary_dict(summary: TrackSummary) -> Json:
    """The JSON of `skisnow track`; its JSON Schema is that of ``skisnow schema track``. Null: unknown or infinite."""
    smoothed = summary.motion.smoothed
    horizontal = summary.horizontal_distance
    from_places = summary.motion.arc_length_source == "places"
    return {
        "schema_version": SCHEMA_VERSION,
        "file": summary.track.name,
        "points": len(summary.track),
        "marked": summary.track.flagged,
        "solutions": solution_counts(summary.track.solution),
        "duration_s": json_number(float(summary.track.time[-1] - summary.track.time[0])),
        "distance_m": json_number(summary.distances[summary.motion.arc_length_source]),
        "distance_source": summary.motion.arc_length_source.replace(" ", "_"),
        "distances_m": {name.replace(" ", "_"): json_number(value) for name, value in summary.distances.items()},
        "distance_interval_m": _interval_list(summary.distance_interval if from_places else None),
        "horizontal_distance_m": json_number(None if horizontal is None else horizontal.value),
        "horizontal_distance_interval_m": _interval_list(horizontal and horizontal[1:]),
        "max_speed_m_per_s": json_number(summary.max_speed),
        "max_speed_interval_m_per_s": _interval_list(summary.max_speed_interval),
        "speed_source": summary.motion.speed_source,
        "smoothing": {
            "method": "local cubic least squares",
            "window_s": smoothed.resolution.window,
            "half_amplitude_period_s": json_number(smoothed.resolution.half_period),
            "ninety_percent_period_s": json_number(smoothed.resolution.period_passed(0.9)),
            "half_amplitude_wavelength_m": json_number(half_wavelength(summary)),
            "velocity_noise_m_per_s": json_number(smoothed.speed_noise),
        },
        "runs": [_stretch_dict(run, "descent_m", 1.0) for run in summary.day.runs],
        "runs_by": summary.day.split_by,
        "lifts": [_stretch_dict(lift, "ascent_m", -1.0) for lift in summary.day.lifts],
        "turns": [_turn_dict(turn) for turn in summary.turns],
        "frame": summary.track.frame,
        "start": None if summary.track.start is None else summary.track.start.isoformat(),
        "time_scale": summary.track.time_scale,
        "remarks": list(summary.remarks),
        "provenance": {"skisnow": version("skisnow")},
    }


def half_wavelength(summary: TrackSummary) -> float | None:
    """Length (m) of a curvature oscillation of which the smoothing leaves half; None without runs."""
    speeds = [summary.motion.speed[run.first : run.last + 1] for run in summary.day.runs]
    speed = np.concatenate(speeds) if speeds else np.empty(0)
    speed = speed[np.isfinite(speed)]
    return float(np.median(speed)) * summary.motion.smoothed.resolution.half_period if len(speed) else None


def _stretch_dict(stretch: Stretch, height_key: str, sign: float) -> Json:
    """JSON of a stretch; its descent (m), multiplied by `sign`, has the key `height_key`."""
    return {
        "start_s": json_number(stretch.start),
        "end_s": json_number(stretch.end),
        "distance_m": json_number(stretch.distance),
        height_key: json_number(None if stretch.descent is None else sign * stretch.descent),
        "distance_interval_m": _interval_list(stretch.distance_interval),
        "max_speed_m_per_s": json_number(stretch.max_speed),
        "max_speed_interval_m_per_s": _interval_list(stretch.max_speed_interval),
        "gaps": stretch.gaps,
    }


def _interval_list(interval: tuple[float, float] | None) -> list[float | None] | None:
    """Both ends of an interval for JSON; None without one."""
    return None if interval is None else [json_number(end) for end in interval]


def _turn_dict(turn: Turn) -> Json:
    """JSON of a turn: times (s), angle (°), radii (m), length (m), and the share that passed the smoothing."""
    return {
        "start_s": json_number(turn.start),
        "end_s": json_number(turn.end),
        "direction": turn.direction,
        "turned_angle_deg": json_number(turn.turned_angle / DEGREE),
        "turned_angle_sd_deg": json_number(turn.turned_angle_sd / DEGREE),
        "least_radius_m": json_number(turn.least_radius),
        "least_radius_interval_m": [json_number(end) for end in turn.least_radius_interval],
        "least_radius_s": json_number(turn.least_radius_time),
        "mean_radius_m": json_number(turn.mean_radius),
        "length_m": json_number(turn.length),
        "share_passed": json_number(turn.share_passed),
    }
