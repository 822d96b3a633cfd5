"""A penetration series: site, tool and angle once, then a depth under each load of the campaign's discs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from nicegui import ui

from ...errors import ParameterError
from ...field.store.cells import checked_cell
from ..fields import button, choice, field
from ..layout import heading, sentence
from ..names import entering
from ..words import label
from .changes import USUAL_REASON, Places, ask_reason, changes

if TYPE_CHECKING:
    from ...field.store import GrownTest
    from .beside import Beside
    from .sheet import Sheet

HEAD: Final = ("experiment", "site", "spot", "tool", "edge_angle_deg")
ON_TO_THE_NEXT: Final = """(event) => {
  const fields = [...event.target.closest('.readings').querySelectorAll('input')];
  const next = fields.slice(fields.indexOf(event.target) + 1).find((field) => !field.value);
  emit();
  if (next) next.focus();
}"""
"""In the browser, so that what is typed on at once goes into the next field and never into none."""


class SeriesForm:
    """The form of one series at a time."""

    def __init__(self, sheet: Sheet, beside: Beside, places: Places) -> None:
        self._sheet = sheet
        self._beside = beside
        self._places = places
        self._head: dict[str, str] = {}
        self._fields: list[ui.input] = []
        self._stored: list[ui.label] = []
        self._asking: tuple[int, str] | None = None

    # The head of a series

    def begin(self) -> None:
        """Ask for what a series has once."""
        ui.navigate.history.replace(entering(self._sheet.desk.id, table=self._sheet.file))
        described = self._sheet.desk.described
        before = self._sheet.tests()[-1].rows[0].cells if self._sheet.tests() else {}
        self._places.clear()
        with self._places.form:
            heading("New series")
            with ui.element("div").classes("fields"):
                name = field(label("experiment"), self._sheet.next_name())
                site = field(label("site"), before.get("site", ""))
                tools = sorted(described.tools)
                tool = choice(label("tool"), tools, before.get("tool", tools[0] if tools else None))
                angle = field(label("edge_angle_deg"), before.get("edge_angle_deg", ""), numeric=True)
                spot = field(label("spot") + ", if shear is tested there too")
            typed = {"experiment": name, "site": site, "spot": spot, "tool": tool, "edge_angle_deg": angle}

            def done() -> None:
                self._begun({column: str(each.value or "") for column, each in typed.items()})

            for each in (name, site, angle, spot):
                each.on("keydown.enter", done)
            button("Begin the series", done, "main")
        (angle if site.value else site).run_method("focus")

    def _begun(self, typed: dict[str, str]) -> None:
        try:
            head = {column: checked_cell(self._sheet.form, column, typed[column]) for column in HEAD}
            if self._sheet.test(head["experiment"]).history:
                raise ParameterError(f"there is a test {head['experiment']} already; give this one another name")
        except ParameterError as error:
            self._sheet.say(f"{error}.", "bad")
            return
        self._sheet.say(f"Series {head['experiment']}: enter the depth under each load.")
        self.show(head["experiment"], head)

    # The readings

    def show(self, name: str, head: dict[str, str] | None = None) -> None:
        """Show a series with its readings, to be gone on with."""
        test = self._sheet.test(name)
        if head is None:
            head = {column: test.rows[0].cells.get(column, "") for column in HEAD}
        self._head = head
        ui.navigate.history.replace(entering(self._sheet.desk.id, table=self._sheet.file, test=name))
        self._draw(test)
        empty = [each for each in self._fields if not each.value]
        if empty and not test.cancelled:
            empty[0].run_method("focus")
        if test.rows:
            self._beside.follow(name, head["site"])

    def _draw(self, test: GrownTest) -> None:
        head = self._head
        loads = self._loads(test)
        self._fields, self._stored, self._asking = [], [], None
        self._places.clear()
        with self._places.form:
            heading(f"Series {test.name}")
            sentence(f"{head['site']} · {head['tool']} · {head['edge_angle_deg']}°", "quiet")
            if test.cancelled:
                sentence(f"Cancelled: {test.cancelled}", "bad")
            with ui.element("div").classes("readings"):
                for position, load in enumerate(loads):
                    self._reading(test, position, load)
            self._ask = ui.element("div")
            button("Next series", self.begin, "main")
        with self._places.below:
            self._changes = ui.element("div")
            self._further(test, len(loads))
        self._show_changes()

    def _show_changes(self) -> None:
        """Undo, cancel and history as they are now; the fields of the readings stay as they are."""
        test = self._sheet.test(self._head["experiment"])
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

    def _reading(self, test: GrownTest, position: int, load: str) -> None:
        row = test.row_at(position)
        with ui.element("div").classes("reading"):
            ui.label(f"{load} N").classes("load")
            depth = field(label("depth_mm"), row.cells["depth_mm"] if row else "", numeric=True)
            depth.props(f'aria-label="Depth under {load} N (mm)"')
            depth.props("readonly" if test.cancelled else "")
            stored = ui.label("stored" if row else "").classes("stored")
            if row is not None and row.corrections:
                stored.set_text(f"corrected from {row.entered.cells['depth_mm']}")
        self._fields.append(depth)
        self._stored.append(stored)
        depth.on("keydown.enter", lambda: self._entered(position, load), js_handler=ON_TO_THE_NEXT)
        depth.on("blur", lambda: self._entered(position, load))

    def _further(self, test: GrownTest, position: int) -> None:
        if test.cancelled:
            return
        with ui.element("details"):
            with ui.element("summary"):
                ui.label("A load that is not in the disc set")
            with ui.element("div").classes("fields"):
                load = field("Further load (N)", numeric=True)
                depth = field("Its depth (mm)", numeric=True)

                def done() -> None:
                    if self._add(position, str(load.value or ""), str(depth.value or "")):
                        self.show(self._head["experiment"], self._head)

                depth.on("keydown.enter", done)
                button("Store it", done)

    def _entered(self, position: int, load: str) -> None:
        """Take a depth: the first one is stored, another one is a correction."""
        test = self._sheet.test(self._head["experiment"])
        row, typed = test.row_at(position), str(self._fields[position].value or "").strip()
        if typed == (row.cells["depth_mm"] if row is not None else ""):
            return
        if row is not None:
            self._ask_correction(test, position, typed)
        elif self._add(position, load, typed):
            self._stored[position].set_text("stored")
            self._fields[position].set_value(self._sheet.test(test.name).rows[-1].cells["depth_mm"])

    def _add(self, position: int, load: str, typed: str) -> bool:
        test = self._sheet.test(self._head["experiment"])
        try:
            form = self._sheet.form
            cells = {**self._head, "load_N": checked_cell(form, "load_N", load)}
            cells["depth_mm"] = checked_cell(form, "depth_mm", typed)
        except ParameterError as error:
            self._sheet.say(f"Not stored: {error}.", "bad")
            return False
        said = f"Stored: {cells['depth_mm']} mm under {cells['load_N']} N."
        stored = self._sheet.add(test.name, cells, position=position, seen=test.last, said=said)
        if stored:
            self._show_changes()
            self._beside.follow(test.name, self._head["site"])
        else:
            self.show_again()
        return stored

    def show_again(self) -> None:
        """Draw the series as it is now, keeping what is typed but not yet stored."""
        typed = [each.value for each in self._fields]
        test = self._sheet.test(self._head["experiment"])
        self._draw(test)
        for position, (each, value) in enumerate(zip(self._fields, typed, strict=False)):
            if value and test.row_at(position) is None:
                each.set_value(value)

    def _ask_correction(self, test: GrownTest, position: int, typed: str) -> None:
        row = test.row_at(position)
        assert row is not None
        entered = row.entered
        try:
            new = checked_cell(self._sheet.form, "depth_mm", typed)
        except ParameterError as error:
            self._sheet.say(f"Not stored: {error}.", "bad")
            return

        def correct(why: str) -> None:
            if self._sheet.correct(test, entered.sequence, {"depth_mm": new}, why):
                self.show(test.name, self._head)

        if self._asking == (position, new):  # Enter, and then the field was left: one question is enough
            return
        self._asking = (position, new)
        words = f"{row.cells['load_N']} N: {row.cells['depth_mm']} mm becomes {new} mm."
        ask_reason(self._ask, words, ("Correct it", correct), usual=USUAL_REASON, leave=self.show_again)
