"""Pages of measured tracks: one track with its turns, and the comparison of two tracks or runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..._support.errors import ParameterError
from ..._support.messages import ENGLISH, Message, in_language, outcome_words
from ...comparison import compare_tracks, comparison_dict
from ...track.course.gates_table import GateGap, read_gate_gaps
from ...track.read import read_track
from ...track.summary import TrackSummary, track_summary
from ..figures.drawing import Picture, render_pictures
from ..formatting import counted, html
from ..race.figures import gap_drawings
from ..race.folder import gaps_headline, gaps_section
from ..sheet import Header, Section, sheet
from ..summaries import read_compared, time_verdict
from ..table import Column, Table, record_table
from .report import comparison_drawing, track_drawings
from .summary import GPX_FILE, TITLES, TURNS_FILE, track_gpx, track_verdict, turn_rows, turns_csv

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
    """Table with a row for each turn: the rows of turns.csv, a missing number as None."""
    return record_table(
        "turns",
        Message("Turns of {track}, with 95 % intervals due to the noise of the places.", track=summary.track.name),
        _COLUMNS,
        map(_record_json, turn_rows(summary)),
        note=Message(
            "Lean of balance: atan(v²/(g r)) at the minimum radius r. Best: the turn of its side that keeps most speed."
        ),
    )


def _record_json(row: dict[str, Any]) -> dict[str, Any]:
    """Row of a turn with None for non-finite numbers, intervals as pairs, and the side in words."""
    finite = {key: None if isinstance(value, float) and not np.isfinite(value) else value for key, value in row.items()}
    for name, low, high in (
        ("radius", "radius_low_m", "radius_high_m"),
        ("lean", "lean_low_deg", "lean_high_deg"),
    ):
        pair = finite[low], finite[high]
        finite[name] = None if None in pair else pair
    return finite | {"side": outcome_words(row["side"])}


def page_of_track(path: Path, name: str, language: str = ENGLISH, *, back: str = "") -> str:
    """HTML of the page about a track's file, with a link to a page; errors as in `read_track` and `track_summary`."""
    summary = track_summary(replace(read_track(path), name=name))
    with in_language(language):
        pictures = render_pictures(track_drawings(summary))
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


def comparison_page(
    comparison: Mapping[str, Any],
    pictures: Sequence[Picture],
    *,
    verdict: Message | None = None,
    gaps: tuple[GateGap, ...] | None = None,
    further: Sequence[Section] = (),
    back: str = "",
) -> str:
    """HTML of the page that compares two tracks, in the current language.

    comparison: contents of `skisnow.comparison.comparison_dict`.
    pictures: pictures of the tracks, and of the gates.
    verdict: verdict on the times of two computed runs (default: none).
    gaps: time lost from gate to gate (default: no gates in common).
    back: address of the page of the lab that links here (default: none).
    """
    names = comparison["simulated"]["name"], comparison["measured"]["name"]
    measured = comparison["nearest"]["rms_m"] is not None
    key = [html(text) for text in (verdict, track_verdict(comparison) if measured else None) if text]
    of_gates = [picture for picture in pictures if picture.name == "gate_gaps"]
    tracks = [picture for picture in pictures if picture.name != "gate_gaps"]
    sections = [
        Section("tracks", Message("Tracks"), key=key, pictures=tracks, tables=[_distances_table(comparison)]),
    ]
    if gaps is not None:
        sections.insert(0 if not measured else 1, gaps_section(gaps, names, of_gates))
    title = Message("{run} compared with {other}", run=names[0], other=names[1])
    headline = (gaps_headline(gaps) if gaps is not None else "") or next(iter(key), "")
    return sheet(Header(Message("Two tracks"), title, [], headline=headline, back=back), [*sections, *further])


def _distances_table(comparison: Mapping[str, Any]) -> Table:
    """Table of maximum, mean and root mean square distance (m) by each definition."""
    keys = (("max_m", Message("Maximum")), ("mean_m", Message("Mean")), ("rms_m", Message("Root mean square")))
    columns = (
        Column("definition", Message("Distance at"), "text"),
        *(Column(key, words, unit="m") for key, words in (*keys, ("compared_m", Message("Compared length")))),
    )
    rows = [
        (title, *(comparison[kind][column.key] for column in columns[1:]))
        for kind, title in TITLES.items()
    ]  # fmt: skip
    exact = comparison["known_to_m"]
    note = Message("A place is known to {exact:g} m.", exact=exact) if exact else ""
    return Table("distances", Message("Distances between the tracks."), columns, rows, note=note)


def page_of_tracks(
    path: Path, name: str, other: Path, other_name: str, language: str = ENGLISH, *, back: str = ""
) -> str:
    """HTML of the page that compares two measured tracks, with the turns of both; errors as in `page_of_track`."""
    first, second = replace(read_track(path), name=name), replace(read_track(other), name=other_name)
    comparison = compare_tracks(first, second)
    with in_language(language):
        pictures = render_pictures(map(comparison_drawing, [comparison]))
        tables = [
            replace(turns_table(summary), name=f"turns_{number}")
            for number, summary in enumerate(map(track_summary, (first, second)), start=1)
            if summary.turns
        ]
        further = [Section("turns", Message("Turns"), tables=tables)] if tables else []
        return comparison_page(comparison_dict(comparison), pictures, further=further, back=back)


def page_of_folders(
    folder: Path, other: Path, language: str = ENGLISH, *, names: tuple[str, str] | None = None, back: str = ""
) -> str:
    """HTML of the page that compares the runs of two folders, with a link back; nothing is written.

    names: names of the runs on the page (default: those of the folders).
    """
    shown = names or (folder.name, other.name)
    first, second = (replace(read_compared(path), name=name) for path, name in zip((folder, other), shown, strict=True))
    comparison, gaps = compare_tracks(first, second), read_gate_gaps(folder, other)
    with in_language(language):
        pictures = render_pictures(map(comparison_drawing, [comparison]))
        if gaps is not None:
            pictures += render_pictures(gap_drawings(gaps, comparison.names))
        compared, verdict = comparison_dict(comparison), time_verdict(first, second)
        return comparison_page(compared, pictures, verdict=verdict, gaps=gaps, back=back)
