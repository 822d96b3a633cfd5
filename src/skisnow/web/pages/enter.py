"""The page on which tests are entered."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from ...errors import ParameterError
from ..desk import Desk
from ..entry.beside import Beside
from ..entry.changes import Places
from ..entry.series import SeriesForm
from ..entry.sheet import WHO, Sheet
from ..entry.single import SingleForm
from ..fields import choice, field, link
from ..layout import framed, heading
from ..names import analysis, entering, required_id
from ..words import TABLES

if TYPE_CHECKING:
    from ..settings import Lab

HERE = "/"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/enter/{id_}")
    def enter(id_: str, table: str = "penetration.csv", test: str = "") -> None:
        if table not in TABLES:
            raise ParameterError("this address names no table of a campaign")
        desk = Desk(lab, required_id(id_))
        with framed(desk.described.name or "Campaign", here=HERE, ahead=True):
            _tables(id_, table)
            who = who_field(desk)
            status = ui.label("").classes("status").props("role=status aria-live=polite")
            sheet = Sheet(desk, table, who, status)
            with ui.element("div").classes("two"):
                form = ui.element("section").props('aria-label="Entry"')
                beside = Beside(sheet)
                with ui.element("section").classes("below").props('aria-label="Changes, and what was entered"'):
                    places = Places(form, ui.element("div"))
                    _others(sheet, test)
            kind = SeriesForm if table == "penetration.csv" else SingleForm
            entry = kind(sheet, beside, places)
            if test and sheet.test(test).rows:
                entry.show(test)
            else:
                entry.begin()


def _tables(id_: str, here: str) -> None:
    with ui.element("nav").classes("tables").props('aria-label="Kind of test"'):
        for file, word in TABLES.items():
            made = ui.link(word, entering(id_, table=file))
            if file == here:
                made.props('aria-current="page"')
        ui.link("Analysis", analysis("entry", id_))
        ui.link("Campaign", f"/describe?entry={id_}")


def who_field(desk: Desk) -> ui.select | ui.input:
    """Who writes: one of the campaign's observers, or a name."""
    observers = list(desk.described.observers)
    return choice(WHO, observers, observers[0]) if observers else field(WHO)


def _others(sheet: Sheet, test: str) -> None:
    """Links to the series so far, the last ones first."""
    if sheet.file != "penetration.csv" or not sheet.tests():
        return
    heading("Series so far", 3)
    with ui.element("div").classes("acts so-far"):
        for other in reversed(sheet.tests()[-40:]):
            words = f"{other.name}{' (cancelled)' if other.cancelled else ''}"
            made = link(words, entering(sheet.desk.id, table=sheet.file, test=other.name), "small")
            if other.name == test:
                made.props('aria-current="page"')
