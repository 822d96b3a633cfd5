"""A ski: its shape, stiffness and mass, as dense tables along it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import Facts, Shown, amount
from ..parameters import APART
from .checks import (
    STRAIGHT,
    EdgeShape,
    require_base_at_boot,
    require_edge,
    require_lengths,
    require_narrow_waist,
    require_on_ski,
    require_tables,
)
from .layout import BaseShape, Layout, SkiSections

_EDGE_POINTS = 401  # of the circle through the edge line, evenly spaced whatever the spacing of the tables


@dataclass(frozen=True, slots=True, weakref_slot=True, eq=False, repr=False)
class Ski(Shown):
    """A ski as tables from tip to tail, dense enough for linear interpolation. Everything in SI.

    Attributes
    ----------
    name
        Name of the ski.
    source
        Where its numbers come from, in words.
    station
        Distance from the boot, positive forward (m); falls from tip to tail in steps of 2.5 mm at most. Shape (n,).
    width
        From edge to edge (m). Shape (n,).
    base_height
        Height of the unloaded base along the base normal, 0 at the boot, positive away from the snow (m): camber makes
        it negative towards the contact points, the shovel rises. Shape (n,).
    bending_stiffness
        EI (N m²). Shape (n,).
    torsional_stiffness
        GJ (N m²). Shape (n,).
    mass_per_length
        (kg/m); its trapezoidal integral is the mass. Shape (n,).
    running_length
        Between the contact points of the base (m).
    sidecut_length
        Between the widest points in front and behind (m).
    base_bevel
        Angle by which the edge strip is ground up from the base (rad), 0 to 0.1.
    edge_width
        Width of the bevelled strip (m). Modelling assumption: 2 mm, a usual steel edge.
    side_edge
        Angle between base and side at the edge (rad).
    edge_radius
        Radius of the corner between base and side (m); the rounding is within the strip.
    sidecut_middle
        Station of the middle of running length and sidecut length (m): 0 where the boot is there.
    base
        Source of ``base_height``; None if the heights themselves are stated.
    keys
        Keys of the file that the ski was read from, in its units; None where the file has a table, or the ski was
        changed since.

    The tables are copied and made read-only.

    Raises
    ------
    ParameterError
        A table is not finite, not of the same length, not falling or not positive where it must be, the waist is wider
        than the tip or the tail, or the tables do not reach over the running and the sidecut length.

    See Also
    --------
    skisnow.read_ski
    skisnow.carve
    """

    name: str
    source: str
    station: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending_stiffness: FloatArray
    torsional_stiffness: FloatArray
    mass_per_length: FloatArray
    running_length: float
    sidecut_length: float
    base_bevel: float = 0.0
    edge_width: float = 0.002
    side_edge: float = math.pi / 2.0
    edge_radius: float = 0.0
    sidecut_middle: float = 0.0
    base: Annotated[BaseShape | None, APART] = None
    keys: Annotated[Mapping[str, Any] | None, APART] = None

    def __post_init__(self) -> None:
        for field in fields(SkiSections):
            table = np.array(getattr(self, field.name), dtype=float)
            table.flags.writeable = False
            object.__setattr__(self, field.name, table)
        tables = self._tables
        require_tables(self.name, tables)
        require_lengths(
            self.name, tables, running=self.running_length, sidecut=self.sidecut_length, middle=self.sidecut_middle
        )
        widths = self.sidecut_widths
        require_edge(self.name, self.edge_shape, waist=widths[1])
        require_narrow_waist(self.name, widths)
        require_base_at_boot(self.name, float(np.interp(0.0, self.station[::-1], self.base_height[::-1])))

    @property
    def edge_shape(self) -> EdgeShape:
        """Grinding of the edges."""
        return EdgeShape(self.base_bevel, self.edge_width, self.side_edge, self.edge_radius)

    @property
    def layout(self) -> Layout:
        """Positions of tip, tail, widest and contact points."""
        return Layout(
            tip=float(self.station[0]),
            tail=float(self.station[-1]),
            middle=self.sidecut_middle,
            running_length=self.running_length,
            sidecut_length=self.sidecut_length,
        )

    @property
    def _tables(self) -> SkiSections:
        return SkiSections(*(getattr(self, field.name) for field in fields(SkiSections)))

    def at(self, station: npt.ArrayLike) -> SkiSections:
        """Give the cross sections at stations (m, any shape), interpolated linearly.

        Raises ParameterError: a station is beyond tip or tail.
        """
        where = np.asarray(station, dtype=float)
        require_on_ski(self.name, self.station, where)
        return self._tables.at(where)

    def stiffened(self, factor: float) -> Ski:
        """The ski with EI and GJ times a factor > 0; itself with 1."""
        if factor == 1.0:
            return self
        return replace(
            self,
            bending_stiffness=self.bending_stiffness * factor,
            torsional_stiffness=self.torsional_stiffness * factor,
            keys=None,
        )

    def camber_rounded(self, length: float) -> Ski:
        """The ski with another rounding of its camber (m).

        Raises ParameterError: the ski has no camber, or its heights were given themselves.
        """
        if self.base is None or self.base.camber == 0.0:
            problem = (
                Message(
                    "the ski {name} has stated heights of its base, so that its camber is not rounded. Remove it",
                    name=self.name,
                )
                if self.base is None
                else Message("the ski {name} has no camber to round. Remove it", name=self.name)
            )
            raise ParameterError(problem).tag("no_camber")
        base = replace(self.base, camber_rounding=length)
        height = base.height_at(self.station, self.layout)
        return replace(
            self, keys=None, base=base, base_height=height - np.interp(0.0, self.station[::-1], height[::-1])
        )

    def _repr_facts(self) -> Facts:
        """Name, length, widths, the radius of the side line in use, mass."""
        widths = "-".join(f"{width * 1e3:.4g}" for width in self.sidecut_widths)
        radius = f"radius of the side line {self.sidecut_radius_of_edge_line:.4g} m"
        return Facts(f"{self.name!r}: {self.length:.4g} m, {widths} mm, {radius}, {self.mass:.4g} kg")

    def _notebook_facts(self) -> Facts:
        middle = int(np.argmin(np.abs(self.station)))
        rows = (
            ("length", amount(self.length, "m")),
            ("widths", f"{'-'.join(f'{width * 1e3:.4g}' for width in self.sidecut_widths)} mm"),
            ("radius of the side line", amount(self.sidecut_radius_of_edge_line, "m")),
            ("EI at the boot", amount(float(self.bending_stiffness[middle]), "N m²")),
            ("GJ at the boot", amount(float(self.torsional_stiffness[middle]), "N m²")),
            ("mass", amount(self.mass, "kg")),
        )
        return Facts(repr(self.name), rows)

    @property
    def length(self) -> float:
        """From tip to tail along the base (m)."""
        return float(self.station[0] - self.station[-1])

    @property
    def mass(self) -> float:
        """Mass of the ski alone (kg)."""
        return float(-np.trapezoid(self.mass_per_length, self.station))

    @property
    def torsional_inertia_per_length(self) -> FloatArray:
        """Moment of inertia about the ski's axis per length, m' w²/12 of a thin strip (kg m). Shape (n,)."""
        inertia: FloatArray = self.mass_per_length * self.width**2 / 12.0
        return inertia

    @property
    def sidecut_ends(self) -> tuple[float, float]:
        """Stations of the front and the rear end of the sidecut length (m)."""
        return self.sidecut_middle + self.sidecut_length / 2.0, self.sidecut_middle - self.sidecut_length / 2.0

    def tables_at(self, station: FloatArray, *tables: str) -> tuple[FloatArray, ...]:
        """Some tables, by name, at stations (m, any shape) between tip and tail, interpolated linearly."""
        rising = self.station[::-1]
        return tuple(np.interp(station, rising, getattr(self, table)[::-1]) for table in tables)

    @property
    def contact_points(self) -> tuple[float, float]:
        """Stations of the front and the rear contact point of the unloaded base, the ends of the running length (m)."""
        return self.sidecut_middle + self.running_length / 2.0, self.sidecut_middle - self.running_length / 2.0

    @property
    def sidecut_widths(self) -> tuple[float, float, float]:
        """Widths at the front end, the middle and the rear end of the sidecut length (m)."""
        front, rear = self.sidecut_ends
        places = [front, self.sidecut_middle, rear]
        at_front, at_middle, at_rear = np.interp(places, self.station[::-1], self.width[::-1]).tolist()
        return at_front, at_middle, at_rear

    @property
    def tip_width(self) -> float:
        """Greatest width in front of the middle of the sidecut length (m)."""
        return float(np.max(self.width[self.station >= self.sidecut_middle]))

    @property
    def waist_width(self) -> float:
        """Width at the middle of the sidecut length (m)."""
        return self.sidecut_widths[1]

    @property
    def tail_width(self) -> float:
        """Greatest width behind the middle of the sidecut length (m)."""
        return float(np.max(self.width[self.station <= self.sidecut_middle]))

    @property
    def sidecut_depth(self) -> float:
        """δ = (tip + tail - 2 waist)/4 of the widths at the ends and the middle of the sidecut length (m)."""
        front, middle, rear = self.sidecut_widths
        return (front + rear - 2.0 * middle) / 4.0

    @property
    def sidecut_radius_of_three_widths(self) -> float:
        """R_sc = L_sc²/(8 δ), the arc through three widths (m); infinite for a straight edge."""
        depth = self.sidecut_depth
        return self.sidecut_length**2 / (8.0 * depth) if depth > STRAIGHT else float("inf")

    @property
    def sidecut_radius_of_edge_line(self) -> float:
        """Radius of the least-squares circle through the edge over the sidecut length (m); infinite if straight."""
        front, rear = self.sidecut_ends
        along = np.linspace(front, rear, _EDGE_POINTS)
        return radius_of_least_squares_circle(along, self.at(along).width / 2.0)


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
