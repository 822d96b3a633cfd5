"""Tables on a sheet: headings on one or two rows, a row of units, and series in neighbouring columns."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

from ..reading.header import NO_UNIT
from ..reading.headings import columns_by_synonym, heading_words, known_unit, named_unit, stated_column, unit_of_column
from ..reading.table_forms import TableForm
from .answers import NONE, Answers
from .sheets import FROM_NOTES, KINDS, Sheet, is_plain_number

_FEWEST_HEADINGS: Final = 2
_IN_BRACKETS: Final = re.compile(r"[^\d\[(]+[\[(]([^\])]*)[\])]")
"""A unit in brackets after words, such as "Masse [kg]"."""


@dataclass(frozen=True, slots=True)
class Section:
    """Position of a table on a sheet; rows and columns count from 0.

    sheet: sheet; for one of several series, with further columns at the right for the texts above it.
    header, start, end: first row of the headings, first row below headings and units, and row behind the last one.
    columns: indices of its columns on the sheet.
    headings, units: headings, and cells of the row of units, "" without one, for each column.
    own: columns that belong to no other series of the table.
    titles: rows above the headings with a text for each series.
    is_last: True if no series follows in the next column.
    """

    sheet: Sheet
    header: int
    start: int
    end: int
    columns: tuple[int, ...]
    headings: tuple[str, ...]
    units: tuple[str, ...]
    own: range
    titles: range = range(0)
    is_last: bool = True

    @property
    def key(self) -> str:
        """Name of the table in answers, SHEET:ROW with the row of its headings."""
        return f"{self.sheet.name}:{self.header + 1}"

    def qualified(self) -> bool:
        """True if the row above has several words, one above a heading of numbers: they may qualify the headings."""
        above = [self.sheet.cell(self.header - 1, column) for column in self.columns] if self.header else []
        words = [(text, heading) for text, heading in zip(above, self.headings, strict=False) if text]
        return (
            not self.titles
            and len(words) > 1
            and not any(re.search(r"[\d:]", text) for text, _ in words)
            and any(unit_of_column(name) for _, heading in words for name in _stated_columns(heading))
        )

    def has(self, row: int, column: int) -> bool:
        """True if a cell belongs to the table or its titles; a row with a single text is a note instead."""
        if row in self.titles and column < self.own.stop:
            return True
        if not self.header <= row < self.end or column not in self.columns:
            return False
        texts = _filled(self.sheet, row, self.columns)
        return row < self.start or len(texts) > 1 or self.columns[0] not in texts


def find_sections(sheet: Sheet, tables: Mapping[str, str]) -> list[Section]:
    """Find the tables of a sheet from top to bottom, also side by side; `tables`: the user's answers by SHEET:ROW."""
    heads: list[tuple[int, range, int]] = []
    below: set[int] = set()
    for row in range(len(sheet.rows)):
        answer = tables.get(f"{sheet.name}:{row + 1}")
        if answer == NONE or sheet.ignores_row(row):
            continue
        taken, below = below, set()
        groups = [group for group in _table_groups(sheet, row) if not taken & set(group)]
        single = [group for group in groups if answer or _is_header(_row_texts(sheet, row, group))]
        two_rows = () if answer else _two_row_headings(sheet, row, groups)
        pairs = [pair for pair in two_rows if not taken & set(pair)]
        heads += [(row, group, 1) for group in single if not any(set(group) & set(pair) for pair in pairs)]
        heads += [(row, group, 2) for group in pairs]
        below.update(column for group in pairs for column in group)
    sections: list[Section] = []
    for row in dict.fromkeys(row for row, _, _ in heads):
        on_row = [_make_section(sheet, row, group, count, heads) for at, group, count in heads if at == row]
        with_data = [
            part
            for part in on_row
            if any(len(_filled(sheet, at, part.columns)) > 1 for at in range(part.start, part.end))
        ]
        sections += _split_series(with_data)
    return sections


def _two_row_headings(sheet: Sheet, row: int, groups: Sequence[range]) -> Iterator[range]:
    """Column groups whose headings are split over this row and the next, by a hyphen or because both are needed."""
    if row + 1 >= len(sheet.rows) or sheet.ignores_row(row + 1):
        return
    lower = list(_groups(sheet, (row + 1,)))
    alone = {
        column
        for at, on_row in ((row, groups), (row + 1, lower))
        for group in on_row
        if _is_header(_row_texts(sheet, at, group))
        for column in group
    }
    for group in _groups(sheet, (row, row + 1)):
        top, below = _row_texts(sheet, row, group), [sheet.cell(row + 1, column) for column in group]
        hyphens = any(text.endswith("-") and _is_part(part) for text, part in zip(top, below, strict=True))
        both = any(top) and any(map(_is_part, below)) and not alone & set(group)
        if (hyphens or both) and not any(map(is_plain_number, (*top, *below))):
            headings = [_joined_heading(text, part) or text for text, part in zip(top, below, strict=True)]
            if _is_header(headings):
                yield group


