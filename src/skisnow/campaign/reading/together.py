"""Checks of a table that more than one of its cells, or more than one file, decide."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..problems import error
from .angles import check_flat_tools, check_steepness, check_unit
from .branches import check_branches
from .campaign_file import CAMPAIGN_FILE
from .experiments import Blocks, check_one_site, check_series
from .likely_units import check_likely_units
from .missing_units import check_missing_units
from .repeated_rows import check_repeated_rows
from .table_forms import DENSITY, DROP_CONE, PENETRATION, SHEAR
from .turning import check_turning, shear_blocks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from .campaign_file import CampaignFile
    from .table import Table


def check_together(table: Table, described: CampaignFile | None) -> Iterator[Problem]:
    """Find contradictions between the rows of a table, or with campaign.toml where that could be read."""
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
    yield from check_turning(table, blocks)
    yield from check_unit(table)
    if described is not None:
        yield from _unknown_names(table, blocks, "plate", described.plate_names)


def _unknown_names(table: Table, blocks: Blocks, column: str, known: frozenset[str]) -> Iterator[Problem]:
    """Find tools or plates that campaign.toml does not describe, once in each experiment."""
    names = table.names[column]
    unknown = np.array([bool(name) and name not in known for name in names.names], dtype=np.bool_)[names.code]
    pairs = np.stack([blocks.of_row, names.code], axis=1)[unknown]
    _, first = np.unique(pairs, axis=0, return_index=True)
    for row in np.flatnonzero(unknown)[np.sort(first)].tolist():
        yield error(
            f"unknown_{column}",
            table.form.file,
            row=int(table.row[row]),
            column=column,
            experiment=table.names[table.form.key][row] or None,
            value=names[row],
            allowed=f"one of {', '.join(sorted(known))}" if known else f"a {column} that {CAMPAIGN_FILE} describes",
            action=f"Correct the cell, or describe the {column} in {CAMPAIGN_FILE} under [[{column}]].",
        )
