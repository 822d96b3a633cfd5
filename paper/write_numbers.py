"""Numbers of the paper, computed: ``python paper/write_numbers.py [--check]``.

In paper.md ``<!--=NAME-->0.95<!--/-->`` marks a number. Without ``--check`` the numbers are written into the file.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.printed_numbers import derived  # noqa: E402

import skisnow  # noqa: E402
from skisnow.campaign import reference_campaign  # noqa: E402

PAPER = Path(__file__).with_name("paper.md")
NUMBER = re.compile(r"<!--=(?P<name>[\w -]+)-->(?P<text>[^<]*)<!--/-->")
CAMPAIGNS = 100
"""Simulated campaigns of the coverage; seeds from 5000."""


def coverage() -> dict[str, str]:
    """Share of the series whose interval of H_V contains the true hardness, and how often F = H_V V is selected."""
    inside: list[bool] = []
    selected = 0
    for seed in range(5000, 5000 + CAMPAIGNS):
        simulated = reference_campaign(seed)
        results = skisnow.analyse(simulated.campaign(), n_resamples=100).results["penetration"]
        truth = simulated.snow_hardness / 1e9
        intervals = np.array(
            [row["H_V_interval_N_per_mm3"] or [np.nan, np.nan] for row in results["experiments"]], dtype=float
        )
        known = np.isfinite(intervals[:, 0])
        inside += ((intervals[:, 0] <= truth) & (truth <= intervals[:, 1]))[known].tolist()
        selected += results["selected"]["id"] == "H_V:a=none,b=one"
    return {"coverage": f"{100.0 * np.mean(inside):.1f}", "selected": str(selected), "campaigns": str(CAMPAIGNS)}


def turn() -> dict[str, str]:
    """End of the turn ``carved-46m``, its distance from that with a tenth of the tolerance, and the energy residual."""
    scenario = skisnow.load_scenario("carved-46m")
    run = skisnow.simulate(scenario)
    finer = skisnow.simulate(skisnow.load_scenario("carved-46m", changes={"solver.tolerance_mm": 1e-4}))
    share = np.nan if run.energy_balance_error is None else run.energy_balance_error
    return {
        "length": f"{run.run_length:.0f}",
        "end moves": f"{1e3 * float(np.linalg.norm(run.place[-1] - finer.place[-1])):.1f}",
        "residual": f"{100.0 * share:.4f}",
    }


def numbers() -> dict[str, str]:
    """Every number of the paper by name."""
    rows = derived()
    return {
        "derived": str(len(rows)),
        "derived agreeing": str(sum(row.agrees for row in rows)),
        **coverage(),
        **turn(),
    }


def main() -> int:
    """1 with ``--check`` if a number differs."""
    parser = argparse.ArgumentParser(description="Numbers of the paper, computed.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit status 1 if a number differs")
    check = parser.parse_args().check
    computed, text = numbers(), PAPER.read_text(encoding="utf-8")
    new = NUMBER.sub(lambda mark: f"<!--={mark['name']}-->{computed[mark['name']]}<!--/-->", text)
    if not check:
        PAPER.write_text(new, encoding="utf-8")
    return int(check and new != text)


if __name__ == "__main__":
    sys.exit(main())
