"""Rules that every grid from a file must follow: size, places, units, holes, and map system."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import CsvRow
from .map_system import MapSystem, require_true_lengths, utm_zone

MOST_CELLS: Final = 50_000_000
FINEST, COARSEST = 0.01, 1e5
"""Smallest and largest allowed cell (m): below, coordinates within ±360 look like degrees."""


class Limits(NamedTuple):
    """Smallest and largest allowed number of a column, and a hint for numbers outside."""

    lowest: float
    highest: float
    note: Message


_PLACE: Final = Limits(-1e8, 1e8, Message("Give coordinates in m."))
_HEIGHT: Final = Limits(
    -5000.0,
    9000.0,
    Message(
        "A number outside often marks a hole. Fix: cut out a rectangle that is measured everywhere, or fill the gaps, "
        "such as by gdal_fillnodata."
    ),
)
_SNOW: Final = Limits(0.0, 1e6, Message("Check the unit."))
LIMITS: Final[Mapping[str, Limits]] = {
    "x": _PLACE,
    "y": _HEIGHT,
    "x_m": _PLACE,
    "y_m": _PLACE,
    "z_m": _HEIGHT,
    "H_V_N_per_mm3": _SNOW,
    "S_f_N_per_mm2": _SNOW,
    "mu_share": _SNOW,
}
"""By column, x and y being those of a profile. 9000 m is above the highest mountain, and heights may count from a place
of the slope."""


@dataclass(frozen=True, slots=True)
class PlacedValues:
    """Columns of values at evenly spaced places, as read from a grid file.

    x, y: places (m), (n,) and (m,), rising.
    columns: values (n, m) by the name of their column.
    """

    x: FloatArray
    y: FloatArray
    columns: dict[str, FloatArray]


@dataclass(frozen=True, slots=True)
class Raster:
    """Grid of heights as read from its file.

    values: heights (rows, columns) in units of `height_unit`, NaN in a hole.
    first, step: middle of the first cell and distance to the next, in x and in y, in the map system's units.
    height_unit: m, length of one unit of the heights.
    system: map system; None if the file states none: metres.
    where: words for the place of a cell in the file, from its row and column (0 or more).
    """

    path: str | Path
    values: FloatArray
    first: tuple[float, float]
    step: tuple[float, float]
    height_unit: float
    system: MapSystem | None
    where: Callable[[int, int], Message]


def number_within(row: CsvRow, column: str) -> float:
    """Number in a cell of a table, checked against the limits of its column."""
    value = row.number(column)
    allowed = LIMITS[column]
    if not allowed.lowest <= value <= allowed.highest:
        raise ParameterError(
            "{path}, row {row}, column {column}: {cell!r} is out of range. Allowed: from {lowest:g} to {highest:g}. "
            "{note}"
        ).tag(
            "out_of_range",
            path=row.path,
            row=row.row,
            column=column,
            cell=row.cells[column],
            lowest=allowed.lowest,
            highest=allowed.highest,
            note=allowed.note,
        )
    return value


def require_size(path: str | Path, n_columns: float, n_rows: float) -> None:
    """Reject a grid that is too small for a surface or too large for the memory."""
    for name, count in (("ncols", n_columns), ("nrows", n_rows)):
        if not 2 <= count <= MOST_CELLS or count != int(count):
            raise ParameterError("{path}: {name} is {count:g}. Allowed: whole numbers from 2 to {most_cells}.").tag(
                "out_of_range", path=path, name=name, count=count, most_cells=MOST_CELLS
            )
    if n_columns * n_rows > MOST_CELLS:
        raise ParameterError(
            "{path}: The grid has {n_columns:g} × {n_rows:g} cells. Allowed: at most {most_cells}. Cut out the slope."
        ).tag("out_of_range", path=path, n_columns=n_columns, n_rows=n_rows, most_cells=MOST_CELLS)


def require_places(path: str | Path, first: tuple[float, float], step: tuple[float, float], n: tuple[int, int]) -> None:
    """Reject places that are not finite or look like degrees, and cells of impossible size."""
    ends = []
    for axis, start, size, count in zip("xy", first, step, n, strict=True):
        if not 0.0 < abs(size) <= COARSEST:
            raise ParameterError(
                "{path}: The cells are {size:g} m wide in {axis}. Allowed: from {finest:g} to {coarsest:g} m."
            ).tag("out_of_range", path=path, size=size, axis=axis, finest=FINEST, coarsest=COARSEST)
        ends += [start, start + size * (count - 1)]
        if not max(abs(ends[-2]), abs(ends[-1])) <= _PLACE.highest:
            raise ParameterError(
                "{path}: The grid reaches from {axis} = {first:g} to {last:g} m. Allowed: from {lowest:g} to "
                "{highest:g} m."
            ).tag(
                "out_of_range",
                path=path,
                axis=axis,
                first=ends[-2],
                last=ends[-1],
                lowest=_PLACE.lowest,
                highest=_PLACE.highest,
            )
    fine = max(abs(size) for size in step) < FINEST
    if fine and max(map(abs, ends[:2])) <= 360.0 and max(map(abs, ends[2:])) <= 90.0:
        raise ParameterError(
            _degrees_message(path, Message("The unit of x and y looks like degrees."), ends[0], ends[2], abs(step[0]))
        ).tag("in_degrees")
    if min(abs(size) for size in step) < FINEST:
        raise ParameterError("{path}: A cell is {step:g} m wide. Allowed: {finest:g} m or more.").tag(
            "out_of_range", path=path, step=min(map(abs, step)), finest=FINEST
        )


def require_metres(path: str | Path, heights: PlacedValues, column: str, *, steepest: float) -> None:
    """Reject degrees that are too coarse for `require_places`: most steps are steeper (m/m) than any slope."""
    first, step = (heights.x[0], heights.y[0]), (heights.x[1] - heights.x[0], heights.y[1] - heights.y[0])
    if max(step) >= 1.0 or np.abs(heights.x).max() > 360.0 or np.abs(heights.y).max() > 90.0:
        return
    rises = [np.median(np.abs(np.diff(heights.columns[column], axis=axis))) / step[axis] for axis in (0, 1)]
    if max(rises) > steepest:
        unit = Message("The unit of x and y looks like degrees.")
        raise ParameterError(_degrees_message(path, unit, *first, step[0])).tag("in_degrees")


def placed_heights(raster: Raster, *, column: str) -> PlacedValues:
    """Heights of a raster in m, at places (m) in rising order, as one column."""
    path, system, (n_rows, n_columns) = raster.path, raster.system, raster.values.shape
    require_size(path, n_columns, n_rows)
    if system is not None:
        _require_usable(raster, system)
    unit = 1.0 if system is None else system.unit
    first, step = ((pair[0] * unit, pair[1] * unit) for pair in (raster.first, raster.step))
    require_places(path, first, step, (n_columns, n_rows))
    heights = raster.values * raster.height_unit
    _require_heights(raster, heights)
    x, y = (
        start + size * np.arange(count, dtype=float)
        for start, size, count in zip(first, step, (n_columns, n_rows), strict=True)
    )
    values = heights.T
    if step[0] < 0.0:
        x, values = x[::-1], values[::-1]
    if step[1] < 0.0:
        y, values = y[::-1], values[:, ::-1]
    return PlacedValues(x, y, {column: np.ascontiguousarray(values)})


def _require_usable(raster: Raster, system: MapSystem) -> None:
    """Reject a raster in degrees, with depths instead of heights, or in a map system that distorts lengths."""
    n_rows, n_columns = raster.values.shape
    x, y = (
        start + size * (count - 1) / 2.0
        for start, size, count in zip(raster.first, raster.step, (n_columns, n_rows), strict=True)
    )
    if system.in_degrees:
        raise ParameterError(
            _degrees_message(
                raster.path,
                Message("The unit of x and y is degrees ({system}).", system=system.name),
                x,
                y,
                abs(raster.step[0]),
            )
        ).tag("in_degrees")
    if system.downwards:
        raise ParameterError(
            "{path}: The vertical system of {name} counts downwards. Allowed: heights. Fix: change the sign and "
            "state heights."
        ).tag("out_of_range", path=raster.path, name=system.name)
    require_true_lengths(raster.path, system, x, y)


def _degrees_message(path: str | Path, unit: Message, longitude: float, latitude: float, size: float) -> Message:
    """Error message for a grid with cells of `size` (°), with a gdalwarp command that converts it to metres."""
    target = utm_zone(longitude, latitude) if abs(latitude) <= 90.0 else "EPSG:32632"
    return Message(
        "{path}: {unit} The grid is at x = {x:.6g}, y = {y:.6g}, its cells are {size:.3g} wide. Allowed: metres, with "
        "cells of {finest:g} m or more. Fix: warp it to metres, such as gdalwarp -t_srs {target} -r cubic.",
        path=path,
        unit=unit,
        x=longitude,
        y=latitude,
        size=size,
        finest=FINEST,
        target=target,
    )


def _require_heights(raster: Raster, heights: FloatArray) -> None:
    """Reject holes: NODATA, numbers that are not finite, and numbers that no place on the earth has as its height."""
    bad = ~((heights >= _HEIGHT.lowest) & (heights <= _HEIGHT.highest))
    if not bad.any():
        return
    row, column = (int(index) for index in np.argwhere(bad)[0])
    value = heights[row, column]
    problem = Message("no height (NODATA)") if np.isnan(value) else Message("{value:g} m is not a height", value=value)
    raise ParameterError(
        "{path}, {where}: {problem}; {count} of {size} cells are like it. Allowed: from {lowest:g} to {highest:g} m. "
        "{note}"
    ).tag(
        "out_of_range",
        path=raster.path,
        where=raster.where(row, column),
        problem=problem,
        count=int(bad.sum()),
        size=bad.size,
        lowest=_HEIGHT.lowest,
        highest=_HEIGHT.highest,
        note=_HEIGHT.note,
    )
