"""Workbooks of spreadsheet programs (.xlsx): the cells of their sheets as text, within limits.

The size of the zip archive is checked before openpyxl opens it. Nothing is computed: a formula gives the value that the
spreadsheet program stored with it, and one without a value is refused.
"""

from __future__ import annotations

import io
import re
import warnings
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date, datetime, time
from functools import partial
from typing import Any, Final, TypeAlias

from .text_files import ContentError

Rows: TypeAlias = list[list[str]]
"""Cells as texts, row 1 first, blank rows as empty lists."""

MOST_WORKBOOK_BYTES: Final = 1 << 25
MOST_UNPACKED_BYTES: Final = 1 << 26
MOST_ROWS: Final = 1 << 20
"""Rows and columns of a sheet of Excel."""
MOST_COLUMNS: Final = 1_000

_TYPED_FRACTION: Final = re.compile(r"\s*[+-]?[0-9]++([.,])[0-9]++\s*")
_FORMULA_ALONE: Final = re.compile(
    rb'<c\s(?![^>]*\bt="str")[^>]*?\br="([A-Z]+[0-9]+)"[^>]*>\s*<f\b(?:[^>]*/>|[^>]*>[^<]*</f>)\s*'
    rb"(?:<v\s*/>|<v>\s*</v>)?\s*</c>"
)
"""Cell with a formula but no value; the value of a formula may be an empty text."""
_OLD_KIND: Final = b"\xd0\xcf\x11\xe0"


def workbook_sheets(
    data: bytes, *, wanted: Callable[[str], bool], fractions: dict[str, list[tuple[int, int]]] | None = None
) -> dict[str, Rows | None]:
    """Read the sheets of a workbook.

    wanted: function that returns True for the name of a sheet to read.
    fractions: dictionary to which row and column, from 0, of each number with a fraction are added, by sheet; all such
        numbers then have a decimal point.
    Returns: rows by the names of the sheets, in their order; None for other sheets. Numbers have a decimal point, or a
        decimal comma where other cells of the sheet are numbers that were typed as text with a comma; days are written
        as 2026-11-23 and times as 2026-11-23T09:10:00, line breaks in a cell are spaces.
    """
    _require_sound(data)
    from openpyxl import load_workbook

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of parts that are not read: validations, drawings
        book = _call_openpyxl(lambda: load_workbook(io.BytesIO(data), read_only=True, data_only=True, keep_links=False))
        places: dict[str, list[tuple[int, int]]] = {} if fractions is None else fractions
        return {
            sheet.title: _read_rows(sheet, places.setdefault(sheet.title, []), like_typed=fractions is None)
            if wanted(sheet.title)
            else None
            for sheet in book.worksheets
        }


@dataclass(frozen=True, slots=True)
class Layout:
    """Layout of a sheet; rows and columns count from 0.

    merged: merged ranges as top, left, bottom and right.
    is_hidden, hidden, hidden_columns: True for a hidden sheet, and the hidden rows and columns of any sheet.
    struck, partly_struck: row and column of each cell that is struck through, as a whole or in a part of its text.
    """

    merged: tuple[tuple[int, int, int, int], ...]
    is_hidden: bool
    hidden: frozenset[int]
    hidden_columns: frozenset[int]
    struck: frozenset[tuple[int, int]]
    partly_struck: frozenset[tuple[int, int]]


def sheet_layouts(data: bytes) -> dict[str, Layout]:
    """Layout of each sheet; errors as `workbook_sheets`."""
    _require_sound(data)
    from openpyxl import load_workbook

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        book = _call_openpyxl(lambda: load_workbook(io.BytesIO(data), keep_links=False, rich_text=True))
    return {sheet.title: _layout_of(sheet) for sheet in book.worksheets}


def _layout_of(sheet: Any) -> Layout:
    """Merged, hidden and struck-out cells of a sheet of openpyxl, with rows and columns counted from 0."""
    cells = {(row - 1, column - 1): cell for (row, column), cell in sheet._cells.items() if cell.value is not None}
    columns = (dimension for dimension in sheet.column_dimensions.values() if dimension.hidden)
    return Layout(
        tuple((area.min_row - 1, area.min_col - 1, area.max_row - 1, area.max_col - 1) for area in sheet.merged_cells),
        sheet.sheet_state != "visible",
        frozenset(row - 1 for row, dimension in sheet.row_dimensions.items() if dimension.hidden),
        frozenset(at for span in columns for at in range(span.min - 1, min(span.max, MOST_COLUMNS))),
        frozenset(place for place, cell in cells.items() if cell.font.strike),
        frozenset(place for place, cell in cells.items() if _is_partly_struck(cell.value)),
    )


