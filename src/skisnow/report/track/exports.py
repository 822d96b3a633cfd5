"""Tables of a measured track: its turns and its points as CSV, its points as GPX."""

from __future__ import annotations

import csv
import io
from datetime import timedelta
from typing import TYPE_CHECKING, Any, Final
from xml.sax.saxutils import escape

import numpy as np

from ..._support.spreadsheet_text import guarded
from ..._support.units import DEGREE
from ...track.projection import earth_centred, east_north_up_axes, geodetic

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...track.summary import TrackSummary
    from ...track.turns import Turn

GRAVITY: Final = 9.81
TURNS_FILE: Final = "turns.csv"
POINTS_FILE: Final = "points.csv"
GPX_FILE: Final = "track.gpx"
TURN_COLUMNS: Final = (
    "turn", "side", "start_s", "duration_s", "length_m", "minimum_radius_m", "radius_low_m", "radius_high_m",
    "speed_in_m_per_s", "speed_out_m_per_s", "speed_ratio", "lean_deg", "lean_low_deg", "lean_high_deg", "best",
)  # fmt: skip


def turn_rows(summary: TrackSummary) -> list[dict[str, Any]]:
    """Row of each turn.

    Lean is the angle of balance atan(v²/(g r)) at the minimum radius r, with its interval from that of r. The best turn
    of a side is the one with the largest ratio of the speeds out and in.
    """
    rows = [_turn_row(summary, number, turn) for number, turn in enumerate(summary.turns, start=1)]
    for side in ("left", "right"):
        ratios = [row["speed_ratio"] for row in rows if row["side"] == side and np.isfinite(row["speed_ratio"])]
        for row in rows:
            if row["side"] == side and len(ratios) > 1 and row["speed_ratio"] == max(ratios):
                row["best"] = "best"
    return rows


def _turn_row(summary: TrackSummary, number: int, turn: Turn) -> dict[str, Any]:
    known = np.isfinite(summary.motion.speed)
    moments = [turn.start, turn.end, turn.least_radius_time]
    speeds = np.interp(moments, summary.motion.time[known], summary.motion.speed[known])
    low, high = turn.least_radius_interval
    lean, most, least = np.arctan(speeds[2] ** 2 / (GRAVITY * np.array([turn.least_radius, low, high]))) / DEGREE
    values = (
        number, turn.direction, turn.start, turn.end - turn.start, turn.length, turn.least_radius, low, high,
        speeds[0], speeds[1], speeds[1] / speeds[0] if speeds[0] > 0 else np.nan, lean, least, most, "",
    )  # fmt: skip
    return dict(zip(TURN_COLUMNS, values, strict=True))


def turns_csv(summary: TrackSummary) -> str:
    """CSV of the turns."""
    return _csv(TURN_COLUMNS, ([row[name] for name in TURN_COLUMNS] for row in turn_rows(summary)))


def points_csv(summary: TrackSummary) -> str:
    """CSV of the points: time, place, speed, signed radius, and latitude and longitude if the track has them."""
    motion, degrees = summary.motion, _degrees(summary)
    radius = np.divide(1.0, motion.curvature, out=np.full(len(motion.time), np.nan), where=motion.curvature != 0.0)
    columns = {"time_s": motion.time, "x_m": summary.track.place[:, 0], "y_m": summary.track.place[:, 1]}
    columns |= {"z_m": summary.track.place[:, 2]} if summary.track.place.shape[1] > 2 else {}
    columns |= {"speed_m_per_s": motion.speed, "radius_m": radius}
    if degrees is not None:
        columns |= {"latitude_deg": degrees[:, 0], "longitude_deg": degrees[:, 1]}
    return _csv(tuple(columns), zip(*(values.tolist() for values in columns.values()), strict=True))


def _csv(columns: Sequence[str], rows: Iterable[Iterable[Any]]) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_cell(value) for value in row] for row in rows)
    return stream.getvalue()


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.9g}" if np.isfinite(value) else ""
    return guarded(str(value))


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
