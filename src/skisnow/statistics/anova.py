"""Do the means of several groups differ? One-way analysis of variance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._support.errors import ParameterError
from .least_squares import require_finite
from .nested import f_ratio, f_tail

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt


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
        Share of the sum of squares that lies between the groups.
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
        raise ParameterError("groups must be one or more rows of at least one number each")
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
