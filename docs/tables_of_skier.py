"""The tables of the page on the skier, computed again: python docs/tables_of_skier.py [TABLE ...].

Some 160 runs in the fast mode: half an hour of one core.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from measures_of_skier import (
    FloatArray,
    edges,
    forces_from_motion,
    in_a_long_turn,
    muscles,
    off_balance,
    outer_share,
    peak_forces,
    rate_step,
    residual,
    run_of,
    skidded_through,
    slip_of,
    slips,
    smallest_radius,
    spaced,
    swing,
    turn_time,
    turning_of,
    weights,
)
from watched_slope import DAY, write_profile

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.page_tables import write_tables
from benchmarks.skier.cases import CASES, Start

from skisnow import Run, Scenario, load_scenario, simulate, time_gates
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS

SHARE = 0.2
SHORT = 4.0
KICKER = "kicker, 10°"
KEYS_OF = {
    "slalom-20-gates": ("skier.pole_clearance_m", "skier.line_rate_per_s"),
    KICKER: ("skier.leg_load", "skier.shortest_leg_m", "skier.highest_flight_m"),
}

WATCHED = (
    ("slalom-20-gates", 4420.0, 203.0),
    ("slalom-20-gates", 11710.0, 203.0),
    ("slalom-20-gates", 11770.0, 203.0),
    ("giant-slalom-20-gates", 11600.0, 477.0),
    ("giant-slalom-20-gates", 4210.0, 477.0),
)
"""Course, where it begins on the day's way and how long it is (m)."""


def watched() -> Iterator[str]:
    """Gates on the slope that a watch measured; as it stands where the day is not there."""
    heads = ("from (m)", "slope: least, mean, greatest (°)", "passed", "speed: least, greatest (m/s)")
    yield f"| course | {' | '.join(heads)} | greatest lean (°) | outcome |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: | --- |"
    for name, begins, length in WATCHED:
        with TemporaryDirectory() as folder:
            profile = Path(folder) / "profile.csv"
            angles = write_profile(profile, begins, length)
            run = run_of(name, ("slope.kind", "profile"), ("slope.profile", str(profile)))
        course = run.scenario.course
        assert course is not None
        passed = [each.outcome for each in time_gates(course, run).passages].count("passed")
        slope = f"{angles.min():.1f}, {angles.mean():.1f}, {angles.max():.1f}"
        speed = f"{run.speed.min():.1f}, {run.speed.max():.1f}"
        told = f"{passed} of 20 | {speed} | {np.degrees(np.abs(run.balance.lean).max()):.0f}"
        yield f"| `{name}` | {begins:.0f} | {slope} | {told} | {run.outcome.replace('_', ' ')} |"


IN_TURNS: dict[str, Callable[[tuple[FloatArray, FloatArray]], str]] = {
    "tan Ψ off by, median": lambda found: f"{100.0 * np.median(found[0]):.1f} %",
    "… 95 % of the instants, within": lambda found: f"{100.0 * np.quantile(found[0], 0.95):.1f} %",
    "… instants within 5 %": lambda found: f"{100.0 * np.mean(found[0] < 0.05):.0f} %",
    "roll, I φ̈/(m z g_n tan Ψ), median": lambda found: f"{100.0 * np.median(found[1]):.1f} %",
}
TURN_TIMES = (1.5, 2.0, 3.0, 4.0, 6.0)


def slowly() -> Iterator[str]:
    """The slope formula in one turn on 3°, by how long the turn is: the middle half of it."""
    yield f"| time of the turn (s) | {' | '.join(f'{each:g}' for each in TURN_TIMES)} |"
    yield f"| --- |{' ---: |' * len(TURN_TIMES)}"
    missed = [in_a_long_turn(each) for each in TURN_TIMES]
    for row, told in IN_TURNS.items():
        yield f"| {row} | {' | '.join(told(each) for each in missed)} |"


