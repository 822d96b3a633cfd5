"""Header of a table: its columns and units, and errors for missing, repeated and unknown columns."""

from __future__ import annotations

import difflib
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

from ..._support.messages import Message, joined, template
from ..problems import Problem, error, warning
from . import headings
from .table_forms import TableForm

_MOST_TITLES = 20
_FEWEST_UNITS = 2
NO_UNIT: Final = {"", "-", "–", "#", "nr", "nr.", "no", "no."}
"""Cells of a row of units below columns without one, in small letters."""


@dataclass(frozen=True, slots=True)
class Header:
    """Header of a table.

    columns: headings of the columns, stripped; ``""`` for an unnamed one.
    row: line of the file.
    units: units in a separate row below the names, ``""`` without a unit; empty without such a row.
    """

    columns: tuple[str, ...]
    row: int
    units: tuple[str, ...] = ()

    @property
    def position(self) -> dict[str, int]:
        """Index of each named column by its name; of equal names the first one."""
        backwards = reversed(range(len(self.columns)))
        places = {self.columns[index]: index for index in backwards if self.columns[index]}
        return dict(sorted(places.items(), key=lambda item: item[1]))


def split_header(lines: list[int], rows: list[list[str]]) -> Header:
    """Remove title rows, headings and a row of units from the first rows of a file; returns the header."""
    filled = [sum(1 for cell in cells if cell.strip()) for cells in rows[:_MOST_TITLES]]
    place = next((place for place, count in enumerate(filled) if count > 1), 0)
    columns = tuple(cell.strip().strip("\ufeff").strip() for cell in rows[place])
    row = lines[place]
    units = _units_of(rows[place + 1]) if place + 1 < len(rows) else ()
    taken = place + (2 if units else 1)
    del rows[:taken], lines[:taken]
    return Header(columns, row, (*units, *[""] * len(columns))[: len(columns)] if units else ())


def _units_of(cells: Sequence[str]) -> tuple[str, ...]:
    """Units by column if a row is one of units (two or more, and else only "Nr.", "-" and the like), otherwise ().

    >>> _units_of(["Nr.", "°", "kg", "[mm]", ""]), _units_of(["1", "30", "kg", "mm", ""])
    (('', '°', 'kg', 'mm', ''), ())
    """
    plain = [cell.strip().strip("[]()").strip() for cell in cells]
    units = tuple(map(headings.known_unit, plain))
    others = {cell.casefold() for cell, unit in zip(plain, units, strict=True) if not unit}
    return units if sum(map(bool, units)) >= _FEWEST_UNITS and others <= NO_UNIT else ()


def check_header(form: TableForm, header: Header) -> list[Problem]:
    """Problems of missing, repeated and unknown columns; only one if all required columns are missing."""
    present = header.position
    unknown = [name for name in present if name not in form.known]
    missing = [name for name in form.required if name not in present]
    if len(missing) == len(form.required):
        return [_missing_columns_error(form, header)]
    repeated = [name for name, times in Counter(filter(None, header.columns)).items() if times > 1]
    allowed, action = Message("each column once"), Message("Rename or remove one of the columns of this name.")
    problems = [
        error("unreadable_file", form.file, row=header.row, column=name, value=name, allowed=allowed, action=action)
        for name in repeated
    ]
    missing_column = partial(error, "missing_column", form.file, row=header.row)
    kept_as_text = partial(warning, "unknown_column", form.file, row=header.row)
    as_written = {heading.lower(): heading for heading in unknown}
    likely = {column: heading for heading, column in headings.columns_by_synonym(form, unknown).items()}
    for name in missing:
        near = difflib.get_close_matches(name.lower(), list(as_written), n=1)
        meant = as_written[near[0]] if near else likely.get(name)
        action = _advise_mapping(meant, name) if meant else Message("Add it; the unit belongs to the name.")
        allowed = Message("the columns {required}", required=list(form.required))
        problems.append(missing_column(column=name, value=meant, allowed=allowed, action=action))
    free = [name for name in form.known if name not in header.columns]
    for name in unknown:
        near = difflib.get_close_matches(name, free, n=1)
        action = Message("The column is kept as text and not interpreted; no action is needed.")
        if near:
            kept = Message("The column is kept as text and not interpreted.")
            action = joined([kept, _advise_mapping(name, near[0])])
        allowed = Message("the columns {known}", known=list(form.known))
        problems.append(kept_as_text(column=name, value=name, allowed=allowed, action=action, needs_action=bool(near)))
    return problems


