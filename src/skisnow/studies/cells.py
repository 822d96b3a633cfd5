"""Cells of a table from value to text and back."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.spreadsheet_text import protect_from_formulas, remove_protection
from .._support.user_files import json_value
from ..parameters import Quantity

TEXTS: Final = ("outcome", "ski_name", "warnings", "reason", "study")
BLANK: Final = ("warnings", "reason")
"""Texts that are empty where there is nothing to say; of all others an empty cell is not a value."""

Reader: TypeAlias = Callable[[str], Any]


def cell(value: Any) -> str:
    """Text of a value in a CSV table: all digits, true or false, empty for None; formulas are made harmless.

    >>> [cell(value) for value in (None, 0.1, 3, True, [1.0, 2.5], "=1")]
    ['', '0.1', '3', 'true', '[1.0, 2.5]', "'=1"]
    """
    kind = type(value)
    if kind is float:
        return repr(value)
    if value is None:
        return ""
    if kind is str:
        return protect_from_formulas(value)
    if kind is bool:
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return json.dumps(list(value))
    return repr(value)


def readers(columns: Sequence[str], keys: Mapping[str, Quantity], mark: str) -> list[Reader]:
    """Functions that convert the cells of each column; `mark` is the decimal mark."""
    return [_cell_reader(name, keys, mark) for name in columns]


def read_cells(place: str, columns: Sequence[str], cells: Sequence[str], readers: Sequence[Reader]) -> list[Any]:
    """Values of a row from its cells, one reader for each; `place` names the row in errors."""
    if len(cells) != len(columns):
        raise ParameterError(
            "{place}: a row of this table has {n_columns} cells, this line has {n_cells}. Remove the line"
        ).tag("wrong_number_of_cells", place=place, n_columns=len(columns), n_cells=len(cells))
    try:
        return [read(text) for text, read in zip(cells, readers, strict=True)]
    except (ValueError, TypeError):
        name, text = next(
            (name, text) for name, text, read in zip(columns, cells, readers, strict=True) if _is_unreadable(read, text)
        )
        raise ParameterError("{place}: {name} is {text!r}; it must be a number. Correct or remove it").tag(
            "wrong_kind", place=place, name=name, text=text
        ) from None


def _is_unreadable(read: Reader, text: str) -> bool:
    """True if the reader rejects the text."""
    try:
        read(text)
    except (ValueError, TypeError):
        return True
    return False


def _cell_reader(name: str, keys: Mapping[str, Quantity], mark: str) -> Reader:
    """Function that converts a cell's text to a text, number, switch or list, by the column's name."""
    if name in TEXTS or (name in keys and keys[name].kind == "text"):
        empty = "" if name in BLANK else None
        return lambda text: remove_protection(text) if text else empty
    number = int if name in keys and keys[name].kind == "whole number" else float

    def read(text: str) -> Any:
        if text == "":
            return None
        if text[0] in "[tTfF":
            return _switch_or_list(text)
        return number(text if mark == "." else text.replace(",", "."))

    return read


def _switch_or_list(text: str) -> bool | list[float]:
    """True, False or a list of numbers from a text; ValueError for another one."""
    if text.startswith("["):
        return [float(number) for number in json_value(text)]
    if text.lower() not in ("true", "false"):
        raise ValueError(text)
    return text.lower() == "true"
