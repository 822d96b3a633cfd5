"""Checks of the rows of a table: units, angles, branches, turning angles, and repeated rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ..._support.arrays import BoolArray
from ..._support.messages import Message
from ..problems import Problem, warning
from .campaign_file import CAMPAIGN_FILE, CampaignFile
from .columns import Table, is_unloading
from .experiments import Blocks, check_one_number, check_one_site, check_series, shear_blocks
from .implausible_units import check_likely_units, check_missing_units
from .table_forms import BRANCH, BRANCHES, DENSITY, DROP_CONE, LOADING, PENETRATION, SHEAR, UNLOADING


def check_rows(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Problems between the rows of a table, and between the table and campaign.toml."""
    yield from check_likely_units(table)
    yield from check_missing_units(table, described)
    if table.form in (DENSITY, DROP_CONE):
        yield from check_repeated_rows(table)
    if table.form == PENETRATION:
        yield from _check_penetration(table, described)
    elif table.form == SHEAR:
        yield from _check_shear(table, described)
    elif table.form == DROP_CONE:
        yield from check_one_site(table)


def _check_penetration(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    blocks = Blocks.of_runs(table.names["experiment"])
    yield from check_series(table, blocks)
    yield from check_branches(table, blocks)
    yield from check_unit(table)
    yield from check_steepness(table, blocks)
    if described is not None:
        yield from check_flat_tools(table, blocks, described.flat_tools)
        yield from _unknown_names(table, blocks, "tool", described.tool_names)


def _check_shear(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    blocks = shear_blocks(table)
    yield from check_series(table, blocks)
    yield from check_one_number(table, blocks, "depth_mm")
    yield from check_one_number(table, blocks, "lever_arm_mm")
    yield from check_unit(table)
    if described is not None:
        yield from _unknown_names(table, blocks, "plate", described.plate_names)


def _unknown_names(table: Table, blocks: Blocks, column: str, described_names: frozenset[str]) -> Iterator[Problem]:
    """Errors for tools or plates that are not in campaign.toml, one for each experiment."""
    names = table.names[column]
    unknown = np.array([bool(name) and name not in described_names for name in names.names], dtype=np.bool_)[names.code]
    pairs = np.stack([blocks.of_row, names.code], axis=1)[unknown]
    _, first = np.unique(pairs, axis=0, return_index=True)
    for row in np.flatnonzero(unknown)[np.sort(first)].tolist():
        allowed = (
            Message("one of {names}", names=sorted(described_names))
            if described_names
            else Message("a {column} that {campaign_file} describes", column=column, campaign_file=CAMPAIGN_FILE)
        )
        action = Message(
            "Correct the cell, or describe the {column} in {campaign_file} under [[{column}]].",
            column=column,
            campaign_file=CAMPAIGN_FILE,
        )
        yield table.error(row, f"unknown_{column}", column, names[row], allowed=allowed, action=action)


COLUMN: Final = "edge_angle_deg"
STEEPEST_MEASURED_DEG: Final = 60.0
"""Largest edge angle of the paper's penetration experiments (Mössner and others 2013)."""
SMALLEST_LIKELY_DEG: Final = 1.6
"""Just above π/2: a file with only smaller angles is probably in radians."""


def check_unit(table: Table) -> Iterator[Problem]:
    """Warning if all angles of the file above 0 look like radians."""
    angle = table.numbers[COLUMN]
    tilted = angle[angle > 0]
    if len(tilted) and float(tilted.max()) < SMALLEST_LIKELY_DEG:
        yield warning(
            "angles_look_like_radians",
            table.form.file,
            column=COLUMN,
            value=f"{tilted.min():g} to {tilted.max():g}",
            allowed=Message("degrees"),
            action=Message("If these are radians multiply them by 57.29578; if they are degrees no action is needed."),
        )


def check_steepness(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Warning of each experiment at a larger edge angle than in the paper."""
    steep = table.numbers[COLUMN] > STEEPEST_MEASURED_DEG
    for row in _once_per_block(steep, blocks):
        allowed = Message(
            "penetration was measured up to {steepest_measured_deg:g} degrees so far",
            steepest_measured_deg=STEEPEST_MEASURED_DEG,
        )
        action = Message("The computation continues; check the angle.")
        yield table.warning(
            row, "angle_above_60", COLUMN, f"{table.numbers[COLUMN][row]:g}", allowed=allowed, action=action
        )


def check_flat_tools(table: Table, blocks: Blocks, flat_tools: frozenset[str]) -> Iterator[Problem]:
    """Errors for tilted tools without an edge."""
    tool = table.names["tool"]
    is_flat = np.array([name in flat_tools for name in tool.names], dtype=np.bool_)[tool.code]
    for row in _once_per_block(is_flat & (table.numbers[COLUMN] > 0), blocks):
        allowed = Message("0 for the tool {tool!r}, which has no edge", tool=tool[row])
        action = Message("Write 0, or name the tool that was used.")
        yield table.error(
            row, "out_of_range", COLUMN, f"{table.numbers[COLUMN][row]:g}", allowed=allowed, action=action
        )


def _once_per_block(chosen: BoolArray, blocks: Blocks) -> list[int]:
    rows = np.flatnonzero(chosen)
    _, first = np.unique(blocks.of_row[rows], return_index=True)
    numbers: list[int] = rows[first].tolist()
    return numbers


def check_branches(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Errors for unknown branches, loading after unloading, and series without loading."""
    branch = table.names[BRANCH]
    unknown = np.array([name.casefold() not in BRANCHES for name in branch.names], dtype=np.bool_)[branch.code]
    for row in np.flatnonzero(unknown).tolist():
        yield _refusal(
            table,
            row,
            "out_of_range",
            Message("{loading}, {unloading} or nothing, which is {loading}", loading=LOADING, unloading=UNLOADING),
        )
    taken_off = is_unloading(branch)
    same = blocks.of_row[1:] == blocks.of_row[:-1]
    for row in (np.flatnonzero(same & taken_off[:-1] & ~taken_off[1:]) + 1).tolist():
        yield _refusal(
            table, row, "branch_order", Message("{branch}: a row of this experiment before it is", branch=UNLOADING)
        )
    for row in blocks.start[taken_off[blocks.start]].tolist():
        yield _refusal(
            table, row, "branch_order", Message("{branch}: an experiment begins under its first load", branch=LOADING)
        )


def _refusal(table: Table, row: int, code: str, allowed: str) -> Problem:
    action = Message(
        "Correct the cell; the rows are in the order of reading, and a second loading is another experiment."
    )
    return table.error(row, code, BRANCH, table.names[BRANCH][row], allowed=allowed, action=action)


MOST_LISTED: Final = 1000
"""Maximum number of repeated rows that are listed."""


def check_repeated_rows(table: Table) -> Iterator[Problem]:
    """Warning of each row that equals an earlier one, up to `MOST_LISTED`."""
    names = [column.cells() for column in table.names.values()]
    numbers = [np.where(np.isfinite(column), column, -np.inf).tolist() for column in table.numbers.values()]
    first: dict[tuple[object, ...], int] = {}
    repeated = 0
    for index, row in enumerate(zip(*names, *numbers, *table.further.values(), strict=True)):
        earlier = first.setdefault(row, index)
        if earlier != index and repeated < MOST_LISTED:
            repeated += 1
            allowed = Message("each measurement once")
            action = Message("It counts again in the mean of its site: remove the row if it was pasted twice.")
            value = f"the same as row {int(table.row[earlier])}"
            yield table.warning(index, "repeated_row", None, value, allowed, action)
