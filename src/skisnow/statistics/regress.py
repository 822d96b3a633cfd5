"""Linear regression with the arguments, results and habits of MATLAB's and Octave's ``regress``."""

from __future__ import annotations

import warnings
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import FitError, FitWarning, ParameterError
from .combined_uncertainty import expanded_factor, require_confidence
from .f_tests import f_ratio, f_tail
from .least_squares import (
    Columns,
    Factorisation,
    factorise,
    independent_columns,
    require_finite,
    standardised,
    warn_if_ill_conditioned,
)


class RegressStatistics(NamedTuple):
    """R², F, its p and the error variance SSE/(n - p): MATLAB's ``stats``."""

    r2: float
    F: float
    p: float
    error_variance: float


class Regress(NamedTuple):
    """Result of `regress`.

    ``b`` (p,) coefficients, ``bint`` (p, 2) their intervals, ``r`` (n,) residuals, ``rint`` (n, 2) intervals of the
    residuals, ``stats``.
    """

    b: FloatArray
    bint: FloatArray
    r: FloatArray
    rint: FloatArray
    stats: RegressStatistics


def regress(y: npt.ArrayLike, X: npt.ArrayLike, alpha: float = 0.05) -> Regress:
    """Regress y on the columns of X, as MATLAB's ``[b, bint, r, rint, stats] = regress(y, X, alpha)``.

    Parameters
    ----------
    y
        Response, shape (n,) or (n, 1).
    X
        Design, shape (n, p) or (n,), *with* its column of ones, in any place.
    alpha
        1 - alpha is the confidence of the intervals.

    Returns
    -------
    Regress
        A row with NaN in y or X takes no part and has NaN in r and rint. An interval in rint that does not contain 0
        marks an outlier: it is taken from the variance without that observation.

    Raises
    ------
    ParameterError
        If shapes do not fit, a value is infinite, or alpha is not between 0 and 1.
    FitError
        If no complete row is left, or X is zero throughout.

    Warns
    -----
    UserWarning
        If no combination of the columns of X is constant: R², F and p are wrong then (R² can be negative). If the
        columns of X depend on each other: b is 0 for the omitted ones.
    FitWarning
        If the condition number of the columns is above 1,000: b loses digits.

    See Also
    --------
    skisnow.analyse : the regressions of a campaign.

    Notes
    -----
    R² = 1 - SSE/SST and F = (Σ(ŷ - mean y)²/(p - 1))/(SSE/(n - p)) with p the rank, as MATLAB has them.

    References
    ----------
    * The function ``regress`` of MATLAB's Statistics and Machine Learning Toolbox and of Octave's package statistics.
    * The page docs/methods/statistics.md.

    Examples
    --------
    >>> found = regress([7, 15, 12, 20], [[1, 1, 1], [1, 2, 3], [1, 3, 2], [1, 3, 5]])
    >>> found.b.round(4).tolist()
    [3.8333, 0.8333, 2.8333]
    >>> [round(value, 5) for value in found.stats]
    [0.98315, 29.16667, 0.12982, 1.5]
    """
    require_confidence(1.0 - alpha)
    response, design = _check_arguments(y, X)
    whole = ~(np.isnan(response) | np.any(np.isnan(design), axis=1))
    if not np.any(whole):
        raise FitError("every row of y and X contains NaN; nothing can be fitted").tag("no_data")
    fit = _factorised(design[whole])
    b, residuals = fit.solve(response[whole])
    _warn_without_constant(fit)
    n, p = fit.orthogonal.shape
    sse = float(residuals @ residuals)
    variance = sse / (n - p) if n > p else float("nan")
    half = expanded_factor(float(n - p), 1.0 - alpha) * np.sqrt(variance) * np.linalg.norm(fit.loadings, axis=1)
    r, rint = np.full(len(response), np.nan), np.full((len(response), 2), np.nan)
    r[whole] = residuals
    rint[whole] = _residual_intervals(fit, residuals, alpha)
    stats = _statistics(response[whole], residuals, p, variance)
    return Regress(b, np.stack((b - half, b + half), axis=-1), r, rint, stats)


