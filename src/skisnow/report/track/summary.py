"""Measured tracks as text for a terminal, CSV and GPX; comparisons of two tracks as text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime, timedelta
from itertools import chain
from textwrap import fill
from typing import Any, Final
from xml.sax.saxutils import escape

import numpy as np

from ..._support.messages import Message, local_number
from ..._support.spreadsheet_text import csv_text, protect_from_formulas
from ..._support.units import DEGREE
from ...track.projection import earth_centred, east_north_up_axes, geodetic
from ...track.summary import TrackSummary
from ..formatting import aligned_rows, named_rows, plain

Json = dict[str, Any]
MOST_ROWS: Final = 40  # maximum number of rows of a table; the JSON has all
WIDTH: Final = 110  # maximum length of a line of prose

_RUNS_WORDS: Final = {
    "height": "A run is what descends between two lifts, from the last stop at its top to the first at its bottom; "
    "descent is height at the start less height at the end.",
    "motion": "A run is a stretch in motion, faster than 1 m/s but for stops up to 30 s.",
}
_TURNS_WORDS: Final = (
    "A turn is a stretch of one sense of curvature in a run, 10 degrees at least; two that follow each other meet in "
    "the switch point. The minimum radius is 1 / the largest curvature of the smoothed track, with its 95 % interval "
    "from only the noise. `passed` is the share of the curvature that the smoothing leaves of half a sine as long as "
    "the turn."
)


def track_text(values: Mapping[str, Any], *, flag_sentences: Mapping[str, str] | None = None) -> str:
    """Text of a measured track: its numbers, flags, runs, lifts and turns.

    values: contents of `skisnow.track.summary.summary_dict`.
    flag_sentences: sentence of each flag, by code.
    """
    lines = [values["file"], "", *named_rows(_summary_rows(values))]
    for code, count in values["marked"].items():
        lines.append(f"{'flagged ' + code.replace('_', ' ')}: {count}. {(flag_sentences or {}).get(code, '')}".rstrip())
    for remark in values["remarks"]:
        lines.append(f"Note: {remark}")
    lines += _table_lines("runs", values["runs"], _RUN_COLUMNS, _RUNS_WORDS[values["runs_by"]])
    if values["lifts"]:
        lines += _table_lines("lifts", values["lifts"], _LIFT_COLUMNS, "")
    lines += _table_lines("turns", values["turns"], _TURN_COLUMNS, _TURNS_WORDS)
    return "\n".join(lines)


def _summary_rows(values: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Names and texts of a track's rows for the terminal."""
    smoothing = values["smoothing"]
    yield "points", f"{values['points']} in {plain(values['duration_s'], 4)} s, time scale {values['time_scale']}"
    if values["start"]:
        time, scale = datetime.fromisoformat(values["start"]), values["time_scale"]
        yield "start", f"{time:%Y-%m-%d %H:%M:%S}{'' if scale == 'local' else f' {scale}'}"
    if solutions := values.get("solutions"):
        yield "carrier phase", ", ".join(f"{count} {_SOLUTION_WORDS[name]}" for name, count in solutions.items())
    yield "frame", values["frame"]
    distance = f"{plain(values['distance_m'], 5)} m{_interval(values['distance_interval_m'], 'm', 5)}"
    yield "distance", f"{distance}, {_DISTANCE_WORDS[values['distance_source']]}"
    if values["horizontal_distance_m"] not in (None, values["distance_m"]):
        horizontal = _interval(values["horizontal_distance_interval_m"], "m", 5)
        yield "seen from above", f"{plain(values['horizontal_distance_m'], 5)} m{horizontal}"
    speed = f"{plain(values['max_speed_m_per_s'], 4)} m/s{_interval(values['max_speed_interval_m_per_s'], 'm/s', 4)}"
    yield "highest speed", f"{speed}, {_SPEED_WORDS[values['speed_source']]}"
    yield "smoothing", f"cubics by least squares in windows of {plain(smoothing['window_s'])} s"
    length = smoothing["half_amplitude_wavelength_m"]
    wave = "" if length is None else f" ({plain(length)} m at the median speed of the runs)"
    halved = f"a curvature that swings in {plain(smoothing['half_amplitude_period_s'])} s{wave} is halved"
    yield "resolution", f"{halved}, in {plain(smoothing['ninety_percent_period_s'])} s it keeps 90 %"


def _interval(ends: Sequence[float | None] | None, unit: str, digits: int) -> str:
    """Text of a 95 % interval; "" for None."""
    return "" if ends is None else f" (95 %: {plain(ends[0], digits)} to {plain(ends[1], digits)} {unit})"


