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

from ..._support.units import MM

SOURCE: Final = "King and others 2020"
WINDOW: Final = 5.0 * MM
"""Length of a window (m)."""
DENSITY_A: Final = (315.61, 46.94, -43.94, -88.15)
"""Coefficients of ρ = 315.61 + 46.94 ln F - 43.94 L ln F - 88.15 L (kg/m³): fit a."""
DENSITY_B: Final = (312.54, 50.27, -50.26, -85.35)
"""The same of fit b."""
