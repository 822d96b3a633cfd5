"""Tables without an error to records in SI."""

from __future__ import annotations

from itertools import compress
from typing import TYPE_CHECKING

import numpy as np

from ..._support.units import DEGREE, MM
from ..records import DensitySamples, DropConeTests, PenetrationTests, ShearTests, TurningReadings, UnloadingReadings
from .columns import is_unloading
from .experiments import Blocks
from .row_checks import shear_blocks
from .table_forms import BRANCH

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..records import BoolArray
    from .columns import NameColumn, Table


def penetration_tests(table: Table) -> PenetrationTests:
    """Make the penetration experiments; their rows stand together and agree."""
    blocks = Blocks.of_runs(table.names["experiment"])
    spot = table.names["spot"]
    taken_off = is_unloading(table.names[BRANCH])
    is_unloaded = bool(taken_off.any())
    laid_on = ~taken_off if is_unloaded else slice(None)
    after = table.numbers["depth_after_mm"][laid_on]
    return PenetrationTests(
        experiment=_at(table.names["experiment"], blocks.start),
        site=_at(table.names["site"], blocks.start),
        tool=_at(table.names["tool"], blocks.start),
        spot=_at(spot, blocks.first_given(~spot.is_blank)),
        edge_angle=table.numbers["edge_angle_deg"][blocks.start] * DEGREE,
        snow_density=blocks.means(table.numbers["snow_density_kg_per_m3"]),
        drop_cone_depth=blocks.means(table.numbers["drop_cone_depth_mm"]) * MM,
        cancelled=blocks.texts(table.names["status"]),
        first=blocks.first_of(~taken_off),
        load=table.numbers["load_N"][laid_on],
        penetration_depth=table.numbers["depth_mm"][laid_on] * MM,
        row=table.row[laid_on],
        further=_of_rows(table.further, ~taken_off) if is_unloaded else table.further,
        unloading=_unloading(table, blocks, taken_off) if is_unloaded else None,
        depth_after=None if np.isnan(after).all() else after * MM,
    )


def _of_rows(further: Mapping[str, tuple[str, ...]], chosen: BoolArray) -> dict[str, tuple[str, ...]]:
    return {name: tuple(compress(cells, chosen.tolist())) for name, cells in further.items()}


def _unloading(table: Table, blocks: Blocks, taken_off: BoolArray) -> UnloadingReadings:
    return UnloadingReadings(
        first=blocks.first_of(taken_off),
        load=table.numbers["load_N"][taken_off],
        penetration_depth=table.numbers["depth_mm"][taken_off] * MM,
        row=table.row[taken_off],
    )


def shear_tests(table: Table) -> ShearTests:
    """Make the shear experiments, one a row, or one of the rows of its turning: that of the largest moment."""
    blocks = shear_blocks(table)
    moment, angle = table.numbers["moment_Nm"], table.numbers["turning_angle_deg"]
    largest = blocks.first_given(moment == np.maximum.reduceat(moment, blocks.start)[blocks.of_row])
    is_turned = ~np.isnan(angle)
    spot = table.names["spot"]
    return ShearTests(
        experiment=_at(table.names["experiment"], largest),
        site=_at(table.names["site"], largest),
        plate=_at(table.names["plate"], largest),
        spot=_at(spot, blocks.first_given(~spot.is_blank)),
        edge_angle=table.numbers["edge_angle_deg"][largest] * DEGREE,
        penetration_depth=table.numbers["depth_mm"][largest] * MM,
        lever_arm=table.numbers["lever_arm_mm"][largest] * MM,
        moment=moment[largest],
        snow_density=blocks.means(table.numbers["snow_density_kg_per_m3"]),
        drop_cone_depth=blocks.means(table.numbers["drop_cone_depth_mm"]) * MM,
        cancelled=blocks.texts(table.names["status"]),
        row=table.row[largest],
        further={name: tuple(cells[row] for row in largest.tolist()) for name, cells in table.further.items()},
        turning=TurningReadings(blocks.first_of(is_turned), angle[is_turned] * DEGREE, moment[is_turned])
        if is_turned.any()
        else None,
    )


def density_samples(table: Table) -> DensitySamples:
    """Make the density samples."""
    return DensitySamples(
        sample=table.names["sample"].cells(),
        site=table.names["site"].cells(),
        snow_density=table.numbers["snow_density_kg_per_m3"],
        cancelled=_cancelled_together(table),
        row=table.row,
        further=table.further,
    )


def drop_cone_tests(table: Table) -> DropConeTests:
    """Make the repeats of the drop-cone tests."""
    return DropConeTests(
        test=table.names["test"].cells(),
        site=table.names["site"].cells(),
        repeat=table.names["repeat"].cells(),
        drop_cone_depth=table.numbers["drop_cone_depth_mm"] * MM,
        cancelled=_cancelled_together(table),
        row=table.row,
        further=table.further,
    )


def _at(column: NameColumn, rows: np.typing.NDArray[np.int64]) -> tuple[str, ...]:
    return tuple(map(column.names.__getitem__, column.code[rows].tolist()))


def _cancelled_together(table: Table) -> tuple[str, ...]:
    """Let a status on any row of a sample or test cancel all rows of that name at that site."""
    status = table.names["status"].cells()
    together = list(zip(table.names["site"].cells(), table.names[table.form.key].cells(), strict=True))
    reasons: dict[tuple[str, str], dict[str, None]] = {}
    for name, reason in zip(together, status, strict=True):
        if reason:
            reasons.setdefault(name, {})[reason] = None
    return tuple("; ".join(reasons.get(name, ())) for name in together)
