"""Intervals of a regression whose observations come in clusters, such as tests at a few sites.

Bias-reduced covariance CR2 (Bell and McCaffrey, 2002, Survey Methodology 28, 169-181) with Satterthwaite degrees of
freedom for each coefficient (the same; Imbens and Kolesár, 2016, Rev. Econ. Stat. 98, 701-712).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .._support.units import CONFIDENCE
from .combined_uncertainty import expanded_factor
from .least_squares import LeastSquares, solve_least_squares

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
    n, p = fit.orthogonal.shape
    errors, dof = np.full(p, np.nan), np.full(p, np.nan)
    if len(names) > 1 and n > p:
        errors, dof = _bias_reduced(fit, cluster, len(names))
    half = expanded_factor(dof, CONFIDENCE) * errors
    intervals = np.stack((fit.coefficients - half, fit.coefficients + half), axis=-1)
    return ClusterIntervals(intervals, errors, dof, len(names), fit.coefficients)


def _bias_reduced(fit: LeastSquares, cluster: npt.NDArray[np.intp], G: int) -> tuple[FloatArray, FloatArray]:
    """Standard errors and degrees of freedom; in the coordinates of Q, where XᵀX is one."""
    Q = fit.orthogonal
    share = _cluster_sums(Q[:, :, None] * Q[:, None, :], cluster, G)
    value, vector = np.linalg.eigh(share)
    left = 1.0 - value
    alone = left < _WHOLLY
    root = np.where(alone, 0.0, 1.0 / np.sqrt(np.where(alone, 1.0, left)))
    adjust = (vector * root[:, None, :]) @ np.swapaxes(vector, 1, 2)
    score = np.einsum("gij,gj->gi", adjust, _cluster_sums(Q * fit.residuals[:, None], cluster, G))
    L = fit.loadings
    lost = _determined_by_one(L, vector, alone)
    errors = np.sqrt(np.sum((score @ L.T) ** 2, axis=0))
    dof = np.array([_satterthwaite_degrees(share, adjust, row) for row in L])
    return np.where(lost, np.nan, errors), np.where(lost, np.nan, dof)


def _determined_by_one(L: FloatArray, vector: FloatArray, alone: BoolArray) -> BoolArray:
    """True for coefficients of which a single cluster determines a part."""
    part = np.abs(np.einsum("jk,gkv->jgv", L, vector)) / np.linalg.norm(L, axis=1)[:, None, None]
    held: BoolArray = np.any(alone[None] & (part > np.sqrt(_WHOLLY)), axis=(1, 2))
    return held


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
