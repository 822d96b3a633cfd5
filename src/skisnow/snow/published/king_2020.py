"""King, Howell, Brady and others (2020): density of snow on Arctic sea ice from a micro-penetrometer.

The Cryosphere 14, 4323-4339, doi 10.5194/tc-14-4323-2020: the form of Proksch and others (2015) fitted to 186 samples
of a density cutter in wind-packed snow and depth hoar, with windows of 5 mm.

Notes
-----
Arguments are in N and m; L is in the equations in mm.

Fit a is over all samples, fit b without the 5 % with the largest residuals. No fit exists for the surface area. None of
the snow was groomed.
"""

from __future__ import annotations

from typing import Final

from ..._support.arrays import FloatArray
from ..._support.units import MM
from .proksch_2015 import density_of_form

SOURCE: Final = "King and others 2020"
WINDOW: Final = 5.0 * MM
"""Length of a window (m)."""


def snow_density_a(median_force: FloatArray, element_size: FloatArray) -> FloatArray:
    """ρ = 315.61 + 46.94 ln F - 43.94 L ln F - 88.15 L in kg/m³; F median force (N), L element size (mm).

    >>> import numpy as np
    >>> round(float(snow_density_a(np.array(1.0), np.array(0.5e-3))), 3)
    271.535
    """
    return density_of_form((315.61, 46.94, -43.94, -88.15), median_force, element_size)


def snow_density_b(median_force: FloatArray, element_size: FloatArray) -> FloatArray:
    """ρ = 312.54 + 50.27 ln F - 50.26 L ln F - 85.35 L in kg/m³; F median force (N), L element size (mm).

    >>> import numpy as np
    >>> round(float(snow_density_b(np.array(1.0), np.array(0.5e-3))), 3)
    269.865
    """
    return density_of_form((312.54, 50.27, -50.26, -85.35), median_force, element_size)
