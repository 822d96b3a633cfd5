"""CSV files: decoding, and separation into records with their lines.

Supported are the formats of European spreadsheet programs: UTF-8 with or without byte order mark, UTF-16, Windows-1252;
comma, semicolon or tab; CR, LF or both. Cells are not interpreted here. Only lines with nothing but separators and
spaces are dropped.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Final, TypeAlias

from .messages import Message
from .spreadsheet_text import (
    LONGEST_CELL,
    MOST_COLUMNS,
    SEPARATOR_NAMES,
    DecodedText,
    NoTextError,
    decoded,
    most_frequent_separator,
    named_separator,
    remove_protection,
)

Records: TypeAlias = tuple[list[int], list[list[str]]]
"""File lines at which records begin, and the records' cells."""

RECORDS_AT_ONCE: Final = 256  # more lists at a time make the garbage collector walk all objects again and again

_CONTROL_BYTES: Final = bytes(code for code in range(32) if code not in b"\t\n\v\f\r") + b"\x7f"
_CONTROL_SHARE: Final = 0.01  # 0 in text, 0.1 in random bytes
_END: Final = "\0"  # a line that no text file holds: decode refuses the character
_HEAD: Final = 1 << 16


class UnreadableTextError(Exception):
    """A file is not valid text. ``row`` is the line of the problem, or None if unknown."""

    def __init__(self, *, value: str | None, allowed: Message, action: Message, row: int | None = None) -> None:
        super().__init__(allowed)
        self.row, self.value, self.allowed, self.action = row, value, allowed, action


def decode(data: bytes) -> DecodedText:
    """Decode a text file; UnreadableTextError unless it is UTF-8, UTF-16 with byte order mark, or Windows-1252."""
    try:
        text = decoded(data)
    except NoTextError as error:
        raise _binary_error(str(error) if error.place.startswith("byte") else error.place) from None
    plain = data if text.codec != "utf-16" else text.text.encode()
    control = len(plain) - len(plain.translate(None, _CONTROL_BYTES))
    if control > _CONTROL_SHARE * len(plain):
        raise _binary_error(f"{control} control characters among {len(plain)} bytes")
    return text


def _binary_error(value: str) -> UnreadableTextError:
    """Error that a file looks binary; `value` is the sign of it."""
    return UnreadableTextError(
        value=value,
        allowed=Message("text in UTF-8, UTF-16 with byte order mark, or Windows-1252"),
        action=Message("This looks like a binary file, such as a spreadsheet's own format; save it as CSV in UTF-8."),
    )


@dataclass(frozen=True, slots=True)
class CsvText:
    """A CSV file with its encoding and separator, before it is split into records.

    data: bytes of the file.
    codec, foreign_encoding: as in `DecodedText`.
    separator: comma, semicolon or tab.
    separator_line: True if line 1 is ``sep=;`` and the header begins below it.
    """

    data: bytes
    codec: str
    foreign_encoding: str | None
    separator: str
    separator_line: bool

    def records(self, most_lines: int | None = None) -> Iterator[Records]:
        """Split the file into records, in chunks; the first record is the header.

        most_lines: read only records that begin on one of these first lines.
        An apostrophe that protects a text from being read as a formula is removed.

        Raises UnreadableTextError: a quote is never closed, so that all further lines would be one cell; or a cell or
            row is too long.
        """
        for lines, rows in self._read_blocks(most_lines):
            _require_size(lines, rows)
            yield lines, rows

    def _read_blocks(self, most_lines: int | None) -> Iterator[Records]:
        """Line numbers and cells of rows in blocks, without blank rows; rejects a quote that is not closed."""
        stream = io.TextIOWrapper(io.BytesIO(self.data), encoding=self.codec, newline="")
        skipped = len(stream.readline()[:1]) if self.separator_line else 0
        reader = csv.reader(chain(stream, (_END,)), delimiter=self.separator, skipinitialspace=True)
        lines: list[int] = []
        rows: list[list[str]] = []
        line = 1 + skipped
        may_be_guarded = b"'" in self.data  # most files have no apostrophe
        try:
            for cells in reader:
                if len(rows) >= RECORDS_AT_ONCE:
                    yield lines, rows
                    lines, rows = [], []
                is_end = len(cells) == 1 and cells[0] == _END and reader.line_num + skipped == line
                if is_end or (most_lines is not None and line > most_lines):
                    yield lines, rows
                    return
                first = cells[0] if cells else ""
                if (first and not first.isspace()) or any(map(str.strip, cells)):
                    lines.append(line)
                    rows.append(list(map(remove_protection, cells)) if may_be_guarded else cells)
                line = reader.line_num + 1 + skipped
            line = lines.pop()  # its last cell swallowed the end
            rows.pop()
        except csv.Error:  # a cell beyond the csv module's limit: an open quote swallows the file, or it is as long
            yield lines, rows
            raise _quote_error(line, f"a cell of more than {csv.field_size_limit()} characters") from None
        yield lines, rows
        raise _quote_error(line, '"')


def _require_size(lines: list[int], rows: list[list[str]]) -> None:
    """Reject a row with too many cells or a cell with too many characters."""
    if max(map(len, rows), default=0) > MOST_COLUMNS:
        line, count = next(
            (line, len(cells)) for line, cells in zip(lines, rows, strict=True) if len(cells) > MOST_COLUMNS
        )
        raise UnreadableTextError(
            row=line,
            value=f"{count} cells",
            allowed=Message("at most {most_columns} columns", most_columns=MOST_COLUMNS),
            action=Message("Remove the unused columns."),
        )
    if max(map(len, chain.from_iterable(rows)), default=0) > LONGEST_CELL:
        line, cell = next(
            (line, cell) for line, cells in zip(lines, rows, strict=True) for cell in cells if len(cell) > LONGEST_CELL
        )
        raise UnreadableTextError(
            row=line,
            value=f"{cell[:40]}…",
            allowed=Message("cells of at most {longest_cell} characters", longest_cell=LONGEST_CELL),
            action=Message("Shorten the cell; is a separator or a quote missing?"),
        )


def _quote_error(line: int, value: str) -> UnreadableTextError:
    """Error for a quote, opened in this line, that is not closed, or a cell beyond the limit."""
    return UnreadableTextError(
        row=line,
        value=value,
        allowed=Message("quotes in pairs, and cells of at most {longest_cell} characters", longest_cell=LONGEST_CELL),
        action=Message("Close the quote that is opened in this row, or shorten the cell; the rest was not read."),
    )


def inspect_csv(data: bytes) -> CsvText:
    """Determine encoding and separator of a CSV file.

    The separator is the most frequent one in the header outside quotes, or that of a first line such as ``sep=;``.

    Raises UnreadableTextError: the bytes are not text, or the first line names another separator.
    """
    text = decode(data)
    head = text.text[:_HEAD]
    named = named_separator(head)
    separator = named or most_frequent_separator(head)
    if separator not in SEPARATOR_NAMES:
        raise UnreadableTextError(
            row=1,
            value=re.split(r"[\r\n]", head, maxsplit=1)[0].strip(' "'),
            allowed=Message("comma, semicolon or tab between cells"),
            action=Message("Save the file with one of these separators."),
        )
    return CsvText(data, text.codec, text.foreign_encoding, separator, named is not None)
