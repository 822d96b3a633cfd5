"""Page for the entry of tests."""

from __future__ import annotations

from nicegui import ui

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ...campaign.store.stored_tables import checked_cell
from ..edit_session import EditSession
from ..entry.changes import Attachments
from ..entry.readings import FILE, receive_offline_readings
from ..entry.series import SeriesForm
from ..entry.single import SingleForm
from ..entry.table_view import EntryList, LiveResults, Places, TableView, table_links, table_view
from ..layout import page_frame
from ..page_requests import analysis, entry_address, required_id
from ..settings import Lab
from ..words import TABLES

HERE = "/"


def add_page(lab: Lab) -> None:
    """Add the page to the application."""

    @ui.page("/enter/{id_}")
    def enter(
        id_: str,
        table: str = "penetration.csv",
        test: str = "",
        site: str = "",
        spot: str = "",
        tool: str = "",
        edge_angle_deg: str = "",
        row: str = "",
    ) -> None:
        if table not in TABLES:
            raise ParameterError("this address names no table of a campaign").tag("no_table")
        session = EditSession(lab, required_id(id_))
        with page_frame(session.described.name or Message("Campaign"), here=HERE, ahead=True):
            further = {Message("Analysis"): analysis("entry", id_), Message("Campaign"): f"/describe?entry={id_}"}
            table_links({file: entry_address(id_, table=file) for file in TABLES}, table, further)
            with table_view(session, table, form=Message("Entry"), below=Message("Changes and entries")) as (
                view,
                live_results,
                places,
            ):
                entry_list = live_results.entry_list = EntryList(view)
                Attachments(view, lambda: entry_list.current)
            head = {"experiment": test, "site": site, "spot": spot, "tool": tool, "edge_angle_deg": edge_angle_deg}
            _show_form(view, (test, row), head, (live_results, places), entry_list)


def _show_form(
    view: TableView,
    shown: tuple[str, str],
    head: dict[str, str],
    where: tuple[LiveResults, Places],
    entry_list: EntryList,
) -> None:
    """Show the form of a test and its row, or of a new test."""
    test, row = shown
    if view.file == FILE:
        series = SeriesForm(view, *where, entry_list)
        receive_offline_readings(view.session, series.show_offline_readings)
        if test and not view.test(test).history and _is_head(view, head):
            series.show(test, head)  # a new series, loaded again before its first reading
        elif test and view.test(test).rows:
            series.show(test)
        else:
            series.begin()
    else:
        single = SingleForm(view, *where, entry_list)
        receive_offline_readings(view.session, lambda _: None)
        if test:
            single.show(test, row=row)
        else:
            single.begin()


def _is_head(view: TableView, head: dict[str, str]) -> bool:
    try:
        cells = {column: checked_cell(view.form, column, text) for column, text in head.items()}
    except ParameterError:
        return False
    return cells == head and head["tool"] in view.session.described.tools
