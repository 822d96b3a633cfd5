"""Tables and figures of an analysis as a page shows them, and the choice of what takes part."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from nicegui import ui

from ..campaign.reading.campaign_file import TOP_KEYS
from ..campaign.reading.table_forms import TABLES
from ..report.formatting import counted
from .campaign_analysis import Choice, Numbers, Refusal, choosable_flags
from .elements import Words, html_words, named
from .error_pages import error_sentence
from .language import language_of, said, said_as_written
from .layout import heading, sentence

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Sequence, Set
    from typing import TypeAlias

    from nicegui.events import ValueChangeEventArguments

    from .analysis_cache import Analysed, Analyses, CampaignSource
    from .campaign_analysis import Shown

    Chooser: TypeAlias = Callable[[ValueChangeEventArguments[bool | None]], Awaitable[None]]

LONG_TABLES: Final = {
    "penetration_experiments": "Every penetration experiment",
    "shear_experiments": "Every shear experiment",
}
FIRST_TABLE: Final = "sites"
MOST_LISTED: Final = 400
NAMES_IN_FILES: Final = frozenset(TOP_KEYS).union(*(form.known for form in TABLES))
"""Columns and keys, which are the same in every language."""


class OpenAnalysis:
    """One open page: which campaign, as it was when the page was opened, what was chosen last, what came of it."""

    def __init__(self, kind: str, id_: str, subject: CampaignSource | None) -> None:
        self.kind = kind
        self.id = id_
        self.subject = subject
        self.choice = Choice()
        self.analysed: Analysed | None = None
        self.refused = ""
        self.closed = False
        self.settled = asyncio.Event()
        """Set while `analysed`, or why there is nothing, belongs to the choice."""


class AnalysisView:
    """Tables and figures that follow the choice."""

    def __init__(self, page: OpenAnalysis, analyses: Analyses) -> None:
        self._page = page
        self._analyses = analyses
        self._asked = 0
        self._status = Words("Computing …").classes("status").props("role=status aria-live=polite")
        self._results = named(ui.element("section"), "Key results")
        self._choices = named(ui.element("section"), "Included data")
        self._tables = named(ui.element("section"), "Tables")
        self._figures = named(ui.element("section"), "Figures")

    def show_known(self) -> None:
        """Show at once what was computed before."""
        subject = self._page.subject
        known = subject.known(self._page.choice) if subject is not None else None
        if known is not None:
            self._show(known)

    async def compute(self) -> None:
        """Compute the numbers, then draw figure by figure; an older question's answer is dropped."""
        self._asked += 1
        asked, page = self._asked, self._page
        page.settled.clear()
        try:
            page.subject = page.subject or await self._analyses.subject(page.kind, page.id)
            found = await page.subject.analysed(page.choice)
            if self._is_old(asked):
                return
            if isinstance(found, Refusal):
                self._refuse(found)
                return
            if found is not page.analysed:
                self._show(found)
            page.settled.set()
            await self._draw(found, asked)
        except Exception as error:
            if not self._is_old(asked):
                page.refused = error_sentence(error)
                page.settled.set()
                self._status.set_text(page.refused)

    def _is_old(self, asked: int) -> bool:
        return asked != self._asked or self._page.closed

    def _refuse(self, refusal: Refusal) -> None:
        """Say why there is nothing; what was shown before belongs to another choice."""
        self._page.analysed = None
        self._page.refused = f"This campaign cannot be analysed yet. {refusal.said}"
        self._page.settled.set()
        self._results.clear()
        self._tables.clear()
        self._figures.clear()
        if not refusal.errors:
            self._status.set_text(self._page.refused)
            return
        self._status.set_text("This campaign cannot be analysed yet. What is wrong in its files:")
        with self._results:
            _list_of_errors(refusal.errors)
            if self._page.kind == "kept":
                sentence("Put the files right and import them again. Single cells can be put right under Correct.")

    def _show(self, found: Analysed) -> None:
        first, self._page.analysed = not self._choices.default_slot.children, found
        if first:
            self._show_choices(found.numbers)
        self._show_results(found.numbers)
        self._show_tables(found.numbers)
        self._status.set_text(f"{_counts(found.numbers)} Drawing the figures …")

    async def _draw(self, found: Analysed, asked: int) -> None:
        """Show each figure as it comes; those of another choice stay until then."""
        begun = False
        async for shown in self._analyses.figures(found, language_of(self._figures.client)):
            if self._is_old(asked):
                return
            if not begun:
                self._figures.clear()
                with self._figures:
                    heading("Figures")
                begun = True
            with self._figures:
                _figure(shown, found.numbers.names)
        if not self._is_old(asked):
            self._status.set_text(_counts(found.numbers))

    def _show_results(self, found: Numbers) -> None:
        """H_V and S_f first: the report's own sentences, and below them each site's."""
        self._results.clear()
        with self._results:
            heading(found.results["campaign"]["name"])
            with ui.element("ul").classes("results"):
                for words in found.key_results:
                    with ui.element("li"):
                        html_words(words, found.names)
            for warning in found.results["penetration"]["warnings"]:
                sentence(warning, "quiet")
            if FIRST_TABLE in found.tables:
                _table(found.tables[FIRST_TABLE], found.names)

    def _show_tables(self, found: Numbers) -> None:
        self._tables.clear()
        with self._tables:
            for name, html in found.tables.items():
                if name == FIRST_TABLE:
                    continue
                if name in LONG_TABLES:
                    _behind(LONG_TABLES[name], partial(_table, html, found.names))
                else:
                    _table(html, found.names)

    def _show_choices(self, found: Numbers) -> None:
        with self._choices:
            heading("Included data")
            _behind("Exclude experiments with these quality flags", lambda: self._list_marks(found))
            _behind("Included experiments", lambda: self._list_experiments(found))

    def _list_marks(self, found: Numbers) -> None:
        for code, words in choosable_flags().items():
            ui.checkbox(said(words), value=code in found.excluding, on_change=self._mark_chooser(code, found.excluding))

    def _list_experiments(self, found: Numbers) -> None:
        for file, kind in (("penetration.csv", "penetration"), ("shear.csv", "shear")):
            rows = found.results[kind]["experiments"]
            for row in rows[:MOST_LISTED]:
                self._experiment(file, kind, row)
            if len(rows) > MOST_LISTED:
                sentence(f"The first {MOST_LISTED} of {len(rows)} {kind} experiments.", "quiet")

    def _experiment(self, file: str, kind: str, row: dict[str, Any]) -> None:
        cancelled = "cancelled" in row["flags"]
        words = f"{kind.capitalize()} {row['experiment']}, {row['site']}, {row['edge_angle_deg']:g}°"
        words += " (cancelled)" if cancelled else ""
        chosen = self._test_chooser((file, str(row["experiment"])))
        box = ui.checkbox(said(words), value=not cancelled, on_change=chosen)
        if cancelled:
            box.disable()

    def _mark_chooser(self, code: str, of_campaign: frozenset[str]) -> Chooser:
        async def chosen(event: ValueChangeEventArguments[bool | None]) -> None:
            chosen_before = self._page.choice.excluding
            now = of_campaign if chosen_before is None else chosen_before
            await self._choose(replace(self._page.choice, excluding=now | {code} if event.value else now - {code}))

        return chosen

    def _test_chooser(self, test: tuple[str, str]) -> Chooser:
        async def chosen(event: ValueChangeEventArguments[bool | None]) -> None:
            out = self._page.choice.left_out
            await self._choose(replace(self._page.choice, left_out=out - {test} if event.value else out | {test}))

        return chosen

    async def _choose(self, choice: Choice) -> None:
        self._page.choice = choice
        self._status.set_text("Computing …")
        await self.compute()


