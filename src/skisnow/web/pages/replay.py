"""Page with the list of runs and links to their replays, alone or with another run or track."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

from nicegui import app, ui

from ..._support.errors import SkisnowError
from ..._support.messages import Message
from ..._support.user_files.json_text import read_record
from ..._support.user_files.text_files import ContentError
from ...report.formatting import counted
from ...report.track.summary import GPX_FILE, TURNS_FILE
from ..elements import Outcome, Words, button, error_sentence, folded, heading, link, named, page_frame, sentence
from ..lab_tracks import LARGEST_TRACK_BYTES, MOST_POINTS, TrackFolders
from ..page_requests import address, file_input, submit_button, text_input, upload_form
from ..replay_addresses import (
    GATES,
    LIST,
    SHOW,
    TRACK_UPLOAD,
    TURNS,
    RunFolders,
    add_addresses,
    add_track_uploads,
    show_address,
)
from ..runs import FinishedRun
from ..settings import Lab
from ..words import said

PATH: Final = LIST
TITLE: Final = Message("Replay")
NONE: Final = "none"


def add_page(lab: Lab) -> None:
    """Add the page that replays runs next to measured tracks, and the addresses of its data."""
    runs, tracks = RunFolders(lab.runs), TrackFolders(lab.runs)
    add_addresses(app, runs)
    add_track_uploads(app, tracks)

    @ui.page(PATH)
    def replay(track: str = "") -> None:
        with page_frame(Message("Replay"), here=PATH):
            names, placings = runs.names(), tracks.placings()
            if track in placings:
                is_kept = Message("The track {track} is kept. Its turns are below.", track=track)
                sentence(is_kept, "good").props("role=status")
            sentence(
                Message(
                    "{n_names} kept, the newest first.", n_names=counted(len(names), "{count} run", "{count} runs")
                ),
                "quiet",
            )
            if not names:
                sentence(Message("Simulate one, then it can be watched here."))
            on_slope = [name for name, placing in placings.items() if placing.is_on_slope]
            if names:
                _side_by_side_form({name: runs.title(name) for name in names}, on_slope, track)
            _add_track_form(is_open=not placings)
            if placings:
                heading(Message("Measured tracks"), 2)
            if len(placings) > 1:
                first, second, *_ = placings
                names_by_value = {name: name for name in placings}
                with ui.element("form").props(f'action="{TURNS}" method="get"').classes("acts"):
                    _select("track", Message("Track"), names_by_value, first, form="pair")
                    _select("other", Message("Compared with"), names_by_value, second, form="pair")
                    submit_button(Message("Compare the tracks"))
            for name, placing in placings.items():
                files = {TURNS_FILE: Message("Turns as CSV")}
                if placing.is_geodetic:
                    files[GPX_FILE] = Message("Track as GPX")
                with ui.element("div").classes("acts"):
                    link(Message("Turns of {name}", name=name), address(TURNS, track=name))
                    for file, words in files.items():
                        table = link(words, address(f"{TURNS}/{file}", track=name))
                        named(table, Message("{words}: {name}", words=words, name=name))
                    _add_removal_button(tracks, name)
            for name in names:
                with ui.element("section").classes("card"):
                    heading(runs.title(name), 2)
                    sentence(_outcome_words(runs.folder_of(name)), "quiet")
                    with ui.element("div").classes("acts"):
                        named(link(Message("Watch"), show_address(name), "main"), Message("Watch {name}", name=name))


def _add_removal_button(tracks: TrackFolders, name: str) -> None:
    """Button that removes a track after a question of the browser."""

    def remove() -> None:
        try:
            tracks.remove(name)
        except SkisnowError as error:
            failed.say(error_sentence(error), bad=True)
        else:
            ui.navigate.to(PATH)

    question = json.dumps(said(Message("Remove the track {name}? This cannot be undone.", name=name)))
    removing = button(Message("Remove"), None, "small")
    named(removing, Message("Remove {name}", name=name))
    removing.on("click", remove, js_handler=f"() => {{ if (confirm({question})) emit(); }}")
    failed = Outcome()


def _outcome_words(place: Path) -> str:
    """Line with the extent and outcome of a run from summary.json."""
    try:
        run = read_record(place / "summary.json", FinishedRun)
        return f"{run.extent}, {run.outcome_in_words}"
    except ContentError:
        return Message("without a readable summary")


def _side_by_side_form(titles: dict[str, str], tracks: list[str], track: str) -> None:
    """Form for a run, a second one and a measured track that are shown together; `titles` of the runs by name."""
    names = list(titles)
    if len(names) == 1 and not tracks:
        return
    heading(Message("Side by side"), 2)
    with ui.element("form").props(f'action="{SHOW}" method="get"').classes("acts"):
        _select("run", Message("Run"), titles, names[0])
        other = names[1] if len(names) > 1 and not track else NONE
        _select("ghost", Message("Second run, translucent"), {NONE: NONE, **titles}, other)
        _select("track", Message("Measured track next to it"), {name: name for name in (NONE, *tracks)}, track or NONE)
        submit_button(Message("Watch together"), kind="main")
        submit_button(Message("Compare tracks and times"), address=GATES)


def _select(key: str, text: str, names: dict[str, str], chosen: str, *, form: str = "replay") -> None:
    """Add a labelled menu of a form sent by the browser; ``names``: titles by value; NONE sends ""."""
    with ui.element("label").props(f"for={form}-{key}"):
        Words(text)
    with ui.element("select").props(f"id={form}-{key} name={key}").classes("act"):
        for name, title in names.items():
            shown = _quoted(said(Message("none")) if name == NONE else title)
            properties = f'value="{_quoted("" if name == NONE else name)}" label="{shown}"'
            ui.element("option").props(properties + (" selected" if name == chosen else ""))


def _add_track_form(*, is_open: bool) -> None:
    """Add the folded form that uploads a measured track with its place on the slope."""
    with folded(Message("Add a measured track"), is_open=is_open):
        sentence(
            Message(
                "CSV, GPX, TCX, FIT, NMEA, UBX or RTKLIB, up to {largest_track_bytes} MB and {most_points:,} "
                "points. To show a track in latitude and longitude next to a run, state the compass direction in "
                "which the slope falls. The track then begins at the start of the run. A track in the axes of a run "
                "(x down the fall line, y left, z out of the snow, in m) keeps its place. Nothing is fitted.",
                largest_track_bytes=LARGEST_TRACK_BYTES // 1_000_000,
                most_points=MOST_POINTS,
            ),
            "quiet",
        )
        with upload_form(TRACK_UPLOAD).classes("acts"):
            azimuth = Message("Direction of the fall line (°), clockwise from north, optional")
            file_input("file", Message("Track"), "track-file")
            text_input("azimuth", azimuth, "track-azimuth", "inputmode=decimal")
            text_input(
                "start", Message("Time of the run at its first point (s)"), "track-start", "inputmode=decimal value=0"
            )
            submit_button(Message("Add the track"))


def _quoted(name: str) -> str:
    """A name with escaped quotes for a property."""
    return name.replace("\\", "\\\\").replace('"', '\\"')
