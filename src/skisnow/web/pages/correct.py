"""The page on which a kept campaign is corrected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import run, ui

from ...errors import ParameterError
from ..entry.frame import sheet_of, table_links
from ..entry.kept import KeptForm, list_tests
from ..fields import link
from ..kept_desk import KeptDesk
from ..layout import framed, sentence
from ..names import analysis, correcting, export, required_id
from ..patience import BUILD_S

if TYPE_CHECKING:
    from ..settings import Lab

HERE = "/"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/correct/{id_}", response_timeout=BUILD_S)
    async def correct(id_: str, table: str = "", test: str = "") -> None:
        desk = await run.io_bound(KeptDesk, lab, required_id(id_))
        if desk is None:  # the lab is being closed
            return
        file = table or next(iter(desk.tables), "")
        if file not in desk.tables:
            raise ParameterError("this campaign has no such table")
        with framed(desk.stored.name or "Campaign", here=HERE, keeps=True):
            sentence("Kept: its files stay as they came in. What is corrected here stands beside them.", "quiet")
            further = {"Analysis": analysis("kept", desk.id), "Export": export("kept", desk.id)}
            table_links({each: correcting(desk.id, table=each) for each in desk.tables}, file, further)
            if test in desk.tables[file].tests:
                _test(desk, file, test)
            else:
                list_tests(desk, file)


def _test(desk: KeptDesk, file: str, name: str) -> None:
    with (
        sheet_of(desk, file, form="Cells", below="Changes") as (sheet, beside, places),
        ui.element("div").classes("acts"),
    ):
        link("Another test", correcting(desk.id, table=file))
    KeptForm(desk, sheet, beside, places).show(name)
