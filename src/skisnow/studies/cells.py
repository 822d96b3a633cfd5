"""Cells of a study's CSV table: from a value to its text and back."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.kept_rows import Row
from .._support.spreadsheet_text import guarded, unguarded
from .._support.user_files import json_value
from ..parameters import Quantity

TEXTS: Final = ("outcome", "ski_name", "warnings", "reason", "study")
BLANK: Final = ("warnings", "reason")
"""Texts that are empty where there is nothing to say; of all others an empty cell is not a value."""

Reader: TypeAlias = Callable[[str], Any]


def cell(value: Any) -> str:
    """Numbers with all their digits, true and false, nothing if the value is missing.

    >>> [cell(value) for value in (None, 0.1, 3, True, [1.0, 2.5], "=1")]
    ['', '0.1', '3', 'true', '[1.0, 2.5]', "'=1"]
    """
    kind = type(value)
    if kind is float:
        return repr(value)
    if value is None:
        return ""
    if kind is str:
        return guarded(value)
    if kind is bool:
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return json.dumps(list(value))
    return repr(value)


def readers(columns: Sequence[str], keys: Mapping[str, Quantity], mark: str) -> list[Reader]:
    """Functions that convert the cells of each column; `mark` is the decimal mark."""
    return [_reader(name, keys, mark) for name in columns]


def row_of(place: str, columns: Sequence[str], cells: Sequence[str], readers: Sequence[Reader]) -> Row:
    """A row by the names of its columns.

    Raises
    ------
    ParameterError
        It has another number of cells, or one is not a number; the message begins with the place.
    """
    if len(cells) != len(columns):
        raise ParameterError(
            "{place}: a row of this table has {n_columns} cells, this line has {n_cells}. Remove the line",
            code="wrong_number_of_cells",
            place=place,
            n_columns=len(columns),
            n_cells=len(cells),
        )
    try:
        return {name: read(text) for name, text, read in zip(columns, cells, readers, strict=True)}
    except (ValueError, TypeError):
        name, text = next(
            (name, text) for name, text, read in zip(columns, cells, readers, strict=True) if _fails(read, text)
        )
        raise ParameterError(
            "{place}: {name} is {text!r}; it must be a number. Correct or remove it",
            code="wrong_kind",
            place=place,
            name=name,
            text=text,
        ) from None


def _fails(read: Reader, text: str) -> bool:
    try:
        read(text)
    except (ValueError, TypeError):
        return True
    return False


def is_text(name: str, keys: Mapping[str, Quantity]) -> bool:
    """True for a column of texts; all others contain numbers, switches, or lists of numbers."""
    return name in TEXTS or (name in keys and keys[name].kind == "text")


def require_kinds(place: str, row: Row, texts: Sequence[bool]) -> None:
    """Check the values of a row from a database; `texts` marks the columns of texts.

    Raises
    ------
    ParameterError
        A value is of another kind than its column; the message begins with the place.
    """
    for (name, value), text in zip(row.items(), texts, strict=True):
        if value is None or (isinstance(value, str) if text else _is_number(value)):
            continue
        if not text and isinstance(value, list) and all(map(_is_number, value)):
            continue
        kind = Message("a text") if text else Message("a number, a switch or a list of numbers")
        raise ParameterError(
            "{place}: {name} is {value!r}. Allowed: {allowed}. Correct or remove it",
            code="out_of_range",
            place=place,
            name=name,
            value=str(value)[:80],
            allowed=kind,
        )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)


def _reader(name: str, keys: Mapping[str, Quantity], mark: str) -> Reader:
    if is_text(name, keys):
        empty = "" if name in BLANK else None
        return lambda text: unguarded(text) if text else empty
    number = int if name in keys and keys[name].kind == "whole number" else float

    def read(text: str) -> Any:
        if text == "":
            return None
        if text[0] in "[tTfF":
            return _switch_or_list(text)
        return number(text if mark == "." else text.replace(",", "."))

    return read


def _switch_or_list(text: str) -> bool | list[float]:
    if text.startswith("["):
        return [float(number) for number in json_value(text)]
    if text.lower() not in ("true", "false"):
        raise ValueError(text)
    return text.lower() == "true"


def cells(values: Iterable[Any]) -> list[str]:
    """The cells of a row."""
    return [cell(value) for value in values]