_DISTANCE_WORDS: Final = {
    "odometer": "the device's own",
    "recorded_speed": "the integral of the recorded speed",
    "places": "the length of the estimated path with its heights",
}
_SOLUTION_WORDS: Final = {
    "fixed": "points fixed to whole cycles", "float": "float", "code": "by the code alone",
}  # fmt: skip
_SPEED_WORDS: Final = {"recorded": "as recorded", "fitted": "horizontal, of the estimated path: no speeds are recorded"}


_RUN_COLUMNS: Final = (
    ("start_s", "start (s)", -1), ("end_s", "end (s)", -1), ("distance_m", "distance (m)", 4),
    ("descent_m", "descent (m)", 3), ("max_speed_m_per_s", "highest speed (m/s)", 3),
)  # fmt: skip
_LIFT_COLUMNS: Final = (
    ("start_s", "start (s)", -1), ("end_s", "end (s)", -1), ("distance_m", "distance (m)", 4),
    ("ascent_m", "ascent (m)", 3),
)  # fmt: skip
_TURN_COLUMNS: Final = (
    ("start_s", "start (s)", -1), ("end_s", "end (s)", -1), ("direction", "to the", 0),
    ("turned_angle_deg", "change of heading (deg)", 3), ("length_m", "length (m)", 3),
    ("least_radius_m", "minimum radius (m)", 3), ("least_radius_interval_m", "95 % interval (m)", 3),
    ("share_passed", "passed", 2),
)  # fmt: skip


def _table_lines(title: str, rows: Sequence[Json], columns: Sequence[tuple[str, str, int]], words: str) -> list[str]:
    """Lines of a table: heading, definition, rows. Columns: key, label, significant digits, if negative decimals."""
    if not rows:
        return ["", f"0 {title}", *fill(words, WIDTH).splitlines()]
    cells = [[label for _, label, _ in columns]]
    cells += [[_cell_text(row[key], digits) for key, _, digits in columns] for row in rows[:MOST_ROWS]]
    more = [f"… and {len(rows) - MOST_ROWS} more; --json gives all"] if len(rows) > MOST_ROWS else []
    heading = f"{len(rows)} {title.removesuffix('s') if len(rows) == 1 else title}"
    return ["", heading, *fill(words, WIDTH).splitlines(), *aligned_rows(cells), *more]


def _cell_text(value: Any, digits: int) -> str:
    """Text of a value: unchanged text, a pair as a range, or a number; negative `digits`: decimals."""
    if isinstance(value, str):
        return value
    if isinstance(value, list):
        return " to ".join("straight" if end is None else plain(end, digits) for end in value)
    return f"{value:.{-digits}f}" if digits < 0 else plain(value, digits)


TITLES: Final = {
    "nearest": Message("nearest place"),
    "arc_length": Message("equal arc length"),
    "time": Message("equal time"),
}
_NO_FRAME: Final = (
    "No distance is printed: the tracks are not in one frame, so that it would say nothing. For a track in latitude",
    "and longitude give --fall-line-azimuth-deg, the direction in which the slope falls, and --slope-angle-deg,",
    "or let --fit-offset start,heading find where the simulated track lies.",
)
_WORDS: Final = {"max": "largest", "mean": "mean", "rms": "rms"}


def compare_summary(comparison: Mapping[str, Any]) -> str:
    """Text of a comparison: distances with their definitions.

    comparison: contents of `skisnow.comparison.comparison_dict`.
    """
    simulated, measured, exact = comparison["simulated"], comparison["measured"], comparison["known_to_m"]
    lines = [
        f"{simulated['name']} ({metres(simulated['length_m'], exact, 4)}) compared with {measured['name']} "
        f"({metres(measured['length_m'], exact, 4)}), {comparison['seen']}",
        "",
    ]
    if not comparison["in_one_frame"]:
        return "\n".join([*lines, *_NO_FRAME])
    if comparison["nearest"]["rms_m"] is not None:
        lines += [track_verdict(comparison), ""]
    for kind, title in TITLES.items():
        lines += [*_distance_lines(title, comparison[kind], measured["length_m"], exact), ""]
    back = comparison["largest_from_simulated_m"]
    if back is not None:
        lines.append(
            f"The other way round, from the simulated track to the nearest place of the measured one: "
            f"maximum {metres(back, exact)}."
        )
    lines.append(f"{comparison['means']}.")
    if exact:
        lines.append(f"A place is known to {plain(exact, 1)} m: no further digits are printed.")
    lines += _fitted_lines(comparison)
    return "\n".join(lines)


