"""Least squares with all coefficients ≥ 0, for the few coefficients of a material law.

The active bounds are those of Lawson and Hanson (1974), *Solving least squares problems*, as `scipy.optimize.nnls`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .least_squares import as_predictors, as_response

MOST_COEFFICIENTS = 6
_DEPENDENT = 1e-13
"""An eigenvalue of a scaled Gram matrix not above this is zero but for rounding."""


class Solved(NamedTuple):
    """Coefficients ≥ 0, exactly 0.0 on the bound, and the rank of the design."""

    coefficients: FloatArray
    rank: int


@dataclass(frozen=True)
class Condensed:
    """Design of p columns and a response, reduced to at most p + 1 rows with the same least squares.

    design: shape (m, p), columns of length one or zero.
    response: shape (m,).
    scale: shape (p,): divisors of the columns.
    n: rows that were condensed.
    """

    design: FloatArray
    response: FloatArray
    scale: FloatArray
    n: int

    def solved(self, projection: FloatArray | None = None, offset: FloatArray | None = None) -> Solved:
        """Minimise ‖design (offset + projection β) - response‖ over β ≥ 0.

        projection: shape (p, q), q from 1 to 6; None: β are the coefficients of the columns themselves.
        offset: shape (p,), coefficients that are given; None: none.

        If columns depend on each other, many β are equally good; one of those with the fewest coefficients above zero
        is returned, and the rank is below their number.
        """
        A, z = self.design * self.scale, self.response
        z = z if offset is None else z - A @ offset
        A = A if projection is None else A @ projection
        _require_few(A.shape[1])
        unit = _lengths(A)
        A = A / unit
        best, _, rank, _ = np.linalg.lstsq(A, z, rcond=max(self.n, A.shape[1]) * np.finfo(float).eps)  # the shortest
        if rank < A.shape[1] or not (best > 0.0).all():
            best = nnls(A, z)[0]
        return Solved(np.asarray(best, dtype=float) / unit, int(rank))


def condensed(design: npt.ArrayLike, response: npt.ArrayLike, *, weights: npt.ArrayLike | None = None) -> Condensed:
    """Factorise a design once for many fits of Σ w (response - design β)² to the same response.

    design: shape (n, p) or (n,), 1 ≤ p ≤ 6; no column is added.
    response: shape (n,).
    weights: w ≥ 0, shape (n,), or None for all one.

    The free fit of y = b1 x + b2 would be b1 = 2, b2 = -1; with b2 held at 0, b1 = (1·1 + 2·3 + 3·5)/(1 + 4 + 9).

    >>> few = condensed([[1, 1], [2, 1], [3, 1]], [1, 3, 5])
    >>> few.solved(np.array([[1.0], [0.0]])).coefficients.round(6).tolist()  # without the column of ones
    [1.571429]
    """
    y = as_response(response)
    A = as_predictors(design, len(y))
    if weights is not None:
        w = np.asarray(weights, dtype=float)
        if w.shape != y.shape or not np.all(np.isfinite(w)) or np.any(w < 0):
            raise ParameterError(
                "weights of shape {shape}; {n} finite numbers ≥ 0 are needed, one for each response"
            ).tag("wrong_shape", shape=str(w.shape), n=len(y))
        A, y = A * np.sqrt(w)[:, None], y * np.sqrt(w)
    unit = _lengths(A)
    few = np.asarray(np.linalg.qr(np.column_stack((A / unit, y)), mode="r"), dtype=float)
    return Condensed(few[:, :-1], few[:, -1], unit, len(y))


def _lengths(A: FloatArray) -> FloatArray:
    """Lengths of the columns, 1 where a length is zero."""
    length = np.linalg.norm(A, axis=0)
    return np.where(length > 0, length, 1.0)


def _require_few(p: int) -> None:
    """Reject a number of coefficients that is not from 1 to the maximum."""
    if not 1 <= p <= MOST_COEFFICIENTS:
        raise ParameterError("{p} coefficients; 1 to {most} are allowed").tag("too_many", p=p, most=MOST_COEFFICIENTS)


def non_negative_fits(gram: npt.ArrayLike, moment: npt.ArrayLike) -> FloatArray:
    """Minimise βᵀ G β - 2 mᵀ β over β ≥ 0 for a whole batch of normal equations.

    gram: G = AᵀA, shape (B, p, p), 1 ≤ p ≤ 6.
    moment: m = Aᵀy, shape (B, p).
    Returns: β, shape (B, p); exactly 0.0 on the bound. NaN for a member that has a value that is not finite. Where G is
        singular, a solution with the fewest coefficients above zero.

    Notes
    -----
    For bootstrap samples, of which only the cross products are known. These hold half the digits of the design; for a
    point estimate use `condensed`.

    Examples
    --------
    >>> non_negative_fits([[[14.0, 6.0], [6.0, 3.0]]], [[22.0, 9.0]]).round(6).tolist()  # the example above
    [[1.571429, 0.0]]
    """
    G, m = np.asarray(gram, dtype=float), np.asarray(moment, dtype=float)
    if m.ndim != 2 or G.shape != (*m.shape, m.shape[1]):
        raise ParameterError("gram has shape {shape}, moment {shape_2}; (B, p, p) and (B, p) are needed").tag(
            "wrong_shape", shape=str(G.shape), shape_2=str(m.shape)
        )
    _require_few(m.shape[1])
    finite = np.isfinite(m).all(axis=1) & np.isfinite(G).all(axis=(1, 2))
    result = np.full(m.shape, np.nan)
    if not np.any(finite):
        return result
    scale = np.sqrt(np.maximum(np.einsum("bii->bi", G[finite]), 0.0))
    unit = np.where(scale > 0, scale, 1.0)
    values, vectors = np.linalg.eigh(G[finite] / (unit[:, :, None] * unit[:, None, :]))
    root = np.sqrt(np.where(values > _DEPENDENT, values, 0.0))
    designs = root[:, :, None] * np.swapaxes(vectors, 1, 2)
    turned = np.einsum("bij,bi->bj", vectors, m[finite] / unit)
    responses = np.divide(turned, root, out=np.zeros_like(turned), where=root > 0.0)
    solutions = [nnls(A, z)[0] for A, z in zip(designs, responses, strict=True)]
    result[finite] = np.array(solutions) / unit
    return result
