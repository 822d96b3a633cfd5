"""Corrections of a series: changed depths with one reason for all, and depths read again after waiting."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from nicegui import ui

from ..._support.messages import Message
from ...campaign.store import Reading, ReplayedTest
from ..elements import folded
from ..page_requests import asking_button, form
from ..words import number_text
from .changes import ASKED, LEFT_AS_IT_WAS, UNANSWERED, USUAL_REASON, WAITED, ask_reason, change_words
from .readings import AFTER, DEPTH, ReadingField, Step, add_reading_field, checked_fields, faults, refuse, stored_depth
from .table_view import CORRECTED, TableView


class SeriesCorrections:
    """Question for the reason of changed readings of a series, one reason for all, and storage of the corrections.

    view, readings: table, and fields of the shown series by step.
    redraw: function that draws the stored series; unstored texts stay in their fields.
    column: column of the depths in the fields.
    """

    def __init__(
        self, view: TableView, readings: Mapping[Step, ReadingField], redraw: Callable[[], object], column: str = DEPTH
    ) -> None:
        self._view = view
        self._readings = readings
        self._redraw = redraw
        self._column = column
        self._asked: dict[Step, str] = {}

    def begin(self, name: str, place: ui.element) -> None:
        """Set the name of the series and the element in which the question is shown."""
        self._name, self._place, self._asked = name, place, {}

    @property
    def _test(self) -> ReplayedTest:
        """Current state of the series."""
        return self._view.test(self._name)

    def _changed(self) -> dict[Step, ReadingField]:
        """Fields whose text differs from the stored depth of their reading, by step."""
        test = self._test
        rows = {step: test.row_under(*step) for step in self._readings}
        return {step: reading for step, reading in self._readings.items() if rows[step] and reading.differs(rows[step])}

    def is_unanswered(self) -> bool:
        """True if a reading is changed and not confirmed; the question is then shown again."""
        if not self._changed():
            return False
        if self.ask(focus=True):
            self._view.say(UNANSWERED, "bad")
        return True

    def ask_again(self) -> None:
        """Ask again after the series was drawn, if a reading is changed."""
        if self._changed():
            self.ask(focus=False, is_said=False)

    def ask(self, *, focus: bool, is_said: bool = True) -> bool:
        """Ask one reason for all changed readings; False if one is not a depth. `is_said`: also in the status line."""
        changed = self._changed()
        cells = {
            step: checked_fields(self._view.form, {self._column: reading.depth}) for step, reading in changed.items()
        }
        depths = {step: row[self._column] for step, row in cells.items() if row is not None}
        if len(depths) < len(changed):
            if is_said:
                self._view.say(Message("Not corrected:"), "bad", faults(reading.depth for reading in changed.values()))
            return False
        if self._asked == depths and not focus:  # Enter, and then the field was left: one question is enough
            return True
        self._asked = depths
        test = self._test
        lines = [
            change_words(step.field_name(self._column), stored_depth(test.row_under(*step), self._column), text)
            for step, text in depths.items()
        ]
        act = (Message("Correct it"), partial(self._correct, depths))
        ask_reason(self._place, lines, act, usual=USUAL_REASON, leave=self._leave, focus=focus)
        if is_said:
            self._view.say(ASKED, "")
        return True

    def store(self, depths: Mapping[Step, str], why: str, said: str = CORRECTED) -> bool:
        """Store depths as corrections with a reason; False after the first rejected one."""
        for step, depth in depths.items():
            test = self._test
            row = test.row_under(*step)
            if row is None or not self._view.correct(test, row.entered.sequence, {self._column: depth}, why, said=said):
                return False
        return True

    def _correct(self, depths: Mapping[Step, str], why: str) -> bool:
        """Store corrected depths with a reason and draw the form again; False if they were not stored."""
        is_stored = self.store(depths, why)
        if is_stored:
            self._redraw()
        return is_stored

    def _leave(self) -> None:
        """Discard the changes: put the stored depths back into their fields."""
        for step, reading in self._readings.items():
            row = self._test.row_under(*step)
            if row is not None and reading.differs(row):
                reading.restore(row)
        self._view.say(LEFT_AS_IT_WAS)
        self._redraw()

    def drop(self, step: Step) -> None:
        """Update the question after the stored depth of a step was typed again, so that it is no longer changed."""
        if step not in self._asked:
            return
        self._asked = {}
        self._place.clear()
        if self._changed():
            self.ask(focus=False)
        else:
            self._view.say(LEFT_AS_IT_WAS)


class DepthsAfterWaiting:
    """Fields for the depths that were read again after waiting, one for each load of a series."""

    def __init__(self, view: TableView, name: str, shown: Callable[[], object]) -> None:
        self._view = view
        self._name = name
        self._shown = shown
        self._fields: dict[Step, ReadingField] = {}
        self._corrections = SeriesCorrections(view, self._fields, shown, AFTER)

    @property
    def unstored(self) -> dict[Step, str]:
        """Texts that differ from the stored depths, by step."""
        fields = self._fields.items()
        return {step: reading.typed for step, reading in fields if reading.differs(self._row(step))}

    def _row(self, step: Step) -> Reading | None:
        """Reading of the series at a step; None without one."""
        return self._view.test(self._name).row_under(*step)

    def draw(self, steps: Sequence[Step], unstored: dict[Step, str], ask: ui.element) -> None:
        """Add the fields, in a section that is closed without a depth; `ask`: element for the question."""
        self._corrections.begin(self._name, ask)
        closed = bool(self._view.test(self._name).cancelled)
        is_open = any(stored_depth(self._row(step), AFTER) for step in steps) or bool(unstored)
        with (
            folded(Message("Depths read once more after waiting"), is_open=is_open),
            form("readings", sends=self._store),
        ):
            for step in steps:
                stored = partial(self._row, step)
                self._fields[step] = add_reading_field(step, unstored.get(step), stored, column=AFTER, closed=closed)
            if not closed:
                asking_button(Message("Store what was read after waiting"), self._store)

    def focus(self) -> None:
        """Put the focus on the first field whose depth is not stored; there must be one."""
        self._fields[next(iter(self.unstored))].depth.run_method("focus")

    def _store(self) -> bool:
        """Store new depths, and ask for the reason of changed ones; False if a depth is rejected."""
        depths = self._valid_changes()
        if depths is None:
            return False
        new = {step: text for step, text in depths.items() if not stored_depth(self._row(step), AFTER)}
        others = {step: text for step, text in depths.items() if step not in new}
        listed = [
            Message("{depth} mm under {load} N", depth=number_text(text), load=number_text(step.load))
            for step, text in new.items()
        ]
        stored = Message("Stored after waiting: {listed}.", listed=listed)
        if not self._corrections.store(new, WAITED, stored):
            return False
        if others:
            self._corrections.ask(focus=True, is_said=not new)
        elif new:
            self._shown()
        else:
            self._view.say(Message("Nothing is different."))
        return True

    def _valid_changes(self) -> dict[Step, str] | None:
        """Changed depths by step; None, after a message, if one of them is not valid."""
        depths: dict[Step, str] = {}
        typed = {step: self._fields[step].depth for step in self.unstored}
        for step, depth in typed.items():
            cells = checked_fields(self._view.form, {AFTER: depth})
            if cells is not None and self._row(step) is None:
                refuse(depth, Message("the first depth under {load} N comes before it", load=number_text(step.load)))
            elif cells is not None:
                depths[step] = cells[AFTER]
        if len(depths) == len(typed):
            return depths
        self._view.say(Message("Not stored:"), "bad", faults(typed.values()))
        return None
