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
from ..entry.table_view import EntryList, TableView, table_links
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
            view = TableView(session, table, form=Message("Entry"), below=Message("Changes and entries"))
            with view.below:
                entry_list = view.entry_list = EntryList(view)
                Attachments(view, lambda: entry_list.current)
            if table == FILE:
                head = {"experiment": test, "site": site, "spot": spot, "tool": tool, "edge_angle_deg": edge_angle_deg}
                _show_series(view, entry_list, test, head)
            else:
                receive_offline_readings(session, lambda _: None)
                SingleForm(view, entry_list).show(test, row=row)


def _show_series(view: TableView, entry_list: EntryList, test: str, head: dict[str, str]) -> None:
    """Show the form of a series, or of a new one."""
    series = SeriesForm(view, entry_list)
    receive_offline_readings(view.session, series.show_offline_readings)
    if test and not view.test(test).history and _is_head(view, head):
        series.show(test, head)  # a new series, loaded again before its first reading
    elif test and view.test(test).rows:
        series.show(test)
    else:
        series.begin()


def _is_head(view: TableView, head: dict[str, str]) -> bool:
    try:
        cells = {column: checked_cell(view.form, column, text) for column, text in head.items()}
    except ParameterError:
        return False
    return cells == head and head["tool"] in view.session.described.tools
