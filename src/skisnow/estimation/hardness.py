"""Snow hardness of each penetration experiment (Eqn 1), failure stress of each shear experiment (Eqns 7-9).

The three rival definitions share one form, H = F / M with a measure M of the contact: the depth e, the projected area A
or the displaced volume V. A further definition is one more entry in ``DEFINITIONS``.

The interval of Eqn 1 has the spreads of the whole campaign (`campaign_model`). With k_M = d ln M/d ln e the variance of
ln H is

    (k_M/k_V)² s² + (u_F/F₇)² + (k_M/e₇)² (u_e² + τ²)

with the relative scatter s of the force, the seating τ, and the standard uncertainties u_F of the load and u_e = (gauge
step)/√12 of the depth. Student's factor has the degrees of freedom of s: τ² contains the offset of the series itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import CONFIDENCE, N_PER_MM, N_PER_MM2, N_PER_MM3, ShownFields
from ..campaign.records import Campaign, ShearTests
from ..statistics.combined_uncertainty import expanded_factor
from .campaign_model import CampaignModel, Parts
from .readings import Readings, ReadingUncertainty


@dataclass(frozen=True, slots=True)
class HardnessDefinition:
    """One way to define hardness.

    symbol: H_e, H_A or H_V.
    unit, unit_key, si: its unit in the paper as printed, as in keys and file headers, and as a factor to SI.
    measure: M of each reading (SI).
    growth: dM/de of each reading (SI).
    """

    symbol: str
    unit: str
    unit_key: str
    si: float
    measure: Callable[[Readings], FloatArray]
    growth: Callable[[Readings], FloatArray]

    @property
    def key(self) -> str:
        """Name of this hardness in files, with its unit."""
        return f"{self.symbol}_{self.unit_key}"


DEFINITIONS: Final = {
    definition.symbol: definition
    for definition in (
        HardnessDefinition(
            "H_e", "N/mm", "N_per_mm", N_PER_MM, lambda r: r.penetration_depth, lambda r: np.ones_like(r.load)
        ),
        HardnessDefinition("H_A", "N/mm²", "N_per_mm2", N_PER_MM2, lambda r: r.contact_area, lambda r: r.area_growth),
        HardnessDefinition(
            "H_V", "N/mm³", "N_per_mm3", N_PER_MM3, lambda r: r.displaced_volume, lambda r: r.contact_area
        ),
    )
}


@dataclass(frozen=True, slots=True, repr=False)
class Hardness(ShownFields):
    """Hardness of m series by one definition, in SI; NaN where it does not exist.

    value: H.
    interval: (m, 2), 95 %; contains gauge, load, seating and scatter. NaN with fewer than two readings in contact.
    """

    value: FloatArray
    interval: FloatArray


def hardness_at_largest_load(readings: Readings, definition: HardnessDefinition) -> FloatArray:
    """H = F₇ / M₇ of each series (Eqn 1), SI; NaN where M₇ = 0: nothing was displaced."""
    F, M = readings.load[readings.largest], definition.measure(readings)[readings.largest]
    return np.divide(F, M, out=np.full(F.shape, np.nan), where=M > 0)


def hardness(readings: Readings, definition: HardnessDefinition, model: CampaignModel) -> Hardness:
    """Hardness of each series from the reading under its largest load (Eqn 1)."""
    value = hardness_at_largest_load(readings, definition)
    last, uncertainty = readings.largest, model.uncertainty
    scatter2, seating2 = (spread[model.group] for spread in (model.spreads.scatter2, model.spreads.seating2))
    with np.errstate(all="ignore"):  # no contact, no hardness
        per_depth = definition.growth(readings)[last] / definition.measure(readings)[last]
        of_volume = readings.contact_area[last] / readings.displaced_volume[last]
        own = (per_depth / of_volume) ** 2 * scatter2
        instrument2 = (uncertainty.load / readings.load[last]) ** 2 + per_depth**2 * (uncertainty.depth**2 + seating2)
        nothing = np.zeros_like(own)
        half = model.factor(Parts(own + instrument2, nothing, nothing, own), model.group) * np.sqrt(own + instrument2)
        half = np.where(np.isfinite(model.log_hardness), half, np.nan)
        return Hardness(value, value[:, None] * np.exp(half[:, None] * np.array([-1.0, 1.0])))


def hardness_of_all_readings(
    readings: Readings, definition: HardnessDefinition, uncertainty: ReadingUncertainty
) -> tuple[FloatArray, FloatArray]:
    """Hardness of each series from all its readings in contact, and their relative scatter s about F = H M.

    The variance of ln(F/M) is s² + (u_F/F)² + (k_M u_e/e)².
    """
    M = definition.measure(readings)
    touching = (M > 0) & (readings.penetration_depth > 0)
    logs = np.log(np.divide(readings.load, M, out=np.ones_like(M), where=touching))
    per_depth = np.divide(definition.growth(readings), M, out=np.zeros_like(M), where=touching)
    instrument2 = (uncertainty.load / readings.load) ** 2 + (per_depth * uncertainty.depth) ** 2
    scatter2 = scatter_variance(readings, logs, instrument2, touching)
    weight = np.where(touching, _reciprocal_or_zero(scatter2[readings.series] + instrument2), 0.0)
    exact = readings.sums(weight) == 0.0  # without any variance all readings of a series have the same weight
    weight = np.where(touching & exact[readings.series], 1.0, weight)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = readings.sums(weight * logs) / readings.sums(weight)
    return np.exp(mean), np.sqrt(scatter2)


def scatter_variance(readings: Readings, logs: FloatArray, instrument2: FloatArray, touching: BoolArray) -> FloatArray:
    """Between-reading variance s² of each series beyond the known one: Paule and Mandel (1982).

    Solves Σ (x - x̄)²/(s² + v) = n - 1 for s² ≥ 0 in each series at once; 0 where the known variance already explains
    the scatter, NaN with fewer than two readings in contact.
    """
    n = readings.sums(touching.astype(float))
    use = touching.astype(float)

    def excess(s2: FloatArray) -> tuple[FloatArray, FloatArray]:
        weight = use * _reciprocal_or_zero(s2[readings.series] + instrument2)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = readings.sums(weight * logs) / readings.sums(weight)
        deviation2 = (logs - mean[readings.series]) ** 2
        return readings.sums(weight * deviation2), readings.sums(weight**2 * deviation2)

    with np.errstate(invalid="ignore", divide="ignore"):
        plain = readings.sums(use * logs) / n
        s2 = readings.sums(use * (logs - plain[readings.series]) ** 2) / (n - 1.0)
        for _ in range(40):
            Q, slope = excess(s2)
            # Newton on 1/Q, which is straight where the scatter dominates
            step = np.where(slope > 0, (Q / (n - 1.0) - 1.0) * Q / slope, 0.0)
            moved = np.maximum(s2 + step, 0.0)
            settled = np.abs(moved - s2) <= 1e-9 * moved
            s2 = moved
            if settled[n > 1].all():
                break
    return np.where(n > 1, s2, np.nan)


def _reciprocal_or_zero(variance: FloatArray) -> FloatArray:
    """1/variance; 0 where the variance is not positive."""
    return np.divide(1.0, variance, out=np.zeros_like(variance), where=variance > 0)


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
    force = tests.moment / tests.lever_arm  # F_t = M/r (Eqn 7)
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
        highest = failure_shear_stress(k * u_M / tests.lever_arm, length, tests.penetration_depth)
        highest = highest * np.exp(k * np.sqrt(relative2))
    at_zero = np.stack((np.zeros_like(value), highest), axis=-1)
    return ShearStress(force, value, np.where((tests.moment > 0)[:, None], interval, at_zero))


@dataclass(frozen=True, slots=True, repr=False)
class ShearDisplacement(ShownFields):
    """u_y of m shear tests; NaN where a test has no rising part.

    n_readings: readings of the rising part, one number per test.
    value, interval: u_y (m), and its 95 % interval (m, 2) from the scatter about the line and the stated uncertainties
        of moment and lever arm: NaN with fewer than three readings.
    """

    n_readings: IntArray
    value: FloatArray
    interval: FloatArray


def shear_displacement(campaign: Campaign, tests: ShearTests) -> ShearDisplacement:
    """Displacement u_y of each shear test, from a line through the rising part of its moment over the angle."""
    m, turning = len(tests), tests.turning
    if turning is None:
        return ShearDisplacement(np.zeros(m, dtype=np.int64), np.full(m, np.nan), np.full((m, 2), np.nan))
    test = turning.series_of_reading
    share = np.divide(turning.moment, tests.moment[test], out=np.zeros(len(test)), where=tests.moment[test] > 0)
    reached = np.concatenate(([0], np.cumsum(turning.moment >= tests.moment[test])))
    before_the_largest = reached[1:] == reached[turning.first[:-1]][test]
    rising = (share >= RISING[0]) & (share <= RISING[1]) & before_the_largest
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
