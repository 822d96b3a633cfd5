"""Unit of each column of numbers: from its heading, a row of units, or ``[units]`` in campaign.toml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..problems import error, warning
from .heading_units import conversion, named_unit, own_unit, unit_of_column, units_for

if TYPE_CHECKING:
    from ..problems import Problem
    from .header import Header
    from .heading_units import UnitConversion
    from .headings import Headings
    from .table_forms import TableForm


@dataclass(frozen=True, slots=True)
class ColumnUnits:
    """Units of the columns of a table.

    Attributes
    ----------
    conversions
        Conversion of each column whose unit is stated.
    unstated
        Headings without a unit, by their columns.
    """

    conversions: Mapping[str, UnitConversion] = field(default_factory=dict)
    unstated: Mapping[str, str] = field(default_factory=dict)


def column_units(form: TableForm, header: Header, headings: Headings, found: list[Problem]) -> ColumnUnits:
    """Resolve the units of a table; a program's own name such as load_N states its unit.

    Parameters
    ----------
    form, header, headings
        The table, its headings as the file has them, and what campaign.toml says about headings.
    found
        Takes the problems: a unit of another kind, two units for one heading, a note on each conversion.
    """
    numbers = {column.name for column in form.numbers} - set(form.further)
    conversions: dict[str, UnitConversion] = {}
    unstated: dict[str, str] = {}
    for place, heading in enumerate(header.columns):
        column = headings.name(form, heading)
        if not unit_of_column(column):
            continue
        named = own_unit(column) if heading == column else named_unit(heading)
        below = header.units[place] if header.units else ""
        stated = list(filter(None, (headings.unit(form, heading), named, below)))
        if any(conversion(each, column) != conversion(stated[0], column) for each in stated):
            found.append(_two_units(form, heading, column, header.row))
            continue
        unit = stated[0] if stated else ""
        size = conversion(unit, column) if unit else None
        if not unit:
            unstated |= {column: heading} if column in numbers else {}
        elif size is None or (size.changes and column not in numbers):
            found.append(_other_unit(form, heading, column, header.row, is_number=column in numbers))
        else:
            conversions[column] = size
            found += [_note(form, heading, column, size.name)] if size.changes else []
    return ColumnUnits(conversions, unstated)


def _note(form: TableForm, heading: str, column: str, unit: str) -> Problem:
    return warning(
        "converted_unit",
        form.file,
        column=column,
        value=f"{heading} converted from {unit}",
        allowed=f"numbers in the unit of {column}",
        action="The numbers were converted; no action is needed.",
        needs_action=False,
    )


def _other_unit(form: TableForm, heading: str, column: str, row: int, *, is_number: bool) -> Problem:
    units = units_for(column)
    return error(
        "other_unit",
        form.file,
        row=row,
        column=column,
        value=heading,
        allowed=f"numbers in {units if is_number else units.split(', ', 1)[0]}",
        action="Correct the unit, or convert the numbers.",
    )


def _two_units(form: TableForm, heading: str, column: str, row: int) -> Problem:
    return error(
        "other_unit",
        form.file,
        row=row,
        column=column,
        value=heading,
        allowed=f"one unit among {units_for(column)}",
        action="Correct the heading, the row of units or campaign.toml: they state different units.",
    )
