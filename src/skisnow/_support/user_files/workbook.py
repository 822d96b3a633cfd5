"""Workbooks of spreadsheet programs (.xlsx): the cells of their sheets as text, within limits.

The zip archive is checked before openpyxl opens it: sizes are counted while parts are unpacked, not believed,
and a part with a document type, in which entities could grow without end, is refused. Nothing is computed: a formula
gives the value that the spreadsheet program stored with it, and one without a value is refused.
"""

from __future__ import annotations

import io
import re
import warnings
import zipfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import date, datetime, time
from functools import partial
from typing import Any, Final, TypeAlias
from xml.parsers import expat

from .text_files import ContentError

Rows: TypeAlias = list[list[str]]
"""Cells as texts, row 1 first, blank rows as empty lists."""

MOST_WORKBOOK_BYTES: Final = 1 << 25
MOST_UNPACKED_BYTES: Final = 1 << 26
MOST_PARTS: Final = 2_000
MOST_SHEETS: Final = 100
MOST_ROWS: Final = 1 << 20
"""Rows and columns of a sheet of Excel."""
MOST_COLUMNS: Final = 1_000
MOST_ELEMENTS: Final = 8_000_000
DEEPEST_ELEMENT: Final = 64

_TYPED_FRACTION: Final = re.compile(r"\s*[+-]?[0-9]++([.,])[0-9]++\s*")
_CHUNK: Final = 1 << 18
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
        if len(book.worksheets) > MOST_SHEETS:
            raise ContentError("The workbook has {count} sheets; at most {limit} are read. Remove some.").tag(
                "too_large", count=len(book.worksheets), limit=MOST_SHEETS
            )
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

    with warnings.catch_warnings(), zipfile.ZipFile(io.BytesIO(data)) as archive:
        warnings.simplefilter("ignore")
        book = _call_openpyxl(lambda: load_workbook(io.BytesIO(data), read_only=True, keep_links=False))
        return {sheet.title: _call_openpyxl(partial(_read_layout, archive, sheet)) for sheet in book.worksheets}


def _read_layout(archive: zipfile.ZipFile, sheet: Any) -> Layout:
    """Merged, hidden and struck-out cells of a sheet from its XML, with rows and columns counted from 0."""
    from openpyxl.utils.cell import range_boundaries

    text = archive.read(sheet._worksheet_path)
    names = re.findall(rb"<(?:\w+:)?mergeCell\s[^>]*?ref=\"([A-Z]+[0-9]+:[A-Z]+[0-9]+)\"", text)
    bounds = (range_boundaries(name.decode()) for name in names)
    hidden = rb"\s(?=[^>]*?\bhidden=\"(?:1|true)\")"
    rows = re.findall(rb"<(?:\w+:)?row" + hidden + rb"[^>]*?\br=\"([0-9]+)\"", text)
    spans = re.findall(rb"<(?:\w+:)?col" + hidden + rb"(?=[^>]*?\bmin=\"([0-9]+)\")[^>]*?\bmax=\"([0-9]+)\"", text)
    struck: Iterable[tuple[int, int]] = ()
    if any(font.strike for font in sheet.parent._fonts):
        sheet.reset_dimensions()
        cells = (cell for row in sheet.iter_rows() for cell in row if cell.value is not None)
        struck = ((cell.row - 1, cell.column - 1) for cell in cells if cell.font.strike)
    return Layout(
        tuple((top - 1, left - 1, bottom - 1, right - 1) for left, top, right, bottom in bounds),
        sheet.sheet_state != "visible",
        frozenset(int(row) - 1 for row in rows),
        frozenset(at for first, last in spans for at in range(int(first) - 1, min(int(last), MOST_COLUMNS))),
        frozenset(struck),
        frozenset(_partly_struck(archive, text)),
    )


_STRIKE: Final = re.compile(rb"<(?:\w+:)?strike(?:\s+val=\"(?:1|true)\")?\s*/>")


