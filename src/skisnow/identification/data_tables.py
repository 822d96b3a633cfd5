"""CSV tables of photo-cell times and of measured grooves, with the unit in each column name."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.spreadsheet_text import MOST_CSV_BYTES, number
from .._support.units import ShownFields
from .._support.user_files import plain_bytes
from ..parameters import Allowed, Quantity, own_quantities
from ..track.readers.text import decimal_mark_of, decode_text, require_width, split_cells

FEWEST_FOR_SCATTER: Final = 3


_NOT_A_NUMBER: Final = {
    False: template(
        "{name}, row {row}, column {column}: {value!r} is not a finite number; write one with a decimal point, without "
        "its unit"
    ),
    True: template(
        "{name}, row {row}, column {column}: {value!r} is not a finite number; write one with a decimal comma, "
        "as others "
        "in the file, without its unit"
    ),
}
_MEASURED: Final = {
    "station": Message("station"),
    "time": Message("time"),
    "depth": Message("depth"),
    "width": Message("width"),
    "turn_radius": Message("turn radius"),
}


@dataclass(frozen=True, slots=True)
class TableFile:
    """Cells of a table as text.

    rows: line number and cells of each line that is not blank.
    header_row: line number of the header.
    mark: decimal point or comma.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    header_row: int = 1
    mark: str = "."

    def require(self, columns: tuple[str, ...]) -> None:
        """Reject a table without these columns, or without rows."""
        missing = [name for name in columns if name not in self.columns]
        if missing:
            raise ParameterError(
                "{name}, row {header_row}: the column {missing} is missing; the columns are {columns}; required are "
                "{needed}"
            ).tag(
                "missing_column",
                name=self.name,
                header_row=self.header_row,
                missing=missing[0],
                columns=list(self.columns),
                needed=list(columns),
            )
        if not self.rows:
            raise ParameterError("{name} has no rows below its header").tag("no_rows", name=self.name)

    def reject_misspelt_columns(self, expected: tuple[str, ...]) -> None:
        """Reject a column whose name is similar to that of a missing one: it would not be read."""
        absent = [name for name in expected if name not in self.columns]
        for name in self.columns:
            similar = difflib.get_close_matches(name.lower(), absent, n=1, cutoff=0.75) if name not in expected else []
            if similar:
                raise ParameterError(
                    "{name}, row {header_row}: unknown column {column}. Did you mean {similar}? Rename it, or give "
                    "it a different name if it is not to be read"
                ).tag("misspelled_column", name=self.name, header_row=self.header_row, column=name, similar=similar[0])

    def texts(self, column: str) -> list[str]:
        """The cells of a column, which must not be empty."""
        place = self.columns.index(column)
        texts = []
        for row, cells in self.rows:
            text = cells[place] if place < len(cells) else ""
            if not text:
                raise ParameterError("{name}, row {row}, column {column}: the cell is empty").tag(
                    "empty_cell", name=self.name, row=row, column=column
                )
            texts.append(text)
        return texts

    def numbers(self, quantity: Quantity) -> FloatArray:
        """Numbers of a column (n,), in the unit of its name; NaN for an empty cell of an optional quantity."""
        column = quantity.name
        place = self.columns.index(column)
        values = []
        for row, cells in self.rows:
            text = cells[place] if place < len(cells) else ""
            if not text and not quantity.needed:
                values.append(math.nan)
                continue
            value = number(text, self.mark)
            if not math.isfinite(value):
                sentence = _NOT_A_NUMBER[self.mark == ","]
                raise ParameterError(sentence).tag("not_a_number", name=self.name, row=row, column=column, value=text)
            try:
                quantity.in_range(value)
            except ParameterError as error:
                raise ParameterError("{name}, row {row}: {error}").tag(
                    error.code, name=self.name, row=row, error=error
                ) from None
            values.append(value)
        return np.array(values)


def read_table(path: Path) -> TableFile:
    """Read a table as spreadsheet programs write it: commas, semicolons or tabs, decimal points or commas."""
    data = plain_bytes(path, most_bytes=MOST_CSV_BYTES)
    cells = split_cells(decode_text(data, str(path)), str(path))
    require_width(cells, str(path))
    mark = decimal_mark_of((cell for row in cells.rows for cell in row), cells.separator)
    return TableFile(str(path), cells.header, tuple(zip(cells.lines, cells.rows, strict=True)), cells.header_line, mark)


@dataclass(frozen=True, slots=True)
class Passage:
    """A row of a file of photo cells."""

    run: Annotated[str, Quantity("run", "name of the run")]
    station: Annotated[float, Quantity("station_m", "distance from the start down, which no cell lies before")]
    time: Annotated[float, Quantity("time_s", "of the passage")]
    time_sd: Annotated[float | None, Quantity("time_sd_s", "standard deviation of it"), Allowed(0.0, above=True)] = None


_PASSAGE: Final = own_quantities(Passage)
CELL_COLUMNS: Final = tuple(quantity.name for quantity in _PASSAGE if quantity.needed)


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
    return parse_photo_cells(read_table(Path(path)))


def parse_photo_cells(table: TableFile) -> PhotoCells:
    """Convert a table to runs of photo cells; errors as in `read_photo_cells`."""
    table.require(CELL_COLUMNS)
    table.reject_misspelt_columns(tuple(quantity.name for quantity in _PASSAGE))
    names = table.texts("run")
    _, station_m, time_s, time_sd_s = _PASSAGE
    station, time = table.numbers(station_m), table.numbers(time_s)
    spread = table.numbers(time_sd_s) if time_sd_s.name in table.columns else None
    runs = []
    for name in dict.fromkeys(names):
        rows = np.array([run == name for run in names])
        try:
            runs.append(PhotoCellRun(name, station[rows], time[rows], _sd_of_run(name, spread, rows)))
        except ParameterError as error:
            raise ParameterError("{name}: {error}").tag(error.code, name=table.name, error=error) from error
    return PhotoCells(table.name, tuple(runs))


