"""Depths of a series that are read once more under the same load, after waiting: whether the snow creeps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ..answering import asking_button, form
from ..fields import field
from ..language import number_said, said_template
from ..worded import Words, named
from ..words import label
from .changes import ASKED, LEFT_AS_IT_WAS, USUAL_REASON, WAITED, ask_reason
from .checking import checked_fields, faults, refuse
from .readings import CHANGED, is_other, show_state

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from ...campaign.store import ReplayedTest
    from .table_view import TableView

AFTER: Final = "depth_after_mm"
BECOMES: Final = "After waiting under {} N: {} mm becomes {} mm."
IS_EMPTIED: Final = "After waiting under {} N: {} mm becomes nothing."


class AfterWaiting:
    """A field for each load of a series; each depth is stored with the reading under its load."""

    def __init__(self, view: TableView, name: str, shown: Callable[[], object]) -> None:
        self._view = view
        self._name = name
        self._shown = shown
        self._fields: dict[str, ui.input] = {}

    @property
    def unstored(self) -> dict[str, str]:
        """What is typed and not stored, by load."""
        test = self._test
        typed = {load: str(each.value or "").strip() for load, each in self._fields.items()}
        return {load: text for load, text in typed.items() if is_other(text, _stored(test, load))}

    @property
    def _test(self) -> ReplayedTest:
        return self._view.test(self._name)

    def draw(self, loads: Iterable[str], unstored: dict[str, str], ask: ui.element) -> None:
        """Draw the fields; they are open where a depth is stored or typed already."""
        test = self._test
        stored = {load: _stored(test, load) for load in loads}
        with ui.element("details").props("open" if any(stored.values()) or unstored else ""):
            with ui.element("summary"):
                Words("Depths read once more after waiting")
            with form("readings", sends=lambda: self._store(ask)):
                for load, text in stored.items():
                    self._fields[load] = self._field(
                        load, text, unstored.get(load, number_said(text)), closed=bool(test.cancelled)
                    )
                if not test.cancelled:
                    asking_button("Store what was read after waiting", lambda: self._store(ask))

    def focus(self) -> None:
        """Put the focus into the first field with something unstored."""
        self._fields[next(iter(self.unstored))].run_method("focus")

    def _field(self, load: str, stored: str, text: str, *, closed: bool) -> ui.input:
        with ui.element("div").classes("reading") as made:
            Words(f"{load} N").classes("load")
            depth = field(label(AFTER), text, numeric=True, optional=True)
            named(depth, f"Depth after waiting under {load} N (mm)")
            depth.props("readonly" if closed else "")
            state = Words("").classes("stored")
            if stored:
                made.props["data-stored"] = stored

        def show() -> None:
            now = _stored(self._test, load)
            show_state(state, CHANGED if now and is_other(str(depth.value or ""), now) else "stored" if now else "")

        show()
        depth.on_value_change(show)
        return depth

    def _store(self, ask: ui.element) -> bool:
        """Store depths that are new; ask why where one was there before."""
        found = self._checked()
        if found is None:
            return False
        new = {load: text for load, text in found.items() if not _stored(self._test, load)}
        others = {load: text for load, text in found.items() if load not in new}
        told = ", ".join(f"{text} mm under {load} N" for load, text in new.items())
        if not self._correct(new, WAITED, f"Stored after waiting: {told}."):
            return False
        if others:
            self._ask_correction(ask, others)
            if not new:
                self._view.say(ASKED, "")
        elif new:
            self._shown()
        else:
            self._view.say("Nothing is different.")
        return True

    def _checked(self) -> dict[str, str] | None:
        """What is typed anew, by load; None where something is refused."""
        found: dict[str, str] = {}
        typed = {load: self._fields[load] for load in self.unstored}
        for load, each in typed.items():
            cells = checked_fields(self._view.form, {AFTER: each})
            if cells is not None and self._test.row_under(load) is None:
                refuse(each, f"the first depth under {load} N comes before it")
            elif cells is not None:
                found[load] = cells[AFTER]
        if len(found) == len(typed):
            return found
        self._view.say("Not stored:", "bad", faults(typed.values()))
        return None

    def _correct(self, depths: dict[str, str], why: str, said: str) -> bool:
        for load, text in depths.items():
            test = self._test
            row = test.row_under(load)
            if row is None or not self._view.correct(test, row.entered.sequence, {AFTER: text}, why, said=said):
                return False
        return True

    def _ask_correction(self, ask: ui.element, depths: dict[str, str]) -> None:
        def correct(why: str) -> bool:
            if not self._correct(depths, why, "Corrected; the first reading is kept."):
                return False
            self._shown()
            return True

        test = self._test
        lines = [
            said_template(BECOMES if text else IS_EMPTIED, *map(number_said, (load, _stored(test, load), text)))
            for load, text in depths.items()
        ]

        def leave() -> None:
            for load in depths:
                self._fields[load].set_value(number_said(_stored(self._test, load), self._fields[load].client))
            self._view.say(LEFT_AS_IT_WAS)
            self._shown()

        ask_reason(ask, lines, ("Correct it", correct), usual=USUAL_REASON, leave=leave)


def _stored(test: ReplayedTest, load: str) -> str:
    row = test.row_under(load)
    return "" if row is None else row.cells.get(AFTER, "")
