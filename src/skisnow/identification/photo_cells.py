"""Photo-cell times: their file, and one entry for each run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.errors import ParameterError
from ..parameters import Quantity, own_quantities
from .table_file import TableFile, read_table

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Passage:
    """A row of a file of photo cells."""

    run: Annotated[str, Quantity("run", "name of the run")]
    station: Annotated[float, Quantity("station_m", "distance from the start down, which no cell lies before")]
    time: Annotated[float, Quantity("time_s", "of the passage")]
    time_sd: Annotated[float | None, Quantity("time_sd_s", "standard deviation of it", lowest=0.0, above=True)] = None


_PASSAGE: Final = own_quantities(Passage)
COLUMNS: Final = tuple(each.name for each in _PASSAGE if each.needed)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PhotoCellRun(ShownFields):
    """The passages of one run.

    Attributes
    ----------
    name
        Of the run.
    station : (n,) m
        Distance from the start down to the cell, along the slope's surface, rising.
    time : (n,) s
        Of the passage, rising.
    time_sd : (n,) s or None
        Standard deviation of each time; None where none is stated.
    """

    name: str
    station: FloatArray
    time: FloatArray
    time_sd: FloatArray | None = None

    def __post_init__(self) -> None:
        if len(self.station) < 1 or self.station.shape != self.time.shape:
            raise ParameterError(f"run {self.name}: {len(self.station)} cells and {len(self.time)} times")
        if self.station[0] < 0.0:
            raise ParameterError(
                f"run {self.name}: station {self.station[0]:g} m lies before the start; they count from the "
                "scenario's start down"
            )
        for what, values, unit in (("station", self.station, "m"), ("time", self.time, "s")):
            wrong = np.flatnonzero(np.diff(values) <= 0.0)
            if wrong.size:
                first, second = values[wrong[0]], values[wrong[0] + 1]
                raise ParameterError(
                    f"run {self.name}: {what} {second:g} {unit} follows {first:g} {unit}; both must rise "
                    "from cell to cell. Sort the rows of the run, and look for a clock that was set back"
                )
        if self.time_sd is not None and not np.all(self.time_sd > 0.0):
            raise ParameterError(f"run {self.name}: time_sd_s must be above 0")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PhotoCells(ShownFields):
    """All runs of a file."""

    name: str
    runs: tuple[PhotoCellRun, ...]


def read_photo_cells(path: str | Path) -> PhotoCells:
    """Read ``run, station_m, time_s[, time_sd_s]``, one row for each passage.

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing, a cell is no number (row and column are named), distances or times
        do not rise, or only some rows of a run state a standard deviation.
    """
    return photo_cells_of(read_table(Path(path)))


def photo_cells_of(table: TableFile) -> PhotoCells:
    """The runs of a table that was read."""
    table.require(COLUMNS)
    table.require_no_slip(tuple(each.name for each in _PASSAGE))
    names = table.texts("run")
    _, station_m, time_s, time_sd_s = _PASSAGE
    station, time = table.numbers(station_m), table.numbers(time_s)
    sd = table.numbers(time_sd_s) if time_sd_s.name in table.columns else None
    runs = []
    for name in dict.fromkeys(names):
        rows = np.array([each == name for each in names])
        try:
            runs.append(PhotoCellRun(name, station[rows], time[rows], _sd_of_run(name, sd, rows)))
        except ParameterError as error:
            raise ParameterError(f"{table.name}: {error}") from error
    return PhotoCells(table.name, tuple(runs))


def _sd_of_run(name: str, sd: FloatArray | None, rows: npt.NDArray[np.bool_]) -> FloatArray | None:
    if sd is None or np.isnan(sd[rows]).all():
        return None
    if np.isnan(sd[rows]).any():
        raise ParameterError(f"run {name}: time_sd_s stands in some rows only; write it in all of them, or in none")
    return sd[rows]
