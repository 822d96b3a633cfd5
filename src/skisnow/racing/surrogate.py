"""A Gaussian process through the evaluations of a search: what a place not evaluated may give."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

FloatArray: TypeAlias = npt.NDArray[np.float64]

LENGTHS: Final = (0.05, 5.0)
"""Within which the process's lengths are, in shares of each range (modelling assumption)."""
NOISE: Final = (1e-3, 0.5)
"""Within which the deviation of one evaluation is, over that of all values (modelling assumption)."""
SMALLEST: Final = 1e-9
"""Added to the kernel's diagonal, for rounding."""


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
        Mean and deviation of the values: of one kind, or (q,) of kinds that have lengths and noise together.
    noise
        Deviation of one value, over `scale`.

    References
    ----------
    * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
      Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
    """

    places: FloatArray
    lengths: FloatArray
    level: FloatArray
    scale: FloatArray
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
            (n,) or (n, q), finite.
        kinds
            Divides d.
        """
        level, scale = values.mean(axis=0), np.asarray(values.std(axis=0))
        scale = np.where(scale > 0.0, scale, 1.0)
        standard = (values - level) / scale
        columns = 1 if values.ndim == 1 else values.shape[1]

        def misfit(logs: FloatArray) -> float:
            lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
            factor = _factored(places, lengths, math.exp(logs[kinds]))
            known = 0.5 * np.sum(standard * cho_solve(factor, standard))
            known += columns * np.sum(np.log(np.diag(factor[0])))
            return float(known + 0.1 * np.sum((logs[:kinds] - math.log(0.7)) ** 2))

        bounds = [(math.log(low), math.log(high)) for low, high in (*(LENGTHS,) * kinds, NOISE)]
        begin = np.array([math.log(0.7)] * kinds + [math.log(0.05)])
        logs = minimize(misfit, begin, method="L-BFGS-B", bounds=bounds, options={"maxiter": 40}).x
        lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
        return cls._with(places, standard, lengths, level, scale, math.exp(logs[kinds]))

    @classmethod
    def _with(
        cls,
        places: FloatArray,
        standard: FloatArray,
        lengths: FloatArray,
        level: FloatArray,
        scale: FloatArray,
        noise: float,
    ) -> Surrogate:
        factor = _factored(places, lengths, noise)
        return cls(places, lengths, level, scale, noise, factor, cho_solve(factor, standard))

    def at(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation, (m,) or (m, q), of what places (m, d) give."""
        kernel = _kernel(places, self.places, self.lengths)
        mean = self.level + self.scale * (kernel @ self._weights)
        left = 1.0 - np.sum(kernel * cho_solve(self._factor, kernel.T).T, axis=1)
        return mean, np.multiply.outer(np.sqrt(np.maximum(left, 1e-12)), self.scale)

    def believing(self, place: FloatArray) -> Surrogate:
        """The same one with a place added that gives what it expects there."""
        expected = (self.at(place[None, :])[0] - self.level) / self.scale
        known = (
            _kernel(self.places, self.places, self.lengths) @ self._weights + (self.noise**2 + SMALLEST) * self._weights
        )
        return self._with(
            np.vstack([self.places, place]), np.concatenate([known, expected]), self.lengths, self.level, self.scale,
            self.noise,
        )  # fmt: skip


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
