"""Failure shear stress of groomed snow from its density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.units import ICE_DENSITY
from ...snow.published.moessner_2013 import STRESS_BY_DENSITY, failure_shear_stress_from_density
from ..measured_ranges import GROOMED_SNOW_DENSITY
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class DensityShear(ShearLaw):
    """F_t = S_f e L with S_f = -0.047 + 0.00031 ρ N/mm², ρ in kg/m³ (Eqn 14).

    Attributes
    ----------
    snow_density
        ρ (kg/m³). Below 151.6 kg/m³ the stress would be negative: refused.

    See Also
    --------
    skisnow.forces.shear.NaturalDensityShear

    Notes
    -----
    Range: 420-740 kg/m³, groomed snow. Source: Mössner and others (2013); the rmse of 0.059 N/mm² is half of the value
    at 500 kg/m³, so this is a rough guess where S_f was not measured.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    500 kg/m³: -0.047 + 0.155 = 0.108 N/mm², on 100 mm of edge, 10 mm deep: 108 N.

    >>> round(float(DensityShear(snow_density=500.0).failure_force(0.010, 0.100, 0.0)), 9)
    108.0
    """

    snow_density: float

    def __post_init__(self) -> None:
        intercept, slope = STRESS_BY_DENSITY
        minimum = -intercept / slope
        if not minimum < self.snow_density <= ICE_DENSITY:
            raise ParameterError(
                "DensityShear: snow_density is {snow_density!r} kg/m³; Eqn 14 gives no strength at or below "
                "{minimum:.1f} kg/m³, and ice has {ice_density:g} kg/m³; the equation was measured for {lowest:g} to "
                "{highest:g} kg/m³",
                code="out_of_range",
                snow_density=self.snow_density,
                minimum=minimum,
                ice_density=ICE_DENSITY,
                lowest=GROOMED_SNOW_DENSITY.lowest,
                highest=GROOMED_SNOW_DENSITY.highest,
            )
        GROOMED_SNOW_DENSITY.warn_outside(self.snow_density, "DensityShear", stacklevel=3)

    @property
    def failure_shear_stress(self) -> float:
        """S_f (N/m²) of this density."""
        return float(failure_shear_stress_from_density(self.snow_density))

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return np.full(depth.shape, self.failure_shear_stress)
