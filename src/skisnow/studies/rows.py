"""Rows of a table in memory, and its cells from value to text and back."""

from __future__ import annotations

import json
import marshal
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Final, TypeAlias

from .._support.environment import import_extra
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.kept_rows import Row
from .._support.spreadsheet_text import protect_from_formulas, remove_protection
from .._support.user_files import json_value
from ..parameters import Quantity
from .points import LazySequence

ROWS_OF_A_BLOCK: Final = 1000


class TableRows(LazySequence):
    """Rows in their order, compressed in blocks: a million rows of carved turns take about 150 MB.

    columns: names of the values of a row.
    rows: the values of each row: numbers, texts, switches, lists of numbers, or None.
    """

    def __init__(self, columns: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
        self.columns = tuple(columns)
        self._blocks: list[bytes] = []
        self._count = 0
        self._last: tuple[int, list[Sequence[Any]]] = (-1, [])
        source = iter(rows)
        while block := list(islice(source, ROWS_OF_A_BLOCK)):
            self._blocks.append(zlib.compress(marshal.dumps(block), 1))
            self._count += len(block)

    def __len__(self) -> int:
        """Number of rows."""
        return self._count

    def point(self, number: int) -> Row:
        """The row of one point; the block that was read last is remembered."""
        block, row = divmod(number, ROWS_OF_A_BLOCK)
        if self._last[0] != block:
            self._last = (block, self._block(block))
        return dict(zip(self.columns, self._last[1][row], strict=True))

    def __iter__(self) -> Iterator[Row]:
        """Rows by the names of the columns."""
        return (dict(zip(self.columns, values, strict=True)) for values in self.values())

    def values(self) -> Iterator[Sequence[Any]]:
        """The values of each row, in the order of the columns."""
        for number in range(len(self._blocks)):
            yield from self._block(number)

    def _block(self, number: int) -> list[Sequence[Any]]:
        values: list[Sequence[Any]] = marshal.loads(zlib.decompress(self._blocks[number]))
        return values


def require_pyarrow() -> Any:
    """Import pyarrow, the library of Parquet files; ParameterError if it is not installed."""
    pyarrow, _ = (
        import_extra(module, extra="parquet", what=Message("A table in Parquet"))
        for module in ("pyarrow", "pyarrow.parquet")
    )
    return pyarrow


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
    try:
        read(text)
    except (ValueError, TypeError):
        return True
    return False


def is_text(name: str, keys: Mapping[str, Quantity]) -> bool:
    """True for a column of texts; all others contain numbers, switches, or lists of numbers."""
    return name in TEXTS or (name in keys and keys[name].kind == "text")


def require_kinds(place: str, columns: Sequence[str], values: Sequence[Any], texts: Sequence[bool]) -> None:
    """Check that values of a database row are texts where marked, otherwise numbers, switches, lists or None."""
    for name, value, text in zip(columns, values, texts, strict=True):
        if value is None or (isinstance(value, str) if text else _is_number(value)):
            continue
        if not text and isinstance(value, list) and all(map(_is_number, value)):
            continue
        kind = Message("a text") if text else Message("a number, a switch or a list of numbers")
        raise ParameterError("{place}: {name} is {value!r}. Allowed: {allowed}. Correct or remove it").tag(
            "out_of_range", place=place, name=name, value=str(value)[:80], allowed=kind
        )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)


def _cell_reader(name: str, keys: Mapping[str, Quantity], mark: str) -> Reader:
    if is_text(name, keys):
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
    if text.startswith("["):
        return [float(number) for number in json_value(text)]
    if text.lower() not in ("true", "false"):
        raise ValueError(text)
    return text.lower() == "true"
