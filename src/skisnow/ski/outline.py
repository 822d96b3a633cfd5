"""The outline of a ski from three widths: one arc along the sides, a rounded tip, a square tail."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .checks import GREATEST_SPACING, STRAIGHT
from .layout import Layout, StationFunction
from .table_file import StationTable

TIP_END_SHARE: Final = 0.2
"""Width at the very tip as a share of the tip width, where it is not given. Modelling assumption: a blunt end, so that
the ski has a width everywhere."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcOutline:
    """Widths over the stations of a ski of which three widths are known (m).

    Modelling assumptions:

    - The side line is one parabola (constant curvature to a part in a thousand) through the half widths at the front
      end, the middle and the rear end of the sidecut length. With tip and tail unlike, the ski is narrowest a little
      behind the middle, by `narrowing` less than the waist.
    - In front of the sidecut length the outline closes with a quarter ellipse, cut off at ``end_width``.
    - Behind the sidecut length it runs straight.

    layout: layout of the ski.
    tip_width, waist_width, tail_width: at the front end, the middle and the rear end of the sidecut length.
    end_width: at the very tip; None: 20 % of the tip width.
    """

    layout: Layout
    tip_width: float
    waist_width: float
    tail_width: float
    end_width: float | None = None

    def width_at(self, station: FloatArray) -> FloatArray:
        """Width (m) at stations (m) between tip and tail."""
        front, rear = self.layout.widest_points
        share = (np.clip(station, rear, front) - self.layout.middle) / self.layout.sidecut_length
        taper = self.tip_width - self.tail_width
        side = self.waist_width + taper * share + 2.0 * self._deepening * share**2
        overhang = self.layout.tip - front
        if overhang <= 0:
            return side
        beyond = np.clip((station - front) / overhang, 0.0, 1.0)
        end = TIP_END_SHARE if self.end_width is None else self.end_width / self.tip_width
        return np.asarray(side * np.sqrt(1.0 - (1.0 - end**2) * beyond**2))

    @property
    def _deepening(self) -> float:
        return self.tip_width + self.tail_width - 2.0 * self.waist_width

    @property
    def narrowing(self) -> float:
        """Width of the waist minus that of the narrowest place (m): (tip - tail)²/(8 (tip + tail - 2 waist)).

        >>> from .layout import layout_of_lengths
        >>> layout = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
        >>> slalom = ArcOutline(layout=layout, tip_width=0.116, waist_width=0.068, tail_width=0.101)
        >>> round(slalom.narrowing * 1e3, 2)  # mm
        0.35
        """
        taper = self.tip_width - self.tail_width
        return taper**2 / (8.0 * self._deepening) if self._deepening > 0 else 0.0


FEWEST_ROWS: Final = 3
"""Rows within the sidecut length without which nothing says how deep the sidecut is."""
LEAST_SHARE: Final = 0.5
"""Share of the sidecut length that these rows span at least (modelling assumption)."""
_SAME_PLACE: Final = 1e-3  # m: a row at the end of the sidecut length, measured on another day


def width_of_table(table: StationTable, layout: Layout) -> StationFunction:
    """Widths (m) at stations (m).

    A dense table is used directly. For a coarser table a parabola, fitted to the rows within the sidecut length, gives
    the sidecut; the differences of the rows from it follow the shape-preserving cubic of `StationTable` (modelling
    assumption). Three rows give the side line of three widths; a cubic through the widths themselves would be flat at
    the widest and at the narrowest row, unlike any ski.
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
            "the column width_mm has {size} rows, {span:.0f} mm apart, within the sidecut length, from {front:.4g} "
            "to {rear:.4g} m. Allowed are {fewest_rows} rows or more over at least half of it: give rows at both "
            "ends and at the waist, and better every 10 cm",
            code="table_too_short",
            size=station.size,
            span=span * 1e3,
            front=front,
            rear=rear,
            fewest_rows=FEWEST_ROWS,
        )
    within = np.clip(station, rear, front)
    coefficients = np.asarray(np.polynomial.polynomial.polyfit(within, table.value[inside], 2), dtype=np.float64)
    return _Parabola(coefficients, front, rear)


def radius_of_least_squares_circle(along: FloatArray, across: FloatArray) -> float:
    """Radius of the circle with the smallest sum of squared distances to points of a plane (m).

    along, across: coordinates of the points (m). Shape (n,), n ≥ 3.
    Returns: above 0, in m; infinite where the points lie on a straight line to a tenth of a micrometre.

    Pratt's form A (x² + y²) + B x + C y + D = 0 with B² + C² - 4 A D = 1 (Pratt 1987, Computer Graphics 21:145). It
    minimises Σ (d + d²/2R)², d the distance of a point from the circle. The edge of a ski is within 0.1 mm of its
    circle and R is metres, so it is the circle of least squares to 5 digits beyond the first. Unlike the centre
    and radius themselves it stays well posed as the line becomes straight.

    >>> turn = np.linspace(-0.05, 0.05, 41)
    >>> round(radius_of_least_squares_circle(13.0 * np.sin(turn), 0.034 + 13.0 * (1.0 - np.cos(turn))), 9)
    13.0
    """
    x, y = along - along.mean(), across - across.mean()
    scale = float(np.max(np.abs(x)))
    curvature = _pratt_curvature(x / scale, y / scale) / scale
    return 1.0 / curvature if curvature * scale**2 / 2.0 > STRAIGHT else float("inf")


def _pratt_curvature(x: FloatArray, y: FloatArray) -> float:
    points = np.column_stack([x**2 + y**2, x, y, np.ones_like(x)])
    constraint = np.array([[0.0, 0, 0, -2], [0, 1, 0, 0], [0, 0, 1, 0], [-2, 0, 0, 0]])
    residuals, circles = np.linalg.eig(np.linalg.solve(constraint, points.T @ points / len(x)))
    # the constraint has one negative direction, whose circle is imaginary: the answer is the one nearest to 0
    A, B, C, D = np.real(circles[:, np.argmin(np.abs(residuals))])
    return float(2.0 * abs(A) / np.sqrt(B**2 + C**2 - 4.0 * A * D))
