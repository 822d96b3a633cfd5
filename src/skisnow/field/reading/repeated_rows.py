"""Duplicate rows of snow tables: pasted again, they count again."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..problems import warning

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from .table import Table


def check_repeated_rows(table: Table) -> Iterator[Problem]:
    """Warn of each row that says in every column what an earlier row says."""
    names = [column.cells() for column in table.names.values()]
    numbers = [np.where(np.isfinite(column), column, -np.inf).tolist() for column in table.numbers.values()]
    first: dict[tuple[object, ...], int] = {}
    for index, row in enumerate(zip(*names, *numbers, *table.further.values(), strict=True)):
        earlier = first.setdefault(row, index)
        if earlier != index:
            yield warning(
                "repeated_row",
                table.form.file,
                row=int(table.row[index]),
                experiment=table.names[table.form.key][index] or None,
                value=f"the same as row {int(table.row[earlier])}",
                allowed="each measurement once",
                action="It counts again in the mean of its site: remove the row if it was pasted twice.",
            )
