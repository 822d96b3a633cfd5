"""Typed fields of a form, checked: a cell for each, or the problem of each field in the language of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from nicegui import ui

from ...campaign.store.cells import CellError, checked_cell
from ..language import number_said, said, said_template
from ..words import in_words, label

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ..._support.errors import SkisnowError
    from ...campaign.reading.heading_units import UnitConversion
    from ...campaign.reading.table_forms import TableForm

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
