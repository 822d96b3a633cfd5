"""Replay: the runs that are kept, each to be watched, alone or with another one laid over it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import app, ui

from ..._support.user_files import GivenError, read_record
from ...report.formatting import counted
from ..elements import Words, link, named
from ..language import said
from ..layout import framed, heading, sentence
from ..replay.addresses import GATES, LIST, SHOW, UPLOAD, RunFolders, add_addresses, add_uploads, show_address
from ..replay.tracks import LARGEST_BYTES, MOST_POINTS, TrackFolders
from ..runs import FinishedRun

if TYPE_CHECKING:
    from pathlib import Path

    from ..settings import Lab

PATH: Final = LIST
TITLE: Final = "Replay"
NONE: Final = "none"


def add_page(lab: Lab) -> None:
    """Add the page, and the addresses that its pictures are fetched from."""
    runs, tracks = RunFolders(lab.runs), TrackFolders(lab.runs)
    add_addresses(app, runs)
    add_uploads(app, tracks)

    @ui.page(PATH)
    def replay(track: str = "") -> None:
        with framed("Replay", here=PATH):
            names = runs.names()
            if track in tracks.names():
                sentence(f"The track {track} is kept. Choose the run that it is to stand beside.", "good").props(
                    "role=status"
                )
            sentence(f"{counted(len(names), 'run')} kept, the newest first.", "quiet")
            if not names:
                sentence("Simulate one, then it can be watched here.")
            if names:
                _together(names, tracks.names(), track)
            _upload()
            for name in names:
                _run(runs.place(name), name)


def _run(place: Path, name: str) -> None:
    with ui.element("section").classes("card"):
        heading(name, 2)
        sentence(_in_words(place), "quiet")
        with ui.element("div").classes("acts"):
            named(link("Watch", show_address(name), "main"), f"Watch {name}")


def _in_words(place: Path) -> str:
    """What summary.json says of a run in a line; nothing where there is none."""
    try:
        run = read_record(place / "summary.json", FinishedRun, only_known=False)
        return f"{run.extent}, {run.outcome_in_words}"
    except GivenError:
        return "without a readable summary"


def _together(names: list[str], tracks: list[str], track: str) -> None:
    """A form that puts a run, another one and a track together: plain HTML, so that it works by keyboard everywhere."""
    if len(names) == 1 and not tracks:
        return
    heading("Side by side", 2)
    with ui.element("form").props(f'action="{SHOW}" method="get"').classes("acts"):
        _select("run", "Run", names, names[0])
        other = names[1] if len(names) > 1 and not track else NONE
        _select("ghost", "Laid over it, translucent", [NONE, *names], other)
        _select("track", "Measured track beside it", [NONE, *tracks], track or NONE)
        with ui.element("button").props("type=submit").classes("act main"):
            Words("Watch together")
        with ui.element("button").props(f'type=submit formaction="{GATES}"').classes("act"):
            Words("Compare times at gates")


def _select(key: str, text: str, names: list[str], chosen: str) -> None:
    with ui.element("label").props(f"for=replay-{key}"):
        Words(text)
    with ui.element("select").props(f"id=replay-{key} name={key}").classes("act"):
        for name in names:
            shown = _quoted(said(NONE) if name == NONE else name)
            told = f'value="{_quoted("" if name == NONE else name)}" label="{shown}"'
            ui.element("option").props(told + (" selected" if name == chosen else ""))


def _upload() -> None:
    """A form that takes a measured track in."""
    with ui.element("details"):
        with ui.element("summary"):
            Words("Add a measured track")
        sentence(
            f"CSV, GPX, FIT, NMEA, UBX or RTKLIB, up to {LARGEST_BYTES // 1_000_000} MB and {MOST_POINTS} points. A "
            "track in latitude and longitude needs the compass direction in which the slope falls; it begins where the "
            "run begins. One in the run's own axes (x down the fall line, y left, z out of the snow, in m) needs none, "
            "and stands where it says. Nothing is fitted.",
            "quiet",
        )
        form = f'method=post action="{UPLOAD}" enctype="multipart/form-data"'
        with ui.element("form").props(form).classes("acts"):
            _input("file", "Track", "type=file required")
            _input("azimuth", "Direction of the fall line (°), clockwise from north", "inputmode=decimal")
            _input("start", "Time of the run at its first point (s)", "inputmode=decimal value=0")
            with ui.element("button").props("type=submit").classes("act"):
                Words("Add the track")


def _input(key: str, text: str, further: str) -> None:
    with ui.element("label").props(f"for=track-{key}"):
        Words(text)
    ui.element("input").props(f"id=track-{key} name={key} {further}").classes("" if "file" in further else "act plain")


def _quoted(name: str) -> str:
    """A name inside the quotes of a property."""
    return name.replace("\\", "\\\\").replace('"', '\\"')
