"""Straight down a plane on rigid flat skis: v² over the path in closed form."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Run, Scenario, SnowMap
from skisnow.geometry.surfaces import Grid
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import shovel
from .sledges import GRAVITY, load, rigid_ski, scenario, total_mass

ANGLE_DEG, FRICTION, DRAG_AREA, SPEED = 10.0, 0.04, 2.0, 8.0
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
            speed=SPEED,
            duration=3.0,
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
    assert run.speed**2 == pytest.approx(squared_speed(run.scenario, run.place[:, 0], 0.0, SPEED**2), rel=2e-4)
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
    given = scenario(ski=ski, compaction=False, friction=FRICTION, speed=SPEED, duration=1.3)
    x = np.arange(-5.0, 20.0, 0.5)
    share = Grid.along(x, np.where(x <= 4.0, 0.5, 2.0))
    run = simulate(replace(given, contact=replace(given.contact, snow_map=SnowMap(friction_share=share))))
    assert run.outcome == "finished"
    place, squared = run.place[:, 0], run.speed**2
    for first, last, expected in ((1.0, 3.2, 0.5), (5.5, 9.0, 2.0)):  # of the boot: the ski is 1.6 m long
        inside = (place > first) & (place < last)
        slope = np.polyfit(place[inside], squared[inside], 1)[0]
        assert slope == pytest.approx(-2.0 * expected * FRICTION * GRAVITY, rel=2e-3)
