"""Tests between nested rows and bootstrap intervals of the coefficients.

The seven readings of a series share one H, so they are not independent, and where a coefficient sits on its bound the F
distribution does not hold. The F tests are therefore given as the paper gives them, beside the effect size and
intervals from a bootstrap that draws whole experiments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from ..statistics.bounded import non_negative_fits
from ..statistics.f_tests import nested_f_test
from ..statistics.resampling import percentile_interval, resampling_counts
from .hardness import DEFINITIONS
from .models import MODELS, NESTED_PAIRS, EndBasis, Model, ModelFit, end_basis

if TYPE_CHECKING:
    from collections.abc import Callable

    from .readings import Readings

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
MINIMUM_DETERMINANT: Final = 1e-12
"""Of a normal matrix of columns of length one: below it, some combination of coefficients is free but for rounding."""
EQUAL_PERCENT: Final = 1e-9
"""Rows whose rmse differ by no more (in percent) are equal."""
MOST_UNITS: Final = 5000
"""Experiments, or groups of them, that the bootstrap draws."""


@dataclass(frozen=True, slots=True)
class NestedRows:
    """The F test of a reduced against a full row; F and p are NaN between equal rows."""

    full: Model
    reduced: Model
    F: float
    df1: int
    df2: int
    p: float
    rmse_change_percent: float
    valid_classically: bool


def compare_nested_rows(fits: tuple[ModelFit, ...]) -> tuple[NestedRows, ...]:
    """Compare all nested pairs of one hardness."""
    by_model = {fit.model: fit for fit in fits}
    return tuple(_compare(by_model[full], by_model[reduced]) for full, reduced in NESTED_PAIRS)


def _compare(full: ModelFit, reduced: ModelFit) -> NestedRows:
    test = nested_f_test(
        full.sse,
        reduced.sse,
        n=full.n,
        n_parameters_full=full.n_parameters,
        n_parameters_reduced=reduced.n_parameters,
    )
    change = 100.0 * (reduced.rmse / full.rmse - 1.0) if full.rmse > 0 else float("nan")
    if abs(change) <= EQUAL_PERCENT:
        change = 0.0  # rows that repeat each other differ by rounding alone
    bounded = bool(full.at_bound or reduced.at_bound)
    return NestedRows(full.model, reduced.model, test.F, test.df1, test.df2, test.p, change, not bounded)


def bootstrap_intervals(
    readings: Readings,
    hardnesses: dict[str, FloatArray],
    rng: np.random.Generator,
    *,
    n_resamples: int,
    weights: dict[Model, FloatArray] | None = None,
    progress: Callable[[str], None] | None = None,
) -> dict[Model, FloatArray]:
    """95 % percentile intervals (4, 2) of a0, a1, b0, b1 of each row, drawing whole experiments.

    Each experiment enters by its 4 × 4 cross products alone, so a resample costs a few hundred operations. The same
    draws serve all rows. ``weights`` gives the readings' weights row by row where a fit is weighted. Above
    ``MOST_UNITS`` experiments, random groups of them are drawn in their place: experiments are independent, so groups
    are too, and their number still is large.
    """
    if readings.n_series < 2:  # one experiment cannot show how experiments differ
        return {model: np.full((4, 2), np.nan) for model in MODELS if model.n_parameters}
    groups = _groups(readings, {symbol: end_basis(readings, hardnesses[symbol]) for symbol in DEFINITIONS}, weights)
    products = [group.products for group in groups]
    ends = np.cumsum([part.shape[1] for part in products])[:-1]
    stacked = _in_groups(np.hstack(products), rng)
    samples: dict[Model, list[FloatArray]] = {model: [] for group in groups for model in group.models}
    done = 0
    for counts in resampling_counts(len(stacked), n_resamples, rng):
        for group, totals in zip(groups, np.split(counts @ stacked, ends, axis=1), strict=True):
            for model in group.models:
                samples[model].append(group.coefficients(model, totals))
        done += len(counts)
        if progress:
            progress(f"bootstrap of the model table: {done} of {n_resamples} resamples")
    return {model: percentile_interval(np.vstack(drawn)) for model, drawn in samples.items()}


@dataclass(frozen=True)
class _Group:
    """Rows that share their regressors and weights, with each experiment's cross products of these regressors.

    ``to_ends`` (4, q) makes the four end values from the coefficients of the group's q regressors.
    """

    basis: EndBasis
    models: tuple[Model, ...]
    to_ends: FloatArray
    products: FloatArray

    def coefficients(self, model: Model, totals: FloatArray) -> FloatArray:
        """(B, 4) a0, a1, b0, b1 of B resamples from their summed products (B, q (q + 3)/2)."""
        q = self.to_ends.shape[1]
        rows, columns = np.triu_indices(q)
        gram = np.empty((len(totals), q, q))
        gram[:, rows, columns] = gram[:, columns, rows] = totals[:, :-q]
        within = np.linalg.lstsq(self.to_ends, self.basis.projection(model))[0]
        normal = within.T @ gram @ within
        fitted = non_negative_fits(normal, totals[:, -q:] @ within)
        fitted[_undetermined(normal)] = np.nan
        return self.basis.coefficients(fitted @ self.basis.projection(model).T + self.basis.offset(model))


def _undetermined(normal: FloatArray) -> BoolArray:
    """Which of B normal matrices (B, p, p) leave a coefficient free: no experiment drawn at one end of the angles."""
    length = np.sqrt(np.einsum("bii->bi", normal))
    present = (length > 0).all(axis=1)
    scale = np.where(length > 0, length, 1.0)
    determinant: FloatArray = np.linalg.det(normal / scale[:, :, None] / scale[:, None, :])
    return ~present | ~(determinant > MINIMUM_DETERMINANT)


def _groups(readings: Readings, bases: dict[str, EndBasis], weights: dict[Model, FloatArray] | None) -> list[_Group]:
    """One group a hardness where all readings count alike; one a row, with its own regressors, where they do not."""
    fitted = [model for model in MODELS if model.n_parameters]
    if weights is None:
        shared = {symbol: tuple(model for model in fitted if model.hardness == symbol) for symbol in bases}
        return [_group(readings, bases[symbol], models, np.eye(4), None) for symbol, models in shared.items()]
    return [
        _group(readings, bases[model.hardness], (model,), bases[model.hardness].projection(model), weights[model])
        for model in fitted
    ]


def _group(
    readings: Readings, basis: EndBasis, models: tuple[Model, ...], to_ends: FloatArray, weight: FloatArray | None
) -> _Group:
    X, F = basis.columns @ to_ends, readings.load
    W = X if weight is None else X * weight[:, None]
    pairs = zip(*np.triu_indices(X.shape[1]), strict=True)
    sums = [readings.sums(W[:, i] * X[:, j]) for i, j in pairs] + [readings.sums(column * F) for column in W.T]
    return _Group(basis, models, to_ends, np.stack(sums, axis=1))


def _in_groups(products: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Sum the experiments' products over random groups of equal size (± 1) where there are very many experiments."""
    m = len(products)
    if m <= MOST_UNITS:
        return products
    shuffled = products[rng.permutation(m)]
    return np.add.reduceat(shuffled, np.arange(MOST_UNITS) * m // MOST_UNITS, axis=0)
