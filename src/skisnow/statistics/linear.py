"""Linear least squares with intervals, R², F and p, for independent errors and for clusters; shares of variance.

Holds the certified digits of the NIST sets Norris and Longley.

Observations in clusters, such as tests at a few sites: bias-reduced covariance CR2 (Bell and McCaffrey, 2002, Survey
Methodology 28, 169-181) with Satterthwaite degrees of freedom for each coefficient (the same; Imbens and Kolesár, 2016,
Rev. Econ. Stat. 98, 701-712).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import fdtrc

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .._support.units import CONFIDENCE, ShownFields
from .combined_uncertainty import expanded_factor
from .f_tests import f_ratio
from .least_squares import LeastSquares, solve_least_squares


@dataclass(frozen=True, repr=False)
class LinearFit(ShownFields):
    """Result of a linear least-squares fit.

    Attributes
    ----------
    n, n_parameters
        Observations n, coefficients p with the intercept.
    coefficients, standard_errors
        Shape (p,), the intercept first.
    intervals
        Shape (p, 2): low and high, by Student's t with n - p degrees of freedom.
    residuals
        Observed minus fitted, shape (n,).
    sse, rmse, rmse_dof
        Sum of squared residuals; its root mean over n; its root mean over n - p (MATLAB's).
    r2
        1 - SSE / sum of squares about the mean; NaN where the response does not vary.
    F, p
        F test against the intercept-only model, p the chance of an F as large; NaN without a predictor, and for n = p.

    Results that need n > p are NaN for n = p: standard_errors, intervals, rmse_dof, F, p.
    """

    n: int
    n_parameters: int
    coefficients: FloatArray
    standard_errors: FloatArray
    intervals: FloatArray
    residuals: FloatArray
    sse: float
    rmse: float
    rmse_dof: float
    r2: float
    F: float
    p: float


def linear_fit(response: npt.ArrayLike, predictors: npt.ArrayLike) -> LinearFit:
    """Fit response = b0 + b1 x1 + … + bk xk + error by least squares.

    response: Shape (n,).
    predictors: x, shape (n, k) or (n,), without a column of ones; (n, 0) fits the mean.
    Raises ParameterError: if shapes do not fit or a value is not finite.
    Raises FitError: if n < p, or a predictor does not vary or follows from the others.
    Warns FitWarning: if the condition number of the centred and scaled predictors is above 1,000: the coefficients lose
        digits.

    Notes
    -----
    Columns are centred and scaled and factorised as QR; no normal equations.

    Examples
    --------
    Through (0, 1), (1, 3), (2, 4), by hand: slope 3/2, intercept 7/6, SSE 1/6.

    >>> fit = linear_fit([1.0, 3.0, 4.0], [0.0, 1.0, 2.0])
    >>> [round(float(b), 12) for b in fit.coefficients], round(fit.sse, 12)
    ([1.166666666667, 1.5], 0.166666666667)
    """
    solved = solve_least_squares(response, predictors)
    coefficients, residuals = solved.coefficients, solved.residuals
    n, p = solved.orthogonal.shape
    sse = float(residuals @ residuals)
    rmse_dof = float(np.sqrt(sse / (n - p))) if n > p else float("nan")
    errors = rmse_dof * np.linalg.norm(solved.loadings, axis=1)
    half = expanded_factor(float(n - p), CONFIDENCE) * errors
    r2, F, tail = _explained(solved.shifted, residuals, p)
    return LinearFit(
        n=n,
        n_parameters=p,
        coefficients=coefficients,
        standard_errors=errors,
        intervals=np.stack((coefficients - half, coefficients + half), axis=-1),
        residuals=residuals,
        sse=sse,
        rmse=float(np.sqrt(sse / n)),
        rmse_dof=rmse_dof,
        r2=r2,
        F=F,
        p=tail,
    )


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
    return r2, F, float(fdtrc(p - 1, n - p, F))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VarianceShares(ShownFields):
    """Shares of an output's variance.

    share: Shape (k,), 0 to 1: share of an input, as its linear effect.
    interval: Shape (k, 2).
    left: Share of no single input: curvature and interaction of inputs.
    """

    share: FloatArray
    interval: FloatArray
    left: float


def variance_shares(output: npt.ArrayLike, inputs: npt.ArrayLike) -> VarianceShares:
    """First-order Sobol shares of independent inputs, as far as the output follows them in proportion.

    output: Shape (n,).
    inputs: Drawn independently of each other, shape (n, k), n ≥ k + 2; each varies.
    Returns: b² Var(x)/Var(y) of the linear regression, minus the value that noise alone would give (the squared
        standard error instead of 0), and not below 0; intervals from those of b by Student's t. All 0 if the output
        does not vary.
    Raises ParameterError, FitError: as of `linear_fit`.

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
    fit = linear_fit(y, x)
    scale = x.var(axis=0) / y.var()
    slope, error, ends = fit.coefficients[1:], fit.standard_errors[1:], fit.intervals[1:]
    low, high = np.sort(ends**2, axis=1).T
    low = np.where(ends[:, 0] * ends[:, 1] <= 0.0, 0.0, low)
    return VarianceShares(
        share=np.clip((slope**2 - error**2) * scale, 0.0, 1.0),
        interval=np.clip(np.stack([low * scale, high * scale], axis=1), 0.0, 1.0),
        left=1.0 - fit.r2,
    )


_WHOLLY = 1e-9
"""A direction of which a cluster holds all but this share is known only from that cluster."""


@dataclass(frozen=True)
class ClusterIntervals:
    """Result of `cluster_intervals`; p coefficients, the intercept first.

    intervals, standard_errors, degrees_of_freedom: Shapes (p, 2), (p,), (p,). NaN for a coefficient that not at least
        two clusters determine.
    n_clusters: Number of different clusters.
    coefficients: Least-squares estimates, shape (p,).
    """

    intervals: FloatArray
    standard_errors: FloatArray
    degrees_of_freedom: FloatArray
    n_clusters: int
    coefficients: FloatArray


def cluster_intervals(response: npt.ArrayLike, predictors: npt.ArrayLike, clusters: npt.ArrayLike) -> ClusterIntervals:
    """Least-squares fit with intervals that account for the clusters.

    Errors may depend on each other in any way within a cluster; the clusters are independent.

    response, predictors: As in `linear_fit`.
    clusters: Name or number of the cluster of each observation, shape (n,).
    Raises ParameterError, FitError: as `linear_fit`.
    Warns FitWarning: as `linear_fit`.

    Notes
    -----
    Intervals are NaN with fewer than two clusters, for n ≤ p, and for a coefficient that is lost without one of the
    clusters: its scatter between clusters is then unknown.

    A_g = (I - H_gg)^-½ of each cluster is needed only between its rows Q_g of Q, where it is the p × p matrix
    (I - Q_gᵀQ_g)^-½: the cost is n p², however large a cluster is. The degrees of freedom are those for independent
    errors of one variance (Bell and McCaffrey's choice); with few clusters they are far below n - p.

    Examples
    --------
    Two tests at each of three sites, mean alone: as the three site means 1, 2, 6 would have it, 3 ± t₂ √(7/3).

    >>> found = cluster_intervals([0, 2, 1, 3, 5, 7], np.empty((6, 0)), ["a", "a", "b", "b", "c", "c"])
    >>> round(float(found.standard_errors[0]) ** 2 * 3, 9), round(float(found.degrees_of_freedom[0]), 9)
    (7.0, 2.0)
    """
    labels = np.asarray(clusters)
    if labels.shape != np.shape(response):
        raise ParameterError("clusters have shape {shape}; one of them is needed for each of {n_y} responses").tag(
            "wrong_shape", shape=str(labels.shape), n_y=np.size(response)
        )
    names, cluster = np.unique(labels, return_inverse=True)
    fit = solve_least_squares(response, predictors)
    errors, dof = _bias_reduced(fit, cluster, len(names))
    half = expanded_factor(dof, CONFIDENCE) * errors
    intervals = np.stack((fit.coefficients - half, fit.coefficients + half), axis=-1)
    return ClusterIntervals(intervals, errors, dof, len(names), fit.coefficients)


def _bias_reduced(fit: LeastSquares, cluster: npt.NDArray[np.intp], G: int) -> tuple[FloatArray, FloatArray]:
    """Bias-reduced standard errors (p,) from the clusters, and their degrees of freedom; NaN if undetermined.

    With one cluster, or n = p, an eigenvector of eigenvalue 1 takes part in each coefficient: all are NaN.
    """
    Q = fit.orthogonal
    share = _cluster_sums(Q[:, :, None] * Q[:, None, :], cluster, G)
    value, vector = np.linalg.eigh(share)
    left = 1.0 - value
    alone = left < _WHOLLY
    root = np.where(alone, 0.0, 1.0 / np.sqrt(np.where(alone, 1.0, left)))
    adjust = (vector * root[:, None, :]) @ np.swapaxes(vector, 1, 2)
    score = np.einsum("gij,gj->gi", adjust, _cluster_sums(Q * fit.residuals[:, None], cluster, G))
    L = fit.loadings
    # coefficients of which a single cluster determines a part
    part = np.abs(np.einsum("jk,gkv->jgv", L, vector)) / np.linalg.norm(L, axis=1)[:, None, None]
    lost: BoolArray = np.any(alone[None] & (part > np.sqrt(_WHOLLY)), axis=(1, 2))
    errors = np.sqrt(np.sum((score @ L.T) ** 2, axis=0))
    dof = np.array([_satterthwaite_degrees(share, adjust, row) for row in L])
    return np.where(lost, np.nan, errors), np.where(lost, np.nan, dof)


def _satterthwaite_degrees(share: FloatArray, adjust: FloatArray, row: FloatArray) -> float:
    """Degrees of freedom by Satterthwaite: (tr M)²/tr(M²), M_gh = a_gᵀ(I - H)_gh a_h, a_g = A_g Q_g l for β = lᵀ Qᵀy.

    The diagonal of M is lᵀ S_g l, S_g = Q_gᵀQ_g; the other elements are -P_gᵀP_h with P_g = S_g (I - S_g)^-½ l.
    """
    diagonal = np.einsum("i,gij,j->g", row, share, row)
    P = np.einsum("gij,gj->gi", share, adjust @ row)
    beside = float(np.sum((P.T @ P) ** 2) - np.sum(np.sum(P**2, axis=1) ** 2))
    squares = float(diagonal @ diagonal) + max(beside, 0.0)
    return float(diagonal.sum() ** 2 / squares)


def _cluster_sums(values: FloatArray, cluster: npt.NDArray[np.intp], G: int) -> FloatArray:
    """Sum rows (n, ...) by cluster to (G, ...)."""
    flat = values.reshape(len(values), -1)
    sums = np.empty((G, flat.shape[1]))
    for j in range(flat.shape[1]):
        sums[:, j] = np.bincount(cluster, weights=flat[:, j], minlength=G)
    return sums.reshape(G, *values.shape[1:])
