"""Failure shear stress of natural snow from its density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.units import ICE_DENSITY
from ...snow.published.domine_2011 import LEAST_DENSITY, failure_shear_stress_from_density
from ..measured_ranges import NATURAL_SNOW_DENSITY
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class NaturalDensityShear(ShearLaw):
    """F_t = S_f e L with S_f = (0.1027 ρ - 11.5323)² Pa, ρ in kg/m³.

    Attributes
    ----------
    snow_density
        ρ (kg/m³). Refused at and below 112.3 kg/m³, where the square is 0 and below which it rises again: lighter snow
        is not stronger.

    See Also
    --------
    skisnow.forces.shear.DensityShear

    Notes
    -----
    Range: naturally packed snow, to 500 kg/m³. Source: Domine and others (2011), as Mössner and others (2013) quote it.
    Not for groomed slopes: at 500 kg/m³ it gives 1585 Pa, seventy times less than Eqn 14.

    References
    ----------
    * Domine, Bock, Morin and Giraud (2011), "Linking the effective thermal conductivity of snow to its shear strength
      and density", J. Geophys. Res. 116, F04027, doi 10.1029/2011JF002000.
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    500 kg/m³: (51.35 - 11.5323)² = 1585.4 Pa, on 1 m of edge, 10 mm deep: 15.85 N.

    >>> round(float(NaturalDensityShear(snow_density=500.0).failure_force(0.010, 1.0, 0.0)), 2)
    15.85
    """

    snow_density: float

    def __post_init__(self) -> None:
        if not LEAST_DENSITY < self.snow_density <= ICE_DENSITY:
            raise ParameterError(
                "NaturalDensityShear: snow_density is {snow_density!r} kg/m³; the square (0.1027 ρ - 11.5323)² is 0 "
                "at {least_density:.1f} kg/m³ and rises again below it, and no snow is denser than {ice_density:g} "
                "kg/m³; give a density between them",
                code="out_of_range",
                snow_density=self.snow_density,
                least_density=LEAST_DENSITY,
                ice_density=ICE_DENSITY,
            )
        NATURAL_SNOW_DENSITY.warn_outside(self.snow_density, "NaturalDensityShear", stacklevel=3)

    @property
    def failure_shear_stress(self) -> float:
        """S_f (N/m²) of this density."""
        return float(failure_shear_stress_from_density(self.snow_density))

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return np.full(depth.shape, self.failure_shear_stress)
