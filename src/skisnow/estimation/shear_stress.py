"""Failure shear stress of each shear experiment (Eqns 7-9), with an interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.units import CONFIDENCE
from ..statistics.combined_uncertainty import expanded_factor

if TYPE_CHECKING:
    from ..campaign.records import Campaign, ShearTests

FloatArray = npt.NDArray[np.float64]


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

    One reading has no scatter of its own: the interval is that of the instruments, without the snow's variation. It is
    NaN where the campaign states no uncertainty at all. At M = 0 the stress is 0 and the interval one-sided.
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
