"""Tests of models and groups: nested models, pairs of groups, and how many tests are needed."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import fdtrc, nctdtr, ndtr, ndtri, stdtrit

from .._support.arrays import FloatArray
from .._support.errors import FitError, ParameterError


class NestedTest(NamedTuple):
    """Result of `nested_f_test`: F with df1 and df2 degrees of freedom, and p, the probability of a larger F."""

    F: float
    df1: int
    df2: int
    p: float


def nested_f_test(
    sse_full: float, sse_reduced: float, *, n: int, n_parameters_full: int, n_parameters_reduced: int
) -> NestedTest:
    """Test whether the parameters that the reduced model leaves out are needed.

    F = ((SSE_reduced - SSE_full)/df1) / (SSE_full/df2), df1 = p_full - p_reduced, df2 = n - p_full.

    sse_full, sse_reduced: Sums of squared residuals, in one and the same unit.
    n: Number of observations.
    n_parameters_full, n_parameters_reduced: Numbers of fitted coefficients, an intercept counted; the reduced model has
        not more than the full one.
    Returns: F and p are NaN where df1 = 0 (one and the same model), where df2 ≤ 0 (nothing left to judge by), where an
        SSE is NaN, and where both models fit exactly. If only the full one fits exactly, F is infinite and p = 0.
    Raises ParameterError: if the reduced model has more parameters than the full one, or an SSE is below zero.

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
            "the reduced model has {n_parameters_reduced} parameters, the full one "
            "{n_parameters_full}; the reduced model must be the smaller one: are the two swapped?"
        ).tag("contradiction", n_parameters_reduced=n_parameters_reduced, n_parameters_full=n_parameters_full)
    if sse_full < 0 or sse_reduced < 0:
        raise ParameterError("sums of squares are {sse_full!r} and {sse_reduced!r}; they cannot be below 0").tag(
            "out_of_range", sse_full=sse_full, sse_reduced=sse_reduced
        )
    if df1 == 0 or df2 <= 0:
        return NestedTest(float("nan"), df1, df2, float("nan"))
    F = f_ratio(max(sse_reduced - sse_full, 0.0), df1, sse_full, df2)
    return NestedTest(F, df1, df2, float(fdtrc(df1, df2, F)))


def f_ratio(explained: float, df1: int, unexplained: float, df2: int) -> float:
    """Ratio of two mean squares; infinite where nothing is left unexplained, NaN for 0/0."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return float(np.divide(explained / df1, unexplained / df2))


_MOST_TESTS = 10**9
_VERY_FAR = 30.0


def holm_corrected(p: npt.ArrayLike) -> FloatArray:
    """P values corrected for their number by Holm's step-down method (1979, Scand. J. Stat. 6, 65-70).

    NaN stays NaN and does not count.

    The smallest of three times 3, the next times 2, and none below the one before it.

    >>> holm_corrected([0.01, 0.04, 0.03]).round(4).tolist()
    [0.03, 0.06, 0.06]
    """
    values = np.asarray(p, dtype=float)
    corrected = np.full(values.shape, np.nan)
    finite = np.flatnonzero(np.isfinite(values))
    order = finite[np.argsort(values[finite], kind="stable")]
    factors = np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(np.maximum.accumulate(values[order] * factors), 1.0)
    return corrected


def compact_letters(differ: npt.ArrayLike) -> list[str]:
    """Letters of n groups of which two share one exactly where their pair does not differ (Piepho 2004).

    differ: symmetric (n, n) mask of the pairs that differ.
    Returns: letters of each group, by insertion and absorption (J. Comput. Graph. Stat. 13, 456-466).

    The first and the last differ, the middle one from neither.

    >>> compact_letters([[0, 0, 1], [0, 0, 0], [1, 0, 0]])
    ['a', 'ab', 'b']
    """
    mask = np.asarray(differ, dtype=np.bool_)
    columns = [frozenset(range(len(mask)))]
    for a, b in np.argwhere(np.triu(mask)).tolist():
        split = (column - {end} for column in columns if {a, b} <= column for end in (a, b))
        columns = list(dict.fromkeys([column for column in columns if not {a, b} <= column] + list(split)))
        columns = [column for column in columns if not any(column < other for other in columns)]
    columns.sort(key=sorted)
    # letters from a to z, then a1, b1 and so on
    letters = [chr(ord("a") + index % 26) + str(index // 26 or "") for index in range(len(columns))]
    return ["".join(letters[i] for i, column in enumerate(columns) if group in column) for group in range(len(mask))]


def tests_per_group(sd_log: float, *, ratio: float = 1.1, power: float = 0.8, alpha: float = 0.05) -> int:
    """Smallest number of tests per group that detects a ratio of their means, by the two-sided t test on logarithms.

    sd_log: Standard deviation of the natural logarithms within a group, > 0.
    ratio: Ratio of the geometric means that is to differ from 1, > 0, not 1.
    power: Chance that the test finds it, between alpha and 1.
    alpha: Level of the test.
    Returns: n ≥ 2 per group: the smallest with P(|t| > t_crit) ≥ power, t noncentral with 2 n - 2 degrees of freedom
        and noncentrality |ln ratio| √(n/2)/sd_log.
    Raises ParameterError: if an argument is outside the range above.
    Raises FitError: if more than 10⁹ tests would be needed.

    Examples
    --------
    The textbook case of half a standard deviation between the means (Cohen 1988, table 2.4.1): 64 in each group.

    >>> tests_per_group(0.2, ratio=math.exp(0.1))
    64
    """
    if not (sd_log > 0 and math.isfinite(sd_log) and ratio > 0 and math.isfinite(ratio) and ratio != 1):
        raise ParameterError(
            "sd_log is {sd_log!r}, ratio {ratio!r}; a scatter above 0 and a ratio above 0 other than 1 are needed"
        ).tag("out_of_range", sd_log=sd_log, ratio=ratio)
    if not 0 < alpha < power < 1:
        raise ParameterError("alpha is {alpha!r}, power {power!r}; 0 < alpha < power < 1 is needed").tag(
            "out_of_range", alpha=alpha, power=power
        )
    effect = abs(math.log(ratio)) / sd_log
    low, high = 1, 2
    while _power(high, effect, alpha) < power:
        low, high = high, 2 * high
        if low > _MOST_TESTS:
            raise FitError(
                "more than {most_tests} tests per group would be needed for a ratio of {ratio} at this scatter"
            ).tag("too_many", most_tests=_MOST_TESTS, ratio=ratio)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if _power(middle, effect, alpha) >= power else (middle, high)
    return high


def _power(n: int, effect: float, alpha: float) -> float:
    """Power of the two-sided t test with n in each group for a difference of ``effect`` standard deviations."""
    dof, shift = 2.0 * n - 2.0, effect * math.sqrt(n / 2.0)
    if n > 10**6:  # the noncentral t has no digits to add there
        critical = float(ndtri(1.0 - 0.5 * alpha))
        return float(ndtr(shift - critical) + ndtr(-shift - critical))
    critical = float(stdtrit(dof, 1.0 - 0.5 * alpha))
    missed, reversed_ = nctdtr(dof, shift, [critical, -critical]).tolist()
    # SciPy gives NaN instead of a chance near 0: of the wrong sign where it is below 3e-12, of no finding above 35
    if math.isnan(reversed_):
        reversed_ = 0.0
    if shift > _VERY_FAR and math.isnan(missed):
        missed = 0.0
    return 1.0 - missed + reversed_
