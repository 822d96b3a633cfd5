"""Photo and position of a test: both optional; the browser makes photos small and asks for consent to a position."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from nicegui import ui

from ..._support.errors import SkisnowError
from ..._support.messages import Message
from ...campaign.store import NewEntry, Position, ReplayedTest, attachments_of, photo_entry, position_entry
from ...campaign.store.attachments import photo_of
from ..elements import Words, button
from ..layout import heading
from .table_view import TableView

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
"""What the browser answers instead of a photo or a position."""


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
                made.on("change", self._take_photo, js_handler=ON_PHOTO)
                placed = button(Message("Store my position with this test"), None, "secure")
                placed.on("click", self._take_position, js_handler=ON_POSITION)
            self._list = ui.element("div")
        self.show()

    def _test(self) -> str:
        """Current test, otherwise the last one of the table; "" without a test."""
        name = self._current()
        if name and self._view.test(name).rows:
            return name
        tests = self._view.tests()
        return tests[-1].name if tests else ""

    def _take_photo(self, event: Any) -> None:
        self._take(event.args, lambda file, test, who: photo_entry(file, test, str(event.args["photo"]), who=who))

    def _take_position(self, event: Any) -> None:
        def entry(file: str, test: str, who: str) -> NewEntry:
            numbers = (float(event.args[key]) for key in ("latitude", "longitude", "accuracy"))
            return position_entry(file, test, Position(*numbers), who=who)

        self._take(event.args, entry)

    def _take(self, answer: Any, entry: Callable[[str, str, str], NewEntry]) -> None:
        if "refused" in answer:
            self._view.say(REFUSED[str(answer["refused"])], "bad")
            return
        test = self._test()
        if not test:
            self._view.say(Message("Store a test first; then add its photo or position."), "bad")
            return
        try:
            self._view.session.write_down(entry(self._view.file, test, self._view.writer), seen=0)
        except SkisnowError as error:
            self._view.say(error.message, "bad")
            return
        self._view.say(Message("Stored with test {test}.", test=test))
        self.show()

    def show(self) -> None:
        """List the photos and positions of the current test."""
        test = self._test()
        self._list.clear()
        with self._list:
            found = attachments_of(self._view.session.campaign, self._view.file, test)
            in_files = self._view.session.attached_in_files(self._view.file, test)
            if found or in_files:
                heading(Message("Test {name}", name=test), 4)
            for row in in_files:
                place = ", ".join(filter(None, (row.get("latitude_deg"), row.get("longitude_deg"))))
                Words(Message("In the files: {attachment}", attachment=row.get("photo") or place)).classes("quiet")
            for attachment in found:
                with ui.element("div").classes("acts"):
                    Words(_words(attachment))
                    button(Message("Remove"), lambda attachment=attachment: self._remove(attachment), "small")

    def _remove(self, attachment: ReplayedTest) -> None:
        entry = NewEntry(
            action="cancel", file=attachment.file, test=attachment.name, who=self._view.writer, why="removed"
        )
        try:
            self._view.session.write_down(entry, seen=attachment.last)
        except SkisnowError as error:
            self._view.say(error.message, "bad")
        self.show()


def _words(attachment: ReplayedTest) -> Message:
    cells = attachment.rows[0].cells
    if photo := photo_of(attachment):
        return Message("Photo, {size:.0f} kB", size=len(photo) / 1000.0)
    lat, lon, accuracy = (float(cells[key]) for key in ("latitude_deg", "longitude_deg", "accuracy_m"))
    return Message("Position {lat:.5f}°, {lon:.5f}° ± {accuracy:.0f} m", lat=lat, lon=lon, accuracy=accuracy)
