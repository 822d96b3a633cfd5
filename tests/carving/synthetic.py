"""Skis and snows that exact answers know, and what an equilibrium says of the boot."""

import math
from collections.abc import Callable

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.carving.result import Equilibrium
from skisnow.ski import Ski
from skisnow.snow.properties import SnowProperties
from tests.present import present

Along = Callable[[FloatArray], FloatArray]

RACE = (0.37, 1.18, 1.88, 1.16, 0.40)
"""EI over its mean at five stations of race skis, tail to tip."""


def snow(hardness: float, strength: float = 0.35) -> SnowProperties:
    """Snow of H_V (N/mm³) and S_f (N/mm²)."""
    return SnowProperties(hardness * 1e9, strength * 1e6, source="test")


def plain_ski(
    *,
    length: float = 1.6,
    width: float | Along = 0.065,
    base_height: Along | None = None,
    bending: float | Along = 300.0,
    torsional: float = 150.0,
    running_length: float | None = None,
) -> Ski:
    """A ski with the boot in its middle, straight and flat unless said otherwise; SI."""
    station = np.linspace(length / 2.0, -length / 2.0, 1 + 2 * math.ceil(length / 2.0 / 0.0025))
    same = np.ones_like(station)
    reach = length if running_length is None else running_length
    return Ski(
        name="plain",
        source="test",
        station=station,
        width=width * same if isinstance(width, float) else width(station),
        base_height=0.0 * same if base_height is None else base_height(station),
        bending_stiffness=bending * same if isinstance(bending, float) else bending(station),
        torsional_stiffness=torsional * same,
        mass_per_length=1.4 * same,
        running_length=reach,
        sidecut_length=reach,
    )


def rigid_ski(length: float = 1.6, width: float = 0.065) -> Ski:
    """Straight, flat, and so stiff that it bends by less than 1e-14 m under the loads of the tests."""
    return plain_ski(length=length, width=width, bending=1e16, torsional=1e16)


def circular_sidecut(radius: float, waist: float = 0.065) -> Along:
    """Width of a ski whose edges are circles."""
    return lambda s: waist + 2.0 * (radius - np.sqrt(radius**2 - s**2))


def race_profile(mean: float, length: float = 1.6) -> Along:
    """EI of a race ski, straight between five stations."""
    place = np.linspace(-length / 2.0, length / 2.0, 5)
    return lambda s: mean * np.interp(s, place, np.array(RACE))


def shovel(running_length: float, height: float, length: float) -> Along:
    """Base that rises quadratically outside the running length, to that height at the ends."""
    overhang = (length - running_length) / 2.0
    return lambda s: height * (np.maximum(np.abs(s) - running_length / 2.0, 0.0) / overhang) ** 2


def boot_pose(found: Equilibrium, ski: Ski, edge_angle: float) -> tuple[float, float]:
    """Depth b₀ (m) of the base's middle under the boot and its slope b₁ along the ski, from the returned arrays.

    At every station e = b₀ + b₁ s - cos ϑ (h + w) + (W/2) sin(ϑ + φ).
    """
    at = ski.at(found.station)
    middle = present(found.edge_depth) - at.width / 2.0 * np.sin(edge_angle + present(found.twist))
    straight = middle + math.cos(edge_angle) * (at.base_height + present(found.bending))
    slope, depth = np.polyfit(found.station, straight, 1)
    assert np.max(np.abs(straight - depth - slope * found.station)) < 1e-9  # else the arrays contradict each other
    return float(depth), float(slope)


def weights(ski: Ski, clamp_length: float, elements: int = 160) -> FloatArray:
    """Length of ski that each station stands for (m)."""
    from skisnow.ski.beam import clamped

    return clamped(ski, clamp_length, elements).stations.weight
