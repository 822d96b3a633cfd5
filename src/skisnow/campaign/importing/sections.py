"""Tables on a sheet: a row of headings, and a row of units below it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from ..reading.headings import columns_by_synonym, heading_words, known_unit, stated_column, unit_of_column
from ..reading.table_forms import TableForm
from .answers import NONE, Answers
from .sheets import FROM_NOTES, KINDS, Sheet, is_plain_number

_FEWEST_HEADINGS: Final = 2


@dataclass(frozen=True, slots=True)
class Section:
    """Position of a table on a sheet; rows and columns count from 0.

    sheet: the sheet.
    header, start, end: first row of the headings, first row below headings and units, and row behind the last one.
    columns: indices of its columns on the sheet.
    headings, units: headings, and cells of the row of units, "" without one, for each column.
    span: all columns from the first to the last one, also blank ones.
    """

    sheet: Sheet
    header: int
    start: int
    end: int
    columns: tuple[int, ...]
    headings: tuple[str, ...]
    units: tuple[str, ...]
    span: range

    @property
    def key(self) -> str:
        """Name of the table in answers, SHEET:ROW with the row of its headings."""
        return f"{self.sheet.name}:{self.header + 1}"

    def qualified(self) -> bool:
        """True if the row above has several words, or a part of a word, that may qualify a heading of numbers."""
        above = [self.sheet.cell(self.header - 1, column) for column in self.columns] if self.header else []
        words = [(text, heading) for text, heading in zip(above, self.headings, strict=False) if text]
        return (
            (len(words) > 1 or any(text.endswith("-") for text, _ in words))
            and not any(re.search(r"[\d:]", text) for text, _ in words)
            and any(unit_of_column(name) for _, heading in words for name in _stated_columns(heading))
        )

    def has(self, row: int, column: int) -> bool:
        """True if a cell belongs to the table; a row with a single text is a note instead."""
        if not self.header <= row < self.end or column not in self.columns:
            return False
        texts = sum(bool(self.sheet.cell(row, place)) for place in self.columns)
        return row < self.start or texts > 1 or self.sheet.cell(row, self.columns[0]) == ""


def find_sections(sheet: Sheet, tables: Mapping[str, str]) -> list[Section]:
    """Find the tables of a sheet from top to bottom; `tables`: the user's answers by SHEET:ROW."""
    heads: list[tuple[int, range]] = []
    for row in range(len(sheet.rows)):
        answer = tables.get(f"{sheet.name}:{row + 1}")
        if answer != NONE and not sheet.ignores_row(row):
            groups = _table_groups(sheet, row)
            heads += [(row, group) for group in groups if answer or _is_header(_row_texts(sheet, row, group))]
    sections = [_make_section(sheet, row, group, heads) for row, group in heads]
    return [
        part
        for part in sections
        if any(sum(bool(sheet.cell(at, column)) for column in part.columns) > 1 for at in range(part.start, part.end))
    ]


def _stated_columns(heading: str) -> set[str]:
    """Columns of all tables that a heading states."""
    return {column for form in KINDS.values() if (column := stated_column(form, heading))}


def _groups(sheet: Sheet, row: int) -> Iterator[range]:
    """Ranges of neighbouring columns with a cell on a row that is not blank."""
    width = len(sheet.filled[row])
    start = 0
    for column in range(width + 1):
        if column == width or not sheet.cell(row, column, filled=True) or sheet.ignores_column(column):
            if column - start >= _FEWEST_HEADINGS:
                yield range(start, column)
            start = column + 1


def _table_groups(sheet: Sheet, row: int) -> list[range]:
    """Ranges of columns with texts on a row, separated by empty columns, unless only all together make a table."""
    groups = list(_groups(sheet, row))
    end = next((at for at in range(row, len(sheet.filled)) if not any(sheet.filled[at])), len(sheet.filled))
    headed = [column for column in range(len(sheet.filled[row])) if sheet.cell(row, column, filled=True)]
    if not headed:
        return groups
    whole = range(headed[0], headed[-1] + 1)
    words = {heading_words(text) for text in _row_texts(sheet, row, whole) if text}
    is_one = (
        len(headed) < len(whole)
        and len(words) == len(headed)
        and all(column in headed or _is_empty(sheet, column, range(row, end)) for column in whole)
        and not any(sheet.ignores_column(column) for column in whole)
        and _is_complete(sheet, row, whole)
        and not any(_is_complete(sheet, row, group) for group in groups)
    )
    return [whole] if is_one else groups


