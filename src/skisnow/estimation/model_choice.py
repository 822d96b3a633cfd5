"""Tests between nested rows and bootstrap intervals of the coefficients.

The seven readings of a series share one H, so they are not independent, and for a coefficient at its bound the F
distribution is not valid. The F tests are therefore given as in the paper, next to the effect size and intervals from a
bootstrap that draws whole experiments.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from ..statistics.bounded import non_negative_fits
from ..statistics.combined_uncertainty import percentile_interval, resampling_counts
from ..statistics.f_tests import nested_f_test
from .hardness import DEFINITIONS
from .models import MODELS, NESTED_PAIRS, EndBasis, Model, ModelFit, end_basis
from .readings import Readings

MINIMUM_DETERMINANT: Final = 1e-12
"""Smallest determinant of a normal matrix of columns of length one: below it, rounding alone determines some
combination of coefficients."""
EQUAL_PERCENT: Final = 1e-9
"""Rows whose rmse differ by no more (in percent) are equal."""
MOST_UNITS: Final = 5000
"""Experiments, or groups of them, that the bootstrap draws."""
_PAIRS: Final = np.triu_indices(4)


@dataclass(frozen=True, slots=True)
class NestedRows:
    """F test of a reduced model against a full one; F and p are NaN between equal models."""

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
    rows = []
    for full, reduced in ((by_model[full], by_model[reduced]) for full, reduced in NESTED_PAIRS):
        parameters = {"n_parameters_full": full.n_parameters, "n_parameters_reduced": reduced.n_parameters}
        test = nested_f_test(full.sse, reduced.sse, n=full.n, **parameters)
        change = 100.0 * (reduced.rmse / full.rmse - 1.0) if full.rmse > 0 else float("nan")
        if abs(change) <= EQUAL_PERCENT:
            change = 0.0  # rows that repeat each other differ by rounding alone
        bounded = bool(full.at_bound or reduced.at_bound)
        rows.append(NestedRows(full.model, reduced.model, *test, change, not bounded))
    return tuple(rows)


def bootstrap_intervals(
    readings: Readings,
    hardnesses: dict[str, FloatArray],
    rng: np.random.Generator,
    *,
    n_resamples: int,
    progress: Callable[[str], None] | None = None,
) -> dict[Model, FloatArray]:
    """95 % percentile intervals (4, 2) of a0, a1, b0, b1 of each row, drawing whole experiments.

    Each experiment enters only by its 4 × 4 cross products, so a resample costs a few hundred operations. The same
    draws serve all rows. Above ``MOST_UNITS`` experiments, random groups of them are drawn in their place: experiments
    are independent, so groups are too, and their number still is large.
    """
    if readings.n_series < 2:  # one experiment cannot show how experiments differ
        return {model: np.full((4, 2), np.nan) for model in MODELS if model.n_parameters}
    fits = [_HardnessRows.of(readings, symbol, hardnesses[symbol]) for symbol in DEFINITIONS]
    stacked = np.hstack([rows.products for rows in fits])
    if (m := len(stacked)) > MOST_UNITS:  # groups of equal size (± 1)
        stacked = np.add.reduceat(stacked[rng.permutation(m)], np.arange(MOST_UNITS) * m // MOST_UNITS, axis=0)
    samples: dict[Model, list[FloatArray]] = {model: [] for rows in fits for model in rows.models}
    done = 0
    for counts in resampling_counts(len(stacked), n_resamples, rng):
        for rows, totals in zip(fits, np.split(counts @ stacked, len(fits), axis=1), strict=True):
            for model in rows.models:
                samples[model].append(rows.coefficients(model, totals))
        done += len(counts)
        if progress:
            progress(f"bootstrap of the model table: {done} of {n_resamples} resamples")
    return {model: percentile_interval(np.vstack(drawn)) for model, drawn in samples.items()}


@dataclass(frozen=True)
class _HardnessRows:
    """Rows of the model table with one hardness.

    products: for each of m experiments, 10 products of pairs of the four regressors and 4 with the load (m, 14).
    """

    basis: EndBasis
    models: tuple[Model, ...]
    products: FloatArray

    @classmethod
    def of(cls, readings: Readings, symbol: str, hardness: FloatArray) -> _HardnessRows:
        """Rows of models with fitted parameters that use this hardness; `hardness`: its value of each series (SI)."""
        basis = end_basis(readings, hardness)
        X, pairs = basis.columns, zip(*_PAIRS, strict=True)
        sums = [readings.sums(X[:, i] * X[:, j]) for i, j in pairs]
        sums += [readings.sums(column * readings.load) for column in X.T]
        models = tuple(model for model in MODELS if model.n_parameters and model.hardness == symbol)
        return cls(basis, models, np.stack(sums, axis=1))

    def coefficients(self, model: Model, totals: FloatArray) -> FloatArray:
        """Coefficients a0, a1, b0, b1 (B, 4) of B resamples, from their sums (B, 14) of the columns of `products`."""
        rows, columns = _PAIRS
        gram = np.empty((len(totals), 4, 4))
        gram[:, rows, columns] = gram[:, columns, rows] = totals[:, :-4]
        projection = self.basis.projection(model)
        normal = projection.T @ gram @ projection
        fitted = non_negative_fits(normal, totals[:, -4:] @ projection)
        # undetermined: no experiment at one end
        length = np.sqrt(np.einsum("bii->bi", normal))
        scale = np.where(length > 0, length, 1.0)
        determinant = np.linalg.det(normal / scale[:, :, None] / scale[:, None, :])
        fitted[~(length > 0).all(axis=1) | ~(determinant > MINIMUM_DETERMINANT)] = np.nan
        return self.basis.coefficients(fitted @ projection.T + self.basis.offset(model))
