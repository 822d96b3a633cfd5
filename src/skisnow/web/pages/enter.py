"""Pages for the entry of tests, and for corrections of an imported campaign, whose files stay unchanged."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from nicegui import run, ui

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ...campaign.store.stored_tables import cell_key, checked_cell
from ..edit_session import CorrectionSession, EditSession
from ..elements import choice, field, folded, heading, link, page_frame, sentence
from ..entry.changes import UNANSWERED, Attachments, ask_correction, changes
from ..entry.readings import FILE, Field, checked_fields, faults, receive_offline_readings
from ..entry.series import SeriesForm
from ..entry.single import SingleForm
from ..entry.table_view import EntryList, TableView, table_links
from ..page_requests import analysis, asking_button, correction_address, entry_address, export, form, required_id
from ..settings import BUILD_S, Lab
from ..words import TABLES

HERE = "/"


def add_page(lab: Lab) -> None:
    """Add the page to enter tests, and the one to correct stored ones."""
    _add_correction(lab)

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
                series = SeriesForm(view, entry_list)
                receive_offline_readings(session, series.show_offline_readings)
                if test and not view.test(test).history and _is_head(view, head):
                    series.show(test, head)  # a new series, loaded again before its first reading
                elif test and view.test(test).rows:
                    series.show(test)
                else:
                    series.begin()
            else:
                receive_offline_readings(session, lambda _: None)
                SingleForm(view, entry_list).show(test, row=row)


def _is_head(view: TableView, head: dict[str, str]) -> bool:
    """True if the cells are a valid head of a series, unchanged by the check, with a known tool."""
    try:
        cells = {column: checked_cell(view.form, column, text) for column, text in head.items()}
    except ParameterError:
        return False
    return cells == head and head["tool"] in view.session.described.tools


UNREAD = Message("no table of this campaign can be read; its errors are listed under Analysis in the list of campaigns")


def _add_correction(lab: Lab) -> None:
    """Add the page that corrects tests of a stored campaign."""

    @ui.page("/correct/{id_}", response_timeout=BUILD_S)
    async def correct(id_: str, table: str = "", test: str = "") -> None:
        session = await run.io_bound(CorrectionSession, lab, required_id(id_))
        if session is None:  # the lab is shutting down
            return
        file = table or next(iter(session.tables), "")
        if file not in session.tables:
            missing = Message("this campaign has no such table")
            raise ParameterError(missing if session.tables else UNREAD).tag("no_table")
        with page_frame(session.stored.name or Message("Campaign"), here=HERE, keeps=True):
            sentence(
                Message("Imported: its files stay unchanged. Corrections made here are stored with them."), "quiet"
            )
            further = {Message("Analysis"): analysis("kept", session.id), Message("Export"): export("kept", session.id)}
            table_links({name: correction_address(session.id, table=name) for name in session.tables}, file, further)
            if test in session.tables[file].tests:
                _show_test(session, file, test)
            else:
                list_tests(session, file)


def _show_test(session: CorrectionSession, file: str, name: str) -> None:
    """Show a stored test with its cells, changes and attachments."""
    view = TableView(session, file, form=Message("Cells"), below=Message("Changes"))
    with view.below, ui.element("div").classes("acts"):
        link(Message("Another test"), correction_address(session.id, table=file))
        Attachments(view, lambda: name)
    ImportedTestForm(session, view, name).show()


ONCE: Final = ("site", "spot", "tool", "plate", "edge_angle_deg")
"""Columns with one value for a test, which each row repeats."""
LEFT_ALONE: Final = ("time", "remark", "snow_type", "status")
FEW: Final = 40


class ImportedTestForm:
    """Form of one test: fields of the columns with one value, and of each row."""

    def __init__(self, session: CorrectionSession, view: TableView, name: str) -> None:
        self._view, self._name = view, name
        self._table = session.tables[view.file]
        columns = (column for column in view.form.known if column in self._table.columns)
        self._columns = [column for column in columns if column not in (view.form.key, *LEFT_ALONE)]
        self._fields: dict[tuple[int, ...], dict[str, Field]] = {}

    def show(self) -> None:
        """Draw the form of an imported test with its current cells and the button to correct them."""
        test, rows = self._view.test(self._name), self._table.tests[self._name]
        cells = test.rows[0].cells
        cancelled = next(filter(None, (cells.get(cell_key(line, "status"), "") for line in rows)), "")
        self._view.clear()
        with self._view.form_place:
            heading(Message("Test {name}", name=self._name))
            if test.cancelled or cancelled:
                sentence(Message("Cancelled: {value}", value=test.cancelled or cancelled), "bad")
            with form("", sends=self._ask_correction):
                self._draw_fields(tuple(rows), cells)
            self._ask = ui.element("div")
            asking_button(Message("Correct"), self._ask_correction, "main")
        with self._view.changes_place:
            is_unanswered, in_file = self._is_unanswered, bool(cancelled)
            changes(self._view, test, self._ask, self.show, is_unanswered=is_unanswered, cancelled=in_file)
        site = cells.get(cell_key(min(rows), "site"), "")  # a file may lack the column
        self._view.live_results.follow(self._name, site)

    def _draw_fields(self, lines: tuple[int, ...], cells: Mapping[str, str]) -> None:
        """Draw fields for the lines of a test: columns with one value once, the others per line."""
        one_value = [column for column in self._columns if len({cells[cell_key(line, column)] for line in lines}) == 1]
        once = [column for column in one_value if column in ONCE]
        self._fields = {lines: {}}
        with ui.element("div").classes("fields"):
            for column in once:
                self._fields[lines][column] = self._make_field(column, cells[cell_key(lines[0], column)])
        for line in lines:
            own = self._fields.setdefault((line,), {})
            with ui.element("div").classes("fields row"):
                for column in self._columns:
                    if column not in once:
                        row = line if len(lines) > 1 else None
                        own[column] = self._make_field(column, cells[cell_key(line, column)], row=row)

    def _make_field(self, column: str, text: str, *, row: int | None = None) -> Field:
        """Field of a cell, a menu for tools and plates; `row`: line in its label, None for none."""
        words = self._view.label(column)
        if row is not None:
            words = Message("{column}, row {row}", column=words, row=row)
        described = self._view.session.described
        if column in ("tool", "plate"):
            names = sorted({text, *(described.tools if column == "tool" else described.plates)})
            return choice(words, names, text)
        numeric = any(rule.name == column for rule in self._view.form.numbers)
        return field(words, text, numeric=numeric, optional=not text)

    def _is_unanswered(self) -> bool:
        """True if a cell is changed and not confirmed, or rejected; the question is asked again."""
        changed = self._changed(self._view.test(self._name).rows[0].cells)
        if changed and self._ask_correction():
            self._view.say(UNANSWERED, "bad")
        return changed is None or bool(changed)

    def _ask_correction(self) -> bool:
        """Ask for the reason of changed cells; False if a cell is rejected."""
        test = self._view.test(self._name)
        row = test.rows[0]
        changed = self._changed(row.cells)
        if changed is None:
            return False
        return ask_correction(self._view, self._ask, (test, row), changed, show=self.show, leave=self.show)

    def _changed(self, stored: Mapping[str, str]) -> dict[str, str] | None:
        """Changed cells by key; None if one is rejected."""
        changed: dict[str, str] = {}
        refused: list[str] = []
        for lines, fields in self._fields.items():
            typed = {
                column: field_
                for column, field_ in fields.items()
                if str(field_.value or "").strip() != stored[cell_key(lines[0], column)]
            }
            cells = checked_fields(self._view.form, typed, conversions=self._table.conversions)
            refused += faults(typed.values())
            changed |= {cell_key(line, column): text for column, text in (cells or {}).items() for line in lines}
        if refused:
            self._view.say(Message("Not corrected:"), "bad", refused)
            return None
        return changed


def list_tests(session: CorrectionSession, file: str) -> None:
    """List links to the tests of a table by site; changed ones are marked."""
    sites: dict[str, list[str]] = {}
    for name, rows in session.tables[file].tests.items():
        sites.setdefault(next(iter(rows.values())).get("site", ""), []).append(name)
    heading(Message("Tests"))
    for site, names in sites.items():
        is_open = len(sites) == 1 and len(names) <= FEW
        with (
            folded(f"{site or Message('No site')}: {len(names)}", is_open=is_open),
            ui.element("div").classes("acts so-far"),
        ):
            for name in names:
                test = session.test(file, name)
                text = f"{name} (corrected)" if test.rows[0].corrections else name
                words = Message("{name} (cancelled)", name=name) if test.cancelled else text
                link(words, correction_address(session.id, table=file, test=name), "small")
