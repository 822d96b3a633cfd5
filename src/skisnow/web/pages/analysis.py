"""A campaign analysed: the nine laws, regressions, figures, and the choice of what takes part."""

from __future__ import annotations

import io
import secrets
from base64 import b64encode
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

from nicegui import app, run, ui
from starlette.responses import FileResponse, Response

from ...field.store import Journals, grown, write_campaign
from ...report.numerals import counted
from ..analysing import Choice, Numbers, Refusal, choosable_marks, figures, numbers_of, write_whole_report
from ..fields import link
from ..layout import framed, heading, sentence
from ..names import entering, export, required_id
from ..trouble import plain_page
from ..unpacking import files_below, write_zip
from ..worker import Worker

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterator
    from typing import TypeAlias

    from nicegui.events import ValueChangeEventArguments

    from ..settings import Lab

    Chooser: TypeAlias = Callable[[ValueChangeEventArguments[bool | None]], Awaitable[None]]

HERE: Final = "/"
LONG_TABLES: Final = {
    "penetration_experiments": "Every penetration experiment",
    "shear_experiments": "Every shear experiment",
}
MOST_LISTED: Final = 400
REPORT_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"


@dataclass(slots=True)
class Analysed:
    """One open page: the folder of its campaign, what was chosen last, what came of it."""

    folder: TemporaryDirectory[str]
    choice: Choice = field(default_factory=Choice)
    numbers: Numbers | None = None
    closed: bool = False

    @property
    def campaign(self) -> Path:
        """The campaign's folder."""
        return Path(self.folder.name) / "campaign"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""
    worker, open_pages = Worker(), dict[str, Analysed]()
    app.on_shutdown(worker.end)

    @ui.page("/analysis/{kind}/{id_}")
    async def analysis(kind: str, id_: str) -> None:
        page = Analysed(TemporaryDirectory(prefix="skisnow-analysis-", ignore_cleanup_errors=True))
        key = secrets.token_hex(8)
        open_pages[key] = page

        def closed() -> None:
            open_pages.pop(key, None)
            page.closed = True
            page.folder.cleanup()

        ui.context.client.on_delete(closed)
        await run.io_bound(_fetch, lab, kind, required_id(id_), page.campaign)
        with framed("Analysis", here=HERE):
            _links(kind, id_, key)
            view = _View(page, worker)
        await ui.context.client.connected()
        await view.compute()

    @app.get("/report/{key}/report.html")
    async def report(key: str) -> Response:
        if (folder := await _report(open_pages.get(key), worker)) is None:
            return plain_page("No such report", "Open the analysis of the campaign again.", 404)
        return FileResponse(folder / "report.html", headers={"content-security-policy": REPORT_POLICY})

    @app.get("/report/{key}/analysis.zip")
    async def everything(key: str) -> Response:
        page = open_pages.get(key)
        if (folder := await _report(page, worker)) is None or page is None:
            return plain_page("No such report", "Open the analysis of the campaign again.", 404)
        packed = io.BytesIO()
        both = [*files_below(page.campaign, under="campaign"), *files_below(folder, under="analysis")]
        write_zip(both, packed)
        headers = {"content-disposition": 'attachment; filename="analysis.zip"'}
        return Response(packed.getvalue(), media_type="application/zip", headers=headers)


def _fetch(lab: Lab, kind: str, id_: str, folder: Path) -> None:
    if kind == "kept":
        lab.store.export(id_, folder)
        return
    entries = Journals(lab.store).entries(id_)
    folder.mkdir()
    write_campaign(grown(entries), folder)


async def _report(page: Analysed | None, worker: Worker) -> Path | None:
    if page is None or page.numbers is None:
        return None
    out = Path(page.folder.name) / "report"
    await worker.do(write_whole_report, str(page.campaign), page.choice, page.numbers.results, str(out))
    return out


