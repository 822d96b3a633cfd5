"""Least squares with all coefficients ≥ 0, exact for the few coefficients of a material law.

With at most six coefficients every set of active bounds can be tried. The one that meets the Karush-Kuhn-Tucker
conditions is the answer: coefficients > 0 where free, and for a coefficient on its bound no gain in leaving it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .least_squares import as_predictors, as_response

MOST_COEFFICIENTS = 6
_KKT_TOLERANCE = 1e-12
"""Share of the gradient, for columns of length one: some thousand roundings."""
_DEPENDENT = 1e-13
"""A pivot of a scaled Gram matrix not above this is zero but for rounding."""


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
        best = _best_support(A / unit, z, self.n)
        return Solved(best.coefficients / unit, best.rank)


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
        root = _root_weights(weights, len(y))
        A, y = A * root[:, None], y * root
    unit = _lengths(A)
    few = np.asarray(np.linalg.qr(np.column_stack((A / unit, y)), mode="r"), dtype=float)
    return Condensed(few[:, :-1], few[:, -1], unit, len(y))


def _lengths(A: FloatArray) -> FloatArray:
    """Lengths of the columns, 1 where a length is zero."""
    length = np.linalg.norm(A, axis=0)
    return np.where(length > 0, length, 1.0)


def _require_few(p: int) -> None:
    if not 1 <= p <= MOST_COEFFICIENTS:
        raise ParameterError(
            "{p} coefficients; every set of bounds is tried, which is practical for 1 to 6 of them"
        ).tag("too_many", p=p)


def _root_weights(weights: npt.ArrayLike, n: int) -> FloatArray:
    """Square roots (n,) of the weights, after a check that they are finite and at least 0."""
    w = np.asarray(weights, dtype=float)
    if w.shape != (n,) or not np.all(np.isfinite(w)) or np.any(w < 0):
        raise ParameterError("weights of shape {shape}; {n} finite numbers ≥ 0 are needed, one for each response").tag(
            "wrong_shape", shape=str(w.shape), n=n
        )
    return np.sqrt(w)


@cache
def _supports(p: int) -> tuple[tuple[int, ...], ...]:
    """All sets of free coefficients: the full one first, as the likeliest, then from the smallest up."""
    everything = tuple(range(p))
    return (everything, *(s for size in range(p) for s in combinations(everything, size)))


def _best_support(A: FloatArray, z: FloatArray, n: int) -> Solved:
    """Minimise ‖A x - z‖ over x ≥ 0 for a small A with columns of length one or zero, condensed from n rows."""
    p = A.shape[1]
    free, rank = _least_squares(A, z, n)
    if rank == p and (free > 0.0).all():
        return Solved(free, rank)
    best, least = np.zeros(p), np.inf
    for support in _supports(p)[1:]:
        columns, x = list(support), np.zeros(p)
        if columns:
            solution, own_rank = _least_squares(A[:, columns], z, n)
            if own_rank < len(columns) or not (solution > 0.0).all():  # dependent columns, or beyond the bound
                continue
            x[columns] = solution
        gain = A.T @ (z - A @ x)
        gain[columns] = 0.0
        violation = max(float(np.max(gain, initial=0.0)), 0.0)
        if violation <= _KKT_TOLERANCE * (float(np.linalg.norm(z)) + float(np.sum(x))):
            return Solved(x, rank)
        if violation < least:
            best, least = x, violation
    return Solved(best, rank)


def _least_squares(A: FloatArray, z: FloatArray, n: int) -> tuple[FloatArray, int]:
    """The shortest least-squares solution, and the numerical rank."""
    solution, _, rank, _ = np.linalg.lstsq(A, z, rcond=max(n, A.shape[1]) * np.finfo(float).eps)
    return np.asarray(solution, dtype=float), int(rank)


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
    # the batch goes last: each step below is then one pass over contiguous memory
    G, m = np.moveaxis(G[finite], 0, -1), m[finite].T
    scale = np.sqrt(np.maximum(np.einsum("iib->ib", G), 0.0))
    unit = np.where(scale > 0, scale, 1.0)
    G = np.ascontiguousarray(G / (unit[:, None] * unit[None, :]))
    result[finite] = (_solve_batch(G, m / unit) / unit).T
    return result


def _solve_batch(G: FloatArray, m: FloatArray) -> FloatArray:
    """Solve B problems with G (p, p, B) of unit diagonal and m (p, B); solved ones leave the batch."""
    p, B = m.shape
    best, least = np.zeros((p, B)), np.full(B, np.inf)
    open_ = np.arange(B)
    for support in _supports(p):
        here_G, here_m = G[:, :, open_], m[:, open_]
        x, feasible = _solved_batch(here_G, here_m, support)
        violation = _violation(here_G, here_m, x, support)
        better = feasible & (violation < least[open_])
        best[:, open_[better]] = x[:, better]
        least[open_[better]] = violation[better]
        allowed = _KKT_TOLERANCE * (np.max(np.abs(here_m), axis=0) + np.sum(x, axis=0))
        open_ = open_[~(feasible & (violation <= allowed))]
        if open_.size == 0:
            break
    return best


def _violation(G: FloatArray, m: FloatArray, x: FloatArray, support: tuple[int, ...]) -> FloatArray:
    """Largest decrease (B,) of the objective per unit of a coefficient that the support holds at 0; 0: none."""
    worst = np.zeros(m.shape[1])
    for j in set(range(len(m))) - set(support):
        gain = m[j].copy()
        for k in support:
            gain -= G[j, k] * x[k]
        np.maximum(worst, gain, out=worst)
    return worst


def _solved_batch(G: FloatArray, m: FloatArray, support: tuple[int, ...]) -> tuple[FloatArray, BoolArray]:
    """Solve G x = m on the support by L D Lᵀ; the second result is True where G is regular and all x > 0."""
    x, feasible = np.zeros_like(m), np.ones(m.shape[1], dtype=bool)
    lower: dict[tuple[int, int], FloatArray] = {}
    pivot: dict[int, FloatArray] = {}
    for i, j in ((i, j) for j in support for i in support if i >= j):  # on and below the diagonal, by columns
        earlier = [k for k in support if k < j]
        entry = G[i, j].copy()
        for k in earlier:
            entry -= lower[i, k] * lower[j, k] * pivot[k]
        if i > j:
            lower[i, j] = entry / pivot[j]
        else:
            regular = entry > _DEPENDENT
            feasible &= regular
            pivot[j] = np.where(regular, entry, 1.0)
    for i in support:
        x[i] = m[i]
        for k in (k for k in support if k < i):
            x[i] -= lower[i, k] * x[k]
    for i in reversed(support):
        x[i] /= pivot[i]
        for k in (k for k in support if k > i):
            x[i] -= lower[k, i] * x[k]
        feasible &= x[i] > 0
    x[:, ~feasible] = 0.0
    return x, feasible
