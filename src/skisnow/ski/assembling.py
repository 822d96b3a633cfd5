"""A `Ski` from its parts: the outline from three widths (an arc, a rounded tip, a square tail), and all tables."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .layout import GREATEST_SPACING, BaseShape, Layout, StationFunction
from .ski import Ski
from .table_file import StationTable, evenly_spread

TIP_END_SHARE: Final = 0.2
"""Width at the very tip as a share of the tip width, where it is not given. Modelling assumption: a blunt end, so that
the ski has a width everywhere."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ArcOutline:
    """Widths over the stations of a ski of which three widths are known (m).

    Modelling assumptions:

    - The side line is one parabola (constant curvature to a part in a thousand) through the half widths at the front
      end, the middle and the rear end of the sidecut length. With tip and tail unlike, the ski is narrowest a little
      behind the middle, by (tip - tail)²/(8 (tip + tail - 2 waist)) less than the waist.
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
        sidecut = self.tip_width + self.tail_width - 2.0 * self.waist_width
        side = self.waist_width + taper * share + 2.0 * sidecut * share**2
        overhang = self.layout.tip - front
        if overhang <= 0:
            return side
        beyond = np.clip((station - front) / overhang, 0.0, 1.0)
        end = TIP_END_SHARE if self.end_width is None else self.end_width / self.tip_width
        return np.asarray(side * np.sqrt(1.0 - (1.0 - end**2) * beyond**2))


FEWEST_ROWS: Final = 3
"""Rows within the sidecut length without which nothing says how deep the sidecut is."""
LEAST_SHARE: Final = 0.5
"""Share of the sidecut length that these rows span at least (modelling assumption)."""
_AT_THE_END: Final = 1e-3  # m: a row at the end of the sidecut length, measured on another day


def width_of_table(table: StationTable, layout: Layout) -> StationFunction:
    """Width (m) as a function of station (m), from a table of widths.

    A dense table is used directly. For a coarser table a parabola, fitted to the rows within the sidecut length, gives
    the sidecut; the differences of the rows from it follow the shape-preserving cubic of `StationTable` (modelling
    assumption). Three rows give the side line of three widths; a cubic through the widths themselves would be flat at
    the widest and at the narrowest row, unlike any ski.
    """
    if np.max(-np.diff(table.station), initial=0.0) <= GREATEST_SPACING + 1e-9:
        return table.at
    parabola = _fit_parabola(table, layout)
    rest = StationTable(table.station, table.value - parabola(table.station))
    return lambda station: parabola(station) + rest.at(station)


def _fit_parabola(table: StationTable, layout: Layout) -> StationFunction:
    """Parabola of the widths within the sidecut length, constant beyond; rejects too few rows or a short span."""
    front, rear = layout.widest_points
    inside = (table.station <= front + _AT_THE_END) & (table.station >= rear - _AT_THE_END)
    station = table.station[inside]
    span = float(station[0] - station[-1]) if station.size else 0.0
    if station.size < FEWEST_ROWS or span < LEAST_SHARE * layout.sidecut_length:
        raise ParameterError(
            "the column width_mm has {size} rows, {span:.0f} mm apart, within the sidecut length, from {front:.4g} "
            "to {rear:.4g} m. Allowed are {fewest_rows} rows or more over at least half of it: give rows at both "
            "ends and at the waist, and better every 10 cm"
        ).tag("table_too_short", size=station.size, span=span * 1e3, front=front, rear=rear, fewest_rows=FEWEST_ROWS)
    within = np.clip(station, rear, front)
    coefficients = np.polynomial.polynomial.polyfit(within, table.value[inside], 2)
    return lambda at: np.asarray(np.polynomial.polynomial.polyval(np.clip(at, rear, front), coefficients))


_SAME_PLACE = 1e-9  # m


def assembled_ski(
    layout: Layout,
    *,
    width: StationFunction,
    base: BaseShape | StationFunction,
    bending_stiffness: StationFunction,
    torsional_stiffness: StationFunction,
    mass_per_length: StationFunction | None = None,
    mass: float = 0.0,
    stations: FloatArray | None = None,
    like: Ski | None = None,
    **others: Any,
) -> Ski:
    """Tabulate the known properties of a ski densely, each a function of station (m) in SI.

    width, bending_stiffness, torsional_stiffness: as in `Ski`.
    base: its shape, or its height, which may have any value at the boot.
    mass_per_length: as in `Ski`; None: proportional to the width (modelling assumption), with ``mass``.
    mass: mass of the ski (kg); used only without ``mass_per_length``.
    stations: requested stations (m), tip to tail; those of layout and boot are added and gaps above 2.5 mm divided
        evenly.
    like: a ski of nearly the same lengths, whose stations are moved with tip, tail, contact points and widest points:
        tables with the same number of rows, which differ smoothly; None: own stations.
    others: name, source, edges and keys, as in `Ski`.
    """
    if like is not None:
        station = like.station if stations is not None else moved_stations(like.station, like.layout, layout)
    elif stations is not None and np.max(-np.diff(stations)) <= GREATEST_SPACING + _SAME_PLACE:
        station = stations
    else:
        station = _dense_grid(layout, () if stations is None else tuple(stations.tolist()))
    widths = width(station)
    base_height = base(station) if callable(base) else base.height_at(station, layout)
    if mass_per_length is None:
        area = -np.trapezoid(widths, station) or 1.0  # without an area the tables are rejected below
        per_length = widths * (mass / area)
    else:
        per_length = mass_per_length(station)
    return Ski(
        station=station,
        width=widths,
        base_height=base_height - np.interp(0.0, station[::-1], base_height[::-1]),
        bending_stiffness=bending_stiffness(station),
        torsional_stiffness=torsional_stiffness(station),
        mass_per_length=per_length,
        running_length=layout.running_length,
        sidecut_length=layout.sidecut_length,
        sidecut_middle=layout.middle,
        base=base if isinstance(base, BaseShape) else None,
        **others,
    )


@functools.lru_cache(maxsize=16)
def _dense_grid(layout: Layout, stations: tuple[float, ...]) -> FloatArray:
    """Stations (m) from tip to tail that include the given and the characteristic ones, with limited spacing."""
    own = [layout.tip, *layout.widest_points, *layout.contact_points, layout.middle, 0.0, layout.tail]
    places = np.unique(np.clip([*own, *stations], layout.tail, layout.tip))[::-1]
    places = places[np.append(True, -np.diff(places) > _SAME_PLACE)]
    counts = np.ceil(-np.diff(places) / GREATEST_SPACING - _SAME_PLACE).astype(int)
    pieces = [
        np.linspace(start, end, count, endpoint=False)
        for start, end, count in zip(places[:-1], places[1:], counts, strict=True)
    ]
    return np.concatenate([*pieces, places[-1:]])


def moved_stations(station: FloatArray, before: Layout, after: Layout) -> FloatArray:
    """Stations (m) that move with tip, tail, contact points and widest points; the boot stays."""

    def fixed(layout: Layout) -> FloatArray:
        return np.array([layout.tail, *layout.widest_points, *layout.contact_points, 0.0, layout.tip])

    _, first = np.unique(np.round(fixed(before), 9), return_index=True)
    shift = (fixed(after) - fixed(before))[first]
    return np.asarray(station + np.interp(station, fixed(before)[first], shift))


def arc_ski(
    layout: Layout,
    *,
    name: str,
    source: str,
    tip_width: float,
    waist_width: float,
    tail_width: float,
    mass: float,
    bending_stiffness: npt.ArrayLike,
    torsional_stiffness: npt.ArrayLike,
    stiffness_station: npt.ArrayLike | None = None,
    base: BaseShape | None = None,
    base_bevel: float = 0.0,
    edge_width: float = 0.002,
) -> Ski:
    """Make a ski from three widths, a mass and a few stiffnesses, in SI.

    layout: of its lengths, see `layout_of_lengths`.
    tip_width, waist_width, tail_width: at the front end, the middle and the rear end of the sidecut length (m).
    mass: mass of the ski (kg), without binding; spread in proportion to the width (modelling assumption).
    bending_stiffness, torsional_stiffness: EI and GJ (N m²), tip to tail, one value or several.
    stiffness_station: stations of both (m, from the boot, falling); default: evenly spaced over the running length
        (modelling assumption). Between them a shape-preserving cubic, beyond them the end values.
    base: camber, rocker and heights; default: flat, with the usual shovel and tail.
    base_bevel, edge_width: as in `Ski`.
    Raises ParameterError: the parts do not fit together or break a rule of `Ski`.
    """
    outline = ArcOutline(layout=layout, tip_width=tip_width, waist_width=waist_width, tail_width=tail_width)
    return assembled_ski(
        layout,
        width=outline.width_at,
        base=BaseShape() if base is None else base,
        bending_stiffness=stiffness_table(bending_stiffness, stiffness_station, layout).at,
        torsional_stiffness=stiffness_table(torsional_stiffness, stiffness_station, layout).at,
        mass=mass,
        name=name,
        source=source,
        base_bevel=base_bevel,
        edge_width=edge_width,
    )


def stiffness_table(values: npt.ArrayLike, station: npt.ArrayLike | None, layout: Layout) -> StationTable:
    """Table of a stiffness, at its stations (m) or evenly spaced over the running length, tip to tail."""
    if station is None:
        return evenly_spread(values, *layout.contact_points)
    listed = np.atleast_1d(np.asarray(values, dtype=float))
    return StationTable(np.atleast_1d(np.asarray(station, dtype=float)), listed)