def _sd_of_run(name: str, sd: FloatArray | None, rows: BoolArray) -> FloatArray | None:
    if sd is None or np.isnan(sd[rows]).all():
        return None
    if np.isnan(sd[rows]).any():
        raise ParameterError("run {name}: time_sd_s is given in some rows only. Give it in all rows, or in none").tag(
            "partial_accuracy", name=name
        )
    return sd[rows]


@dataclass(frozen=True, slots=True, kw_only=True)
class GrooveRow:
    """A row of a file of measured grooves; None for a quantity that was not measured."""

    depth: Annotated[float | None, Quantity("depth_mm", "depth of the groove"), Allowed(0.0, above=True)] = None
    width: Annotated[float | None, Quantity("width_mm", "width of the groove"), Allowed(0.0, above=True)] = None
    turn_radius: Annotated[float | None, Quantity("turn_radius_m", "radius of the track on either side")] = None
    depth_sd: Annotated[float | None, Quantity("depth_sd_mm", "of the depth"), Allowed(0.0, above=True)] = None
    width_sd: Annotated[float | None, Quantity("width_sd_mm", "of the width"), Allowed(0.0, above=True)] = None
    turn_radius_sd: Annotated[float | None, Quantity("turn_radius_sd_m", "of the radius"), Allowed(0.0, above=True)] = (
        None
    )


_ROW: Final = own_quantities(GrooveRow)
GROOVE_COLUMNS: Final = tuple(quantity.name for quantity in _ROW[:3])
SPREADS: Final = tuple(quantity.name for quantity in _ROW[3:])


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MeasuredGrooves(ShownFields):
    """Places along a track, (n,) each, in m.

    name: Name of the file.
    depth, width: Depth of the remaining groove, and its width across it in the snow's surface; NaN if not measured.
    turn_radius: Radius of the track, > 0 to either side; NaN if not measured.
    depth_sd, width_sd, turn_radius_sd: Their standard deviations.
    stated: True if the file has all standard deviations; otherwise they are the scatter of the places.
    """

    name: str
    depth: FloatArray
    width: FloatArray
    turn_radius: FloatArray
    depth_sd: FloatArray
    width_sd: FloatArray
    turn_radius_sd: FloatArray
    stated: bool = True

    def __post_init__(self) -> None:
        for what in ("depth", "width", "turn_radius"):
            values, spread = getattr(self, what), getattr(self, f"{what}_sd")
            for place in np.flatnonzero(np.isfinite(values)):
                if values[place] <= 0.0:
                    raise ParameterError("{name}: {what} of place {place} is {value:g} m; it must be above 0").tag(
                        "out_of_range", name=self.name, what=_MEASURED[what], place=place + 1, value=values[place]
                    )
                if not spread[place] > 0.0:
                    raise ParameterError(
                        "{name}: the standard deviation of {what} of place {place} must be above 0"
                    ).tag("out_of_range", name=self.name, what=_MEASURED[what], place=place + 1)

    def __len__(self) -> int:
        return len(self.depth)


def read_measured_grooves(path: str | Path) -> MeasuredGrooves:
    """Read ``depth_mm, width_mm, turn_radius_m, depth_sd_mm, width_sd_mm, turn_radius_sd_m``, a row for each place.

    Columns and cells may be missing. A missing standard deviation is estimated from the scatter of at least 3 places.

    Raises ParameterError: the file cannot be read, all three quantities are missing, or a number is missing or not
        above 0.
    """
    return parse_grooves(read_table(Path(path)))


def parse_grooves(table: TableFile) -> MeasuredGrooves:
    """Convert a table to measured grooves; errors as in `read_measured_grooves`."""
    table.require(())
    table.reject_misspelt_columns((*GROOVE_COLUMNS, *SPREADS))
    columns = {}
    stated = True
    for quantity, spread in zip(_ROW[:3], _ROW[3:], strict=True):
        name = quantity.name
        values = _read_column(table, quantity) * quantity.factor
        measured = np.isfinite(values)
        sd = _read_column(table, spread) * spread.factor
        if np.isfinite(sd[measured]).all():
            columns[name] = (values, sd)
            continue
        stated = False
        columns[name] = (values, np.full(len(values), _standard_deviation(table.name, name, values[measured])))
    (depth, depth_sd), (width, width_sd), (radius, radius_sd) = (columns[name] for name in GROOVE_COLUMNS)
    if not any(np.isfinite(values).any() for values in (depth, width, radius)):
        raise ParameterError("{name} has no column of {columns}").tag(
            "no_columns", name=table.name, columns=list(GROOVE_COLUMNS)
        )
    return MeasuredGrooves(table.name, depth, width, np.abs(radius), depth_sd, width_sd, radius_sd, stated)


def _read_column(table: TableFile, quantity: Quantity) -> FloatArray:
    if quantity.name not in table.columns:
        return np.full(len(table.rows), np.nan)
    return table.numbers(quantity)


def _standard_deviation(file: str, name: str, values: FloatArray) -> float:
    if len(values) < FEWEST_FOR_SCATTER:
        raise ParameterError(
            "{file}: {name} has no standard deviation ({column}), and {count} places are too few to estimate it; "
            "state it, or measure {fewest} places"
        ).tag(
            "no_deviation",
            file=file,
            name=name,
            column=name.replace("_mm", "_sd_mm").replace("s_m", "s_sd_m"),
            count=len(values),
            fewest=FEWEST_FOR_SCATTER,
        )
    return max(float(np.std(values, ddof=1)), 1e-6)
