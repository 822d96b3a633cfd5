"""Sheets of a workbook or a CSV file, with merged cells filled, and the tables on them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Final

from ..._support.csv_text import CsvText, UnreadableTextError, decode
from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.spreadsheet_text import SEPARATOR_NAMES, is_number, named_separator
from ..._support.user_files.text_files import ContentError
from ..._support.user_files.workbook import Layout, Rows, sheet_layouts, workbook_sheets
from ..reading.headings import FORMS, stated_column
from ..reading.table_forms import SNOW_MICRO_PEN, TABLES
from ..reading.workbook_files import is_workbook

_LETTERS: Final = 26
HIDDEN: Final = "hidden"
STRUCK: Final = "struck"
EXCLUDED: Final = {HIDDEN: Message("a hidden row, column or sheet"), STRUCK: Message("a cell that is struck through")}


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of an imported workbook, or an imported CSV file.

    name: title of the sheet; name of a CSV file without its ending.
    rows, filled: cells as written, and with the first cell of each merged range in all rows of the range.
    fractions: row and column of cells of `filled` that the workbook stores as numbers; they have a decimal point.
    separator: separator of a CSV file, "" for a workbook.
    excluded: row and column of cells that the author may have excluded, by reason: HIDDEN or STRUCK.
    partly_struck, hidden_columns: cells with a part that is struck through, and hidden columns.
    ignored: rows, columns and cells that the user excluded, as SHEET!5, SHEET!H and SHEET!H5.
    hides_columns: True if the user excluded all hidden columns.
    """

    name: str
    rows: Rows
    filled: Rows
    fractions: frozenset[tuple[int, int]] = frozenset()
    separator: str = ""
    excluded: Mapping[str, frozenset[tuple[int, int]]] = field(default_factory=dict)
    partly_struck: frozenset[tuple[int, int]] = frozenset()
    hidden_columns: frozenset[int] = frozenset()
    ignored: frozenset[str] = frozenset()
    hides_columns: bool = False

    def ignores_row(self, row: int) -> bool:
        """True if the user excluded a row."""
        return f"{self.name}!{row + 1}" in self.ignored

    def ignores_column(self, column: int) -> bool:
        """True if the user excluded a column."""
        return f"{self.name}!{column_letters(column)}" in self.ignored

    def ignores(self, row: int, column: int) -> bool:
        """True if the user excluded a cell, directly or with its row or column."""
        place = f"{self.name}!{column_letters(column)}{row + 1}"
        return self.ignores_row(row) or self.ignores_column(column) or place in self.ignored

    def hides(self, column: int) -> bool:
        """True for a hidden column that the user excluded with all hidden ones."""
        return self.hides_columns and column in self.hidden_columns

    def cell(self, row: int, column: int, *, filled: bool = False) -> str:
        """Text of a cell, "" outside of the sheet; rows and columns count from 0."""
        rows = self.filled if filled else self.rows
        return rows[row][column].strip() if row < len(rows) and column < len(rows[row]) else ""


def column_letters(column: int) -> str:
    """Letters that name a column in a spreadsheet, from its index from 0.

    >>> column_letters(0), column_letters(27)
    ('A', 'AB')
    """
    before, last = divmod(column, _LETTERS)
    return (column_letters(before - 1) if before else "") + chr(ord("A") + last)


def read_sheets(name: str, data: bytes, *, count: Callable[[Sequence[str]], int] | None = None) -> list[Sheet]:
    """Read all sheets of a file that are not empty.

    name, data: name and bytes of the file.
    count: function that counts known headings in a row, for the separator of a CSV file (default: headings of
        campaigns).
    Raises ContentError or ParameterError: it is not a workbook or a CSV file, or is beyond a limit.
    """
    if not is_workbook(name):
        rows, separator = _csv_rows(name, data, count or _count_headings)
        return [Sheet(PurePath(name).stem, rows, rows, separator=separator)]
    fractions: dict[str, list[tuple[int, int]]] = {}
    try:
        layouts = sheet_layouts(data)
        sheets = workbook_sheets(data, wanted=lambda _: True, fractions=fractions)
    except ContentError as error:
        raise error.of(name) from error
    return [_sheet(title, rows, layouts[title], set(fractions[title])) for title, rows in sheets.items() if rows]


def _sheet(title: str, rows: Rows, layout: Layout, fractions: set[tuple[int, int]]) -> Sheet:
    """Sheet of a workbook from its rows and layout; merged ranges have their first cell in all their rows."""
    filled = [list(cells) for cells in rows]
    for top, left, bottom, _ in layout.merged:
        if top >= len(rows) or left >= len(rows[top]):
            continue
        for row in range(top + 1, min(bottom + 1, len(rows))):
            filled[row].extend([""] * (left + 1 - len(filled[row])))
            filled[row][left] = rows[top][left]
            fractions |= {(row, left)} if (top, left) in fractions else set()
    hidden = {
        (row, column)
        for row in (range(len(rows)) if layout.is_hidden else layout.hidden & set(range(len(rows))))
        for column in range(len(rows[row]))
    }
    excluded, partly_struck = {HIDDEN: frozenset(hidden), STRUCK: layout.struck}, layout.partly_struck
    return Sheet(title, rows, filled, frozenset(fractions), "", excluded, partly_struck, layout.hidden_columns)


def _csv_rows(name: str, data: bytes, count: Callable[[Sequence[str]], int]) -> tuple[Rows, str]:
    """Rows of a CSV file, row i from line i + 1, and the separator, the one that yields the most headings."""
    try:
        text = decode(data)
        named = named_separator(text.text[:1000])
        separators = [named] if named in SEPARATOR_NAMES else list(SEPARATOR_NAMES)
        texts = [CsvText(data, text.codec, text.foreign_encoding, mark, named is not None) for mark in separators]
        begins = [max(map(count, _read_rows(text, most=_HEADING_ROWS)), default=0) for text in texts]
        best = texts[begins.index(max(begins))]
        return _read_rows(best), best.separator
    except UnreadableTextError as failure:
        raise ParameterError("{file}: allowed: {allowed}. {action}").tag(
            "unreadable_file", file=name, allowed=failure.allowed, action=failure.action
        ) from failure


def _count_headings(cells: Sequence[str]) -> int:
    """Largest number of cells that state a column of the same table."""
    return max(sum(bool(stated_column(form, cell.strip())) for cell in cells) for form in TABLES)


def _read_rows(text: CsvText, *, most: int | None = None) -> Rows:
    """Cells by line, with single spaces; blank lines are empty rows. `most`: maximum number of lines (default: all)."""
    rows: Rows = []
    blank: list[str] = []  # shared by all blank lines
    for lines, records in text.records(most):
        for line, cells in zip(lines, records, strict=True):
            rows += [blank] * (line - 1 - len(rows))
            rows.append([" ".join(cell.split()) for cell in cells])
    return rows


_HEADING_ROWS: Final = 1000
"""First rows of a CSV file, whose headings tell its separator."""
KINDS: Final = {name: form for name, form in FORMS.items() if form in TABLES and form is not SNOW_MICRO_PEN}
"""Tables that can be imported."""
FROM_NOTES: Final = ("site", "tool", "plate")
"""Columns that a note can replace."""


def is_plain_number(text: str) -> bool:
    """True for a number with a decimal point or comma, and for a date or time in digits."""
    plain = text.strip()
    return is_number(plain, ".") or is_number(plain, ",") or bool(re.fullmatch(r"[\d.,:/\- ]*\d[\d.,:/\- T]*", plain))
