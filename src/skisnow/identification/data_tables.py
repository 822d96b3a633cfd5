"""CSV tables of photo-cell times, with the unit in each column name."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import CsvRow, csv_rows
from .._support.units import ShownFields
from ..parameters import Quantity

_ACTION: Final = Message("Write finite numbers without their units, with one decimal mark in all of the file.")
_MEASURED: Final = {"station": Message("station"), "time": Message("time")}
_PASSAGE: Final = (
    Quantity("station_m", "distance from the start down, which no cell lies before"),
    Quantity("time_s", "of the passage"),
    Quantity("time_sd_s", "standard deviation of it", lowest=0.0, above=True, needed=False),
)
CELL_COLUMNS: Final = ("run", "station_m", "time_s")
CELL_SPREAD: Final = "time_sd_s"


def _column(rows: list[CsvRow], quantity: Quantity) -> FloatArray:
    """Numbers (n,) in the unit of the column's name; NaN for empty cells of an optional quantity."""
    name, values = quantity.name, np.full(len(rows), np.nan)
    for place, row in enumerate(rows):
        if quantity.needed or row.cells.get(name):
            values[place] = row.number(name)
            if quantity.outside(values[place]):
                allowed = Message("Allowed is {allowed} {unit}.", allowed=quantity.allowed, unit=quantity.unit)
                raise row.refused(name, allowed, code="out_of_range")
    return values


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PhotoCellRun(ShownFields):
    """The passages of one run.

    name: Name of the run.
    station: (n,) m, distance from the start down to the cell, along the slope's surface, rising.
    time: (n,) s, time of each passage, rising.
    time_sd: (n,) s or None, standard deviation of each time; None if not stated.
    """

    name: str
    station: FloatArray
    time: FloatArray
    time_sd: FloatArray | None = None

    def __post_init__(self) -> None:
        if len(self.station) < 1 or self.station.shape != self.time.shape:
            raise ParameterError("run {name}: {n_cells} cells and {n_times} times").tag(
                "unequal_lengths", name=self.name, n_cells=len(self.station), n_times=len(self.time)
            )
        if self.station[0] < 0.0:
            raise ParameterError(
                "run {name}: station {station:g} m is before the start. Give distances from the scenario's start down"
            ).tag("before_start", name=self.name, station=self.station[0])
        for what, values, unit in (("station", self.station, "m"), ("time", self.time, "s")):
            wrong = np.flatnonzero(np.diff(values) <= 0.0)
            if wrong.size:
                first, second = values[wrong[0]], values[wrong[0] + 1]
                raise ParameterError(
                    "run {name}: {what} {second:g} {unit} follows {first:g} {unit}; both must rise from cell to "
                    "cell. Sort the rows of the run, and check for a clock that was set back"
                ).tag(f"{what}_not_rising", name=self.name, what=_MEASURED[what], second=second, unit=unit, first=first)
        if self.time_sd is not None and not np.all(self.time_sd > 0.0):
            raise ParameterError("run {name}: time_sd_s must be above 0").tag("out_of_range", name=self.name)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PhotoCells(ShownFields):
    """All runs of a file."""

    name: str
    runs: tuple[PhotoCellRun, ...]


def read_photo_cells(path: str | Path) -> PhotoCells:
    """Read ``run, station_m, time_s[, time_sd_s]``, one row for each passage.

    Raises ParameterError: the file cannot be read, a column is missing, a cell is not a number (row and column are
        named), distances or times do not rise, or only some rows of a run state a standard deviation.
    """
    table = list(csv_rows(Path(path), CELL_COLUMNS, further=(CELL_SPREAD,), action=_ACTION))
    if not table:
        raise ParameterError("{name} has no rows below its header").tag("no_rows", name=path)
    station, time, spread = (_column(table, quantity) for quantity in _PASSAGE)
    for row in table:
        if not row.cells["run"]:
            raise row.refused("run", Message("The cell is empty."), code="empty_cell")
    names = [row.cells["run"] for row in table]
    runs = []
    for name in dict.fromkeys(names):
        rows = np.array([run == name for run in names])
        try:
            unknown = np.isnan(spread[rows])
            if unknown.any() and not unknown.all():
                raise ParameterError(
                    "run {name}: time_sd_s is given in some rows only. Give it in all rows, or in none"
                ).tag("partial_accuracy", name=name)
            runs.append(PhotoCellRun(name, station[rows], time[rows], None if unknown.any() else spread[rows]))
        except ParameterError as error:
            raise ParameterError("{name}: {error}").tag(error.code, name=path, error=error) from error
    return PhotoCells(str(path), tuple(runs))
