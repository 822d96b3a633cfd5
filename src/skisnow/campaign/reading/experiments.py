"""Conversion of rows to experiments: blocks of rows, checks of their consistency, records in SI."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import compress
from typing import Any, Final

import numpy as np

from ..._support.arrays import BoolArray, FloatArray, IntArray
from ..._support.messages import Message
from ..._support.units import DEGREE, MM
from ..problems import Problem
from ..records import DensitySamples, DropConeTests, PenetrationTests, ShearTests, TurningReadings, UnloadingReadings
from .columns import NameColumn, Table, is_unloading
from .table_forms import BRANCH


@dataclass(frozen=True, slots=True)
class Blocks:
    """m blocks of consecutive rows of a table, one per experiment; block i has the rows ``first[i]:first[i + 1]``."""

    first: IntArray

    @classmethod
    def of_runs(cls, key: NameColumn) -> Blocks:
        """Blocks of consecutive rows that have the same name in the column `key`."""
        changes = np.flatnonzero(key.code[1:] != key.code[:-1]) + 1
        return cls(np.concatenate(([0], changes, [len(key.code)])).astype(np.int64))

    @property
    def start(self) -> IntArray:
        """Index of the first row of each block (m,)."""
        return self.first[:-1]

    @property
    def of_row(self) -> IntArray:
        """Index of the block of each row (n,)."""
        return np.repeat(np.arange(len(self.start), dtype=np.int64), np.diff(self.first))

    def first_of(self, chosen: BoolArray) -> IntArray:
        """Offsets (m + 1,) of the blocks in an array of only the chosen rows."""
        count = np.add.reduceat(chosen.astype(np.int64), self.start)
        return np.concatenate(([0], np.cumsum(count))).astype(np.int64)

    def first_chosen(self, mask: BoolArray) -> IntArray:
        """Index of the first row of each block at which ``mask`` is True; without one, that of its first row."""
        chosen = self.start.copy()
        rows = np.flatnonzero(mask)[::-1]
        chosen[self.of_row[rows]] = rows  # of repeated indices the last assignment stays
        return chosen

    def means(self, values: FloatArray) -> FloatArray:
        """Mean (m,) of each block's numbers without NaN; exact if all are equal."""
        finite = ~np.isnan(values)
        count = np.add.reduceat(finite.astype(np.int64), self.start)
        low, high = np.fmin.reduceat(values, self.start), np.fmax.reduceat(values, self.start)
        total = np.add.reduceat(np.where(finite, values, 0.0), self.start)
        return np.where(low == high, low, total / np.maximum(count, 1) + np.where(count > 0, 0.0, np.nan))

    def texts(self, column: NameColumn) -> tuple[str, ...]:
        """For each block, the distinct texts of a column that are not blank, joined by semicolons."""
        collected: dict[int, dict[str, None]] = {}
        block = self.of_row
        for row in np.flatnonzero(~column.is_blank).tolist():
            collected.setdefault(int(block[row]), {})[column[row]] = None
        return tuple("; ".join(collected.get(index, ())) for index in range(len(self.start)))


TURNING: Final = "turning_angle_deg"


def shear_blocks(table: Table) -> Blocks:
    """Blocks of a shear table: rows of an experiment with turning angles, and single rows without one."""
    turned = ~np.isnan(table.numbers[TURNING])
    if not turned.any():
        return Blocks(np.arange(len(table) + 1, dtype=np.int64))
    code = table.names[table.form.key].code
    goes_on = (code[1:] == code[:-1]) & turned[1:] & turned[:-1]
    return Blocks(np.concatenate(([0], np.flatnonzero(~goes_on) + 1, [len(code)])).astype(np.int64))


