"""Corrections of a series: changed depths with one reason for all, and depths read again after waiting."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Final

from nicegui import ui

from ..._support.messages import Message, template
from ...campaign.store import ReplayedTest
from ..elements import Words, field, folded, named
from ..entry.readings import STORED
from ..page_requests import asking_button, form
from ..words import label, number_text
from .changes import ASKED, LEFT_AS_IT_WAS, UNANSWERED, USUAL_REASON, WAITED, ask_reason
from .readings import (
    CHANGED,
    ReadingField,
    Step,
    add_load,
    checked_fields,
    faults,
    is_other,
    refuse,
    show_state,
    stored_depth,
)
from .table_view import TableView


class SeriesCorrections:
    """Corrections of stored readings of a series, with one reason for all.

    view, readings: table, and fields of the shown series by step.
    redraw: function that draws the stored series; unstored texts stay in their fields.
    """

    def __init__(self, view: TableView, readings: Mapping[Step, ReadingField], redraw: Callable[[], object]) -> None:
        self._view = view
        self._readings = readings
        self._redraw = redraw
        self._asked: dict[Step, str] = {}

    def begin(self, name: str, place: ui.element) -> None:
        """Set the series and the element for questions."""
        self._name, self._place, self._asked = name, place, {}

    @property
    def _test(self) -> ReplayedTest:
        return self._view.test(self._name)

    def _changed(self) -> dict[Step, ReadingField]:
        """Fields of stored readings with another depth, by step."""
        test = self._test
        rows = {step: test.row_under(*step) for step in self._readings}
        return {step: reading for step, reading in self._readings.items() if rows[step] and reading.differs(rows[step])}

    def is_unanswered(self) -> bool:
        """True if a reading is changed and not confirmed; the question is asked again."""
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
        """Ask for one reason for all changed readings; False if one of them is not a depth.

        ``is_said``: the status line shows it, too.
        """
        test, changed = self._test, self._changed()
        cells = {
            step: checked_fields(self._view.form, {"depth_mm": reading.depth}) for step, reading in changed.items()
        }
        depths = {step: row["depth_mm"] for step, row in cells.items() if row is not None}
        if len(depths) < len(changed):
            if is_said:
                self._view.say(Message("Not corrected:"), "bad", faults(reading.depth for reading in changed.values()))
            return False
        if self._asked == depths and not focus:  # Enter, and then the field was left: one question is enough
            return True
        self._asked = depths
        lines = [
            Message(
                "{step}: {old} mm becomes {new} mm.",
                step=step.words,
                old=number_text(stored),
                new=number_text(depth),
            )
            for step, depth in depths.items()
            for stored in [stored_depth(test.row_under(*step))]
        ]
        act = (Message("Correct it"), lambda why: self._store_corrections(depths, why))
        ask_reason(self._place, lines, act, usual=USUAL_REASON, leave=self._leave, focus=focus)
        if is_said:
            self._view.say(ASKED, "")
        return True

    def drop(self, step: Step) -> None:
        """Remove a reading from the question if its stored depth was typed again."""
        if step not in self._asked:
            return
        self._asked = {}
        self._place.clear()
        if self._changed():
            self.ask(focus=False)
        else:
            self._view.say(LEFT_AS_IT_WAS)

    def _store_corrections(self, depths: Mapping[Step, str], why: str) -> bool:
        for step, depth in depths.items():
            test = self._test
            row = test.row_under(*step)
            if row is None or not self._view.correct(test, row.entered.sequence, {"depth_mm": depth}, why):
                return False
        self._redraw()
        return True

    def _leave(self) -> None:
        """Restore the stored depths."""
        for step, reading in self._changed().items():
            reading.restore(self._test.row_under(*step))
        self._view.say(LEFT_AS_IT_WAS)
        self._redraw()


AFTER: Final = "depth_after_mm"
BECOMES: Final = template("After waiting under {load} N: {old} mm becomes {new} mm.")
IS_EMPTIED: Final = template("After waiting under {load} N: {old} mm becomes nothing.")


class DepthsAfterWaiting:
    """Fields of the depths after waiting, one for each load of a series."""

    def __init__(self, view: TableView, name: str, shown: Callable[[], object]) -> None:
        self._view = view
        self._name = name
        self._shown = shown
        self._fields: dict[str, ui.input] = {}

    @property
    def unstored(self) -> dict[str, str]:
        """Unstored texts by load."""
        test = self._test
        typed = {load: str(field.value or "").strip() for load, field in self._fields.items()}
        return {load: text for load, text in typed.items() if is_other(text, _depth_after(test, load))}

    @property
    def _test(self) -> ReplayedTest:
        return self._view.test(self._name)

    def draw(self, loads: Iterable[str], unstored: dict[str, str], ask: ui.element) -> None:
        """Draw the fields, folded without a depth."""
        test = self._test
        stored = {load: _depth_after(test, load) for load in loads}
        is_open = any(stored.values()) or bool(unstored)
        with (
            folded(Message("Depths read once more after waiting"), is_open=is_open),
            form("readings", sends=lambda: self._store(ask)),
        ):
            for load, text in stored.items():
                typed = unstored.get(load, number_text(text))
                self._fields[load] = self._add_depth_field(load, text, typed, closed=bool(test.cancelled))
            if not test.cancelled:
                asking_button(Message("Store what was read after waiting"), lambda: self._store(ask))

    def focus(self) -> None:
        """Put the focus on the first unstored field."""
        self._fields[next(iter(self.unstored))].run_method("focus")

    def _add_depth_field(self, load: str, stored: str, text: str, *, closed: bool) -> ui.input:
        with ui.element("div").classes("reading") as made:
            add_load(load)
            depth = field(label(AFTER), text, numeric=True, optional=True)
            named(depth, Message("Depth after waiting under {load} N (mm)", load=number_text(load)))
            depth.props("readonly" if closed else "")
            state = Words("").classes("stored")
            if stored:
                made.props["data-stored"] = stored

        def show() -> None:
            depth_after = _depth_after(self._test, load)
            is_changed = is_other(str(depth.value or ""), depth_after)
            show_state(state, "" if not depth_after else CHANGED if is_changed else STORED)

        show()
        depth.on_value_change(show)
        return depth

    def _store(self, ask: ui.element) -> bool:
        """Store new depths, and ask for the reason of changed ones; False if nothing is stored or asked."""
        depths = self._valid_changes()
        if depths is None:
            return False
        new = {load: text for load, text in depths.items() if not _depth_after(self._test, load)}
        others = {load: text for load, text in depths.items() if load not in new}
        listed = [
            Message("{depth} mm under {load} N", depth=number_text(text), load=number_text(load))
            for load, text in new.items()
        ]
        if not self._store_corrections(new, WAITED, Message("Stored after waiting: {listed}.", listed=listed)):
            return False
        if others:
            self._ask_correction(ask, others)
            if not new:
                self._view.say(ASKED, "")
        elif new:
            self._shown()
        else:
            self._view.say(Message("Nothing is different."))
        return True

    def _valid_changes(self) -> dict[str, str] | None:
        """Changed depths by load; None, after a message, if one of them is not valid."""
        depths: dict[str, str] = {}
        typed = {load: self._fields[load] for load in self.unstored}
        for load, depth in typed.items():
            cells = checked_fields(self._view.form, {AFTER: depth})
            if cells is not None and self._test.row_under(load) is None:
                refuse(depth, Message("the first depth under {load} N comes before it", load=number_text(load)))
            elif cells is not None:
                depths[load] = cells[AFTER]
        if len(depths) == len(typed):
            return depths
        self._view.say(Message("Not stored:"), "bad", faults(typed.values()))
        return None

    def _store_corrections(self, depths: dict[str, str], why: str, said: str) -> bool:
        for load, text in depths.items():
            test = self._test
            row = test.row_under(load)
            if row is None or not self._view.correct(test, row.entered.sequence, {AFTER: text}, why, said=said):
                return False
        return True

    def _ask_correction(self, ask: ui.element, depths: dict[str, str]) -> None:
        def correct(why: str) -> bool:
            if not self._store_corrections(depths, why, Message("Corrected; the first reading is kept.")):
                return False
            self._shown()
            return True

        test = self._test
        lines = [
            Message(
                BECOMES if text else IS_EMPTIED,
                load=number_text(load),
                old=number_text(_depth_after(test, load)),
                new=number_text(text),
            )
            for load, text in depths.items()
        ]

        def leave() -> None:
            for load in depths:
                self._fields[load].set_value(number_text(_depth_after(self._test, load), self._fields[load].client))
            self._view.say(LEFT_AS_IT_WAS)
            self._shown()

        ask_reason(ask, lines, (Message("Correct it"), correct), usual=USUAL_REASON, leave=leave)


def _depth_after(test: ReplayedTest, load: str) -> str:
    row = test.row_under(load)
    return "" if row is None else row.cells.get(AFTER, "")
