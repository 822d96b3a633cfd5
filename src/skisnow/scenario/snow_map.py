"""Snow that varies, from files: H_V, S_f and friction over a grid or along the slope, and layers over the depth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import CsvRow, csv_rows
from .._support.units import MM, N_PER_MM2, N_PER_MM3, Facts, Shown, span
from ..geometry.surfaces import Grid
from ..snow import SnowProperties
from .raster import number_within
from .raster_formats import read_grid_table

FINER: Final = 4
"""Parts into which a patch is divided by the search for values below 0."""
_PATCHES_AT_ONCE: Final = 16_384


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class SnowMap(Shown):
    """H_V, S_f and friction over the place, in the scenario's coordinates; beyond its border the last value continues.

    Attributes
    ----------
    hardness
        H_V (N/m³), everywhere > 0; None: that of the scenario's snow.
    failure_shear_stress
        S_f (N/m²), everywhere > 0; None: that of the scenario's snow.
    friction_share
        μ over that of the scenario, everywhere > 0; None: 1.
    source
        Where it comes from, in words.

    Raises
    ------
    ParameterError
        It contains none of them, or a value that is not above 0, at its places or between them.

    See Also
    --------
    skisnow.SnowProperties
    skisnow.Scenario

    Examples
    --------
    >>> SnowMap(hardness=Grid.along([0.0, 10.0], [1e8, 4e8]))
    <SnowMap H_V 0.1 to 0.4 N/mm³: given as numbers>
    """

    hardness: Grid | None = None
    failure_shear_stress: Grid | None = None
    friction_share: Grid | None = None
    source: str = Message("given as numbers")

    def __post_init__(self) -> None:
        grids = (("H_V", self.hardness), ("S_f", self.failure_shear_stress), ("mu_share", self.friction_share))
        if all(grid is None for _, grid in grids):
            raise ParameterError("a snow map has neither H_V nor S_f nor friction; add at least one of them").tag(
                "missing"
            )
        for name, grid in grids:
            if grid is not None:
                _require_positive(name, grid)

    @property
    def mean_hardness(self) -> float | None:
        """Geometric mean of H_V (N/m³) over the map's places; None if the map has no H_V."""
        return None if self.hardness is None else float(np.exp(np.mean(np.log(self.hardness.values))))

    @property
    def mean_stress(self) -> float | None:
        """Mean of S_f (N/m²) over the map's places; None if the map has no S_f."""
        return None if self.failure_shear_stress is None else float(self.failure_shear_stress.values.mean())

    def means_of(self, snow: SnowProperties) -> SnowProperties:
        """The snow with the map's means as H_V and S_f."""
        hardness, stress = self.mean_hardness, self.mean_stress
        if hardness is not None:
            snow = replace(snow, snow_hardness=hardness, snow_hardness_interval=None)
        if stress is not None:
            snow = replace(snow, failure_shear_stress=stress, failure_shear_stress_interval=None)
        if hardness is None and stress is None:
            return snow
        names = " and ".join(name for name, value in (("H_V", hardness), ("S_f", stress)) if value is not None)
        return replace(snow, source=f"{snow.source}; {names}: means over the snow map {self.source}")

    def _repr_facts(self) -> Facts:
        """Title with the ranges of the mapped quantities and the source."""
        parts = [
            f"{name} {span(float(grid.values.min()) / size, float(grid.values.max()) / size, unit)}"
            for name, grid, size, unit in (
                ("H_V", self.hardness, N_PER_MM3, "N/mm³"),
                ("S_f", self.failure_shear_stress, N_PER_MM2, "N/mm²"),
                ("mu_share", self.friction_share, 1.0, ""),
            )
            if grid is not None
        ]
        return Facts(f"{', '.join(parts)}: {self.source}")


