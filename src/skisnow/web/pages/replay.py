"""Replay: the runs that are kept, each to be watched, alone or with another one laid over it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

from nicegui import app, ui

from ...report.numerals import counted
from ..fields import link
from ..layout import framed, heading, sentence
from ..replay.addresses import LIST, SHOW, RunFolders, add_addresses, show_address

if TYPE_CHECKING:
    from pathlib import Path

    from ..settings import Lab

PATH: Final = LIST
TITLE: Final = "Replay"


def add_page(lab: Lab) -> None:
    """Add the page, and the addresses that its pictures are fetched from."""
    runs = RunFolders(lab.runs)
    add_addresses(app, runs)

    @ui.page(PATH)
    def replay() -> None:
        with framed("Replay", here=PATH):
            names = runs.names()
            sentence(f"{counted(len(names), 'run')} kept, the newest first.", "quiet")
            if not names:
                sentence("Simulate one, then it can be watched here.")
            if len(names) > 1:
                _two_runs(names)
            for name in names:
                _run(runs.place(name), name)


def _run(place: Path, name: str) -> None:
    with ui.element("section").classes("card"):
        heading(name, 2)
        sentence(_told(place), "quiet")
        with ui.element("div").classes("acts"):
            link("Watch", show_address(name), "main").props(f'aria-label="Watch {_quoted(name)}"')


def _told(place: Path) -> str:
    """What summary.json says of a run in a line; nothing where there is none."""
    try:
        summary: dict[str, Any] = json.loads((place / "summary.json").read_text(encoding="utf-8"))
        length, time = float(summary["run_length_m"]), float(summary["simulated_s"])
        return f"{length:.1f} m in {time:.2f} s, {str(summary['outcome']).replace('_', ' ')}"
    except (OSError, ValueError, KeyError, TypeError):
        return "without a readable summary"


def _two_runs(names: list[str]) -> None:
    """A form that lays one run over another: plain HTML, so that it works by keyboard everywhere."""
    heading("Two runs, one over the other", 2)
    with ui.element("form").props(f'action="{SHOW}" method="get"').classes("acts"):
        _select("run", "Run", names, 0)
        _select("ghost", "Laid over it, translucent", names, 1)
        with ui.element("button").props("type=submit").classes("act"):
            ui.label("Watch both")


def _select(key: str, text: str, names: list[str], chosen: int) -> None:
    with ui.element("label").props(f"for=replay-{key}"):
        ui.label(text)
    with ui.element("select").props(f"id=replay-{key} name={key}").classes("act"):
        for i, name in enumerate(names):
            said = f'value="{_quoted(name)}" label="{_quoted(name)}"'
            ui.element("option").props(said + (" selected" if i == chosen else ""))


def _quoted(name: str) -> str:
    """A name inside the quotes of a property."""
    return name.replace("\\", "\\\\").replace('"', '\\"')
