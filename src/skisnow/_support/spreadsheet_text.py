"""Text as spreadsheet programs of any European laptop write it: encoding, separator, numbers and their decimal mark.

UTF-8 with or without byte order mark, UTF-16, Windows-1252; comma, semicolon or tab; decimal points or decimal commas.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Final

from .errors import ParameterError
from .messages import Message
from .user_files.text_files import plain_bytes

SEPARATOR_NAMES: Final = {",": "comma", ";": "semicolon", "\t": "tab"}
_FORMS: Final = {
    mark: re.compile(rf"[+-]?(?:[0-9]++(?:{escaped}[0-9]*+)?|{escaped}[0-9]++)(?:[eE][+-]?[0-9]++)?")
    for mark, escaped in ((".", r"\."), (",", ","))
}
"""Possessive: what does not fit is refused after one pass over the cell."""
LONGEST_CELL: Final = 32_767
"""Characters: what a cell of Excel and LibreOffice holds."""
LONGEST_NUMBER: Final = 1_100
"""Characters: the longest decimal that is exactly a number in double precision has 1,077."""
MOST_COLUMNS: Final = 1_000


class NoTextError(ValueError):
    """Bytes are not text: ``place`` is ``"byte 12"`` or ``"a NUL character"``, ``encoding`` the one that was tried."""

    def __init__(self, place: str, encoding: str) -> None:
        super().__init__(f"{place} is no {encoding} text")
        self.place, self.encoding = place, encoding


@dataclass(frozen=True, slots=True)
class DecodedText:
    """Decoded text with Python's name of its codec, and a readable name of the encoding, None for UTF-8."""

    text: str
    codec: str
    foreign_encoding: str | None


