"""Time from asking for a page until what it is for stands there, by the browser's own clock."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .filled_lab import RUN

if TYPE_CHECKING:
    from .filled_lab import FilledLab

GOAL_S = 1.0
PATIENCE_MS = 120_000
TALKS = "window.did_handshake"
DRAWN = "document.querySelectorAll('svg path.line').length"


@dataclass(frozen=True, slots=True)
class Opening:
    """A page: where it is at each try, and in words and as a condition in the browser what must stand there.

    ``before`` is done ahead of each try, with its number.
    """

    addresses: tuple[str, ...]
    shown: dict[str, str]
    before: Callable[[int], object] = int


@dataclass(frozen=True, slots=True)
class Times:
    """Seconds of several tries, in their order."""

    what: str
    seconds: tuple[float, ...]


def openings(lab: FilledLab) -> list[Opening]:
    """Every page of the lab."""
    return [
        Opening(("/",), {"Campaigns: the list": f"document.querySelectorAll('.card').length == {1 + len(lab.kept)}"}),
        Opening(("/describe",), {"New campaign: its form": f"{TALKS} && document.querySelector('main input')"}),
        Opening(
            (f"/enter/{lab.entry}",),
            {
                f"Enter, {lab.readings} readings in the store: a field to type in": (
                    f"{TALKS} && document.querySelector('main input:enabled')"
                )
            },
        ),
        *_analyses(lab),
        Opening(("/skis",), {"Skis: numbers and drawings": f"document.querySelector('td') && {DRAWN} >= 5"}),
        Opening(("/carve",), {"Carve: numbers and drawings": f"document.querySelector('td') && {DRAWN} >= 4"}),
        Opening(("/simulate",), {"Simulate: its form": f"{TALKS} && document.querySelectorAll('summary').length > 3"}),
        Opening(("/replay",), {"Replay: the list": "document.querySelectorAll('.card').length == 1"}),
        Opening((f"/replay/show?run={RUN}",), {"Replay of 5 s: the first picture": "window.skisnowReplay?.frames > 0"}),
    ]


def _analyses(lab: FilledLab) -> list[Opening]:
    reference = tuple(f"/analysis/kept/{id_}" for id_ in lab.kept)
    season = (f"/analysis/entry/{lab.entry}",)
    of_season, of_reference = f"Analysis of {lab.readings} readings", "Analysis of the reference campaign"
    return [
        Opening(reference, _analysed(f"{of_reference}, first time")),
        Opening(reference, _analysed(f"{of_reference}, again")),
        Opening(
            season,
            _analysed(f"{of_season}, when one was added"),
            lambda attempt: lab.enter_one_more(f"further {attempt}"),
        ),
        Opening(season, _analysed(f"{of_season}, again")),
    ]


def _analysed(words: str) -> dict[str, str]:
    done = "document.querySelector('.status').textContent.endsWith('used.')"
    return {
        f"{words}: numbers": "document.querySelector('main .table td')",
        f"{words}: the first figure": "document.querySelector('main figure img')",
        f"{words}: all figures": f"document.querySelector('main figure img') && {done}",
    }


def opened(browser: Any, lab: FilledLab, *, tries: int) -> Iterator[Times]:
    """Each page several times, each time by a browser that has kept nothing; the first time is the server's first."""
    for each in openings(lab):
        found = [_once(browser, lab, each, attempt) for attempt in range(tries)]
        for i, words in enumerate(each.shown):
            yield Times(words, tuple(row[i] for row in found))


def _once(browser: Any, lab: FilledLab, opening: Opening, attempt: int) -> list[float]:
    """Seconds until each thing is shown. ``performance.now()`` counts from the beginning of the navigation."""
    opening.before(attempt)
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    page = context.new_page()
    page.goto(lab.address + opening.addresses[attempt % len(opening.addresses)], wait_until="commit")
    # looked at before every picture that is drawn
    waits = (f"() => ({shown}) && performance.now()" for shown in opening.shown.values())
    found = [float(page.wait_for_function(wait, timeout=PATIENCE_MS).json_value()) / 1e3 for wait in waits]
    context.close()
    return found
