"""Straight runs, steady circles and steady carves against closed forms."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Run, Scenario, SnowMap, carve
from skisnow.forces.shear.law import SHEAR_DISPLACEMENT
from skisnow.geometry.surfaces import Grid
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import circular_sidecut, shovel, snow
from .sledges import GRAVITY, arc_base, load, rigid_ski, scenario, total_mass

SIDECUT, EDGE_DEG, LENGTH, HARDNESS = 60.0, 20.0, 1.6, 0.2
RADIUS = SIDECUT * math.cos(math.radians(EDGE_DEG))
SPEED = math.sqrt(GRAVITY * RADIUS * math.tan(math.radians(EDGE_DEG)))
"""At which the force on the edge stands square on the base (m/s)."""


@cache
def circle(
    *,
    strength: float,
    side: float = 1.0,
    centre_height: float = 0.0,
    solver: Solver | None = None,
    duration: float = 1.6,
    displacement: float = SHEAR_DISPLACEMENT,
) -> Run:
    """A circle to the left for side = 1, to the right for -1."""
    ski = rigid_ski(length=LENGTH, width=circular_sidecut(SIDECUT), base_height=arc_base(SIDECUT, EDGE_DEG))
    given = scenario(
        ski=ski,
        hardness=HARDNESS,
        strength=strength,
        unloading_ratio=1.0,
        compaction=False,
        edge_deg=side * EDGE_DEG,
        stance=0.3,
        centre_height=centre_height,
        speed=SPEED,
        duration=duration,
        solver=solver,
    )
    return simulate(replace(given, contact=replace(given.contact, shear_displacement=displacement)))


def radius(run: Run) -> float:
    """Path over turn in the second half (m)."""
    late = run.time > 0.5 * run.time[-1]
    return float(np.trapezoid(run.speed[late], run.time[late]) / (run.heading[late][-1] - run.heading[late][0]))


@cache
def sufficient_strength() -> float:
    """S_f (N/mm²) = m v²/R/(e₁ L + e₂ L), with the depths e at which both edges are at the start."""
    run = circle(strength=1.0, duration=1e-3)
    demand = total_mass(run.scenario) * SPEED**2 / RADIUS
    return float(demand / (LENGTH * run.skis.edge_depth[0].mean(axis=1).sum())) / 1e6


@pytest.mark.parametrize("side", [1.0, pytest.param(-1.0, marks=pytest.mark.slow)])
def test_radius_of_the_arc(side: float) -> None:
    """R_sc cos ϑ, with strong snow and lines of 6 mm.

    What is left is the edge's drift within its grip, of which 2 % are used, and the distance of the skis.
    """
    run = circle(strength=5.0, side=side, solver=Solver(line_spacing=6e-3, fixed=True, step=1e-3), duration=1.0)
    assert run.outcome == "finished"
    assert side * radius(run) == pytest.approx(RADIUS, rel=5e-3)
    assert run.speed[-1] == pytest.approx(SPEED, rel=1e-3)


@pytest.mark.slow
def test_radius_at_the_defaults() -> None:
    """Lines of 20 mm: within a quarter of a percent of what lines of 3 mm give."""
    coarse, fine = (circle(strength=0.5, solver=Solver(line_spacing=spacing)) for spacing in (None, 3e-3))
    assert radius(coarse) == pytest.approx(radius(fine), rel=2.5e-3)


@pytest.mark.parametrize("share", [0.2, 0.8])
def test_holds_below_the_limit(share: float) -> None:
    """The radius stays near that of the arc, and hardly anything is lost to shear once the turn has begun.

    It is larger by the drift of the edge within its grip, by half a percent at 80 % of it.
    """
    run = circle(strength=sufficient_strength() / share)
    assert radius(run) == pytest.approx(RADIUS, rel=0.01)
    half = len(run.time) // 2
    shear = run.energies["shear"]
    path = run.speed[-1] * (run.time[-1] - run.time[half])
    # less than a thousandth of the side force times the path
    assert abs(shear[-1] - shear[half]) < 1e-3 * total_mass(run.scenario) * SPEED**2 / RADIUS * path


def test_the_shear_displacement_is_a_parameter() -> None:
    """At 80 % of the grip the edge drifts by a share of u_y; the circle is exact within 1 % at the default 0.02 mm."""
    strength = sufficient_strength() / 0.8
    more, less = (
        radius(run) / RADIUS - 1.0
        for run in (circle(strength=strength, displacement=0.125e-3), circle(strength=strength))
    )
    assert 0.0 < less < 0.01
    assert more > 3.0 * less


def path_radius(run: Run) -> float:
    """Radius of the circle through the path in the second half (m)."""
    x, y = run.place[run.time > 0.5 * run.time[-1], :2].T
    (a, b, c), *_ = np.linalg.lstsq(np.column_stack([2.0 * x, 2.0 * y, np.ones(len(x))]), x**2 + y**2)
    return float(np.sqrt(c + a**2 + b**2))


@pytest.mark.parametrize("share", [1.1, 2.0])
def test_slips_above_the_limit(share: float) -> None:
    """The snow cannot turn it tighter than m v²/R = S_f ∫ e ds; keeping it turning takes some, so R is larger.

    v falls, by 5 % at twice the limit. The heading drifts away from the path there.
    """
    run = circle(strength=sufficient_strength() / share)
    square = float(np.mean(run.speed[run.time > 0.5 * run.time[-1]] ** 2))
    assert 1.0 < path_radius(run) / (share * RADIUS * square / SPEED**2) < 1.12
    shear = run.energies["shear"]
    half = len(run.time) // 2
    assert shear[-1] - shear[half] > 3.0


def test_a_tall_sledge_tips() -> None:
    """v²/(R g) = tan 20°: above (half the stance, and what the edges lie aside)/tan ϑ = 0.5 m it must tip, outwards."""
    run = circle(strength=5.0, centre_height=0.8)
    assert run.outcome == "tipped_over"
    assert run.attitude[-1, 2, 1] > 0.5  # the left side comes up
    assert np.isfinite(run.place).all()
    assert circle(strength=5.0, centre_height=0.2).outcome == "finished"


CARVED_EDGE_DEG = 30.0
LEVEL = {
    "slope.angle_deg": 0.0,
    "start.heading_deg": 0.0,
    "start.speed_m_per_s": 8.0,
    "friction.mu_0": 0.0,
    "drag.drag_area_m2": 0.0,
    "snow.compaction_resistance": False,
    "sledge.centre_of_mass_height_m": 0.0,
    "run.duration_s": 3.0,
    "run.output_ms": 3.7,  # every 10 ms would meet the lines, four of which pass in that time, always alike
}


def steady(hardness: float, strength: float) -> Run:
    return simulate(
        load_scenario("carved-46m", changes={**LEVEL, "snow.H_V_N_per_mm3": hardness, "snow.S_f_N_per_mm2": strength})
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hardness", "strength", "of_sidecut", "of_chord"),
    [(0.2, 5.0, 0.04, 0.01), (1.0, 5.0, 0.015, 0.012), (5.0, 20.0, 0.01, 0.02), (20.0, 50.0, 0.01, 0.03)],
)
def test_radius(hardness: float, strength: float, of_sidecut: float, of_chord: float) -> None:
    """The path is that of the whole contact: the circle through the boot and the contact's ends, not that at the boot.

    Measured against R_sc cos ϑ: -3.0, -0.1, -0.1, +0.1 % at 0.2, 1, 5, 20 N/mm³; in soft snow the middle is deeper.
    Against the mean of both skis' chord circles under the loads they have in the run: -0.3, -0.0, -1.4, -1.9 %.
    The circle at the boot ± 0.4 m is 10 to 16 % larger: the clamp of 0.3 m straightens the ski there.
    """
    run = steady(hardness, strength)
    ski, edge = run.scenario.ski, math.radians(CARVED_EDGE_DEG)
    late = run.time > 1.5
    path = np.trapezoid(run.speed[late], run.time[late])
    radius = float(path / (run.heading[late][-1] - run.heading[late][0]))
    assert radius == pytest.approx(ski.sidecut_radius_of_edge_line * math.cos(edge), rel=of_sidecut)
    loads = -np.trapezoid(run.skis.force_per_length[late], run.skis.station, axis=2).mean(axis=0)
    weight = (run.scenario.sledge.mass + 2.0 * ski.mass) * 9.81
    assert loads.sum() == pytest.approx(weight, rel=0.02)  # sampled at the nodes, every 45 mm
    assert loads[0] < loads[1]  # the edges lie left of the skis' middles: the right ski bears more
    found = [
        carve(ski, snow(hardness, strength), edge_angle=edge, load=float(load), unloading_ratio=10.0) for load in loads
    ]
    chord = [each.turn_radius_chord for each in found]
    boot = [each.turn_radius_boot for each in found]
    assert None not in chord
    assert None not in boot
    assert radius == pytest.approx(np.mean(np.array(chord, float)), rel=of_chord)
    assert 1.08 < np.mean(np.array(boot, float)) / radius < 1.18


ANGLE_DEG, FRICTION, DRAG_AREA, STRAIGHT_SPEED = 10.0, 0.04, 2.0, 8.0
WIDTH = 0.065
SOFT = 0.001
"""H_V (N/mm³): so soft that a flat ski sinks 5 mm and its groove costs 1.7 N."""


def straight(*, compaction: bool, unloading_ratio: float = 10.0) -> Run:
    """Down the fall line, on skis with a shovel at either end: without one the base would meet the snow with a wall."""
    ski = rigid_ski(width=WIDTH, base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    return simulate(
        scenario(
            ski=ski,
            angle_deg=ANGLE_DEG,
            hardness=SOFT,
            unloading_ratio=unloading_ratio,
            compaction=compaction,
            friction=FRICTION,
            drag_area=DRAG_AREA,
            speed=STRAIGHT_SPEED,
            duration=2.2,
        )
    )


def squared_speed(given: Scenario, path: npt.NDArray[np.float64], resistance: float, before: float) -> object:
    """v² = v∞² + (v₀² - v∞²) exp(-s/ℓ) with a constant resistance besides friction and drag (N)."""
    mass = total_mass(given)
    decay = mass / (given.air.density * given.air.drag_area)
    downhill = mass * GRAVITY * math.sin(math.radians(ANGLE_DEG)) - FRICTION * load(given) - resistance
    final = 2.0 * downhill / (given.air.density * given.air.drag_area)
    return final + (before - final) * np.exp(-path / decay)


def test_without_compaction() -> None:
    """The whole run. The load swings by tenths of a percent as the sledge settles; friction averages over that."""
    run = straight(compaction=False)
    assert run.outcome == "finished"
    assert run.speed**2 == pytest.approx(squared_speed(run.scenario, run.place[:, 0], 0.0, STRAIGHT_SPEED**2), rel=2e-4)
    assert np.abs(run.place[:, 1]).max() < 1e-8  # rounding, which the shovels amplify
    assert run.run_length == pytest.approx(run.place[-1, 0], rel=1e-6)
    assert run.energies["friction"][-1] == pytest.approx(FRICTION * load(run.scenario) * run.place[-1, 0], rel=1e-3)


@pytest.mark.parametrize("unloading_ratio", [10.0, 2.0])
def test_groove_is_paid_for(unloading_ratio: float) -> None:
    """Once the groove is even: a resistance of ½ H ε² (1 - H/k_u) W for each ski, whatever the shape of the shovel.

    It is 1.5 % of the weight's pull. Its loss is known from the snow, its force from the base's slope: both must agree.
    """
    run = straight(compaction=True, unloading_ratio=unloading_ratio)
    path = run.place[:, 0]
    even = (run.groove.middle[:, 0] > 8.0) & (run.groove.middle[:, 0] < path[-1] - 1.0)
    depth = run.groove.depth[even]
    resistance = 2.0 * 0.5 * SOFT * 1e9 * np.mean(depth**2) * (1.0 - 1.0 / unloading_ratio) * WIDTH
    assert run.groove.width[even] == pytest.approx(np.full(depth.size, WIDTH), rel=1e-7)  # kept in single precision
    assert run.groove.residual_depth[even] == pytest.approx(depth * (1.0 - 1.0 / unloading_ratio), rel=1e-12)
    steady = np.flatnonzero((path > 8.0) & (path < path[-1] - 1.0))
    first, last = steady[0], steady[-1]
    way = path[last] - path[first]
    lost = run.energies["penetration"]
    # the energy is counted line by line, every 24 mm of 16 m, and by trapezoids over the steps
    assert (lost[last] - lost[first]) / way == pytest.approx(resistance, rel=5e-3)
    expected = squared_speed(run.scenario, path[steady] - path[first], resistance, run.speed[first] ** 2)
    free = squared_speed(run.scenario, path[steady] - path[first], 0.0, run.speed[first] ** 2)
    # the shovel meets line after line: its force swings by a percent of the load about the mean
    assert run.speed[steady] ** 2 == pytest.approx(expected, rel=6e-5)
    lacking = np.asarray(free)[-1] - run.speed[last] ** 2
    assert lacking == pytest.approx(np.asarray(free)[-1] - np.asarray(expected)[-1], rel=0.02)


def test_elastic_snow_costs_nothing() -> None:
    """Snow that springs back returns at the tail what it took at the tip."""
    run = straight(compaction=True, unloading_ratio=1.0)
    path = run.place[:, 0]
    late = path > 4.0
    expected = squared_speed(run.scenario, path[late] - path[late][0], 0.0, run.speed[late][0] ** 2)
    assert run.speed[late] ** 2 == pytest.approx(expected, rel=5e-5)
    assert abs(run.energies["penetration"][-1]) < 1e-3 * run.energies["friction"][-1]


def test_friction_over_the_place_gives_its_own_slope_of_v_squared() -> None:
    """On a level: v² falls by 2 μ g for each metre, with the μ of each piece. The map rises between 4 and 4.5 m."""
    ski = rigid_ski(width=WIDTH, base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    given = scenario(ski=ski, compaction=False, friction=FRICTION, speed=STRAIGHT_SPEED, duration=1.3)
    x = np.arange(-5.0, 20.0, 0.5)
    share = Grid.along(x, np.where(x <= 4.0, 0.5, 2.0))
    run = simulate(replace(given, contact=replace(given.contact, snow_map=SnowMap(friction_share=share))))
    assert run.outcome == "finished"
    place, squared = run.place[:, 0], run.speed**2
    for first, last, expected in ((1.0, 3.2, 0.5), (5.5, 9.0, 2.0)):  # of the boot: the ski is 1.6 m long
        inside = (place > first) & (place < last)
        slope = np.polyfit(place[inside], squared[inside], 1)[0]
        assert slope == pytest.approx(-2.0 * expected * FRICTION * GRAVITY, rel=2e-3)
