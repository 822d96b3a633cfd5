"""Which scatter and layering reproduce the nine rmse that the paper prints: ``python -m benchmarks.printed_rmse``.

Campaigns of the paper's design are drawn with random depth scatter, mean and spread of the layering exponent κ, and a
random share of the series at each edge angle, which the paper does not print. The nine models are fitted to each. ln
rmse of each row is then a quadratic function of these, fitted by least squares; what stays over is its covariance. The
posterior of the numbers under even priors is that function's under the printed rmse. Prints Markdown tables; those of
the page on the printed rmse are its output.
"""

from __future__ import annotations

import argparse
import sys
from itertools import combinations_with_replacement
from typing import Final

import numpy as np
import numpy.typing as npt

from skisnow.campaign import ReferenceNoise, reference_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.models import MODELS, fit_models
from skisnow.estimation.readings import readings_of
from skisnow.snow.published.moessner_2013 import PRINTED_RMSE_N

FloatArray = npt.NDArray[np.float64]

PRIOR: Final = {
    "relative scatter of depth": (0.02, 0.16),
    "mean of κ": (-0.4, 0.4),
    "standard deviation of κ": (0.0, 0.4),
}
"""Even between these ends; κ beyond 0.4 is not drawn, for then the force could fall with depth in some series."""
ANGLES_DEG: Final = (0, 15, 30, 45, 60)
DESIGN_SD: Final = 0.02
"""Relative uncertainty of every rmse from what else the paper does not print of its design (modelling assumption)."""
_SAMPLES: Final = 1_000_000
_LEAST_EFFECTIVE: Final = 50.0


def rmse_of(seed: int, theta: FloatArray, kept: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The nine rmse (N) of one campaign, of which a share of the series at each angle is kept; the shares that stay."""
    scatter, mean, spread = theta.tolist()
    noise = ReferenceNoise(depth_scatter=scatter, layering_mean=mean, layering_sd=spread, depths_grow=False)
    drawn = reference_campaign(seed, noise=noise).campaign()
    assert drawn.penetration is not None
    readings = readings_of(drawn.penetration, drawn.tools, geometry="extended")
    by_last = {symbol: hardness_at_largest_load(readings, each) for symbol, each in DEFINITIONS.items()}
    angle = np.searchsorted(ANGLES_DEG, np.rint(np.degrees(readings.edge_angle)))
    known = np.all([np.isfinite(values) for values in by_last.values()], axis=0)
    known &= np.random.default_rng((seed, 1)).random(readings.n_series) < kept[angle]
    fits = fit_models(readings.of(known), {symbol: values[known] for symbol, values in by_last.items()})
    return np.array([fit.rmse for fit in fits]), np.bincount(angle[known], minlength=len(ANGLES_DEG)) / known.sum()


def design(theta: FloatArray, shares: FloatArray) -> FloatArray:
    """1, the three scaled to -1 … 1, four of the shares, their products, the cubes of the three."""
    low, high = np.array(list(PRIOR.values())).T
    x = np.column_stack([(2.0 * theta - low - high) / (high - low), 5.0 * shares[:, 1:] - 1.0])
    products = [x[:, i] * x[:, k] for i, k in combinations_with_replacement(range(x.shape[1]), 2)]
    return np.column_stack([np.ones(len(x)), x, *products, *(x[:, i] ** 3 for i in range(len(PRIOR)))])


def drawn_campaigns(count: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The three numbers, the shares of the angles and the nine rmse of ``count`` campaigns."""
    low, high = np.array(list(PRIOR.values())).T
    theta = rng.uniform(low, high, (count, len(PRIOR)))
    found = []
    for index, each in enumerate(theta):
        found.append(rmse_of(index, each, rng.uniform(0.1, 1.0, len(ANGLES_DEG))))
        print(f"\r{index + 1} of {count}", end="", file=sys.stderr)
    print(file=sys.stderr)
    return theta, np.array([shares for _, shares in found]), np.array([rmse for rmse, _ in found])


def posterior(rows: list[int], coefficients: FloatArray, covariance: FloatArray, rng: np.random.Generator) -> list[str]:
    """Tables of the numbers that reproduce these rows, and of the nine rmse that come out with them."""
    low, high = np.array(list(PRIOR.values())).T
    theta = rng.uniform(low, high, (_SAMPLES, len(PRIOR)))
    kept = rng.uniform(0.1, 1.0, (_SAMPLES, len(ANGLES_DEG)))
    shares = kept / kept.sum(axis=1, keepdims=True)
    printed = np.log([PRINTED_RMSE_N[model.id] for model in MODELS])
    expected = design(theta, shares) @ coefficients
    residual = expected[:, rows] - printed[rows]
    distance2 = np.einsum("ni,ni->n", residual @ np.linalg.inv(covariance[np.ix_(rows, rows)]), residual)
    weight = np.exp(-0.5 * (distance2 - distance2.min()))
    weight /= weight.sum()
    best = int(np.argmin(distance2))
    values = np.column_stack([theta, shares])
    names = [*PRIOR, *(f"share of series at {angle}°" for angle in ANGLES_DEG)]
    effective = 1.0 / float(np.sum(weight**2))
    told = [f"{len(rows)} rows, smallest χ² {distance2.min():.1f}, effective samples {effective:.0f}", ""]
    told += ["| parameter | best | 95 % |", "| --- | ---: | --- |"]
    for name, column, own in zip(names, values.T, values[best], strict=True):
        order = np.argsort(column)
        ends = np.interp([0.025, 0.975], np.cumsum(weight[order]), column[order])
        between = f"{ends[0]:.3f} to {ends[1]:.3f}" if effective >= _LEAST_EFFECTIVE else "–"
        told.append(f"| {name} | {own:.3f} | {between} |")
    told += ["", "| model | printed (N) | best (N) |", "| --- | ---: | ---: |"]
    for model, paper, own in zip(MODELS, np.exp(printed), np.exp(expected[best]), strict=True):
        told.append(f"| `{model.id}` | {paper:.1f} | {own:.1f} |")
    return told


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.printed_rmse")
    parser.add_argument("--campaigns", type=int, default=1500)
    rng = np.random.default_rng(1)
    theta, shares, rmse = drawn_campaigns(parser.parse_args().campaigns, rng)
    X, logs = design(theta, shares), np.log(rmse)
    coefficients = np.asarray(np.linalg.lstsq(X, logs, rcond=None)[0], dtype=np.float64)
    left = logs - X @ coefficients
    covariance = left.T @ left / (len(X) - X.shape[1])
    print("what the function leaves over (%):", np.round(100.0 * np.sqrt(np.diag(covariance)), 1).tolist())
    covariance += DESIGN_SD**2 * np.eye(len(MODELS))
    of_volume = [index for index, model in enumerate(MODELS) if model.hardness == "H_V"]
    for rows in (of_volume, list(range(len(MODELS)))):
        print()
        print("\n".join(posterior(rows, coefficients, covariance, rng)))


if __name__ == "__main__":
    main()
