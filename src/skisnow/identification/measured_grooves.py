"""The track left in the snow: depth and width of the groove, and the radius of the turn."""

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


@dataclass(frozen=True, slots=True, kw_only=True)
class GrooveRow:
    """A row of a file of measured grooves; what was not measured is left out."""

    depth: Annotated[float | None, Quantity("depth_mm", "depth of the groove", lowest=0.0, above=True)] = None
    width: Annotated[float | None, Quantity("width_mm", "width of the groove", lowest=0.0, above=True)] = None
    turn_radius: Annotated[float | None, Quantity("turn_radius_m", "radius of the track on either side")] = None
    depth_sd: Annotated[float | None, Quantity("depth_sd_mm", "of the depth", lowest=0.0, above=True)] = None
    width_sd: Annotated[float | None, Quantity("width_sd_mm", "of the width", lowest=0.0, above=True)] = None
    turn_radius_sd: Annotated[float | None, Quantity("turn_radius_sd_m", "of the radius", lowest=0.0, above=True)] = (
        None
    )


_ROW: Final = own_quantities(GrooveRow)
COLUMNS: Final = tuple(each.name for each in _ROW[:3])
SPREADS: Final = tuple(each.name for each in _ROW[3:])
FEWEST_FOR_SCATTER: Final = 3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MeasuredGrooves(ShownFields):
    """Places along a track, (n,) each, in m.

    Attributes
    ----------
    name
        Of the file.
    depth, width
        Of the groove that stays, and across it in the snow's surface; NaN where not measured.
    turn_radius
        Of the track, > 0 whatever the side; NaN where not measured.
    depth_sd, width_sd, turn_radius_sd
        Their standard deviations.
    stated
        Whether all of them stand in the file; else they are the scatter of the places.
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
                    raise ParameterError(
                        f"{self.name}: {what} of place {place + 1} is {values[place]:g} m; above 0 is allowed"
                    )
                if not spread[place] > 0.0:
                    raise ParameterError(
                        f"{self.name}: the standard deviation of {what} of place {place + 1} must be above 0"
                    )

    def __len__(self) -> int:
        return len(self.depth)


def read_measured_grooves(path: str | Path) -> MeasuredGrooves:
    """Read ``depth_mm, width_mm, turn_radius_m, depth_sd_mm, width_sd_mm, turn_radius_sd_m``, a row for each place.

    Columns and cells may be missing; without standard deviations the scatter of three places or more takes their part.

    Raises
    ------
    ParameterError
        The file cannot be read, none of the three quantities is there, or a number is missing or not above 0.
    """
    return grooves_of(read_table(Path(path)))


def grooves_of(table: TableFile) -> MeasuredGrooves:
    """The grooves of a table that was read."""
    table.require(())
    table.require_no_slip((*COLUMNS, *SPREADS))
    columns = {}
    stated = True
    for quantity, spread in zip(_ROW[:3], _ROW[3:], strict=True):
        name = quantity.name
        values = _column(table, quantity) * quantity.factor
        known = np.isfinite(values)
        sd = _column(table, spread) * spread.factor
        if np.isfinite(sd[known]).all():
            columns[name] = (values, sd)
            continue
        stated = False
        columns[name] = (values, np.full(len(values), _scatter(table.name, name, values[known])))
    (depth, depth_sd), (width, width_sd), (radius, radius_sd) = (columns[name] for name in COLUMNS)
    if not any(np.isfinite(each).any() for each in (depth, width, radius)):
        raise ParameterError(f"{table.name} holds none of {', '.join(COLUMNS)}")
    return MeasuredGrooves(table.name, depth, width, np.abs(radius), depth_sd, width_sd, radius_sd, stated)


def _column(table: TableFile, quantity: Quantity) -> FloatArray:
    if quantity.name not in table.columns:
        return np.full(len(table.rows), np.nan)
    return table.numbers(quantity)


def _scatter(file: str, name: str, values: FloatArray) -> float:
    if len(values) < FEWEST_FOR_SCATTER:
        raise ParameterError(
            f"{file}: {name} has no standard deviation ({name.replace('_mm', '_sd_mm').replace('s_m', 's_sd_m')}), and "
            f"{len(values)} places are too few for their scatter to say it; give it, or {FEWEST_FOR_SCATTER} places"
        )
    return max(float(np.std(values, ddof=1)), 1e-6)
