"""Bootstrap: how often each unit is drawn, and intervals from the resampled results.

A unit is a whole experiment, drawn independently, and not one of its readings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._support.errors import ParameterError
from .combined_uncertainty import require_confidence

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

    from .._support.arrays import FloatArray


_BEYOND = 1e300
"""Stands for an unknown sample; a quantile between it and any other number is still far beyond all numbers in use."""
_DRAWS_AT_ONCE = 2**18
"""Draws of one chunk, some MB: what stays in the processor's cache."""


def resampling_counts(
    n_units: int, n_resamples: int, rng: np.random.Generator, *, chunk: int | None = None
) -> Iterator[FloatArray]:
    """Draw bootstrap resamples: n units from n units with replacement, as counts.

    Parameters
    ----------
    n_units
        Units, and draws in each resample, ≥ 1.
    n_resamples
        Resamples in all, ≥ 0.
    rng
        Source of random numbers; the counts depend only on its state, not on ``chunk``.
    chunk
        Resamples in each array (default: some MB).

    Yields
    ------
    array
        Shape (b, n_units), b ≤ chunk: number of draws of each unit; every row sums to n_units. Floats, for the product
        with the units' contributions: ``counts @ contributions``.

    Examples
    --------
    >>> rows = np.vstack(list(resampling_counts(5, 3, np.random.default_rng(1))))
    >>> rows.shape, rows.sum(axis=1).tolist()
    ((3, 5), [5.0, 5.0, 5.0])
    """
    if n_units < 1 or n_resamples < 0 or (chunk is not None and chunk < 1):
        raise ParameterError(
            "n_units = {n_units}, n_resamples = {n_resamples}, chunk = {chunk}; at least 1, 0 and 1 are needed",
            code="out_of_range",
            n_units=n_units,
            n_resamples=n_resamples,
            chunk=chunk,
        )
    return _drawn(n_units, n_resamples, rng, chunk or max(1, _DRAWS_AT_ONCE // n_units))


def _drawn(n_units: int, n_resamples: int, rng: np.random.Generator, chunk: int) -> Iterator[FloatArray]:
    for start in range(0, n_resamples, chunk):
        b = min(chunk, n_resamples - start)
        # 64-bit integers: narrower ones are drawn in words whose rest is thrown away at the end of each call, and the
        # sequence would depend on the chunk
        drawn = rng.integers(0, n_units, size=(b, n_units), dtype=np.int64)
        if b > 1:
            drawn += np.arange(b, dtype=np.int64)[:, None] * n_units
        yield np.bincount(drawn.ravel(), minlength=b * n_units).reshape(b, n_units).astype(float)


def percentile_interval(samples: npt.ArrayLike, *, confidence: float = 0.95) -> FloatArray:
    """Percentile interval of resampled results: the quantiles (1 ± confidence)/2 over the first axis.

    Parameters
    ----------
    samples
        Shape (B, ...), one entry for each resample.
    confidence
        Between 0 and 1.

    Returns
    -------
    array
        Low and high, shape (..., 2). A NaN is a resample without a result. Its value is unknown, so it counts as below
        everything for the low end and above everything for the high end. If an end would be such a sample, both ends
        are NaN. NaN for B = 0.

    Notes
    -----
    Quantiles are linear between order statistics (type 7 of Hyndman and Fan, 1996).

    Examples
    --------
    >>> percentile_interval(np.arange(101.0), confidence=0.9).round(9).tolist()
    [5.0, 95.0]
    """
    require_confidence(confidence)
    values = np.asarray(samples, dtype=float)
    if values.ndim == 0:
        raise ParameterError("samples must have at least one axis, that of the resamples", code="wrong_shape")
    if len(values) == 0:
        return np.full((*values.shape[1:], 2), np.nan)
    tail = 0.5 * (1.0 - confidence)
    unknown = np.isnan(values)
    low = np.quantile(np.where(unknown, -_BEYOND, values), tail, axis=0)
    high = np.quantile(np.where(unknown, _BEYOND, values), 1.0 - tail, axis=0)
    bounds = np.stack((low, high), axis=-1)
    reached = np.any(np.abs(bounds) > _BEYOND * 1e-6, axis=-1, keepdims=True)
    return np.where(reached, np.nan, bounds)
