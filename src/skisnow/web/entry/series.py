"""A penetration series: site, tool and angle once, then a depth under each load of the campaign's discs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ..answering import answering, asking_button, form
from ..fields import choice, field
from ..layout import heading, sentence
from ..names import entering
from ..words import label
from .changes import USUAL_REASON, Places, ask_reason, changes
from .checking import Field, checked_fields, faults, refuse

if TYPE_CHECKING:
    from ...field.store import GrownTest
    from .beside import Beside
    from .sheet import Sheet

HEAD: Final = ("experiment", "site", "spot", "tool", "edge_angle_deg")
TOLD: Final = "(event) => lab.reading(event, emit)"


class SeriesForm:
    """The form of one series at a time."""

    def __init__(self, sheet: Sheet, beside: Beside, places: Places) -> None:
        self._sheet = sheet
        self._beside = beside
        self._places = places
        self._head: dict[str, str] = {}
        self._fields: list[ui.input] = []
        self._stored: list[ui.label] = []
        self._rows: list[ui.element] = []
        self._asking: tuple[int, str] | None = None
        self._shown = ""

    # The head of a series

    def begin(self) -> None:
        """Ask for what a series has once."""
        ui.navigate.history.replace(entering(self._sheet.desk.id, table=self._sheet.file))
        self._shown = ""
        described = self._sheet.desk.described
        before = self._sheet.tests()[-1].rows[0].cells if self._sheet.tests() else {}
        self._places.clear()
        with self._places.form:
            heading("New series")
            with form(sends=lambda: self._begun(typed)):
                name = field(label("experiment"), self._sheet.next_name())
                site = field(label("site"), before.get("site", ""))
                tools = sorted(described.tools)
                tool = choice(label("tool"), tools, before.get("tool", tools[0] if tools else None))
                angle = field(label("edge_angle_deg"), before.get("edge_angle_deg", ""), numeric=True)
                spot = field(label("spot") + ", if shear is tested there too", optional=True)
            typed: dict[str, Field] = dict(zip(HEAD, (name, site, spot, tool, angle), strict=True))
            asking_button("Begin the series", lambda: self._begun(typed), "main")
        first = angle if site.value else site
        first.run_method("focus")
        first.run_method("select")  # what stands there from the last series is written over

    def _begun(self, typed: dict[str, Field]) -> bool:
        head = checked_fields(self._sheet.form, typed)
        if head is not None and self._sheet.test(head["experiment"]).history:
            refuse(typed["experiment"], f"there is a test {head['experiment']} already; give this one another name")
            head = None
        if head is None:
            self._sheet.say(f"Not begun: {'; '.join(faults(typed.values()))}.", "bad")
            return False
        self._sheet.say(f"Series {head['experiment']}: enter the depth under each load.")
        self.show(head["experiment"], head)
        return True

    # The readings

    def show(self, name: str, head: dict[str, str] | None = None) -> None:
        """Show a series with its readings, to be gone on with."""
        test = self._sheet.test(name)
        if head is None:
            head = {column: test.rows[0].cells.get(column, "") for column in HEAD}
        self._head = head
        ui.navigate.history.replace(entering(self._sheet.desk.id, table=self._sheet.file, test=name))
        self._draw(test)
        self._focus_next(test)
        if test.rows:
            self._beside.follow(name, head["site"])

    def _focus_next(self, test: GrownTest) -> None:
        empty = [each for each in self._fields if not each.value]
        if empty and not test.cancelled:
            empty[0].run_method("focus")
        else:
            self._then.client.run_javascript(f"getHtmlElement({self._then.id}).focus()")  # a button knows no method

    def _draw(self, test: GrownTest) -> None:
        """Draw the series; what is typed and not stored stays."""
        unstored = self._unstored() if self._shown == test.name else {}
        self._shown = test.name
        self._fields, self._stored, self._rows, self._asking = [], [], [], None
        self._places.clear()
        loads = self._loads(test)
        with self._places.form:
            heading(f"Series {test.name}")
            sentence(f"{self._head['site']} · {self._head['tool']} · {self._head['edge_angle_deg']}°", "quiet")
            if test.cancelled:
                sentence(f"Cancelled: {test.cancelled}", "bad")
            with ui.element("div").classes("readings"):
                for position, load in enumerate(loads):
                    self._reading(test, position, load, unstored.get(position, ""))
            self._ask = ui.element("div")
            self._then = asking_button("Next series", self._next, "main then")
        with self._places.below:
            self._changes = ui.element("div")
            self._further(test, len(loads))
        self._show_changes()

    def _unstored(self) -> dict[int, str]:
        """What is typed in fields whose reading is not stored, by position."""
        shown = zip(self._fields, self._stored, strict=True)
        return {place: each.value for place, (each, stored) in enumerate(shown) if each.value and not stored.text}

    def _next(self) -> bool:
        """Begin the next series, where all that is typed in this one is stored."""
        missing = self._unstored()
        if missing:
            loads = ", ".join(f"{self._loads(self._test)[position]} N" for position in missing)
            self._sheet.say(f"Not stored yet: {loads}. Put it right or empty the field, then go on.", "bad")
            self._fields[min(missing)].run_method("focus")
            return False
        self.begin()
        return True

    @property
    def _test(self) -> GrownTest:
        return self._sheet.test(self._head["experiment"])

    def _show_changes(self) -> None:
        """Undo, cancel and history as they are now; the fields of the readings stay as they are."""
        test = self._test
        self._changes.clear()
        with self._changes:
            changes(self._sheet, test, self._ask, lambda: self.show(test.name, self._head))

    def _loads(self, test: GrownTest) -> list[str]:
        """The disc set's loads, and those that were entered beyond or instead of them."""
        loads = [f"{load:g}" for load in self._sheet.desk.described.load_steps]
        for row in test.rows:
            position = row.entered.position or 0
            loads += [""] * (position + 1 - len(loads))
            loads[position] = row.cells["load_N"]
        return loads

    def _reading(self, test: GrownTest, position: int, load: str, typed: str) -> None:
        row = test.row_at(position)
        with ui.element("div").classes("reading") as made:
            ui.label(f"{load} N").classes("load")
            depth = field(label("depth_mm"), row.cells["depth_mm"] if row else typed, numeric=True)
            depth.props(f'aria-label="Depth under {load} N (mm)"')
            depth.props("readonly" if test.cancelled else "")
            stored = ui.label("stored" if row else "").classes("stored")
            if row is not None:
                made.props["data-stored"] = row.cells["depth_mm"]
            if row is not None and row.corrections:
                stored.set_text(f"corrected from {row.entered.cells['depth_mm']}")
        self._fields.append(depth)
        self._stored.append(stored)
        self._rows.append(made)
        depth.on("keydown.enter", answering(lambda: self._entered(position, load)), js_handler=TOLD)
        depth.on("blur", lambda: self._entered(position, load, left=True))

    def _further(self, test: GrownTest, position: int) -> None:
        if test.cancelled:
            return

        def done() -> bool:
            if not self._add(position, load, depth):
                return False
            self.show(self._head["experiment"], self._head)
            return True

        with ui.element("details"):
            with ui.element("summary"):
                ui.label("A load that is not in the disc set")
            with form(sends=done):
                load = field("Further load (N)", numeric=True)
                depth = field("Its depth (mm)", numeric=True)
                asking_button("Store it", done)

    def _entered(self, position: int, load: str, *, left: bool = False) -> bool:
        """Take a depth: the first one is stored, another one is a correction; ``left``: its field is left already."""
        test, made = self._test, self._fields[position]
        row, typed = test.row_at(position), str(made.value or "").strip()
        if typed == (row.cells["depth_mm"] if row is not None else ""):
            self._rows[position].classes(remove="refused")
            return True
        if row is not None:
            return self._ask_correction(test, position, focus=not left)
        stored = self._add(position, load, made)
        if stored:
            cell = self._test.rows[-1].cells["depth_mm"]
            self._stored[position].set_text("stored")
            self._rows[position].props["data-stored"] = cell
            self._rows[position].classes(remove="refused")
            made.set_value(cell)
        elif self._fields[position] is made:  # the series was not drawn anew meanwhile
            self._rows[position].classes("refused")
        return stored

    def _add(self, position: int, load: ui.input | str, depth: ui.input) -> bool:
        """Store a reading; what cannot be is said at its field, and stays there."""
        test = self._test
        given = {"depth_mm": depth} if isinstance(load, str) else {"load_N": load, "depth_mm": depth}
        cells = checked_fields(self._sheet.form, given)
        if cells is None:
            self._sheet.say(f"Not stored: {'; '.join(faults(given.values()))}.", "bad")
            return False
        cells = {**self._head, **({"load_N": load} if isinstance(load, str) else {}), **cells}
        said = f"Stored: {cells['depth_mm']} mm under {cells['load_N']} N."
        stored = self._sheet.add(test.name, cells, position=position, seen=test.last, said=said)
        if stored:
            self._show_changes()
            self._beside.follow(test.name, self._head["site"])
        else:
            self._draw(self._test)
        return stored

    def _ask_correction(self, test: GrownTest, position: int, *, focus: bool) -> bool:
        row = test.row_at(position)
        assert row is not None
        entered = row.entered
        cells = checked_fields(self._sheet.form, {"depth_mm": self._fields[position]})
        if cells is None:
            self._sheet.say(f"Not corrected: {'; '.join(faults([self._fields[position]]))}.", "bad")
            return False

        def correct(why: str) -> bool:
            if not self._sheet.correct(test, entered.sequence, cells, why):
                return False
            self.show(test.name, self._head)
            return True

        if self._asking == (position, cells["depth_mm"]):  # Enter, and then the field was left: one question is enough
            return True
        self._asking = (position, cells["depth_mm"])
        words = f"{row.cells['load_N']} N: {row.cells['depth_mm']} mm becomes {cells['depth_mm']} mm."
        act = ("Correct it", correct)
        ask_reason(
            self._ask, words, act, usual=USUAL_REASON, leave=lambda: self.show(test.name, self._head), focus=focus
        )
        return True
