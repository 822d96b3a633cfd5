"""Changes of a test below its form, with the history."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from nicegui import ui

from ..._support.messages import Message, joined, template
from ...campaign.reading.columns import is_unloading_cell
from ...campaign.reading.table_forms import BRANCH
from ...campaign.store import (
    JournalEntry,
    Reading,
    ReplayedTest,
)
from ...campaign.store.stored_tables import cell_of
from ..elements import add_items, button, field, folded
from ..page_requests import asking_button, form
from ..words import label, minute_words, number_text, said
from .table_view import TableView

USUAL_REASON: Final = Message("typing error")
ASKED: Final = Message("Not corrected yet. Give the reason below.")
UNANSWERED: Final = Message("Not corrected yet. Correct it with a reason, or leave it as it was.")
LEFT_AS_IT_WAS: Final = Message("It is as it was before.")
WAITED: Final = "read once more after waiting"
"""Reason in the journal for a second depth of a reading."""
_SAME: Final = ("experiment", "sample", "test", "site", "spot", "tool", "plate")


def ask_reason(
    place: ui.element,
    lines: Sequence[str],
    act: tuple[str, Callable[[str], bool]],
    *,
    usual: str = "",
    leave: Callable[[], object],
    focus: bool = True,
) -> None:
    """Ask for the reason of a change, inside the page.

    place: element that is replaced by the question.
    act: text of the button, and the function that is called with the reason; it returns False for a rejected change.
    leave: function that is called when the change is not made.
    focus: True to put the focus on the reason; False if the user is on the way to another field.
    """
    place.clear()

    def done() -> bool:
        return act[1](reason.value or "")

    def left() -> None:
        place.clear()
        with place:  # the button that was pressed is gone
            leave()

    with place, form("card ask", sends=done):
        for line in lines:
            ui.label(said(line)).classes("sentence")
        reason = field(Message("Why"), said(usual), wide=True)
        reason.on("keydown.esc", left)
        with ui.element("div").classes("acts"):
            asking_button(act[0], done, "main")
            button(Message("Leave it as it was"), left)
    if focus:
        reason.run_method("focus")
    if focus and usual:
        reason.run_method("select")


def ask_correction(
    view: TableView,
    place: ui.element,
    row: tuple[ReplayedTest, Reading],
    changed: Mapping[str, str],
    *,
    show: Callable[[], object],
    leave: Callable[[], object],
) -> bool:
    """Ask for the reason of changed cells of a row, to store them as a correction; returns True, also without a change.

    changed: texts by the keys of the cells.
    show, leave: functions that are called after the correction is stored, or not made.
    """
    if not changed:
        view.say(Message("Nothing is different."))
        return True
    stored = row[1].cells
    lines = [
        change_words(view.label(key.rpartition("/")[2]), stored.get(key, ""), text) for key, text in changed.items()
    ]

    def correct(why: str) -> bool:
        test, reading = row
        if not view.correct(test, reading.entered.sequence, changed, why):
            return False
        show()
        return True

    def left() -> None:
        view.say(LEFT_AS_IT_WAS)
        leave()

    act = (Message("Correct it"), correct)
    ask_reason(place, list(dict.fromkeys(lines)), act, usual=USUAL_REASON, leave=left)
    view.say(ASKED, "")
    return True


def change_words(name: str, old: str, new: str) -> Message:
    """Sentence with the old and the new text of a cell or field."""
    old_text, new_text = (number_text(text) or Message("nothing") for text in (old, new))
    return Message("{name}: {old} becomes {new}.", name=name, old=old_text, new=new_text)


def focus_button(button: ui.button) -> None:
    """Put the focus on a button, which has no method for it."""
    button.client.run_javascript(f"getHtmlElement({button.id}).focus()")


def changes(
    view: TableView,
    test: ReplayedTest,
    ask: ui.element,
    changed: Callable[[], object],
    *,
    is_unanswered: Callable[[], bool],
    cancelled: bool = False,
) -> None:
    """Show the history of a test with buttons that undo its last change or cancel the test.

    changed: function that is called after a change is stored.
    is_unanswered: function that returns True, and asks for the reason again, if a typed correction is not confirmed.
    cancelled: True if the test is cancelled in its file.
    """

    def undo() -> bool:
        if is_unanswered():
            return False
        done = view.undo(test)
        changed()
        return done

    def cancel(why: str) -> bool:
        if not view.cancel(test, why):
            return False
        changed()
        return True

    def ask_cancel() -> bool:
        if is_unanswered():
            return False
        question = Message("Cancel {test}? Its readings are kept but not included.", test=test.name)
        ask_reason(ask, [question], (Message("Cancel the test"), cancel), leave=lambda: focus_button(asks))
        return True

    with ui.element("div").classes("acts"):
        if test.undoable is not None:
            asking_button(Message("Undo: {done}", done=_entry_words(test.undoable, view)), undo)
        if not test.cancelled and not cancelled and test.rows:
            asks = asking_button(Message("Cancel this test"), ask_cancel)
    _add_history(test, view)


def _add_history(test: ReplayedTest, view: TableView) -> None:
    if not test.history:
        return
    lines = []
    for entry in test.history:
        parts = (minute_words(entry.at), entry.who, _entry_words(entry, view))
        words: str = joined([part for part in parts if part], " · ")
        lines.append(Message("{entry} (undone)", entry=words) if entry.sequence in test.undone else words)
    with folded(Message("History of {name}", name=test.name)), ui.element("ol"):
        add_items(lines)


_DONE: Final = {
    "add": template("entered {what}"),
    "correct": template("corrected {what}"),
    "cancel": template("cancelled"),
    "undo": template("undid the entry before"),
}


def _entry_words(entry: JournalEntry, view: TableView) -> str:
    """Content of an entry of the history in words."""
    cells = {column: number_text(text) for column, text in entry.cells.items()}
    if entry.is_from_file:
        return entry.why
    what: str
    if entry.action == "correct" and all("/" in key for key in cells):
        places = {cell_of(key): text or Message("nothing") for key, text in cells.items()}
        what = joined(
            [
                Message("{column} in row {line} to {text}", column=view.label(column), line=line, text=text)
                for (line, column), text in places.items()
            ],
            ", ",
        )
    elif entry.action == "correct" and entry.why == WAITED:
        return Message("read once more after waiting: {depths} mm", depths=list(cells.values()))
    elif entry.action == "add" and "load_N" in cells:
        reading = {"depth": cells["depth_mm"], "load": cells["load_N"]}
        if is_unloading_cell(cells.get(BRANCH, "")):
            what = Message("{depth} mm under {load} N on the way back", **reading)
        else:
            what = Message("{depth} mm under {load} N", **reading)
    else:
        shown = {column: text for column, text in cells.items() if text and column not in _SAME}
        what = joined([Message("{column} {text}", column=label(key), text=text) for key, text in shown.items()], ", ")
    done = Message(_DONE[entry.action], what=what)
    return Message("{done} ({why})", done=done, why=entry.why) if entry.why else done
