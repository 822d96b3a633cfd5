"""How well parameters are known: from the curvature of the sum of squares, in standard deviations of the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.stats import norm, t

from .._support.units import CONFIDENCE

FloatArray = npt.NDArray[np.float64]

SINGULAR: Final = 1e-6
"""Of scaled columns: a singular value below this share of the largest is none."""
WIDEST: Final = 1.5
"""Half an interval, in sizes of its parameter, from which on the data say nothing about it (modelling assumption)."""
TAKES_PART: Final = 0.2
"""Share of a direction that nothing is known of, from which on a parameter takes part in it (modelling assumption)."""


@dataclass(frozen=True, slots=True, eq=False)
class Uncertainty:
    """Of p parameters, in their sizes.

    Attributes
    ----------
    covariance
        (p, p); infinite on the diagonal where nothing is known.
    correlation
        (p, p), NaN where nothing is known.
    factor
        Half an interval over its standard error.
    unknown
        (p,) whether the data leave it open.
    groups
        Parameters of which only a combination is known, by number; one alone has no effect at all.
    alone
        (p,) standard errors if all others were known; infinite without effect.
    """

    covariance: FloatArray
    correlation: FloatArray
    factor: float
    unknown: npt.NDArray[np.bool_]
    groups: tuple[tuple[int, ...], ...]
    alone: FloatArray

    def would_be_known(self, j: int) -> bool:
        """Whether the data tell parameter j once all others are known."""
        return bool(self.factor * self.alone[j] <= WIDEST)

    @property
    def standard_errors(self) -> FloatArray:
        """(p,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


def uncertainty(jacobian: FloatArray, *, degrees_of_freedom: float | None) -> Uncertainty:
    """From the derivatives of the residuals, each divided by its standard deviation.

    Parameters
    ----------
    jacobian
        (n, p), by parameters in their sizes.
    degrees_of_freedom
        Of the estimate of the noise, for Student's t; None where the noise is stated.

    Examples
    --------
    Two readings of one number, each with standard deviation 1: its standard error is 1/√2.

    >>> found = uncertainty(np.ones((2, 1)), degrees_of_freedom=None)
    >>> round(float(found.standard_errors[0]) ** 2, 9), round(found.factor, 3)
    (0.5, 1.96)
    """
    p = jacobian.shape[1]
    length = np.linalg.norm(jacobian, axis=0)
    unit = np.where(length > 0.0, length, 1.0)
    _, singular, directions = np.linalg.svd(jacobian / unit, full_matrices=False)
    known = singular > SINGULAR * max(float(singular.max(initial=0.0)), 1e-300)
    inverse = (directions[known].T / singular[known] ** 2) @ directions[known]
    covariance = inverse / unit[:, None] / unit[None, :]
    covariance = 0.5 * (covariance + covariance.T)  # the same above and below the diagonal, to the last digit
    open_directions = np.vstack([directions[~known], np.zeros((0, p))])
    lost = (np.abs(open_directions) > TAKES_PART).any(axis=0) | (length == 0.0)
    error = np.sqrt(np.where(lost, 1.0, np.diag(covariance)))
    correlation = covariance / np.outer(error, error)
    correlation[lost, :] = np.nan
    correlation[:, lost] = np.nan
    np.fill_diagonal(correlation, 1.0)
    covariance[lost, lost] = np.inf
    tail = 0.5 * (1.0 + CONFIDENCE)
    factor = float(norm.ppf(tail) if degrees_of_freedom is None else t.ppf(tail, max(degrees_of_freedom, 1.0)))
    alone = np.where(length > 0.0, 1.0 / unit, np.inf)
    with np.errstate(invalid="ignore"):
        unknown = lost | (factor * np.sqrt(np.diag(covariance)) > WIDEST)
    return Uncertainty(covariance, correlation, factor, unknown, _groups(open_directions, length), alone)


def _groups(directions: FloatArray, length: FloatArray) -> tuple[tuple[int, ...], ...]:
    alone = [(int(j),) for j in np.flatnonzero(length == 0.0)]
    together = [
        tuple(int(j) for j in np.flatnonzero((np.abs(each) > TAKES_PART) & (length > 0.0))) for each in directions
    ]
    return tuple(dict.fromkeys([*alone, *(group for group in together if group)]))
