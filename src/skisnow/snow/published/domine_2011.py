"""Domine, Bock, Morin and Giraud (2011), J. Geophys. Res. 116, F04027: shear strength of natural snow from its density.

Notes
-----
Their snow was naturally packed, not groomed: at 500 kg/m³ the relation gives 1585 Pa, seventy times less than Eqn 14 of
Mössner and others (2013) for groomed slopes. That paper prints 0.0015 N/mm² for this value; the relation gives 0.0016.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.messages import Message

SOURCE: Final = Message("Domine and others 2011")
LEAST_DENSITY: Final = 11.5323 / 0.1027
"""Density (kg/m³) at which the square is 0, 112.3: below it the relation rises again, which no snow does."""
SNOW_DENSITY_RANGE: Final = (LEAST_DENSITY, 500.0)
"""ρ (kg/m³) for which it may stand: Mössner and others (2013) give 100-500 for such studies; it starts at its zero."""


def failure_shear_stress_from_density(snow_density: npt.ArrayLike) -> FloatArray:
    """S_f (Pa) = (0.1027 ρ - 11.5323)², ρ in kg/m³.

    >>> round(float(failure_shear_stress_from_density(500.0)))
    1585
    """
    root = 0.1027 * np.asarray(snow_density, float) - 11.5323
    result: FloatArray = root**2
    return result
