"""What the tables of the page on the skier measure of a run."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from functools import cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from skisnow import Course, Gate, Run, load_scenario, simulate

FloatArray: TypeAlias = npt.NDArray[np.float64]
BAND = (5.0, 12.0)
"""In which loads chatter (Hz)."""
AVERAGED = 0.2
"""Over which curvatures are meant (s)."""


@cache
def run_of(name: str, *changes: tuple[str, object]) -> Run:
    """A run of a built-in scenario with changes, in the fast mode."""
    print(name, *changes, file=sys.stderr)
    return simulate(load_scenario(name, changes={"solver.method": "fast", **dict(changes)}))


def in_a_long_turn(time: float) -> tuple[FloatArray, FloatArray]:
    """By how much tan Ψ is off, and what the body's roll takes of it, in the middle half of a turn so long (s)."""
    gentle = {"slope.angle_deg": 3.0, "start.speed_m_per_s": 8.0, "friction.mu_0": 0.02, "drag.drag_area_m2": 0.3}
    plan = {"skier.turn_time_s": time, "skier.turns": 1.5, "run.duration_s": 0.8 + 1.5 * time}
    run = run_of("skier-10deg", *(gentle | plan).items())
    balance, sledge = run.balance, run.scenario.sledge
    middle = (run.time > 0.8 + 0.75 * time) & (run.time < 0.8 + 1.25 * time) & np.isfinite(balance.pressure_lean)
    tangent = np.tan(balance.balanced_lean)
    rolls = np.convolve(np.gradient(np.gradient(balance.lean, run.time), run.time), np.ones(11) / 11.0, "same")
    gravity = run.scenario.gravity * math.cos(math.radians(3.0))
    share = sledge.inertia[0] * rolls / (sledge.mass * sledge.centre_of_mass[1] * gravity * tangent)
    return np.abs(np.tan(balance.pressure_lean) / tangent - 1.0)[middle], np.abs(share)[middle]


def steps_of(run: Run) -> float:
    """Between two rows (s)."""
    return float(np.median(np.diff(run.time)))


def swing(run: Run, first: float = 1.0, last: float = math.inf) -> float:
    """Rms of the load of the outer ski between 5 and 12 Hz, in a time (N)."""
    within = (run.time > first) & (run.time < last)
    load = run.balance.load[within]
    parts, rates = np.fft.rfft(load - load.mean(axis=0), axis=0), np.fft.rfftfreq(len(load), steps_of(run))
    parts[(rates < BAND[0]) | (rates > BAND[1])] = 0.0
    left, right = np.fft.irfft(parts, len(load), axis=0).T
    return float(np.sqrt(np.mean(np.where(run.balance.lean[within] > 0.0, right, left) ** 2)))


def edges(run: Run) -> FloatArray:
    """Edge angle over time (°)."""
    return np.degrees(run.balance.lean + run.balance.angulation)


def off_balance(run: Run) -> list[FloatArray]:
    """By how much tan Ψ is off, by the slope formula and with roll and rise, where it is above 0.3, after 1 s."""
    balance, found = run.balance, []
    for formula in (balance.balanced_lean, balance.rolling_lean):
        turning = (run.time > 1.0) & (np.abs(np.tan(formula)) > 0.3) & np.isfinite(balance.pressure_lean)
        found.append(np.abs(np.tan(balance.pressure_lean[turning]) / np.tan(formula[turning]) - 1.0))
    return found


def slips(run: Run, first: float, last: float) -> float:
    """Median angle between skis and path in a time (°)."""
    return float(np.median(np.abs(slip_of(run))[(run.time > first) & (run.time < last)]))


def weights(run: Run) -> str:
    """Greatest force on the boots, of both and of one, meant over 0.1 s, over the weight."""
    assert run.boots is not None
    half = max(1, round(0.05 / steps_of(run)))
    forces = run.boots.force.sum(axis=1), run.boots.force[:, 0], run.boots.force[:, 1]
    even = np.ones(2 * half + 1) / (2 * half + 1)
    most = [np.convolve(np.linalg.norm(each, axis=1), even, "same")[half:-half].max() for each in forces]
    weight = run.scenario.sledge.mass * run.scenario.gravity
    return f"{most[0] / weight:.1f}, {max(most[1:]) / weight:.1f}"


def residual(run: Run) -> float:
    """Energy that is missing, in millionths of all."""
    assert run.energy_balance_error is not None
    return 1e6 * abs(run.energy_balance_error)


def rate_step(run: Run) -> float:
    """Greatest change of the edge angle's rate between two rows (°/s)."""
    return float(np.abs(np.diff(edges(run), n=2)).max() / steps_of(run))


def muscles(run: Run) -> tuple[float, float]:
    """Work of the muscles where they give and where they take (J)."""
    steps = np.diff(run.energies["boots"])
    return float(steps[steps > 0.0].sum()), float(steps[steps < 0.0].sum())


def slip_of(run: Run) -> FloatArray:
    """Angle from the path to the skis over time (°)."""
    path = np.unwrap(np.arctan2(run.velocity[:, 1], run.velocity[:, 0]))
    return np.asarray(np.degrees(run.heading - path))


