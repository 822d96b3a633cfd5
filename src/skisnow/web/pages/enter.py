"""The page on which tests are entered."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nicegui import ui

from ..._support.errors import ParameterError
from ...campaign.store.stored_tables import checked_cell
from ..edit_session import EditSession
from ..entry.offline_readings import FILE, take_resent
from ..entry.series import SeriesForm
from ..entry.single import SingleForm
from ..entry.table_frame import table_links, table_view_of
from ..entry.table_view import SeriesList
from ..layout import framed
from ..page_addresses import analysis, entering, required_id
from ..words import TABLES

if TYPE_CHECKING:
    from ..entry.changes import Places
    from ..entry.live_results import Beside
    from ..entry.table_view import TableView
    from ..settings import Lab

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
            raise ParameterError("this address names no table of a campaign")
        session = EditSession(lab, required_id(id_))
        with framed(session.described.name or "Campaign", here=HERE, ahead=True):
            further = {"Analysis": analysis("entry", id_), "Campaign": f"/describe?entry={id_}"}
            table_links({file: entering(id_, table=file) for file in TABLES}, table, further)
            with table_view_of(session, table, form="Entry", below="Changes, and what was entered") as (
                view,
                beside,
                places,
            ):
                series_list = SeriesList(view) if view.file == FILE else None
            head = {"experiment": test, "site": site, "spot": spot, "tool": tool, "edge_angle_deg": edge_angle_deg}
            _begin(view, (test, row), head, (beside, places), series_list)


def _begin(
    view: TableView,
    shown: tuple[str, str],
    head: dict[str, str],
    where: tuple[Beside, Places],
    series_list: SeriesList | None,
) -> None:
    """Show the form of a test and of its row, or of a new one."""
    test, row = shown
    if series_list is not None:
        series = SeriesForm(view, *where, series_list)
        take_resent(view.session, series.follow_resent)
        if test and not view.test(test).history and _is_head(view, head):
            series.show(test, head)  # begun, and loaded anew before its first reading
        elif test and view.test(test).rows:
            series.show(test)
        else:
            series.begin()
    else:
        single = SingleForm(view, *where)
        take_resent(view.session, lambda _: None)
        if test:
            single.show(test, row=row)
        else:
            single.begin()


def _is_head(view: TableView, head: dict[str, str]) -> bool:
    try:
        said = {column: checked_cell(view.form, column, text) for column, text in head.items()}
    except ParameterError:
        return False
    return said == head and head["tool"] in view.session.described.tools
