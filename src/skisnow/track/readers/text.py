"""Text and tables in files of tracks: decoding, separation into cells, times."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final

from ..._support.spreadsheet_text import (
    LONGEST_CELL,
    MOST_COLUMNS,
    SEPARATOR_NAMES,
    NoTextError,
    decimal_mark,
    decoded,
    most_frequent_separator,
    named_separator,
)
from .recording import track_error

if TYPE_CHECKING:
    from collections.abc import Iterable

_HEAD: Final = 1 << 16


def decode_text(data: bytes, name: str) -> str:
    """Decode UTF-8, UTF-16 with byte order mark, or Windows-1252; all line ends become line feeds.

    All byte order marks are removed: concatenated files have several.

    Raises
    ------
    FieldDataError
        The bytes are not text.
    """
    try:
        return "\n".join(decoded(data).text.replace("\ufeff", "").splitlines())
    except NoTextError as error:
        raise _no_text(name, error.place) from error


def _no_text(name: str, value: str) -> Exception:
    return track_error(
        "unreadable_file",
        name,
        value=value,
        allowed="text in UTF-8, UTF-16 with byte order mark, or Windows-1252; or FIT or UBX",
        action="The file is neither text nor a known format of receivers; export it as CSV, GPX or FIT.",
    )


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells of a table: the header, and rows with the line of the file at which each begins."""

    header: tuple[str, ...]
    header_line: int
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    separator: str


def split_cells(text: str, name: str) -> Cells:
    """Split a CSV file into cells by the most frequent of comma, semicolon and tab, or by a first line ``sep=;``.

    Raises
    ------
    FieldDataError
        There is no header, a quote is never closed, a cell is too long, or there are too many columns.
    """
    lines = text.split("\n")
    named = named_separator(lines[0])
    first = 1 if named in SEPARATOR_NAMES else 0
    if not any(re.sub('[,;"]', "", line).strip() for line in lines[first:]):
        raise track_error("empty_file", name, allowed="a header and rows", action="The file is empty.")
    separator = named if first and named else most_frequent_separator(text[:_HEAD])
    reader = csv.reader(lines[first:], delimiter=separator, skipinitialspace=True, strict=True)
    numbers: list[int] = []
    rows: list[tuple[str, ...]] = []
    begun = first + 1
    try:
        for row in reader:
            stripped = tuple(cell.strip() for cell in row)
            if any(stripped):
                numbers.append(begun)
                rows.append(stripped)
            begun = first + reader.line_num + 1
    except csv.Error as error:
        raise track_error(
            "unreadable_file",
            name,
            place=f"row {begun}",
            value=str(error),
            allowed=f"cells with quotes in pairs, of at most {LONGEST_CELL} characters",
            action="Close the quote, or take it away.",
        ) from error
    _require_size(rows, numbers, name)
    return Cells(rows[0], numbers[0], tuple(numbers[1:]), tuple(rows[1:]), separator)


def _require_size(rows: list[tuple[str, ...]], lines: list[int], name: str) -> None:
    """Reject tables with too many columns or too long cells before they are processed."""
    for line, row in zip(lines, rows, strict=True):
        if len(row) > MOST_COLUMNS:
            raise track_error(
                "too_many_cells",
                name,
                place=f"row {line}",
                value=f"{len(row)} cells",
                allowed=f"at most {MOST_COLUMNS} columns",
                action="Take out the columns that are not needed.",
            )
        if max(map(len, row)) > LONGEST_CELL:
            raise track_error(
                "unreadable_file",
                name,
                place=f"row {line}",
                value=max(row, key=len),
                allowed=f"cells of at most {LONGEST_CELL} characters",
                action="Shorten the cell; is a separator or a quote missing?",
            )


def require_width(cells: Cells, name: str) -> None:
    """Reject a row with more cells than the header, such as with decimal commas in a file separated by commas.

    Raises
    ------
    FieldDataError
        A row has more cells than the header.
    """
    width = len(cells.header)
    for line, row in zip(cells.lines, cells.rows, strict=True):
        if any(row[width:]):
            raise track_error(
                "too_many_cells",
                name,
                place=f"row {line}",
                value=next(filter(None, row[width:])),
                allowed=f"{width} {'cell' if width == 1 else 'cells'}, as in the header",
                action="A decimal comma in a file separated by commas looks like this; separate by semicolons.",
            )


def decimal_mark_of(cells: Iterable[str], separator: str) -> str:
    """Decimal mark of a file: a comma if it is not the separator and at least as frequent as the point in numbers.

    >>> decimal_mark_of(["1", "2,5", "1.5"], ";"), decimal_mark_of(["1", "2"], ";")
    (',', '.')
    """
    return "." if separator == "," else decimal_mark([cells], separator=separator)


def moment(cell: str) -> datetime | None:
    """Date and time in a cell by ISO 8601, converted to UTC if it has a zone; None if it is not a date and time.

    >>> moment("2022-12-27T16:51:14.5+01:00").isoformat()
    '2022-12-27T15:51:14.500000+00:00'
    """
    if len(cell) < len("2022-12-27T15:51") or not cell.isascii():
        return None
    try:
        time = datetime.fromisoformat(cell)
        return time if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):
        return None