def _is_partly_struck(value: Any) -> bool:
    """True if a cell's value is rich text with a part that is struck out."""
    return isinstance(value, list) and any(getattr(part, "font", None) and part.font.strike for part in value)


def _call_openpyxl(doing: Callable[[], Any]) -> Any:
    """Result of a call of openpyxl; each of its many errors for damaged files becomes a ContentError."""
    try:
        return doing()
    except ContentError:
        raise
    except Exception as error:
        raise ContentError(
            "This is not a workbook that can be read, or it is damaged. Open it in a spreadsheet program, "
            "and save it as .xlsx."
        ).tag("not_readable") from error


def _read_rows(sheet: Any, fractions: list[tuple[int, int]], *, like_typed: bool) -> Rows:
    """Texts of cells; `fractions` collects the places of floats, which `like_typed` writes with the typed mark."""
    sheet.reset_dimensions()  # the stated size may be wrong
    rows: Rows = []
    typed = {".": 0, ",": 0}

    def read() -> None:
        for cells in sheet.iter_rows(values_only=True):
            if len(rows) >= MOST_ROWS:
                raise ContentError("The sheet {sheet!r} has more than {limit} rows. Remove some.").tag(
                    "too_large", limit=MOST_ROWS, sheet=sheet.title
                )
            texts = [_cell_text(value) for value in cells]
            for value in cells:
                if isinstance(value, str) and (fraction := _TYPED_FRACTION.fullmatch(value)):
                    typed[fraction[1]] += 1
            fractions.extend((len(rows), place) for place, text in enumerate(texts) if isinstance(cells[place], float))
            while texts and not texts[-1]:
                texts.pop()
            if len(texts) > MOST_COLUMNS:
                raise ContentError(
                    "Row {row} of the sheet {sheet!r} has {count} cells; at most {limit} columns are read. "
                    "Remove the unused ones."
                ).tag("too_large", row=len(rows) + 1, sheet=sheet.title, count=len(texts), limit=MOST_COLUMNS)
            rows.append(texts)

    _call_openpyxl(read)
    while rows and not rows[-1]:
        rows.pop()
    if like_typed and typed[","] > typed["."]:  # then a reader would take 43.5 for a thousand
        for row, place in fractions:
            rows[row][place] = rows[row][place].replace(".", ",")
    return rows


def _cell_text(value: object) -> str:
    """Text of a cell's value: "" for None, whole floats without ".0", dates in ISO form, line breaks as spaces."""
    if value is None or isinstance(value, bool):
        return "" if value is None else str(value).upper()
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    return _date_text(value) if isinstance(value, date | time) else re.sub(r"\s*[\r\n]\s*", " ", str(value)).strip()


def _date_text(value: date | time) -> str:
    """ISO text of a date or time to the second; a date alone for midnight."""
    if isinstance(value, datetime) and value.time() == time():
        return value.date().isoformat()
    if isinstance(value, datetime | time):
        return value.isoformat(timespec="seconds")
    return value.isoformat()


def _require_sound(data: bytes) -> None:
    """Reject a workbook that is too large, protected, in the old form, or has formulas without values."""
    if len(data) > MOST_WORKBOOK_BYTES:
        raise ContentError("The workbook is too large: at most {limit} MiB are read. Save it as CSV.").tag(
            "too_large", limit=MOST_WORKBOOK_BYTES >> 20
        )
    if data.startswith(_OLD_KIND):
        raise ContentError(
            "The workbook is protected by a password, or in Excel's old form. Save it as .xlsx without a password."
        ).tag("not_readable")
    _call_openpyxl(partial(_require_small_parts, data))


def _require_small_parts(data: bytes) -> None:
    """Reject a workbook that is too large when unpacked, or with a formula that has no stored value."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(part.file_size for part in archive.infolist()) > MOST_UNPACKED_BYTES:  # zipfile reads no byte more
            raise ContentError(
                "The workbook has more than {limit} MiB when it is unpacked. Save its sheets as CSV."
            ).tag("too_large", limit=MOST_UNPACKED_BYTES >> 20)
        for name in archive.namelist():
            if name.startswith("xl/worksheets/") and (cell := _FORMULA_ALONE.search(archive.read(name))):
                raise ContentError(
                    "The cell {cell} ({part}) has a formula without its value. Open the workbook in a "
                    "spreadsheet program and save it."
                ).tag("formula_without_value", cell=cell[1].decode(), part=name)