def encoding_of(data: bytes) -> tuple[str, str | None]:
    """Python's codec of a text file, and a readable name of the encoding, None for UTF-8.

    >>> encoding_of("Höhe".encode()), encoding_of("Höhe".encode("cp1252"))
    (('utf-8', None), ('cp1252', 'Windows-1252'))
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16", "UTF-16"
    if data.startswith(b"\xef\xbb\xbf"):
        return "utf-8-sig", None
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252", "Windows-1252"
    return "utf-8", None


def decoded(data: bytes) -> DecodedText:
    """Decode a text file, without byte order marks."""
    codec, foreign = encoding_of(data)
    try:
        text = data.decode(codec)
    except UnicodeDecodeError as error:
        raise NoTextError(Message("byte {byte}", byte=error.start + 1), foreign or "UTF-8") from None
    if "\0" in text:
        raise NoTextError(Message("a NUL character"), foreign or "UTF-8")
    return DecodedText(text.lstrip("\ufeff"), codec, foreign)


def named_separator(head: str) -> str | None:
    r"""Separator (any character) that a first line such as ``sep=;`` names; None without such a line.

    >>> named_separator('"sep=;"\na;b'), named_separator("a;b")
    (';', None)
    """
    first_line = re.split(r"[\r\n]", head, maxsplit=1)[0].strip(' "')
    named = re.fullmatch(r"sep=(.)\1*", first_line, re.IGNORECASE)
    return named[1] if named else None


def most_frequent_separator(head: str) -> str:
    r"""Most frequent separator (comma, semicolon, tab) outside quotes in the first line with one; else the comma.

    >>> most_frequent_separator('"a,b,c";d\n1;2'), most_frequent_separator("Title\na;b\n1,5;2")
    (';', ';')
    """
    outside_quotes = re.sub(r'"[^"]*("|\Z)', "x", head)
    lines = (line for line in re.split(r"[\r\n]+", outside_quotes) if re.search("[,;\t]", line.strip(" ,;\t")))
    header = next(lines, "")
    return max(SEPARATOR_NAMES, key=header.count)  # the first of equals: the comma


def is_number(cell: str, mark: str) -> bool:
    """True if a stripped cell is written as a number with this decimal mark.

    >>> is_number("-1.5e3", "."), is_number("1_000", "."), is_number("nan", "."), is_number("1.5", ",")
    (True, False, False, False)
    """
    return len(cell) <= LONGEST_NUMBER and _FORMS[mark].fullmatch(cell) is not None


def number(cell: str, mark: str = ".") -> float:
    """Read one cell; NaN where it is not a finite number.

    >>> number(" 2,5", ","), number("1e999", "."), number("1_000")
    (2.5, nan, nan)
    """
    stripped = cell.strip()
    if not is_number(stripped, mark):
        return math.nan
    value = float(stripped.replace(",", "."))
    return value if math.isfinite(value) else math.nan


def decimal_mark(groups: Iterable[Iterable[str]], *, separator: str) -> str:
    """Decimal mark of the numbers in the cells: a point or a comma.

    The first group of cells with a fraction decides, by its majority; where both are equally many, a file separated by
    commas has points and any other has commas. Without any fraction it is the point.

    >>> decimal_mark([["1", "2"], ["0,5", "1,5", "2.5"]], separator=";")
    ','
    """
    for cells in groups:
        written = list(cells)
        points, commas = _count_numbers_with(written, "."), _count_numbers_with(written, ",")
        if points or commas:
            tie_is_comma = separator != ","
            return "," if commas > points or (commas == points and tie_is_comma) else "."
    return "."


def _count_numbers_with(cells: Iterable[str], mark: str) -> int:
    """Number of cells that are a number with `mark` as its decimal sign in it."""
    return sum(mark in cell and is_number(cell.strip(), mark) for cell in cells)


def with_decimal_point(cell: str) -> str:
    """Cell with a decimal point instead of a comma; one with a point becomes invalid, because 1.500 may be 1500.

    >>> with_decimal_point("1,5"), with_decimal_point("1.500,5")
    ('1.5', '1·500.5')
    """
    return cell if is_number(cell, ".") and "." not in cell else cell.replace(".", "·").replace(",", ".")


def column_names(cells: Iterable[str], columns: Iterable[str]) -> list[str]:
    """Names of a header without outer blanks; one that equals a known column but for case gets the column's spelling.

    >>> column_names([" X_M", "Gate", "Colour"], ["gate", "x_m"])
    ['x_m', 'gate', 'Colour']
    """
    names = {name.casefold(): name for name in columns}
    return [names.get(cell.strip().casefold(), cell.strip()) for cell in cells]


_FORMULA: Final = "=+-@\t\r＝＋－＠"
_AS_FORMULA: Final = re.compile(f"'*[{re.escape(_FORMULA)}]")


def csv_text(rows: Iterable[Iterable[object]]) -> str:
    r"""CSV text of rows of cells, with commas and line feeds.

    >>> csv_text([("old", "new"), ("1,5", 1.5)])
    'old,new\n"1,5",1.5\n'
    """
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()


def protect_from_formulas(text: str) -> str:
    """Text of a cell with an apostrophe in front if a spreadsheet program could read it as a formula.

    A text that begins with = + - @, a tab or a carriage return, and is not a number, gets an apostrophe in front.
    So does one that begins so after apostrophes, so that `remove_protection` restores every text.

    >>> [protect_from_formulas(text) for text in ("=1+1", "-1.5", "'=a", "it's", "-")]
    ["'=1+1", '-1.5', "''=a", "it's", "'-"]
    """
    if not _AS_FORMULA.match(text) or is_number(text, ".") or is_number(text, ","):
        return text
    return f"'{text}"


def remove_protection(cell: str) -> str:
    """Original text of a cell that `protect_from_formulas` wrote: without the added apostrophe.

    >>> [remove_protection(cell) for cell in ("'=1+1", "-1.5", "''=a", "'tis")]
    ['=1+1', '-1.5', "'=a", "'tis"]
    """
    return cell[1:] if cell.startswith("'") and _AS_FORMULA.match(cell) else cell


MOST_CSV_BYTES: Final = 1 << 26
_HEAD: Final = 1 << 16


@dataclass(frozen=True, slots=True)
class CsvRow:
    """One row of a CSV table.

    path, row: file, and number of the row; the header is row 1.
    cells: texts by column, without blanks around them.
    action: sentence with the fix that errors of this row recommend.
    mark: decimal mark of the file's numbers.
    """

    path: Path
    row: int
    cells: dict[str, str]
    action: Message
    mark: str = "."

    def number(self, column: str) -> float:
        """Number in a column; a ParameterError that names the cell unless it is a finite number."""
        value = number(self.cells[column], self.mark)
        if not math.isfinite(value):
            raise self.refused(column, Message("A finite number is needed."), code="not_a_number")
        return value

    def refused(self, column: str, problem: Message, *, code: str, action: Message | None = None) -> ParameterError:
        """Error for a cell of this row, to be raised by the caller: sentences with the problem and the fix."""
        return ParameterError("{path}, row {row}, column {column}: {value!r}: {problem} {action}").tag(
            code,
            path=self.path,
            row=self.row,
            column=column,
            value=self.cells[column],
            problem=problem,
            action=action or self.action,
        )


def csv_rows(
    path: str | Path, columns: Sequence[str], *, further: Sequence[str] = (), action: Message
) -> Iterator[CsvRow]:
    """Read the rows of a CSV table that are not blank, one after the other; a wrong row raises a ParameterError.

    path: text in UTF-8, UTF-16 or Windows-1252 with the names of the columns first, below ``sep=;`` if there is one;
        comma, semicolon or tab, and with the last two a decimal point or comma.
    columns, further: required and optional columns, in any case of letters; others are not read.
    action: sentence with the fix that errors recommend.
    """
    path = Path(path)
    try:
        text = decoded(plain_bytes(path, most_bytes=MOST_CSV_BYTES)).text.replace("\r\n", "\n").replace("\r", "\n")
    except NoTextError as error:
        raise ParameterError("{path} is not {encoding} text ({place}). Save it as UTF-8.").tag(
            "not_text", path=path, encoding=error.encoding, place=error.place
        ) from error
    named = named_separator(text[:_HEAD])
    separator = named or most_frequent_separator(text[:_HEAD])
    lines: Iterator[list[str]] = csv.reader(io.StringIO(text), delimiter=separator)
    first, mark = 1, "."  # row of the header, and decimal mark
    if named:
        next(lines)
        first = 2
    try:
        if separator != ",":
            every = list(lines)
            mark, lines = decimal_mark([chain.from_iterable(every[1:])], separator=separator), iter(every)
        head = column_names(next(lines, []), (*columns, *further))
        missing = [name for name in columns if name not in head]
        if missing:
            raise ParameterError("{path}, row {row}: column {column} is missing among {columns}. {action}").tag(
                "missing_column", path=path, row=first, column=missing[0], columns=head, action=action
            )
        twice = [name for name in (*columns, *further) if head.count(name) > 1]
        if twice:
            raise ParameterError("{path}, row {row}: the column {column} is there twice. Keep one of them.").tag(
                "repeated_column", path=path, row=first, column=twice[0]
            )
        places = {name: head.index(name) for name in (*columns, *further) if name in head}
        for row, cells in enumerate(lines, start=first + 1):
            if any(cell.strip() for cell in cells[len(head) :]):
                raise ParameterError(
                    "{path}, row {row}: there are {count} cells under {columns} names of columns, perhaps because of "
                    "decimal commas. {action}"
                ).tag("too_many_cells", path=path, row=row, count=len(cells), columns=len(head), action=action)
            if any(cell.strip() for cell in cells):
                values = {name: cells[at].strip() if at < len(cells) else "" for name, at in places.items()}
                yield CsvRow(path, row, values, action, mark)
    except csv.Error as error:
        raise ParameterError("{path} is not CSV text ({error}). {action}").tag(
            "not_csv", path=path, error=error, action=action
        ) from error
