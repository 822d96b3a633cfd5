"""Positions of tip, tail, widest points and contact points of a ski, and the sections between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.display import ShownFields
from .._support.errors import ParameterError

LONGEST: Final = 6.0
"""Length (m) from tip to tail beyond which no ski is tabulated: the reach of the stations that a ski file may name."""
TAIL_OVERHANG: Final = 0.020
"""Length of ski behind the rear end of the sidecut length (m). Modelling assumption: 20 mm, a short square tail."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Stations and lengths of a ski (m). Stations count from the boot, positive forward.

    Modelling assumption: the running length is centred in the sidecut length, ``middle`` is the station of both
    middles.
    """

    tip: float
    tail: float
    middle: float
    running_length: float
    sidecut_length: float

    def __post_init__(self) -> None:
        if self.tip - self.tail > LONGEST:
            raise ParameterError(
                "the ski is {tip:.6g} m long. Allowed: at most {longest:g} m. Correct the lengths or their units.",
                code="out_of_range",
                tip=self.tip - self.tail,
                longest=LONGEST,
            )
        for name in ("running_length", "sidecut_length"):
            length = getattr(self, name)
            if not length > 0:
                raise ParameterError(
                    "{name} is {length!r} m; it must be above 0. Correct it.",
                    code="out_of_range",
                    name=name,
                    length=length,
                )
            front, rear = self.middle + length / 2.0, self.middle - length / 2.0
            if front > self.tip + 1e-9 or rear < self.tail - 1e-9:
                raise ParameterError(
                    "the {name} of {length:.1f} mm reaches from {front:.1f} to {rear:.1f} mm from the boot, but the "
                    "ski only from {tip:.1f} to {tail:.1f} mm. Correct the lengths, the boot position or the tail "
                    "overhang.",
                    code="contradiction",
                    name=name,
                    length=length * 1e3,
                    front=front * 1e3,
                    rear=rear * 1e3,
                    tip=self.tip * 1e3,
                    tail=self.tail * 1e3,
                )

    @property
    def widest_points(self) -> tuple[float, float]:
        """Stations of the front and the rear end of the sidecut length (m)."""
        return self.middle + self.sidecut_length / 2.0, self.middle - self.sidecut_length / 2.0

    @property
    def contact_points(self) -> tuple[float, float]:
        """Stations of the front and the rear end of the running length (m)."""
        return self.middle + self.running_length / 2.0, self.middle - self.running_length / 2.0


def layout_of_lengths(
    *,
    length: float,
    running_length: float,
    sidecut_length: float,
    tail_overhang: float = TAIL_OVERHANG,
    boot_position: float = 0.0,
) -> Layout:
    """Lay a ski out by its lengths (m).

    Parameters
    ----------
    length
        From tip to tail along the base.
    running_length, sidecut_length
        Between the contact points, between the widest points.
    tail_overhang
        Length of the tail behind the sidecut length; the rest of the length is the tip. Modelling assumption: 20 mm.
    boot_position
        Distance of the boot in front of the middle of the running length, negative behind it. Modelling assumption: 0.

    Raises
    ------
    ParameterError
        The running or the sidecut length does not fit between tip and tail.

    Examples
    --------
    >>> ski = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
    >>> round(ski.tip - ski.widest_points[0], 6), round(ski.widest_points[1] - ski.tail, 6)
    (0.115, 0.02)
    """
    tail = -boot_position - sidecut_length / 2.0 - tail_overhang
    return Layout(
        tip=tail + length,
        tail=tail,
        middle=-boot_position,
        running_length=running_length,
        sidecut_length=sidecut_length,
    )


StationFunction: TypeAlias = Callable[[FloatArray], FloatArray]
"""Function from stations (m) to a quantity of the ski."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SkiSections(ShownFields):
    """Cross sections of a ski at chosen stations; every array has the shape of ``station``.

    Attributes
    ----------
    station
        From the boot, positive forward (m).
    width, base_height, bending_stiffness, torsional_stiffness, mass_per_length
        As in `Ski`.
    """

    station: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending_stiffness: FloatArray
    torsional_stiffness: FloatArray
    mass_per_length: FloatArray

    def at(self, station: FloatArray) -> SkiSections:
        """Sections at other stations (m, any shape) between these, which fall, interpolated linearly."""
        rising = self.station[::-1]

        def along(table: FloatArray) -> FloatArray:
            return np.asarray(np.interp(station, rising, table[::-1]))

        return SkiSections(
            station,
            along(self.width),
            along(self.base_height),
            along(self.bending_stiffness),
            along(self.torsional_stiffness),
            along(self.mass_per_length),
        )
