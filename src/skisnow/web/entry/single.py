"""Form of tests with one row: a shear test, a density sample, a repeat of a drop cone."""

from __future__ import annotations

from functools import partial
from typing import Final

from nicegui import ui

from ..._support.messages import Message
from ...campaign.reading.experiments import TURNING
from ...campaign.store import Reading, ReplayedTest
from ..elements import choice, field, heading, sentence
from ..page_requests import asking_button, entry_address, form
from ..words import label
from .changes import UNANSWERED, ask_correction, changes
from .readings import checked_fields, faults, is_other, refuse
from .table_view import EntryList, TableView

OPTIONAL: Final = {"shear.csv": ("spot", TURNING), "density.csv": ("sample_depth_mm",)}
KEPT: Final = ("site", "plate", "edge_angle_deg", "lever_arm_mm")
"""Columns that are prefilled with the values of the test before."""
ONCE: Final = ("site", "spot", "plate", "edge_angle_deg", "depth_mm", "lever_arm_mm")
"""Columns with one value for all rows of a shear test with turning angles."""


class SingleForm:
    """Form to enter or correct one row of a table, such as a shear test, with the list of rows."""

    def __init__(self, view: TableView, entry_list: EntryList) -> None:
        self._view = view
        self._list = entry_list
        entry_list.open_row = self._open_row
        table = view.form
        required = [column.name for column in table.numbers if column.needed]
        self._columns = (*table.names, *OPTIONAL.get(table.file, ()), *required)
        self._numeric = {column.name for column in table.numbers}
        self._fields: dict[str, ui.input | ui.select] = {}
        self._begun: dict[str, str] | None = None
        """Typed texts of a new row while another row is shown."""
        self._is_new = False
        self._correcting: tuple[ReplayedTest, Reading] | None = None

    def begin(self) -> None:
        """Show the form of a new row, with the texts that were typed before another row was shown."""
        self._draw(self._begun or self._prefilled_cells(), None)

    def _open_row(self, name: str = "", row: str = "") -> bool:
        """Open a row of a test, by default a new one; False if a question is not answered yet."""
        if self._is_unanswered():
            return False
        self.show(name, row=row)
        return True

    def show(self, name: str, *, row: str = "") -> None:
        """Show a row of a test, by the number of its entry or the first; without a row: the form of a new test."""
        test = self._view.test(name)
        if not test.rows:
            self.begin()
            return
        chosen = next((candidate for candidate in test.rows if _entry_number(candidate) == row), test.rows[0])
        self._draw(chosen.cells, (test, chosen))
        self._view.live_results.follow(name, chosen.cells["site"])

    def _prefilled_cells(self) -> dict[str, str]:
        """Cells of a new test, some of them from the test before."""
        tests, key = self._view.tests(), self._view.form.key
        before = tests[-1].rows[-1].cells if tests else {}
        cells = {column: before.get(column, "") for column in KEPT}
        cells[key] = self._view.next_name()
        if "repeat" in self._columns:
            cells[key] = before.get(key, cells[key])
            cells["repeat"] = str(len(tests[-1].rows) + 1) if tests else "1"
        if before.get(TURNING):
            cells |= {column: before.get(column, "") for column in (key, *ONCE)}
        return cells

    def _draw(self, cells: dict[str, str], correcting: tuple[ReplayedTest, Reading] | None) -> None:
        """Draw the form with `cells`; `correcting`: test and row to correct, None for a new test."""
        if self._is_new and correcting is not None:
            typed = {column: str(field_.value) for column, field_ in self._fields.items() if field_.value}
            self._begun = typed if typed.items() - self._prefilled_cells().items() else None
        self._is_new, self._correcting = correcting is None, correcting
        name, head = (correcting[0].name, {"row": _entry_number(correcting[1])}) if correcting else ("", {})
        address = entry_address(self._view.session.id, table=self._view.file, test=name, head=head)
        ui.navigate.history.replace(address)  # the browser keeps typed texts by address: each row has one
        self._view.clear()
        with self._view.form_place:
            heading(Message("Correct a test") if correcting else Message("New test"))
            if correcting and correcting[0].cancelled:
                sentence(Message("Cancelled: {cancelled}", cancelled=correcting[0].cancelled), "bad")
            sends = self._store_test if correcting is None else lambda: self._ask_correction(*correcting)
            with form(sends=sends):
                self._fields = {column: self._field(column, cells, fixed=bool(correcting)) for column in self._columns}
            self._ask = ui.element("div")
            with ui.element("div").classes("acts"):
                asking_button(Message("Store") if correcting is None else Message("Correct"), sends, "main")
                if correcting is not None:
                    asking_button(Message("New test"), self._open_row)
        with self._view.changes_place:
            if correcting is not None:
                show = partial(self.show, name, **head)
                changes(self._view, correcting[0], self._ask, show, is_unanswered=self._is_unanswered)
        self._list.show(name)
        self._focus_first()

    def _field(self, column: str, cells: dict[str, str], *, fixed: bool) -> ui.input | ui.select:
        """Field of a column, a menu for a plate; the test's name is read-only if `fixed`."""
        if column == "plate":
            plates, value = sorted(self._view.session.described.plates), cells.get(column)
            if not plates:
                sentence(Message("This campaign has no plate yet: name one under Campaign."), "bad")
            return choice(label(column), plates, value if value in plates else next(iter(plates), None))
        optional = column in OPTIONAL.get(self._view.file, ())
        made = field(label(column), cells.get(column, ""), numeric=column in self._numeric, optional=optional)
        if fixed and column == self._view.form.key:
            made.props("readonly")
        return made

    def _focus_first(self) -> None:
        """Put the focus on the first empty field that is not optional."""
        empty = [field_ for field_ in self._fields.values() if not field_.value and isinstance(field_, ui.input)]
        goes_on = TURNING in self._fields and bool(self._fields["depth_mm"].value)  # the next angle of the same test
        left = [column for column in OPTIONAL.get(self._view.file, ()) if not (column == TURNING and goes_on)]
        candidates = [field_ for field_ in empty if all(field_ is not self._fields[column] for column in left)]
        if candidates:
            candidates[0].run_method("focus")

    def _checked_cells(self, rejected: str = Message("Not stored:")) -> dict[str, str] | None:
        """Checked cells by column; None, with the faults shown after `rejected`, if one is not valid."""
        cells = checked_fields(self._view.form, self._fields)
        if cells is None:
            self._view.say(rejected, "bad", faults(self._fields.values()))
        return cells

    def _store_test(self) -> bool:
        """Store the typed test, or a further row of it; False, with the faults shown, if it is not valid."""
        cells = self._checked_cells()
        if cells is None:
            return False
        key = self._view.form.key
        test = self._view.test(cells[key])
        if (before := self._view.stored_before()) is not None:
            return self._announce_stored(before, cells["site"])
        if test.history and (fault := self._fault_of_second_row(test, cells)):
            refuse(self._fields[key], fault)
            self._view.say(Message("Not stored:"), "bad", faults([self._fields[key]]))
            return False
        if not self._view.add(test, cells, position=len(test.rows), said=""):
            return False
        return self._announce_stored(test.name, cells["site"])

    def _announce_stored(self, name: str, site: str) -> bool:
        """Say that a test is stored, compute its results and begin the next one; returns True."""
        self._view.say(Message("Stored: test {name}.", name=name))
        self._view.live_results.follow(name, site)
        self._begun = None
        self.begin()
        return True

    def _fault_of_second_row(self, test: ReplayedTest, cells: dict[str, str]) -> str:
        """Fault if the cells cannot be a further row of the test; "" if they can."""
        if cells.get(TURNING) and all(row.cells.get(TURNING) for row in test.rows):
            first = test.rows[0].cells if test.rows else cells
            changed = next((column for column in ONCE if cells.get(column, "") != first.get(column, "")), None)
            if changed is None:
                return ""
            return Message("the rows of test {name} have one {label}", name=test.name, label=label(changed))
        if "repeat" not in cells:
            return Message("there is a test {name} already; give this one another name", name=test.name)
        if any(row.cells["repeat"] == cells["repeat"] for row in test.rows):
            return Message("test {name} has a repeat {repeat} already", name=test.name, repeat=cells["repeat"])
        if test.rows and test.rows[0].cells["site"] != cells["site"]:
            return Message("test {name} is at the site {site}", name=test.name, site=test.rows[0].cells["site"])
        return ""

    def _is_unanswered(self) -> bool:
        """True if the shown row is changed and not confirmed; the question is then shown again."""
        if self._correcting is None:
            return False
        stored = self._correcting[1].cells
        typed = {column: str(field_.value or "").strip() for column, field_ in self._fields.items()}
        if not any(is_other(text, stored.get(column, "")) for column, text in typed.items()):
            return False
        if self._ask_correction(*self._correcting):
            self._view.say(UNANSWERED, "bad")
        return True

    def _ask_correction(self, test: ReplayedTest, row: Reading) -> bool:
        """Ask for the reason of the changed cells, then store them; False if a cell is not valid."""
        cells = self._checked_cells(Message("Not corrected:"))
        if cells is None:
            return False
        stored = row.cells
        changed = {column: text for column, text in cells.items() if text != stored.get(column, "")}
        show, leave = partial(self.show, test.name, row=_entry_number(row)), lambda: self._draw(row.cells, (test, row))
        return ask_correction(self._view, self._ask, (test, row), changed, show=show, leave=leave)


def _entry_number(row: Reading) -> str:
    """Sequence number of the entry of a reading, as text."""
    return str(row.entered.sequence)
