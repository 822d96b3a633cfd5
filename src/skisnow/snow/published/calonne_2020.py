"""Calonne, Richter, Löwe and others (2020): density and specific surface area of snow from a micro-penetrometer.

The Cryosphere 14, 1829-1848, doi 10.5194/tc-14-1829-2020: regressions on an alpine snowpack through one winter (RHOSSA,
Weissfluhjoch), with windows of 1 mm and the fourth make of the instrument.

Notes
-----
Arguments are in N and m; L is in the equations in mm.

The snow was not groomed. The SSA becomes negative for L above about 1 mm.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.units import MM

SOURCE: Final = "Calonne and others 2020"
WINDOW: Final = 1.0 * MM
"""Length of a window (m)."""
DENSITY: Final = (295.8, 65.1, -43.2, 47.1)
"""Coefficients of ρ = 295.8 + 65.1 ln F - 43.2 L ln F + 47.1 L (kg/m³)."""


def specific_surface_area(median_force: FloatArray, element_size: FloatArray) -> FloatArray:
    """SSA = 0.57 - 18.56 ln L - 3.66 ln F in m²/kg; F median force (N), L element size (mm).

    >>> round(float(specific_surface_area(np.array(1.0), np.array(0.5e-3))), 2)
    13.43
    """
    area: FloatArray = 0.57 - 18.56 * np.log(element_size / MM) - 3.66 * np.log(median_force)
    return area
