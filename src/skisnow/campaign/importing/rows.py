"""Rows of a table to import as they are stored: names filled down, numbers in the units of their columns."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from ..._support.messages import Message
from ..._support.spreadsheet_text import is_number
from ..reading.headings import letters
from ..reading.table_forms import TableForm
from .answers import Dialogue
from .columns import ColumnChoice, number_columns
from .sections import Section
from .sheets import EXCLUDED, column_letters

_SUMMARY: Final = {
    "mittel", "mittelwert", "mean", "average", "durchschnitt", "summe", "sum", "total", "gesamt", "stabw", "std",
    "median", "maximum", "minimum", "max", "min",
}  # fmt: skip
"""Words of rows below a table that are not a measurement."""
_THOUSANDS: Final = re.compile(r"[+-]?[1-9]\d{0,2}(?:[.,]\d{3})+")
_GROUPED: Final = {
    ",": re.compile(r"[+-]?[1-9]\d{0,2}(?:(?:['’]\d{3})+(?:,\d+)?|(?:\.\d{3})+,\d+)"),
    ".": re.compile(r"[+-]?[1-9]\d{0,2}(?:(?:['’]\d{3})+(?:\.\d+)?|(?:,\d{3})+\.\d+)"),
}
"""Numbers with thousands separators that cannot be decimal marks, by decimal mark."""
DECIMAL: Final = "decimal"
THOUSANDS: Final = "thousands"
FILL_DOWN: Final = "fill-down"


@dataclass(frozen=True, slots=True)
class StoredRow:
    """A row of a campaign's table, cells by column, and its row number on the imported sheet, from 1."""

    source: int
    cells: dict[str, str]


@dataclass(frozen=True, slots=True)
class ImportedTable:
    """A table of the imported file, converted to a table of the campaign.

    section, form: table on the sheet, and form of the campaign's table.
    columns: columns of the sheet with their columns in the campaign and units.
    rows: rows as the campaign stores them.
    """

    section: Section
    form: TableForm
    columns: tuple[ColumnChoice, ...]
    rows: tuple[StoredRow, ...]


def stored_rows(
    section: Section, choices: Sequence[ColumnChoice], form: TableForm, dialogue: Dialogue
) -> list[StoredRow]:
    """Convert the rows of a section that have a required number; questions and errors are added to the dialogue."""
    sheet, numbers = section.sheet, number_columns(form)
    needed = {column.name for column in form.numbers if column.needed}
    places = [choice.place for choice in choices if choice.column in needed and choice.place in section.own]
    rows = [
        row
        for row in range(section.start, section.end)
        if any(sheet.cell(row, place) and not sheet.ignores(row, place) for place in places)
    ]
    used = {choice.column: choice for choice in choices if choice.column}
    mark = _decimal_mark(section, [choice for choice in used.values() if choice.column in numbers], rows, dialogue)
    stored, above = [], dict[str, str]()
    for row in rows:
        cells = {
            name: "" if sheet.ignores(row, choice.place) else sheet.cell(row, choice.place, filled=True)
            for name, choice in used.items()
        }
        texts = [text for name, text in cells.items() if name not in numbers and name != "remark"]
        if any(word in _SUMMARY for text in texts for word in letters(text).split()):
            dialogue.ask("ignore", f"{sheet.name}!{row + 1}", section.key, row=row + 1, value=cells.get(form.key))
        _fill_down(section, row, cells, above, form, dialogue)
        above = dict(cells)
        if _is_excluded(section, row, [choice.place for choice in used.values()], dialogue):
            continue
        partly = next((choice.place for choice in used.values() if (row, choice.place) in sheet.partly_struck), None)
        if partly is not None:
            value = Message("a cell that is struck through in part: {text}", text=sheet.cell(row, partly))
            dialogue.ask("ignore", f"{sheet.name}!{row + 1}", section.key, row=row + 1, value=value)
            continue
        for name in numbers:
            if name in used and cells[name]:
                choice = used[name]
                cells[name] = _number(section, row, choice, cells[name], mark, dialogue)
        stored.append(StoredRow(row + 1, cells))
    _refuse_strays(section, rows, dialogue)
    _refuse_split_numbers(section, choices, rows, numbers, dialogue)
    return stored


def _decimal_mark(section: Section, choices: Sequence[ColumnChoice], rows: Sequence[int], dialogue: Dialogue) -> str:
    """Decimal mark of numbers that are text; a question is added if they may have thousands separators instead."""
    sheet = section.sheet
    typed = [
        sheet.cell(row, choice.place)
        for row in rows
        for choice in choices
        if (row, choice.place) not in sheet.fractions
    ]
    if answer := dialogue.answers.cells.get(DECIMAL):
        return answer
    clear = {
        mark
        for text in typed
        if not _THOUSANDS.fullmatch(text)
        for mark in ",."
        if mark in text and is_number(_without_groups(text, mark), mark)
    }
    unclear = next((text for text in typed if _THOUSANDS.fullmatch(text)), None)
    if len(clear) == 1:
        return clear.pop()
    if clear or unclear:
        dialogue.ask("cells", DECIMAL, section.key, value=unclear or ", .", choices=(",", "."))
    return "."


