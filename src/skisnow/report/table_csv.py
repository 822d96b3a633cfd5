"""A table as CSV after RFC 4180: comma, CRLF, all digits, units in the names of the columns, empty where absent."""

from __future__ import annotations

import csv
import io
from itertools import chain
from typing import TYPE_CHECKING, Any, Final

import orjson

from .._support.spreadsheet_text import guarded

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .table import Column, Table


def table_csv(table: Table) -> str:
    """The whole table; an interval takes two columns, ``…_low`` and ``…_high``, beside its value's."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\r\n")
    writer.writerow(chain.from_iterable(_names(column) for column in table.columns))
    columns = [_cells(column, [row[i] for row in table.rows]) for i, column in enumerate(table.columns)]
    writer.writerows(zip(*chain.from_iterable(columns), strict=True))
    return buffer.getvalue()


def _names(column: Column) -> tuple[str, ...]:
    ends = (f"{column.key}_low", f"{column.key}_high")
    return {"interval": ends, "range": ends, "estimate": (column.key, *ends)}.get(column.kind, (column.key,))


def _cells(column: Column, values: Sequence[Any]) -> list[Sequence[str]]:
    if column.kind in ("interval", "range"):
        return _ends(values)
    if column.kind == "estimate":
        return [_digits([value for value, _ in values]), *_ends([pair for _, pair in values])]
    if column.numeric:
        return [_digits(values)]
    return [list(map(_WRITTEN[column.kind], values))]


def _ends(pairs: Sequence[Any]) -> list[Sequence[str]]:
    return [_digits([None if pair is None else pair[end] for pair in pairs]) for end in (0, 1)]


def _digits(values: Sequence[float | None]) -> list[str]:
    """The fewest digits that read back as the same number, of a whole column at once; empty where there is none."""
    return orjson.dumps(values).decode("ascii")[1:-1].replace("null", "").split(",") if values else []


def _text(value: Any) -> str:
    return "" if value is None else guarded(str(value))


def _truth(value: bool) -> str:
    return "true" if value else "false"


_WRITTEN: Final[dict[str, Callable[[Any], str]]] = {
    "text": _text,
    "words": _text,
    "yes": _truth,
    "tick": _truth,
    "codes": lambda codes: guarded("; ".join(codes)),
}