def track_verdict(comparison: Mapping[str, Any]) -> Message:
    """Sentence whether two tracks differ by more than the places are known: rms distance of nearest places.

    Two places that are each known to u differ by √2 u if the tracks are the same; twice that counts as certain.
    """
    rms, exact = comparison["nearest"]["rms_m"], comparison["known_to_m"] or 0.0
    apart = local_number(metres(rms, exact))
    if not exact:
        return Message("The tracks are {apart} apart (root mean square, nearest place).", apart=apart)
    if rms > 2.0 * math.sqrt(2.0) * exact:
        return Message(
            "The tracks are {apart} apart (root mean square, nearest place): certain, as a place is known to {exact} "
            "m.",
            apart=apart, exact=local_number(plain(exact, 1)),
        )  # fmt: skip
    return Message(
        "The tracks are {apart} apart (root mean square, nearest place): not certain, as a place is known to {exact} m "
        "only.",
        apart=apart, exact=local_number(plain(exact, 1)),
    )  # fmt: skip


_ROUNDING: Final = 1e-12  # largest size of a distance (m) that is an error of rounding


def metres(value: float | None, exact: float, digits: int = 3) -> str:
    """Text of a distance in m, without digits below the precision ``exact`` (m) of the places, which may be 0.

    >>> metres(4e-17, 0.0), metres(2.345, 3.0), metres(0.4, 3.0), metres(41.987, 0.02, 4), metres(41.987, 0.3, 4)
    ('0 m', '2 m', 'below 1 m', '41.99 m', '42.0 m')
    """
    return f"{rounded(value, exact, digits)} m"


def rounded(value: float | None, exact: float, digits: int = 3) -> str:
    """Text of a number without digits below the precision ``exact``; with ``digits`` significant digits if it is 0."""
    if value is not None and abs(value) < _ROUNDING:
        value = 0.0
    if value is None or exact <= 0.0 or not math.isfinite(value):
        return plain(value, digits)
    decimals = -math.floor(math.log10(exact))
    if 0.0 < abs(value) < 0.5 * 10.0**-decimals:
        return str(Message("below {limit}", limit=f"{10.0**-decimals:.{max(decimals, 0)}f}"))
    fewest = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    return f"{round(value, min(decimals, max(fewest, 0))):.{max(min(decimals, max(fewest, 0)), 0)}f}"


def _distance_lines(title: str, distances: Mapping[str, Any], length: float, exact: float) -> Iterator[str]:
    """Lines on the distances of two tracks; length: of the measured one (m); exact: accuracy of places (m)."""
    yield f"{title}: {distances['definition']}"
    if distances["max_m"] is None:
        yield f"  none: {distances['reason']}"
        return
    for key, word in _WORDS.items():
        share = rounded(100.0 * distances[f"{key}_share"], 100.0 * exact / length, 2)
        where = f", {metres(distances['max_at_m'], exact)} along it" if key == "max" else ""
        yield f"  {word:8}{metres(distances[f'{key}_m'], exact)}, {share} % of the measured track's length{where}"
    share = plain(100.0 * distances["compared_share"], 4)
    yield f"  over    {metres(distances['compared_m'], exact, 4)}, {share} % of the measured track"


def _fitted_lines(comparison: Mapping[str, Any]) -> Iterator[str]:
    """Lines about a fit: movement, turn, and distances before and after; none without a fit."""
    fitted = comparison["fitted"]
    if fitted is None:
        return
    yield ""
    yield f"Fitted: {', '.join(fitted['what'])}. The simulated track was moved as a whole before it was compared:"
    height = "" if fitted["moved_z_m"] is None else f", z {plain(fitted['moved_z_m'])} m"
    yield (
        f"  start by x {plain(fitted['moved_x_m'])} m, y {plain(fitted['moved_y_m'])} m{height}; turned by "
        f"{plain(fitted['turned_deg'])} degrees to the left; looked up {plain(fitted['later_s'])} s later"
    )
    if fitted["undetermined"]:
        yield f"  {fitted['undetermined']} direction(s) these tracks do not tell; nothing was moved along them"
    for kind, title in TITLES.items():
        states = []
        for state in (fitted["before"], comparison):
            largest, mean = (metres(state[kind][key], comparison["known_to_m"]) for key in ("max_m", "mean_m"))
            states.append(f"both {mean}" if largest == mean else f"{largest} and {mean}")
        yield f"  {title}: largest and mean {states[0]} before, {states[1]} after"


GRAVITY: Final = 9.81
TURNS_FILE: Final = "turns.csv"
POINTS_FILE: Final = "points.csv"
GPX_FILE: Final = "track.gpx"
TURN_COLUMNS: Final = (
    "turn", "side", "start_s", "duration_s", "length_m", "minimum_radius_m", "radius_low_m", "radius_high_m",
    "speed_in_m_per_s", "speed_out_m_per_s", "speed_ratio", "lean_deg", "lean_low_deg", "lean_high_deg", "best",
)  # fmt: skip


