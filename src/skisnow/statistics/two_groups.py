"""Two groups of measurements that scatter by a factor: how far apart, and how many more are needed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import nctdtr, ndtr, ndtri, stdtr, stdtrit

from .._support.errors import FitError, ParameterError
from .._support.messages import Message
from .combined_uncertainty import expanded_factor, require_confidence, welch_satterthwaite

if TYPE_CHECKING:
    import numpy.typing as npt

    from .least_squares import FloatArray

_MOST_TESTS = 10**9
_FAR, _VERY_FAR = 4.5, 30.0


class RatioOfMeans(NamedTuple):
    """Ratio of the geometric means of a and b, its interval (2,), and p of the test against the ratio 1."""

    ratio: float
    interval: FloatArray
    p: float


def ratio_of_means(logs_a: npt.ArrayLike, logs_b: npt.ArrayLike, *, confidence: float = 0.95) -> RatioOfMeans:
    """Compare two groups by Welch's t test on natural logarithms (Welch 1947, Biometrika 34, 28-35).

    Parameters
    ----------
    logs_a, logs_b
        Natural logarithms of the measured values, shapes (n_a,) and (n_b,).
    confidence
        Confidence of the interval.

    Returns
    -------
    RatioOfMeans
        ``ratio`` = geometric mean of a / geometric mean of b, NaN for an empty group. ``interval`` and ``p`` are NaN
        with fewer than two values in a group, and where neither group scatters at all: the scatter is then not known.
        A NaN among the logarithms makes everything NaN; nothing is left out.

    Examples
    --------
    >>> found = ratio_of_means(np.log([2.0, 4.0, 8.0]), np.log([1.0, 2.0, 4.0]))
    >>> round(found.ratio, 9)
    2.0
    """
    require_confidence(confidence)
    a, b = _logarithms("logs_a", logs_a), _logarithms("logs_b", logs_b)
    unknown = np.full(2, np.nan)
    if a.size == 0 or b.size == 0:
        return RatioOfMeans(float("nan"), unknown, float("nan"))
    difference = float(a.mean() - b.mean())
    if min(a.size, b.size) < 2 or not math.isfinite(difference):
        return RatioOfMeans(math.exp(difference), unknown, float("nan"))
    variances = np.array([a.var(ddof=1) / a.size, b.var(ddof=1) / b.size])
    error = math.sqrt(float(variances.sum()))
    if error == 0:
        return RatioOfMeans(math.exp(difference), unknown, float("nan"))
    dof = float(welch_satterthwaite(variances, [a.size - 1.0, b.size - 1.0]))
    half = float(expanded_factor(dof, confidence)) * error
    interval = np.exp([difference - half, difference + half])
    return RatioOfMeans(math.exp(difference), interval, 2.0 * float(stdtr(dof, -abs(difference) / error)))


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
    known = np.flatnonzero(np.isfinite(values))
    order = known[np.argsort(values[known], kind="stable")]
    factors = np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(np.maximum.accumulate(values[order] * factors), 1.0)
    return corrected


def _logarithms(name: str, values: npt.ArrayLike) -> FloatArray:
    logs = np.asarray(values, dtype=float)
    if logs.ndim != 1 or np.any(np.isinf(logs)):
        raise ParameterError(
            Message("{name} must be one row without infinite values: logarithms of measurements above 0", name=name),
            code="wrong_shape",
        )
    return logs


def tests_per_group(sd_log: float, *, ratio: float = 1.1, power: float = 0.8, alpha: float = 0.05) -> int:
    """Fewest tests in each of two groups that tell a ratio of their means, by the two-sided t test on logarithms.

    Parameters
    ----------
    sd_log
        Standard deviation of the natural logarithms within a group, > 0.
    ratio
        Ratio of the geometric means to be told from 1, > 0, not 1.
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
            Message(
                "sd_log is {sd_log!r}, ratio {ratio!r}; a scatter above 0 and a ratio above 0 other than 1 are needed",
                sd_log=sd_log,
                ratio=ratio,
            ),
            code="out_of_range",
        )
    if not 0 < alpha < power < 1:
        raise ParameterError(
            Message("alpha is {alpha!r}, power {power!r}; 0 < alpha < power < 1 is needed", alpha=alpha, power=power),
            code="out_of_range",
        )
    effect = abs(math.log(ratio)) / sd_log
    low, high = 1, 2
    while _power(high, effect, alpha) < power:
        low, high = high, 2 * high
        if low > _MOST_TESTS:
            raise FitError(
                Message(
                    "more than {most_tests} tests per group would be needed for a ratio of {ratio} at this scatter",
                    most_tests=_MOST_TESTS,
                    ratio=ratio,
                ),
                code="too_many",
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