def _require_positive(name: str, grid: Grid) -> None:
    """Reject values of 0 or less, at the places and between them, where smooth patches may overshoot."""
    i, j = np.unravel_index(int(np.argmin(grid.values)), grid.values.shape)
    if grid.values[i, j] <= 0.0:
        raise ParameterError("{name} of the snow map is {value:g} at x = {x:g} m, y = {y:g} m; it must be above 0").tag(
            "out_of_range", name=name, value=grid.values[i, j], x=grid.x[i], y=grid.y[j]
        )
    x, y = _corners_that_may_swing(grid)
    parts = np.linspace(0.0, 1.0, FINER + 1)
    for first in range(0, len(x), _PATCHES_AT_ONCE):
        some = slice(first, first + _PATCHES_AT_ONCE)
        finer_x, finer_y = np.broadcast_arrays(
            x[some, None, None] + grid.steps[0] * parts[:, None], y[some, None, None] + grid.steps[1] * parts
        )
        values = grid.values_at(finer_x, finer_y)
        lowest = int(np.argmin(values))
        if values.flat[lowest] <= 0.0:
            raise ParameterError(
                "{name} of the snow map falls from one place to the next so steeply that the curve through its "
                "values goes below 0 at x = {x:g} m, y = {y:g} m; give more places there"
            ).tag("out_of_range", name=name, x=finer_x.flat[lowest], y=finer_y.flat[lowest])


def _corners_that_may_swing(grid: Grid) -> tuple[FloatArray, FloatArray]:
    """X and y of the first corner of each patch that may reach below 0.

    A patch is in the convex hull of its Bézier points, which are its corners' values, give or take a third of their
    slopes over the patch.
    """
    along_x, along_y = grid.gradients(grid.x[:, None], grid.y[None, :])
    swing = (np.abs(along_x) * grid.steps[0] + np.abs(along_y) * grid.steps[1]) / 3.0
    low = np.pad(grid.values <= swing, ((0, 1), (0, 1)), mode="edge")
    i, j = np.nonzero(low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:])
    return grid.x[i], grid.y[j]


SIZES: Final = {"H_V_N_per_mm3": N_PER_MM3, "S_f_N_per_mm2": N_PER_MM2, "mu_share": 1.0}
PLACES_PER_STEP: Final = 16
"""Places of an uneven row's even table for each of its shortest distances."""
MOST_PLACES: Final = 20_000
CLOSEST: Final = 1e-6
"""Rows nearer to each other (m) are at the same place."""
_ACTION: Final = Message(
    "Write x_m and one or more of H_V_N_per_mm3, S_f_N_per_mm2 and mu_share, one row for each place along the slope; "
    "with y_m one row for each place of an even grid."
)


def read_snow_map(path: str | Path) -> SnowMap:
    """Read H_V, S_f and friction over the place.

    path: CSV with ``x_m``, one or more of ``H_V_N_per_mm3``, ``S_f_N_per_mm2`` and ``mu_share`` (μ over the
        scenario's), and where the snow varies across the slope ``y_m``. With ``y_m`` places are those of an even grid,
        in any order; without it x rises, evenly or not, and values between are those of monotone cubics (PCHIP).
    Raises ParameterError: the file cannot be read, a column is missing, a cell has no number above 0, or places do not
        form a grid; file, row, column and value are named.
    """
    rows = []
    for row in csv_rows(path, ("x_m",), further=("y_m", *SIZES), action=_ACTION):
        for name in filter(row.cells.__contains__, SIZES):
            if not number_within(row, name) > 0.0:
                raise row.refused(name, Message("A number above 0 is needed."), code="out_of_range")
        rows.append(row)
    names = [name for name in SIZES if rows and name in rows[0].cells]
    if not names:
        raise ParameterError("{path}: no column of {columns}, or no row. {action}").tag(
            "missing", path=path, columns=list(SIZES), action=_ACTION
        )
    if "y_m" in rows[0].cells:
        table = read_grid_table(path, names, action=_ACTION)
        grids = {name: Grid(table.x, table.y, SIZES[name] * values) for name, values in table.columns.items()}
    else:
        grids = _grids_along_x(path, rows, names)
    try:
        return SnowMap(
            hardness=grids.get("H_V_N_per_mm3"),
            failure_shear_stress=grids.get("S_f_N_per_mm2"),
            friction_share=grids.get("mu_share"),
            source=str(path),
        )
    except ParameterError as error:
        raise error.at(path) from error


