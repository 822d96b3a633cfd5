"""Fields of readings: state, check of typed text, problems; and readings that were typed without a connection."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple, TypeAlias

from nicegui import ui
from nicegui.events import GenericEventArguments

from ..._support.errors import ParameterError, SkisnowError, StoreError
from ..._support.messages import Message
from ..._support.units import KILOGRAM_FORCE
from ...campaign.reading.headings import UnitConversion
from ...campaign.reading.table_forms import BRANCH, TableForm
from ...campaign.store import NewEntry, Reading
from ...campaign.store.stored_tables import FORMS, CellError, checked_cell
from ...report.formatting import significant
from ..edit_session import EditSession
from ..elements import Words, field, named
from ..page_requests import LONGEST
from ..words import in_words, label, number_text, plain_number, said

CHANGED: Final = Message("changed, not stored")
STORED: Final = Message("stored")


class Step(NamedTuple):
    """Load (N, as text) and branch of a reading, which identify it in a series; "" is the branch of rising loads."""

    load: str
    branch: str = ""

    @property
    def words(self) -> Message:
        """Load and branch in words, such as "50 N on the way back"."""
        load = number_text(self.load)
        return Message("{load} N on the way back", load=load) if self.branch else Message("{load} N", load=load)

    def field_name(self, column: str) -> Message:
        """Name for screen readers of the step's field for a column of depths."""
        load = number_text(self.load)
        if column == AFTER:
            return Message("Depth after waiting under {load} N (mm)", load=load)
        if self.branch:
            return Message("Depth back under {load} N (mm)", load=load)
        return Message("Depth under {load} N (mm)", load=load)


DEPTH: Final = "depth_mm"
AFTER: Final = "depth_after_mm"


@dataclass(frozen=True, slots=True, eq=False)
class ReadingField:
    """Field of a depth under one load, label of its state, the element around them, and the column of the depth."""

    depth: ui.input
    state: ui.label
    row: ui.element
    column: str

    @property
    def typed(self) -> str:
        """Stripped text in the field."""
        return str(self.depth.value or "").strip()

    def unstored(self, row: Reading | None) -> str | None:
        """Unstored text, to be kept when the field is drawn again; None if it is stored or the reading is a new one."""
        drawn = str(self.row.props.get("data-stored") or "")
        is_kept = is_other(self.typed, drawn) and self.differs(row) and (bool(drawn) or row is None)
        return self.typed if is_kept else None

    def differs(self, row: Reading | None) -> bool:
        """True if the text differs from the stored reading, or from "" without one."""
        return is_other(self.typed, stored_depth(row, self.column))

    def show_state(self, row: Reading | None) -> None:
        """Show whether the text in the field is stored; mark an unstored change."""
        stored = stored_depth(row, self.column)
        entered = stored if row is None else row.entered.cells.get(self.column, stored)
        is_changed = bool(stored) and self.differs(row)
        words = Message("corrected from {depth}", depth=number_text(entered)) if entered != stored else STORED
        self.state.set_text(CHANGED if is_changed else words if stored else "")
        self.state.classes(add="changed" if is_changed else "", remove="" if is_changed else "changed")

    def restore(self, row: Reading | None) -> None:
        """Put the stored depth back into the field."""
        self.depth.set_value(number_text(stored_depth(row, self.column), self.depth.client))


def add_reading_field(
    step: Step, typed: str | None, stored: Callable[[], Reading | None], *, column: str = DEPTH, closed: bool
) -> ReadingField:
    """Add a field of a depth with its load and state; lab.js shows the load in kg if the user wants this.

    typed: text of the field (default: the stored depth).
    stored: function that returns the current reading.
    closed: True if the text cannot be changed.
    """
    depth = stored_depth(stored(), column)
    with ui.element("div").classes("reading") as holder:
        in_kilograms = significant(float(step.load) / KILOGRAM_FORCE)
        Words(f"{number_text(step.load)} N").classes("load").props["data-kg"] = f"{in_kilograms} kg"
        text = number_text(depth) if typed is None else typed
        made = field(label(column), text, numeric=True, optional=column == AFTER)
        named(made, step.field_name(column)).props("readonly" if closed else "")
        reading = ReadingField(made, Words("").classes("stored"), holder, column)
        if depth:
            holder.props["data-stored"] = depth
    reading.show_state(stored())
    made.on_value_change(lambda: reading.show_state(stored()))
    return reading


def stored_depth(row: Reading | None, column: str = DEPTH) -> str:
    """Stored depth of a reading in a column (mm, as text); "" without a reading or depth."""
    return "" if row is None else row.cells.get(column, "")


def is_other(typed: str, stored: str) -> bool:
    """True if a typed text differs from the stored one; the decimal sign of a number does not matter.

    >>> is_other("2,25", "2.25"), is_other("", "2.25"), is_other("A, left", "A, left")
    (False, True, False)
    """
    return stored not in {typed.strip(), plain_number(typed)}


