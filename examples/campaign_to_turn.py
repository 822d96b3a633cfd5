"""From an analysed campaign to a turn: each contact on the snow that was found, and a band over its uncertainty.

    python examples/campaign_to_turn.py RESULTS.json OUT [--site SITE] [--runs N] [--seed N] [--workers N]

RESULTS.json is what `skisnow analyse` wrote. Sledge and skis are those of the built-in scenario `carved-46m`. Site C of
the reference campaign is weak in shear, so the turn is slow and on a gentle slope: what it asks of the snow, the snow
can hold. OUT/report.html shows the whole chain.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from skisnow import Run, SnowProperties, read_scenario, simulated_run, snow_from_results
from skisnow.report.figures.track_band import TimedTrack
from skisnow.report.material import is_synthetic
from skisnow.report.turn_report import EnsembleRun, TurnChain, write_turn_report
from skisnow.report.turn_sentences import contrast
from skisnow.simulate.batch import run_batch
from skisnow.snow.drawn import drawn_snows

TURN = {"slope.angle_deg": 5.0, "start.speed_m_per_s": 4.5, "sledge.edge_angle_deg": 40.0}
CONTACTS = {"hypoplastic, k_u / H_V = 10": 10.0, "elastic": 1.0}
QUICKLY = {"fixed": True, "step": 1e-3}  # the ensemble's solver; the report says what that costs
EVERY = 5  # of a track's rows the band draws one in so many


def turn(snow: SnowProperties, unloading_ratio: float = 10.0, **solver: Any) -> Run:
    """The turn on this snow."""
    scenario = read_scenario("carved-46m", changes=TURN)
    contact = replace(scenario.contact, snow=snow, unloading_ratio=unloading_ratio)
    return simulated_run(replace(scenario, contact=contact, solver=replace(scenario.solver, **solver)))


def track_row(snow: SnowProperties) -> dict[str, Any]:
    """One run of the ensemble as JSON values: it may come back from another process."""
    run = turn(snow, **QUICKLY)
    time, x, y = (column[::EVERY].tolist() for column in (run.time, run.place[:, 0], run.place[:, 1]))
    return {"outcome": run.outcome, "track": [time, x, y]}


def told(done: int, count: int) -> None:
    """Say how far the ensemble is."""
    print(f"run {done} of {count}", file=sys.stderr)


def main() -> None:
    """Simulate, draw, write; print what the contacts do otherwise."""
    parser = argparse.ArgumentParser(description="From an analysed campaign to a turn.")
    parser.add_argument("results", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--site", default="site C")
    for name, default in (("--runs", 32), ("--seed", 1), ("--workers", None)):
        parser.add_argument(name, type=int, default=default)
    asked = parser.parse_args()
    snow = snow_from_results(asked.results, site=asked.site)
    runs = {name: turn(snow, ratio) for name, ratio in CONTACTS.items()}
    snows = drawn_snows(snow, asked.runs, np.random.default_rng(asked.seed))
    nominal, *rows = run_batch([snow, *snows], track_row, workers=asked.workers, progress=told)
    hypoplastic = next(iter(runs.values()))
    moved = float(np.hypot(*(hypoplastic.place[-1, :2] - [column[-1] for column in nominal["track"][1:]])))
    tracks = [TimedTrack(*map(np.array, row["track"])) for row in rows]
    ensemble = [EnsembleRun(*of) for of in zip(snows, [row["outcome"] for row in rows], tracks, strict=True)]
    name = json.loads(asked.results.read_text(encoding="utf-8"))["campaign"]["name"]
    chain = TurnChain(
        campaign=name, site=asked.site, synthetic=is_synthetic(name), snow=snow, runs=runs, ensemble=ensemble,
        seed=asked.seed, ensemble_error=moved,
    )  # fmt: skip
    page = write_turn_report(chain, asked.out)
    print(
        "\n".join(sentence.replace("<sub>", "_").striptags() for sentence in contrast(chain)),
        f"The whole chain: {page}",
        sep="\n",
    )


if __name__ == "__main__":
    main()
