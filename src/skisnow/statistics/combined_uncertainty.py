"""Degrees of freedom of a combined uncertainty, and the factor that turns a standard error into an interval.

Source: *Guide to the expression of uncertainty in measurement* (JCGM 100:2008), annex G.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.special import ndtri, stdtrit

from .._support.errors import ParameterError

if TYPE_CHECKING:
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float64]


def welch_satterthwaite(variances: npt.ArrayLike, degrees_of_freedom: npt.ArrayLike) -> FloatArray:
    """Effective degrees of freedom of a sum of independent contributions (GUM, Eqn G.2b).

    ν_eff = (Σ uᵢ²)² / Σ (uᵢ⁴/νᵢ)

    Parameters
    ----------
    variances
        Contributions uᵢ² ≥ 0 to the variance of the result, shape (..., k).
    degrees_of_freedom
        νᵢ of each contribution, shape (..., k) or what broadcasts to it; ``inf`` for one that is taken as known.

    Returns
    -------
    array
        ν_eff, shape (...). ``inf`` where no contribution above zero has finite νᵢ; 0 where one has νᵢ = 0; NaN where
        an input is NaN or below zero.

    Examples
    --------
    The end gauge of GUM H.1: 25 nm (18 degrees), 9.7 nm (25.6), 2.9 nm (50) and 16.6 nm (2) make 32 nm with 16 degrees
    of freedom, cut to the whole number below as the GUM does.

    >>> nm = [25.0, 9.7, 2.9, 16.6]
    >>> int(welch_satterthwaite([u**2 for u in nm], [18, 25.6, 50, 2]))
    16
    """
    u2, nu = np.broadcast_arrays(np.asarray(variances, float), np.asarray(degrees_of_freedom, float))
    bad = np.isnan(u2) | np.isnan(nu) | (u2 < 0) | (nu < 0)
    present = (u2 > 0) & ~bad
    total = np.sum(np.where(present, u2, 0.0), axis=-1)
    # shares, not squares of variances: u⁴ of a hardness in N/m³ would overflow sooner than need be
    share = np.where(present, u2, 0.0) / np.where(total > 0, total, 1.0)[..., None]
    with np.errstate(divide="ignore"):
        lost = np.sum(np.where(present, share**2 / np.where(present, nu, 1.0), 0.0), axis=-1)
        effective = 1.0 / lost
    return np.where(np.any(bad, axis=-1), np.nan, effective)


def expanded_factor(degrees_of_freedom: npt.ArrayLike, confidence: float) -> FloatArray:
    """Factor k that makes estimate ± k · standard error an interval of the given confidence.

    Student's t quantile at (1 + confidence)/2; the normal quantile where the degrees of freedom are infinite.

    Parameters
    ----------
    degrees_of_freedom
        ν, any shape; need not be whole numbers.
    confidence
        Between 0 and 1, both left out.

    Returns
    -------
    array
        k, of the shape of ν; NaN where ν is NaN or not above zero: nothing is known of the scatter there.

    Examples
    --------
    >>> expanded_factor([1.0, 30.0, float("inf")], 0.95).round(4).tolist()
    [12.7062, 2.0423, 1.96]
    """
    require_confidence(confidence)
    nu = np.asarray(degrees_of_freedom, float)
    quantile = 0.5 * (1.0 + confidence)
    finite = np.isfinite(nu) & (nu > 0)
    k = np.where(finite, stdtrit(np.where(finite, nu, 1.0), quantile), np.nan)
    return np.where(np.isposinf(nu), ndtri(quantile), k)


def require_confidence(confidence: float) -> None:
    """Raise `ParameterError` unless the confidence lies between 0 and 1."""
    if not 0.0 < confidence < 1.0:
        raise ParameterError(f"confidence is {confidence!r}; it must lie between 0 and 1, 0.95 for a 95 % interval")
