"""Uncertainty of one key of a scenario: a range from the user, or a value with interval from a campaign."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..snow import SnowProperties
from ..snow.mean_snow import log_normal
from .keys import SCENARIO_KEYS, free_key


@dataclass(frozen=True, slots=True, kw_only=True)
class Prior:
    """A key of a scenario with a range of values, each as likely as any other of the same order of size.

    Attributes
    ----------
    key
        Full name.
    low, high
        Ends in the key's unit, 0 < low ≤ high; equal ones: it is known. The logarithm is even between them.
    about
        Whether the ends are multiplied with the scenario's own value.
    origin
        Where the range comes from.
    """

    key: str
    low: float
    high: float
    origin: str
    about: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.low <= self.high:
            raise ParameterError(
                f"the prior of {self.key} is {self.low:g} to {self.high:g}; its ends must be above 0, the first one "
                "not above the other"
            )
        if not self.about:
            for end in (self.low, self.high):
                SCENARIO_KEYS[self.key].in_range(end)

    def ends(self, own: float) -> tuple[float, float]:
        """Both ends for a scenario with a value of its own."""
        return (self.low * own, self.high * own) if self.about else (self.low, self.high)

    def at(self, shares: npt.NDArray[np.float64], own: float) -> npt.NDArray[np.float64]:
        """Values at shares (n,) between 0 and 1, kept inside what the key allows."""
        low, high = self.ends(own)
        key = SCENARIO_KEYS[self.key]
        return np.clip(low * (self.high / self.low) ** shares, key.lowest, key.highest) if high > 0.0 else 0.0 * shares


def prior_of(word: str) -> Prior:
    """A prior as the command line takes it.

    Raises
    ------
    ParameterError
        It is not ``KEY=LOW:HIGH``, or the key or the ends cannot be.

    Examples
    --------
    >>> prior_of("unloading_ratio=5:20")
    Prior(key='snow.unloading_ratio', low=5.0, high=20.0, origin='given', about=False)
    """
    name, _, ends = word.partition("=")
    try:
        low, high = (float(end) for end in ends.split(":"))
    except ValueError:
        raise ParameterError(
            f"{word!r} is no prior; write KEY=LOW:HIGH, such as snow.unloading_ratio=5:20, with equal ends where it is "
            "known"
        ) from None
    return Prior(key=free_key(name), low=low, high=high, origin="given")


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
