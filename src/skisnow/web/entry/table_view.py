"""One table of a campaign on a page: writer, status, entries, links to tables and series, live results."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, Final

from nicegui import background_tasks, run, ui

from ..._support.errors import FieldDataError, SkisnowError, StoreError
from ..._support.messages import Message
from ..._support.user_files.text_files import natural_number
from ...campaign import QUALITY_FLAGS
from ...campaign.reading.table_forms import PENETRATION, SHEAR, TableForm
from ...campaign.store import NewEntry, OvertakenError, Reading, ReplayedTest
from ...campaign.store.journal import Action
from ...campaign.store.stored_tables import FORMS
from ...report.charts import SeriesCurve
from ...report.formatting import significant
from ..edit_session import EditSession, QuickResults, TestKey
from ..elements import StatusLine, Words, add_items, choice, error_sentence, field, heading, link, named
from ..page_requests import asking_button, current_request, entry_address
from ..widgets import BEHIND, ChartLine, LineChart
from ..words import TABLES, in_words, label, minute_words, number_text, result_words, said

WHO: Final = Message("Operator")
CORRECTED: Final = Message("Corrected; the first reading is kept.")


class TableView:
    """Form, status, changes and live results of a table; `form`, `below`: names of sections for screen readers."""

    def __init__(self, session: EditSession, file: str, *, form: str, below: str) -> None:
        self.session = session
        self.file = file
        self.form: TableForm = FORMS[file]
        self.entry_list: EntryList | None = None
        self._who = _writer_field(session)
        self._status = StatusLine()
        with ui.element("div").classes("two"):
            self.form_place = named(ui.element("section"), form)
            self.live_results = LiveResults(self)
            with named(ui.element("section").classes("below"), below) as self.below:
                self.changes_place = ui.element("div")

    def clear(self) -> None:
        """Remove the elements of the form and of the changes from the page."""
        self.form_place.clear()
        self.changes_place.clear()

    def test(self, name: str) -> ReplayedTest:
        """A test of the table by its name, as of the last reading of the journal; an empty one if there is none."""
        return self.session.test(self.file, name)

    def label(self, column: str) -> str:
        """Label of a column with the unit in which this campaign's file has it."""
        return label(column, unit=self.session.unit(self.file, column))

    @property
    def writer(self) -> str:
        """Name of the operator in the page's field, who writes the entries."""
        return str(self._who.value or "")

    def tests(self) -> list[ReplayedTest]:
        """All tests of the table, in the order of entry."""
        return self.session.campaign.of_file(self.file)

    def next_name(self) -> str:
        """Name for a new test: the number after the largest one among the names of the tests."""
        numbers = (natural_number(test.name) for test in self.tests())
        return str(max((number for number in numbers if number is not None), default=0) + 1)

    def add(self, test: ReplayedTest, cells: Mapping[str, str], *, position: int, said: str) -> bool:
        """Store a new row of a test and show `said`; True if it is stored, now or by an earlier equal request."""
        once = current_request().once
        return self.write(self._make_entry("add", test, cells=cells, position=position, once=once), test.last, said)

    def stored_before(self) -> str | None:
        """Name of the test that an earlier request with the same key stored; None without one."""
        once = current_request().once
        sent = (entry for test in self.tests() for entry in test.history if once is not None and entry.once == once)
        return next((entry.test for entry in sent), None)

    def correct(
        self, test: ReplayedTest, row: int, cells: Mapping[str, str], why: str, *, said: str = CORRECTED
    ) -> bool:
        """Store corrected cells of a row, given by its entry's sequence, with a reason; True if they are stored."""
        if not why.strip():
            self.say(Message("A correction needs a reason."), "bad")
            return False
        entry = self._make_entry("correct", test, about=row, cells=cells, why=why.strip())
        return self.write(entry, test.last, said)

    def cancel(self, test: ReplayedTest, why: str) -> bool:
        """Store the cancellation of a test with its reason; True if it is stored."""
        if not why.strip():
            self.say(Message("A test is cancelled with a reason."), "bad")
            return False
        entry = self._make_entry("cancel", test, why=" ".join(why.split()))
        return self.write(entry, test.last, Message("{name} is cancelled; its readings are kept.", name=test.name))

    def undo(self, test: ReplayedTest) -> bool:
        """Store the undo of the last entry about a test; True if it is stored."""
        if test.undoable is None:
            self.say(Message("There is nothing to undo."), "bad")
            return False
        entry = self._make_entry("undo", test, about=test.undoable.sequence)
        return self.write(entry, test.last, Message("Undone."))

    def say(self, text: str, kind: str = "good", items: Sequence[str] = ()) -> None:
        """Show the outcome of the last action; ``items``: problems in the language of the page."""
        self._status.say(in_words(text), kind, items)

    def _make_entry(self, action: Action, test: ReplayedTest, **fields: Any) -> NewEntry:
        """New entry of an action for a test of this table by the present writer."""
        return NewEntry(action=action, file=self.file, test=test.name, who=self.writer, **fields)

    def write(self, entry: NewEntry, seen: int, said: str) -> bool:
        """Store an entry and show ``said``, or why it is rejected; True if it is stored."""
        try:
            self.session.write_down(entry, seen=seen)
        except SkisnowError as error:
            if isinstance(error, OvertakenError):
                self.session.refresh()
            self.say(error.message, "bad")
            return False
        self.say(said)
        return True


