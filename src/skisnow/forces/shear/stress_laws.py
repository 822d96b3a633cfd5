"""Failure shear stress that is constant, or depends on the edge angle or the density."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.units import ICE_DENSITY, N_PER_MM2
from ...snow.published import domine_2011, moessner_2013
from ...snow.published.domine_2011 import LEAST_DENSITY
from ...snow.published.moessner_2013 import STRESS_BY_ANGLE, STRESS_BY_DENSITY
from ..parameter_checks import (
    ABOVE_ZERO,
    FAILURE_SHEAR_STRESS,
    FINITE,
    GROOMED_SNOW_DENSITY,
    NATURAL_SNOW_DENSITY,
    RIGHT_ANGLE,
)
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class ConstantShear(ShearLaw):
    """F_t = S_f e L (Eqn 9).

    Attributes
    ----------
    failure_shear_stress
        S_f (N/m²).

    See Also
    --------
    skisnow.forces.shear.AngleShear
    skisnow.forces.shear.DensityShear

    Notes
    -----
    Range: 0.04-0.52 N/mm² on groomed ski slopes. Source: Mössner and others (2013), 108 experiments; the upper end is
    the race piste of Federolf and others (2006) as converted there. S_f is the stress at the start of shearing. The
    resistance during further sliding may be lower and was not measured.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.

    Examples
    --------
    0.2 N/mm² on 100 mm of edge, 6 mm deep: 120 N.

    >>> law = ConstantShear(failure_shear_stress=0.2e6)
    >>> round(float(law.failure_force(0.006, 0.100, 0.0)), 9)
    120.0
    """

    failure_shear_stress: Annotated[float, ABOVE_ZERO, FAILURE_SHEAR_STRESS]

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Shear stress S_f (N/m²) at each place, whatever depth and angle."""
        return np.full(depth.shape, self.failure_shear_stress)


@dataclass(frozen=True, slots=True)
class AngleShear(ShearLaw):
    """F_t = S_f0 (1 - k ϑ) e L, ϑ in rad (the form of Eqn 13).

    Attributes
    ----------
    flat_shear_stress
        S_f0 (N/m²), the stress extrapolated to ϑ = 0.
    relative_decrease
        k (1/rad), at most 2/π: the stress must not turn negative before the edge is upright.

    See Also
    --------
    skisnow.forces.shear.ConstantShear
    skisnow.forces.shear.MachiningShear

    Notes
    -----
    Range: one soft snow, S_f0 = 0.059 N/mm² and k = 0.266, n = 30, rmse 0.006 N/mm²: `AngleShear.soft_snow`. On the
    hard snow of the paper no dependence on ϑ was found (n = 20, p = 0.50). Source: Mössner and others (2013).
    At 90° the printed digits give 0.0343 N/mm²; with unrounded ones 0.0344 has been stated.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    Upright: 0.059 (1 - 0.266·1.5708) = 0.0343 N/mm², on 100 mm of edge, 10 mm deep: 34.3 N.

    >>> import math
    >>> round(float(AngleShear.soft_snow().failure_force(0.010, 0.100, math.pi / 2)), 1)
    34.3
    """

    flat_shear_stress: Annotated[float, ABOVE_ZERO, FAILURE_SHEAR_STRESS]
    relative_decrease: Annotated[float, FINITE]

    def _check_further(self) -> None:
        """Reject a relative_decrease that makes the stress negative at 90°."""
        if self.relative_decrease * RIGHT_ANGLE > 1.0:
            raise ParameterError(
                "AngleShear: with a relative_decrease of {relative_decrease!r} per rad the stress is negative on an "
                "upright edge; it must be at most 2/π = 0.637 per rad (Eqn 13: 0.266)"
            ).tag("out_of_range", relative_decrease=self.relative_decrease)

    @classmethod
    def soft_snow(cls) -> AngleShear:
        """Eqn 13 with its printed numbers, the soft snow on which it was found."""
        flat, decrease = STRESS_BY_ANGLE
        return cls(flat_shear_stress=flat * N_PER_MM2, relative_decrease=decrease)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Shear stress (N/m²), which falls linearly with the edge angle (rad); the depth has no effect."""
        return self.flat_shear_stress * (1.0 - self.relative_decrease * angle)


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

    snow_density: Annotated[float, GROOMED_SNOW_DENSITY]

    def _check_further(self) -> None:
        """Reject a density at which Eqn 14 gives no strength, or above that of ice."""
        intercept, slope = STRESS_BY_DENSITY
        minimum = -intercept / slope
        if not minimum < self.snow_density <= ICE_DENSITY:
            raise ParameterError(
                "DensityShear: snow_density is {snow_density!r} kg/m³; Eqn 14 gives no strength at or below "
                "{minimum:.1f} kg/m³, and ice has {ice_density:g} kg/m³; the equation was measured for {lowest:g} to "
                "{highest:g} kg/m³"
            ).tag(
                "out_of_range",
                snow_density=self.snow_density,
                minimum=minimum,
                ice_density=ICE_DENSITY,
                lowest=GROOMED_SNOW_DENSITY.lowest,
                highest=GROOMED_SNOW_DENSITY.highest,
            )

    @property
    def failure_shear_stress(self) -> float:
        """S_f (N/m²) of this density."""
        return float(moessner_2013.failure_shear_stress_from_density(self.snow_density))

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Shear stress S_f (N/m²) at each place, whatever depth and angle."""
        return np.full(depth.shape, self.failure_shear_stress)


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

    snow_density: Annotated[float, NATURAL_SNOW_DENSITY]

    def _check_further(self) -> None:
        """Reject a density at or below 112.3 kg/m³, where the square rises again, or above that of ice."""
        if not LEAST_DENSITY < self.snow_density <= ICE_DENSITY:
            raise ParameterError(
                "NaturalDensityShear: snow_density is {snow_density!r} kg/m³; the square (0.1027 ρ - 11.5323)² is 0 "
                "at {least_density:.1f} kg/m³ and rises again below it, and no snow is denser than {ice_density:g} "
                "kg/m³; give a density between them"
            ).tag("out_of_range", snow_density=self.snow_density, least_density=LEAST_DENSITY, ice_density=ICE_DENSITY)

    @property
    def failure_shear_stress(self) -> float:
        """S_f (N/m²) of this density."""
        return float(domine_2011.failure_shear_stress_from_density(self.snow_density))

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Shear stress S_f (N/m²) at each place, whatever depth and angle."""
        return np.full(depth.shape, self.failure_shear_stress)