def _links(kind: str, id_: str, key: str) -> None:
    with ui.element("div").classes("acts"):
        if kind == "entry":
            link("Enter tests", entering(id_))
        link("Open the report", f"/report/{key}/report.html").props("target=_blank")
        link("Download everything", f"/report/{key}/analysis.zip")
        link("Export the campaign", export(kind, id_))


class _View:
    """Tables and figures that follow the choice."""

    def __init__(self, page: Analysed, worker: Worker) -> None:
        self._page = page
        self._worker = worker
        self._asked = 0
        self._status = ui.label("Computing …").classes("status").props("role=status aria-live=polite")
        self._choices = ui.element("section").props('aria-label="What takes part"')
        self._tables = ui.element("section").props('aria-label="Tables"')
        self._figures = ui.element("section").props('aria-label="Figures"')

    async def compute(self) -> None:
        """Compute the numbers, then draw; an older question's answer is dropped."""
        self._asked += 1
        asked, page = self._asked, self._page
        found = await run.io_bound(numbers_of, str(page.campaign), page.choice)
        if asked != self._asked or page.closed or found is None:
            return
        if isinstance(found, Refusal):
            self._status.set_text(f"This campaign cannot be analysed yet. {found.said}")
            return
        first, page.numbers = page.numbers is None, found
        if first:
            self._show_choices(found)
        self._show_tables(found)
        self._status.set_text(f"{_counts(found)} Drawing the figures …")
        drawn = await self._worker.do(figures, str(page.campaign), page.choice, found.results)
        if asked != self._asked or page.closed:
            return
        self._figures.clear()
        with self._figures:
            heading("Figures")
            for shown in drawn:
                _figure(shown.alt, shown.caption, shown.svg)
        self._status.set_text(_counts(found))

    def _show_tables(self, found: Numbers) -> None:
        self._tables.clear()
        with self._tables:
            heading(found.results["campaign"]["name"])
            if (selected := found.results["penetration"]["selected"]) is not None:
                sentence(f"Law: {selected['id']}. {selected['reason']}")
            for name, html in found.tables.items():
                with _behind(LONG_TABLES[name]) if name in LONG_TABLES else nullcontext():
                    ui.html(html, sanitize=False)  # the report's own table, in which all that users wrote is escaped

    def _show_choices(self, found: Numbers) -> None:
        with self._choices:
            heading("What takes part")
            with _behind("Leave out experiments with these marks"):
                for code, words in choosable_marks().items():
                    ui.checkbox(words, value=code in found.excluding, on_change=self._mark_chooser(code))
            with _behind("Experiments that take part"):
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
        box = ui.checkbox(words, value=not cancelled, on_change=self._test_chooser((file, str(row["experiment"]))))
        if cancelled:
            box.disable()

    def _mark_chooser(self, code: str) -> Chooser:
        async def chosen(event: ValueChangeEventArguments[bool | None]) -> None:
            now = self._page.choice.excluding
            if now is None:
                assert self._page.numbers is not None
                now = self._page.numbers.excluding
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


@contextmanager
def _behind(words: str) -> Iterator[None]:
    """Let what is long be opened by who wants it."""
    with ui.element("details"):
        with ui.element("summary"):
            ui.label(words)
        yield


def _counts(found: Numbers) -> str:
    pressed, sheared = (found.results[kind]["experiments"] for kind in ("penetration", "shear"))
    used = [sum(row["used"] for row in rows) for rows in (pressed, sheared)]
    return (
        f"{counted(len(pressed), 'penetration experiment')}, {used[0]} used; "
        f"{counted(len(sheared), 'shear experiment')}, {used[1]} used."
    )


def _figure(alt: str, caption: str, svg: str) -> None:
    data = b64encode(svg.encode()).decode("ascii")
    with ui.element("figure"):
        image = ui.element("img")
        image.props["src"] = f"data:image/svg+xml;base64,{data}"
        image.props["alt"] = alt
        with ui.element("figcaption"):
            ui.html(caption, sanitize=False)  # the report's own words, in which all that users wrote is escaped