def _list_of_errors(lines: Sequence[str]) -> None:
    """With headings and cells to be copied as they are written."""
    with ui.element("ul").classes("errors"):
        for line in lines:
            with ui.element("li"):
                ui.label(said_as_written(line, NAMES_IN_FILES))


def _behind(words: str, fill: Callable[[], None]) -> None:
    """Let what is long be opened by who wants it; until then it costs nothing."""
    with ui.element("details") as details, ui.element("summary"):
        Words(words)

    def opened() -> None:
        if len(details.default_slot.children) == 1:
            with details:
                fill()

    details.on("toggle", opened)


def _table(html: str, names: Set[str]) -> None:
    html_words(html, names)


def _counts(found: Numbers) -> str:
    pressed, sheared = (found.results[kind]["experiments"] for kind in ("penetration", "shear"))
    used = [sum(row["used"] for row in rows) for rows in (pressed, sheared)]
    return (
        f"{counted(len(pressed), 'penetration experiment')}, {used[0]} used; "
        f"{counted(len(sheared), 'shear experiment')}, {used[1]} used."
    )


def _figure(shown: Shown, names: Set[str]) -> None:
    with ui.element("figure"):
        with ui.element("div") as box:
            image = ui.element("img")
        if shown.wide:
            box.classes("scroll").props("tabindex=0 role=region").props["aria-label"] = said(shown.alt)
        image.props["src"] = shown.image
        image.props["alt"] = said(shown.alt)
        with ui.element("figcaption"):
            html_words(shown.caption, names)
