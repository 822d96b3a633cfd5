"""Corrections of the readings of a series: changed fields, and one question about all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..language import number_said, said, said_template
from .changes import ASKED, LEFT_AS_IT_WAS, UNANSWERED, USUAL_REASON, ask_reason
from .checking import checked_fields, faults
from .readings import stored_depth

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from nicegui import ui

    from ...campaign.store import ReplayedTest
    from .readings import ReadingField, Step
    from .table_view import TableView


class SeriesCorrections:
    """Asks why stored readings are changed.

    Parameters
    ----------
    view, readings
        The table, and the fields of the series that is shown, by step.
    redraw
        Draws the series as it is stored; texts that are not stored stay in their fields.
    """

    def __init__(self, view: TableView, readings: Mapping[Step, ReadingField], redraw: Callable[[], object]) -> None:
        self._view = view
        self._readings = readings
        self._redraw = redraw
        self._asked: dict[Step, str] = {}

    def begin(self, name: str, place: ui.element) -> None:
        """Ask about the series of this name, in this place."""
        self._name, self._place, self._asked = name, place, {}

    @property
    def _test(self) -> ReplayedTest:
        return self._view.test(self._name)

    def _changed(self) -> dict[Step, ReadingField]:
        """Fields of stored readings in which another depth is typed."""
        test = self._test
        rows = {step: test.row_under(*step) for step in self._readings}
        return {step: each for step, each in self._readings.items() if rows[step] and each.differs(rows[step])}

    def is_unanswered(self) -> bool:
        """Ask again if a reading is changed and the change not confirmed."""
        if not self._changed():
            return False
        if self.ask(focus=True):
            self._view.say(UNANSWERED, "bad")
        return True

    def ask_again(self) -> None:
        """Ask again after the series was drawn again, if a reading is changed."""
        if self._changed():
            self.ask(focus=False, is_said=False)

    def ask(self, *, focus: bool, is_said: bool = True) -> bool:
        """Ask once why stored readings are changed, all of them; False if one of them is not a depth.

        ``is_said``: the status line tells it, too.
        """
        test, changed = self._test, self._changed()
        cells = {step: checked_fields(self._view.form, {"depth_mm": each.depth}) for step, each in changed.items()}
        depths = {step: found["depth_mm"] for step, found in cells.items() if found is not None}
        if len(depths) < len(changed):
            if is_said:
                self._view.say("Not corrected:", "bad", faults(each.depth for each in changed.values()))
            return False
        if self._asked == depths and not focus:  # Enter, and then the field was left: one question is enough
            return True
        self._asked = depths
        lines = [
            said_template("{}: {} mm becomes {} mm.", said(step.words), *map(number_said, (stored, depth)))
            for step, depth in depths.items()
            for stored in [stored_depth(test.row_under(*step))]
        ]
        act = ("Correct it", lambda why: self._correct(depths, why))
        ask_reason(self._place, lines, act, usual=USUAL_REASON, leave=self._leave, focus=focus)
        if is_said:
            self._view.say(ASKED, "")
        return True

    def drop(self, step: Step) -> None:
        """Ask no more about a reading whose stored depth is typed again."""
        if step not in self._asked:
            return
        self._asked = {}
        self._place.clear()
        if self._changed():
            self.ask(focus=False)
        else:
            self._view.say(LEFT_AS_IT_WAS)

    def _correct(self, depths: Mapping[Step, str], why: str) -> bool:
        for step, depth in depths.items():
            test = self._test
            row = test.row_under(*step)
            if row is None or not self._view.correct(test, row.entered.sequence, {"depth_mm": depth}, why):
                return False
        self._redraw()
        return True

    def _leave(self) -> None:
        """Put the stored depths back, as was asked."""
        for step, each in self._changed().items():
            each.restore(self._test.row_under(*step))
        self._view.say(LEFT_AS_IT_WAS)
        self._redraw()
