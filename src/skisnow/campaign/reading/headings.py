"""Headings that a campaign's tables have in place of the columns' names: ``[columns]`` in campaign.toml."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from .heading_units import every_unit, known_unit
from .table_forms import CORRECTIONS, TABLES

if TYPE_CHECKING:
    from .table_forms import TableForm
    from .toml_values import TomlValues

KEY: Final = "columns"
UNITS_KEY: Final = "units"
FORMS: Final = {form.file.removesuffix(".csv"): form for form in (*TABLES, CORRECTIONS)}
"""Tables by the names that ``[columns.NAME]`` and sheets of a workbook have."""


@dataclass(frozen=True, slots=True)
class Headings:
    """Names of columns by the headings that stand for them, plain ones.

    Attributes
    ----------
    everywhere
        In every table that may have such a column.
    of_table
        In one table, by its file; before what holds everywhere.
    units, units_of_table
        Units of the numbers below headings, in the same way.
    """

    everywhere: Mapping[str, str] = field(default_factory=dict)
    of_table: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    units_of_table: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def name(self, form: TableForm, heading: str) -> str:
        """The column that a heading of a table stands for; the heading where it stands for itself."""
        plain = plain_heading(heading)
        own = self.of_table.get(form.file, {}).get(plain)
        if own is not None:
            return own
        name = self.everywhere.get(plain)
        return name if name is not None and name in form.known else heading

    def unit(self, form: TableForm, heading: str) -> str:
        """The unit that campaign.toml states for a heading of a table; empty if it states none."""
        plain = plain_heading(heading)
        return self.units_of_table.get(form.file, {}).get(plain) or self.units.get(plain, "")

    def without_heading(self, headings: Mapping[str, Sequence[str]]) -> Iterator[str]:
        """Paths of stated units whose heading no table has; the headings of each table are given by its file."""
        there = {file: {plain_heading(each) for each in names} for file, names in headings.items()}
        everywhere = set().union(*there.values())
        yield from (f"{UNITS_KEY}.{name}" for name in self.units if name not in everywhere)
        for file, units in self.units_of_table.items():
            table = file.removesuffix(".csv")
            yield from (f"{UNITS_KEY}.{table}.{name}" for name in units if name not in there.get(file, set()))


def plain_heading(heading: str) -> str:
    r"""A heading without what nobody sees: line breaks, several spaces, capitals, two ways to write an umlaut.

    >>> plain_heading(" Kantwinkel\n[°] ")
    'kantwinkel [°]'
    """
    return " ".join(unicodedata.normalize("NFC", heading).split()).casefold()


def headings_of(top: TomlValues) -> Headings:
    """Read ``[columns]`` and ``[units]``; each for all tables, or for one under ``[columns.penetration]``."""
    units, units_of_table = _units_of(top.table(UNITS_KEY))
    section = top.table(KEY)
    everywhere: dict[str, str] = {}
    of_table: dict[str, dict[str, str]] = {}
    every_name = tuple(dict.fromkeys(name for form in FORMS.values() for name in form.known))
    for heading, value in section.values.items():
        if heading in FORMS and isinstance(value, Mapping):
            form = FORMS[heading]
            of_table[form.file] = _names(section.table(heading), form.known)
        else:
            everywhere |= _name(section, heading, every_name)
    return Headings(everywhere, of_table, units, units_of_table)


def _units_of(section: TomlValues) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """Units of all tables and of single ones: ``"Last" = "kg"``."""
    everywhere: dict[str, str] = {}
    of_table: dict[str, dict[str, str]] = {}
    for heading, value in section.values.items():
        if heading in FORMS and isinstance(value, Mapping):
            table = section.table(heading)
            of_table[FORMS[heading].file] = {
                plain_heading(name): unit for name in table.values if (unit := _unit(table, name))
            }
        elif unit := _unit(section, heading):
            everywhere[plain_heading(heading)] = unit
    return everywhere, of_table


def _unit(section: TomlValues, heading: str) -> str:
    value = section.values[heading]
    unit = known_unit(value) if isinstance(value, str) else ""
    if not unit:
        section.refuse(heading, f"one of the units {every_unit()}", "Write the unit in quotes.")
    return unit


def _names(section: TomlValues, known: tuple[str, ...]) -> dict[str, str]:
    found: dict[str, str] = {}
    for heading in section.values:
        found |= _name(section, heading, known)
    return found


def _name(section: TomlValues, heading: str, known: tuple[str, ...]) -> dict[str, str]:
    """The column that a heading stands for, or nothing where that is refused."""
    value = section.values[heading]
    if isinstance(value, str) and value.strip() in known:
        return {plain_heading(heading): value.strip()}
    near = difflib.get_close_matches(str(value).lower(), known, n=1)
    meant = f"Is {near[0]} meant? " if near else ""
    action = f"{meant}Write the heading, an equals sign and the column's name, both in quotes."
    section.refuse(heading, f"one of the columns {', '.join(known)}", action)
    return {}