def turning_of(run: Run) -> FloatArray:
    """Curvature of the boots' path, meant over 0.2 s (1/m)."""
    path = np.unwrap(np.arctan2(run.velocity[:, 1], run.velocity[:, 0]))
    turning = np.gradient(path, run.time) / np.maximum(run.speed, 0.1)
    count = max(1, round(AVERAGED / steps_of(run)))
    return np.convolve(turning, np.ones(count) / count, "same")


def smallest_radius(run: Run) -> float:
    """Median over the turns of the smallest radius of the boots' path, of curvatures meant over 0.2 s (m)."""
    count = max(1, round(AVERAGED / steps_of(run)))
    smooth = turning_of(run)[count:-count]
    sides = np.flatnonzero(np.diff(np.sign(smooth)))
    tops = [np.abs(part).max() for part in np.split(smooth, sides + 1)[1:-1] if len(part) > 2 * count]
    return float(1.0 / np.median(tops)) if tops else math.nan


@cache
def spaced(distance: float, across: float, edge: float, angle: float) -> Run:
    """Ten slalom gates so far apart down the slope and across (m), with a greatest edge angle and a slope (°)."""
    poles = ((12.0 + distance * i, 0.5 * across * (-1) ** i) for i in range(10))
    found = tuple(
        Gate(name=str(i), turning=place, side="left" if place[1] > 0.0 else "right") for i, place in enumerate(poles, 1)
    )
    base = load_scenario("slalom-20-gates", changes={"solver.method": "fast", "slope.angle_deg": angle})
    assert base.skier is not None
    skier = replace(base.skier, greatest_edge=math.radians(edge))
    print("spaced", distance, angle, file=sys.stderr)
    return simulate(base.with_(course=Course(gates=found), skier=skier))


@cache
def skidded_through(down: float, across: float, speed: float, ski: str, angle: float = 19.0) -> Run:
    """Eight gates so far apart (m), in skidded turns that brake to a speed (m/s), on a slope (°)."""
    gates = tuple(
        Gate(
            name=str(i + 1),
            turning=((i + 0.5) * down, 0.5 * across * (-1) ** i),
            side="right" if i % 2 else "left",
        )
        for i in range(8)
    )
    changes = {"solver.method": "fast", "slope.angle_deg": angle, "ski.name": ski, "skier.brakes_to_m_per_s": speed}
    base = load_scenario("slalom-15deg", changes=changes)
    heading = math.atan((0.5 * across + 0.4) * math.pi / down)
    print("skidded", down, angle, file=sys.stderr)
    start = replace(base.start, x=0.0, y=0.0, heading=heading, speed=speed)
    return simulate(base.with_(course=Course(gates=gates), start=start))


def peak_forces(run: Run) -> FloatArray:
    """Greatest force on both boots in each turn, over 20 ms, over the weight."""
    assert run.boots is not None
    force = np.linalg.norm(run.boots.force.sum(axis=1), axis=1)
    count = max(1, round(0.02 / steps_of(run)))
    even = np.convolve(force, np.ones(count) / count, "same")
    sides = np.flatnonzero(np.diff(np.sign(run.balance.lean))) + 1
    weight = run.scenario.sledge.mass * run.scenario.gravity
    turns = [each.max() for each in np.split(even, sides)[1:-1] if len(each) * steps_of(run) > 0.3]
    return np.array(turns) / weight


def turn_time(run: Run) -> float:
    """Median time from lean to lean on the other side (s)."""
    steps = np.diff(run.time[np.flatnonzero(np.diff(np.sign(run.balance.lean)))])
    return float(np.median(steps[steps > 0.3]))


def forces_from_motion(run: Run) -> tuple[FloatArray, FloatArray]:
    """Total of the boots and its part against the motion (N), (2, n): from the motion at 50 Hz, and recorded.

    Both are averaged over 0.2 s. Gravity and the drag of the scenario are taken from mass times acceleration.
    """
    assert run.boots is not None
    scenario, rate = run.scenario, 50.0
    time = np.arange(run.time[0], run.time[-1], 1.0 / rate)
    sampled = [
        np.stack([np.interp(time, run.time, rows[:, axis]) for axis in range(3)], axis=1)
        for rows in (run.boots.centre_of_mass, run.boots.force.sum(axis=1))
    ]
    velocity = np.gradient(sampled[0], 1.0 / rate, axis=0)
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    angle, air = scenario.slope.angle, scenario.air  # type: ignore[union-attr]
    gravity = scenario.gravity * np.array([math.sin(angle), 0.0, -math.cos(angle)])
    drag = 0.5 * air.density * air.drag_area * speed * velocity
    found = scenario.sledge.mass * (np.gradient(velocity, 1.0 / rate, axis=0) - gravity) + drag
    even, ends = np.ones(10) / 10.0, slice(20, -20)
    forces = [
        np.stack([np.convolve(each[:, axis], even, "same") for axis in range(3)], axis=1)
        for each in (found, sampled[1])
    ]
    totals = [np.linalg.norm(force, axis=1)[ends] for force in forces]
    brakes = [-np.sum(force * velocity / speed, axis=1)[ends] for force in forces]
    return np.array(totals), np.array(brakes)


def outer_share(run: Run) -> float:
    """Median share of the outer ski where the body leans by more than 12°."""
    lean, load = run.balance.lean, run.balance.load
    turning = np.abs(lean) > math.radians(12.0)
    return float(np.median(np.where(lean > 0.0, load[:, 1], load[:, 0])[turning] / load[turning].sum(axis=1)))
