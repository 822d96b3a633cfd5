"""The page on which a kept campaign is corrected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import run, ui

from ..._support.errors import ParameterError
from ..edit_session import CorrectionSession
from ..elements import link
from ..entry.imported_test import KeptForm, list_tests
from ..entry.table_frame import table_links, table_view_of
from ..layout import framed, sentence
from ..page_addresses import analysis, correcting, export, required_id
from ..settings import BUILD_S

if TYPE_CHECKING:
    from ..settings import Lab

HERE = "/"
UNREAD = (
    "no table of this campaign can be read; what is wrong in its files stands under Analysis in the list of campaigns"
)


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/correct/{id_}", response_timeout=BUILD_S)
    async def correct(id_: str, table: str = "", test: str = "") -> None:
        session = await run.io_bound(CorrectionSession, lab, required_id(id_))
        if session is None:  # the lab is being closed
            return
        file = table or next(iter(session.tables), "")
        if file not in session.tables:
            raise ParameterError("this campaign has no such table" if session.tables else UNREAD)
        with framed(session.stored.name or "Campaign", here=HERE, keeps=True):
            sentence("Imported: its files stay as they came in. What is corrected here stands beside them.", "quiet")
            further = {"Analysis": analysis("kept", session.id), "Export": export("kept", session.id)}
            table_links({each: correcting(session.id, table=each) for each in session.tables}, file, further)
            if test in session.tables[file].tests:
                _test(session, file, test)
            else:
                list_tests(session, file)


def _test(session: CorrectionSession, file: str, name: str) -> None:
    with (
        table_view_of(session, file, form="Cells", below="Changes") as (view, beside, places),
        ui.element("div").classes("acts"),
    ):
        link("Another test", correcting(session.id, table=file))
    KeptForm(session, view, beside, places).show(name)
