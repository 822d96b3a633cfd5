"""Starts at rest and in balance."""

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import fsolve

from skisnow import Run, Scenario, read_ski, rest
from skisnow._support.errors import SolverError
from skisnow.contact.snow_field import STICK_DISPLACEMENT
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.run_setup import set_up
from skisnow.simulation.simulated_run import simulate
from tests.coded import raises
from tests.key_names import EDGE_ANGLE

from ...carving.synthetic import snow
from ...dynamics.sledges import left_over
from ...dynamics.test_start import HARD
from ..beyond_ranges import beyond
from .sledges import GRAVITY, load, rigid_ski, scenario, total_mass

LENGTH, WIDTH, HARDNESS = 1.6, 0.065, 0.2
INSTANT = 1e-3


def at_start(given: Scenario) -> Run:
    run = simulate(replace(given, stop=replace(given.stop, duration=INSTANT)))
    assert run.time[0] == 0.0
    return run


@pytest.mark.parametrize(("edge_angle", "hardness"), HARD)
def test_edges_on_hard_snow_find_their_balance(edge_angle: float, hardness: float) -> None:
    """Of 800 N nothing is left but rounding, held directions aside."""
    changes = {EDGE_ANGLE: edge_angle, "snow.H_V_N_per_mm3": hardness, "start.speed_m_per_s": 0.0}
    setup = set_up(load_scenario("carved-46m", changes=changes))
    assert setup.static_residual < 1e-6
    on_body, on_skis = left_over(setup.dynamics)
    assert max(np.abs(each).max() for each in (on_body[2:5], *on_skis)) < 1e-5


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"start.heading_deg": 90.0, "slope.angle_deg": 30.0}, {"ahead": 0.0, "left": -0.44}),
        ({"start.heading_deg": -90.0, "slope.angle_deg": 30.0}, {"ahead": 0.0, "left": 0.44}),
        ({"slope.angle_deg": 50.0, "start.heading_deg": 0.0}, {"ahead": 0.903, "left": 0.0}),
    ],
)
def test_a_sledge_that_falls_over_is_reported_where_its_weight_passes(
    changes: dict[str, object], expected: dict[str, float]
) -> None:
    """h tan α from the boots' middle, with the skis' weight at the base; between its skis it may fall over, too."""
    high = {"sledge.centre_of_mass_height_m": 0.8, **changes}
    with raises(SolverError, "no_start") as told:
        simulate(load_scenario("carved-46m", changes=high))
    assert {key: told.value.fields[key] for key in expected} == pytest.approx(expected, abs=0.03)
    soft = {"sledge.centre_of_mass_height_m": 2.6, "snow.H_V_N_per_mm3": 0.02}
    with raises(SolverError, "no_start"):
        simulate(load_scenario("carved-46m", changes=soft))


@pytest.mark.parametrize("edge_angle", [60.0, 70.0])
def test_steep_edges_that_hold_strongly(edge_angle: float) -> None:
    """Nothing moves faster than gravity lets it."""
    changes = {"sledge.edge_angle_deg": edge_angle, "snow.S_f_N_per_mm2": 2.0, "run.duration_s": INSTANT}
    run = simulate(load_scenario("carved-46m", changes=changes))
    assert run.outcome == "finished"
    assert abs(float(run.velocity[-1, 2] - run.velocity[0, 2])) < GRAVITY * INSTANT


@pytest.mark.parametrize("hardness", [0.002, 0.02, 0.2])
def test_rigid_flat(hardness: float) -> None:
    """F/(H_V L W), F half the weight; so stiff a ski still bends by 4e-9 m between boot and snow."""
    given = scenario(ski=rigid_ski(), hardness=hardness)
    expected = load(given) / 2.0 / (hardness * 1e9 * LENGTH * WIDTH)
    run = at_start(given)
    assert run.skis.edge_depth[0] == pytest.approx(np.full_like(run.skis.edge_depth[0], expected), rel=1e-5, abs=5e-9)


def wedges(given: Scenario, edge_angle: float) -> tuple[float, float]:
    """Depths (m) of the left and the right edge for ϑ > 0, from the balance of force and rolling moment of two wedges.

    The edges lie left of the skis' middles, so the right ski bears more, and the sledge leans by the difference.
    """
    half, stance, height = WIDTH / 2.0, given.sledge.stance_width, given.sledge.centre_of_mass[1]

    def depths(lift: float, roll: float) -> list[float]:
        across = [side * stance / 2.0 + half * math.cos(edge_angle) for side in (1.0, -1.0)]
        return [-(y * math.sin(roll) - half * math.sin(edge_angle) * math.cos(roll) + lift) for y in across]

    def unbalanced(unknown: npt.NDArray[np.float64], /) -> list[float]:
        lift, roll = (float(each) for each in unknown)
        slant = math.tan(edge_angle - roll)
        force, moment = -total_mass(given) * GRAVITY, given.sledge.mass * GRAVITY * height * math.sin(roll)
        for side, depth in zip((1.0, -1.0), depths(lift, roll), strict=True):
            bears = HARDNESS * 1e9 * LENGTH * depth**2 / (2.0 * slant)
            edge = (side * stance / 2.0 + half * math.cos(edge_angle)) * math.cos(roll)
            edge += half * math.sin(edge_angle) * math.sin(roll)
            force += bears
            moment += bears * (edge - depth / slant / 3.0)  # pressed at a third of the wedge
        return [force, moment]

    even = math.sqrt(load(given) * math.tan(edge_angle) / (HARDNESS * 1e9 * LENGTH))
    lift, roll = fsolve(unbalanced, [half * math.sin(edge_angle) - even, 0.0], xtol=1e-13)
    left, right = depths(float(lift), float(roll))
    return left, right


