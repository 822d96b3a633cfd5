"""Form of a penetration series: site, tool and angle, then a depth under each load of the discs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Final

from nicegui import ui

from ..._support.messages import Message
from ...campaign.reading.table_forms import BRANCH, UNLOADING
from ...campaign.store import ReplayedTest
from ..elements import button, choice, field, folded, heading, sentence
from ..page_requests import asking_button, current_request, entry_address, event_handler, form
from ..words import label, number_text
from .changes import changes, focus_button
from .readings import HEAD, Field, ReadingField, Step, add_reading_field, checked_fields, faults, refuse
from .series_corrections import DepthsAfterWaiting, SeriesCorrections
from .table_view import EntryList, TableView

ON_ENTER: Final = "(event) => lab.reading(event, emit)"
ON_BLUR: Final = "(event) => lab.leaving(event, emit)"


class SeriesForm:
    """Form to enter a penetration series, one series at a time."""

    def __init__(self, view: TableView, entry_list: EntryList) -> None:
        self._view = view
        self._head: dict[str, str] = {}
        self._readings: dict[Step, ReadingField] = {}
        self._shown: str = ""
        self._corrections = SeriesCorrections(view, self._readings, lambda: self.show(self._shown, self._head))
        self._refused: dict[Step, str] = {}
        self._waiting: DepthsAfterWaiting | None = None
        self._list = entry_list

    # The head of a series

    def begin(self) -> None:
        """Show the form of a new series: name, site, measurement point, tool, edge angle."""
        ui.navigate.history.replace(entry_address(self._view.session.id, table=self._view.file))
        self._shown = ""
        self._list.show("")
        described = self._view.session.described
        before = self._view.tests()[-1].rows[0].cells if self._view.tests() else {}
        self._view.clear()
        with self._view.form_place:
            heading(Message("New series"))
            with form(sends=lambda: self._begin_series(typed)):
                name = field(label("experiment"), self._view.next_name())
                site = field(label("site"), before.get("site", ""))
                tools = sorted(described.tools)
                last = before.get("tool")
                tool = choice(label("tool"), tools, last if last in tools else next(iter(tools), None))
                angle = field(label("edge_angle_deg"), before.get("edge_angle_deg", ""), numeric=True)
                spot = field(Message("Measurement point, if sheared there"), optional=True)
            typed: dict[str, Field] = dict(zip(HEAD, (name, site, spot, tool, angle), strict=True))
            asking_button(Message("Begin the series"), lambda: self._begin_series(typed), "main")
        first = angle if site.value else site
        first.run_method("focus")
        first.run_method("select")  # typing replaces the value of the last series

    def _begin_series(self, typed: dict[str, Field]) -> bool:
        """Begin a series with the typed head; False, with the faults shown, if it is not valid or not new."""
        head = checked_fields(self._view.form, typed)
        if head is not None and self._view.test(name := head["experiment"]).history:
            words = Message("there is a test {experiment} already; give this one another name", experiment=name)
            refuse(typed["experiment"], words)
            head = None
        if head is None:
            self._view.say(Message("Not begun:"), "bad", faults(typed.values()))
            return False
        self._view.say(Message("Series {experiment}: enter the depth under each load.", experiment=head["experiment"]))
        self.show(head["experiment"], head)
        return True

    # The readings

    def show_offline_readings(self, series: set[str]) -> None:
        """Show the series again if the browser sent readings of it that were typed without a connection."""
        if self._shown in series:
            self.show(self._shown, self._head)
        self._list.show(self._shown)

    def show(self, name: str, head: dict[str, str] | None = None) -> None:
        """Show a series with the focus on its next empty field; ``head``: cells of its site, tool and so on, if new."""
        test = self._view.test(name)
        if head is None:
            head = {column: test.rows[0].cells.get(column, "") for column in HEAD}
        self._head = head
        begun = None if test.rows else {column: text for column, text in head.items() if column != "experiment"}
        ui.navigate.history.replace(entry_address(self._view.session.id, table=self._view.file, test=name, head=begun))
        self._draw(test)
        self._focus_next(test)
        if test.rows:
            self._view.live_results.follow(name, head["site"], in_progress=self._is_in_progress(name))

    def _is_in_progress(self, name: str) -> bool:
        """True if a series is the last one of the table, so that readings may still be missing."""
        return self._view.tests()[-1].name == name

    def _focus_next(self, test: ReplayedTest) -> None:
        """Put the focus on the first empty depth of the branch in progress, or on the next action."""
        back = any(row.cells.get(BRANCH) for row in test.rows)
        shown = self._readings.items()
        empty = [reading.depth for step, reading in shown if not reading.depth.value and (back or not step.branch)]
        if empty and not test.cancelled:
            empty[0].run_method("focus")
        else:
            focus_button(self._then)

    def _draw(self, test: ReplayedTest) -> None:
        """Draw the fields of a series; unstored texts stay in their fields."""
        unstored = self._unstored() if self._shown == test.name else {}
        waiting = self._waiting.unstored if self._waiting is not None and self._shown == test.name else {}
        self._shown = test.name
        self._readings.clear()
        self._refused = {}
        self._view.clear()
        with self._view.form_place:
            with ui.element("div").classes("series-head"):
                heading(Message("Series {name}", name=test.name))
                angle = number_text(self._head["edge_angle_deg"])
                sentence(f"{self._head['site']} · {self._head['tool']} · {angle}°", "quiet")
            if test.cancelled:
                sentence(Message("Cancelled: {cancelled}", cancelled=test.cancelled), "bad")
            steps_in_set = [f"{load:g}" for load in self._view.session.described.load_steps]
            further = [load for load in steps_in_set if test.row_under(load) is None]
            loads = sorted(dict.fromkeys([*(row.cells["load_N"] for row in test.rows), *further]), key=float)
            rising = [Step(load) for load in loads]
            self._draw_fields(test, rising, unstored)
            self._ask = ui.element("div")
            self._corrections.begin(test.name, self._ask)
            self._then = asking_button(Message("Next series"), self._next, "main then")
            button(Message("Loads in N or kg"), None, "small switch-kg")
            steps = [Step(load, UNLOADING) for load in loads[-2::-1]]
            if steps:
                begun = any(test.row_under(*step) or step in unstored for step in steps)
                with folded(Message("Discs taken off one by one"), is_open=begun):
                    self._draw_fields(test, steps, unstored)
            self._waiting = DepthsAfterWaiting(self._view, test.name, lambda: self.show(test.name, self._head))
            self._waiting.draw(rising, waiting, self._ask)
        with self._view.changes_place:
            self._changes = ui.element("div")
            self._draw_further_load(test)
        self._show_changes()
        self._corrections.ask_again()

    def _draw_fields(self, test: ReplayedTest, steps: Iterable[Step], unstored: Mapping[Step, str]) -> None:
        """Draw a depth field for each step; `unstored`: typed texts that are not stored yet."""
        with ui.element("div").classes("readings") as readings:
            readings.props["data-head"] = json.dumps(self._head)
            for step in steps:
                self._readings[step] = self._add_reading(test, step, unstored.get(step))

    def _unstored(self) -> dict[Step, str]:
        """Unstored texts of new and changed readings, by step."""
        test = self._test
        texts = {step: reading.unstored(test.row_under(*step)) for step, reading in self._readings.items()}
        return {step: text for step, text in texts.items() if text is not None}

    def _next(self) -> bool:
        """Show the form of the next series if all typed texts are stored; otherwise False, after a message."""
        missing = [step for step in self._unstored() if self._test.row_under(*step) is None]
        if missing:
            loads = [step.words for step in missing]
            self._view.say(
                Message("Not stored yet: {loads}. Correct it or empty the field, then continue.", loads=loads), "bad"
            )
            first = self._readings[missing[0]].depth
            first.run_method("focus")
            first.run_method("select")
            return False
        if self._corrections.is_unanswered():
            return False
        if self._waiting is not None and self._waiting.unstored:
            loads = [Message("{load} N after waiting", load=number_text(load)) for load, _ in self._waiting.unstored]
            self._view.say(
                Message("Not stored yet: {loads}. Store it or empty the field, then continue.", loads=loads), "bad"
            )
            self._waiting.focus()
            return False
        if self._test.rows:
            self._view.live_results.follow(self._shown, self._head["site"])
        self.begin()
        return True

    @property
    def _test(self) -> ReplayedTest:
        """Current state of the series."""
        return self._view.test(self._head["experiment"])

    def _show_changes(self) -> None:
        """Draw undo, cancel and history again, without the fields of the readings."""
        test = self._test
        self._changes.clear()
        with self._changes:
            show = partial(self.show, test.name, self._head)
            changes(self._view, test, self._ask, show, is_unanswered=self._corrections.is_unanswered)
        self._list.show(test.name)

    def _add_reading(self, test: ReplayedTest, step: Step, unstored: str | None) -> ReadingField:
        """Add the depth field of a step; it is read-only if the test was cancelled."""
        typed, closed = None if test.cancelled else unstored, bool(test.cancelled)
        made = add_reading_field(step, typed, lambda: self._test.row_under(*step), closed=closed)
        made.row.props["data-load"], made.row.props["data-branch"] = step
        made.depth.on("keydown.enter", event_handler(lambda: self._entered(step)), js_handler=ON_ENTER)
        made.depth.on("blur", event_handler(lambda: self._entered(step, left=True)), js_handler=ON_BLUR)
        return made

    def _draw_further_load(self, test: ReplayedTest) -> None:
        """Draw the folded form for a further load (N); nothing if the test was cancelled."""
        if test.cancelled:
            return

        def done() -> bool:
            if not self._add(load, depth):
                return False
            self.show(self._head["experiment"], self._head)
            return True

        with folded(Message("A load that is not in the disc set")), form(sends=done):
            load = field(Message("Further load (N)"), numeric=True)
            depth = field(Message("Its depth (mm)"), numeric=True)
            asking_button(Message("Store it"), done)

    def _entered(self, step: Step, *, left: bool = False) -> bool:
        """Store a step's first depth, or ask why it changed; False if rejected. left: the field lost the focus."""
        test, made = self._test, self._readings[step]
        if (sent := current_request().text) is not None and sent != str(made.depth.value or "").strip():
            made.depth.set_value(sent)  # the typed text was lost on its way, and is sent again
        row, typed = test.row_under(*step), made.typed
        if not made.differs(row):
            made.row.classes(remove="refused")
            self._refused.pop(step, None)
            self._corrections.drop(step)
            return True
        if left and typed == self._refused.get(step):  # shown at its Enter; by now the status may be another
            return False
        taken = self._corrections.ask(focus=not left) if row is not None else self._store(step, made)
        if not taken and self._readings.get(step) is made:  # the series was not drawn again meanwhile
            self._refused[step] = typed
        return taken

    def _store(self, step: Step, made: ReadingField) -> bool:
        """Store the first depth under a load and show its state; True if it is stored."""
        stored = self._add(step, made.depth)
        row = self._test.row_under(*step)
        if stored and row is not None:
            cell = row.cells["depth_mm"]
            made.row.props["data-stored"] = cell
            made.row.classes(remove="refused")
            made.restore(row)
            made.show_state(row)
        elif self._readings.get(step) is made:  # the series was not drawn again meanwhile
            made.row.classes("refused")
            made.depth.client.run_javascript(f"lab.refusedLast({made.depth.id})")
        return stored

    def _add(self, load: ui.input | Step, depth: ui.input) -> bool:
        """Store a reading; True if it is stored, otherwise the problem is shown at its field, whose text stays."""
        test = self._test
        fields = {"depth_mm": depth} if isinstance(load, Step) else {"load_N": load, "depth_mm": depth}
        cells = checked_fields(self._view.form, fields)
        if cells is not None and isinstance(load, Step) and load.branch and not test.rows:
            refuse(depth, Message("the depths under rising loads come first"))
            cells = None
        if cells is not None and not isinstance(load, Step) and test.row_under(cells["load_N"]) is not None:
            load_n = number_text(cells["load_N"])
            refuse(
                load, Message("there is a reading under {load_n} N already; correct it in its own field", load_n=load_n)
            )
            cells = None
        if cells is None:
            self._view.say(Message("Not stored:"), "bad", faults(fields.values()))
            return False
        step = load if isinstance(load, Step) else Step(cells["load_N"])
        branch = {BRANCH: step.branch} if step.branch else {}
        cells = {**self._head, "load_N": step.load, **cells, **branch}
        said = Message(
            "Stored: {depth_mm} mm under {words}.", depth_mm=number_text(cells["depth_mm"]), words=step.words
        )
        stored = self._view.add(test, cells, position=test.next_position, said=said)
        if stored:
            self._show_changes()
            self._view.live_results.follow(test.name, self._head["site"], in_progress=self._is_in_progress(test.name))
        else:
            self._draw(self._test)
        return stored
