"""The frame of the pages that edit a table: links to the tables, the writer, the places of the form."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from nicegui import ui

from ..elements import StatusLine, choice, field, named
from ..language import said
from ..words import TABLES
from .changes import Places
from .live_results import Beside
from .table_view import WHO, TableView

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..edit_session import EditSession


def table_links(tables: Mapping[str, str], here: str, further: Mapping[str, str]) -> None:
    """Links to the tables, addresses by file, and behind them what else there is of the campaign, by name."""
    with named(ui.element("nav").classes("tables"), "Kind of test"):
        for file, address in tables.items():
            made = ui.link(said(TABLES[file]), address)
            if file == here:
                made.props('aria-current="page"')
        for name, address in further.items():
            ui.link(said(name), address)


@contextmanager
def table_view_of(
    session: EditSession, file: str, *, form: str, below: str
) -> Iterator[tuple[TableView, Beside, Places]]:
    """The view of a table with its places on the page; what follows stands below the changes.

    Parameters
    ----------
    session, file
        Campaign and table.
    form, below
        What the sections of the form and of the changes are called, for who cannot see them.
    """
    who = _who(session)
    view = TableView(session, file, who, StatusLine())
    with ui.element("div").classes("two"):
        place = named(ui.element("section"), form)
        beside = Beside(view)
        with named(ui.element("section").classes("below"), below):
            yield view, beside, Places(place, ui.element("div"))


def _who(session: EditSession) -> ui.select | ui.input:
    """Who writes: one of the campaign's observers, or a name."""
    observers = list(session.described.observers)
    with ui.element("div").classes("who") as place:
        made = choice(WHO, observers, observers[0]) if observers else field(WHO)

    def tell() -> None:
        place.props["data-who"] = str(made.value or "")

    made.on_value_change(tell)
    tell()
    return made
