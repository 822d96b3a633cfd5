"""Shear experiments of several rows: a moment for each turning angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..problems import error
from .experiments import Blocks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from .table import Table

TURNING: Final = "turning_angle_deg"
_ONCE: Final = ("depth_mm", "lever_arm_mm")


def shear_blocks(table: Table) -> Blocks:
    """Rows of one experiment together where their turning angle is given; each row by itself where it is not."""
    turned = ~np.isnan(table.numbers[TURNING])
    if not turned.any():
        return Blocks.of_single_rows(len(table))
    code = table.names[table.form.key].code
    goes_on = (code[1:] == code[:-1]) & turned[1:] & turned[:-1]
    return Blocks(np.concatenate(([0], np.flatnonzero(~goes_on) + 1, [len(code)])).astype(np.int64))


def check_turning(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Find depths and lever arms that change within an experiment."""
    for name in _ONCE:
        values = table.numbers[name]
        first = values[blocks.start][blocks.of_row]
        for row in np.flatnonzero((values != first) & ~np.isnan(values) & ~np.isnan(first)).tolist():
            yield error(
                "mixed_experiment",
                table.form.file,
                row=int(table.row[row]),
                column=name,
                experiment=table.names[table.form.key][row] or None,
                value=f"{values[row]:.12g}",
                allowed=f"one {name} in an experiment; its first row has {first[row]:.12g}",
                action="Correct the cell, or give the rows that were another experiment another name.",
            )