def _check_arguments(y: npt.ArrayLike, X: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    response, design = np.asarray(y, dtype=float), np.asarray(X, dtype=float)
    if response.ndim == 2 and response.shape[1] == 1:
        response = response[:, 0]
    if design.ndim == 1:
        design = design[:, None]
    if response.ndim != 1 or design.ndim != 2 or len(response) != len(design) or design.shape[1] == 0:
        raise ParameterError("y has shape {shape}, X {shape_2}; X needs one row for each value of y").tag(
            "wrong_shape", shape=str(response.shape), shape_2=str(design.shape)
        )
    for name, values in (("y", response), ("X", design)):
        require_finite(name, np.where(np.isnan(values), 0.0, values))
    return response, design


def _factorised(design: FloatArray) -> Factorisation:
    """Factorise the independent columns of the design; with a column of ones the others are centred."""
    ones = np.flatnonzero(np.all(design == 1.0, axis=0))
    if ones.size:
        others = np.delete(np.arange(design.shape[1]), ones[0])
        inner = standardised(design[:, others], intercept=True)
        back = np.empty_like(inner.back)
        back[np.concatenate((ones[:1], others))] = inner.back
        columns = Columns(inner.scaled, back, inner.names)
    else:
        columns = standardised(design, intercept=False)
    used = independent_columns(columns.scaled)
    if not used:
        raise FitError("X is zero throughout; it determines no coefficient").tag("no_data")
    if len(used) < design.shape[1]:
        warnings.warn(
            FitWarning("X has {count} columns but rank {rank}: coefficients that are not determined are set to 0").tag(
                "rank_deficient", count=design.shape[1], rank=len(used)
            ),
            stacklevel=3,
        )
    part = Columns(columns.scaled[:, used], columns.back[:, used], tuple(columns.names[j] for j in used))
    warn_if_ill_conditioned(part.scaled)
    return factorise(part)


def _warn_without_constant(fit: Factorisation) -> None:
    ones = np.ones(len(fit.orthogonal))
    missed = ones - fit.orthogonal @ (fit.orthogonal.T @ ones)
    if np.abs(missed).sum() > len(ones) * np.sqrt(np.finfo(float).eps):
        warnings.warn(
            FitWarning(
                "no combination of the columns of X is constant: R², F and p in stats are not those of a "
                "regression; add a column of ones, or compare models without an intercept by "
                "nested_f_test"
            ).tag("no_constant_column"),
            stacklevel=3,
        )


def _residual_intervals(fit: Factorisation, residuals: FloatArray, alpha: float) -> FloatArray:
    """Give r ± t s₍ᵢ₎ √(1 - hᵢ), s₍ᵢ₎ from the fit without observation i (n - p - 1 degrees of freedom)."""
    n, p = fit.orthogonal.shape
    nu = n - p
    free = 1.0 - np.sum(fit.orthogonal**2, axis=1)
    determined = free > np.sqrt(np.finfo(float).eps)  # an observation that alone fixes a coefficient has no interval
    if nu == 0:
        return np.full((n, 2), np.nan)
    squares = np.full(n, residuals @ residuals / nu)
    if nu > 1:
        without = residuals @ residuals - residuals**2 / np.where(determined, free, 1.0)
        squares = np.maximum(without, 0.0) / (nu - 1)
    width = expanded_factor(float(max(nu - 1, 1)), 1.0 - alpha) * np.sqrt(squares * np.maximum(free, 0.0))
    width = np.where(determined, width, np.inf)
    return np.stack((residuals - width, residuals + width), axis=-1)


def _statistics(response: FloatArray, residuals: FloatArray, p: int, variance: float) -> RegressStatistics:
    n, deviations = len(response), response - response.mean()
    with np.errstate(divide="ignore", invalid="ignore"):
        r2 = float(1.0 - np.divide(residuals @ residuals, deviations @ deviations))
    if p < 2 or n <= p:
        return RegressStatistics(r2, float("nan"), float("nan"), variance)
    explained = float(np.sum((deviations - residuals) ** 2))
    F = f_ratio(explained, p - 1, variance, 1)
    return RegressStatistics(r2, F, f_tail(F, p - 1, n - p), variance)
