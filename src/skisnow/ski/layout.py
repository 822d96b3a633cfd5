"""Positions of tip, tail, widest and contact points of a ski, the sections between them, and its base from the side."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Final, NamedTuple, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import ShownFields
from ..parameters import Allowed, Declared, Quantity

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
                "the ski is {tip:.6g} m long. Allowed: at most {longest:g} m. Correct the lengths or their units."
            ).tag("out_of_range", tip=self.tip - self.tail, longest=LONGEST)
        for name in ("running_length", "sidecut_length"):
            length = getattr(self, name)
            if not length > 0:
                raise ParameterError("{name} is {length!r} m; it must be above 0. Correct it.").tag(
                    "out_of_range", name=name, length=length
                )
            front, rear = self.middle + length / 2.0, self.middle - length / 2.0
            if front > self.tip + 1e-9 or rear < self.tail - 1e-9:
                raise ParameterError(
                    "the {name} of {length:.1f} mm reaches from {front:.1f} to {rear:.1f} mm from the boot, but the "
                    "ski only from {tip:.1f} to {tail:.1f} mm. Correct the lengths, the boot position or the tail "
                    "overhang."
                ).tag(
                    "contradiction",
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
    """Layout of a ski from its lengths (m).

    length: from tip to tail along the base.
    running_length, sidecut_length: between the contact points, between the widest points.
    tail_overhang: length of the tail behind the sidecut length; the rest of the length is the tip. Modelling
        assumption: 20 mm.
    boot_position: distance of the boot in front of the middle of the running length, negative behind it. Modelling
        assumption: 0.
    Raises ParameterError: the running or the sidecut length does not fit between tip and tail.

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


class EdgeShape(NamedTuple):
    """Grinding of an edge: strip of base (rad, m), angle between base and side (rad), radius of the corner (m)."""

    base_bevel: float
    edge_width: float
    side_edge: float
    edge_radius: float


