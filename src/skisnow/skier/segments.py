"""Lengths and masses of a body's segments, as shares of its height and mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from .anthropometry import body_of


@dataclass(frozen=True, slots=True)
class Segment:
    """One segment between two joints, of one side where there are two.

    length: over the height of the body.
    mass: over the mass of the body.
    centre: of its mass from the upper joint, for the trunk from the hips, over its length.

    Source: The page docs/methods/skier.md: Winter (2009), after Drillis and Contini (1966) and Dempster (1955).
    """

    length: float
    mass: float
    centre: float


FOOT: Final = Segment(0.039, 0.0145, 0.5)
"""Its length is the height of the ankle above the sole."""
SHANK: Final = Segment(0.246, 0.0465, 0.433)
THIGH: Final = Segment(0.245, 0.100, 0.433)
TRUNK: Final = Segment(0.288, 0.578, 0.66)
"""From the hips to the shoulders, with the mass of neck and head."""
UPPER_ARM: Final = Segment(0.186, 0.028, 0.436)
FOREARM: Final = Segment(0.146, 0.022, 0.682)
"""With the mass of the hand."""
SHOULDER_WIDTH: Final = 0.259
HIP_WIDTH: Final = 0.191
"""Share of the body's height; the hip joints are half as far apart (modelling assumption)."""


def height_of(mass: float, roll_inertia: float) -> float:
    """Height (m) of the body that has a mass (kg) and a roll inertia (kg m²), within 1 to 2.3 m.

    Source: The page docs/methods/skier.md: `body_of` the other way round.

    >>> round(height_of(75.0, body_of(75.0, 1.8).inertia[0]), 6)
    1.8
    """
    unit = body_of(75.0, 1.0).inertia[0] / 75.0
    return min(max((roll_inertia / (unit * mass)) ** 0.5, 1.0), 2.3)