def _without_groups(text: str, mark: str) -> str:
    """Text of a number without its thousands separators, if it clearly has some; otherwise unchanged."""
    return re.sub(rf"[^\d+{mark}-]", "", text) if _GROUPED[mark].fullmatch(text) else text


def _number(section: Section, row: int, choice: ColumnChoice, text: str, mark: str, dialogue: Dialogue) -> str:
    """Text of a number, converted to the unit of its column; "" with a question or an error if it is unclear."""
    sheet = section.sheet
    written = "." if (row, choice.place) in sheet.fractions else mark
    plain = _without_groups(text.replace("−", "-"), written)
    if not is_number(plain, written) and _THOUSANDS.fullmatch(plain):
        separator = "," if written == "." else "."
        if dialogue.answers.cells.get(THOUSANDS) == separator:
            plain = plain.replace(separator, "")
        else:
            if not any(dialogue.has_asked("cells", key) for key in (DECIMAL, THOUSANDS)):
                dialogue.ask("cells", THOUSANDS, section.key, row=row + 1, value=text, choices=(separator,))
            return ""
    if not is_number(plain, written):
        place = f"{sheet.name}!{column_letters(choice.place)}{row + 1}"
        allowed = Message("a number with the decimal mark {mark}", mark=written)
        action = Message("Correct the cell, or exclude it with --ignore {place}.", place=place)
        dialogue.refuse(
            "not_a_number", sheet.name, row=row + 1, column=choice.heading, value=text, allowed=allowed, action=action
        )
        return ""
    value = float(plain.replace(",", "."))
    return f"{value * choice.unit.factor + choice.unit.shift:.10g}" if choice.unit is not None else ""


def _fill_down(
    section: Section, row: int, cells: dict[str, str], above: dict[str, str], form: TableForm, dialogue: Dialogue
) -> None:
    """Fill blank names and angles in `cells` from the row `above` if the user answered so; otherwise add a question."""
    for name in (*form.names, "edge_angle_deg"):
        if name not in cells or cells[name] or not above.get(name):
            continue
        if dialogue.answers.cells.get(FILL_DOWN) == "yes":
            cells[name] = above[name]
        elif not dialogue.has_asked("cells", FILL_DOWN):
            value = Message("a blank cell below {value}", value=above[name])
            dialogue.ask("cells", FILL_DOWN, section.key, row=row + 1, value=value, choices=("yes",), proposed="yes")


def _is_excluded(section: Section, row: int, places: Sequence[int], dialogue: Dialogue) -> bool:
    """True if the user excludes rows like this one, hidden or struck through; adds a question without an answer."""
    answers, excluded = dialogue.answers.cells, section.sheet.excluded
    reasons = [reason for reason, cells in excluded.items() if any((row, place) in cells for place in places)]
    for reason in reasons:
        if reason not in answers and not dialogue.has_asked("cells", reason):
            value = EXCLUDED[reason]
            dialogue.ask("cells", reason, section.key, row=row + 1, value=value, choices=("yes", "no"))
    return any(answers.get(reason) == "no" for reason in reasons)


def _refuse_split_numbers(
    section: Section, choices: Sequence[ColumnChoice], rows: Sequence[int], numbers: Sequence[str], dialogue: Dialogue
) -> None:
    """Add an error if decimal commas of a CSV file seem to have split numbers into two cells."""
    if section.sheet.separator != ",":
        return
    for before, choice in pairwise(choices):
        if before.column in numbers and choice.column not in numbers:
            row = next((row for row in rows if section.sheet.cell(row, choice.place).isdecimal()), None)
            if row is not None:
                value, allowed = section.sheet.cell(row, choice.place), Message("a text below this heading")
                action = Message("Put decimal commas in quotes, or separate the cells by semicolons.")
                further = {"column": choice.heading, "value": value, "allowed": allowed, "action": action}
                dialogue.refuse("split_number", section.sheet.name, row=row + 1, **further)


def _refuse_strays(section: Section, rows: Sequence[int], dialogue: Dialogue) -> None:
    """Add errors for cells to the right of a table that have no heading: a separator may have split a number."""
    sheet = section.sheet
    for row in rows:
        right = section.own.stop
        while section.is_last and (text := sheet.cell(row, right)):
            if not sheet.ignores(row, right):
                place = f"{sheet.name}!{column_letters(right)}"
                action = Message("Add a heading, or exclude the column with --ignore {place}.", place=place)
                further = {"value": text, "allowed": Message("cells below a heading"), "action": action}
                dialogue.refuse("no_heading", sheet.name, row=row + 1, column=column_letters(right), **further)
            right += 1
