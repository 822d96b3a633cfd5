"""How well a hardness that grows with depth is found: ``python -m benchmarks.growing_hardness``.

The truth is known. Prints a Markdown table; that of the page on growing hardness is its output.
"""

from __future__ import annotations

import argparse
import math
from itertools import product

import numpy as np

from benchmarks.page_tables import write_tables
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.layering import growing_hardness, site_growth
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.geometry import SkiPiece

LOADS = np.linspace(12.0, 492.0, 7)
TOOL, ANGLE = SkiPiece(0.2, 0.062), math.radians(30.0)
GAUGE = 1e-5
OF_A_SITE = 30
HEAD = (
    "| H_V (N/mm³) | true γ | mean of single series | standard deviation | coverage | mean of sites | coverage |",
    "| ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
)


def growing(
    hardness: np.ndarray, growth: float, scatter: float = 0.0, offset: float = 0.0, *, seed: int = 1, step: float = 0.0
) -> Readings:
    """Series at 30° of F = H_0 L/tan ϑ (e²/2 + γ e³/(3 e₇)) with F₇/V₇ = ``hardness`` (N/m³), by Newton's method.

    Depths scatter by ``scatter``, their zero is off by ``offset`` (m, one per series), the gauge has ``step`` (m).
    """
    rng = np.random.default_rng(seed)
    per_depth = TOOL.length / math.tan(ANGLE)
    deepest = np.sqrt(2.0 * LOADS[-1] / (hardness * per_depth))[:, None]
    surface = hardness[:, None] * per_depth / (1.0 + 2.0 * growth / 3.0)
    depth = deepest * np.sqrt(LOADS / LOADS[-1])
    for _ in range(50):
        force = surface * (depth**2 / 2.0 + growth * depth**3 / (3.0 * deepest))
        depth = depth - (force - LOADS) / (surface * (depth + growth * depth**2 / deepest))
    read = depth * (1.0 + scatter * rng.standard_normal(depth.shape))
    read = read + offset * rng.standard_normal((len(hardness), 1))
    return series_of(np.maximum(np.round(read / step) * step if step else read, 0.0))


def series_of(depth: np.ndarray) -> Readings:
    """Readings of depths (m, 7) in m under the loads at 30°."""
    m, k = depth.shape
    return Readings(
        load=np.tile(LOADS, m),
        penetration_depth=depth.ravel(),
        edge_angle=np.full(m, ANGLE),
        first=np.arange(m + 1) * k,
        largest=np.arange(m) * k + k - 1,
        tool=np.zeros(m, dtype=np.int64),
        tools=(TOOL,),
    )


def row(hardness: float, growth: float, count: int) -> str:
    """The table of one snow: 2 % of scatter, a gauge of 0.01 mm, offsets of 0.02 mm."""
    readings = growing(np.full(count, hardness), growth, 0.02, 2e-5, step=GAUGE)
    uncertainty = ReadingUncertainty(GAUGE / math.sqrt(12.0))
    found = growing_hardness(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), uncertainty)
    low, high = found.growth_interval.T
    held = np.mean((low <= growth) & (high >= growth))
    sites = [str(index // OF_A_SITE) for index in range(count)]
    *means, _ = site_growth(found, np.ones(count, dtype=bool), sites)
    held_by_sites = np.mean([each.low <= growth <= each.high for each in means])
    return (
        f"| {hardness / 1e9:g} | {growth:.0%} | {np.nanmean(found.growth):.1%} | {np.nanstd(found.growth):.0%} | "
        f"{held:.1%} | {np.mean([each.value for each in means]):.1%} | {held_by_sites:.1%} |"
    )


def main() -> None:
    """Write the table of docs/validation/reference-campaign.md."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.growing_hardness")
    parser.add_argument("--series", type=int, default=30_000)
    count = parser.parse_args().series
    lines = [*HEAD, *(row(H, growth, count) for H, growth in product((1e8, 1e9, 1e10), (0.0, 0.2, 0.5)))]
    write_tables("validation/reference-campaign", {"growing-hardness": lines})


if __name__ == "__main__":
    main()