def _partly_struck(archive: zipfile.ZipFile, sheet: bytes) -> Iterable[tuple[int, int]]:
    """Row and column (from 0) of cells with a part of their text struck through; openpyxl does not report these."""
    from openpyxl.utils.cell import coordinate_to_tuple

    name = next((name for name in archive.namelist() if name.lower().endswith("/sharedstrings.xml")), None)
    texts = re.findall(rb"<(?:\w+:)?si\s*/>|<(?:\w+:)?si\b.*?</(?:\w+:)?si>", archive.read(name) if name else b"", re.S)
    struck = {b"%d" % index for index, text in enumerate(texts) if _STRIKE.search(text)}
    for cell in (
        re.finditer(rb"<(?:\w+:)?c\s([^>]*)>(.*?)</(?:\w+:)?c>", sheet, re.S) if struck or b"strike" in sheet else ()
    ):
        place = re.search(rb"\br=\"([A-Z]+[0-9]+)\"", cell[1])
        index = re.search(rb"<(?:\w+:)?v>([0-9]+)<", cell[2]) if b't="s"' in cell[1] else None
        if place and ((index and index[1] in struck) or _STRIKE.search(cell[2])):
            row, column = coordinate_to_tuple(place[1].decode())
            yield row - 1, column - 1


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
    """Text of a cell's value: "" for None, whole floats without ".0", ISO dates, line breaks as spaces."""
    if value is None or isinstance(value, bool):
        return "" if value is None else str(value).upper()
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, datetime) and value.time() == time():
        return value.date().isoformat()
    if isinstance(value, datetime | time):
        return value.isoformat(timespec="seconds")
    return value.isoformat() if isinstance(value, date) else re.sub(r"\s*[\r\n]\s*", " ", str(value)).strip()


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
    if data.count(b"PK\1\2") > MOST_PARTS:
        raise ContentError("The workbook has more than {limit} parts, which no table has.").tag(
            "too_large", limit=MOST_PARTS
        )
    _call_openpyxl(partial(_require_small_parts, data))


def _require_small_parts(data: bytes) -> None:
    """Reject a workbook that is too large when unpacked, or with a formula that has no stored value."""
    unpacked = 0
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for part in archive.infolist():
            checked = _Part(part.filename) if part.filename.endswith((".xml", ".rels")) else None
            with archive.open(part) as content:
                while piece := content.read(_CHUNK):
                    unpacked += len(piece)
                    if unpacked > MOST_UNPACKED_BYTES:
                        raise ContentError(
                            "The workbook has more than {limit} MiB when it is unpacked. Save its sheets as CSV."
                        ).tag("too_large", limit=MOST_UNPACKED_BYTES >> 20)
                    if checked is not None:
                        checked.parser.Parse(piece, False)
            if checked is not None:
                checked.parser.Parse(b"", True)


class _Part:
    """Checker of the XML of one part of a workbook, which its `parser` receives in pieces; raises ContentError."""

    def __init__(self, name: str) -> None:
        self._name = name
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.StartDoctypeDeclHandler = self._refuse_document_type
        self.parser.StartElementHandler = self._on_begin
        self.parser.EndElementHandler = self._on_end
        self.parser.CharacterDataHandler = self._on_text
        self._elements = self._depth = 0
        self._cell = ""
        self._is_text = self._is_value = False
        self._in_cell: set[str] = set()

    def _refuse_document_type(self, *_: object) -> None:
        """Reject a document type in a part of the workbook."""
        raise ContentError(
            "The workbook has a document type in its part {part}, which no spreadsheet program writes."
        ).tag("not_readable", part=self._name)

    def _on_begin(self, name: str, attributes: dict[str, str]) -> None:
        """Count an element and record the cell it begins; rejects too many or too deep elements."""
        self._elements += 1
        self._depth += 1
        if self._elements > MOST_ELEMENTS or self._depth > DEEPEST_ELEMENT:
            raise ContentError("The part {part} of the workbook is larger than any table. Save its sheets as CSV.").tag(
                "too_large", part=self._name
            )
        local = name.rpartition(" ")[2]
        if local == "c":
            self._cell = attributes.get("r", "?")
            self._is_text = attributes.get("t") == "str"
            self._in_cell.clear()
        elif local == "f" or (local == "v" and self._is_text):  # the result of a formula may be an empty text
            self._in_cell.add(local)
        self._is_value = local == "v"

    def _on_text(self, text: str) -> None:
        """Record that the present cell has a value."""
        if self._is_value and text.strip():
            self._in_cell.add("v")

    def _on_end(self, name: str) -> None:
        """End an element; rejects a cell with a formula but without a stored value."""
        self._depth -= 1
        self._is_value = False
        if name.endswith(" c") and self._in_cell == {"f"}:
            raise ContentError(
                "The cell {cell} ({part}) has a formula without its value. Open the workbook in a "
                "spreadsheet program and save it."
            ).tag("formula_without_value", cell=self._cell[:20], part=self._name)
