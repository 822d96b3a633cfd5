"""Two groups of measurements that scatter by a factor: how far apart, and how many more are needed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import nctdtr, ndtr, ndtri, stdtrit

from .._support.errors import FitError, ParameterError

if TYPE_CHECKING:
    import numpy.typing as npt

    from .._support.arrays import FloatArray


_MOST_TESTS = 10**9
_FAR, _VERY_FAR = 4.5, 30.0


def holm_corrected(p: npt.ArrayLike) -> FloatArray:
    """P values corrected for their number by Holm's step-down method (1979, Scand. J. Stat. 6, 65-70).

    NaN stays NaN and does not count.

    Examples
    --------
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

    Parameters
    ----------
    differ
        Symmetric (n, n) mask of the pairs that differ.

    Returns
    -------
    list of str
        Letters of each group, by insertion and absorption (J. Comput. Graph. Stat. 13, 456-466).

    Examples
    --------
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
    return [
        "".join(_letter(index) for index, column in enumerate(columns) if group in column) for group in range(len(mask))
    ]


def _letter(index: int) -> str:
    """Letters from a to z, then a1, b1 and so on."""
    return chr(ord("a") + index % 26) + (str(index // 26) if index >= 26 else "")


def tests_per_group(sd_log: float, *, ratio: float = 1.1, power: float = 0.8, alpha: float = 0.05) -> int:
    """Smallest number of tests per group that detects a ratio of their means, by the two-sided t test on logarithms.

    Parameters
    ----------
    sd_log
        Standard deviation of the natural logarithms within a group, > 0.
    ratio
        Ratio of the geometric means that is to differ from 1, > 0, not 1.
    power
        Chance that the test finds it, between alpha and 1.
    alpha
        Level of the test.

    Returns
    -------
    int
        n ≥ 2 per group: the smallest with P(|t| > t_crit) ≥ power, t noncentral with 2 n - 2 degrees of freedom and
        noncentrality |ln ratio| √(n/2)/sd_log.

    Raises
    ------
    ParameterError
        If an argument is outside the range above.
    FitError
        If more than 10⁹ tests would be needed.

    Examples
    --------
    The textbook case of half a standard deviation between the means (Cohen 1988, table 2.4.1): 64 in each group.

    >>> tests_per_group(0.2, ratio=math.exp(0.1))
    64
    """
    if not (sd_log > 0 and math.isfinite(sd_log) and ratio > 0 and math.isfinite(ratio) and ratio != 1):
        raise ParameterError(
            "sd_log is {sd_log!r}, ratio {ratio!r}; a scatter above 0 and a ratio above 0 other than 1 are needed",
            code="out_of_range",
            sd_log=sd_log,
            ratio=ratio,
        )
    if not 0 < alpha < power < 1:
        raise ParameterError(
            "alpha is {alpha!r}, power {power!r}; 0 < alpha < power < 1 is needed",
            code="out_of_range",
            alpha=alpha,
            power=power,
        )
    effect = abs(math.log(ratio)) / sd_log
    low, high = 1, 2
    while _power(high, effect, alpha) < power:
        low, high = high, 2 * high
        if low > _MOST_TESTS:
            raise FitError(
                "more than {most_tests} tests per group would be needed for a ratio of {ratio} at this scatter",
                code="too_many",
                most_tests=_MOST_TESTS,
                ratio=ratio,
            )
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
    # far out scipy gives NaN for values that are zero to all digits: seen from 4.9 on for one, from 37 on for the other
    if shift > _FAR and math.isnan(reversed_):
        reversed_ = 0.0
    if shift > _VERY_FAR and math.isnan(missed):
        missed = 0.0
    return 1.0 - missed + reversed_
