"""Rows of a table to experiments: which rows belong together, and whether they agree on what they must agree on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..problems import Problem
    from ..records import BoolArray, FloatArray, IntArray
    from .columns import NameColumn, Table

from ..problems import error


@dataclass(frozen=True, slots=True)
class Blocks:
    """Runs of rows with one key: m blocks, block i being rows ``first[i]:first[i + 1]``."""

    first: IntArray

    @classmethod
    def of_runs(cls, key: NameColumn) -> Blocks:
        """Cut where the key changes."""
        changes = np.flatnonzero(key.code[1:] != key.code[:-1]) + 1
        return cls(np.concatenate(([0], changes, [len(key.code)])).astype(np.int64))

    @classmethod
    def of_single_rows(cls, count: int) -> Blocks:
        """Let each row be a block of its own."""
        return cls(np.arange(count + 1, dtype=np.int64))

    @property
    def start(self) -> IntArray:
        """First row of each block."""
        return self.first[:-1]

    @property
    def of_row(self) -> IntArray:
        """Block of each row."""
        return np.repeat(np.arange(len(self.start), dtype=np.int64), np.diff(self.first))

    def first_of(self, chosen: BoolArray) -> IntArray:
        """Offsets of the blocks among the chosen rows alone: m + 1 of them."""
        count = np.add.reduceat(chosen.astype(np.int64), self.start)
        return np.concatenate(([0], np.cumsum(count))).astype(np.int64)

    def first_given(self, given: BoolArray) -> IntArray:
        """First row of each block for which ``given`` holds, or the block's first row."""
        chosen = self.start.copy()
        rows = np.flatnonzero(given)[::-1]
        chosen[self.of_row[rows]] = rows  # of repeated indices the last assignment stays
        return chosen

    def means(self, values: FloatArray) -> FloatArray:
        """Mean of each block's numbers that are not NaN; exact where they are all the same."""
        given = ~np.isnan(values)
        count = np.add.reduceat(given.astype(np.int64), self.start)
        low, high = np.fmin.reduceat(values, self.start), np.fmax.reduceat(values, self.start)
        total = np.add.reduceat(np.where(given, values, 0.0), self.start)
        return np.where(low == high, low, total / np.maximum(count, 1) + np.where(count > 0, 0.0, np.nan))

    def texts(self, column: NameColumn) -> tuple[str, ...]:
        """Each block's different texts that are not blank, joined by semicolons."""
        collected: dict[int, dict[str, None]] = {}
        block = self.of_row
        for row in np.flatnonzero(~column.is_blank).tolist():
            collected.setdefault(int(block[row]), {})[column[row]] = None
        return tuple("; ".join(collected.get(index, ())) for index in range(len(self.start)))


def check_series(table: Table, blocks: Blocks) -> Iterator[Problem]:
    """Find experiments of several rows that change their place, tool or angle, or have rows in two places."""
    key = table.names[table.form.key]
    if table.form.key in table.absent:
        return
    yield from _repeated_name(table, blocks)
    for name in (*table.form.names, "spot"):
        column = table.names[name]
        if name != table.form.key:
            reference = blocks.first_given(~column.is_blank)[blocks.of_row]
            differs = (column.code != column.code[reference]) & ~column.is_blank & ~key.is_blank
            for row in np.flatnonzero(differs).tolist():
                yield _mixed(table, row, int(reference[row]), name, column[row], column[int(reference[row])])
    angle = table.numbers["edge_angle_deg"]
    reference = blocks.first_given(~np.isnan(angle))[blocks.of_row]
    differs = (angle != angle[reference]) & ~np.isnan(angle) & ~key.is_blank
    for row in np.flatnonzero(differs).tolist():
        other = float(angle[reference[row]])
        yield _mixed(table, row, int(reference[row]), "edge_angle_deg", f"{angle[row]:.12g}", f"{other:.12g}")


def check_one_site(table: Table) -> Iterator[Problem]:
    """Find tests that are given two sites."""
    key, site = table.names[table.form.key], table.names["site"]
    if table.absent & {table.form.key, "site"}:
        return
    first_row: dict[int, int] = {}
    for row in np.flatnonzero(~key.is_blank & ~site.is_blank).tolist():
        reference = first_row.setdefault(int(key.code[row]), row)
        if site.code[row] != site.code[reference]:
            yield _mixed(table, row, reference, "site", site[row], site[reference])


def _repeated_name(table: Table, blocks: Blocks) -> Iterator[Problem]:
    key = table.names[table.form.key]
    code = key.code[blocks.start]
    _, met_first = np.unique(code, return_index=True)
    again = np.ones(len(code), dtype=np.bool_)
    again[met_first] = False
    start_of_code = dict(zip(code[met_first].tolist(), blocks.start[met_first].tolist(), strict=True))
    for row in blocks.start[again & ~key.is_blank[blocks.start]].tolist():
        before = int(table.row[start_of_code[int(key.code[row])]])
        yield error(
            "mixed_experiment",
            table.form.file,
            row=int(table.row[row]),
            column=table.form.key,
            experiment=key[row],
            value=key[row],
            allowed=f"each name for one experiment, its rows together; this one also begins in row {before}",
            action="Rename one of the two, or bring the rows together.",
        )


def _mixed(table: Table, row: int, reference: int, column: str, value: str, other: str) -> Problem:
    return error(
        "mixed_experiment",
        table.form.file,
        row=int(table.row[row]),
        column=column,
        experiment=table.names[table.form.key][row],
        value=value,
        allowed=f"one {column} in an experiment; row {int(table.row[reference])} has {other!r}",
        action="Correct the cell, or give the rows that were another experiment another name.",
    )
