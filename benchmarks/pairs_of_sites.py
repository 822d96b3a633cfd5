"""Coverage of ratios of equal sites in simulated pairs, for a table of docs/validation/reference-campaign.md.

``python -m benchmarks.pairs_of_sites`` writes it. Each value has an error of 0.05 in ln H_V and the site's scatter.
"""

from __future__ import annotations

import argparse
import math
from typing import Final

import numpy as np

from benchmarks.page_tables import write_tables
from skisnow.estimation.group_comparisons import Measured, compare_groups

ERROR: Final = 0.05
"""Of ln H_V."""
CASES: Final = {
    "5, 5": ((5, 0.3), (5, 0.3)),
    "2, 2": ((2, 0.3), (2, 0.3)),
    "1, 5": ((1, 0.3), (5, 0.3)),
    "eight sites of 3": ((3, 0.3),) * 8,
    "12, 8": ((12, 0.2), (8, 0.4)),
    "5, 20": ((5, 0.2), (20, 0.6)),
    "20, 5": ((20, 0.2), (5, 0.6)),
}
"""Tests and scatter of ln H_V of each site."""


def row(name: str, count: int) -> str:
    """Coverage of the ratio, and share of the campaigns that call some pair certain."""
    rng = np.random.default_rng(8)
    sites = [chr(65 + site) for site, (tests, _) in enumerate(CASES[name]) for _ in range(tests)]
    scatter = np.array([sd for tests, sd in CASES[name] for _ in range(tests)])
    covered, certain = [], []
    for _ in range(count):
        logs = rng.normal(0.0, np.hypot(scatter, ERROR))
        pairs = compare_groups(Measured("H_V", logs, np.full(logs.shape, ERROR**2), {"site": sites}), "site")
        covered += [pair.interval[0] <= 1.0 <= pair.interval[1] for pair in pairs]
        certain.append(min(pair.p_holm for pair in pairs) < 0.05)
    scatters = ", ".join(f"{sd:g}" for sd in dict.fromkeys(sd for _, sd in CASES[name]))
    return f"| {name} | {scatters} | {100.0 * np.mean(covered):.1f} | {100.0 * np.mean(certain):.1f} |"


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.pairs_of_sites")
    parser.add_argument("--pairs", type=int, default=2000)
    count = parser.parse_args().pairs
    heads = ("tests at the sites", "scatter of ln H_V", "covers (%)", "some pair is certain (%)")
    lines = [f"| {' | '.join(heads)} |", "| --- | --- | --- | --- |"]
    lines += [row(name, math.ceil(count / max(1, len(CASES[name]) // 2))) for name in CASES]
    write_tables("validation/reference-campaign", {"pairs-of-sites": lines})


if __name__ == "__main__":
    main()
