"""Edge angles of a table: in degrees, not too steep for the experiment, and zero for tools without an edge."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..problems import error, warning
from .table_forms import PENETRATION

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from ..records import BoolArray
    from .experiments import Blocks
    from .table import Table

COLUMN: Final = "edge_angle_deg"
STEEPEST_MEASURED_DEG: Final = 60.0
"""Edge angles of the paper's penetration experiments end here (Mössner and others 2013)."""
SMALLEST_LIKELY_DEG: Final = 1.6
"""Just above π/2: a file whose angles all stay below may hold radians."""


def check_unit(table: Table) -> Iterator[Problem]:
    """Warn once where all angles of the file that are not zero look like radians."""
    angle = table.numbers[COLUMN]
    tilted = angle[angle > 0]
    if len(tilted) and float(tilted.max()) < SMALLEST_LIKELY_DEG:
        yield warning(
            "angles_look_like_radians",
            table.form.file,
            column=COLUMN,
            value=f"{tilted.min():g} to {tilted.max():g}",
            allowed="degrees",
            action="If these are radians multiply them by 57.29578; if they are degrees nothing need be done.",
        )


def check_steepness(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Warn of each experiment that is steeper than what was measured for the paper."""
    steep = table.numbers[COLUMN] > STEEPEST_MEASURED_DEG
    for row in _once_per_block(steep, blocks):
        yield warning(
            "angle_above_60",
            table.form.file,
            row=int(table.row[row]),
            column=COLUMN,
            experiment=table.names[table.form.key][row] or None,
            value=f"{table.numbers[COLUMN][row]:g}",
            allowed=f"penetration at up to {STEEPEST_MEASURED_DEG:g} degrees is what was measured before",
            action="It is computed all the same; make sure that the angle is meant.",
        )


def check_flat_tools(table: Table, blocks: Blocks, flat_tools: frozenset[str]) -> Iterator[Problem]:
    """Find tools without an edge that are tilted."""
    tool = table.names["tool"]
    is_flat = np.array([name in flat_tools for name in tool.names], dtype=np.bool_)[tool.code]
    for row in _once_per_block(is_flat & (table.numbers[COLUMN] > 0), blocks):
        yield error(
            "out_of_range",
            PENETRATION.file,
            row=int(table.row[row]),
            column=COLUMN,
            experiment=table.names[table.form.key][row] or None,
            value=f"{table.numbers[COLUMN][row]:g}",
            allowed=f"0 for the tool {tool[row]!r}, which has no edge",
            action="Write 0, or name the tool that was used.",
        )


def _once_per_block(chosen: BoolArray, blocks: Blocks) -> list[int]:
    rows = np.flatnonzero(chosen)
    _, first = np.unique(blocks.of_row[rows], return_index=True)
    found: list[int] = rows[first].tolist()
    return found
