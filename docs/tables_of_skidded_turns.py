"""Tables of gates, starts, wedges and keys of the skier: python docs/tables_of_skidded_turns.py [TABLE …]."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.page_tables import write_tables
from benchmarks.skier.__main__ import NEAR, carved, numbers, outcome, passed
from benchmarks.skier.cases import CASES, HYBRID, Case, Start, starts

from skisnow import Run, load_scenario, simulate
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS
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

COURSES = (
    Case("slalom 11.5 m, 17°", 17, 11.5, 3.0, 6.5, gates=5),
    Case("slalom 13 m, 22°", 22, 13.0, 3.0, 8.5, gates=5),
    Case("giant slalom 27 m, 17°", 17, 27.0, 6.5, 11.5, gates=5, ski="giant-slalom"),
)
"""Courses that are not among the benchmark's cases, and by which no key was chosen."""
HYBRID_STARTS = (40, 40, 12, 20, 40)
"""Disturbed starts of each case of turns that carve."""
KEYS = (
    *("greatest_slip_deg", "least_slip_deg", "braking_per_s", "outer_share", "edge_rate_per_s", "leg_gain"),
    *("leg_yielding_per_s", "edge_gain", "pole_clearance_m"),
)


def keys() -> Iterator[str]:
    """Each key of skidded turns times 0.5 and 1.5, as far as it may go, on three courses."""
    yield f"| key | value | {' | '.join(case.name for case in COURSES)} |"
    yield "| --- | ---: | ---: | ---: | ---: |"
    values = scenario_values(COURSES[0].scenario(Start()))
    yield f"| as they are | | {' | '.join(_skied(case) for case in COURSES)} |"
    for name in KEYS:
        key, value = SCENARIO_KEYS[f"skier.{name}"], float(str(values[f"skier.{name}"]))
        for changed in (max(key.lowest, 0.5 * value), min(key.highest, 1.5 * value)):
            cells = (_skied(case, **{name: changed}) for case in COURSES)
            yield f"| `{name}` | {value:g} → {changed:g} | {' | '.join(cells)} |"


def _skied(case: Case, **changes: float) -> str:
    """Passed gates of five, largest load over 20 ms (weights), and the end of the run where it fails."""
    run = simulate(case.scenario(Start()).with_(**changes))
    end = outcome(run)
    return f"{passed(run)}, {numbers(run)[1]:.1f}{'' if end == 'finished' else f', {end}'.replace('_', ' ')}"


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
        ends = [(start.force, outcome(simulate(case.scenario(start))) == "finished") for start in starts(6, 137)]
        near = [good for force, good in ends if NEAR[0] <= force <= NEAR[1]]
        far = [good for force, good in ends if not NEAR[0] <= force <= NEAR[1]]
        failed = ", ".join(f"{force:.2f}" for force, good in sorted(ends) if not good)
        yield f"| {case.name} | {sum(near)} of {len(near)} | {sum(far)} of {len(far)} | {failed} |"


def hybrid() -> Iterator[str]:
    """Turns that carve behind the fall line: disturbed starts that finish, and turns that carve."""
    heads = ("starts", "finished", "turns that carve", "speed at the end (m/s)", "largest load over 20 ms (weights)")
    yield f"| case | {' | '.join(heads)} |"
    yield "| --- |" + " ---: |" * len(heads)
    for case, count in zip(HYBRID, HYBRID_STARTS, strict=True):
        finished, turns, speeds, loads = 0, [], [], []
        for start in starts(count, 57):
            skier = BalancedSkier(case.scenario(start))
            run = simulate(skier.scenario, boots=skier)
            finished += outcome(run) == "finished"
            turns += carved(skier, case)
            speeds.append(run.speed[-1])
            loads.append(numbers(run)[1])
        cells = (
            count,
            finished,
            f"{sum(turns)} of {len(turns)}",
            f"{np.median(speeds):.1f}",
            f"{np.median(loads):.1f}",
        )
        yield f"| {case.name} | {' | '.join(map(str, cells))} |"


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
    TABLES = {"skidded-starts": gates, "disturbed": disturbed, "hybrid": hybrid, "wedge": wedge, "keys": keys}
    for chosen in sys.argv[1:] or TABLES:
        write_tables("validation/skier", {chosen: TABLES[chosen]()})
