"""What is not known of one key of a scenario: a range, and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .free_keys import free_key
from .keys import SCENARIO_KEYS


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
