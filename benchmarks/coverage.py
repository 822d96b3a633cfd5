"""Bias and coverage of the coefficients b of the paper's rows over simulated campaigns: ``python -m
benchmarks.coverage``.

The intervals are the bootstrap intervals of the model table. Writes a table of docs/validation/reference-campaign.md.
Intervals of each series are in ``benchmarks.campaign_intervals``.
"""

from __future__ import annotations

import argparse
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from benchmarks.campaign_intervals import HALF_AS_MUCH_AGAIN
from benchmarks.page_tables import write_tables
from skisnow.campaign import ReferenceNoise, reference_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.model_choice import bootstrap_intervals
from skisnow.estimation.models import Model, fit_models
from skisnow.estimation.readings import readings_of
from skisnow.estimation.screening import screened_penetration

STATED = ReferenceNoise()
CONDITIONS = {
    "all stated errors": STATED,
    "H +50 % over the depth": replace(STATED, layering_mean=HALF_AS_MUCH_AGAIN, layering_sd=0.0),
    "no layering": replace(STATED, layering_sd=0.0),
    "no layering, no seating": replace(STATED, layering_sd=0.0, seating_sd=0.0),
}
ANGLE_ROW = Model("H_V", "none", "linear")
CONSTANT_ROW = Model("H_V", "none", "constant")
TRUE_COEFFICIENTS = {
    "b (constant)": (CONSTANT_ROW, 2, 1.0),
    "b₀": (ANGLE_ROW, 2, 1.0),
    "b₁ (1/rad)": (ANGLE_ROW, 3, 0.0),
}
N_RESAMPLES = 1000
FIRST_SEED = 500_000
"""Apart from the seeds of the other studies and of the tests."""


class Outcome(NamedTuple):
    """Error of a coefficient, and whether its interval contains the truth."""

    error: float
    inside: bool


def simulate(seed: int, noise: ReferenceNoise) -> dict[str, Outcome]:
    """The coefficients of one campaign."""
    reference = reference_campaign(seed, noise=noise)
    campaign = reference.campaign()
    used = screened_penetration(campaign, geometry="extended").used
    readings = readings_of(reference.penetration, campaign.tools, geometry="extended").of(used)
    by_last = {symbol: hardness_at_largest_load(readings, each) for symbol, each in DEFINITIONS.items()}
    fits = {fit.model: fit for fit in fit_models(readings, by_last)}
    intervals = bootstrap_intervals(readings, by_last, np.random.default_rng(seed), n_resamples=N_RESAMPLES)
    outcomes = {}
    for name, (model, index, truth) in TRUE_COEFFICIENTS.items():
        fit = fits[model]
        low, high = intervals[model][index].tolist()
        outcomes[name] = Outcome((fit.a0, fit.a1, fit.b0, fit.b1)[index] - truth, low <= truth <= high)
    return outcomes


def table(condition: str, outcomes: list[dict[str, Outcome]]) -> list[str]:
    """Rows of one condition."""
    rows = []
    for name in TRUE_COEFFICIENTS:
        error, inside = np.array([outcome[name] for outcome in outcomes], dtype=float).T
        rms = np.sqrt(np.mean(error**2))
        rows.append(f"| {condition} | {name} | {error.mean():+.4f} | {rms:.4f} | {100 * inside.mean():.1f} % |")
    return rows


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coverage")
    parser.add_argument("--campaigns", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    lines = ["| errors in the data | coefficient | mean error | rms error | coverage of 95 % |"]
    lines.append("| --- | --- | ---: | ---: | ---: |")
    start = time.monotonic()
    with ProcessPoolExecutor(options.workers) as pool:
        for condition, noise in CONDITIONS.items():
            outcomes = list(
                pool.map(partial(simulate, noise=noise), range(FIRST_SEED, FIRST_SEED + options.campaigns), chunksize=5)
            )
            lines += table(condition, outcomes)
            print(f"{condition}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    write_tables("validation/reference-campaign", {"coefficients": lines})


if __name__ == "__main__":
    main()
