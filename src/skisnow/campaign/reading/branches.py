"""The branch of a penetration reading: a disc was laid on, or taken off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..problems import error
from .table_forms import BRANCH, BRANCHES, LOADING, UNLOADING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from ..records import BoolArray
    from .columns import NameColumn
    from .experiments import Blocks
    from .table import Table


def is_unloading_cell(cell: str) -> bool:
    """Tell a cell of a row that was read while the discs were taken off."""
    return cell.strip().casefold() == UNLOADING


def is_unloading(branch: NameColumn) -> BoolArray:
    """Tell the rows that were read while the discs were taken off."""
    return np.array(list(map(is_unloading_cell, branch.names)), dtype=np.bool_)[branch.code]


def check_branches(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Find words that name no branch, discs that are laid on again, and series that were never loaded."""
    branch = table.names[BRANCH]
    unknown = np.array([name.casefold() not in BRANCHES for name in branch.names], dtype=np.bool_)[branch.code]
    for row in np.flatnonzero(unknown).tolist():
        yield _refusal(table, row, "out_of_range", f"{LOADING}, {UNLOADING} or nothing, which is {LOADING}")
    taken_off = is_unloading(branch)
    same = blocks.of_row[1:] == blocks.of_row[:-1]
    for row in (np.flatnonzero(same & taken_off[:-1] & ~taken_off[1:]) + 1).tolist():
        yield _refusal(table, row, "branch_order", f"{UNLOADING}: a row of this experiment before it is")
    for row in blocks.start[taken_off[blocks.start]].tolist():
        yield _refusal(table, row, "branch_order", f"{LOADING}: an experiment begins under its first load")


def _refusal(table: Table, row: int, code: str, allowed: str) -> Problem:
    return error(
        code,
        table.form.file,
        row=int(table.row[row]),
        column=BRANCH,
        experiment=table.names[table.form.key][row] or None,
        value=table.names[BRANCH][row],
        allowed=allowed,
        action="Correct the cell; the rows stand in the order of reading, and a second loading is another experiment.",
    )