def _is_part(text: str) -> bool:
    """True for a text that may be the second part of a heading: neither blank nor a unit, and without digits."""
    plain = re.sub(r"[\[(/].*", "", text)
    return not _is_unit(text) and not re.search(r"\d", plain)


def _is_unit(text: str) -> bool:
    """True for a known unit or a word for none, also in brackets."""
    plain = text.strip("[]()").strip()
    return plain.casefold() in NO_UNIT or bool(known_unit(plain))


def _unit_of_cell(text: str) -> str:
    """Unit that a cell of a row of units states, without brackets, and without words before them."""
    match = _IN_BRACKETS.fullmatch(text)
    if match:
        return match[1].strip() if known_unit(match[1]) else text
    return text.strip("[]()").strip()


def _joined_heading(top: str, below: str) -> str:
    """Heading of two cells, one below the other, if both are needed for it; otherwise ""."""
    if not _is_part(below):
        return ""
    if not top or top.endswith("-"):
        return top.removesuffix("-") + below
    both = f"{top} {below}"
    names = _stated_columns(both)
    return both if names and (not _stated_columns(top) or (names == _stated_columns(top) and named_unit(both))) else ""


def _stated_columns(heading: str) -> set[str]:
    """Columns of all tables that a heading states."""
    return {column for form in KINDS.values() if (column := stated_column(form, heading))}


def _groups(sheet: Sheet, rows: Sequence[int]) -> Iterator[range]:
    """Ranges of at least two neighbouring columns that have a text in one of the rows."""
    width = max(len(sheet.filled[row]) for row in rows)
    filled = [any(sheet.cell(row, column, filled=True) for row in rows) for column in range(width)]
    start = 0
    for column in range(width + 1):
        if column == width or not filled[column] or sheet.ignores_column(column):
            if column - start >= _FEWEST_HEADINGS:
                yield range(start, column)
            start = column + 1


def _table_groups(sheet: Sheet, row: int) -> list[range]:
    """Ranges of columns with texts on a row, separated by empty columns, unless only all together make a table."""
    groups = list(_groups(sheet, (row,)))
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


def _make_section(
    sheet: Sheet, row: int, columns: range, rows_of_headings: int, heads: Sequence[tuple[int, range, int]]
) -> Section:
    """Section below one or two rows of headings, up to the next; without its empty and hidden columns."""
    later = [other for other, group, _ in heads if other > row and set(group) & set(columns)]
    top = _row_texts(sheet, row, columns)
    below = [sheet.cell(row + 1, column) for column in columns]
    headings, start = tuple(top), row + 1
    units: tuple[str, ...] = ()
    joined = [_joined_heading(text, part) for text, part in zip(top, below, strict=True)]
    parts = not any(map(is_plain_number, below)) and any(joined)
    if parts or rows_of_headings > 1:
        headings = tuple(new or text for new, text in zip(joined, top, strict=True))
        below = ["" if new else part for new, part in zip(joined, below, strict=True)]
        third = [_unit_of_cell(sheet.cell(row + 2, column)) for column in columns]
        if all(map(_is_unit, third)) and any(map(known_unit, third)):
            below = [cell or part for cell, part in zip(third, below, strict=True)]
            start = row + 2
    below = [_unit_of_cell(cell) for cell in below]
    texts = [text for text in below if text]
    has_units = any(map(known_unit, texts)) or len(texts) >= _FEWEST_HEADINGS
    if parts or rows_of_headings > 1 or (has_units and not any(map(is_plain_number, texts))):
        units, start = tuple(below), start + 1
    end = min(later, default=len(sheet.rows))
    while end > start:
        last = [text for text in _row_texts(sheet, end - 1, columns) if text]
        if len(last) > 1 or any(map(is_plain_number, last)):
            break  # a row of data; a blank row, and a row of a title or note only, belong to the next table
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


def _split_series(sections: Sequence[Section]) -> list[Section]:
    """Split tables with repeated columns (load, depth, load, depth) into one section for each series.

    Series share the columns on their left that do not repeat. If no column names the tests, each row above the
    headings with one text for each series becomes a column with this text in all rows of the series.
    """
    series = [part for section in sections for part in _repeated_parts(section)]
    own = [
        [heading_words(text) for place, text in zip(part.columns, part.headings, strict=True) if place in part.own]
        for part in series
    ]
    is_titled = len(series) > 1 and all(words == own[0] for words in own) and not _names_tests(series[0].headings)
    return _with_titles(series) if is_titled else series


def _names_tests(headings: Sequence[str]) -> bool:
    """True if a heading is that of the tests of a table."""
    return any(stated_column(form, heading) == form.key for form in KINDS.values() for heading in headings)


