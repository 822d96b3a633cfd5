"""A Gaussian process through the evaluations of a search: what a place not evaluated may give."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

from .score import NOT_PASSED

FloatArray: TypeAlias = npt.NDArray[np.float64]

LENGTHS: Final = (0.05, 5.0)
"""Within which the process's lengths are, in shares of each range (modelling assumption)."""
NOISE: Final = (1e-3, 0.5)
"""Within which the deviation of one evaluation is, over that of all values (modelling assumption)."""
SMALLEST: Final = 1e-9
"""Added to the kernel's diagonal, for rounding."""
FAILED_MORE: Final = (0.3, 0.8, 0.7)
"""By how many of the passed values' deviations a failure counts above the greatest of them: at least, for each gate,
for each metre, of which one counts (modelling assumption): so near that the process stays smooth."""
MOST_GATES: Final = 5.0
"""Gates of a failure that count (modelling assumption)."""
MOST_PASSED: Final = 3.0
"""Of the passed values' quarter widths above the median, beyond which a time counts as so much (modelling
assumption)."""


@dataclass(frozen=True, slots=True)
class Surrogate:
    """A Gaussian process of Matérn's kernel 5/2.

    Attributes
    ----------
    places
        (n, d) in the unit cube.
    lengths
        (d,) of the kernel.
    level, scale
        Mean and deviation of the values.
    noise
        Deviation of one value, over `scale`.

    References
    ----------
    * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
      Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
    """

    places: FloatArray
    lengths: FloatArray
    level: float
    scale: float
    noise: float
    _factor: tuple[FloatArray, bool]
    _weights: FloatArray

    @classmethod
    def of(cls, places: FloatArray, values: FloatArray, kinds: int) -> Surrogate:
        """The likeliest one, whose lengths are the same for each `kinds`-th number.

        Parameters
        ----------
        places
            (n, d), n from 2 on.
        values
            (n,) finite.
        kinds
            Divides d.
        """
        level, scale = float(values.mean()), float(values.std()) or 1.0
        standard = (values - level) / scale

        def misfit(logs: FloatArray) -> float:
            lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
            factor = _factored(places, lengths, math.exp(logs[kinds]))
            known = 0.5 * standard @ cho_solve(factor, standard) + float(np.sum(np.log(np.diag(factor[0]))))
            return float(known + 0.1 * np.sum((logs[:kinds] - math.log(0.7)) ** 2))

        bounds = [(math.log(low), math.log(high)) for low, high in (*(LENGTHS,) * kinds, NOISE)]
        begin = np.array([math.log(0.7)] * kinds + [math.log(0.05)])
        logs = minimize(misfit, begin, method="L-BFGS-B", bounds=bounds, options={"maxiter": 40}).x
        lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
        return cls._with(places, standard, lengths, level, scale, math.exp(logs[kinds]))

    @classmethod
    def _with(
        cls, places: FloatArray, standard: FloatArray, lengths: FloatArray, level: float, scale: float, noise: float
    ) -> Surrogate:
        factor = _factored(places, lengths, noise)
        return cls(places, lengths, level, scale, noise, factor, cho_solve(factor, standard))

    def at(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation (m,) of what places (m, d) give."""
        kernel = _kernel(places, self.places, self.lengths)
        mean = self.level + self.scale * (kernel @ self._weights)
        left = 1.0 - np.sum(kernel * cho_solve(self._factor, kernel.T).T, axis=1)
        return mean, self.scale * np.sqrt(np.maximum(left, 1e-12))

    def believing(self, place: FloatArray) -> Surrogate:
        """The same one with a place added that gives what it expects there."""
        expected = (self.at(place[None, :])[0] - self.level) / self.scale
        known = (
            _kernel(self.places, self.places, self.lengths) @ self._weights + (self.noise**2 + SMALLEST) * self._weights
        )
        return self._with(
            np.vstack([self.places, place]), np.append(known, expected), self.lengths, self.level, self.scale,
            self.noise,
        )  # fmt: skip


def learnable(values: Sequence[float]) -> FloatArray:
    """Values of evaluations, of which failures count as little more than the greatest time, in their order."""
    given = np.asarray(values, float)
    passed = np.isfinite(given) & (given < NOT_PASSED)
    if not passed.any():
        return np.log(np.where(np.isfinite(given), given, NOT_PASSED * 100.0))
    low, middle, high = np.quantile(given[passed], [0.25, 0.5, 0.75])
    known = np.minimum(given, middle + MOST_PASSED * max(high - low, 1e-6))
    deviation, worst = max(float(known[passed].std()), 1e-6), float(known[passed].max())
    gates, beside = np.divmod(np.where(np.isfinite(given), given, NOT_PASSED * 100.0), NOT_PASSED)
    gates = np.minimum(gates, MOST_GATES)
    least, each_gate, each_metre = FAILED_MORE
    return np.where(
        passed, known, worst + deviation * (least + each_gate * gates + each_metre * np.minimum(beside, 1.0))
    )


def _factored(places: FloatArray, lengths: FloatArray, noise: float) -> tuple[FloatArray, bool]:
    kernel = _kernel(places, places, lengths)
    kernel[np.diag_indices(len(places))] += noise**2 + SMALLEST
    factor, low = cho_factor(kernel, lower=True)
    return factor, bool(low)


def _kernel(first: FloatArray, second: FloatArray, lengths: FloatArray) -> FloatArray:
    """Matérn 5/2 (n, m)."""
    a, b = first / lengths, second / lengths
    square = np.sum(a * a, axis=1)[:, None] + np.sum(b * b, axis=1)[None, :] - 2.0 * a @ b.T
    apart = np.sqrt(5.0 * np.maximum(square, 0.0))
    return (1.0 + apart + apart**2 / 3.0) * np.exp(-apart)
