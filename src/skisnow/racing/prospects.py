"""What races so far say of a place not raced: by how much it may be quicker, and whether it comes through."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr, ndtr

from .score import NOT_PASSED
from .search import Evaluated
from .surrogate import Surrogate

FloatArray: TypeAlias = npt.NDArray[np.float64]

MOST_TIME: Final = 3.0
"""Of the times' quarter widths above their median, beyond which a time counts as so much, and what a race counts that
never came to the last gate (modelling assumption)."""
MOST_MARGIN: Final = 0.5
"""Distance (m) from a pole that counts at most, to either side; a gate that was not reached counts as missed by it
(modelling assumption)."""
_UNIT: Final = 0.5 * math.log(2.0 * math.pi)


@dataclass(frozen=True, slots=True)
class Prospects:
    """Two processes: of the time at the last gate, failures among them, and of the margins that all have to be above 0.

    Attributes
    ----------
    time, margins
        `margins` is None where nothing is known to fail.
    least
        Of the times that the process expects where a race came through (s).

    References
    ----------
    * Gardner and others (2014), "Bayesian optimization with inequality constraints", Proceedings of Machine Learning
      Research 32(2), 937-945.
    * Eriksson and Poloczek (2021), "Scalable constrained Bayesian optimization", Proceedings of Machine Learning
      Research 130, 730-738, doi 10.48550/arXiv.2002.08526.
    """

    time: Surrogate
    margins: Surrogate | None
    least: float

    @classmethod
    def of(cls, found: Sequence[Evaluated], kinds: int) -> Prospects:
        """What evaluations say, two at least, whose places have `kinds` numbers a turn."""
        places = np.array([each.place for each in found])
        times, margins = times_of(found), margins_of(found)
        time = Surrogate.of(places, times, kinds)
        passed = passed_of(found)
        expected = time.at(places)[0]
        least = float(expected[passed].min() if passed.any() else times.max())
        varied = bool(np.any(margins <= 0.0))
        return cls(time, Surrogate.of(places, margins, kinds) if varied else None, least)

    def through(self, places: FloatArray) -> FloatArray:
        """Logarithm of the probability (m,) of coming through at places (m, d)."""
        if self.margins is None:
            return np.zeros(len(places))
        mean, deviation = self.margins.at(places)
        scatter = np.hypot(deviation, self.margins.noise * self.margins.scale)
        return np.asarray(np.sum(log_ndtr(mean / scatter), axis=1))

    def worth(self, places: FloatArray, curiosity: float = 1.0, caution: float = 1.0) -> FloatArray:
        """Logarithm of the time (s) by which places (m, d) may be expected to be quicker than the least.

        `curiosity` multiplies the deviation of the time: near 0 only what is expected counts, not what may be;
        `caution` is the power of the probability of coming through.
        """
        mean, deviation = self.time.at(places)
        deviation = deviation * curiosity
        gain = _log_improvement((self.least - mean) / deviation) + np.log(deviation)
        return np.asarray(gain + caution * self.through(places))

    def believing(self, place: FloatArray) -> Prospects:
        """The same with a place that gives what is expected there."""
        margins, least = None if self.margins is None else self.margins.believing(place), self.least
        if self.through(place[None, :])[0] > math.log(0.5):
            least = min(least, float(self.time.at(place[None, :])[0][0]))
        return Prospects(self.time.believing(place), margins, least)


def passed_of(found: Sequence[Evaluated]) -> npt.NDArray[np.bool_]:
    """Which came through (n,)."""
    return np.array([each.value < NOT_PASSED for each in found])


def times_of(found: Sequence[Evaluated]) -> FloatArray:
    """Times (n,) (s) at the last gate, of failures too; those that never came there count as slow."""
    given = np.array([_time(each) for each in found])
    known = np.isfinite(given)
    if not known.any():
        return np.array([math.log(min(each.value, 1e6)) for each in found])
    low, middle, high = np.quantile(given[known], [0.25, 0.5, 0.75])
    return np.minimum(np.where(known, given, np.inf), middle + MOST_TIME * max(high - low, 1e-6))


def margins_of(found: Sequence[Evaluated]) -> FloatArray:
    """Margins (n, q) (m) of evaluations whose rows have some, and -1 or 1 for failing where they have none."""
    if not found[0].row.get("margins"):
        return np.where(passed_of(found), 1.0, -1.0)[:, None]
    count = max(len(each.row["margins"]) for each in found)
    out = np.full((len(found), count), -MOST_MARGIN)
    for i, each in enumerate(found):
        for j, margin in enumerate(each.row["margins"]):
            if margin is not None:
                out[i, j] = min(max(margin, -MOST_MARGIN), MOST_MARGIN)
    return out


def _time(each: Evaluated) -> float:
    if each.value < NOT_PASSED:
        return each.value
    gates = each.row.get("gates")
    return float(gates[-1][1]) if gates and gates[-1][1] is not None else math.inf


def _log_improvement(hope: FloatArray) -> FloatArray:
    """Logarithm of φ(z) + z Φ(z), also far below 0."""
    above, near = np.maximum(hope, 0.0), np.clip(hope, -10.0, 0.0)
    density = -0.5 * near**2 - _UNIT
    below = density + np.log1p(near * np.exp(log_ndtr(near) - density))
    low = np.maximum(-hope, 10.0)
    far = -0.5 * low**2 - _UNIT - 2.0 * np.log(low) + np.log1p(-3.0 / low**2 + 15.0 / low**4)
    over = np.log(above * ndtr(above) + np.exp(-0.5 * above**2 - _UNIT))
    return np.asarray(np.where(hope > 0.0, over, np.where(hope > -10.0, below, far)))
