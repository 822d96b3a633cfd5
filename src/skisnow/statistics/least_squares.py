"""The one orthogonal factorisation behind the linear fits of this package.

The columns are centred and scaled, factorised by Householder reflections with column exchange, and the coefficients are
carried back to the columns as given. No normal equations: they would square the condition number.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypedDict

import numpy as np
import numpy.typing as npt
from scipy.linalg import qr, solve_triangular

from .._support.arrays import FloatArray, IntArray
from .._support.errors import FitError, FitWarning, ParameterError
from .._support.messages import Message
from .combined_uncertainty import expanded_factor

CONDITION_LIMIT: Final = 1e3
"""Of centred columns of unit length. NIST's Longley has 110 and keeps 13 digits; Wampler5 has 1,600 and keeps 8."""
_EPS = float(np.finfo(float).eps)
_ROUNDING = 4.0 * _EPS
"""A column whose spread is not above this share of its size is constant but for rounding."""


@dataclass(frozen=True)
class Columns:
    """A design in well-conditioned coordinates.

    The scaled columns (n, p) span the same space as the original columns X; ``back`` (p, p) converts coefficients γ of
    the scaled columns to those of X: β = back γ.
    """

    scaled: FloatArray
    back: FloatArray
    names: tuple[str, ...]


@dataclass(frozen=True)
class Factorisation:
    """Full-rank design: β = loadings Qᵀy, so that the covariance of β is σ² loadings loadingsᵀ.

    orthogonal: Q, shape (n, p), with orthonormal columns.
    loadings: shape (p, p).
    """

    orthogonal: FloatArray
    loadings: FloatArray
    _scaled: FloatArray
    _back: FloatArray
    _inverse: FloatArray

    def solve(self, response: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the coefficients β (p,) and residuals (n,), with one step of iterative refinement."""
        gamma = np.zeros(self._scaled.shape[1])
        residual = response
        for _ in range(2):
            gamma = gamma + self._inverse @ (self.orthogonal.T @ residual)
            residual = response - self._scaled @ gamma
        return self._back @ gamma, residual


def as_response(response: npt.ArrayLike) -> FloatArray:
    """Check a response: one dimension, at least one finite number, no others."""
    y = np.asarray(response, dtype=float)
    if y.ndim != 1 or y.size == 0:
        raise ParameterError("response has shape {shape}; it must be a row of at least one number").tag(
            "wrong_shape", shape=str(y.shape)
        )
    require_finite("response", y)
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
    require_finite("predictors", X)
    return X


def require_finite(name: str, values: FloatArray) -> None:
    """Raise `ParameterError` with the position of the first value that is not a finite number."""
    bad = ~np.isfinite(values)
    if np.any(bad):
        place = tuple(int(i) for i in np.argwhere(bad)[0])
        raise ParameterError("{name}{place} is {value}; only finite numbers can be fitted: remove such rows").tag(
            "not_a_number", name=name, place=place, value=values[place]
        )


def centre(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shift columns (n, ...) by their means; a column that is constant but for rounding becomes exactly zero."""
    middle = values.mean(axis=0)
    shifted = values - middle
    still = np.max(np.abs(shifted), axis=0) <= _ROUNDING * np.max(np.abs(values), axis=0)
    return np.where(still, 0.0, shifted), middle


def standardised(predictors: FloatArray, *, intercept: bool) -> Columns:
    """Divide predictors (n, k) by their root mean square; with an intercept centre them first and put ones before."""
    n, k = predictors.shape
    shifted, middle = centre(predictors) if intercept and k else (predictors, np.zeros(k))
    length = np.sqrt(np.mean(shifted**2, axis=0)) if k else np.zeros(0)
    unit = np.where(length > 0, length, 1.0)
    back = np.diag(1.0 / unit)
    scaled = shifted / unit
    names = tuple(f"predictor {j + 1}" for j in range(k))
    if not intercept:
        return Columns(scaled, back, names)
    top = np.concatenate(([1.0], -middle / unit))
    back = np.vstack((top, np.hstack((np.zeros((k, 1)), back))))
    return Columns(np.hstack((np.ones((n, 1)), scaled)), back, ("intercept", *names))


def pivoted_qr(columns: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Q (n, m), R (m, p) and the order of the columns, m = min(n, p), with columns[:, order] = Q R."""
    Q, R, order = qr(columns, mode="economic", pivoting=True)
    return np.asarray(Q, dtype=float), np.asarray(R, dtype=float), np.asarray(order, dtype=np.int64)


def rank_of(triangle: FloatArray, n: int) -> int:
    """Numerical rank from the triangle of a factorisation with column exchange."""
    diagonal = np.abs(np.diag(triangle))
    if diagonal.size == 0 or diagonal[0] == 0:
        return 0
    return int(np.sum(diagonal > max(n, triangle.shape[1]) * _EPS * diagonal[0]))


def independent_columns(scaled: FloatArray) -> list[int]:
    """Indices, ascending, of columns that span all of them and are independent of each other."""
    _, R, order = pivoted_qr(scaled)
    return sorted(order[: rank_of(R, len(scaled))].tolist())


def factorise(columns: Columns) -> Factorisation:
    """Factorise a design of full rank."""
    n, p = columns.scaled.shape
    if n < p:
        raise FitError("{n} observations cannot determine {p} coefficients; at least {p} are needed").tag(
            "too_few_data", n=n, p=p
        )
    Q, R, order = pivoted_qr(columns.scaled)
    rank = rank_of(R, n)
    if rank < p:
        raise FitError(_dependence_problem(columns.names, order[rank:].tolist(), rank)).tag("rank_deficient")
    inverse = np.empty((p, p))
    inverse[order] = solve_triangular(R, np.eye(p))
    return Factorisation(Q, columns.back @ inverse, columns.scaled, columns.back, inverse)


def warn_if_ill_conditioned(columns: FloatArray) -> None:
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


class Spread(TypedDict):
    """Statistics of a least-squares fit with n_parameters coefficients and n residuals."""

    n: int
    n_parameters: int
    coefficients: FloatArray
    standard_errors: FloatArray
    intervals: FloatArray
    covariance: FloatArray
    residuals: FloatArray
    sse: float
    rmse: float
    rmse_dof: float


def spread(coefficients: FloatArray, residuals: FloatArray, design: Factorisation, confidence: float) -> Spread:
    """Errors of the coefficients from the scatter of the residuals; NaN where no degree of freedom is left."""
    n, p = len(residuals), len(coefficients)
    sse = float(residuals @ residuals)
    variance = sse / (n - p) if n > p else float("nan")
    errors = np.sqrt(variance) * np.linalg.norm(design.loadings, axis=1)
    half = expanded_factor(float(n - p), confidence) * errors
    return Spread(
        n=n,
        n_parameters=p,
        coefficients=coefficients,
        standard_errors=errors,
        intervals=np.stack((coefficients - half, coefficients + half), axis=-1),
        covariance=variance * design.loadings @ design.loadings.T,
        residuals=residuals,
        sse=sse,
        rmse=float(np.sqrt(sse / n)),
        rmse_dof=float(np.sqrt(variance)),
    )


def _dependence_problem(names: Sequence[str], dependent: list[int], rank: int) -> Message:
    return Message(
        "the data determine only {rank} of {count} coefficients: {names} does not vary or follows from the other "
        "columns; remove it, or measure at more settings of it",
        rank=rank,
        count=len(names),
        names=[names[j] for j in sorted(dependent)],
    )
