"""One table of a campaign on a page: writer, status, storing of entries, links to tables and series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ..._support.errors import ParameterError, StoreError
from ..._support.user_files import natural_number
from ...campaign.store import NewEntry, OvertakenError
from ...campaign.store.stored_tables import FORMS
from ..elements import StatusLine, link
from ..layout import heading
from ..page_addresses import entering
from ..page_requests import asked
from ..words import in_words, label

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ...campaign.reading.table_forms import TableForm
    from ...campaign.store import ReplayedTest
    from ..edit_session import EditSession


WHO: Final = "Operator"


class TableView:
    """Writes about the tests of one table, and says aloud what came of it."""

    def __init__(self, session: EditSession, file: str, who: ui.select | ui.input, status: StatusLine) -> None:
        self.session = session
        self.file = file
        self.form: TableForm = FORMS[file]
        self._who = who
        self._status = status

    def test(self, name: str) -> ReplayedTest:
        """A test as it was at the last look."""
        return self.session.test(self.file, name)

    def label(self, column: str) -> str:
        """Label of a column, with the unit of its cells."""
        return label(column, unit=self.session.unit(self.file, column))

    def tests(self) -> list[ReplayedTest]:
        """All tests of the table, in the order of entry."""
        return self.session.campaign.of_file(self.file)

    def next_name(self) -> str:
        """The number behind the largest one among the names."""
        numbers = (natural_number(test.name) for test in self.tests())
        return str(max((number for number in numbers if number is not None), default=0) + 1)

    def add(self, name: str, cells: Mapping[str, str], *, position: int, seen: int, said: str) -> bool:
        """Store a row; whether it is stored, now or when it was sent before."""
        entry = NewEntry(
            action="add",
            file=self.file,
            test=name,
            cells=cells,
            position=position,
            who=self._who.value or "",
            once=asked().once,
        )
        return self._write(entry, seen, said)

    def stored_before(self) -> str | None:
        """The name of the test that was stored when what is asked for now was sent before."""
        once = asked().once
        sent = (entry for test in self.tests() for entry in test.history if once is not None and entry.once == once)
        return next((entry.test for entry in sent), None)

    def correct(
        self,
        test: ReplayedTest,
        row: int,
        cells: Mapping[str, str],
        why: str,
        *,
        said: str = "Corrected; the first reading is kept.",
    ) -> bool:
        """Store a correction of the row that was entered under this sequence."""
        if not why.strip():
            self.say("A correction needs a reason.", "bad")
            return False
        entry = NewEntry(
            action="correct",
            file=self.file,
            test=test.name,
            about=row,
            cells=cells,
            who=self._who.value or "",
            why=why.strip(),
        )
        return self._write(entry, test.last, said)

    def cancel(self, test: ReplayedTest, why: str) -> bool:
        """Store that a test does not count, and why."""
        if not why.strip():
            self.say("A test is cancelled with a reason.", "bad")
            return False
        entry = NewEntry(
            action="cancel", file=self.file, test=test.name, who=self._who.value or "", why=" ".join(why.split())
        )
        return self._write(entry, test.last, f"{test.name} is cancelled; its readings are kept.")

    def undo(self, test: ReplayedTest) -> bool:
        """Store that the last entry was not meant."""
        last = test.undoable
        if last is None:
            self.say("There is nothing to undo.", "bad")
            return False
        entry = NewEntry(action="undo", file=self.file, test=test.name, about=last.sequence, who=self._who.value or "")
        return self._write(entry, test.last, "Undone.")

    def say(self, text: str, kind: str = "good", items: Sequence[str] = ()) -> None:
        """Show the outcome of the last action; ``items``: problems in the language of the page."""
        self._status.say(in_words(text), kind, items)

    def _write(self, entry: NewEntry, seen: int, said: str) -> bool:
        try:
            self.session.write_down(entry, seen=seen)
        except OvertakenError as error:
            self.session.refresh()
            self.say(str(error), "bad")
            return False
        except (StoreError, ParameterError) as error:
            self.say(str(error), "bad")
            return False
        self.say(said)
        return True


MOST: Final = 40


class SeriesList:
    """The list below the form of a series."""

    def __init__(self, view: TableView) -> None:
        self._view = view
        self._place = ui.element("div")
        self._drawn: tuple[str, list[tuple[str, bool]]] = ("", [])

    def show(self, current: str) -> None:
        """Draw the list again if a series or its state is new; ``current``: name of the series in the form."""
        tests = [(test.name, bool(test.cancelled)) for test in self._view.tests()[-MOST:]]
        if self._drawn == (current, tests):
            return
        self._drawn = current, tests
        self._place.clear()
        if not tests:
            return
        with self._place:
            heading("Series so far", 3)
            with ui.element("div").classes("acts so-far"):
                for name, cancelled in reversed(tests):
                    address = entering(self._view.session.id, table=self._view.file, test=name)
                    made = link(f"{name}{' (cancelled)' if cancelled else ''}", address, "small")
                    if name == current:
                        made.props('aria-current="page"')
