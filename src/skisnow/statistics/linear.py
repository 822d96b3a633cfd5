"""Linear least squares with standard errors, intervals, R², F and p; and polynomials of high degree.

Holds the certified digits of the NIST sets Norris and Longley.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import ShownFields
from .combined_uncertainty import require_confidence
from .f_tests import f_ratio, f_tail
from .least_squares import (
    Columns,
    as_predictors,
    as_response,
    centre,
    factorise,
    spread,
    standardised,
    warn_if_ill_conditioned,
)

_CHEBYSHEV_LIMIT: Final = 1e5
"""Limit of the condition number of Chebyshev polynomials: at 3·10⁴ the coefficients of the powers keep 9 digits."""
Polynomial = list[Fraction]
"""Coefficients in ascending powers."""


@dataclass(frozen=True, repr=False)
class LinearFit(ShownFields):
    """Result of a linear least-squares fit.

    Attributes
    ----------
    n, n_parameters, rank
        Observations n, coefficients p (an intercept counted), rank of the design (equal to p).
    coefficients, standard_errors
        Shape (p,), the intercept first.
    intervals
        Shape (p, 2): low and high, by Student's t with n - p degrees of freedom.
    covariance
        Covariance of the coefficients, shape (p, p).
    residuals
        Observed minus fitted, shape (n,).
    sse, rmse, rmse_dof
        Sum of squared residuals; its root mean over n; its root mean over n - p (MATLAB's).
    r2
        1 - SSE / sum of squares about the mean; NaN without an intercept and where the response does not vary.
    F, p
        F test against the intercept-only model, p the chance of an F as large; NaN without an intercept, without a
        predictor, and for n = p.

    Results that need n > p are NaN for n = p: standard_errors, intervals, covariance, rmse_dof, F, p.
    """

    n: int
    n_parameters: int
    rank: int
    coefficients: FloatArray
    standard_errors: FloatArray
    intervals: FloatArray
    covariance: FloatArray
    residuals: FloatArray
    sse: float
    rmse: float
    rmse_dof: float
    r2: float
    F: float
    p: float


def linear_fit(
    response: npt.ArrayLike, predictors: npt.ArrayLike, *, intercept: bool = True, confidence: float = 0.95
) -> LinearFit:
    """Fit response = b0 + b1 x1 + … + bk xk + error by least squares.

    Parameters
    ----------
    response
        Shape (n,).
    predictors
        x, shape (n, k) or (n,), without a column of ones; (n, 0) fits the mean.
    intercept
        Whether b0 is fitted; it is then the first coefficient.
    confidence
        Confidence of the intervals.

    Raises
    ------
    ParameterError
        If shapes do not fit or a value is not finite.
    FitError
        If n < p, or a predictor does not vary or follows from the others.

    Warns
    -----
    FitWarning
        If the condition number of the centred and scaled predictors is above 1,000: the coefficients lose digits.

    Notes
    -----
    Columns are centred and scaled and factorised as QR; no normal equations. Without an intercept R², F and p stay NaN:
    about zero they would answer another question under the same name. `nested_f_test` compares such models.

    Examples
    --------
    Through (0, 1), (1, 3), (2, 4), by hand: slope 3/2, intercept 7/6, SSE 1/6.

    >>> fit = linear_fit([1.0, 3.0, 4.0], [0.0, 1.0, 2.0])
    >>> [round(float(b), 12) for b in fit.coefficients], round(fit.sse, 12)
    ([1.166666666667, 1.5], 0.166666666667)
    """
    require_confidence(confidence)
    y = as_response(response)
    X = as_predictors(predictors, len(y))
    columns = standardised(X, intercept=intercept)
    warn_if_ill_conditioned(columns.scaled)
    return _fit(y, columns, intercept=intercept, confidence=confidence)


def polynomial_fit(x: npt.ArrayLike, y: npt.ArrayLike, degree: int, *, confidence: float = 0.95) -> LinearFit:
    """Fit y = b0 + b1 x + … + b_d x^d + error by least squares; coefficients in ascending powers.

    Parameters
    ----------
    x, y
        Shape (n,).
    degree
        d ≥ 0.

    Returns
    -------
    LinearFit
        As of `linear_fit`, for the powers of x as given.

    Notes
    -----
    The powers of x are nearly dependent columns: raised from -9 … -3 to the tenth they lose all digits of a double.
    The fit is done in Chebyshev polynomials of x shifted and scaled to [-1, 1], and carried back to powers in rational
    arithmetic, which loses nothing.

    Examples
    --------
    >>> fit = polynomial_fit([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 5.0, 10.0], 2)  # 1 + x²
    >>> [abs(round(float(b), 12)) for b in fit.coefficients]
    [1.0, 0.0, 1.0]
    """
    require_confidence(confidence)
    response = as_response(y)
    columns = chebyshev_columns(as_predictors(x, len(response)), degree)
    warn_if_ill_conditioned(columns.scaled, limit=_CHEBYSHEV_LIMIT)
    return _fit(response, columns, intercept=True, confidence=confidence)


def _fit(response: FloatArray, columns: Columns, *, intercept: bool, confidence: float) -> LinearFit:
    design = factorise(columns)
    shifted, middle = centre(response) if intercept else (response, np.zeros(()))
    coefficients, residuals = design.solve(shifted)
    if intercept:
        coefficients[0] += middle
    p = len(coefficients)
    r2, F, tail = _explained(shifted, residuals, p) if intercept else (float("nan"),) * 3
    statistics = spread(coefficients, residuals, design, confidence)
    return LinearFit(**statistics, rank=p, r2=r2, F=F, p=tail)


def _explained(shifted: FloatArray, residuals: FloatArray, p: int) -> tuple[float, float, float]:
    """R² about the mean, F and p against the intercept-only model."""
    n = len(shifted)
    deviations = shifted - shifted.mean()
    total, sse = float(deviations @ deviations), float(residuals @ residuals)
    if total == 0:
        return (float("nan"),) * 3
    r2 = 1.0 - sse / total
    if p == 1 or n <= p:
        return r2, float("nan"), float("nan")
    fitted = shifted - residuals
    # the explained squares from the fitted values: total - sse would lose digits where little is explained
    explained = float(np.sum((fitted - fitted.mean()) ** 2))
    F = f_ratio(explained, p - 1, sse, n - p)
    return r2, F, f_tail(F, p - 1, n - p)


def chebyshev_columns(x: FloatArray, degree: int) -> Columns:
    """T_0(t) … T_d(t) of t = (x - middle)/scale in [-1, 1], for x of shape (n, 1).

    The scale is a power of two and middle has few binary digits, so that t keeps every digit of x.
    """
    if x.shape[1] != 1 or degree < 0:
        raise ParameterError("a polynomial needs one predictor (found {count}) and a degree ≥ 0 (found {degree})").tag(
            "out_of_range", count=x.shape[1], degree=degree
        )
    low, high = float(x.min()), float(x.max())
    scale = 2.0 ** math.ceil(math.log2(high - low) - 1.0) if high > low else 1.0
    middle = round((0.5 * low + 0.5 * high) / scale * 16.0) / 16.0 * scale
    t = (x[:, 0] - middle) / scale
    scaled: FloatArray = np.polynomial.chebyshev.chebvander(t, degree).astype(float)
    back = np.array([[float(c) for c in row] for row in exact_power_basis(degree, middle, scale)])
    return Columns(scaled, back, tuple(f"power {j}" for j in range(degree + 1)))


def exact_power_basis(degree: int, middle: float, scale: float) -> list[list[Fraction]]:
    """Matrix B, B[j][k] = coefficient of x^j in T_k((x - middle)/scale), exactly."""
    t: Polynomial = [Fraction(-middle) / Fraction(scale), 1 / Fraction(scale)]
    basis: list[Polynomial] = [[Fraction(1)], t]
    while len(basis) <= degree:  # T_{k+1} = 2 t T_k - T_{k-1}
        doubled = [2 * c for c in _product(t, basis[-1])]
        older = basis[-2] + [Fraction(0)] * (len(doubled) - len(basis[-2]))
        basis.append([a - b for a, b in zip(doubled, older, strict=True)])
    padded = [p + [Fraction(0)] * (degree + 1 - len(p)) for p in basis[: degree + 1]]
    return [[padded[k][j] for k in range(degree + 1)] for j in range(degree + 1)]


def _product(a: Polynomial, b: Polynomial) -> Polynomial:
    result = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, left in enumerate(a):
        for j, right in enumerate(b):
            result[i + j] += left * right
    return result


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VarianceShares(ShownFields):
    """Shares of an output's variance.

    Attributes
    ----------
    share
        Shape (k,), 0 to 1: share of an input, as its linear effect.
    interval
        Shape (k, 2).
    left
        Share of no single input: curvature and interaction of inputs.
    """

    share: FloatArray
    interval: FloatArray
    left: float


def variance_shares(output: npt.ArrayLike, inputs: npt.ArrayLike, *, confidence: float = 0.95) -> VarianceShares:
    """First-order Sobol shares of independent inputs, as far as the output follows them in proportion.

    Parameters
    ----------
    output
        Shape (n,).
    inputs
        Drawn independently of each other, shape (n, k), n ≥ k + 2; each varies.
    confidence
        Confidence of the intervals.

    Returns
    -------
    VarianceShares
        b² Var(x)/Var(y) of the linear regression, minus the value that noise alone would give (the squared standard
        error instead of 0), and not below 0; intervals from those of b by Student's t. All 0 if the output does not
        vary.

    Raises
    ------
    ParameterError, FitError
        As of `linear_fit`.

    References
    ----------
    Saltelli and others (2008), Global Sensitivity Analysis, The Primer, Wiley, section 1.2.5 (standardised regression
    coefficients).

    Examples
    --------
    y = 2 x₁ + x₂ over a full grid: four fifths and one fifth, exactly.

    >>> shares = variance_shares([-3.0, -1.0, 1.0, 3.0], [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]])
    >>> [round(float(each), 12) for each in shares.share], round(shares.left, 12)
    ([0.8, 0.2], 0.0)
    """
    y, x = np.asarray(output, dtype=float), np.asarray(inputs, dtype=float)
    if len(y) and np.all(y == y[0]):
        nothing = np.zeros(x.shape[1])
        return VarianceShares(nothing, np.zeros((x.shape[1], 2)), 0.0)
    fit = linear_fit(y, x, confidence=confidence)
    scale = x.var(axis=0) / y.var()
    slope, error, ends = fit.coefficients[1:], fit.standard_errors[1:], fit.intervals[1:]
    low, high = np.sort(ends**2, axis=1).T
    low = np.where(ends[:, 0] * ends[:, 1] <= 0.0, 0.0, low)
    return VarianceShares(
        share=np.clip((slope**2 - error**2) * scale, 0.0, 1.0),
        interval=np.clip(np.stack([low * scale, high * scale], axis=1), 0.0, 1.0),
        left=1.0 - fit.r2,
    )
