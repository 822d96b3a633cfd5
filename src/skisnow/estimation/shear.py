"""Failure shear stress (Eqns 7-9) and shear displacement of each shear experiment, with intervals.

The shear displacement u_y is the displacement of the plate at which the shear stress of the snow reaches S_f. As in the
simulations (`skisnow.forces.shear`), the force grows in proportion to the displacement up to S_f e L, which it reaches
at u_y. At a plate on the lever arm r the displacement is r φ, so the moment is M_f (φ - φ₀)/φ_y up to the largest
moment M_f, and u_y = r φ_y. φ over M is a straight line over the rising part. Its intercept φ₀ takes slack and the zero
of the angle; its slope times M_f r is u_y. A pole that twists by M/k between gauge and plate takes 1/k of the slope.
u_y is our modelling assumption: the paper records only the largest moment.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.units import CONFIDENCE
from ..statistics.combined_uncertainty import expanded_factor

if TYPE_CHECKING:
    from .._support.arrays import BoolArray, FloatArray, IntArray
    from ..campaign.records import Campaign, ShearTests, TurningReadings

RISING: Final = (0.1, 0.9)
"""Shares of the largest moment between which a reading is of the rising part (modelling assumption): below, the plate
still comes to lie on the snow; above, parts of the snow have failed."""
_FITTED: Final = 2
"""Slope and intercept."""


@dataclass(frozen=True, slots=True, repr=False)
class ShearStress(ShownFields):
    """Failure shear force F_t (N) and stress S_f (N/m²) of each test, its 95 % interval (n, 2); NaN where undefined."""

    force: FloatArray
    value: FloatArray
    interval: FloatArray


def failure_shear_force(moment: npt.ArrayLike, lever_arm: npt.ArrayLike) -> FloatArray:
    """F_t = M / r (Eqn 7), N; moment in N m, lever arm to the middle of the plate in m.

    >>> float(failure_shear_force(30.0, 0.25))
    120.0
    """
    return np.asarray(moment, float) / np.asarray(lever_arm, float)


def failure_shear_stress(
    shear_force: npt.ArrayLike, plate_length: npt.ArrayLike, penetration_depth: npt.ArrayLike
) -> FloatArray:
    """S_f = F_t / (L e) (Eqn 9), N/m²; NaN at depth 0, where no snow is sheared.

    120 N on 100 mm of plate, 6 mm deep: 120/600 = 0.2 N/mm².

    >>> round(float(failure_shear_stress(120.0, 0.1, 0.006)) / 1e6, 12)
    0.2
    """
    section = np.asarray(plate_length, float) * np.asarray(penetration_depth, float)
    force = np.broadcast_to(np.asarray(shear_force, float), np.broadcast_shapes(np.shape(shear_force), section.shape))
    return np.divide(force, section, out=np.full(force.shape, np.nan), where=section > 0)


def shear_stress(campaign: Campaign, tests: ShearTests) -> ShearStress:
    """F_t and S_f of every test; u²(ln S_f) = (u_M/M)² + (u_r/r)² + (u_e/e)².

    A single reading has no scatter: its interval is that of the instruments, without the variation of the snow. It is
    NaN if the campaign states no uncertainty. At M = 0 the stress is 0 and the interval one-sided.
    """
    length = np.array([campaign.plates[name] for name in tests.plate])
    force = failure_shear_force(tests.moment, tests.lever_arm)
    value = failure_shear_stress(force, length, tests.penetration_depth)
    stated = (campaign.moment_uncertainty, campaign.lever_arm_uncertainty, campaign.depth_uncertainty)
    if not any(stated):
        return ShearStress(force, value, np.full((len(tests), 2), np.nan))
    u_M, u_r, u_e = (u or 0.0 for u in stated)
    k = float(expanded_factor(np.inf, CONFIDENCE))
    with np.errstate(invalid="ignore", divide="ignore"):
        relative2 = (u_r / tests.lever_arm) ** 2 + (u_e / tests.penetration_depth) ** 2
        half = k * np.sqrt((u_M / tests.moment) ** 2 + relative2)
        interval = value[:, None] * np.exp(np.stack((-half, half), axis=-1))
        highest = failure_shear_stress(
            failure_shear_force(k * u_M, tests.lever_arm), length, tests.penetration_depth
        ) * np.exp(k * np.sqrt(relative2))
    at_zero = np.stack((np.zeros_like(value), highest), axis=-1)
    return ShearStress(force, value, np.where((tests.moment > 0)[:, None], interval, at_zero))


@dataclass(frozen=True, slots=True, repr=False)
class ShearDisplacement(ShownFields):
    """u_y of m shear tests; NaN where a test has no rising part.

    Attributes
    ----------
    n_readings
        Readings of the rising part, one number per test.
    value, interval
        u_y (m), and its 95 % interval (m, 2) from the scatter about the line and the stated uncertainties of moment and
        lever arm: NaN with fewer than three readings.
    """

    n_readings: IntArray
    value: FloatArray
    interval: FloatArray


def shear_displacement(campaign: Campaign, tests: ShearTests) -> ShearDisplacement:
    """Fit the rising part of every test."""
    m, turning = len(tests), tests.turning
    if turning is None:
        return ShearDisplacement(np.zeros(m, dtype=np.int64), np.full(m, np.nan), np.full((m, 2), np.nan))
    test = turning.test_of_reading
    share = np.divide(turning.moment, tests.moment[test], out=np.zeros(len(test)), where=tests.moment[test] > 0)
    rising = (share >= RISING[0]) & (share <= RISING[1]) & _before_the_largest(turning, tests)
    count = np.bincount(test[rising], minlength=m)
    slope, error = _slope(turning.moment[rising], turning.turning_angle[rising], test[rising], count)
    own = slope - (1.0 / campaign.pole_stiffness if campaign.pole_stiffness else 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        value = np.where(own > 0, own, np.nan) * tests.moment * tests.lever_arm
        relative2 = (error / own) ** 2
        relative2 += ((campaign.moment_uncertainty or 0.0) / tests.moment) ** 2
        relative2 += ((campaign.lever_arm_uncertainty or 0.0) / tests.lever_arm) ** 2
        dof = count - float(_FITTED)
        half = expanded_factor(np.where(dof >= 1.0, dof, np.nan), CONFIDENCE) * np.sqrt(relative2)
        interval = value[:, None] * np.exp(np.stack((-half, half), axis=-1))
    return ShearDisplacement(count, value, interval)


def _before_the_largest(turning: TurningReadings, tests: ShearTests) -> BoolArray:
    """Readings before the first one of their test with its largest moment."""
    largest = turning.moment >= tests.moment[turning.test_of_reading]
    reached = np.concatenate(([0], np.cumsum(largest)))
    return np.asarray(reached[1:] == reached[turning.first[:-1]][turning.test_of_reading])


def _slope(x: FloatArray, y: FloatArray, test: IntArray, count: IntArray) -> tuple[FloatArray, FloatArray]:
    """Slope of y on x in each test by least squares, and its standard error from the scatter about the line."""
    m = len(count)

    def sums(values: FloatArray) -> FloatArray:
        return np.bincount(test, weights=values, minlength=m).astype(np.float64, copy=False)

    with np.errstate(invalid="ignore", divide="ignore"):
        dx, dy = x - (sums(x) / count)[test], y - (sums(y) / count)[test]
        spread = sums(dx**2)
        slope = sums(dx * dy) / spread
        residual2 = sums((dy - slope[test] * dx) ** 2)
        return slope, np.sqrt(np.where(count > _FITTED, residual2 / (count - _FITTED), np.nan) / spread)
