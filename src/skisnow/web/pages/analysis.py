"""Page of an analysed campaign: laws, regressions, figures, and the choice of included data."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import Final

from nicegui import app, background_tasks, ui
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from ..._support.messages import Message
from ..analysis_view import AnalysisView, OpenAnalysis
from ..campaign_analysis import AnalysisCache, load_drawing, write_whole_report
from ..elements import link, page_frame, plain_page
from ..page_requests import entry_address, export, required_id
from ..settings import Lab
from ..uploads import Worker, zip_download, zip_of_campaign
from ..words import language_of_request

HERE: Final = "/"
REPORT_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; frame-ancestors 'none'; sandbox"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""
    worker, open_pages = Worker(), dict[str, OpenAnalysis]()
    analyses = AnalysisCache(lab, worker)
    app.on_shutdown(worker.end)

    @ui.page("/analysis/{kind}/{id_}")
    def analysis(kind: str, id_: str) -> None:
        page = OpenAnalysis(kind, id_, analyses.cached(kind, required_id(id_)))
        background_tasks.create(worker.do(load_drawing), name="worker begins")  # while the numbers are computed
        key = secrets.token_hex(8)
        open_pages[key] = page

        def closed() -> None:
            open_pages.pop(key, None)
            page.closed = True
            page.settled.set()

        ui.context.client.on_delete(closed)
        with page_frame(Message("Analysis"), here=HERE):
            _add_links(kind, id_, key)
            view = AnalysisView(page, analyses)
        view.show_cached()
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


def _no_report(page: OpenAnalysis | None, request: Request) -> Response:
    if page is not None and page.refused:
        return plain_page(Message("No report yet"), page.refused, 404, request)
    return plain_page(Message("No such report"), Message("Open the analysis of the campaign again."), 404, request)


async def _report(page: OpenAnalysis | None, worker: Worker, request: Request) -> Path | None:
    """Folder with the report of a page's choice in its language, written at the first request; None without one."""
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
    with ui.element("div").classes("acts"):
        if kind == "entry":
            link(Message("Enter tests"), entry_address(id_))
        # both are requested over the connection of the page, so that earlier choices are applied first
        report = link(Message("Open the report"), f"/report/{key}/report.html").props("target=_blank")
        report.on("click.prevent", lambda: ui.navigate.to(f"/report/{key}/report.html", new_tab=True))
        everything = link(Message("Download everything"), "#")
        everything.on("click.prevent", lambda: ui.download(f"/report/{key}/analysis.zip"))
        link(Message("Export the campaign"), export(kind, id_))