def _is_complete(sheet: Sheet, row: int, columns: range) -> bool:
    """True if the headings of a row have all required columns of a table, except those that notes can state."""
    texts = [text for text in _row_texts(sheet, row, columns) if text]
    return any(
        set(form.required) - set(FROM_NOTES) <= set(likely_columns(form, texts).values()) for form in KINDS.values()
    )


def _row_texts(sheet: Sheet, row: int, columns: range) -> list[str]:
    """Texts of a row's cells in `columns`, with merged cells filled."""
    return [sheet.cell(row, column, filled=True) for column in columns]


def _is_header(cells: Sequence[str]) -> bool:
    """True if cells can be headings: at least two columns of a table, one with a unit, and no number or unit."""
    if any(is_plain_number(cell) or known_unit(cell.strip("[]()")) for cell in cells):
        return False
    return any(
        len(likely) >= _FEWEST_HEADINGS and any(map(unit_of_column, likely))
        for form in KINDS.values()
        if (likely := likely_columns(form, cells).values())
    )


def likely_columns(form: TableForm, headings: Sequence[str]) -> dict[str, str]:
    """Columns of a table by the heading that states or probably means them."""
    stated = {heading: column for heading in headings if (column := stated_column(form, heading))}
    return columns_by_synonym(form, headings) | stated


def _make_section(sheet: Sheet, row: int, columns: range, heads: Sequence[tuple[int, range]]) -> Section:
    """Section below a row of headings, up to the next headings; without its empty and hidden columns."""
    later = [other for other, group in heads if other > row and set(group) & set(columns)]
    headings, start = tuple(_row_texts(sheet, row, columns)), row + 1
    below = [sheet.cell(row + 1, column).strip("[]()").strip() for column in columns]
    texts = [cell for cell in below if cell]
    units: tuple[str, ...] = ()
    has_units = any(map(known_unit, texts)) or len(texts) >= _FEWEST_HEADINGS
    if has_units and not any(map(is_plain_number, texts)):
        units, start = tuple(below), start + 1
    end = min(later, default=len(sheet.rows))
    while end > start and _is_title(sheet, end - 1, columns):
        end -= 1
    used = [
        place
        for place, column in enumerate(columns)
        if not _is_empty(sheet, column, range(row, end)) and not sheet.hides(column)
    ]
    headings, units = tuple(headings[place] for place in used), tuple(units[place] for place in used if units)
    return Section(sheet, row, start, end, tuple(columns[place] for place in used), headings, units, columns)


def _is_empty(sheet: Sheet, column: int, rows: range) -> bool:
    """True if a column has no text in `rows`."""
    return not any(sheet.cell(row, column, filled=True) for row in rows)


def _is_title(sheet: Sheet, row: int, columns: range) -> bool:
    """True for a row without numbers and with at most one text below the headings: blank, or a title or note."""
    texts = [text for column in columns if (text := sheet.cell(row, column, filled=True))]
    return not texts or (len(texts) == 1 and not is_plain_number(texts[0]))


def table_of(section: Section, answers: Answers) -> TableForm | None:
    """Form of the campaign's table for a section: the user's answer, or the one whose required numbers are all there.

    Of several forms that with the most numbers counts; None if it is unclear.
    """
    answer = answers.table.get(section.key, "")
    if answer in KINDS:
        return KINDS[answer]
    counts: dict[str, int] = {}
    numbers: dict[str, set[str]] = {}
    for name, form in KINDS.items():
        stated = {
            answers.of_heading("column", name, heading) or stated_column(form, heading) for heading in section.headings
        }
        needed = {column.name for column in form.numbers if column.needed}
        numbers[name] = needed & stated
        if needed <= stated:
            counts[name] = len(needed)
    most = max(counts.values(), default=0)
    best = [name for name, count in counts.items() if count == most]
    if len(best) != 1 or any(others - set(KINDS[best[0]].known) for others in numbers.values()):
        return None
    return KINDS[best[0]]


def likely_table(section: Section) -> str:
    """Name of the campaign's table that the headings of a section probably mean, by its required numbers."""

    def fit(form: TableForm) -> tuple[int, float]:
        needed = {column.name for column in form.numbers if column.needed}
        count = len(needed & set(likely_columns(form, section.headings).values()))
        return count, count / len(needed)

    return max(KINDS, key=lambda name: fit(KINDS[name]))
