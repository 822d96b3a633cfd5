"""Least squares by an orthogonal factorisation, behind the linear fits of this package.

The columns are centred and scaled, factorised by Householder reflections with column exchange, and the coefficients are
carried back to the columns as given. No normal equations: they would square the condition number.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.linalg import qr, solve_triangular

from .._support.arrays import FloatArray
from .._support.errors import FitError, FitWarning, ParameterError
from .._support.messages import Message

CONDITION_LIMIT: Final = 1e3
"""Of centred columns of unit length. NIST's Longley has 110 and keeps 13 digits; Wampler5 has 1,600 and keeps 8."""
_EPS = float(np.finfo(float).eps)
_ROUNDING = 4.0 * _EPS
"""A column whose spread is not above this share of its size is constant but for rounding."""


@dataclass(frozen=True)
class LeastSquares:
    """Fit of p coefficients, the intercept first, with the covariance σ² loadings loadingsᵀ.

    shifted: response less its mean, shape (n,).
    coefficients, residuals: shapes (p,) and (n,).
    orthogonal: Q, shape (n, p), with orthonormal columns.
    loadings: shape (p, p); the coefficients are loadings Qᵀy.
    """

    shifted: FloatArray
    coefficients: FloatArray
    residuals: FloatArray
    orthogonal: FloatArray
    loadings: FloatArray


def solve_least_squares(response: npt.ArrayLike, predictors: npt.ArrayLike) -> LeastSquares:
    """Fit response = b0 + b1 x1 + … + bk xk + error, with one step of iterative refinement.

    response, predictors: shapes (n,), and (n, k) or (n,).
    Raises ParameterError: shapes do not fit, or a value is not finite.
    Raises FitError: n < k + 1, or a predictor does not vary or follows from the others.
    """
    y = as_response(response)
    centred, means = _centre(as_predictors(predictors, len(y)))
    length = np.sqrt(np.mean(centred**2, axis=0))
    unit = np.where(length > 0, length, 1.0)
    scaled = np.hstack((np.ones((len(y), 1)), centred / unit))
    back = np.diag(np.concatenate(([1.0], 1.0 / unit)))  # to the coefficients of the predictors as given
    back[0, 1:] = -means / unit
    _warn_if_ill_conditioned(scaled)
    n, p = scaled.shape
    if n < p:
        raise FitError("{n} observations cannot determine {p} coefficients; at least {p} are needed").tag(
            "too_few_data", n=n, p=p
        )
    Q, R, order = qr(scaled, mode="economic", pivoting=True)
    diagonal = np.abs(np.diag(R))
    rank = int(np.sum(diagonal > n * _EPS * diagonal[0]))
    if rank < p:
        dependent = sorted(order[rank:].tolist())
        raise FitError(
            "the data determine only {rank} of {count} coefficients: {names} does not vary or follows from the other "
            "columns; remove it, or measure at more settings of it"
        ).tag("rank_deficient", rank=rank, count=p, names=[f"predictor {j}" if j else "intercept" for j in dependent])
    inverse = np.empty((p, p))
    inverse[order] = solve_triangular(R, np.eye(p))
    shifted, middle = _centre(y)
    scaled_coefficients, residuals = np.zeros(p), shifted
    for _ in range(2):
        scaled_coefficients = scaled_coefficients + inverse @ (Q.T @ residuals)
        residuals = shifted - scaled @ scaled_coefficients
    coefficients = back @ scaled_coefficients
    coefficients[0] += middle
    return LeastSquares(shifted, coefficients, residuals, np.asarray(Q, dtype=float), back @ inverse)


def as_response(response: npt.ArrayLike) -> FloatArray:
    """Check a response: one dimension, at least one finite number, no others."""
    y = np.asarray(response, dtype=float)
    if y.ndim != 1 or y.size == 0:
        raise ParameterError("response has shape {shape}; it must be a row of at least one number").tag(
            "wrong_shape", shape=str(y.shape)
        )
    _require_finite("response", y)
    return y


def as_predictors(predictors: npt.ArrayLike, n: int) -> FloatArray:
    """Check predictors: (n,) or (n, k), finite; returned as (n, k)."""
    X = np.asarray(predictors, dtype=float)
    if X.ndim == 1:
        X = X[:, None]
    if X.ndim != 2 or len(X) != n:
        raise ParameterError("predictors have shape {shape}; {n} rows are needed, one for each response").tag(
            "wrong_shape", shape=str(X.shape), n=n
        )
    _require_finite("predictors", X)
    return X


def _require_finite(name: str, values: FloatArray) -> None:
    """Raise `ParameterError` with the position of the first value that is not a finite number."""
    bad = ~np.isfinite(values)
    if np.any(bad):
        place = tuple(int(i) for i in np.argwhere(bad)[0])
        raise ParameterError("{name}{place} is {value}; only finite numbers can be fitted: remove such rows").tag(
            "not_a_number", name=name, place=place, value=values[place]
        )


def _centre(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shift columns (n, ...) by their means; a column that is constant but for rounding becomes exactly zero."""
    middle = values.mean(axis=0)
    shifted = values - middle
    still = np.max(np.abs(shifted), axis=0) <= _ROUNDING * np.max(np.abs(values), axis=0)
    return np.where(still, 0.0, shifted), middle


def _warn_if_ill_conditioned(columns: FloatArray) -> None:
    """Warn where columns of unit length have a condition number κ above `CONDITION_LIMIT`.

    Rounding of 2⁻⁵³ moves the coefficients by up to κ times as much, with large residuals by up to κ² times (Björck
    1996, Numerical Methods for Least Squares Problems, section 1.4).
    """
    length = np.linalg.norm(columns, axis=0)
    condition = float(np.linalg.cond(columns / np.where(length > 0, length, 1.0)))
    if CONDITION_LIMIT < condition < 1.0 / _EPS:
        message = Message(
            "The condition number of the predictors is {condition}, above {limit}: they nearly depend on each other. "
            "The coefficients have at most {digits} correct digits, fewer where the residuals are large. "
            "Omit a predictor.",
            condition=f"{condition:.1e}",
            limit=f"{CONDITION_LIMIT:.0e}",
            digits=f"{-np.log10(_EPS * condition):.0f}",
        )
        warnings.warn(FitWarning(message).tag("ill_conditioned"), stacklevel=4)