def turn_rows(summary: TrackSummary) -> list[dict[str, Any]]:
    """Values of each turn of a track, by the names of `TURN_COLUMNS`.

    Lean is the angle of balance atan(v²/(g r)) at the minimum radius r, with its interval from that of r. The best turn
    of a side is the one with the largest ratio of the speeds out and in.
    """
    rows = []
    has_speed = np.isfinite(summary.motion.speed)
    for number, turn in enumerate(summary.turns, start=1):
        moments = [turn.start, turn.end, turn.least_radius_time]
        speeds = np.interp(moments, summary.motion.time[has_speed], summary.motion.speed[has_speed])
        low, high = turn.least_radius_interval
        lean, most, least = np.arctan(speeds[2] ** 2 / (GRAVITY * np.array([turn.least_radius, low, high]))) / DEGREE
        values = (
            number, turn.direction, turn.start, turn.end - turn.start, turn.length, turn.least_radius, low, high,
            speeds[0], speeds[1], speeds[1] / speeds[0] if speeds[0] > 0 else np.nan, lean, least, most, "",
        )  # fmt: skip
        rows.append(dict(zip(TURN_COLUMNS, values, strict=True)))
    for side in ("left", "right"):
        ratios = [row["speed_ratio"] for row in rows if row["side"] == side and np.isfinite(row["speed_ratio"])]
        for row in rows:
            if row["side"] == side and len(ratios) > 1 and row["speed_ratio"] == max(ratios):
                row["best"] = "best"
    return rows


def turns_csv(summary: TrackSummary) -> str:
    """CSV text with a row for each turn of a track; the columns are TURN_COLUMNS."""
    return _csv_text(TURN_COLUMNS, ([row[name] for name in TURN_COLUMNS] for row in turn_rows(summary)))


def points_csv(summary: TrackSummary) -> str:
    """CSV of the points: time, place, speed, signed radius, and latitude and longitude if the track has them."""
    motion, degrees = summary.motion, _degrees(summary)
    radius = np.divide(1.0, motion.curvature, out=np.full(len(motion.time), np.nan), where=motion.curvature != 0.0)
    columns = {"time_s": motion.time, "x_m": summary.track.place[:, 0], "y_m": summary.track.place[:, 1]}
    columns |= {"z_m": summary.track.place[:, 2]} if summary.track.place.shape[1] > 2 else {}
    columns |= {"speed_m_per_s": motion.speed, "radius_m": radius}
    if degrees is not None:
        columns |= {"latitude_deg": degrees[:, 0], "longitude_deg": degrees[:, 1]}
    return _csv_text(tuple(columns), zip(*(values.tolist() for values in columns.values()), strict=True))


def _csv_text(columns: Sequence[str], rows: Iterable[Iterable[Any]]) -> str:
    """CSV text of a header and rows."""
    return csv_text(chain([columns], (map(_point_cell, row) for row in rows)))


def _point_cell(value: object) -> str:
    """Cell of a float with nine digits, "" if it is not finite; other values as protected text."""
    if isinstance(value, float):
        return f"{value:.9g}" if np.isfinite(value) else ""
    return protect_from_formulas(str(value))


def track_gpx(summary: TrackSummary) -> str | None:
    """GPX 1.1 with a segment for each stretch without a gap; None for a track without latitude and longitude."""
    degrees, track = _degrees(summary), summary.track
    if degrees is None:
        return None
    segments: dict[int, list[str]] = {}
    for number in np.flatnonzero(track.usable & np.isfinite(degrees[:, :2]).all(axis=1)).tolist():
        latitude, longitude, height = degrees[number]
        elevation = f"<ele>{height:.3f}</ele>" if np.isfinite(height) else ""
        time = ""
        if track.start is not None:
            moment = track.start + timedelta(seconds=float(track.time[number] - track.time[0]))
            time = f"<time>{moment.isoformat().replace('+00:00', 'Z')}</time>"
        point = f'<trkpt lat="{latitude:.8f}" lon="{longitude:.8f}">{elevation}{time}</trkpt>'
        segments.setdefault(int(summary.motion.smoothed.part[number]), []).append(point)
    inside = "\n".join(f"<trkseg>\n{chr(10).join(points)}\n</trkseg>" for points in segments.values())
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="skisnow" '
        f'xmlns="http://www.topografix.com/GPX/1/1">\n<trk><name>{escape(track.name)}</name>\n{inside}\n</trk>\n</gpx>\n'
    )


def _degrees(summary: TrackSummary) -> Any:
    """Latitude, longitude (°) and height (m) of the points, shape (n, 3); None without an origin."""
    origin, place = summary.track.origin, summary.track.place
    if origin is None:
        return None
    missing = np.isnan(place[:, 2])
    level = np.where(missing[:, None], np.column_stack([place[:, :2], np.zeros(len(place))]), place)
    there = earth_centred(*map(np.array, (origin.latitude_deg, origin.longitude_deg, origin.height)))
    degrees = geodetic(there + level @ east_north_up_axes(origin.latitude_deg, origin.longitude_deg))
    degrees[missing, 2] = np.nan
    return degrees
