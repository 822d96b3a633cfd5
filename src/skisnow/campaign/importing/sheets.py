"""Sheets of a workbook or a CSV file, with merged cells filled, and the tables on them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from ..._support.errors import ParameterError
from ..._support.spreadsheet_text import SEPARATOR_NAMES, is_number, named_separator
from ..._support.user_files import workbook_sheets
from ..._support.user_files.workbook import merged_ranges
from ..reading.headings import FORMS, columns_by_synonym, known_unit, stated_column, unit_of_column
from ..reading.table_forms import SNOW_MICRO_PEN, TABLES
from ..reading.text import CsvText, UnreadableTextError, decode
from ..reading.workbook_files import is_workbook
from .answers import NONE

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..._support.user_files.workbook import Rows
    from ..reading.table_forms import TableForm
    from .answers import Answers

_LETTERS: Final = 26


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of a file.

    Attributes
    ----------
    name
        Title of the sheet; name of a CSV file without its ending.
    rows, filled
        Cells as written, and with the first cell of each merged range in all rows of the range.
    fractions
        Row and column of cells of `filled` that are numbers, not text: they have a decimal point.
    separator
        Separator of a CSV file, "" for a workbook.
    """

    name: str
    rows: Rows
    filled: Rows
    fractions: frozenset[tuple[int, int]] = frozenset()
    separator: str = ""

    def cell(self, row: int, column: int, *, filled: bool = False) -> str:
        """Text of a cell, "" outside of the sheet; rows and columns count from 0."""
        rows = self.filled if filled else self.rows
        return rows[row][column].strip() if row < len(rows) and column < len(rows[row]) else ""


def column_letters(column: int) -> str:
    """Name of a column in a spreadsheet, counted from 0.

    >>> column_letters(0), column_letters(27)
    ('A', 'AB')
    """
    before, last = divmod(column, _LETTERS)
    return (column_letters(before - 1) if before else "") + chr(ord("A") + last)


def read_sheets(name: str, data: bytes, *, count: Callable[[Sequence[str]], int] | None = None) -> list[Sheet]:
    """Read all sheets of a file that are not empty.

    Parameters
    ----------
    name, data
        The file.
    count
        Number of known headings in a row, by which the separator of a CSV file is found; default: those of campaigns.

    Raises
    ------
    GivenError, ParameterError
        It is not a workbook or a CSV file, or is beyond a limit.
    """
    if not is_workbook(name):
        rows, separator = _csv_rows(name, data, count or _headings)
        return [Sheet(PurePath(name).stem, rows, rows, separator=separator)]
    merged = merged_ranges(data)
    fractions: dict[str, list[tuple[int, int]]] = {}
    sheets = workbook_sheets(data, wanted=lambda _: True, fractions=fractions)
    return [_sheet(title, rows, merged[title], set(fractions[title])) for title, rows in sheets.items() if rows]


def _sheet(
    title: str, rows: Rows, ranges: Sequence[tuple[int, int, int, int]], fractions: set[tuple[int, int]]
) -> Sheet:
    """Sheet with the first cell of each merged range in all its rows."""
    filled = [list(cells) for cells in rows]
    for top, left, bottom, _ in ranges:
        if top >= len(rows) or left >= len(rows[top]):
            continue
        for row in range(top + 1, min(bottom + 1, len(rows))):
            filled[row].extend([""] * (left + 1 - len(filled[row])))
            filled[row][left] = rows[top][left]
            fractions |= {(row, left)} if (top, left) in fractions else set()
    return Sheet(title, rows, filled, frozenset(fractions))


def _csv_rows(name: str, data: bytes, count: Callable[[Sequence[str]], int]) -> tuple[Rows, str]:
    """Rows of a CSV file by line, and the separator that yields the most headings."""
    try:
        text = decode(data)
        named = named_separator(text.text[:1000])
        separators = [named] if named in SEPARATOR_NAMES else list(SEPARATOR_NAMES)
        candidates = [
            (_records(CsvText(data, text.codec, text.foreign_encoding, mark, named is not None)), mark)
            for mark in separators
        ]
    except UnreadableTextError as failure:
        raise ParameterError(
            "{file}: allowed: {allowed}. {action}",
            code="unreadable_file",
            file=name,
            allowed=failure.allowed,
            action=failure.action,
        ) from failure
    return max(candidates, key=lambda candidate: max(map(count, candidate[0][:_HEADING_ROWS]), default=0))


def _headings(cells: Sequence[str]) -> int:
    return max(sum(bool(stated_column(form, cell.strip())) for cell in cells) for form in TABLES)


def _records(text: CsvText) -> Rows:
    rows: Rows = []
    for lines, records in text.records():
        for line, cells in zip(lines, records, strict=True):
            rows.extend([] for _ in range(line - 1 - len(rows)))
            rows.append([re.sub(r"\s+", " ", cell).strip() for cell in cells])
    return rows


_FEWEST_HEADINGS: Final = 2
_HEADING_ROWS: Final = 1000
"""First rows of a CSV file, whose headings tell its separator."""
KINDS: Final = {name: form for name, form in FORMS.items() if form in TABLES and form is not SNOW_MICRO_PEN}
"""Tables that can be imported."""


@dataclass(frozen=True, slots=True)
class Section:
    """A table on a sheet; rows and columns count from 0.

    Attributes
    ----------
    sheet
        The sheet.
    header, start, end
        Row of the headings, first row below headings and units, and row behind the last one.
    left
        First column.
    headings, units
        Headings, and cells of the row of units, "" without one.
    """

    sheet: Sheet
    header: int
    start: int
    end: int
    left: int
    headings: tuple[str, ...]
    units: tuple[str, ...]

    @property
    def key(self) -> str:
        """Sheet and row of the headings, as answers name the table."""
        return f"{self.sheet.name}:{self.header + 1}"

    @property
    def columns(self) -> range:
        """Columns of the sheet."""
        return range(self.left, self.left + len(self.headings))