Field: TypeAlias = ui.input | ui.select


def checked_fields(
    form: TableForm, fields: Mapping[str, Field], *, conversions: Mapping[str, UnitConversion] | None = None
) -> dict[str, str] | None:
    """Checked texts by column, converted from the units of fields; None if one is rejected: its field shows why."""
    cells: dict[str, str] = {}
    units = conversions or {}
    for column, typed in fields.items():
        typed.error = None
        try:
            cells[column] = checked_cell(form, column, str(typed.value or ""), conversion=units.get(column))
        except CellError as error:
            name = typed.props.get("aria-label") or typed.props.get("label") or ""
            typed.error = error_text(error, name=str(name))
    return cells if len(cells) == len(fields) else None


def error_text(error: SkisnowError, *, name: str = "") -> str:
    """Text of an error in the language of the page; ``name`` of the field (default: the label of the column)."""
    if not isinstance(error, CellError):
        return f"{said(in_words(error.message)).rstrip('.')}."
    return said(error.problem(error.code, name or label(error.column)))


def refuse(field: Field, fault: str) -> None:
    """Show at a field why its text is rejected, until another text is typed."""
    field.error = said(in_words(fault))


def faults(fields: Iterable[Field]) -> list[str]:
    """The problem of each rejected field, in the language of the page."""
    return [field.error for field in fields if field.error]


FILE: Final = "penetration.csv"
HEAD: Final = ("experiment", "site", "spot", "tool", "edge_angle_deg")  # columns with one value for a series
READING: Final = ("load_N", "depth_mm", BRANCH)
MOST: Final = 10_000


def receive_offline_readings(session: EditSession, changed: Callable[[set[str]], object]) -> None:
    """Store readings that the browser kept offline, each once; `changed` is called with the names of their series."""
    client = ui.context.client

    def take(event: GenericEventArguments) -> None:
        records = event.args if isinstance(event.args, list) else []
        answers, series = [], set[str]()
        for record in records[:MOST]:
            sent = record.get("once") if isinstance(record, dict) else None
            once, refusal = sent if isinstance(sent, str) and len(sent) <= LONGEST else "", ""
            try:
                series.add(_stored(session, record, once))
            except (StoreError, ParameterError) as error:
                refusal = said(
                    Message(
                        "Not stored: {reading}: {problem}", reading=_reading_words(record), problem=error_text(error)
                    )
                )
            answers.append((once, refusal))
        changed(series)
        client.run_javascript(f"lab.resent({json.dumps(answers)})")

    ui.on("resent", take)


def _sent_cells(record: Any) -> dict[str, str]:
    """Cells of a reading that the browser sent, by column, without an empty branch; empty if it sent none."""
    said = record.get("cells") if isinstance(record, dict) else None
    if not isinstance(said, dict):
        return {}
    cells = {column: str(said.get(column) or "") for column in (*HEAD, *READING)}
    return cells if cells[BRANCH] else {column: text for column, text in cells.items() if column != BRANCH}


def _reading_words(record: Any) -> Message:
    """Message with depth, load and series of a reading that the browser sent."""
    cells = _sent_cells(record)
    if not cells:
        return Message("a reading")
    depth, load, series = number_text(cells["depth_mm"]), number_text(cells["load_N"]), cells["experiment"]
    return Message("{depth} mm under {load} N in series {series}", depth=depth, load=load, series=series)


def _stored(session: EditSession, record: Any, once: str) -> str:
    """Store a reading that the browser kept, with its key; returns the name of its series."""
    said = _sent_cells(record)
    if not once or not said:
        raise ParameterError("this is not a reading").tag("not_a_reading")
    cells = {column: checked_cell(FORMS[FILE], column, text) for column, text in said.items()}
    if cells["tool"] not in session.described.tools:
        raise ParameterError("the campaign has no tool {tool!r}").tag("unknown_name", tool=cells["tool"])
    test = session.test(FILE, cells["experiment"])
    there = test.row_under(cells["load_N"], cells.get(BRANCH, ""))
    if there is not None and there.entered.once != once:
        raise ParameterError("a reading of {depth_mm} mm is there already").tag(
            "already_there", depth_mm=there.cells["depth_mm"]
        )
    if test.rows and test.rows[0].cells["site"] != cells["site"]:
        raise ParameterError("that series is at the site {site}").tag("other_site", site=test.rows[0].cells["site"])
    who = str(record.get("who") or "")[:LONGEST]
    place = test.next_position
    entry = NewEntry(action="add", file=FILE, test=test.name, cells=cells, position=place, who=who, once=once)
    session.write_down(entry, seen=test.last)
    return test.name