def _repeated_parts(section: Section) -> list[Section]:
    """Parts of a table whose headings repeat as a whole, each with the shared columns; else only the table itself."""
    words = [heading_words(heading) for heading in section.headings]
    times = Counter(words)
    starts = [place for place, word in enumerate(words) if word == next((w for w in words if w and times[w] > 1), None)]
    blocks = [range(*ends) for ends in pairwise((*starts, len(words)))]
    shared = section.headings[: starts[0]] if starts else ()
    if (
        not starts
        or any(words[block.start : block.stop] != words[starts[0] : blocks[0].stop] for block in blocks)
        or _names_tests(shared)
        or not any(unit_of_column(name) for place in blocks[0] for name in _stated_columns(section.headings[place]))
    ):
        return [section]
    parts = []
    for block in blocks:
        places = (*range(starts[0]), *block)
        columns, headings = (tuple(values[place] for place in places) for values in (section.columns, section.headings))
        units = tuple(section.units[place] for place in places) if section.units else ()
        own = range(columns[len(shared)], columns[-1] + 1)
        parts.append(replace(section, columns=columns, headings=headings, units=units, own=own, is_last=False))
    parts[-1] = replace(parts[-1], is_last=True)
    return parts


def _with_titles(series: Sequence[Section]) -> list[Section]:
    """Copies of series that are side by side, each with a further column for each row of titles above them."""
    first = series[0]
    sheet, row = first.sheet, first.header
    while row and not sheet.ignores_row(row - 1) and all(len(_filled(sheet, row - 1, p.own)) == 1 for p in series):
        row -= 1
    titles = [title for at in range(row, first.header) for title in _titles(series, at)]
    left = max(map(len, sheet.filled)) + 1
    rows, filled = (
        [[*cells, *[""] * (left - len(cells) + len(titles) * len(series))] for cells in kind]
        for kind in (sheet.rows, sheet.filled)
    )
    fractions = set(sheet.fractions)
    named = []
    for part in series:
        places = tuple(range(left, left + len(titles)))
        left += len(titles)
        for at in (at for at in range(part.start, part.end) if _filled(sheet, at, part.own)):
            for place, title in zip(places, titles, strict=True):
                value, source = title.values[part.own]
                rows[at][place] = filled[at][place] = value
                fractions |= {(at, place)} if source in sheet.fractions else set()
        units = (*(part.units or [""] * len(part.columns)), *(title.unit for title in titles))
        headings = (*part.headings, *(title.heading for title in titles))
        titled = range(row, first.header)
        named.append(replace(part, columns=part.columns + places, headings=headings, units=units, titles=titled))
    after = replace(sheet, rows=rows, filled=filled, fractions=frozenset(fractions))
    return [replace(part, sheet=after) for part in named]


def _filled(sheet: Sheet, row: int, columns: Sequence[int]) -> list[int]:
    """Columns with a text in the row."""
    return [column for column in columns if sheet.cell(row, column)]


@dataclass(frozen=True, slots=True)
class _Title:
    """A column made of titles above series: heading, unit, and by a series' own columns its value and its cell."""

    heading: str
    unit: str
    values: Mapping[range, tuple[str, tuple[int, int] | None]]


def _titles(series: Sequence[Section], row: int) -> Iterator[_Title]:
    """Columns from a row of titles above series; their headings are a label at the left or words in the titles."""
    sheet = series[0].sheet
    places = [_filled(sheet, row, part.own)[0] for part in series]
    label = next((text for column in range(series[0].own.start)[::-1] if (text := sheet.cell(row, column))), "")
    texts = [sheet.cell(row, place) for place in places]
    parts = [[text] if label else re.split(r"[,;|]\s+", text) for text in texts]
    if len({len(of_series) for of_series in parts}) > 1:
        parts = [[text] for text in texts]
    for number, values in enumerate(zip(*parts, strict=True), start=1):
        pairs = [_named_value(value) for value in values]
        same = not label and len({heading_words(words) for words, _ in pairs}) == 1
        heading = pairs[0][0] if same else label
        plain = [value for _, value in pairs] if same else values
        matches = [re.fullmatch(r"([+-]?\d+(?:[.,]\d+)?)\s*(\D+)", value) for value in plain]
        units = {known_unit(match[2]) if match else "" for match in matches}
        unit = units.pop() if len(units) == 1 else ""
        stored = [match[1] if match and unit else value for match, value in zip(matches, plain, strict=True)]
        yield _Title(
            heading or f"{sheet.name}:{row + 1}" + (f".{number}" if len(parts[0]) > 1 else ""),
            unit,
            {
                part.own: (value, (row, place) if value == sheet.cell(row, place) else None)
                for part, value, place in zip(series, stored, places, strict=True)
            },
        )


def _named_value(text: str) -> tuple[str, str]:
    """Split a text such as "Versuch 1" or "Kantwinkel: 30°" into heading and value; "" for an unknown heading."""
    ends = [match for match in re.finditer(r"[\s:=]+(?=\S)", text) if not re.search(r"\d", text[: match.start()])]
    return next(
        ((text[: end.start()], text[end.end() :]) for end in ends[::-1] if _stated_columns(text[: end.start()])),
        ("", text),
    )


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