LINKED: dict[str, Callable[[Run], str]] = {
    "outcome": lambda run: run.outcome,
    "speed, least and greatest (m/s)": lambda run: f"{run.speed.min():.1f}, {run.speed.max():.1f}",
    "greatest lean, edge angle (°)": lambda run: (
        f"{np.degrees(np.abs(run.balance.lean).max()):.0f}, {np.abs(edges(run)).max():.0f}"
    ),
    "leg, shortest and longest (m)": lambda run: f"{run.balance.leg.min():.2f}, {run.balance.leg.max():.2f}",
    "edge angle changes in 10 ms by at most (°)": lambda run: f"{np.abs(np.diff(edges(run))).max():.1f}",
    "edge rate changes in 10 ms by at most (°/s)": lambda run: f"{rate_step(run):.0f}",
    "slope formula: median of the error of tan Ψ": lambda run: f"{100.0 * np.median(off_balance(run)[0]):.1f} %",
    "with roll and rise: median": lambda run: f"{100.0 * np.median(off_balance(run)[1]):.1f} %",
    "… instants within 5 %": lambda run: f"{100.0 * np.mean(off_balance(run)[1] < 0.05):.0f} %",
    "load of the outer ski, 5 to 12 Hz, rms (N)": lambda run: f"{swing(run):.0f}",
    "one ski in the air, of the time": lambda run: f"{100.0 * np.mean(run.balance.load.min(axis=1) < 10.0):.0f} %",
    "greatest force on both boots, on one, in weights": weights,
    "energy residual over all energy": lambda run: f"{residual(run):.0f} · 10⁻⁶",
    "work of the muscles (J)": lambda run: f"{run.energies['boots'][-1]:.0f}",
    "of it given, taken (J)": lambda run: "{:.0f}, {:.0f}".format(*muscles(run)),
}


def linked() -> Iterator[str]:
    """The linked turns, row by row."""
    names = ("skier-10deg", "skier-19deg")
    yield f"| | {' | '.join(f'`{each}`' for each in names)} |"
    yield "| --- | ---: | ---: |"
    for row, told in LINKED.items():
        yield f"| {row} | {' | '.join(told(run_of(each)).replace('-', '−') for each in names)} |"


def swings() -> Iterator[str]:
    """The load of the outer ski, by how fast legs give way."""
    rates = (0.0, 0.5, 1.0, 2.0)
    yield f"| legs give way with (1/s) | {' | '.join(f'{each:g}' for each in rates)} |"
    yield f"| --- |{' ---: |' * len(rates)}"
    for name in ("skier-10deg", "skier-19deg"):
        runs = [run_of(name, ("run.duration_s", 3.5), ("skier.leg_yielding_per_s", each)) for each in rates]
        yield f"| `{name}`, rms 5 to 12 Hz (N) | {' | '.join(f'{swing(each):.0f}' for each in runs)} |"
        yield f"| … greatest load of a ski (N) | {' | '.join(f'{each.balance.load.max():.0f}' for each in runs)} |"


def carved() -> Iterator[str]:
    """Turn by turn on two snows: angle between skis and path, and what shear takes."""
    hard = {"snow.published": None, "snow.H_V_N_per_mm3": 1.0, "snow.S_f_N_per_mm2": 0.4}
    yield "| turn on 10° | race piste: slip (°), lost to shear (J) | H_V 1, S_f 0.4: slip (°), lost to shear (J) |"
    yield "| --- | ---: | ---: |"
    for number, (first, last) in enumerate(((0.8, 1.8), (1.8, 3.8), (3.8, 5.8), (5.8, 7.8), (7.8, 9.8))):
        cells = []
        for changes in ({}, hard):
            run = run_of("skier-10deg", *{key: value for key, value in changes.items() if value is not None}.items())
            lost = np.interp([first, last], run.time, run.energies["shear"])
            over = run.time[-1] < last
            cells.append("fell" if over else f"{slips(run, first, last):.1f}, {abs(lost[1] - lost[0]):.0f}")
        yield f"| {'half' if number == 0 else number} | {' | '.join(cells)} |"


def skidded() -> Iterator[str]:
    """Turn by turn where the snow does not hold what later turns ask for."""
    run = run_of("skier-12deg")
    heads = ("speed (m/s)", "slip: median, greatest (°)", "smallest radius (m)", "of a carve so edged (m)", "shear (J)")
    yield f"| turn | {' | '.join(heads)} | friction (J) | drag (J) |"
    yield f"| --- |{' ---: |' * (len(heads) + 2)}"
    skier = run.scenario.skier
    assert skier is not None
    for number in range(round(skier.turns - 0.5) + 1):
        first = skier.first_turn + skier.turn_time * max(0.0, number - 0.5)
        last = skier.first_turn + skier.turn_time * (number + 0.5)
        yield f"| {number or 'half'} | {' | '.join(one_turn(run, first, last))} |"


