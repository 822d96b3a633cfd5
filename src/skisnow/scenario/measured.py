"""What a campaign measured of one key of a scenario: a value with its interval, which an ensemble is drawn from."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..snow import SnowProperties
from ..snow.drawn import log_normal
from .keys import SCENARIO_KEYS


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """A key of a scenario with a measured value, log-normal with its 95 % interval.

    Attributes
    ----------
    key
        Full name.
    value
        In the key's unit: the median of what is drawn.
    low, high
        Ends of the 95 % interval in the key's unit, 0 < low ≤ value ≤ high.
    """

    key: str
    value: float
    low: float
    high: float

    def at(self, shares: npt.NDArray[np.float64], own: float) -> npt.NDArray[np.float64]:  # noqa: ARG002
        """Values at shares (n,) between 0 and 1, kept inside what the key allows; the scenario's own plays no part."""
        key = SCENARIO_KEYS[self.key]
        return np.clip(log_normal(self.value, (self.low, self.high), shares), key.lowest, key.highest)


def measured_of(snow: SnowProperties) -> tuple[Measured, ...]:
    """What a snow has with a value and an interval above 0: H_V, S_f, k_u/H_V, u_y, as far as they are known.

    >>> snow = SnowProperties(2e8, None, "somewhere", unloading_ratio=9.0, unloading_ratio_interval=(6.0, 16.0))
    >>> measured_of(snow)
    (Measured(key='snow.unloading_ratio', value=9.0, low=6.0, high=16.0),)
    """
    return tuple(_measured(snow))


def _measured(snow: SnowProperties) -> Iterator[Measured]:
    known = (
        ("snow.H_V_N_per_mm3", snow.snow_hardness, snow.snow_hardness_interval, N_PER_MM3),
        ("snow.S_f_N_per_mm2", snow.failure_shear_stress, snow.failure_shear_stress_interval, N_PER_MM2),
        ("snow.unloading_ratio", snow.unloading_ratio, snow.unloading_ratio_interval, 1.0),
        ("snow.shear_displacement_mm", snow.shear_displacement, snow.shear_displacement_interval, MM),
    )
    for key, value, interval, unit in known:
        if value is not None and interval is not None and interval[0] > 0.0:
            yield Measured(key=key, value=value / unit, low=interval[0] / unit, high=interval[1] / unit)