def _missing_columns_error(form: TableForm, header: Header) -> Problem:
    """Error for a table without any required column; it proposes a mapping of the headings in campaign.toml."""
    meant = headings.columns_by_synonym(form, header.columns)
    left = [name for name in form.required if name not in meant.values()]
    pairs = ", ".join(
        f"{json.dumps(heading, ensure_ascii=False)} = {json.dumps(name)}" for heading, name in meant.items()
    )
    actions = []
    if meant:
        line = f"columns.{form.name} = {{{pairs}}}"
        actions.append(Message("Put this at the top of campaign.toml if it is right: {line}.", line=line))
    if left:
        actions.append(Message("No heading looks like {columns}: rename or add it.", columns=left))
    allowed = Message("{required}, or headings that campaign.toml maps to them", required=list(form.required))
    action = joined(actions)
    return error("missing_column", form.file, row=header.row, allowed=allowed, action=action)


def _advise_mapping(heading: str, column: str) -> Message:
    """Advice to rename a heading as `column` or map it; warns of the unit if the column has one."""
    if not headings.unit_of_column(column):
        advice = template("Did you mean {column!r}? Rename {heading!r}, or map it under [columns] in campaign.toml.")
    else:
        advice = template(
            "Did you mean {column!r}? Rename {heading!r} if its numbers have the unit of this column, or map it under "
            "[columns] in campaign.toml, which converts them."
        )
    return Message(advice, heading=heading, column=column)


def column_units(
    form: TableForm, header: Header, mapping: headings.Headings, problems: list[Problem]
) -> tuple[dict[str, headings.UnitConversion], dict[str, str]]:
    """Resolve the units of a table; a column's own name such as load_N states its unit.

    form, header, mapping: form of the table, its header in the file, and the mapping of headings in campaign.toml.
    problems: list to which problems are added: a wrong unit, two units for one heading, a note on each conversion.
    Returns the conversion of each column whose unit is stated, and the headings without a unit by their columns.
    """
    numbers = {column.name for column in form.numbers} - set(form.further)
    conversions: dict[str, headings.UnitConversion] = {}
    unstated: dict[str, str] = {}
    for place, heading in enumerate(header.columns):
        column = mapping.name(form, heading)
        if not headings.unit_of_column(column):
            continue
        named = headings.folded_unit(column) if heading == column else headings.named_unit(heading)
        below = header.units[place] if header.units else ""
        stated = list(filter(None, (mapping.unit(form, heading), named, below)))
        units, size = headings.units_for(column), headings.conversion(stated[0], column) if stated else None
        wrong_unit = partial(error, "other_unit", form.file, row=header.row, column=column, value=heading)
        if any(headings.conversion(unit, column) != size for unit in stated):
            action = Message("Correct the heading, the row of units or campaign.toml: they state different units.")
            problems.append(wrong_unit(allowed=Message("one unit among {units}", units=units), action=action))
        elif not stated:
            unstated |= {column: heading} if column in numbers else {}
        elif size is None or (size.changes and column not in numbers):
            allowed = Message("numbers in {units}", units=units if column in numbers else units.split(", ", 1)[0])
            problems.append(wrong_unit(allowed=allowed, action=Message("Correct the unit, or convert the numbers.")))
        else:
            conversions[column] = size
            if size.changes:
                value = f"{heading} converted from {size.name}"
                allowed = Message("numbers in the unit of {column}", column=column)
                action = Message("The numbers were converted; no action is needed.")
                note = warning("converted_unit", form.file, column=column, value=value, allowed=allowed, action=action)
                problems.append(replace(note, needs_action=False))
    return conversions, unstated
