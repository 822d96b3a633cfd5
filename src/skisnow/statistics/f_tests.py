"""F tests: two nested least-squares models, and one-way analysis of variance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import fdtrc

from .._support.errors import ParameterError
from .least_squares import require_finite

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt


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
            "the reduced model has {n_parameters_reduced} parameters, the full one "
            "{n_parameters_full}; the reduced model must be the smaller one: are the two swapped?",
            code="contradiction",
            n_parameters_reduced=n_parameters_reduced,
            n_parameters_full=n_parameters_full,
        )
    if sse_full < 0 or sse_reduced < 0:
        raise ParameterError(
            "sums of squares are {sse_full!r} and {sse_reduced!r}; they cannot be below 0",
            code="out_of_range",
            sse_full=sse_full,
            sse_reduced=sse_reduced,
        )
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


@dataclass(frozen=True)
class Anova:
    """A one-way analysis of variance.

    Attributes
    ----------
    F, p
        Mean square between over mean square within, and the chance of an F as large.
    df_between, df_within
        Degrees of freedom: groups - 1, observations - groups.
    ss_between, ss_within
        Sums of squares.
    r2
        Share of the sum of squares between the groups.
    residual_sd
        Root of the mean square within.
    """

    F: float
    p: float
    df_between: int
    df_within: int
    ss_between: float
    ss_within: float
    r2: float
    residual_sd: float


def one_way_anova(groups: Sequence[npt.ArrayLike]) -> Anova:
    """Compare the means of groups of observations.

    Parameters
    ----------
    groups
        One row of finite numbers for each group, each with at least one.

    Returns
    -------
    Anova
        F and p are NaN for a single group and where no group has more than one observation.

    Raises
    ------
    ParameterError
        If there is no group, a group is empty or a value is not finite.

    Notes
    -----
    All values are first shifted by the overall mean: digits that all have in common would cost digits of the squares.

    Examples
    --------
    Groups 1, 3 and 4, 6: means 2 and 5, between 9, within 4, F = 9/(4/2).

    >>> one_way_anova([[1.0, 3.0], [4.0, 6.0]]).F
    4.5
    """
    rows = [np.asarray(group, dtype=float) for group in groups]
    if not rows or any(row.ndim != 1 or row.size == 0 for row in rows):
        raise ParameterError("groups must be one or more rows of at least one number each", code="wrong_shape")
    for number, row in enumerate(rows, start=1):
        require_finite(f"group {number}", row)
    overall = np.concatenate(rows).mean()
    shifted = [row - overall for row in rows]
    middle = float(np.concatenate(shifted).mean())
    within = float(sum(np.sum((row - row.mean()) ** 2) for row in shifted))
    between = float(sum(row.size * (row.mean() - middle) ** 2 for row in shifted))
    df_between, df_within = len(rows) - 1, sum(row.size for row in rows) - len(rows)
    testable = df_between > 0 and df_within > 0
    F = f_ratio(between, df_between, within, df_within) if testable else float("nan")
    return Anova(
        F=F,
        p=f_tail(F, df_between, df_within) if testable else float("nan"),
        df_between=df_between,
        df_within=df_within,
        ss_between=between,
        ss_within=within,
        r2=between / (between + within) if between + within > 0 else float("nan"),
        residual_sd=float(np.sqrt(within / df_within)) if df_within > 0 else float("nan"),
    )
