"""Tables and figures of an analysis on a page, and the choice of included data."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Final

from nicegui import ui
from nicegui.events import ValueChangeEventArguments

from .._support.messages import Message, in_language, template
from ..report.campaign.data import ReportData
from .campaign_analysis import (
    AnalysisCache,
    CampaignSource,
    Choice,
    FigureImage,
    Numbers,
    Refusal,
    choosable_flags,
)
from .elements import Words, add_items, choice, error_sentence, folded, heading, html_words, named, sentence
from .words import language_of, said

LONG_TABLES: Final = {
    "penetration_experiments": Message("Every penetration experiment"),
    "shear_experiments": Message("Every shear experiment"),
}
FIRST_TABLE: Final = "sites"
MOST_LISTED: Final = 400
_FIRST_ONLY: Final = {
    "penetration": template("The first {most} of {all} penetration experiments."),
    "shear": template("The first {most} of {all} shear experiments."),
}
_EXPERIMENT: Final = {
    ("penetration", False): template("Penetration {name}, {site}, {angle:g}°"),
    ("penetration", True): template("Penetration {name}, {site}, {angle:g}° (cancelled)"),
    ("shear", False): template("Shear {name}, {site}, {angle:g}°"),
    ("shear", True): template("Shear {name}, {site}, {angle:g}° (cancelled)"),
}
"""Texts of an experiment by its kind, and whether it is cancelled."""


@dataclass(eq=False)
class OpenAnalysis:
    """State of an open page: campaign, its state when the page was opened, last choice and its result."""

    kind: str
    id: str
    subject: CampaignSource | None
    choice: Choice = field(default_factory=Choice)
    analysed: Numbers | None = None
    refused: str = ""
    closed: bool = False
    settled: asyncio.Event = field(default_factory=asyncio.Event)
    """Set while the result, or the reason of its absence, belongs to the choice."""


DIFFERENCES: Final = (0.05, 0.1, 0.2, 0.3, 0.5, 1.0)  # differences that the user can choose from


class AnalysisView:
    """Tables and figures that follow the choice."""

    def __init__(self, page: OpenAnalysis, analyses: AnalysisCache) -> None:
        self._page = page
        self._analyses = analyses
        self._asked = 0
        self._status = Words(Message("Computing …")).classes("status").props("role=status aria-live=polite")
        self._results = named(ui.element("section"), Message("Key results"))
        self._choices = named(ui.element("section"), Message("Included data"))
        self._tables = named(ui.element("section"), Message("Tables"))
        self._figures = named(ui.element("section"), Message("Figures"))

    def show_cached(self) -> None:
        """Show a cached analysis at once."""
        subject = self._page.subject
        result = subject.cached(self._page.choice) if subject is not None else None
        if result is not None:
            self._show_result(result)

    async def compute(self) -> None:
        """Compute the numbers, then draw figure by figure; results for an older choice are dropped."""
        self._asked += 1
        number, page = self._asked, self._page
        page.settled.clear()
        try:
            page.subject = page.subject or await self._analyses.subject(page.kind, page.id)
            result = await page.subject.analysed(page.choice)
            if self._is_old(number):
                return
            if isinstance(result, Refusal):
                self._refuse(result)
                return
            if result is not page.analysed:
                self._show_result(result)
            page.settled.set()
            await self._draw(result, number)
        except Exception as error:
            if not self._is_old(number):
                page.refused = error_sentence(error)
                page.settled.set()
                self._status.set_text(page.refused)

    def _is_old(self, number: int) -> bool:
        return number != self._asked or self._page.closed

    def _refuse(self, refusal: Refusal) -> None:
        """Show why there is no analysis instead of the results of another choice."""
        self._page.analysed = None
        self._page.refused = Message("This campaign cannot be analysed yet. {said}", said=refusal.said)
        self._page.settled.set()
        self._results.clear()
        self._tables.clear()
        self._figures.clear()
        if not refusal.errors:
            self._status.set_text(self._page.refused)
            return
        self._status.set_text(Message("This campaign cannot be analysed yet. Errors in its files:"))
        with self._results:
            with ui.element("ul").classes("errors"):  # with headings and cells as they are in the files
                add_items(refusal.errors, lambda line: ui.label(said(line)))
            if self._page.kind == "kept":
                sentence(
                    Message("Correct the files and import them again. Single cells can be corrected under Correct.")
                )

    def _show_result(self, result: Numbers) -> None:
        first, self._page.analysed = not self._choices.default_slot.children, result
        if first and ReportData(result.analysis).has_tests:
            self._show_choices(result)
        self._show_results(result)
        self._show_tables(result)
        self._status.set_text(Message("{counts}. Drawing the figures …", counts=self._counts_text(result)))

    def _counts_text(self, numbers: Numbers) -> str:
        with in_language(language_of(self._figures.client)):  # tasks in the background have no page
            return ReportData(numbers.analysis).counts

    async def _draw(self, result: Numbers, number: int) -> None:
        """Show each figure when it is drawn; those of another choice stay until the first one."""
        begun = False
        async for shown in self._analyses.figures(result, language_of(self._figures.client)):
            if self._is_old(number):
                return
            if not begun:
                self._figures.clear()
                with self._figures:
                    heading(Message("Figures"))
                begun = True
            with self._figures:
                _add_figure(shown)
        if not self._is_old(number):
            self._status.set_text(f"{self._counts_text(result)}.")

    def _show_results(self, numbers: Numbers) -> None:
        """Show the key results of the report, then the table of the sites."""
        self._results.clear()
        with self._results:
            heading(numbers.analysis.results["campaign"]["name"])
            with ui.element("ul").classes("results"):
                add_items(numbers.verdicts, sentence)
                add_items(numbers.key_results[language_of()], html_words)
            for warning in numbers.analysis.results["penetration"]["warnings"]:
                sentence(warning, "quiet")
            tables = numbers.tables[language_of()]
            if FIRST_TABLE in tables:
                html_words(tables[FIRST_TABLE])

    def _show_tables(self, numbers: Numbers) -> None:
        self._tables.clear()
        with self._tables:
            for name, html in numbers.tables[language_of()].items():
                if name == FIRST_TABLE:
                    continue
                if name in LONG_TABLES:
                    _add_folded(LONG_TABLES[name], partial(html_words, html))
                else:
                    html_words(html)

    def _show_choices(self, numbers: Numbers) -> None:
        with self._choices:
            heading(Message("Included data"))
            options = {str(share): f"{100.0 * share:.0f} %" for share in DIFFERENCES}
            made = choice(Message("Difference that tests are to show"), options, str(self._page.choice.difference))
            made.on_value_change(
                lambda event: self._choose(replace(self._page.choice, difference=float(str(event.value))))
            )
            sentence(
                Message("Number of tests: two-sided t test at 5 %, power 80 %, with the pooled scatter of the groups."),
                "quiet",
            )
            _add_folded(Message("Exclude experiments with these quality flags"), lambda: self._list_marks(numbers))
            _add_folded(Message("Included experiments"), lambda: self._list_experiments(numbers))

    def _list_marks(self, numbers: Numbers) -> None:
        before = numbers.analysis.campaign.excluding
        for code, words in choosable_flags().items():
            ui.checkbox(said(words), value=code in before, on_change=partial(self._choose_flag, code, before))

    def _list_experiments(self, numbers: Numbers) -> None:
        for file, kind in (("penetration.csv", "penetration"), ("shear.csv", "shear")):
            rows = numbers.analysis.results[kind]["experiments"]
            for row in rows[:MOST_LISTED]:
                self._add_experiment_box(file, kind, row)
            if len(rows) > MOST_LISTED:
                sentence(Message(_FIRST_ONLY[kind], most=MOST_LISTED, all=len(rows)), "quiet")

    def _add_experiment_box(self, file: str, kind: str, row: dict[str, Any]) -> None:
        cancelled = "cancelled" in row["flags"]
        words = Message(
            _EXPERIMENT[kind, cancelled], name=row["experiment"], site=row["site"], angle=row["edge_angle_deg"]
        )
        chosen = partial(self._choose_test, (file, str(row["experiment"])))
        box = ui.checkbox(said(words), value=not cancelled, on_change=chosen)
        if cancelled:
            box.disable()

    async def _choose_flag(
        self, code: str, of_campaign: frozenset[str], event: ValueChangeEventArguments[bool | None]
    ) -> None:
        before = self._page.choice.excluding
        excluding = of_campaign if before is None else before
        excluding = excluding | {code} if event.value else excluding - {code}
        await self._choose(replace(self._page.choice, excluding=excluding))

    async def _choose_test(self, test: tuple[str, str], event: ValueChangeEventArguments[bool | None]) -> None:
        out = self._page.choice.left_out
        await self._choose(replace(self._page.choice, left_out=out - {test} if event.value else out | {test}))

    async def _choose(self, choice: Choice) -> None:
        self._page.choice = choice
        self._status.set_text(Message("Computing …"))
        await self.compute()


def _add_folded(words: str, fill: Callable[[], object]) -> None:
    """Add a folded section that is filled when it is opened."""
    details = folded(words)

    def opened() -> None:
        if len(details.default_slot.children) == 1:
            with details:
                fill()

    details.on("toggle", opened)


def _add_figure(shown: FigureImage) -> None:
    with ui.element("figure"):
        with ui.element("div") as box:
            image = ui.element("img")
        if shown.wide:
            box.classes("scroll").props("tabindex=0 role=region").props["aria-label"] = shown.alt
        image.props["src"] = shown.image
        image.props["alt"] = shown.alt
        with ui.element("figcaption"):
            html_words(shown.caption)
