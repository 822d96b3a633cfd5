"""Time from asking for a page until what it is for stands there, by the browser's own clock."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .filled_lab import RUN

if TYPE_CHECKING:
    from .filled_lab import FilledLab

GOAL_S = 1.0
PATIENCE_MS = 300_000
TALKS = "window.did_handshake"
DRAWN = "document.querySelectorAll('.js-plotly-plot .scatterlayer .trace').length"


@dataclass(frozen=True, slots=True)
class Opening:
    """A page: in words what must stand there, its address, the same as a condition in the browser."""

    what: str
    address: str
    shown: str


@dataclass(frozen=True, slots=True)
class Times:
    """Seconds of several tries, in their order."""

    what: str
    seconds: tuple[float, ...]


def openings(lab: FilledLab) -> list[Opening]:
    """Every page of the lab."""
    season = f"/analysis/entry/{lab.entry}"
    reference = f"/analysis/kept/{lab.kept}"
    numbers, figures = "document.querySelector('main .table td')", "document.querySelector('main figure img')"
    return [
        Opening("Campaigns: the list", "/", "document.querySelectorAll('.card').length == 2"),
        Opening("New campaign: its form", "/describe", f"{TALKS} && document.querySelector('main input')"),
        Opening(
            f"Enter, {lab.readings} readings in the store: a field to type in",
            f"/enter/{lab.entry}",
            f"{TALKS} && document.activeElement.matches('main input')",
        ),
        Opening("Analysis of the reference campaign: numbers", reference, numbers),
        Opening("Analysis of the reference campaign: figures", reference, figures),
        Opening(f"Analysis of {lab.readings} readings: numbers", season, numbers),
        Opening(f"Analysis of {lab.readings} readings: figures", season, figures),
        Opening("Skis: numbers and drawings", "/skis", f"document.querySelector('td') && {DRAWN} >= 5"),
        Opening("Carve: numbers and drawings", "/carve", f"document.querySelector('td') && {DRAWN} >= 4"),
        Opening("Simulate: its form", "/simulate", f"{TALKS} && document.querySelectorAll('summary').length > 3"),
        Opening("Replay: the list", "/replay", "document.querySelectorAll('.card').length == 1"),
        Opening("Replay of 5 s: the first picture", f"/replay/show?run={RUN}", "window.skisnowReplay?.frames > 0"),
    ]


def opened(browser: Any, lab: FilledLab, *, tries: int) -> Iterator[Times]:
    """Each page several times, each time by a browser that has kept nothing; the first time is the server's first."""
    for each in openings(lab):
        yield Times(each.what, tuple(_once(browser, lab, each) for _ in range(tries)))


def _once(browser: Any, lab: FilledLab, opening: Opening) -> float:
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    page = context.new_page()
    page.goto(lab.address + opening.address, wait_until="commit")
    # performance.now() counts from the beginning of the navigation; looked at before every picture that is drawn
    found = page.wait_for_function(f"() => ({opening.shown}) && performance.now()", timeout=PATIENCE_MS)
    milliseconds = float(found.json_value())
    context.close()
    return milliseconds / 1e3
