"""Which of several independent inputs an output's variance comes from: first-order Sobol shares by regression."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._support.display import ShownFields
from .linear import linear_fit

if TYPE_CHECKING:
    import numpy.typing as npt

    from .least_squares import FloatArray


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VarianceShares(ShownFields):
    """Shares of an output's variance.

    Attributes
    ----------
    share
        Shape (k,), 0 to 1: what an input takes along in proportion.
    interval
        Shape (k, 2).
    left
        What no input takes along: curvature and interplay of inputs.
    """

    share: FloatArray
    interval: FloatArray
    left: float


def variance_shares(output: npt.ArrayLike, inputs: npt.ArrayLike, *, confidence: float = 0.95) -> VarianceShares:
    """First-order Sobol shares of independent inputs, as far as the output follows them in proportion.

    Parameters
    ----------
    output
        Shape (n,).
    inputs
        Drawn independently of each other, shape (n, k), n ≥ k + 2; each varies.
    confidence
        Confidence of the intervals.

    Returns
    -------
    VarianceShares
        b² Var(x)/Var(y) of the linear regression, less what noise alone would give (the squared standard error in place
        of 0), and not below 0; intervals from those of b by Student's t. All 0 where the output does not vary.

    Raises
    ------
    ParameterError, FitError
        As of `linear_fit`.

    References
    ----------
    Saltelli and others (2008), Global Sensitivity Analysis, The Primer, Wiley, section 1.2.5 (standardised regression
    coefficients).

    Examples
    --------
    y = 2 x₁ + x₂ over a full grid: four fifths and one fifth, exactly.

    >>> shares = variance_shares([-3.0, -1.0, 1.0, 3.0], [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]])
    >>> [round(float(each), 12) for each in shares.share], round(shares.left, 12)
    ([0.8, 0.2], 0.0)
    """
    y, x = np.asarray(output, dtype=float), np.asarray(inputs, dtype=float)
    if len(y) and np.all(y == y[0]):
        nothing = np.zeros(x.shape[1])
        return VarianceShares(nothing, np.zeros((x.shape[1], 2)), 0.0)
    fit = linear_fit(y, x, confidence=confidence)
    scale = x.var(axis=0) / y.var()
    slope, error, ends = fit.coefficients[1:], fit.standard_errors[1:], fit.intervals[1:]
    low, high = np.sort(ends**2, axis=1).T
    low = np.where(ends[:, 0] * ends[:, 1] <= 0.0, 0.0, low)
    return VarianceShares(
        share=np.clip((slope**2 - error**2) * scale, 0.0, 1.0),
        interval=np.clip(np.stack([low * scale, high * scale], axis=1), 0.0, 1.0),
        left=1.0 - fit.r2,
    )
