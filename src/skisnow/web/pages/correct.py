"""The page on which a kept campaign is corrected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import run, ui

from ...errors import ParameterError
from ..entry.beside import Beside
from ..entry.changes import Places
from ..entry.kept import KeptForm, list_tests
from ..entry.sheet import Sheet
from ..fields import link
from ..kept_desk import KeptDesk
from ..layout import framed, sentence
from ..names import analysis, correcting, export, required_id
from ..words import TABLES
from .enter import who_field

if TYPE_CHECKING:
    from ..settings import Lab

HERE = "/"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/correct/{id_}")
    async def correct(id_: str, table: str = "", test: str = "") -> None:
        desk = await run.io_bound(KeptDesk, lab, required_id(id_))
        if desk is None:  # the lab is being closed
            return
        ui.context.client.on_delete(desk.close)
        file = table or next(iter(desk.tables), "")
        if file not in desk.tables:
            raise ParameterError("this campaign has no such table")
        with framed(desk.stored.name or "Campaign", here=HERE):
            sentence("Kept: its files stay as they came in. What is corrected here stands beside them.", "quiet")
            _tables(desk, file)
            if test in desk.tables[file].tests:
                _test(desk, file, test)
            else:
                list_tests(desk, file)


def _tables(desk: KeptDesk, here: str) -> None:
    with ui.element("nav").classes("tables").props('aria-label="Kind of test"'):
        for file in desk.tables:
            made = ui.link(TABLES[file], correcting(desk.id, table=file))
            if file == here:
                made.props('aria-current="page"')
        ui.link("Analysis", analysis("kept", desk.id))
        ui.link("Export", export("kept", desk.id))


def _test(desk: KeptDesk, file: str, name: str) -> None:
    who = who_field(desk)
    status = ui.label("").classes("status").props("role=status aria-live=polite")
    sheet = Sheet(desk, file, who, status)
    with ui.element("div").classes("two"):
        form = ui.element("section").props('aria-label="Cells"')
        beside = Beside(sheet)
        with ui.element("section").classes("below").props('aria-label="Changes"'):
            places = Places(form, ui.element("div"))
            with ui.element("div").classes("acts"):
                link("Another test", correcting(desk.id, table=file))
    KeptForm(desk, sheet, beside, places).show(name)
