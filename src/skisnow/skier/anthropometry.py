"""A skier's body by mass and height, from the shares of its segments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from .._support.errors import ParameterError


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


POUND_INCH: Final = 0.112985
"""kg m² in 1 lb in s² (pounds of force)."""
POUND: Final = 0.45359237
INCH: Final = 0.0254

SUBJECTS: Final = (
    (173.5, 72.2, 32.2, (132.0, 119.0, 13.1), (41.4, 37.3, 29.9)),
    (147.3, 67.4, 29.8, (95.6, 81.9, 10.3), (32.9, 30.4, 21.5)),
    (203.0, 73.3, 31.8, (144.0, 129.0, 14.2), (48.9, 41.9, 36.7)),
)
"""Three men of Santschi, DuBois and Omoto (1963): weight (lb), height (in), centre of mass below the top of the head
(in) and moments of inertia (lb in s²), roll, pitch and yaw, standing; and those sitting with the thighs drawn up."""


@dataclass(frozen=True, slots=True)
class Body:
    """A body: mass (kg), height (m), centre of mass above the soles, standing (m), moments of inertia (kg m²).

    Attributes
    ----------
    mass, height
        As requested.
    standing_height
        Height of the centre of mass above the soles, upright.
    inertia
        Roll, pitch, yaw at the centre of mass, in the middle between standing and crouched.
    """

    mass: float
    height: float
    standing_height: float
    inertia: tuple[float, float, float]


def body_of(mass: float, height: float) -> Body:
    """Scale measured bodies to a mass (kg) and a height (m).

    Parameters
    ----------
    mass
        From 20 to 200 kg.
    height
        From 1 to 2.3 m.

    Raises
    ------
    ParameterError
        Outside these ranges.

    Notes
    -----
    Moments of inertia go with mass and the square of height; the mean of three men is taken, and the middle between
    standing and sitting with drawn-up thighs (modelling assumption: a skier in a turn is neither).

    References
    ----------
    The page docs/methods/skier.md: Santschi, DuBois and Omoto, *Moments of inertia and centers of gravity of the living
    human body*, AMRL-TDR-63-36, 1963.

    Examples
    --------
    >>> body = body_of(75.0, 1.76)
    >>> round(body.standing_height, 2), [round(each, 1) for each in body.inertia]
    (0.98, [8.4, 7.4, 2.1])
    """
    for name, value, low, high in (("mass", mass, 20.0, 200.0), ("height", height, 1.0, 2.3)):
        if not low <= value <= high:
            raise ParameterError("body_of: {name} is {value:g}; it must be from {low:g} to {high:g}").tag(
                "wrong_kind", name=name, value=value, low=low, high=high
            )
    shares = []
    for weight, tall, below, standing, crouched in SUBJECTS:
        unit = weight * POUND * (tall * INCH) ** 2
        middle = [0.5 * POUND_INCH * (one + other) / unit for one, other in zip(standing, crouched, strict=True)]
        shares.append((1.0 - below / tall, *middle))
    up, roll, pitch, yaw = (sum(each) / len(SUBJECTS) for each in zip(*shares, strict=True))
    scale = mass * height**2
    return Body(mass, height, up * height, (roll * scale, pitch * scale, yaw * scale))
