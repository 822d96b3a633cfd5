"""Ranges in which the force laws were measured, as `MeasuredRange` with their sources.

H_V and S_f were measured on ski slopes by Mössner and others (2013), and by Federolf and others (2006) as that paper
converts them. Both count: a snow that either of them met is inside.
"""

from __future__ import annotations

from typing import Final

from .._support.messages import Message
from .._support.units import DEGREE, MM, N_PER_MM2, N_PER_MM3
from ..snow import MeasuredRange
from ..snow.published import domine_2011, federolf_2006, lieu_mote_1985, moessner_2013

_BOTH: Final = Message("{first}; {second}", first=moessner_2013.SOURCE, second=federolf_2006.SOURCE)
_FEDEROLF: Final = tuple(federolf_2006.snows().values())

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