@pytest.mark.parametrize("edge_deg", [10.0, 30.0, 60.0])
def test_rigid_edged(edge_deg: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)) for the load and the edge angle that each ski has once the sledge leans."""
    given = scenario(ski=rigid_ski(), hardness=HARDNESS, edge_deg=edge_deg, centre_height=0.1)
    left, right = wedges(given, math.radians(edge_deg))
    even = math.sqrt(load(given) * math.tan(math.radians(edge_deg)) / (HARDNESS * 1e9 * LENGTH))
    assert left < even < right  # half the weight lies between
    depth = at_start(given).skis.edge_depth[0]
    assert depth[0] == pytest.approx(np.full_like(depth[0], left), rel=2e-5)
    assert depth[1] == pytest.approx(np.full_like(depth[1], right), rel=2e-5)
    mirrored = at_start(replace(given, sledge=replace(given.sledge, edge_angle=-given.sledge.edge_angle)))
    assert mirrored.skis.edge_depth[0] == pytest.approx(depth[::-1], abs=1e-12)


@pytest.mark.parametrize(
    ("edge_deg", "hardness"),
    [(0.0, 0.04), (0.0, 0.2), (0.0, 5.0), (40.0, 0.04), (40.0, 0.2), (40.0, 5.0), (45.0, 20.0), (60.0, 90.0)],
)
def test_flexible_as_at_rest(edge_deg: float, hardness: float) -> None:
    """`rest` knows the same ski by other equations on another mesh. The skis weigh next to nothing here."""
    ski = read_ski("giant-slalom")
    ski = replace(ski, mass_per_length=np.full_like(ski.station, 1e-4))
    fine = Solver(elements=160, line_spacing=6e-3)
    given = scenario(ski=ski, hardness=hardness, edge_deg=edge_deg, mass=160.0, solver=fine)
    given = replace(given, sledge=beyond(given.sledge, stance_width=1000.0))
    found = rest(ski, snow(hardness), edge_angle=math.radians(edge_deg), load=80.0 * GRAVITY)
    assert found.edge_depth is not None
    run = at_start(given)
    station = run.skis.station
    assert -np.trapezoid(run.skis.force_per_length[0], station) == pytest.approx([80.0 * GRAVITY] * 2, rel=5e-4)
    buried = (found.edge_depth > 0.0) & (np.abs(found.station) < 0.6)
    for depth in run.skis.edge_depth[0]:
        there = np.interp(found.station[buried], station[::-1], depth[::-1])
        # lines of 6 mm against Gauss points of 1 cm; the skis a kilometre apart lean by 0.3 µm
        assert there == pytest.approx(found.edge_depth[buried], rel=5e-3, abs=2e-6)


def flat(*, friction: float, speed: float, duration: float) -> Run:
    changes = {
        "slope.angle_deg": 2.0,
        "friction.mu_0": friction,
        "drag.drag_area_m2": 0.0,
        "start.speed_m_per_s": speed,
        "start.heading_deg": 0.0,
        "sledge.edge_angle_deg": 0.0,
        "run.duration_s": duration,
    }
    scenario = load_scenario("carved-46m", changes=changes)
    return simulate(scenario.with_(solver=Solver(output_interval=0.05)))


def test_friction_holds_a_ski_at_rest_and_a_ski_comes_to_rest_and_stays() -> None:
    """It gives by a part of the stick displacement, swings about it, and stands; that energy is counted."""
    run = flat(friction=0.05, speed=0.0, duration=3.0)
    assert run.outcome == "finished"
    assert np.abs(run.place - run.place[0]).max() < 0.1e-3
    share = math.tan(math.radians(2.0)) / 0.05  # of the friction in use
    assert run.place[-1, 0] - run.place[0, 0] == pytest.approx(share * STICK_DISPLACEMENT, rel=0.8)
    assert run.speed[-1] < 1e-9
    held = 0.5 * 0.05 * load(run.scenario) * STICK_DISPLACEMENT * share**2
    assert np.abs(run.energy_residual).max() < 0.3 * held
    # From 1.2 m/s over v²/(2 g (μ cos α - sin α)), less what the snow takes else; then it does not creep.
    run = flat(friction=0.1, speed=1.2, duration=3.0)
    slope = math.radians(2.0)
    way = run.place[-1, 0] - run.place[0, 0]
    to_snow = run.energies["penetration"][-1] + run.energies["shear"][-1]  # groove, and what the tail pushes aside
    lost = to_snow / (total_mass(run.scenario) * GRAVITY)
    braking = 0.1 * math.cos(slope) - math.sin(slope)
    assert way == pytest.approx((1.2**2 / (2.0 * GRAVITY) - lost) / braking, rel=1e-3)
    assert run.energies["friction"][-1] == pytest.approx(0.1 * load(run.scenario) * way, rel=1e-3)
    stopped = run.time > 2.4
    assert np.ptp(run.place[stopped, 0]) < 1e-6
    assert run.speed[-1] < 1e-9
