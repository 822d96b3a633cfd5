"""A test of an imported campaign: cells that are corrected with a reason. Its files stay unchanged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ...campaign.store.stored_tables import cell_key
from ..elements import Words, choice, field, link
from ..language import said
from ..layout import heading, sentence
from ..page_addresses import correcting
from ..page_requests import asking_button, form
from .changes import ASKED, LEFT_AS_IT_WAS, UNANSWERED, USUAL_REASON, Places, ask_reason, change_said, changes
from .readings import Field, checked_fields, faults

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ...campaign.store import ReplayedTest
    from ..edit_session import CorrectionSession
    from .live_results import Beside
    from .table_view import TableView

ONCE: Final = ("site", "spot", "tool", "plate", "edge_angle_deg")
"""Columns that a test has once, though every row of it says them."""
LEFT_ALONE: Final = ("time", "remark", "snow_type", "status")
FEW: Final = 40


class KeptForm:
    """The form of one test: each column that it has once, and each row."""

    def __init__(self, session: CorrectionSession, view: TableView, beside: Beside, places: Places) -> None:
        self._desk = session
        self._view = view
        self._beside = beside
        self._places = places
        self._table = session.tables[view.file]
        known = (column for column in view.form.known if column in self._table.columns)
        self._columns = [column for column in known if column not in (view.form.key, *LEFT_ALONE)]
        self._fields: dict[tuple[int, ...], dict[str, Field]] = {}

    def show(self, name: str) -> None:
        """Show a test as it is now."""
        test, rows = self._view.test(name), self._table.tests[name]
        now = test.rows[0].cells
        cancelled = next(filter(None, (now.get(cell_key(line, "status"), "") for line in rows)), "")
        self._places.clear()
        with self._places.form:
            heading(f"Test {name}")
            if test.cancelled or cancelled:
                sentence(f"Cancelled: {test.cancelled or cancelled}", "bad")
            with form("", sends=lambda: self._ask_correction(name)):
                self._draw(tuple(rows), now)
            self._ask = ui.element("div")
            asking_button("Correct", lambda: self._ask_correction(name), "main")
        with self._places.below:
            changes(
                self._view,
                test,
                self._ask,
                lambda: self.show(name),
                is_unanswered=lambda: self._is_unanswered(name),
                cancelled=bool(cancelled),
            )
        self._beside.follow(name, now.get(cell_key(min(rows), "site"), ""))  # a file may lack the column

    def _draw(self, lines: tuple[int, ...], now: Mapping[str, str]) -> None:
        once = [column for column in self._columns if column in ONCE and self._is_once(lines, column, now)]
        self._fields = {lines: {}}
        with ui.element("div").classes("fields"):
            for column in once:
                self._fields[lines][column] = self._field(column, now[cell_key(lines[0], column)])
        for line in lines:
            own = self._fields.setdefault((line,), {})
            with ui.element("div").classes("fields row"):
                for column in self._columns:
                    if column not in once:
                        row = line if len(lines) > 1 else None
                        own[column] = self._field(column, now[cell_key(line, column)], row=row)

    def _is_once(self, lines: Iterable[int], column: str, now: Mapping[str, str]) -> bool:
        return len({now[cell_key(line, column)] for line in lines}) == 1

    def _field(self, column: str, text: str, *, row: int | None = None) -> Field:
        words = self._view.label(column) + (f", row {row}" if row is not None else "")
        described = self._desk.described
        if column in ("tool", "plate"):
            names = sorted({text, *(described.tools if column == "tool" else described.plates)})
            return choice(words, names, text)
        numeric = any(rule.name == column for rule in self._view.form.numbers)
        return field(words, text, numeric=numeric, optional=not text)

    def _is_unanswered(self, name: str) -> bool:
        """Ask again if a cell is changed and the change not confirmed."""
        changed = self._changed(self._view.test(name).rows[0].cells)
        if changed and self._ask_correction(name):
            self._view.say(UNANSWERED, "bad")
        return changed is None or bool(changed)

    def _ask_correction(self, name: str) -> bool:
        test = self._view.test(name)
        now = test.rows[0].cells
        changed = self._changed(now)
        if changed is None:
            return False
        if not changed:
            self._view.say("Nothing is different.")
            return True

        def correct(why: str) -> bool:
            if not self._view.correct(test, test.rows[0].entered.sequence, changed, why):
                return False
            self.show(name)
            return True

        columns = {key: said(self._view.label(key.split("/", 1)[1])) for key in changed}
        lines = list(dict.fromkeys(change_said(columns[key], now[key], new) for key, new in changed.items()))
        act = ("Correct it", correct)
        ask_reason(self._ask, lines, act, usual=USUAL_REASON, leave=lambda: self._leave(name))
        self._view.say(ASKED, "")
        return True

    def _leave(self, name: str) -> None:
        self._view.say(LEFT_AS_IT_WAS)
        self.show(name)

    def _changed(self, now: Mapping[str, str]) -> dict[str, str] | None:
        """Cells by key that are typed anew; None where one is refused."""
        changed: dict[str, str] = {}
        refused: list[str] = []
        for lines, fields in self._fields.items():
            typed = {
                column: each
                for column, each in fields.items()
                if str(each.value or "").strip() != now[cell_key(lines[0], column)]
            }
            cells = checked_fields(self._view.form, typed, conversions=self._table.conversions)
            refused += faults(typed.values())
            changed |= {cell_key(line, column): text for column, text in (cells or {}).items() for line in lines}
        if refused:
            self._view.say("Not corrected:", "bad", refused)
            return None
        return changed


def list_tests(session: CorrectionSession, file: str) -> None:
    """Links to the tests of a table, site by site; those that were spoken of are marked."""
    sites: dict[str, list[str]] = {}
    for name, rows in session.tables[file].tests.items():
        sites.setdefault(next(iter(rows.values())).get("site", ""), []).append(name)
    heading("Tests")
    for site, names in sites.items():
        with ui.element("details").props("open" if len(sites) == 1 and len(names) <= FEW else ""):
            with ui.element("summary"):
                Words(f"{site or 'No site'}: {len(names)}")
            with ui.element("div").classes("acts so-far"):
                for name in names:
                    link(_name(session.test(file, name)), correcting(session.id, table=file, test=name), "small")


def _name(test: ReplayedTest) -> str:
    if test.cancelled:
        return f"{test.name} (cancelled)"
    return f"{test.name} (corrected)" if test.rows[0].corrections else test.name
