"""F test between two nested least-squares models, from their sums of squared residuals alone."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import fdtrc

from .._support.errors import ParameterError


class NestedTest(NamedTuple):
    """What `nested_f_test` found: F with df1 and df2 degrees of freedom, and p, the chance of an F as large."""

    F: float
    df1: int
    df2: int
    p: float


def nested_f_test(
    sse_full: float, sse_reduced: float, *, n: int, n_parameters_full: int, n_parameters_reduced: int
) -> NestedTest:
    """Test whether the parameters that the reduced model leaves out are needed.

    F = ((SSE_reduced - SSE_full)/df1) / (SSE_full/df2), df1 = p_full - p_reduced, df2 = n - p_full.

    Parameters
    ----------
    sse_full, sse_reduced
        Sums of squared residuals, in one and the same unit.
    n
        Number of observations.
    n_parameters_full, n_parameters_reduced
        Numbers of fitted coefficients, an intercept counted; the reduced model has not more than the full one.

    Returns
    -------
    NestedTest
        F and p are NaN where df1 = 0 (one and the same model), where df2 ≤ 0 (nothing left to judge by), where an SSE
        is NaN, and where both models fit exactly. If only the full one fits exactly, F is infinite and p = 0.

    Raises
    ------
    ParameterError
        If the reduced model has more parameters than the full one, or an SSE is below zero.

    Notes
    -----
    A reduced model cannot fit better than the one that contains it. A difference below zero, as rounding leaves it
    between two fits that are equally good, counts as zero: F = 0, p = 1.

    The test supposes independent residuals and parameters that are free. With a parameter on a bound, or with several
    readings of one experiment, its p is only a number to compare with other authors' p.

    Examples
    --------
    >>> nested_f_test(8.0, 12.0, n=10, n_parameters_full=2, n_parameters_reduced=1).F  # (4/1)/(8/8)
    4.0
    """
    df1, df2 = n_parameters_full - n_parameters_reduced, n - n_parameters_full
    if df1 < 0:
        raise ParameterError(
            f"the reduced model has {n_parameters_reduced} parameters, the full one {n_parameters_full}; "
            "the reduced model must be the smaller one: are the two swapped?"
        )
    if sse_full < 0 or sse_reduced < 0:
        raise ParameterError(f"sums of squares are {sse_full!r} and {sse_reduced!r}; they cannot be below 0")
    if df1 == 0 or df2 <= 0:
        return NestedTest(float("nan"), df1, df2, float("nan"))
    F = f_ratio(max(sse_reduced - sse_full, 0.0), df1, sse_full, df2)
    return NestedTest(F, df1, df2, f_tail(F, df1, df2))


def f_ratio(explained: float, df1: int, unexplained: float, df2: int) -> float:
    """Ratio of two mean squares; infinite where nothing is left unexplained, NaN for 0/0."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return float(np.divide(explained / df1, unexplained / df2))


def f_tail(F: float, df1: int, df2: int) -> float:
    """Chance of a value above F in the F distribution; NaN in, NaN out."""
    return float(fdtrc(df1, df2, F))