MOST: Final = 40


class EntryList:
    """List of the tests of a table by site, below the form: angle, result, flags, writer and time.

    A line of a penetration test is a link; one of another table is a row, which ``open_row`` shows by its entry.
    """

    def __init__(self, view: TableView) -> None:
        self._view = view
        self._place = ui.element("div")
        self.current = ""
        self.open_row: Callable[[str, str], bool] | None = None
        self._results: dict[str, tuple[str, list[str]]] = {}
        """Result in short and codes of the flags by test."""
        self._drawn: object = None
        if view.file in RESULTS:
            background_tasks.create(self._load(), name="list", context=self._place.client)

    async def _load(self) -> None:
        """Compute the results of each site and add them to the list."""
        for site in dict.fromkeys(test.rows[0].cells["site"] for test in self._shown_tests()):
            try:
                results = await run.io_bound(self._view.session.quick_results, site)
            except (FieldDataError, StoreError):  # the form shows the error
                continue
            if results is None or self._place.is_deleted:  # the server ends, or the page was left
                return
            self.take(results)

    def take(self, results: QuickResults) -> None:
        """Add the results of a site to the lines of its tests."""
        symbol, column = RESULTS.get(self._view.file, ("", ""))
        for (file, name), row in results.experiments.items():
            if file == self._view.file and column:
                value = row[column]
                short = f"{symbol} {significant(value)}" if value is not None else ""
                self._results[name] = short, list(results.flags.get((file, name), {}))
        self.show(self.current)

    def _shown_tests(self) -> list[ReplayedTest]:
        """Last tests of the table that have rows, up to the maximum number."""
        return [test for test in self._view.tests()[-MOST:] if test.rows]

    def show(self, current: str) -> None:
        """Draw the list again if a test is new or changed; ``current``: name of the test in the form."""
        self.current = current
        lines = [
            (test.name, row.cells["site"], str(row.entered.sequence), *self._words(test, row))
            for test in reversed(self._shown_tests())
            for row in (reversed(test.rows) if self.open_row else test.rows[:1])
        ]
        if self._drawn == (current, lines):
            return
        self._drawn = current, lines
        self._place.clear()
        if not lines:
            return
        with self._place:
            heading(Message("So far") if self.open_row else Message("Series so far"), 3)
            for site in dict.fromkeys(line[1] for line in lines):
                heading(site, 4)
                with ui.element("ul").classes("so-far"):
                    for name, _, row, text, about in (line for line in lines if line[1] == site):
                        with ui.element("li"):
                            self._add_item(name, row, text, about)

    def _add_item(self, name: str, row: str, text: str, about: str) -> None:
        """Add an item that opens a row of a test; the current test is marked."""
        made: ui.element
        if (open_row := self.open_row) is not None:
            made = asking_button(text, lambda: open_row(name, row), "small")
        else:
            made = link(text, entry_address(self._view.session.id, table=self._view.file, test=name), "small")
        if name == self.current:
            made.props('aria-current="page"')
        Words(about).classes("quiet")

    def _words(self, test: ReplayedTest, row: Reading) -> tuple[str, str]:
        """Text of the link, such as "2 · 45°"; then result, measured value of one row, writer, time and flags."""
        value, flags = self._results.get(test.name, ("", []))
        angle, repeat = (row.cells.get(key, "") for key in ("edge_angle_deg", "repeat"))
        words = f"{test.name} · {number_text(angle)}°" if angle else test.name
        words += f" · {said(label('repeat'))} {repeat}" if repeat else ""
        measured = [column.name for column in self._view.form.numbers if column.needed][-1]
        read = f"{said(self._view.label(measured))} {number_text(row.cells[measured])}" if self.open_row else ""
        last = test.history[-1]
        marks = (said(QUALITY_FLAGS[flag].name) for flag in flags)
        about = " · ".join(filter(None, (value, read, last.who, minute_words(last.at), *marks)))
        return Message("{words} (cancelled)", words=words) if test.cancelled else words, about


RESULTS: Final = {PENETRATION.file: ("H_V", "H_V_N_per_mm3"), SHEAR.file: ("S_f", "S_f_N_per_mm2")}
"""Symbol and key in results.json of the result of a test, by table."""


