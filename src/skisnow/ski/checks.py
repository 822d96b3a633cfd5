"""Conditions that every ski meets."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .layout import SkiSections

GREATEST_SPACING: Final = 2.5e-3
"""Greatest distance of neighbouring stations (m): linear interpolation of a sidecut is then good to 0.1 micrometre."""

_STRETCH: Final = 1.01  # of that distance, where stations move with a length that changes a little

STRAIGHT: Final = 1e-7
"""Depth of a curve (m) below which an edge counts as straight: far below what can be made or measured."""

GREATEST_BEVEL: Final = 0.1
"""Greatest base bevel (rad), 5.7°; skis are ground to 0-2°."""

LEAST_SIDE: Final = math.radians(80.0)
"""Smallest angle between base and side of a ski (rad); sides are ground to 85-90°."""
GREATEST_SIDE: Final = math.radians(95.0)

_ROUNDING = 1e-9  # m
_ZERO_AT_BOOT = 1e-5  # m, a hundredth of a millimetre
_POSITIVE = ("width", "bending_stiffness", "torsional_stiffness", "mass_per_length")


_CORRECT: Final = Message("Correct it")


def require_on_ski(name: str, stations: FloatArray, station: FloatArray) -> None:
    """Check that stations (m) are between tip and tail, the ends of the ski's own."""
    off = ~((station >= stations[-1] - _ROUNDING) & (station <= stations[0] + _ROUNDING))
    if np.any(off):
        problem = Message(
            "station {station:.6g} m is not on the ski: it reaches from {tip:.4f} to {tail:.4f} m from the boot",
            station=station[off].flat[0],
            tip=stations[0],
            tail=stations[-1],
        )
        _refuse(name, problem, Message("Choose stations on it"))


def require_tables(name: str, tables: SkiSections) -> None:
    """Check that a ski has a name, and tables that are equally long, finite, falling from tip to tail and above 0."""
    if not (isinstance(name, str) and name.strip()):  # type: ignore[redundant-expr] # callers without types
        _refuse(name, Message("its name is blank"), Message("Give it one"))
    for which in ("station", "base_height", *_POSITIVE):
        table: FloatArray = getattr(tables, which)
        if table.ndim != 1 or table.size < 2 or table.size != tables.station.size:
            problem = Message(
                "{table} has shape {shape}, station {needed}",
                table=which,
                shape=str(table.shape),
                needed=str(tables.station.shape),
            )
            _refuse(name, problem, Message("Give equally long tables"))
        if not np.isfinite(table).all():
            place = int(np.argmin(np.isfinite(table)))
            problem = Message(
                "{table}[{place}] is {value}; every value must be finite", table=which, place=place, value=table[place]
            )
            _refuse(name, problem, _CORRECT)
    _require_stations(name, tables.station)
    _require_positive(name, tables)


def _refuse(name: str, problem: Message, action: Message) -> None:
    raise ParameterError("ski {name!r}: {problem}. {action}.").tag(
        "invalid_ski", name=name, problem=problem, action=action
    )


def _require_stations(name: str, station: FloatArray) -> None:
    steps = station[:-1] - station[1:]
    if steps.min() <= 0:
        place = int(np.argmax(steps <= 0)) + 1
        problem = Message(
            "station[{place}] = {station:.6g} m is not below the one before it", place=place, station=station[place]
        )
        _refuse(name, problem, Message("List the stations from tip to tail, positive in front of the boot"))
    if steps.max() > _STRETCH * GREATEST_SPACING:
        problem = Message(
            "stations are up to {spacing:.3g} mm apart; at most 2.5 mm is allowed", spacing=steps.max() * 1e3
        )
        _refuse(name, problem, Message("Interpolate the tables first, as the reader of ski files does"))


def _require_positive(name: str, tables: SkiSections) -> None:
    for which in _POSITIVE:
        table: FloatArray = getattr(tables, which)
        if table.min() <= 0:
            place = int(np.argmax(table <= 0))
            problem = Message(
                "{table} is {value:.6g} at {station:.4f} m from the boot; it must be above 0",
                table=which,
                value=table[place],
                station=tables.station[place],
            )
            _refuse(name, problem, _CORRECT)


