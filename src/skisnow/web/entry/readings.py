"""Fields of readings: state (stored, corrected, not stored), check of typed text, problems."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from nicegui import ui

from ...campaign.store.stored_tables import CellError, checked_cell
from ..language import number_said, said, said_template
from ..words import in_words, label

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ..._support.errors import SkisnowError
    from ...campaign.reading.headings import UnitConversion
    from ...campaign.reading.table_forms import TableForm
    from ...campaign.store import ReplayedRow

CHANGED: Final = "changed, not stored"


class Step(NamedTuple):
    """A load (N, as text), and whether discs were laid on or taken off: what distinguishes readings of a series."""

    load: str
    branch: str = ""

    @property
    def words(self) -> str:
        """As a person says it."""
        return f"{self.load} N on the way back" if self.branch else f"{self.load} N"

    @property
    def asked(self) -> str:
        """Name of its field."""
        return f"Depth back under {self.load} N (mm)" if self.branch else f"Depth under {self.load} N (mm)"


@dataclass(frozen=True, slots=True, eq=False)
class ReadingField:
    """The field of the depth under one load, the word for its state, and the element that holds both."""

    depth: ui.input
    state: ui.label
    row: ui.element

    @property
    def typed(self) -> str:
        """The text in the field."""
        return str(self.depth.value or "").strip()

    def unstored(self, row: ReplayedRow | None) -> str | None:
        """The text to keep when the field is drawn again; None if it was stored, or if another reading is there now."""
        drawn = str(self.row.props.get("data-stored") or "")
        is_kept = is_other(self.typed, drawn) and self.differs(row) and (bool(drawn) or row is None)
        return self.typed if is_kept else None

    def differs(self, row: ReplayedRow | None) -> bool:
        """True if the field has another text than the reading that is stored; with none stored: if it has any."""
        return is_other(self.typed, stored_depth(row))

    def show_state(self, row: ReplayedRow | None) -> None:
        """Say whether the text in the field is stored."""
        if row is None:
            show_state(self.state, "")
        elif self.differs(row):
            show_state(self.state, CHANGED)
        elif row.cells["depth_mm"] != row.entered.cells["depth_mm"]:
            show_state(self.state, f"corrected from {row.entered.cells['depth_mm']}")
        else:
            show_state(self.state, "stored")

    def restore(self, row: ReplayedRow | None) -> None:
        """Put the stored depth back into the field."""
        self.depth.set_value(number_said(stored_depth(row), self.depth.client))


def stored_depth(row: ReplayedRow | None) -> str:
    """The depth of a reading (mm, as text); "" if there is no reading."""
    return "" if row is None else row.cells["depth_mm"]


def is_other(typed: str, stored: str) -> bool:
    """True if a typed number has another text than the stored one, whichever decimal sign it has.

    >>> is_other("2,25", "2.25"), is_other("", "2.25")
    (False, True)
    """
    return typed.strip().replace(",", ".") != stored


def show_state(label: ui.label, words: str) -> None:
    """Show the state of a field; a change that is not stored is marked."""
    label.set_text(words)
    label.classes(add="changed" if words == CHANGED else "", remove="" if words == CHANGED else "changed")


Field: TypeAlias = ui.input | ui.select


def checked_fields(
    form: TableForm, fields: Mapping[str, Field], *, conversions: Mapping[str, UnitConversion] | None = None
) -> dict[str, str] | None:
    """The cells of a row as they are typed, by column; None if one is rejected: its field then shows the problem.

    ``conversions`` from the units of fields to those of their columns (default: they are the same).
    """
    cells: dict[str, str] = {}
    known = conversions or {}
    for column, each in fields.items():
        each.error = None
        try:
            cells[column] = checked_cell(form, column, str(each.value or ""), conversion=known.get(column))
        except CellError as error:
            each.error = problem_said(error, name=_name_said(each))
    return cells if len(cells) == len(fields) else None


def problem_said(error: SkisnowError, *, name: str = "") -> str:
    """An error in the language of the page; each sentence about a cell is translated by its own template.

    ``name`` of the field in that language (default: the name of the column).
    """
    if not isinstance(error, CellError):
        return f"{said(in_words(str(error))).rstrip('.')}."
    problem = said_template(error.problem, name or said(label(error.column)), error.value)
    return f"{problem} {said_template(error.fix, *(number_said(f'{limit:g}') for limit in error.limits))}"


def _name_said(field: Field) -> str:
    return str(field.props.get("aria-label") or field.props.get("label") or "")


def refuse(field: Field, fault: str) -> None:
    """Show at a field why it is rejected. The typed text stays; the fault goes when something else is typed."""
    field.error = said(in_words(fault))


def faults(fields: Iterable[Field]) -> list[str]:
    """The problem of each rejected field, in the language of the page."""
    return [each.error for each in fields if each.error]
