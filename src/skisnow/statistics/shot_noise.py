"""Poisson shot noise: a force as a sum of saw teeth at random places, and the properties of the teeth.

Notes
-----
A tooth rises over the deflection δ from 0 to the force f₀ at which an element ruptures, and λ teeth begin on a metre.
Then the mean of the force is λ f₀ δ/2, its variance λ f₀² δ/3, and its covariance falls at distance 0 with the slope
-3/(2 δ) of its value there. Löwe and van Herwijnen (2012) take all three from the force as it is; Proksch and others
(2015) take a straight line off each window before the covariance, so that a layer which grows harder does not lengthen
δ. The latter is done here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._support.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class ShotNoise:
    """Parameters of each window; NaN where its force does not vary or its mean is not above 0.

    rupture_force: f₀ in N.
    deflection: δ at rupture in m.
    intensity: λ, ruptures on a metre.
    """

    rupture_force: FloatArray
    deflection: FloatArray
    intensity: FloatArray


def shot_noise(force: FloatArray, sample_distance: float) -> ShotNoise:
    """δ = -(3/2) C(0)/C'(0), f₀ = (3/2) κ₂/κ₁, λ = (4/3) κ₁²/(κ₂ δ); κ₁ and κ₂ are mean and variance.

    force: (..., n) N, a window in each row of n samples, n ≥ 3.
    sample_distance: from sample to sample (m), above 0. C'(0) is the difference of the covariance over it.

    * Löwe and van Herwijnen (2012), "A Poisson shot noise model for micro-penetration of snow", Cold Reg. Sci. Technol.
      70, 62-70, doi 10.1016/j.coldregions.2011.09.001.
    * Proksch, Löwe and Schneebeli (2015), "Density, specific surface area, and correlation length of snow measured by
      high-resolution penetrometry", J. Geophys. Res. Earth Surf. 120, 346-362, doi 10.1002/2014JF003266.

    Mean 2, variance 1; about their straight line (slope -0.4) the squares sum to 3.2, neighbours' products to -2.4.

    >>> found = shot_noise(np.array([3.0, 1.0, 3.0, 1.0]), 1e-3)
    >>> round(float(found.rupture_force), 6), round(float(found.deflection) * 1e3, 6)
    (0.75, 0.857143)
    """
    mean, variance = force.mean(axis=-1), force.var(axis=-1)
    # residuals of each window from its least-squares line
    place = np.arange(force.shape[-1]) - 0.5 * (force.shape[-1] - 1)
    level = force - mean[..., None]
    residual = level - (level @ place / np.sum(place**2))[..., None] * place
    at_zero = np.sum(residual**2, axis=-1)
    next_to_it = np.sum(residual[..., 1:] * residual[..., :-1], axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        deflection = 1.5 * at_zero / (at_zero - next_to_it) * sample_distance
        rupture_force = 1.5 * variance / mean
        intensity = 4.0 / 3.0 * mean**2 / (variance * deflection)
    determined = (mean > 0.0) & np.isfinite(rupture_force) & np.isfinite(deflection) & np.isfinite(intensity)
    return ShotNoise(*(np.where(determined, parts, np.nan) for parts in (rupture_force, deflection, intensity)))


def windows_of(force: FloatArray, size: int, step: int) -> FloatArray:
    """The whole windows of ``size`` samples that begin ``step`` samples apart: (k, size), k = 0 where none is whole."""
    if len(force) < size:
        return np.zeros((0, size))
    return np.lib.stride_tricks.sliding_window_view(force, size)[::step]