def require_lengths(name: str, tables: SkiSections, *, running: float, sidecut: float, middle: float) -> None:
    """Check that the tables reach over running length and sidecut length (m), and over the boot."""
    tip, tail = tables.station[0], tables.station[-1]
    for which, length in (("running_length", running), ("sidecut_length", sidecut)):
        if not (math.isfinite(length) and length > 0):
            problem = Message("{key} is {length!r} m; it must be a finite length above 0", key=which, length=length)
            _refuse(name, problem, _CORRECT)
        front, rear = middle + length / 2.0, middle - length / 2.0
        if not (front <= tip + _ROUNDING and rear >= tail - _ROUNDING):
            problem = Message(
                "its tables reach from {tip:.4f} to {tail:.4f} m from the boot and so are shorter than the {key}, from "
                "{front:.4f} to {rear:.4f} m",
                tip=tip,
                tail=tail,
                key=which,
                front=front,
                rear=rear,
            )
            _refuse(name, problem, Message("Continue the tables to tip and tail or correct {key}", key=which))
    require_on_ski(name, tables.station, np.zeros(1))


class EdgeShape(NamedTuple):
    """Grinding of an edge: strip of base (rad, m), angle between base and side (rad), radius of the corner (m)."""

    base_bevel: float
    edge_width: float
    side_edge: float
    edge_radius: float


def require_edge(name: str, edge: EdgeShape, *, waist: float) -> None:
    """Check how an edge is ground, its width against the waist (m)."""
    bevel, width, side, radius = edge
    if not 0.0 <= bevel <= GREATEST_BEVEL:
        problem = Message("base_bevel is {bevel!r} rad; it must be 0 to {limit}", bevel=bevel, limit=GREATEST_BEVEL)
        _refuse(name, problem, Message("Give it in radians"))
    if not 0.0 <= width < waist / 2.0:
        problem = Message(
            "edge_width is {width!r} m; it must be 0 to half the waist, {limit:.4f} m", width=width, limit=waist / 2.0
        )
        _refuse(name, problem, _CORRECT)
    if not LEAST_SIDE <= side <= GREATEST_SIDE:
        problem = Message(
            "side_edge is {side!r} rad; it must be {low:.4f} to {high:.4f}",
            side=side,
            low=LEAST_SIDE,
            high=GREATEST_SIDE,
        )
        _refuse(name, problem, Message("Give it in radians"))
    largest = width * math.tan(0.5 * (side + bevel))
    if not 0.0 <= radius <= largest:
        problem = Message(
            "edge_radius is {radius!r} m; it must be 0 to {largest:.6f} m, so that the rounding is within edge_width",
            radius=radius,
            largest=largest,
        )
        _refuse(name, problem, _CORRECT)


def require_narrow_waist(name: str, widths: tuple[float, float, float]) -> None:
    """Check that the waist is the smallest of the widths of tip, waist and tail (m)."""
    front, middle, rear = widths
    if middle > front + _ROUNDING:
        problem = Message(
            "its waist, {waist:.2f} mm, is wider than its tip, {width:.2f} mm", waist=middle * 1e3, width=front * 1e3
        )
        action = Message("The waist must be the narrowest of the three widths: correct waist or tip")
        _refuse(name, problem, action)
    if middle > rear + _ROUNDING:
        problem = Message(
            "its waist, {waist:.2f} mm, is wider than its tail, {width:.2f} mm", waist=middle * 1e3, width=rear * 1e3
        )
        action = Message("The waist must be the narrowest of the three widths: correct waist or tail")
        _refuse(name, problem, action)


def require_base_at_boot(name: str, base_height: float) -> None:
    """Check that heights of the base (m) count from the boot."""
    if abs(base_height) > _ZERO_AT_BOOT:
        problem = Message("base_height is {height:.6g} m at the boot; it must be 0 there", height=base_height)
        _refuse(name, problem, Message("Subtract that height"))