def one_turn(run: Run, first: float, last: float) -> list[str]:
    """Of a turn from one time to another (s): speed, slip, smallest radius, that of a carve so edged, what is lost."""
    within = (run.time > first) & (run.time < last)
    turning, slip = turning_of(run), np.abs(slip_of(run))[within]
    tightest = np.flatnonzero(within)[np.argmax(np.abs(turning[within]))]
    carve = run.scenario.ski.sidecut_radius_of_edge_line * math.cos(math.radians(float(edges(run)[tightest])))
    lost = [np.ptp(np.interp([first, last], run.time, run.energies[name])) for name in ("shear", "friction", "drag")]
    found = [f"{run.speed[within].mean():.1f}", f"{np.median(slip):.1f}, {slip.max():.1f}"]
    return [*found, f"{1.0 / abs(turning[tightest]):.1f}", f"{carve:.1f}", *(f"{each:.0f}" for each in lost)]


def through(name: str, *changes: tuple[str, object]) -> list[str]:
    """Of a run through gates: passed, speed, time, greatest lean and edge angle, smallest radius."""
    run = run_of(name, *changes)
    course = run.scenario.course
    assert course is not None
    passages = time_gates(course, run).passages
    passed = [each.outcome for each in passages].count("passed")
    return [
        f"{passed} of {len(passages)}",
        f"{run.speed[-1]:.1f}",
        f"{np.degrees(np.abs(run.balance.lean).max()):.0f}",
        f"{np.abs(edges(run)).max():.0f}",
        f"{smallest_radius(run):.1f}",
        f"{100.0 * np.mean(off_balance(run)[1] < 0.05):.0f} %",
        run.outcome.replace("_", " "),
    ]


GATES = (
    ("slalom-20-gates", 7.0),
    ("slalom-20-gates", 8.0),
    ("giant-slalom-20-gates", 7.0),
    ("giant-slalom-20-gates", 8.0),
    ("giant-slalom-20-gates", 10.0),
)


def gates() -> Iterator[str]:
    """Which gates are passed on which slope."""
    heads = ("course", "slope (°)", "passed", "speed at the end (m/s)", "greatest lean (°)", "edge angle (°)")
    yield f"| {' | '.join(heads)} | smallest radius (m) | lean within 5 % | outcome |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |"
    for name, angle in GATES:
        yield f"| `{name}` | {angle:g} | {' | '.join(through(name, ('slope.angle_deg', angle)))} |"


def racers() -> Iterator[str]:
    """Beside Reid and others (2020)."""
    yield "| gates every | slope (°) | greatest edge angle (°) | smallest radius (m) | passed | speed (m/s) |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    yield "| 10 m, measured | 19 | 65.7 ± 1.7 | 3.96 ± 0.23 | | |"
    yield _racer(10.0, 65.7)
    yield "| 13 m, measured | 19 | 71.0 ± 1.9 | 4.94 ± 0.59 | | |"
    yield _racer(13.0, 71.0)


def _racer(distance: float, edge: float, angle: float = 7.0) -> str:
    run = spaced(distance, 3.0, edge, angle)
    assert run.scenario.course is not None
    passed = [each.outcome for each in time_gates(run.scenario.course, run).passages].count("passed")
    numbers = f"{np.abs(edges(run)).max():.1f} | {smallest_radius(run):.1f} | {passed} of 10 | {run.speed[-1]:.1f} |"
    return f"| {distance:g} m, simulated | {angle:g} | {numbers}"


STEEP = (
    ("slalom, 10 m", 10.0, 3.0, 5.5, "slalom", "65.7 ± 1.7, 3.96 ± 0.23", "2.5 to 4"),
    ("slalom, 13 m", 13.0, 3.0, 7.5, "slalom", "71.0 ± 1.9, 4.94 ± 0.59", "2.5 to 4"),
    ("giant slalom, 25 m", 25.0, 6.0, 11.0, "giant-slalom", "", "2 to 3.5"),
)
"""Gates on 19°, wanted speed (m/s), ski; edge angle (°) and radius (m) measured, and peaks of force (weights)."""


def steep() -> Iterator[str]:
    """Skidded turns on 19° beside measured racers."""
    heads = ("gates on 19°", "passed", "speed (m/s), turn (s)", "edge angle (°), smallest radius (m)", "measured")
    forces = ("peak force of a turn, median and most (weights)", "published", "outer ski", "slip (°)")
    yield f"| {' | '.join((*heads, *forces))} |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    for name, down, across, speed, ski, measured, published in STEEP:
        run = skidded_through(down, across, speed, ski)
        assert run.scenario.course is not None
        passed = [each.outcome for each in time_gates(run.scenario.course, run).passages].count("passed")
        peaks = peak_forces(run)
        own = f"{np.quantile(np.abs(edges(run)), 0.99):.0f}, {smallest_radius(run):.1f}"
        force = f"{np.median(peaks):.1f}, {peaks.max():.1f}"
        slip = np.quantile(np.abs(slip_of(run)), 0.95)
        yield (
            f"| {name} | {passed} of 8 | {run.speed.mean():.1f}, {turn_time(run):.1f} | {own} | {measured} | {force} "
            f"| {published} | {outer_share(run):.0%} | {slip:.0f} |"
        )


