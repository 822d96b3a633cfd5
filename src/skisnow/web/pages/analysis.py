"""Page of an analysed campaign: laws, regressions, figures, and the choice of included data."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from nicegui import app, background_tasks, ui
from nicegui.events import ValueChangeEventArguments
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from ..._support.messages import Message, in_language, template
from ...report.campaign.data import ReportData
from ..campaign_analysis import (
    AnalysisCache,
    CampaignSource,
    Choice,
    FigureImage,
    Numbers,
    Refusal,
    choosable_flags,
    load_drawing,
    write_whole_report,
)
from ..elements import (
    Words,
    add_items,
    choice,
    error_sentence,
    folded,
    heading,
    html_words,
    link,
    named,
    page_frame,
    plain_page,
    sentence,
)
from ..page_requests import entry_address, export, required_id
from ..settings import Lab
from ..uploads import Worker, zip_download, zip_of_campaign
from ..words import language_of, language_of_request, said

HERE: Final = "/"
REPORT_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"


def add_page(lab: Lab) -> None:
    """Add the pages that analyse a campaign, and the addresses of their reports."""
    worker, open_pages = Worker(), dict[str, AnalysisView]()
    analyses = AnalysisCache(lab, worker)
    app.on_shutdown(worker.end)

    @ui.page("/analysis/{kind}/{id_}")
    def analysis(kind: str, id_: str) -> None:
        subject = analyses.cached(kind, required_id(id_))
        background_tasks.create(worker.do(load_drawing), name="worker begins")  # while the numbers are computed
        key = secrets.token_hex(8)
        with page_frame(Message("Analysis"), here=HERE):
            _add_links(kind, id_, key)
            open_pages[key] = view = AnalysisView(analyses, kind, id_, subject)

        def closed() -> None:
            open_pages.pop(key, None)
            view.closed = True
            view.settled.set()

        ui.context.client.on_delete(closed)
        background_tasks.create(view.compute(), name="analysis")

    @app.get("/report/{key}/report.html")
    async def report(request: Request, key: str) -> Response:
        page = open_pages.get(key)
        if (folder := await _report(page, worker, request)) is None:
            return _no_report(page, request)
        return FileResponse(folder / "report.html", headers={"content-security-policy": REPORT_POLICY})

    @app.get("/report/{key}/analysis.zip")
    async def everything(request: Request, key: str) -> Response:
        page = open_pages.get(key)
        if page is None or (folder := await _report(page, worker, request)) is None or page.subject is None:
            return _no_report(page, request)
        content = await run_in_threadpool(zip_of_campaign, page.subject.write_campaign, report=folder)
        return zip_download(content, "analysis.zip")


def _no_report(page: AnalysisView | None, request: Request) -> Response:
    """Response 404: the analysis was rejected, with its reason, or is not open."""
    if page is not None and page.refused:
        return plain_page(Message("No report yet"), page.refused, 404, request)
    return plain_page(Message("No such report"), Message("Open the analysis of the campaign again."), 404, request)


async def _report(page: AnalysisView | None, worker: Worker, request: Request) -> Path | None:
    """Folder with the report for a page's choice and language, written if missing; None without an analysis."""
    if page is not None:
        await page.settled.wait()
    if page is None or page.subject is None or page.analysed is None:
        return None
    language, numbers = language_of_request(request), page.analysed
    out = page.subject.place / f"report-{numbers.key}-{language}"
    if not (out / "results.json").is_file():  # written last
        await worker.do(write_whole_report, numbers.analysis, str(out), language)
    return out


def _add_links(kind: str, id_: str, key: str) -> None:
    """Add the links of an analysis: entry, report, everything as a zip, and export."""
    with ui.element("div").classes("acts"):
        if kind == "entry":
            link(Message("Enter tests"), entry_address(id_))
        # both are requested over the connection of the page, so that earlier choices are applied first
        report = link(Message("Open the report"), f"/report/{key}/report.html").props("target=_blank")
        report.on("click.prevent", lambda: ui.navigate.to(f"/report/{key}/report.html", new_tab=True))
        everything = link(Message("Download everything"), "#")
        everything.on("click.prevent", lambda: ui.download(f"/report/{key}/analysis.zip"))
        link(Message("Export the campaign"), export(kind, id_))


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


DIFFERENCES: Final = (0.05, 0.1, 0.2, 0.3, 0.5, 1.0)  # differences that the user can choose from


