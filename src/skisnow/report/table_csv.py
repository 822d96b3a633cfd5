"""A table as CSV after RFC 4180: comma, CRLF, all digits, units in the names of the columns, empty where absent."""

from __future__ import annotations

import csv
import io
from itertools import chain
from operator import itemgetter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from .table import Column, Table

_NOTHING: tuple[None, None] = (None, None)


def table_csv(table: Table) -> str:
    """The whole table; an interval takes two columns, ``…_low`` and ``…_high``, beside its value's."""
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\r\n")
    writer.writerow(chain.from_iterable(_names(column) for column in table.columns))
    columns = [_cells(column, map(itemgetter(index), table.rows)) for index, column in enumerate(table.columns)]
    writer.writerows(zip(*chain.from_iterable(columns), strict=True))
    return buffer.getvalue()


def _names(column: Column) -> tuple[str, ...]:
    ends = (f"{column.key}_low", f"{column.key}_high")
    return {"interval": ends, "range": ends, "estimate": (column.key, *ends)}.get(column.kind, (column.key,))


def _cells(column: Column, values: Iterable[Any]) -> list[Iterable[Any]]:
    if column.kind in ("interval", "range"):
        return list(zip(*(pair or _NOTHING for pair in values), strict=True)) or [(), ()]
    if column.kind == "estimate":
        return list(zip(*((value, *(pair or _NOTHING)) for value, pair in values), strict=True)) or [(), (), ()]
    return [map(_WRITTEN.get(column.kind, _as_it_is), values)]


def _as_it_is(value: Any) -> Any:
    return value


def _truth(value: bool) -> str:
    return "true" if value else "false"


_WRITTEN: dict[str, Callable[[Any], Any]] = {
    "yes": _truth,
    "tick": _truth,
    "codes": "; ".join,
}