def table_links(tables: Mapping[str, str], here: str, further: Mapping[Message, str]) -> None:
    """Add links to the tables (addresses by file) and to further pages of the campaign (addresses by name)."""
    with named(ui.element("nav").classes("tables"), Message("Kind of test")):
        for file, address in tables.items():
            made = ui.link(said(TABLES[file]), address)
            if file == here:
                made.props('aria-current="page"')
        for name, address in further.items():
            ui.link(said(name), address)


def _writer_field(session: EditSession) -> ui.select | ui.input:
    """Add the field for the operator: a menu of the campaign's observers, or a text field."""
    observers = list(session.described.observers)
    with ui.element("div").classes("who") as place:
        made = choice(WHO, observers, observers[0]) if observers else field(WHO)

    def tell() -> None:
        place.props["data-who"] = str(made.value or "")

    made.on_value_change(tell)
    tell()
    return made


MISSING_YET: Final = frozenset({"too_few_loads"})  # flags of a series that is still being read


class LiveResults:
    """Results of one test next to its form, updated with each reading."""

    def __init__(self, view: TableView) -> None:
        self._view = view
        self._wanted: tuple[str, str, frozenset[str]] | None = None
        self._working = False
        is_pressed = view.file == PENETRATION.file
        classes = "beside" if is_pressed else "beside above"
        with named(ui.element("section").classes(classes), Message("Results of the readings")):
            self._name = Words("").classes("quiet")
            self._measured_value = Words("").classes("value").props("role=status")
            self._verdicts = ui.element("ul").classes("verdicts")
            self._marks = ui.element("ul").classes("marks")
            self._chart: LineChart | None = None
            if is_pressed:
                words = Message("Load against depth of this series and the others of its site, load in N")
                self._chart = LineChart(label("depth_mm"), label("load_N"), words, height=340)

    def follow(self, name: str, site: str, *, in_progress: bool = False) -> None:
        """Compute and show the newest results of a test; `in_progress`: flags about missing readings are not shown."""
        self._wanted = (name, site, MISSING_YET if in_progress else frozenset())
        if not self._working:
            self._working = True
            background_tasks.create(self._compute_requests(), name="beside", context=self._name.client)

    async def _compute_requests(self) -> None:
        """Compute the wanted results, newest request only, and show them until none is wanted."""
        try:
            while self._wanted is not None:
                (name, site, unsaid), self._wanted = self._wanted, None
                try:
                    results = await run.io_bound(self._view.session.quick_results, site)
                except (FieldDataError, StoreError) as error:
                    self._measured_value.set_text(error_sentence(error))
                    continue
                if self._marks.is_deleted:  # the page was left meanwhile
                    return
                # another may have been wanted while this one was waited for
                if self._wanted is None and results is not None:  # type: ignore[redundant-expr]
                    self._show(name, results, unsaid)
                    await self._compare_sites()
        finally:
            self._working = False

    async def _compare_sites(self) -> None:
        """Show the verdicts over the whole campaign; none while another of its tests has an error."""
        try:
            verdicts = await run.io_bound(self._view.session.quick_verdicts, self._view.file) or []
        except (FieldDataError, StoreError):
            verdicts = []
        if self._verdicts.is_deleted:
            return
        self._verdicts.clear()
        with self._verdicts:
            add_items(verdicts)

    def _show(self, name: str, results: QuickResults, unsaid: frozenset[str]) -> None:
        """Show results, flags and chart of a test; flags with a code in `unsaid` are left out."""
        key = self._view.file, name
        if self._view.entry_list is not None:
            self._view.entry_list.take(results)
        row = results.experiments.get(key)
        self._name.set_text(Message("Test {name}", name=name) if row else "")
        self._measured_value.set_text("" if row is None else result_words(row))
        self._marks.clear()
        with self._marks:
            flags = results.flags.get(key, {})
            add_items(in_words(sentence) for code, sentence in flags.items() if code not in unsaid)
        if self._chart is not None:
            self._chart.show(list(_lines(key, results.curves)), from_zero="xy")


def _lines(key: TestKey, curves: dict[TestKey, SeriesCurve]) -> Iterator[ChartLine]:
    """Lines of a chart: readings and law of a series, and of all other series of its site together."""
    others = [curve for other, curve in curves.items() if other != key]
    own = [curves[key]] if key in curves else []
    for chosen, style in ((others, BEHIND), (own, 0)):
        if chosen:
            points = [(curve.depth_mm, curve.load_N) for curve in chosen]
            laws = [((*curve.law_depth_mm, None), (*curve.law_load_N, None)) for curve in chosen]
            yield ChartLine(*_join_curves(points), style, points=True)
            yield ChartLine(*_join_curves(laws), style)


def _join_curves(
    pairs: Iterable[tuple[Iterable[float | None], Iterable[float | None]]],
) -> tuple[list[float | None], list[float | None]]:
    """All x and all y of several curves (x, y), one curve after the other."""
    x, y = zip(*pairs, strict=True)
    return list(chain.from_iterable(x)), list(chain.from_iterable(y))
