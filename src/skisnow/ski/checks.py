"""What a ski must be, whoever makes it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from ..errors import ParameterError

if TYPE_CHECKING:
    from .ski import FloatArray, Ski

GREATEST_SPACING: Final = 2.5e-3
"""Greatest distance of neighbouring stations (m): linear interpolation of a sidecut is then good to 0.1 micrometre."""

STRAIGHT: Final = 1e-7
"""Depth of a curve (m) below which an edge counts as straight: far below what can be made or measured."""

GREATEST_BEVEL: Final = 0.1
"""Greatest base bevel (rad), 5.7°; skis are ground to 0-2°."""

_ROUNDING = 1e-9  # m
_ZERO_AT_BOOT = 1e-5  # m, a hundredth of a millimetre
_POSITIVE = ("width", "bending_stiffness", "torsional_stiffness", "mass_per_length")


def require_sound(ski: Ski) -> None:
    """Check every rule that `Ski` states.

    Raises
    ------
    ParameterError
        The first rule broken.
    """
    if not (isinstance(ski.name, str) and ski.name.strip()):  # type: ignore[redundant-expr] # callers without types
        _refuse(ski, "its name is blank", "Give it one")
    _require_tables(ski)
    _require_stations(ski)
    _require_positive_tables(ski)
    _require_lengths(ski)
    _require_edge(ski)
    _require_waist(ski)
    at_boot = float(ski.at(0.0).base_height)
    if abs(at_boot) > _ZERO_AT_BOOT:
        _refuse(ski, f"base_height is {at_boot:.6g} m at the boot; it must be 0 there", "Subtract that height")


def require_on_ski(ski: Ski, station: FloatArray) -> None:
    """Check that stations (m) are between tip and tail.

    Raises
    ------
    ParameterError
        One is not, or is no number.
    """
    off = ~((station >= ski.station[-1] - _ROUNDING) & (station <= ski.station[0] + _ROUNDING))
    if np.any(off):
        reach = f"it reaches from {ski.station[0]:.4f} to {ski.station[-1]:.4f} m from the boot"
        _refuse(ski, f"station {station[off].flat[0]:.6g} m is not on the ski: {reach}", "Choose stations on it")


def _refuse(ski: Ski, what: str, action: str) -> None:
    raise ParameterError(f"ski {ski.name!r}: {what}. {action}.")


def _require_tables(ski: Ski) -> None:
    n = ski.station.size
    for name in ("station", "base_height", *_POSITIVE):
        table: FloatArray = getattr(ski, name)
        if table.ndim != 1 or table.size < 2 or table.size != n:
            _refuse(ski, f"{name} has shape {table.shape}, station {ski.station.shape}", "Give equally long tables")
        if not np.all(np.isfinite(table)):
            place = int(np.argmin(np.isfinite(table)))
            _refuse(ski, f"{name}[{place}] is {table[place]}; every value must be finite", "Correct it")


def _require_stations(ski: Ski) -> None:
    steps = -np.diff(ski.station)
    if np.any(steps <= 0):
        place = int(np.argmax(steps <= 0)) + 1
        what = f"station[{place}] = {ski.station[place]:.6g} m is not below the one before it"
        _refuse(ski, what, "List the stations from tip to tail, positive in front of the boot")
    if np.max(steps) > GREATEST_SPACING + _ROUNDING:
        what = f"stations are up to {np.max(steps) * 1e3:.3g} mm apart; at most 2.5 mm is allowed"
        _refuse(ski, what, "Interpolate the tables first, as the reader of ski files does")


def _require_positive_tables(ski: Ski) -> None:
    for name in _POSITIVE:
        table: FloatArray = getattr(ski, name)
        if np.any(table <= 0):
            place = int(np.argmax(table <= 0))
            what = f"{name} is {table[place]:.6g} at {ski.station[place]:.4f} m from the boot; it must be above 0"
            _refuse(ski, what, "Correct it")


def _require_lengths(ski: Ski) -> None:
    for name in ("running_length", "sidecut_length"):
        length = getattr(ski, name)
        if not (math.isfinite(length) and length > 0):
            _refuse(ski, f"{name} is {length!r} m; it must be a finite length above 0", "Correct it")
        front, rear = ski.sidecut_middle + length / 2.0, ski.sidecut_middle - length / 2.0
        if not (front <= ski.station[0] + _ROUNDING and rear >= ski.station[-1] - _ROUNDING):
            reach = f"its tables reach from {ski.station[0]:.4f} to {ski.station[-1]:.4f} m from the boot"
            what = f"{reach} and so are shorter than the {name}, from {front:.4f} to {rear:.4f} m"
            _refuse(ski, what, f"Continue the tables to tip and tail or correct {name}")
    require_on_ski(ski, np.zeros(1))


def _require_edge(ski: Ski) -> None:
    if not 0.0 <= ski.base_bevel <= GREATEST_BEVEL:
        _refuse(ski, f"base_bevel is {ski.base_bevel!r} rad; it must be 0 to {GREATEST_BEVEL}", "Give it in radians")
    if not 0.0 <= ski.edge_width < ski.waist_width / 2.0:
        what = f"edge_width is {ski.edge_width!r} m; it must be 0 to half the waist, {ski.waist_width / 2.0:.4f} m"
        _refuse(ski, what, "Correct it")


def _require_waist(ski: Ski) -> None:
    front, middle, rear = ski.sidecut_widths
    for part, end in (("tip", front), ("tail", rear)):
        if middle > end + _ROUNDING:
            what = f"its waist, {middle * 1e3:.2f} mm, is wider than its {part}, {end * 1e3:.2f} mm"
            _refuse(ski, what, f"The waist must be the narrowest of the three widths: correct waist or {part}")