def _grids_along_x(path: str | Path, rows: Sequence[CsvRow], names: Sequence[str]) -> dict[str, Grid]:
    """Grids over x only; cubics without overshoot convert uneven places to even ones."""
    x = np.array([number_within(row, "x_m") for row in rows])
    if len(x) < 2:
        raise ParameterError("{path}: there are {n_x} rows; snow that varies needs two or more").tag(
            "out_of_range", path=path, n_x=len(x)
        )
    for row, step in zip(rows[1:], np.diff(x), strict=True):
        if not step > CLOSEST:
            raise row.refused(
                "x_m",
                Message("x does not rise."),
                code="not_rising",
                action=Message("Sort the rows, and keep one of those at the same place."),
            )
    from scipy.interpolate import PchipInterpolator  # slow to load

    count = min(MOST_PLACES, PLACES_PER_STEP * math.ceil((x[-1] - x[0]) / np.diff(x).min()) + 1)
    even = np.linspace(x[0], x[-1], count)
    columns = {name: SIZES[name] * np.array([row.number(name) for row in rows]) for name in names}
    return {name: Grid.along(even, PchipInterpolator(x, values)(even)) for name, values in columns.items()}


MOST_LAYERS: Final = 100
"""Rows of a profile; a run evaluates the pressure between each two."""
_LAYERS_ACTION: Final = Message(
    "Write depth_mm, the top of each layer from 0 on, and hardness_share (of H_V) or force_N (of a SnowMicroPen)."
)


@dataclass(frozen=True, slots=True)
class SnowLayers:
    """Tops (m), rising from 0, and hardness over H_V of each layer, with the file."""

    tops: tuple[float, ...]
    shares: tuple[float, ...]
    source: str


def read_snow_layers(path: str | Path) -> SnowLayers:
    """Read the hardness over the depth.

    path: CSV with ``depth_mm``, the top of each layer, the first 0, and ``hardness_share`` (hardness over H_V) or
        ``force_N``, whose mean over the depth of the file corresponds to H_V.
    """
    every = csv_rows(path, ("depth_mm",), further=("hardness_share", "force_N"), action=_LAYERS_ACTION)
    rows = list(islice(every, MOST_LAYERS + 1))
    names = [name for name in ("hardness_share", "force_N") if rows and name in rows[0].cells]
    if len(names) != 1 or len(rows) > MOST_LAYERS:
        raise ParameterError(
            "{path}: {count} rows with the columns {columns}; allowed are 1 to {most} rows with one of hardness_share "
            "and force_N. {action}"
        ).tag("wrong_kind", path=path, count=len(rows), columns=names, most=MOST_LAYERS, action=_LAYERS_ACTION)
    tops = np.array([row.number("depth_mm") for row in rows]) * MM
    values = np.array([row.number(names[0]) for row in rows])
    for row, step, value in zip(rows, np.diff(tops, prepend=-1.0), values, strict=True):
        if not value > 0.0:
            raise row.refused(names[0], Message("A number above 0 is needed."), code="out_of_range")
        if step <= 0.0 or (row is rows[0] and step != 1.0):
            raise row.refused("depth_mm", Message("Depths rise from 0."), code="not_rising", action=_LAYERS_ACTION)
    if names[0] == "force_N":
        values = values / (np.average(values[:-1], weights=np.diff(tops)) if len(rows) > 1 else values[0])
    return SnowLayers(tuple(tops.tolist()), tuple(values.tolist()), str(path))
