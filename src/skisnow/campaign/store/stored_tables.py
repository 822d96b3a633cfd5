"""Cells of tables for entry and correction: tables of a stored campaign, and validation of typed cells."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from ..._support.csv_text import UnreadableTextError
from ..._support.errors import ParameterError
from ..._support.messages import Message, joined, template
from ..._support.spreadsheet_text import number
from ..._support.user_files.text_files import natural_number
from ..reading.campaign import read_description
from ..reading.campaign_files import CampaignFiles, RawFiles
from ..reading.header import split_header
from ..reading.headings import UnitConversion
from ..reading.table_forms import BRANCH, BRANCHES, TABLES, TableForm, allowed_words
from ..reading.tables import TableReading
from .rows import damage_error


@dataclass(frozen=True, slots=True)
class StoredTable:
    """A table of a stored campaign.

    columns: columns of the file, and ``status``, which a correction can add.
    tests: cells by test, line of the file and column, with the corrections of the campaign's corrections.csv.
    conversions: conversion of each column whose unit in the file differs from its name.
    """

    form: TableForm
    columns: tuple[str, ...]
    tests: Mapping[str, Mapping[int, Mapping[str, str]]]
    conversions: Mapping[str, UnitConversion]


def stored_tables(campaign: CampaignFiles) -> dict[str, StoredTable]:
    """Tables of a stored campaign by file, without those that cannot be read."""
    files = RawFiles(campaign)
    read_description(files)
    tables = {form.file: _stored_table(files, form) for form in TABLES}
    return {file: table for file, table in tables.items() if table is not None}


def cell_key(line: int, column: str) -> str:
    """Key of a cell in an entry about a stored test.

    >>> cell_key(12, "depth_mm")
    '12/depth_mm'
    """
    return f"{line}/{column}"


def cell_of(key: str) -> tuple[int, str]:
    """Line of the file and column of a cell's key.

    >>> cell_of("12/depth_mm")
    (12, 'depth_mm')

    Raises StoreError: the key is invalid: the entry is damaged.
    """
    text, _, column = key.partition("/")
    line = natural_number(text)
    if line is None or not column:
        raise damage_error(Message("A correction of the cell {cell!r}", cell=key[:80]))
    return line, column


def _stored_table(files: RawFiles, form: TableForm) -> StoredTable | None:
    """Table with its corrections, cells by test and line; None if it is missing or has no column of tests."""
    text = files.csv_text(form)
    if text is None:
        return None
    table: TableReading | None = None
    tests: dict[str, dict[int, dict[str, str]]] = {}
    try:
        for lines, rows in text.records():
            if table is None and rows:
                table = TableReading(form, files, split_header(lines, rows), text)
            if table is None or form.key not in table.header.position:
                return None
            positions = table.header.position.items()
            table.corrector.apply(lines, rows)
            for line, row in zip(lines, rows, strict=True):
                cells = {name: row[at].strip() if at < len(row) else "" for name, at in positions}
                tests.setdefault(cells[form.key], {})[line] = cells
    except UnreadableTextError as failure:
        files.report_unreadable(form.file, failure)
    if table is None:
        return None
    columns = tuple(dict.fromkeys((*table.header.position, "status")))
    conversions = {column: size for column, size in table.conversions.items() if size.changes}
    return StoredTable(form, columns, tests, conversions)


FORMS: Final = {form.file: form for form in TABLES}
"""Required and allowed columns of each table, by file."""
LONGEST_TEXT: Final = 200

_PROBLEMS: Final = {
    "empty": template("{column} is empty."),
    "not_allowed": template("{column}: “{value}” is not allowed."),
    "too_long": template("{column} is too long, or has several lines."),
}
NAME: Final = Message("Enter a name.")
BRANCH_WORD: Final = Message("Enter loading or unloading, or leave it empty.")
SHORT_LINE: Final = Message("Enter one line of at most {most} characters.", most=LONGEST_TEXT)


class CellError(ParameterError):
    """Rejection of a typed cell: a sentence with the problem, and one with the allowed values.

    code: empty, not_allowed or too_long.
    column, value: name of the column, and the typed text.
    fix: sentence with the allowed values, in the unit of the text.
    """

    def __init__(self, code: str, column: str, value: str, fix: Message) -> None:
        self.column, self.value, self.fix = column, value, fix
        super().__init__(self.problem(code, column), code=code)

    def problem(self, code: str, name: str) -> Message:
        """Message with the problem and the fix, with another code and name of the column."""
        return joined([Message(_PROBLEMS[code], column=name, value=self.value), self.fix])


def checked_cell(form: TableForm, column: str, typed: str, *, conversion: UnitConversion | None = None) -> str:
    """The text of a cell as the table stores it: without surrounding blanks, a number with a decimal point.

    conversion: from the unit of the text to that of the column (default: it has the unit of the column).
    Raises CellError: an empty name, a text that is too long or not a number, a number outside its range.

    >>> checked_cell(FORMS["penetration.csv"], "depth_mm", " 2,50 ")
    '2.50'
    """
    text = typed.strip()
    rule = next((rule for rule in form.numbers if rule.name == column), None)
    if rule is not None:
        if not text and not rule.needed:
            return ""
        text, unit = text.replace("−", "-"), conversion or UnitConversion(column)
        value = number(text, "," if "," in text else ".")
        if math.isnan(value) or bool(rule.outside(unit.convert(np.array([value])))[0]):
            ends = (rule.lowest, rule.highest)
            low, high = (unit.revert(limit) if math.isfinite(limit) else limit for limit in ends)
            fix = Message("Enter {allowed}.", allowed=allowed_words(replace(rule, lowest=low, highest=high)))
            raise CellError("not_allowed" if text else "empty", column, text, fix)
        return text.replace(",", ".")
    if column == BRANCH and text.casefold() not in BRANCHES:
        raise CellError("not_allowed", column, text, BRANCH_WORD)
    if not text and column in form.names:
        raise CellError("empty", column, text, NAME)
    if len(text) > LONGEST_TEXT or not all(letter.isprintable() for letter in text):
        raise CellError("too_long", column, text, SHORT_LINE)
    return text
