"""Changes of a test below its form, with the history; its photo and position, both optional."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from nicegui import ui

from ..._support.errors import SkisnowError
from ..._support.messages import Message, joined, template
from ...campaign.reading.columns import is_unloading_cell
from ...campaign.reading.table_forms import BRANCH
from ...campaign.store import (
    JournalEntry,
    NewEntry,
    Position,
    Reading,
    ReplayedTest,
    attachments_of,
    photo_entry,
    position_entry,
)
from ...campaign.store.export import photo_of
from ...campaign.store.stored_tables import cell_of
from ..elements import Words, add_items, button, field, folded, heading
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
    lines = []
    for entry in test.history:
        parts = (minute_words(entry.at), entry.who, _entry_words(entry, view))
        words: str = joined([part for part in parts if part], " · ")
        lines.append(Message("{entry} (undone)", entry=words) if entry.sequence in test.undone else words)
    if lines:
        with folded(Message("History of {name}", name=test.name)), ui.element("ol"):
            add_items(lines)


_DONE: Final = {
    "add": template("entered {what}"),
    "correct": template("corrected {what}"),
    "cancel": template("cancelled"),
    "undo": template("undid the entry before"),
}


def _entry_words(entry: JournalEntry, view: TableView) -> str:
    """Sentence about an entry: its added or changed cells, or that it cancels or takes back; with the reason."""
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


ON_PHOTO: Final = "(event) => lab.photo(event, emit)"
ON_POSITION: Final = "(event) => lab.position(event, emit)"
NEEDS: Final = Message(
    "Both need the connection to the lab. Without it, use the camera of the device and add the photo later."
)
REFUSED: Final = {
    "photo": Message("The browser cannot read this picture. Choose a JPEG or PNG file."),
    "denied": Message("The browser gives no position: you or its settings did not allow it."),
    "insecure": Message("The browser gives a position only to an encrypted page: start the lab with --certificate."),
    "unavailable": Message("The device found no position. Try again under the open sky."),
}
"""Messages for the answers of a browser that has no photo or position."""


class Attachments:
    """Part of the page with the photos and positions of the current test."""

    def __init__(self, view: TableView, current: Callable[[], str]) -> None:
        self._view = view
        self._current = current
        with ui.element("details").classes("attachments").on("toggle", self.show):
            with ui.element("summary"):
                Words(Message("Photo and position (optional)"))
            Words(NEEDS).classes("quiet")
            Words(REFUSED["insecure"]).classes("quiet insecure")
            with ui.element("div").classes("acts"):
                with ui.element("label").classes("act"):
                    Words(Message("Add a photo"))
                    made = ui.element("input").props("type=file accept=image/* hidden")
                made.on("change", self._store_attachment, js_handler=ON_PHOTO)
                placed = button(Message("Store my position with this test"), None, "secure")
                placed.on("click", self._store_attachment, js_handler=ON_POSITION)
            self._list = ui.element("div")
        self.show()

    def _test(self) -> str:
        """Name of the current test, otherwise of the last one of the table; "" without a test."""
        name = self._current()
        if name and self._view.test(name).rows:
            return name
        tests = self._view.tests()
        return tests[-1].name if tests else ""

    def _store_attachment(self, event: Any) -> None:
        """Store a photo or position that the browser sent with its test; shows why if it is rejected."""
        answer, test, file, who = event.args, self._test(), self._view.file, self._view.writer
        if "refused" in answer:
            self._view.say(REFUSED[str(answer["refused"])], "bad")
            return
        if not test:
            self._view.say(Message("Store a test first; then add its photo or position."), "bad")
            return
        if "photo" in answer:
            entry = photo_entry(file, test, str(answer["photo"]), who=who)
        else:
            numbers = (float(answer[key]) for key in ("latitude", "longitude", "accuracy"))
            entry = position_entry(file, test, Position(*numbers), who=who)
        if self._view.write(entry, 0, Message("Stored with test {test}.", test=test)):
            self.show()

    def show(self) -> None:
        """List the photos and positions of the current test."""
        test = self._test()
        self._list.clear()
        with self._list:
            attachments = attachments_of(self._view.session.campaign, self._view.file, test)
            in_files = self._view.session.attached_in_files(self._view.file, test)
            if attachments or in_files:
                heading(Message("Test {name}", name=test), 4)
            for row in in_files:
                place = ", ".join(filter(None, (row.get("latitude_deg"), row.get("longitude_deg"))))
                Words(Message("In the files: {attachment}", attachment=row.get("photo") or place)).classes("quiet")
            for attachment in attachments:
                with ui.element("div").classes("acts"):
                    Words(_in_words(attachment))
                    button(Message("Remove"), lambda attachment=attachment: self._remove(attachment), "small")

    def _remove(self, attachment: ReplayedTest) -> None:
        """Cancel the entry of a photo or position, and show the attachments again."""
        entry = NewEntry(
            action="cancel", file=attachment.file, test=attachment.name, who=self._view.writer, why="removed"
        )
        try:
            self._view.session.write_down(entry, seen=attachment.last)
        except SkisnowError as error:
            self._view.say(error.message, "bad")
        self.show()


def _in_words(attachment: ReplayedTest) -> Message:
    """Message about an attachment: size (kB) of a photo, or position and accuracy (m)."""
    cells = attachment.rows[0].cells
    if photo := photo_of(attachment):
        return Message("Photo, {size:.0f} kB", size=len(photo) / 1000.0)
    lat, lon, accuracy = (float(cells[key]) for key in ("latitude_deg", "longitude_deg", "accuracy_m"))
    return Message("Position {lat:.5f}°, {lon:.5f}° ± {accuracy:.0f} m", lat=lat, lon=lon, accuracy=accuracy)
