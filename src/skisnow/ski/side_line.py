"""The width of a ski from a table with few rows: a side line between them that is as smooth as a ski's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .checks import GREATEST_SPACING
from .table_file import StationTable

if TYPE_CHECKING:
    from .assembling import Along
    from .layout import Layout

FloatArray = npt.NDArray[np.float64]

FEWEST_ROWS: Final = 3
"""Rows within the sidecut length without which nothing says how deep the sidecut is."""
LEAST_SHARE: Final = 0.5
"""Share of the sidecut length that these rows span at least (modelling assumption)."""
_SAME_PLACE: Final = 1e-3  # m: a row at the end of the sidecut length, measured on another day


def width_of_table(table: StationTable, layout: Layout) -> Along:
    """Widths (m) at stations (m).

    A dense table is used as it is. Between the rows of a coarser one a parabola, fitted to those within the sidecut
    length, carries the sidecut; what the rows differ from it follows the shape-preserving cubic of `StationTable`
    (modelling assumption). Three rows give the side line of three widths; a cubic through the widths themselves would
    be flat at the
    widest and at the narrowest row, and bend between them as no ski does.

    Raises
    ------
    ParameterError
        There are too few rows within the sidecut length, or they lie together.
    """
    if np.max(-np.diff(table.station), initial=0.0) <= GREATEST_SPACING + 1e-9:
        return table.at
    parabola = _parabola(table, layout)
    rest = StationTable(table.station, table.value - parabola(table.station))
    return lambda station: parabola(station) + rest.at(station)


@dataclass(frozen=True, slots=True, eq=False)
class _Parabola:
    """Widths a + b s + c s² over the sidecut length; beyond its ends those of the ends."""

    coefficients: FloatArray
    front: float
    rear: float

    def __call__(self, station: FloatArray) -> FloatArray:
        return np.asarray(np.polynomial.polynomial.polyval(np.clip(station, self.rear, self.front), self.coefficients))


def _parabola(table: StationTable, layout: Layout) -> _Parabola:
    front, rear = layout.widest_points
    inside = (table.station <= front + _SAME_PLACE) & (table.station >= rear - _SAME_PLACE)
    station = table.station[inside]
    span = float(station[0] - station[-1]) if station.size else 0.0
    if station.size < FEWEST_ROWS or span < LEAST_SHARE * layout.sidecut_length:
        raise ParameterError(
            f"the column width_mm has {station.size} rows, {span * 1e3:.0f} mm apart, within the sidecut length, from "
            f"{front:.4g} to {rear:.4g} m. Allowed are {FEWEST_ROWS} rows or more over at least half of it: give rows "
            "at both ends and at the waist, and better every 10 cm"
        )
    within = np.clip(station, rear, front)
    coefficients = np.asarray(np.polynomial.polynomial.polyfit(within, table.value[inside], 2), dtype=np.float64)
    return _Parabola(coefficients, front, rear)
