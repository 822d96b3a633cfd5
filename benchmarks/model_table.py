"""The nine-row table and its bootstrap on a campaign of the paper's size, beside statsmodels and SciPy."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scipy.optimize
import statsmodels.api as sm

from skisnow.campaign import read_campaign, write_reference
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.model_choice import bootstrap_intervals
from skisnow.estimation.models import MODELS, end_basis, fit_models
from skisnow.estimation.readings import Readings, readings_of
from skisnow.estimation.screening import screened_penetration

from .timing import Measurement, in_turn, timed

RESAMPLES = 10_000


def reference_readings() -> tuple[Readings, dict[str, np.ndarray]]:
    with tempfile.TemporaryDirectory() as folder:
        write_reference(Path(folder) / "campaign", seed=1)
        campaign = read_campaign(Path(folder) / "campaign")
    assert campaign.penetration is not None
    used = screened_penetration(campaign, geometry="extended").used
    readings = readings_of(campaign.penetration, campaign.tools, geometry="extended").of(used)
    return readings, {symbol: hardness_at_largest_load(readings, d) for symbol, d in DEFINITIONS.items()}


def measure() -> Iterator[Measurement]:
    readings, hardnesses = reference_readings()
    designs = [(end_basis(readings, hardnesses[m.hardness]), m) for m in MODELS if m.n_parameters]
    matrices = [basis.columns @ basis.projection(model) for basis, model in designs]

    def ours() -> None:
        fit_models(readings, hardnesses)

    def with_statsmodels() -> None:
        for matrix in matrices:
            sm.OLS(readings.load, matrix).fit().params  # noqa: B018

    def with_scipy() -> None:
        for matrix in matrices:
            scipy.optimize.nnls(matrix, readings.load)

    mine, peer = in_turn(ours, with_statsmodels)
    size = f"{readings.n_series} x 7"
    yield Measurement(f"nine-row table, {size}", mine, "< 10 ms", "statsmodels OLS, unbounded", peer / mine)
    mine, peer = in_turn(ours, with_scipy)
    yield Measurement(f"nine-row table, {size}", mine, "< 10 ms", "scipy nnls", peer / mine)

    def bootstrap() -> None:
        bootstrap_intervals(readings, hardnesses, np.random.default_rng(1), n_resamples=RESAMPLES)

    def naive_share() -> None:
        """One hundredth of the same bootstrap as one would write it: draw rows, fit each row by scipy's nnls."""
        rng = np.random.default_rng(1)
        for _ in range(RESAMPLES // 100):
            drawn = rng.integers(0, readings.n_series, readings.n_series)
            rows = np.concatenate([np.arange(readings.first[i], readings.first[i + 1]) for i in drawn])
            for matrix in matrices:
                scipy.optimize.nnls(matrix[rows], readings.load[rows])

    mine = statistics.median(timed(bootstrap) for _ in range(5))
    peer = 100.0 * timed(naive_share)
    yield Measurement(f"{RESAMPLES} resamples of the whole table", mine, "< 2 s", "scipy nnls in a loop", peer / mine)
