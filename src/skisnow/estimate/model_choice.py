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
from ..statistics.nested import nested_f_test
from ..statistics.resampling import percentile_interval, resampling_counts
from .hardness import DEFINITIONS
from .models import MODELS, NESTED_PAIRS, EndBasis, Model, ModelFit, end_basis

if TYPE_CHECKING:
    from collections.abc import Callable

    from .readings import Readings

FloatArray = npt.NDArray[np.float64]
_UPPER = np.triu_indices(4)
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
    bases = {symbol: end_basis(readings, hardnesses[symbol]) for symbol in DEFINITIONS}
    groups: dict[str, list[Model]] = {}
    for model in MODELS:
        if model.n_parameters:
            groups.setdefault(model.id if weights else model.hardness, []).append(model)
    products = [
        _cross_products(readings, bases[members[0].hardness], weights[members[0]] if weights else None)
        for members in groups.values()
    ]
    stacked = _in_groups(np.hstack(products), rng)
    width = products[0].shape[1]
    samples: dict[Model, list[FloatArray]] = {model: [] for members in groups.values() for model in members}
    done = 0
    for counts in resampling_counts(len(stacked), n_resamples, rng):
        totals = counts @ stacked
        for index, members in enumerate(groups.values()):
            part = totals[:, index * width : (index + 1) * width]
            for model in members:
                samples[model].append(_resampled_coefficients(bases[model.hardness], model, part))
        done += len(counts)
        if progress:
            progress(f"bootstrap of the model table: {done} of {n_resamples} resamples")
    return {model: percentile_interval(np.vstack(drawn)) for model, drawn in samples.items()}


def _in_groups(products: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Sum the experiments' products over random groups of equal size (± 1) where there are very many experiments."""
    m = len(products)
    if m <= MOST_UNITS:
        return products
    shuffled = products[rng.permutation(m)]
    return np.add.reduceat(shuffled, np.arange(MOST_UNITS) * m // MOST_UNITS, axis=0)


def _cross_products(readings: Readings, basis: EndBasis, weights: FloatArray | None) -> FloatArray:
    """(m, 14): the upper triangle of XᵀX and XᵀF of each series."""
    X, F = basis.columns, readings.load
    W = X if weights is None else X * weights[:, None]
    rows = [readings.sums(W[:, i] * X[:, j]) for i, j in zip(*_UPPER, strict=True)]
    rows += [readings.sums(W[:, i] * F) for i in range(4)]
    return np.stack(rows, axis=1)


def _resampled_coefficients(basis: EndBasis, model: Model, totals: FloatArray) -> FloatArray:
    gram = np.empty((len(totals), 4, 4))
    gram[:, _UPPER[0], _UPPER[1]] = totals[:, :10]
    gram[:, _UPPER[1], _UPPER[0]] = totals[:, :10]
    projection = basis.projection(model)
    fitted = non_negative_fits(projection.T @ gram @ projection, totals[:, 10:] @ projection)
    return basis.coefficients(fitted @ projection.T + basis.offset(model))
