"""Values printed in Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), J. Glaciol.

*Measurement of mechanical properties of snow for simulation of skiing*: 236 penetration and 108 shear experiments on
compacted snow of groomed slopes in the European Alps, with a 200 × 62 mm ski tool and a blade. No raw data are public.
Numbers here are the printed ones, in the printed units.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from ..properties import SnowProperties

SOURCE: Final = Message("Mössner and others 2013")

SNOW_HARDNESS_RANGE_N_PER_MM3: Final = (0.04, 90.0)
"""H_V, from fresh snow on ski slopes to late-summer glacier slopes."""
FAILURE_SHEAR_STRESS_RANGE_N_PER_MM2: Final = (0.04, 0.40)
"""S_f, from fresh snow on ski slopes to slopes prepared for World Cup races."""
SNOW_DENSITY_RANGE: Final = (420.0, 740.0)
"""ρ of the shear tests in kg/m³; that of the penetration tests ends at 620."""
PENETRATION_EDGE_ANGLE_RANGE: Final = (0.0, 60.0 * DEGREE)
"""ϑ of the penetration tests (rad)."""
NAMED_SNOWS: Final = {
    "fresh-snow": ("fresh snow on ski slopes", 0.04, 0.04),
    "glacier": ("late-summer glacier", 90.0, 0.30),
}
"""H_V (N/mm³) and S_f (N/mm²) that the paper prints for a named snow, by the name of `skisnow.snow.from_results`."""
TOOL_LENGTH_MM: Final = 200.0
TOOL_WIDTH_MM: Final = 62.0

PRINTED_RMSE_N: Final = {
    "H_e:a=linear,b=linear": 140.0,
    "H_A:a=linear,b=linear": 58.4,
    "H_V:a=linear,b=linear": 53.6,
    "H_e:a=constant,b=constant": 207.0,
    "H_A:a=constant,b=constant": 75.2,
    "H_V:a=constant,b=constant": 54.8,
    "H_V:a=none,b=linear": 53.8,
    "H_V:a=none,b=constant": 54.9,
    "H_V:a=none,b=one": 56.1,
}
"""The nine printed rmse by model; the last two H_V rows are Eqn 11 and Eqn 12's neighbours in the text."""

ANGLE_TERM: Final = (0.99, 0.14)
"""b₀ and b₁ (1/rad) of Eqn 11, F_n = (0.99 + 0.14 ϑ) H_V V."""

STRESS_BY_ANGLE: Final = (0.059, 0.266)
"""S_f at ϑ → 0 (N/mm²) and its relative decrease with ϑ (1/rad) in Eqn 13."""

STRESS_BY_DENSITY: Final = (-0.047, 0.00031)
"""Intercept (N/mm²) and slope (N/mm² per kg/m³) of Eqn 14."""


def failure_shear_stress_from_angle(edge_angle: npt.ArrayLike) -> FloatArray:
    """S_f (N/m²) of the soft snow by Eqn 13: 0.059 (1 - 0.266 ϑ) N/mm², ϑ in rad; rmse 0.006, n = 30.

    Range: one soft snow; positive below 3.76 rad, so over all edge angles.

    >>> import math
    >>> round(float(failure_shear_stress_from_angle(math.pi / 2)) / 1e6, 4)
    0.0343
    """
    flat, decrease = STRESS_BY_ANGLE
    result: FloatArray = flat * N_PER_MM2 * (1.0 - decrease * np.asarray(edge_angle, float))
    return result


def failure_shear_stress_from_density(snow_density: npt.ArrayLike) -> FloatArray:
    """S_f (N/m²) by Eqn 14: -0.047 + 0.00031 ρ N/mm², ρ in kg/m³; rmse 0.059. Measured for 420-740 kg/m³.

    >>> round(float(failure_shear_stress_from_density(500.0)) / 1e6, 3)
    0.108
    """
    intercept, slope = STRESS_BY_DENSITY
    result: FloatArray = N_PER_MM2 * (intercept + slope * np.asarray(snow_density, float))
    return result


def named_snows() -> dict[str, SnowProperties]:
    """Fresh snow and the late-summer glacier, by the names of `skisnow.snow.from_results`.

    The paper names these snows as the ends of its ranges of H_V and of S_f, one after the other. That the two numbers
    of one name belong to one snow is our reading (assumption): the paper found no relation between H_V and S_f.
    """
    return {
        name: SnowProperties(
            H_V * N_PER_MM3, S_f * N_PER_MM2, f"{SOURCE}: {words}, ends of the printed ranges, paired by us"
        )
        for name, (words, H_V, S_f) in NAMED_SNOWS.items()
    }
