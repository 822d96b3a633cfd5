"""Bias and coverage of the 95 % intervals over simulated campaigns whose truth is known: ``python -m
benchmarks.coverage``.

The paper's procedure (H_V from the last reading, all error in the load) beside the fit with errors in depth and load.
Prints a Markdown table; the table of the documentation is its output for 1,000 campaigns, seeds 0 to 999.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from skisnow.campaign import ReferenceNoise, reference_campaign
from skisnow.campaign.reference import design
from skisnow.estimation.errors_in_depth import fit_models_with_depth_errors, fitted_hardness
from skisnow.estimation.hardness import DEFINITIONS, ReadingUncertainty, hardness, hardness_of_all_readings
from skisnow.estimation.model_choice import bootstrap_intervals
from skisnow.estimation.models import Model, ModelFit, fit_models
from skisnow.estimation.readings import readings_of
from skisnow.estimation.screening import screened_penetration
from skisnow.estimation.seating import seating

FloatArray = npt.NDArray[np.float64]
HALF_AS_MUCH_AGAIN = 2.0 * math.log(1.5) / (math.log(design.LOADS[-1] / design.LOADS[0]) - math.log(1.5))
"""κ for which F/V grows by half from the smallest load to the largest."""
CONDITIONS = {
    "all stated errors": ReferenceNoise(),
    "H +50 % over the depth": ReferenceNoise(layering_mean=HALF_AS_MUCH_AGAIN, layering_sd=0.0),
    "no layering": ReferenceNoise(layering_sd=0.0),
    "no layering, no seating": ReferenceNoise(layering_sd=0.0, seating_sd=0.0),
}
ANGLE_ROW = Model("H_V", "none", "linear")
CONSTANT_ROW = Model("H_V", "none", "constant")
TRUE_COEFFICIENTS = {
    "b (constant)": (CONSTANT_ROW, 2, 1.0),
    "b₀": (ANGLE_ROW, 2, 1.0),
    "b₁ (1/rad)": (ANGLE_ROW, 3, 0.0),
}
N_RESAMPLES = 1000


@dataclass(frozen=True)
class Outcome:
    """One campaign: by (procedure, quantity) the errors and whether each interval covers the truth; of each series,
    whether it is marked as layered, and half the widths of the intervals of ln H_V.
    """

    errors: dict[tuple[str, str], FloatArray]
    covered: dict[tuple[str, str], FloatArray]
    layered: npt.NDArray[np.bool_]
    half_width: FloatArray
    half_width_even: FloatArray


def simulate(seed: int, noise: ReferenceNoise) -> Outcome:
    reference = reference_campaign(seed, noise=noise)
    campaign = reference.campaign()
    assert campaign.penetration is not None
    screened = screened_penetration(campaign, geometry="extended")
    used = screened.used
    readings = readings_of(campaign.penetration, campaign.tools, geometry="extended").of(used)
    uncertainty = ReadingUncertainty(campaign.depth_uncertainty or 0.0, campaign.load_uncertainty or 0.0)
    found = {symbol: hardness(readings, definition, uncertainty) for symbol, definition in DEFINITIONS.items()}
    H, truth = found["H_V"], reference.snow_hardness[used]
    plain = hardness_of_all_readings(readings, DEFINITIONS["H_V"], uncertainty)

    seated = seating(readings, H.value, uncertainty)
    fitted = fitted_hardness(readings, seated, uncertainty)
    errors = {
        ("paper", "H_V"): np.log(H.value / truth),
        ("errors in depth", "H_V"): np.log(fitted.value["H_V"] / truth),
        ("errors in depth, even snow supposed", "H_V"): np.log(seated.hardness / truth),
        ("errors in depth, no offset fitted", "H_V"): np.log(plain.value / truth),
    }
    covered = {
        ("paper", "H_V"): inside(H.interval, truth),
        ("errors in depth", "H_V"): inside(fitted.interval, truth),
        ("errors in depth, even snow supposed", "H_V"): inside(seated.hardness_interval, truth),
        ("errors in depth, no offset fitted", "H_V"): inside(plain.interval, truth),
    }
    by_last = {symbol: h.value for symbol, h in found.items()}
    fits, weights = fit_models_with_depth_errors(fitted, uncertainty)
    rng = np.random.default_rng(seed)
    tables = {
        "paper": (fit_models(readings, by_last), bootstrap_intervals(readings, by_last, rng, n_resamples=N_RESAMPLES)),
        "errors in depth": (
            fits,
            bootstrap_intervals(fitted.readings, fitted.value, rng, n_resamples=N_RESAMPLES, weights=weights),
        ),
    }
    for procedure, (rows, intervals) in tables.items():
        for name, (model, index, true_value) in TRUE_COEFFICIENTS.items():
            value = coefficients(next(row for row in rows if row.model == model))[index]
            errors[procedure, name] = np.array([value - true_value])
            covered[procedure, name] = inside(intervals[model][index][None, :], np.array([true_value]))
    width = np.log(fitted.interval[:, 1] / fitted.interval[:, 0]) / 2.0
    alone = np.log(seated.hardness_interval[:, 1] / seated.hardness_interval[:, 0]) / 2.0
    return Outcome(errors, covered, screened.flags["layered"][used], width, alone)


def coefficients(fit: ModelFit) -> tuple[float, float, float, float]:
    return fit.a0, fit.a1, fit.b0, fit.b1


def inside(interval: FloatArray, truth: FloatArray) -> FloatArray:
    known = np.isfinite(interval).all(axis=1)
    return ((interval[:, 0] <= truth) & (truth <= interval[:, 1]))[known].astype(float)


def table(condition: str, outcomes: list[Outcome]) -> list[str]:
    rows = []
    for key in outcomes[0].errors:
        procedure, quantity = key
        error = np.concatenate([outcome.errors[key] for outcome in outcomes])
        shares = [outcome.covered[key] for outcome in outcomes if key in outcome.covered]
        coverage = f"{100 * np.concatenate(shares).mean():.1f} %" if shares else "—"
        bias = f"{error.mean():+.4f}"
        rows.append(
            f"| {condition} | {quantity} | {procedure} | {bias} | {np.sqrt(np.mean(error**2)):.4f} | {coverage} |"
        )
    return sorted(rows)


def marks(outcomes: list[Outcome]) -> str:
    """Share of the series marked as layered, and the median half-widths of the intervals of ln H_V."""
    share = np.concatenate([outcome.layered for outcome in outcomes]).mean()
    names = ("half_width", "half_width_even")
    widths = (np.concatenate([getattr(outcome, name) for outcome in outcomes]) for name in names)
    return " | ".join([f"{100 * share:.1f} %", *(f"{np.median(width):.3f}" for width in widths)])


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coverage")
    parser.add_argument("--campaigns", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    print(f"{options.campaigns} campaigns each, seeds 0 to {options.campaigns - 1}, {N_RESAMPLES} resamples\n")
    print("| errors in the data | quantity | procedure | mean error | rms error | coverage of 95 % |")
    print("| --- | --- | --- | ---: | ---: | ---: |")
    start = time.monotonic()
    marked: dict[str, str] = {}
    with ProcessPoolExecutor(options.workers) as pool:
        for condition, noise in CONDITIONS.items():
            outcomes = []
            for outcome in pool.map(partial(simulate, noise=noise), range(options.campaigns), chunksize=5):
                outcomes.append(outcome)
                if len(outcomes) % 50 == 0:
                    print(f"{condition}: {len(outcomes)}, {time.monotonic() - start:.0f} s", file=sys.stderr)
            print("\n".join(table(condition, outcomes)), flush=True)
            marked[condition] = marks(outcomes)
    print("\n| errors in the data | marked layered | median half-width of ln H_V | even snow supposed |")
    print("| --- | ---: | ---: | ---: |")
    for condition, cells in marked.items():
        print(f"| {condition} | {cells} |")


if __name__ == "__main__":
    main()
