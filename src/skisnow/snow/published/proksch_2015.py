"""Proksch, Löwe and Schneebeli (2015): density and specific surface area of snow from a micro-penetrometer.

J. Geophys. Res. Earth Surf. 120, 346-362, doi 10.1002/2014JF003266: regressions on micro-tomography of alpine, arctic
and antarctic snow, with windows of 2.5 mm.

Notes
-----
Arguments are in N and m; L is in the equations in mm.

The length l_c = 0.131 + 0.355 L + 0.0291 ln F (mm) gives the surface by SSA = 4 (1 - ρ/ρ_ice)/(ρ_ice l_c). None of the
snow was groomed.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.units import ICE_DENSITY, MM

SOURCE: Final = "Proksch and others 2015"
WINDOW: Final = 2.5 * MM
"""Length of a window (m)."""
DENSITY: Final = (420.47, 102.47, -121.15, -169.96)
"""Coefficients of ρ = 420.47 + 102.47 ln F - 121.15 L ln F - 169.96 L (kg/m³)."""


def density_of_form(
    coefficients: tuple[float, float, float, float], median_force: FloatArray, element_size: FloatArray
) -> FloatArray:
    """Density A + b ln F + c L ln F + d L (kg/m³) with coefficients A to d; F in N, L in mm in the formula.

    >>> float(density_of_form((1.0, 2.0, 4.0, 8.0), np.array(1.0), np.array(0.5e-3)))
    5.0
    """
    at_1_newton, by_force, by_both, by_size = coefficients
    log_force, size_mm = np.log(median_force), element_size / MM
    density: FloatArray = at_1_newton + by_force * log_force + by_both * size_mm * log_force + by_size * size_mm
    return density


def specific_surface_area(median_force: FloatArray, element_size: FloatArray) -> FloatArray:
    """SSA (m²/kg) from median force F (N) and element size L (m), with the density of this publication.

    >>> round(float(specific_surface_area(np.array(1.0), np.array(0.5e-3))), 2)
    8.97
    """
    length = (0.131 + 0.355 * element_size / MM + 0.0291 * np.log(median_force)) * MM
    solid_share = density_of_form(DENSITY, median_force, element_size) / ICE_DENSITY
    area: FloatArray = 4.0 * (1.0 - solid_share) / (ICE_DENSITY * length)
    return area
