"""The tables of gates, disturbed starts and wedges of the page on the skier: python docs/tables_of_skidded_turns.py."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.page_tables import write_tables
from benchmarks.skier.__main__ import NEAR, numbers, outcome, passed
from benchmarks.skier.cases import CASES, Case, Start, starts

from skisnow import Run, load_scenario, simulate
from skisnow.skier import BalancedSkier
from skisnow.skier.posture import LEFT_EDGE, RIGHT_EDGE, RIGHT_TOE

SHORT = [replace(case, gates=6) for case in CASES if isinstance(case, Case) and not case.name.startswith("linked")]
RACE, RECREATIONAL = (0.21, 0.52), (0.16, 0.086)
WEDGES = (
    ("10°, race piste", 10.0, RACE, (1.0, 1.0), 9.0),
    ("10°, race piste", 10.0, RACE, (2.0, 0.7), 9.0),
    ("15°, race piste", 15.0, RACE, (1.0, 1.0), 9.0),
    ("15°, race piste", 15.0, RACE, (2.0, 0.8), 9.0),
    ("15°, race piste", 15.0, RACE, (0.5, 1.4), 9.0),
    ("10°, recreational piste", 10.0, RECREATIONAL, (1.0, 1.0), 25.0),
)
"""Name, slope (°), assumed H_V and S_f, the true ones over these, and duration (s)."""


def gates() -> Iterator[str]:
    """One start at the edge change before the first of six gates."""
    heads = ("passed", "mean speed (m/s)", "largest load over 20 ms (weights)", "greatest lean, angulation (°)")
    yield f"| case | start (m/s) | {' | '.join(heads)} |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for case in SHORT:
        run = simulate(case.scenario(Start()))
        speed, load, lean = numbers(run)
        angle = f"{lean:.0f}, {np.degrees(np.abs(run.balance.angulation).max()):.0f}"
        fell = "" if outcome(run) == "finished" else f", {outcome(run).replace('_', ' ')}"
        yield f"| {case.name} | {case.speed:g} | {passed(run)}{fell} | {speed:.1f} | {load:.1f} | {angle} |"


def disturbed() -> Iterator[str]:
    """Six disturbed starts: how many finish, by the force of a skid over the assumed one."""
    yield "| case | f 0.7 to 1.4 | other f | failed at f |"
    yield "| --- | ---: | ---: | --- |"
    for case in SHORT:
        ends = [(start.force, outcome(simulate(case.scenario(start))) == "finished") for start in starts(6, 91)]
        near = [good for force, good in ends if NEAR[0] <= force <= NEAR[1]]
        far = [good for force, good in ends if not NEAR[0] <= force <= NEAR[1]]
        failed = ", ".join(f"{force:.2f}" for force, good in sorted(ends) if not good)
        yield f"| {case.name} | {sum(near)} of {len(near)} | {sum(far)} of {len(far)} | {failed} |"


def wedge() -> Iterator[str]:
    """A wedge from 5 m/s down the fall line to a stop."""
    yield "| wedge | f | stopped | way (m) | toe-in, edge at most (°) | largest load (weights) |"
    yield "| --- | ---: | --- | ---: | ---: | ---: |"
    for name, slope, snow, factors, duration in WEDGES:
        changes = {
            "solver.method": "fast",
            "skier.steers": "wedge",
            "slope.angle_deg": slope,
            "snow.H_V_N_per_mm3": snow[0] * factors[0],
            "snow.S_f_N_per_mm2": snow[1] * factors[1],
            "skier.assumed_H_V_N_per_mm3": snow[0],
            "skier.assumed_S_f_N_per_mm2": snow[1],
            "start.speed_m_per_s": 5.0,
            "run.duration_s": duration,
        }
        scenario = load_scenario("skier-10deg", changes=changes)
        skier = BalancedSkier(scenario)
        run = simulate(scenario, boots=skier)
        force = factors[1] / factors[0] ** 0.5
        yield f"| {name} | {force:.2f} | {_stop(run)} | {_limits(skier)} | {numbers(run)[1]:.1f} |"


def _stop(run: Run) -> str:
    stopped = run.outcome == "finished" and run.speed[run.time > run.time[-1] - 1.0].max() < 0.2
    way = np.linalg.norm(np.diff(run.place, axis=0), axis=1).sum()
    return f"{'yes' if stopped else 'no'} | {way:.1f}"


def _limits(skier: BalancedSkier) -> str:
    postures = np.degrees(np.abs([record.posture for record in skier.records]).max(axis=0))
    return f"{postures[RIGHT_TOE]:.0f}, {max(postures[LEFT_EDGE], postures[RIGHT_EDGE]):.0f}"


if __name__ == "__main__":
    TABLES = {"skidded-starts": gates, "disturbed": disturbed, "wedge": wedge}
    for chosen in sys.argv[1:] or TABLES:
        write_tables("validation/skier", {chosen: TABLES[chosen]()})