def check_series(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Errors for experiments that change their site, tool or angle, or whose rows are not consecutive."""
    key = table.names[table.form.key]
    if table.form.key in table.absent:
        return
    first_row: dict[int, int] = {}
    for row in blocks.start[~key.is_blank[blocks.start]].tolist():
        before = first_row.setdefault(int(key.code[row]), row)
        if before != row:
            line = int(table.row[before])
            allowed = Message(
                "each name for one experiment, its rows together; this one also begins in row {before}", before=line
            )
            action = Message("Rename one of the two, or bring the rows together.")
            yield table.error(row, "mixed_experiment", table.form.key, key[row], allowed, action)
    for name in (*table.form.names, "spot"):
        column = table.names[name]
        if name != table.form.key:
            reference = blocks.first_chosen(~column.is_blank)[blocks.of_row]
            differs = (column.code != column.code[reference]) & ~column.is_blank & ~key.is_blank
            for row in np.flatnonzero(differs).tolist():
                yield _mixed_error(table, row, int(reference[row]), name, column[row], column[int(reference[row])])
    yield from check_one_number(table, blocks, "edge_angle_deg")


def check_one_number(table: Table, blocks: Blocks, column: str) -> Iterator[Problem]:
    """Errors for rows of an experiment whose number in a column differs from its first one; gaps are allowed."""
    values, blank = table.numbers[column], table.names[table.form.key].is_blank
    reference = blocks.first_chosen(~np.isnan(values))[blocks.of_row]
    differs = (values != values[reference]) & ~np.isnan(values) & ~blank
    for row in np.flatnonzero(differs).tolist():
        first = int(reference[row])
        yield _mixed_error(table, row, first, column, f"{values[row]:.12g}", f"{values[first]:.12g}")


def check_one_site(table: Table) -> Iterator[Problem]:
    """Errors for rows of a test at another site than its first row; nothing if a column is missing."""
    key, site = table.names[table.form.key], table.names["site"]
    if table.absent & {table.form.key, "site"}:
        return
    first_row: dict[int, int] = {}
    for row in np.flatnonzero(~key.is_blank & ~site.is_blank).tolist():
        reference = first_row.setdefault(int(key.code[row]), row)
        if site.code[row] != site.code[reference]:
            yield _mixed_error(table, row, reference, "site", site[row], site[reference])


def _mixed_error(table: Table, row: int, reference: int, column: str, value: str, other: str) -> Problem:
    """Error for a row whose `column` differs from that of the experiment's row `reference`."""
    line = int(table.row[reference])
    allowed = Message("one {column} in an experiment; row {row} has {other!r}", column=column, row=line, other=other)
    action = Message("Correct the cell, or give the rows that were another experiment another name.")
    return table.error(row, "mixed_experiment", column, value, allowed=allowed, action=action)


def penetration_tests(table: Table) -> PenetrationTests:
    """Penetration experiments in SI from a table without errors, with unloading readings apart."""
    blocks = Blocks.of_runs(table.names["experiment"])
    taken_off = is_unloading(table.names[BRANCH])
    is_unloaded = bool(taken_off.any())
    laid_on = ~taken_off if is_unloaded else slice(None)
    after = table.numbers["depth_after_mm"][laid_on]
    further, counted = table.further, (~taken_off).tolist()
    if is_unloaded:
        further = {name: tuple(compress(cells, counted)) for name, cells in further.items()}
    return PenetrationTests(
        **_experiments(table, blocks, blocks.start),
        first=blocks.first_of(~taken_off),
        load=table.numbers["load_N"][laid_on],
        penetration_depth=table.numbers["depth_mm"][laid_on] * MM,
        row=table.row[laid_on],
        further=further,
        unloading=UnloadingReadings(
            first=blocks.first_of(taken_off),
            load=table.numbers["load_N"][taken_off],
            penetration_depth=table.numbers["depth_mm"][taken_off] * MM,
            row=table.row[taken_off],
        )
        if is_unloaded
        else None,
        depth_after=None if np.isnan(after).all() else after * MM,
    )


def _experiments(table: Table, blocks: Blocks, rows: IntArray) -> dict[str, Any]:
    """Fields of records that penetration and shear experiments share, by name; `rows`: row of names and angles."""
    spot = table.names["spot"]
    return {
        **{name: _cells_at(table.names[name], rows) for name in table.form.names},
        "spot": _cells_at(spot, blocks.first_chosen(~spot.is_blank)),
        "edge_angle": table.numbers["edge_angle_deg"][rows] * DEGREE,
        "snow_density": blocks.means(table.numbers["snow_density_kg_per_m3"]),
        "drop_cone_depth": blocks.means(table.numbers["drop_cone_depth_mm"]) * MM,
        "cancelled": blocks.texts(table.names["status"]),
    }


def shear_tests(table: Table) -> ShearTests:
    """Shear experiments of a valid table: the largest moment, and means of density and cone depth, of each.

    `turning` has all moments over turning angles.
    """
    blocks = shear_blocks(table)
    moment, angle = table.numbers["moment_Nm"], table.numbers["turning_angle_deg"]
    largest = blocks.first_chosen(moment == np.maximum.reduceat(moment, blocks.start)[blocks.of_row])
    is_turned = ~np.isnan(angle)
    turning = None
    if is_turned.any():
        turning = TurningReadings(blocks.first_of(is_turned), angle[is_turned] * DEGREE, moment[is_turned])
    return ShearTests(
        **_experiments(table, blocks, largest),
        penetration_depth=table.numbers["depth_mm"][largest] * MM,
        lever_arm=table.numbers["lever_arm_mm"][largest] * MM,
        moment=moment[largest],
        row=table.row[largest],
        further={name: tuple(cells[row] for row in largest.tolist()) for name, cells in table.further.items()},
        turning=turning,
    )


def density_samples(table: Table) -> DensitySamples:
    """Density samples in SI from a table without errors."""
    return DensitySamples(
        **single_rows(table),
        snow_density=table.numbers["snow_density_kg_per_m3"],
        sample_depth=table.numbers["sample_depth_mm"] * MM,
        sample_thickness=table.numbers["sample_thickness_mm"] * MM,
    )


def drop_cone_tests(table: Table) -> DropConeTests:
    """Repeats of drop-cone tests in SI from a table without errors."""
    return DropConeTests(**single_rows(table), drop_cone_depth=table.numbers["drop_cone_depth_mm"] * MM)


def single_rows(table: Table) -> dict[str, Any]:
    """Fields of records of single rows by name: names, reasons of cancellations, lines of the file, other texts.

    A status in one row of a test cancels all its rows at that site.
    """
    names = {name: table.names[name].cells() for name in table.form.names}
    tests = list(zip(names["site"], names[table.form.key], strict=True))
    reasons: dict[tuple[str, str], dict[str, None]] = {}
    for test, reason in zip(tests, table.names["status"].cells(), strict=True):
        if reason:
            reasons.setdefault(test, {})[reason] = None
    cancelled = tuple("; ".join(reasons.get(test, ())) for test in tests)
    return {**names, "cancelled": cancelled, "row": table.row, "further": table.further}


def _cells_at(column: NameColumn, rows: np.typing.NDArray[np.int64]) -> tuple[str, ...]:
    """Texts of a column at the given row indices."""
    return tuple(map(column.names.__getitem__, column.code[rows].tolist()))
