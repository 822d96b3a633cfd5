"""Duplicate rows of snow tables: pasted again, they count again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..problems import warning

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from .table import Table


MOST_LISTED: Final = 1000
"""Repeated rows that are listed one by one."""


def check_repeated_rows(table: Table) -> Iterator[Problem]:
    """Warn of each row that says in every column what an earlier row says; beyond `MOST_LISTED` of their number."""
    names = [column.cells() for column in table.names.values()]
    numbers = [np.where(np.isfinite(column), column, -np.inf).tolist() for column in table.numbers.values()]
    first: dict[tuple[object, ...], int] = {}
    repeated = 0
    for index, row in enumerate(zip(*names, *numbers, *table.further.values(), strict=True)):
        earlier = first.setdefault(row, index)
        if earlier == index:
            continue
        repeated += 1
        if repeated > MOST_LISTED:
            continue
        yield warning(
            "repeated_row",
            table.form.file,
            row=int(table.row[index]),
            experiment=table.names[table.form.key][index] or None,
            value=f"the same as row {int(table.row[earlier])}",
            allowed="each measurement once",
            action="It counts again in the mean of its site: remove the row if it was pasted twice.",
        )
    if repeated > MOST_LISTED:
        yield warning(
            "repeated_row",
            table.form.file,
            value=f"{repeated - MOST_LISTED} more repeated rows",
            allowed="each measurement once",
            action="They count again in the means of their sites: remove rows that were pasted twice.",
        )
