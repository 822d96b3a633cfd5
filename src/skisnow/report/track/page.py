"""Page of a measured track: pictures from above, and a table of its turns."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, in_language, outcome_words
from ...track.read import read_track
from ...track.summary import TrackSummary, track_summary
from ..figures.figure_files import render_pictures
from ..formatting import counted
from ..sheet import Header, Section, sheet
from ..table import Column, Table, record_table
from .report import track_drawings
from .summary import GPX_FILE, TURNS_FILE, track_gpx, turn_rows, turns_csv

_COLUMNS: Final = (
    Column("turn", Message("Turn"), "count"),
    Column("side", Message("Side"), "words"),
    Column("minimum_radius_m", Message("Minimum radius"), "estimate", "m", interval="radius"),
    Column("duration_s", Message("Duration"), unit="s"),
    Column("speed_in_m_per_s", Message("Speed at the start"), unit="m/s"),
    Column("speed_out_m_per_s", Message("Speed at the end"), unit="m/s"),
    Column("lean_deg", Message("Lean of balance"), "estimate", "°", interval="lean"),
    Column("length_m", Message("Length"), unit="m"),
    Column("best", Message("Best"), "tick"),
)


def turns_table(summary: TrackSummary) -> Table:
    """Table of the turns: the rows of turns.csv, a missing number as None."""
    return record_table(
        "turns",
        Message("Turns of {track}, with 95 % intervals due to the noise of the places.", track=summary.track.name),
        _COLUMNS,
        map(_record, turn_rows(summary)),
        note=Message(
            "Lean of balance: atan(v²/(g r)) at the minimum radius r. Best: the turn of its side that keeps most speed."
        ),
    )


def _record(row: dict[str, Any]) -> dict[str, Any]:
    finite = {key: None if isinstance(value, float) and not np.isfinite(value) else value for key, value in row.items()}
    for name, low, high in (
        ("radius", "radius_low_m", "radius_high_m"),
        ("lean", "lean_low_deg", "lean_high_deg"),
    ):
        pair = finite[low], finite[high]
        finite[name] = None if None in pair else pair
    return finite | {"side": outcome_words(row["side"])}


def page_of_track(path: Path, name: str, language: str = ENGLISH, *, back: str = "") -> str:
    """HTML of the page of a file, with a link back to a page; errors as in `read_track` and `track_summary`."""
    summary = track_summary(replace(read_track(path), name=name))
    pictures = render_pictures(track_drawings(summary), language=language)
    with in_language(language):
        count = counted(len(summary.turns), "{count} turn", "{count} turns")
        sections = [
            Section("pictures", Message("From above"), pictures=pictures),
            *([Section("turns", Message("Turns"), tables=[turns_table(summary)])] if summary.turns else []),
        ]
        return sheet(Header(Message("Measured track"), name, [], headline=count, back=back), sections)


def file_of_track(path: Path, name: str, file: str) -> str:
    """Text of turns.csv or track.gpx of a track; errors as in `page_of_track`, and without latitude and longitude."""
    summary = track_summary(replace(read_track(path), name=name))
    text = {TURNS_FILE: turns_csv, GPX_FILE: track_gpx}[file](summary)
    if text is None:
        raise ParameterError("{track} has no latitude and longitude, which GPX requires. Use its CSV").tag(
            "no_origin", track=name
        )
    return text
