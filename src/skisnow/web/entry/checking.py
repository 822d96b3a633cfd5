"""What is typed in fields, checked: a cell for each, or each fault at the field that has it."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from nicegui import ui

from ...errors import ParameterError
from ...field.store.cells import checked_cell
from ..words import in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ...field.reading.table_forms import TableForm

Field: TypeAlias = ui.input | ui.select


def checked_fields(form: TableForm, fields: Mapping[str, Field]) -> dict[str, str] | None:
    """The cells of a row as they are typed, by column; None where one is refused, which its field then says."""
    cells: dict[str, str] = {}
    for column, each in fields.items():
        each.error = None
        try:
            cells[column] = checked_cell(form, column, str(each.value or ""))
        except ParameterError as error:
            each.error = in_words(str(error))
    return cells if len(cells) == len(fields) else None


def refuse(field: Field, fault: str) -> None:
    """Say at a field why it is refused. What is typed stays; the fault goes when something else is typed."""
    field.error = fault


def faults(fields: Iterable[Field]) -> list[str]:
    """What is wrong, field by field."""
    return [each.error for each in fields if each.error]