def terms() -> Iterator[str]:
    """Forces from the motion of the body less recorded ones, in the terms of two papers."""
    yield "| | correlation | total (weights) | total (N) | against the motion (N) |"
    yield "| --- | ---: | ---: | ---: | ---: |"
    yield "| Gao and others, model − insoles | 0.94 | −0.022 ± 0.186 | | |"
    yield "| Gilgien and others, GNSS − reference | | | −26 ± 152 | 1 ± 96 |"
    for name, down, across, speed, ski, *_ in STEEP:
        run = skidded_through(down, across, speed, ski)
        totals, brakes = forces_from_motion(run)
        weight = run.scenario.sledge.mass * run.scenario.gravity
        apart = [_apart(totals / weight, 3), _apart(totals, 0), _apart(brakes, 0)]
        yield f"| {name}, from the motion − recorded | {np.corrcoef(totals)[0, 1]:.3f} | {' | '.join(apart)} |"


def _apart(forces: FloatArray, digits: int) -> str:
    difference = forces[0] - forces[1]
    mean = round(float(difference.mean()), digits) + 0.0  # no negative zero
    return f"{mean:.{digits}f} ± {difference.std():.{digits}f}".replace("-", "−")


def sensitivity() -> Iterator[str]:
    """What a fifth more or less of each number of the skier moves after 4 s."""
    yield "| key | value | moves the end by, −20 %, +20 % (m) | load, 5 to 12 Hz (N) | greatest lean (°) |"
    yield "| --- | ---: | ---: | ---: | ---: |"
    others = ["skier.stops_after_s", *(key for keys in KEYS_OF.values() for key in keys)]
    for name in ("skier-10deg", *KEYS_OF):
        base = _short(name)
        yield f"| `{name}` as it is | | | {swing(base):.0f} | {_lean(base)} |"
        for key, value in _numbers(base.scenario):
            if key in KEYS_OF.get(name, ()) or (name not in KEYS_OF and key not in others):
                yield f"| `{key.removeprefix('skier.')}` | {value:g} | {_moved(name, base, key, value)} |"


def _short(name: str, *changes: tuple[str, object]) -> Run:
    """The first seconds of a built-in scenario, or of the benchmark's kicker, with changes."""
    if name != KICKER:
        return run_of(name, ("run.duration_s", SHORT), *changes)
    case = next(case for case in CASES if case.name == KICKER).scenario(Start())
    keys = {"solver.method": "fast", "run.duration_s": SHORT, "skier.first_turn_s": 100.0, **dict(changes)}
    return simulate(load_scenario("skier-10deg", changes=keys).with_(slope=case.slope, start=case.start))


def _numbers(turn: Scenario) -> Iterator[tuple[str, float]]:
    values: Mapping[str, object] = scenario_values(turn)
    for key in SCENARIO_KEYS:
        value = values.get(key)
        if key.startswith("skier.") and isinstance(value, float | int) and not isinstance(value, bool):
            yield key, float(value)


def _moved(name: str, base: Run, key: str, value: float) -> str:
    highest = SCENARIO_KEYS[key].highest
    top = min(value * (1.0 + SHARE), highest)
    runs = [_short(name, (key, each)) for each in (value * (1.0 - SHARE), top)]
    ends = ", ".join(
        f"{math.dist(each.place[-1], base.place[-1]):.3f}" if each.time[-1] == base.time[-1] else each.outcome
        for each in runs
    )
    return f"{ends} | {swing(runs[0]):.0f}, {swing(runs[1]):.0f} | {_lean(runs[0])}, {_lean(runs[1])}"


def _lean(run: Run) -> str:
    return f"{np.degrees(np.abs(run.balance.lean).max()):.1f}"


TABLES: dict[str, Callable[[], Iterator[str]]] = {
    "linked": linked,
    "slowly": slowly,
    "swings": swings,
    "carved": carved,
    "skidded": skidded,
    "gates": gates,
    "watched": watched,
    "racers": racers,
    "steep": steep,
    "terms": terms,
    "sensitivity": sensitivity,
}


def main() -> None:
    """Write the tables that are named, or all."""
    for name in sys.argv[1:] or (each for each in TABLES if each != "watched" or DAY.exists()):
        write_tables("validation/skier", {name: TABLES[name]()})


if __name__ == "__main__":
    main()