class AnalysisView:
    """Tables and figures on an open page, which are computed again after each change of the choice.

    kind, id, subject: campaign, and its state when the page was opened if it is cached.
    analysed, refused: result of the last choice, or the reason why there is none.
    settled: event that is set while these belong to the current choice.
    """

    def __init__(self, analyses: AnalysisCache, kind: str, id_: str, subject: CampaignSource | None) -> None:
        self.kind, self.id, self.subject = kind, id_, subject
        self.analysed: Numbers | None = None
        self.refused = ""
        self.closed = False
        self.settled = asyncio.Event()
        self._choice = Choice()
        self._analyses = analyses
        self._asked = 0
        self._status = Words(Message("Computing …")).classes("status").props("role=status aria-live=polite")
        self._results = named(ui.element("section"), Message("Key results"))
        self._choices = named(ui.element("section"), Message("Included data"))
        self._tables = named(ui.element("section"), Message("Tables"))
        self._figures = named(ui.element("section"), Message("Figures"))
        if subject is not None and (cached := subject.cached(self._choice)) is not None:
            self._show_result(cached)

    async def compute(self) -> None:
        """Compute the numbers, then draw figure by figure; results for an older choice are dropped."""
        self._asked += 1
        number = self._asked
        self.settled.clear()
        try:
            self.subject = self.subject or await self._analyses.subject(self.kind, self.id)
            result = await self.subject.analysed(self._choice)
            if self._is_old(number):
                return
            if isinstance(result, Refusal):
                self._refuse(result)
                return
            if result is not self.analysed:
                self._show_result(result)
            self.settled.set()
            await self._draw(result, number)
        except Exception as error:
            if not self._is_old(number):
                self.refused = error_sentence(error)
                self.settled.set()
                self._status.set_text(self.refused)

    def _is_old(self, number: int) -> bool:
        """True if a newer computation was requested, or the page was closed."""
        return number != self._asked or self.closed

    def _refuse(self, refusal: Refusal) -> None:
        """Show why there is no analysis instead of the results of another choice."""
        self.analysed = None
        self.refused = Message("This campaign cannot be analysed yet. {said}", said=refusal.said)
        self.settled.set()
        self._results.clear()
        self._tables.clear()
        self._figures.clear()
        if not refusal.errors:
            self._status.set_text(self.refused)
            return
        self._status.set_text(Message("This campaign cannot be analysed yet. Errors in its files:"))
        with self._results:
            with ui.element("ul").classes("errors"):  # with headings and cells as they are in the files
                add_items(refusal.errors, lambda line: ui.label(said(line)))
            if self.kind == "kept":
                sentence(
                    Message("Correct the files and import them again. Single cells can be corrected under Correct.")
                )

    def _show_result(self, result: Numbers) -> None:
        """Show the results and tables of an analysis, and the choices at the first time."""
        first, self.analysed = not self._choices.default_slot.children, result
        if first and ReportData(result.analysis).has_tests:
            self._show_choices(result)
        self._show_results(result)
        self._show_tables(result)
        self._status.set_text(Message("{counts}. Drawing the figures …", counts=self._counts_text(result)))

    def _counts_text(self, numbers: Numbers) -> str:
        """Text with the counts of experiments, in the language of the page."""
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
        """Show the tables in the language of the page, the long ones folded."""
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
        """Show the choices of difference, flags and experiments."""
        with self._choices:
            heading(Message("Included data"))
            options = {str(share): f"{100.0 * share:.0f} %" for share in DIFFERENCES}
            made = choice(Message("Difference that tests are to show"), options, str(self._choice.difference))
            made.on_value_change(lambda event: self._choose(replace(self._choice, difference=float(str(event.value)))))
            sentence(
                Message("Number of tests: two-sided t test at 5 %, power 80 %, with the pooled scatter of the groups."),
                "quiet",
            )
            _add_folded(Message("Exclude experiments with these quality flags"), lambda: self._list_marks(numbers))
            _add_folded(Message("Included experiments"), lambda: self._list_experiments(numbers))

    def _list_marks(self, numbers: Numbers) -> None:
        """List a checkbox for each quality flag that can be excluded."""
        before = numbers.analysis.campaign.excluding
        for code, words in choosable_flags().items():
            ui.checkbox(said(words), value=code in before, on_change=partial(self._choose_flag, code, before))

    def _list_experiments(self, numbers: Numbers) -> None:
        """List a checkbox for each experiment, up to a maximum number per kind."""
        for file, kind in (("penetration.csv", "penetration"), ("shear.csv", "shear")):
            rows = numbers.analysis.results[kind]["experiments"]
            for row in rows[:MOST_LISTED]:
                self._add_experiment_box(file, kind, row)
            if len(rows) > MOST_LISTED:
                sentence(Message(_FIRST_ONLY[kind], most=MOST_LISTED, all=len(rows)), "quiet")

    def _add_experiment_box(self, file: str, kind: str, row: dict[str, Any]) -> None:
        """Add the checkbox of an experiment; it is disabled if the experiment was cancelled."""
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
        """Exclude or include experiments with a flag, and compute again."""
        before = self._choice.excluding
        excluding = of_campaign if before is None else before
        excluding = excluding | {code} if event.value else excluding - {code}
        await self._choose(replace(self._choice, excluding=excluding))

    async def _choose_test(self, test: tuple[str, str], event: ValueChangeEventArguments[bool | None]) -> None:
        """Include or leave out one experiment, and compute again."""
        out = self._choice.left_out
        await self._choose(replace(self._choice, left_out=out - {test} if event.value else out | {test}))

    async def _choose(self, choice: Choice) -> None:
        """Compute again with a choice."""
        self._choice = choice
        self._status.set_text(Message("Computing …"))
        await self.compute()


def _add_folded(words: str, fill: Callable[[], object]) -> None:
    """Add a folded section, which `fill` fills when it is opened for the first time."""
    details = folded(words)

    def opened() -> None:
        if len(details.default_slot.children) == 1:
            with details:
                fill()

    details.on("toggle", opened)


def _add_figure(shown: FigureImage) -> None:
    """Add a figure with caption; a wide one can be scrolled."""
    with ui.element("figure"):
        with ui.element("div") as box:
            image = ui.element("img")
        if shown.wide:
            box.classes("scroll").props("tabindex=0 role=region").props["aria-label"] = shown.alt
        image.props["src"] = shown.image
        image.props["alt"] = shown.alt
        with ui.element("figcaption"):
            html_words(shown.caption)
