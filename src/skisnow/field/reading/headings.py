"""Headings that a campaign's tables have in place of the columns' names: ``[columns]`` in campaign.toml."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from .table_forms import CORRECTIONS, TABLES

if TYPE_CHECKING:
    from .table_forms import TableForm
    from .toml_values import TomlValues

KEY: Final = "columns"
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
    """

    everywhere: Mapping[str, str] = field(default_factory=dict)
    of_table: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def name(self, form: TableForm, heading: str) -> str:
        """The column that a heading of a table stands for; the heading where it stands for itself."""
        plain = plain_heading(heading)
        own = self.of_table.get(form.file, {}).get(plain)
        if own is not None:
            return own
        name = self.everywhere.get(plain)
        return name if name is not None and name in form.known else heading


def plain_heading(heading: str) -> str:
    r"""A heading without what nobody sees: line breaks, several spaces, capitals, two ways to write an umlaut.

    >>> plain_heading(" Kantwinkel\n[°] ")
    'kantwinkel [°]'
    """
    return " ".join(unicodedata.normalize("NFC", heading).split()).casefold()


def headings_of(top: TomlValues) -> Headings:
    """Read ``[columns]``: ``"Kantwinkel [°]" = "edge_angle_deg"``, for one table under ``[columns.penetration]``."""
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
    return Headings(everywhere, of_table)


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
