"""Checks of the force laws: parameters that no snow can have, and the ranges in which laws were measured.

H_V and S_f were measured on ski slopes by Mössner and others (2013), and by Federolf and others (2006) as that paper
converts them. Both count: a snow that either of them met is inside.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import fields
from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..snow import MeasuredRange
from ..snow.published import domine_2011, federolf_2006, lieu_mote_1985, moessner_2013

RIGHT_ANGLE = math.pi / 2.0


class ParameterCheck(NamedTuple):
    """Condition on a parameter of a law, for its annotation; with the problem and code of its error."""

    holds: Callable[[float], bool]
    problem: str
    code: str = "out_of_range"


ABOVE_ZERO: Final = ParameterCheck(
    lambda value: value > 0, template("{kind}: {name} is {value!r}; it must be a finite number above 0")
)
NOT_BELOW_ZERO: Final = ParameterCheck(
    lambda value: value >= 0, template("{kind}: {name} is {value!r}; it must be a finite number, 0 or above")
)
FINITE: Final = ParameterCheck(
    lambda _: True, template("{kind}: {name} is {value!r}; it must be a finite number"), "not_a_number"
)


class CheckedParameters:
    """Base of the laws: checks each parameter against the marks of its annotation when a law is made.

    ``Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]`` rejects a number that is not above 0 and warns outside the range.
    """

    __slots__ = ()

    def __post_init__(self) -> None:
        """Reject impossible parameters, then compare the others with the measured ranges."""
        law: Any = type(self)
        kind, marks = law.__name__, _marks_of(law)
        for name, mark in marks:
            value = getattr(self, name)
            value = min(value, default=0.0) if isinstance(value, tuple) else value
            if isinstance(mark, ParameterCheck) and not (math.isfinite(value) and mark.holds(value)):
                raise ParameterError(mark.problem).tag(mark.code, kind=kind, name=name, value=value)
        self._check_further()
        for name, mark in marks:
            if isinstance(mark, MeasuredRange):
                mark.warn_outside(getattr(self, name), kind, stacklevel=3)

    def _check_further(self) -> None:
        """Further checks of a law; a warning needs ``stacklevel=4`` to name the line that made the law."""


@cache
def _marks_of(law: Any) -> tuple[tuple[str, object], ...]:
    """Name of a field and one mark of its annotation, for all fields that have marks."""
    marked = [field for field in fields(law) if str(field.type).startswith("Annotated[")]
    hints = [eval(str(field.type), dict(vars(sys.modules[law.__module__]))) for field in marked]
    return tuple((field.name, mark) for field, hint in zip(marked, hints, strict=True) for mark in hint.__metadata__)


def edge_angles(edge_angle: npt.ArrayLike) -> FloatArray:
    """The edge angles as an array, refused unless all are in 0 ≤ ϑ ≤ π/2 rad."""
    angle = np.asarray(edge_angle, float)
    # to one part in 10⁹: 90° through a unit conversion is a right angle
    wrong = ~((angle >= 0.0) & (angle <= RIGHT_ANGLE * (1.0 + 1e-9)))
    if np.any(wrong):
        first = float(angle[wrong].flat[0])
        raise ParameterError(
            "edge angle is {edge_angle!r} rad; it must be between 0 and π/2 rad (0° and 90°): an angle in degrees "
            "must be converted with math.radians"
        ).tag("out_of_range", edge_angle=first)
    return angle


_BOTH: Final = Message("{first}; {second}", first=moessner_2013.SOURCE, second=federolf_2006.SOURCE)
_FEDEROLF: Final = tuple(federolf_2006.named_snows().values())

SNOW_HARDNESS: Final = MeasuredRange(
    "snow hardness H_V",
    min(snow.snow_hardness for snow in _FEDEROLF),
    moessner_2013.SNOW_HARDNESS_RANGE_N_PER_MM3[1] * N_PER_MM3,
    "N/mm³",
    N_PER_MM3,
    _BOTH,
)
"""0.022 (spring snow of 2006) to 90 N/mm³ (late-summer glacier); 0.04 to 90 in 2013 alone."""

FAILURE_SHEAR_STRESS: Final = MeasuredRange(
    "failure shear stress S_f",
    moessner_2013.FAILURE_SHEAR_STRESS_RANGE_N_PER_MM2[0] * N_PER_MM2,
    max(snow.failure_shear_stress or 0.0 for snow in _FEDEROLF),
    "N/mm²",
    N_PER_MM2,
    _BOTH,
)
"""0.04 (fresh snow) to 0.52 N/mm² (race piste of 2006); 0.04 to 0.40 in 2013 alone."""

PENETRATION_EDGE_ANGLE: Final = MeasuredRange(
    "edge angle", *moessner_2013.PENETRATION_EDGE_ANGLE_RANGE, "°", DEGREE, moessner_2013.SOURCE
)

GROOMED_SNOW_DENSITY: Final = MeasuredRange(
    "snow density", *moessner_2013.SNOW_DENSITY_RANGE, "kg/m³", 1.0, moessner_2013.SOURCE
)

NATURAL_SNOW_DENSITY: Final = MeasuredRange(
    "snow density", *domine_2011.SNOW_DENSITY_RANGE, "kg/m³", 1.0, domine_2011.SOURCE
)

PRESSURE_SLOPE: Final = MeasuredRange(
    "A of p = A e + B",
    min(slope for slope, _ in federolf_2006.PRESSURE_LAWS.values()) * N_PER_MM3,
    max(slope for slope, _ in federolf_2006.PRESSURE_LAWS.values()) * N_PER_MM3,
    "N/mm³",
    N_PER_MM3,
    "Federolf and others 2006",
)

PRESSURE_OFFSET: Final = MeasuredRange(
    "B of p = A e + B",
    min(offset for _, offset in federolf_2006.PRESSURE_LAWS.values()) * N_PER_MM2,
    max(offset for _, offset in federolf_2006.PRESSURE_LAWS.values()) * N_PER_MM2,
    "N/mm²",
    N_PER_MM2,
    "Federolf and others 2006",
)

ICE_CUTTING_DEPTH: Final = MeasuredRange(
    "edge depth", *lieu_mote_1985.CUTTING_DEPTH_RANGE, "mm", MM, lieu_mote_1985.SOURCE
)

ICE_CUTTING_EDGE_ANGLE: Final = MeasuredRange(
    "edge angle", *lieu_mote_1985.EDGE_ANGLE_RANGE, "°", DEGREE, lieu_mote_1985.SOURCE
)

GLIDE_FRICTION: Final = MeasuredRange(
    "coefficient of friction", 0.023, 0.139, "", 1.0, "Wolfsperger and others 2021, over 200 runs on skis"
)

DRAG_AREA: Final = MeasuredRange("drag area", 0.23, 0.66, "m²", 1.0, "Supej and others 2022, tuck to upright")