GREATEST_SPACING: Final = 2.5e-3
"""Greatest distance of neighbouring stations (m): linear interpolation of a sidecut is then good to 0.1 micrometre."""
StationFunction: TypeAlias = Callable[[FloatArray], FloatArray]
"""Function from stations (m) to a quantity of the ski."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SkiSections(ShownFields):
    """Cross sections of a ski at chosen stations; every array has the shape of ``station``.

    station: from the boot, positive forward (m).
    width, base_height, bending_stiffness, torsional_stiffness, mass_per_length: as in `Ski`.
    """

    station: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending_stiffness: FloatArray
    torsional_stiffness: FloatArray
    mass_per_length: FloatArray


SHOVEL_HEIGHT: Final = 0.050
"""Height of the tip over the contact points (m). Modelling assumption: 50 mm, a usual alpine ski."""

LEAST_CONTACT: Final = 1e-3
"""Length of base that rockers must leave in contact (m)."""

CAMBER_ROUNDING: Final = 0.100
"""Length before a contact point over which the camber is rounded off (m). Modelling assumption without source: 100 mm,
and 50 to 200 mm in a band."""

TAIL_HEIGHT: Final = 0.008
"""Height of the tail over the contact points (m). Modelling assumption: 8 mm, a usual square tail."""


def _rocker_length(of: str, end: str) -> Quantity:
    """Quantity of the length of a rocker, of the tip or the tail, with its range (mm)."""
    meaning = f"by how much the {end} contact point is drawn in"
    return Quantity(f"{of}_rocker_length_mm", meaning, lowest=0, highest=1500, usual=(20, 800), origin="0")


def _rocker_height(of: str, end: str) -> Quantity:
    """Quantity of the height of a rocker, of the tip or the tail, with its range (mm)."""
    meaning = f"height of the base at the {end} end of the running length"
    return Quantity(f"{of}_rocker_height_mm", meaning, lowest=0, highest=200, usual=(0.5, 100), origin="0")


@dataclass(frozen=True, slots=True, kw_only=True)
class BaseShape(Declared):
    """Heights and lengths of the unloaded base (m); heights are over the line through the contact points.

    Modelling assumptions:

    - Camber is an arch of one curvature, so that the ends stay down when the middle is pressed flat; over the length
      ``camber_rounding`` before each contact point, at most a quarter of the length between them, it is rounded so that
      it meets it with slope 0.
    - The shovel rises quadratically from the front contact point to ``shovel_height`` at the tip, the tail likewise
      behind. The slope is continuous along the whole base.
    - Rocker draws a contact point in from the end of the running length, by ``…_rocker_length``; over that length the
      base rises quadratically to ``…_rocker_height``, and the shovel or tail continues from there without a kink.

    A missing height counts as 0 if the ski ends at the contact point.
    """

    camber: Annotated[
        float,
        Quantity("camber_mm", "height of the arch over the line through the contact points"),
        Allowed(-50, 50, usual=(0.5, 25), origin="0"),
    ] = 0.0
    camber_rounding: Annotated[
        float,
        Quantity("camber_rounding_mm", "length before each contact point over which the arch levels out"),
        Allowed(1, 1000, usual=(20, 300), origin="100 (modelling assumption, no source)"),
    ] = CAMBER_ROUNDING
    shovel_height: Annotated[
        float | None,
        Quantity("shovel_height_mm", "height of the tip over that line"),
        Allowed(0, 300, usual=(5, 150), origin="50 (modelling assumption)"),
    ] = None
    tail_height: Annotated[
        float | None,
        Quantity("tail_height_mm", "height of the tail over that line"),
        Allowed(0, 300, usual=(1, 150), origin="8 (modelling assumption)"),
    ] = None
    tip_rocker_length: Annotated[float, _rocker_length("tip", "front")] = 0.0
    tip_rocker_height: Annotated[float, _rocker_height("tip", "front")] = 0.0
    tail_rocker_length: Annotated[float, _rocker_length("tail", "rear")] = 0.0
    tail_rocker_height: Annotated[float, _rocker_height("tail", "rear")] = 0.0

    def height_at(self, station: FloatArray, layout: Layout) -> FloatArray:
        """Height (m) of the base at stations (m), 0 at the boot.

        Raises ParameterError: rockers overlap, or the shovel or tail would bend down after its rocker.

        >>> from .layout import layout_of_lengths
        >>> layout = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
        >>> contact, tip = BaseShape(camber=0.007).height_at(np.array([1.396 / 2, layout.tip]), layout)
        >>> round(float(contact) * 1e3, 6), round(float(tip) * 1e3, 6)  # mm
        (-7.0, 43.0)
        """
        return _height(self, np.asarray(station, float).tobytes(), layout).copy()

    def _height_over_contact_points(self, station: FloatArray, layout: Layout) -> FloatArray:
        """Height (m) over the line through the contact points; rejects rockers that leave too little of the base."""
        front, rear = layout.contact_points
        foremost, hindmost = front - self.tip_rocker_length, rear + self.tail_rocker_length
        if foremost - hindmost < LEAST_CONTACT:
            raise ParameterError(
                "the rockers, {tip_rocker_length:.1f} and {tail_rocker_length:.1f} mm long, leave less than "
                "{least_contact:g} mm of the running length of {running_length:.1f} mm. Shorten them."
            ).tag(
                "contradiction",
                tip_rocker_length=self.tip_rocker_length * 1e3,
                tail_rocker_length=self.tail_rocker_length * 1e3,
                least_contact=LEAST_CONTACT * 1e3,
                running_length=layout.running_length * 1e3,
            )
        shovel = _End("shovel", self.tip_rocker_length, self.tip_rocker_height, layout.tip - front, self.shovel_height)
        tail = _End("tail", self.tail_rocker_length, self.tail_rocker_height, rear - layout.tail, self.tail_height)
        half = (foremost - hindmost) / 2.0
        rounding = min(self.camber_rounding, half / 2.0)
        heights = self.camber * _arch(station - (foremost + hindmost) / 2.0, half, rounding)
        heights += shovel.rise(np.maximum(station - foremost, 0.0))
        heights += tail.rise(np.maximum(hindmost - station, 0.0))
        return heights


@functools.lru_cache(maxsize=32)
def _height(base: BaseShape, station: bytes, layout: Layout) -> FloatArray:
    """Height (m) of a base at stations, 0 at the boot; cached, because a design often keeps the base."""
    heights = base._height_over_contact_points(np.append(np.frombuffer(station), 0.0), layout)
    return heights[:-1] - heights[-1]


def _arch(place: FloatArray, half: float, rounding: float) -> FloatArray:
    """Height of a camber arch (1 in the middle, 0 at ±half) at places from its middle; the ends are rounded."""
    plain = half - rounding
    k = 2.0 / (plain * half)  # the whole drop k plain half / 2 is 1
    inside = np.minimum(np.abs(place), plain)
    beyond = np.clip(np.abs(place) - plain, 0.0, rounding)
    return np.asarray(1.0 - k * (inside**2 / 2.0 + plain * beyond * (1.0 - beyond / (2.0 * rounding))))


@dataclass(frozen=True, slots=True)
class _End:
    """Rise of the base outwards from a contact point: rocker, then shovel or tail (m)."""

    name: str
    rocker_length: float
    rocker_height: float
    length: float
    given_height: float | None

    def rise(self, distance: FloatArray) -> FloatArray:
        """Rise (m) at a distance (m) outwards from the inner end of the rocker; rejects a height without a length."""
        if self.rocker_height > 0 and not self.rocker_length > 0:
            raise ParameterError(
                "the rocker before the {name} has a height of {rocker_height:.1f} mm but no length. State its length "
                "or remove the height."
            ).tag("contradiction", name=self.name, rocker_height=self.rocker_height * 1e3)
        share = np.minimum(distance, self.rocker_length) / self.rocker_length if self.rocker_length > 0 else 0.0
        beyond = np.maximum(distance - self.rocker_length, 0.0)
        return np.asarray(self.rocker_height * share**2 + self._slope * beyond + self._outer_curvature() * beyond**2)

    @property
    def _slope(self) -> float:
        """Slope of the base at the rocker's outer end; 0 without a rocker."""
        return 2.0 * self.rocker_height / self.rocker_length if self.rocker_length > 0 else 0.0

    def _outer_curvature(self) -> float:
        """Coefficient c (1/m) of the rise c x² beyond the rocker that reaches the height of the tip or tail."""
        if self.length <= 1e-9:
            if self.given_height and abs(self.given_height - self.rocker_height) > 1e-9:
                raise ParameterError(
                    "the {name} height is {given_height:.1f} mm, but the running length ends where the ski does. "
                    "State the length of the {name} or remove its height."
                ).tag("contradiction", name=self.name, given_height=self.given_height * 1e3)
            return 0.0
        straight = self.rocker_height + self._slope * self.length
        default = SHOVEL_HEIGHT if self.name == "shovel" else TAIL_HEIGHT
        height = max(default, straight) if self.given_height is None else self.given_height
        if height < straight - 1e-9:
            raise ParameterError(
                "the {name} height is {height:.1f} mm, but straight on from its rocker the base is already "
                "{straight:.1f} mm high. Raise the {name} or flatten the rocker."
            ).tag("contradiction", name=self.name, height=height * 1e3, straight=straight * 1e3)
        return (height - straight) / self.length**2