def find_sections(sheet: Sheet, tables: Mapping[str, str], ignored: Ignored) -> list[Section]:
    """Tables of a sheet in their order, also side by side; `tables` are answers by heading row."""
    heads: list[tuple[int, range]] = []
    for row in range(len(sheet.rows)):
        answer = tables.get(f"{sheet.name}:{row + 1}")
        if answer == NONE or ignored.row(sheet.name, row):
            continue
        heads += [(row, group) for group in _groups(sheet, row, ignored) if answer or _is_header(sheet, row, group)]
    sections = [_section(sheet, row, columns, heads) for row, columns in heads]
    return [section for section in sections if any(_is_filled(section, row) for row in _body(section))]


def _body(section: Section) -> range:
    return range(section.start, section.end)


def _is_filled(section: Section, row: int) -> bool:
    return sum(bool(section.sheet.cell(row, column)) for column in section.columns) > 1


def _groups(sheet: Sheet, row: int, ignored: Ignored) -> Iterator[range]:
    """Neighbouring cells of a row that are not blank."""
    width = len(sheet.filled[row])
    filled = [bool(sheet.cell(row, column, filled=True)) for column in range(width)]
    start = 0
    for column in range(width + 1):
        if column == width or not filled[column] or ignored.column(sheet.name, column):
            if column - start >= _FEWEST_HEADINGS:
                yield range(start, column)
            start = column + 1


def _is_header(sheet: Sheet, row: int, columns: range) -> bool:
    """True for at least two headings of a table, one with a unit, and no number or unit."""
    cells = [sheet.cell(row, column, filled=True) for column in columns]
    if any(is_plain_number(cell) or known_unit(cell.strip("[]()")) for cell in cells):
        return False
    return any(
        len(likely) >= _FEWEST_HEADINGS and any(map(unit_of_column, likely))
        for form in KINDS.values()
        if (likely := likely_columns(form, cells).values())
    )


def likely_columns(form: TableForm, headings: Sequence[str]) -> dict[str, str]:
    """Stated or likely columns by heading."""
    stated = {heading: column for heading in headings if (column := stated_column(form, heading))}
    return columns_by_synonym(form, headings) | stated


def _section(sheet: Sheet, row: int, columns: range, heads: Sequence[tuple[int, range]]) -> Section:
    later = [other for other, group in heads if other > row and set(group) & set(columns)]
    headings = tuple(sheet.cell(row, column, filled=True) for column in columns)
    below = [sheet.cell(row + 1, column) for column in columns]
    units = tuple(cell.strip("[]()").strip() for cell in below) if _is_row_of_units(below) else ()
    start, end = row + (2 if units else 1), min(later, default=len(sheet.rows))
    while end > start and _is_title(sheet, end - 1, columns):
        end -= 1
    return Section(sheet, row, start, end, columns.start, headings, units)


def _is_title(sheet: Sheet, row: int, columns: range) -> bool:
    """True for a row without numbers and with at most one text below the headings: blank, or a title or note."""
    texts = [text for column in columns if (text := sheet.cell(row, column, filled=True))]
    return not texts or (len(texts) == 1 and not is_plain_number(texts[0]))


def _is_row_of_units(cells: Sequence[str]) -> bool:
    texts = [cell.strip("[]()").strip() for cell in cells if cell]
    numbers = any(map(is_plain_number, texts))
    return not numbers and (any(map(known_unit, texts)) or len(texts) >= _FEWEST_HEADINGS)


def is_plain_number(text: str) -> bool:
    """True for a number with a decimal point or comma, or a day."""
    plain = text.strip()
    return is_number(plain, ".") or is_number(plain, ",") or bool(re.fullmatch(r"[\d.,:/\- ]*\d[\d.,:/\- T]*", plain))


@dataclass(frozen=True, slots=True)
class Ignored:
    """Rows, columns and cells that the user excluded."""

    places: frozenset[str]

    def row(self, sheet: str, row: int) -> bool:
        """True if a row is excluded."""
        return f"{sheet}!{row + 1}" in self.places

    def column(self, sheet: str, column: int) -> bool:
        """True if a column is excluded."""
        return f"{sheet}!{column_letters(column)}" in self.places

    def cell(self, sheet: str, row: int, column: int) -> bool:
        """True if a cell is excluded, directly or with its row or column."""
        name = f"{sheet}!{column_letters(column)}{row + 1}"
        return self.row(sheet, row) or self.column(sheet, column) or name in self.places


def table_of(section: Section, answers: Answers) -> TableForm | None:
    """Table of a section: the answer, or the one with the most needed numbers among those that have all; else None."""
    answer = answers.table.get(section.key, "")
    if answer in KINDS:
        return KINDS[answer]
    counts: dict[str, int] = {}
    for name, form in KINDS.items():
        stated = {
            answers.of_heading("column", name, heading) or stated_column(form, heading) for heading in section.headings
        }
        needed = [column.name for column in form.numbers if column.needed]
        if all(column in stated for column in needed):
            counts[name] = len(needed)
    most = max(counts.values(), default=0)
    best = [name for name, count in counts.items() if count == most]
    return KINDS[best[0]] if len(best) == 1 else None


def likely_table(section: Section) -> str:
    """Name of the table with the largest share of likely columns."""

    def share(form: TableForm) -> float:
        needed = [column.name for column in form.numbers if column.needed]
        return len(set(needed) & set(likely_columns(form, section.headings).values())) / len(needed)

    return max(KINDS, key=lambda name: share(KINDS[name]))
