"""A ski: its shape, stiffness and mass, as dense tables along it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from typing import Annotated, Any, Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import Facts, Shown, amount
from ..parameters import APART
from .layout import GREATEST_SPACING, BaseShape, EdgeShape, Layout, SkiSections

_EDGE_POINTS = 401  # of the circle through the edge line, evenly spaced whatever the spacing of the tables

STRAIGHT: Final = 1e-7
"""Depth of a curve (m) below which an edge counts as straight: far below what can be made or measured."""
_STRETCH: Final = 1.01  # of that distance, where stations move with a length that changes a little

GREATEST_BEVEL: Final = 0.1
"""Greatest base bevel (rad), 5.7°; skis are ground to 0-2°."""

LEAST_SIDE: Final = math.radians(80.0)
"""Smallest angle between base and side of a ski (rad); sides are ground to 85-90°."""
GREATEST_SIDE: Final = math.radians(95.0)

_ROUNDING = 1e-9  # m
_ZERO_AT_BOOT = 1e-5  # m, a hundredth of a millimetre
_POSITIVE = ("width", "bending_stiffness", "torsional_stiffness", "mass_per_length")


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
        with _named_errors(self):
            _require_sound(self)

    @property
    def edge_shape(self) -> EdgeShape:
        """Bevel angles (rad), width and radius (m) of the ground edges."""
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

    def at(self, station: npt.ArrayLike) -> SkiSections:
        """Give the cross sections at stations (m, any shape), interpolated linearly.

        Raises ParameterError: a station is beyond tip or tail.
        """
        where = np.asarray(station, dtype=float)
        with _named_errors(self):
            _require_on_ski(self, where)
        names = [field.name for field in fields(SkiSections)][1:]
        return SkiSections(where, *map(np.asarray, self.tables_at(where, *names)))

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
        if self.base is None:
            raise ParameterError(
                "the ski {name} has stated heights of its base, so that its camber is not rounded. Remove it"
            ).tag("no_camber", name=self.name)
        if self.base.camber == 0.0:
            raise ParameterError("the ski {name} has no camber to round. Remove it").tag("no_camber", name=self.name)
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
        """Title with the name, and rows with length, widths, radius, stiffness and mass."""
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


@contextmanager
def _named_errors(ski: Ski) -> Iterator[None]:
    """Context that adds the name of the ski to each ParameterError raised inside."""
    try:
        yield
    except ParameterError as error:
        raise error.at(Message("ski {name!r}", name=ski.name)).tag("invalid_ski") from None


def _require_sound(ski: Ski) -> None:
    """Reject a ski whose name is blank, or whose tables, lengths, edges, widths or heights cannot be those of a ski."""
    _require_tables(ski)
    _require_on_ski(ski, np.array([ski.layout.middle, 0.0]))
    widths = ski.sidecut_widths
    _require_edge(ski.edge_shape, waist=widths[1])
    _require_narrow_waist(widths)
    height = float(np.interp(0.0, ski.station[::-1], ski.base_height[::-1]))
    if abs(height) > _ZERO_AT_BOOT:
        raise ParameterError(
            "base_height is {height:.6g} m at the boot; it must be 0 there. Subtract that height."
        ).tag("invalid_ski", height=height)


def _require_on_ski(ski: Ski, station: FloatArray) -> None:
    """Reject stations (m) beyond tip or tail."""
    off = ~((station >= ski.station[-1] - _ROUNDING) & (station <= ski.station[0] + _ROUNDING))
    if np.any(off):
        raise ParameterError(
            "station {station:.6g} m is not on the ski: it reaches from {tip:.4f} to {tail:.4f} m from the boot. "
            "Choose stations on it."
        ).tag("invalid_ski", station=station[off].flat[0], tip=ski.station[0], tail=ski.station[-1])


def _require_tables(ski: Ski) -> None:
    """Reject a blank name, and tables that are not equally long, finite, falling from tip to tail or above 0."""
    if not (isinstance(ski.name, str) and ski.name.strip()):  # type: ignore[redundant-expr] # callers without types
        raise ParameterError("its name is blank. Give it one.").tag("invalid_ski")
    for name in ("station", "base_height", *_POSITIVE):
        table: FloatArray = getattr(ski, name)
        if table.ndim != 1 or table.size < 2 or table.size != ski.station.size:
            raise ParameterError("{table} has shape {shape}, station {needed}. Give equally long tables.").tag(
                "invalid_ski", table=name, shape=str(table.shape), needed=str(ski.station.shape)
            )
        if not np.isfinite(table).all():
            row = int(np.argmin(np.isfinite(table)))
            raise ParameterError("{table}[{row}] is {value}; every value must be finite. Correct it.").tag(
                "invalid_ski", table=name, row=row, value=table[row]
            )
    steps = ski.station[:-1] - ski.station[1:]
    if steps.min() <= 0:
        row = int(np.argmax(steps <= 0)) + 1
        raise ParameterError(
            "station[{row}] = {station:.6g} m is not below the one before it. List the stations from tip to tail, "
            "positive in front of the boot."
        ).tag("invalid_ski", row=row, station=ski.station[row])
    if steps.max() > _STRETCH * GREATEST_SPACING:
        raise ParameterError(
            "stations are up to {spacing:.3g} mm apart; at most 2.5 mm is allowed. Interpolate the tables first, as "
            "the reader of ski files does."
        ).tag("invalid_ski", spacing=steps.max() * 1e3)
    for name in _POSITIVE:
        table = getattr(ski, name)
        if table.min() <= 0:
            row = int(np.argmax(table <= 0))
            raise ParameterError(
                "{table} is {value:.6g} at {station:.4f} m from the boot; it must be above 0. Correct it."
            ).tag("invalid_ski", table=name, value=table[row], station=ski.station[row])


def _require_edge(edge: EdgeShape, *, waist: float) -> None:
    """Reject an edge shape that cannot be ground on a ski with this waist (m)."""
    bevel, width, side, radius = edge
    if not 0.0 <= bevel <= GREATEST_BEVEL:
        raise ParameterError("base_bevel is {bevel!r} rad; it must be 0 to {limit}. Give it in radians.").tag(
            "invalid_ski", bevel=bevel, limit=GREATEST_BEVEL
        )
    if not 0.0 <= width < waist / 2.0:
        raise ParameterError(
            "edge_width is {width!r} m; it must be 0 to half the waist, {limit:.4f} m. Correct it."
        ).tag("invalid_ski", width=width, limit=waist / 2.0)
    if not LEAST_SIDE <= side <= GREATEST_SIDE:
        raise ParameterError("side_edge is {side!r} rad; it must be {low:.4f} to {high:.4f}. Give it in radians.").tag(
            "invalid_ski", side=side, low=LEAST_SIDE, high=GREATEST_SIDE
        )
    largest = width * math.tan(0.5 * (side + bevel))
    if not 0.0 <= radius <= largest:
        raise ParameterError(
            "edge_radius is {radius!r} m; it must be 0 to {largest:.6f} m, so that the rounding is within edge_width. "
            "Correct it."
        ).tag("invalid_ski", radius=radius, largest=largest)


def _require_narrow_waist(widths: tuple[float, float, float]) -> None:
    """Reject a waist that is wider than tip or tail (m)."""
    front, middle, rear = widths
    if middle > front + _ROUNDING:
        raise ParameterError(
            "its waist, {waist:.2f} mm, is wider than its tip, {width:.2f} mm. The waist must be the narrowest of the "
            "three widths: correct waist or tip."
        ).tag("invalid_ski", waist=middle * 1e3, width=front * 1e3)
    if middle > rear + _ROUNDING:
        raise ParameterError(
            "its waist, {waist:.2f} mm, is wider than its tail, {width:.2f} mm. The waist must be the narrowest of "
            "the three widths: correct waist or tail."
        ).tag("invalid_ski", waist=middle * 1e3, width=rear * 1e3)


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
    u, v = x / scale, y / scale
    points = np.column_stack([u**2 + v**2, u, v, np.ones_like(u)])
    constraint = np.array([[0.0, 0, 0, -2], [0, 1, 0, 0], [0, 0, 1, 0], [-2, 0, 0, 0]])
    residuals, circles = np.linalg.eig(np.linalg.solve(constraint, points.T @ points / len(u)))
    # the constraint has one negative direction, whose circle is imaginary: the answer is the one nearest to 0
    A, B, C, D = np.real(circles[:, np.argmin(np.abs(residuals))])
    curvature = float(2.0 * abs(A) / np.sqrt(B**2 + C**2 - 4.0 * A * D)) / scale
    return 1.0 / curvature if curvature * scale**2 / 2.0 > STRAIGHT else float("inf")
