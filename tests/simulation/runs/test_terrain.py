"""Runs on profiles and terrain, and the rate of output."""

import csv
import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Run, Scenario
from skisnow.scenario import Plane, Profile, Solver, Terrain, load_scenario
from skisnow.simulation.run_setup import Setup, set_up
from skisnow.simulation.simulated_run import simulate
from tests.present import present

from ...carving.synthetic import shovel
from .sledges import rigid_ski, scenario

FloatArray = npt.NDArray[np.float64]

PLAIN = """\
[slope]
kind = "grid"
grid = "heights.csv"
[snow]
H_V_N_per_mm3 = 0.2
S_f_N_per_mm2 = 0.5
unloading_ratio = 10.0
[friction]
mu_0 = 0.01
[drag]
drag_area_m2 = 0.42
[sledge]
mass_kg = 80.0
inertia_kg_m2 = [6.0, 8.0, 10.0]
centre_of_mass_height_m = 0.12
stance_width_m = 0.50
edge_angle_deg = 30.0
[ski]
name = "giant-slalom"
[start]
speed_m_per_s = 7.0
heading_deg = {heading!r}
[run]
duration_s = 0.3
"""
"""carved-46m, but for its slope."""


def write_heights(path: Path, x: FloatArray, y: FloatArray, height: FloatArray) -> None:
    """Rows from the last place to the first: their order does not count."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream)
        rows.writerow(["x_m", "y_m", "z_m"])
        rows.writerows(
            map(repr, (float(x[i]), float(y[j]), float(height[i, j]))) for i, j in list(np.ndindex(height.shape))[::-1]
        )


def test_tilted_plane_as_a_grid_gives_the_run_of_the_plane(tmp_path: Path) -> None:
    """With the fall line turned by 35 degrees to the left of x: the same run in other coordinates.

    A metre of the run is 2e-16 m in the last digit, the snow is met thousands of times: 1e-12 m is what is left.
    """
    on_plane = carved(**{"run.duration_s": 0.3})
    slope = on_plane.scenario.slope
    assert isinstance(slope, Plane)
    fall = math.tan(slope.angle)
    direction = np.array([math.cos(math.radians(35.0)), math.sin(math.radians(35.0))])
    x, y = np.linspace(-3.0, 12.0, 16), np.linspace(-12.0, 12.0, 13)
    write_heights(tmp_path / "heights.csv", x, y, -fall * np.add.outer(x * direction[0], y * direction[1]))

    down = np.array([*direction, -fall]) * math.cos(slope.angle)  # of space in the slope's own axes, each a row
    out = np.array([fall * direction[0], fall * direction[1], 1.0]) * math.cos(slope.angle)
    axes = np.stack([down, np.cross(out, down), out])
    towards_x = np.array([1.0, 0.0, -fall * direction[0]])
    of_fall_line = math.atan2(down @ np.cross(out, towards_x), down @ towards_x)
    file = tmp_path / "turn.toml"
    file.write_text(PLAIN.format(heading=-30.0 + math.degrees(of_fall_line)), encoding="utf-8")

    run = simulate(load_scenario(file))
    assert run.time[-1] == 0.3
    np.testing.assert_allclose(run.place, on_plane.place @ axes, atol=1e-9)
    np.testing.assert_allclose(run.skis.depth, on_plane.skis.depth, atol=1e-9)
    np.testing.assert_allclose(run.heading - of_fall_line, on_plane.heading, atol=1e-9)


def pipe(x: FloatArray, y: FloatArray) -> FloatArray:
    """Waves 14 m long down the slope, and sides that rise like those of a half-pipe."""
    return np.asarray(-0.15 * x + 0.25 * np.cos(2.0 * np.pi * x / 14.0) + 0.02 * y**2)


def run_in_pipe(changes: dict[str, float]) -> Run:
    x, y = np.arange(0.0, 40.0, 0.5), np.arange(-8.0, 8.5, 0.5)
    given = {"start.x_m": 3.0, "start.speed_m_per_s": 6.0, "friction.mu_0": 0.0, "drag.drag_area_m2": 0.0}
    terrain = Terrain(x, y, pipe(x[:, None], y[None, :]))
    run = simulate(load_scenario("carved-46m", changes=given | changes).with_(slope=terrain))
    assert run.outcome == "finished"
    np.testing.assert_allclose(run.place[:, 2], pipe(run.place[:, 0], run.place[:, 1]), atol=0.04)  # on the snow
    assert present(run.energy_balance_error) < 2e-3
    return run


@pytest.mark.slow
def test_without_loss_speed_is_height_over_rollers() -> None:
    """Along the bottom of the pipe, on elastic snow that holds no shear, without friction and drag: v² = v₀² - 2 g Δz.

    v and z are those of the centre of mass, 12 cm above the boots: it is slower than they are in a hollow. Beside it
    there are a bounce on the snow's springs, and the pitch of the sledge: a joule of 1500.
    """
    straight = {"start.heading_deg": 0.0, "sledge.edge_angle_deg": 0.0, "run.duration_s": 2.0}
    run = run_in_pipe(straight | {"snow.unloading_ratio": 1.0, "snow.S_f_N_per_mm2": 1e-4})
    assert np.abs(run.place[:, 1]).max() < 1e-6
    assert np.ptp(run.place[:, 2]) > 1.5
    centre = run.place + 0.12 * run.attitude[:, :, 2]
    speed = np.linalg.norm(np.gradient(centre, run.time, axis=0, edge_order=2), axis=1)
    by_height = speed[0] ** 2 + 2.0 * 9.81 * (centre[0, 2] - centre[:, 2])
    np.testing.assert_allclose(speed, np.sqrt(by_height), atol=0.015)


def test_energy_closes_along_a_bank() -> None:
    """Across the pipe and up its side in plastic snow, edges at work: what is lost is counted, the rest is there."""
    run = run_in_pipe(
        {"start.y_m": 2.0, "start.heading_deg": 25.0, "sledge.edge_angle_deg": 8.0, "run.duration_s": 1.0}
    )
    assert run.place[-1, 1] > 3.5
    assert run.energies["penetration"][-1] > 1.0


@pytest.mark.parametrize(
    ("heading_deg", "x_m", "y_m"), [(0.0, 5.0, 0.0), (80.0, 0.0, 1.0), (-80.0, 0.0, -1.0), (170.0, -1.0, 0.0)]
)
def test_each_border_of_a_grid_ends_the_run(heading_deg: float, x_m: float, y_m: float) -> None:
    x, y = np.linspace(-3.0, 7.0, 11), np.linspace(-3.0, 3.0, 7)
    height = np.repeat(-0.02 * x[:, None], len(y), axis=1)
    changes = {"start.x_m": x_m, "start.y_m": y_m, "start.heading_deg": heading_deg, "run.duration_s": 1.0}
    flat = {"sledge.edge_angle_deg": 0.0, "solver.method": "fast"}
    run = simulate(load_scenario("carved-46m", changes=changes | flat).with_(slope=Terrain(x, y, height)))
    assert run.outcome == "end_of_slope"
    assert 0.05 < run.simulated_s < 0.4


def both(given: Scenario) -> tuple[Run, Run, npt.NDArray[np.float64]]:
    """The run on the plane, that on the profile, and the first one's places as x horizontal, y left, z up."""
    assert isinstance(given.slope, Plane)
    angle = given.slope.angle
    x = np.linspace(-20.0, 60.0, 81)
    plane = simulate(given)
    profile = simulate(replace(given, slope=Profile(x, -math.tan(angle) * x)))
    c, s = math.cos(angle), math.sin(angle)
    turned = plane.place @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
    return plane, profile, turned


def test_straight_down() -> None:
    """Without the resistance of the shovel, which swings as it meets line after line, and these begin elsewhere.

    The sledge bounces undamped on the shovels as they meet the lines: 5 µm of height, in another phase.
    """
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    given = scenario(ski=ski, angle_deg=12.0, hardness=0.01, friction=0.03, drag_area=0.5, speed=6.0, duration=0.9)
    given = replace(given, contact=replace(given.contact, compaction_resistance=False))
    plane, profile, turned = both(given)
    assert profile.place == pytest.approx(turned, abs=1e-5)
    assert profile.run_length == pytest.approx(plane.run_length, abs=1e-5)
    assert profile.skis.depth == pytest.approx(plane.skis.depth, abs=1e-5)


def test_turn() -> None:
    """The snow's lines begin elsewhere by the sledge's height times tan α: the runs differ as for any other grid."""
    fixed = Solver(fixed=True, step=0.5e-3)
    given = replace(load_scenario("carved-46m", changes={"run.duration_s": 0.3}), solver=fixed)
    plane, profile, turned = both(given)
    assert profile.place[0] == pytest.approx(turned[0], abs=1e-6)
    assert profile.place == pytest.approx(turned, abs=4e-4)  # 24 mm lines: another grid moves a track by so much
    assert profile.speed == pytest.approx(plane.speed, rel=1e-4)
    for name in ("kinetic", "potential", "friction", "drag"):
        change = profile.energies[name] - profile.energies[name][0]
        assert change == pytest.approx(plane.energies[name] - plane.energies[name][0], abs=0.3), name


def test_heading_is_reported_in_the_slope() -> None:
    """As the start's heading is given: from the fall line, in the snow's surface."""
    plane, profile, _ = both(load_scenario("carved-46m", changes={"run.duration_s": 0.05}))
    tilt = 1e-3  # °: settled into its grooves the sledge pitches and rolls by milliradians, whose product turns it
    assert math.degrees(plane.heading[0]) == pytest.approx(-30.0, abs=tilt)
    assert math.degrees(profile.heading[0]) == pytest.approx(-30.0, abs=tilt)


@pytest.mark.parametrize(("edge_deg", "heading_deg"), [(0.0, 0.0), (20.0, -20.0)])
def test_energy_closes_in_a_hollow(edge_deg: float, heading_deg: float) -> None:
    """Into a bottom of 20 m radius: lines that crowded before the tips once made 20 % of the energy out of nothing."""
    x = np.linspace(-3.0, 12.0, 61)
    hollow = Profile(x, 20.0 - np.sqrt(400.0 - (x - 8.0) ** 2))
    changes = {"run.duration_s": 0.65, "snow.H_V_N_per_mm3": 1.0, "sledge.edge_angle_deg": edge_deg}
    given = load_scenario("carved-46m", changes=changes | {"start.heading_deg": heading_deg})
    run = simulate(replace(given, slope=hollow))
    assert run.outcome == "finished"
    assert run.place[-1, 0] > 4.0
    assert run.energies["penetration"][-1] > 1.0
    assert present(run.energy_balance_error) < 2e-3  # as on a plane, where the table states 0.01 to 0.5 %


DAMPED = {"snow.damping_N_s_per_mm3": 0.001}
DELAYED = {"snow.delayed_share": 0.5, "snow.retardation_time_ms": 50.0}
CASES = {"damped": DAMPED, "both": {**DAMPED, **DELAYED}}
LEVEL = {"slope.angle_deg": 0.0, "start.heading_deg": 0.0, "start.speed_m_per_s": 0.0, "sledge.edge_angle_deg": 0.0}


@cache
def carved(**changes: float) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


def test_a_sledge_that_stands_sinks_to_where_softer_snow_holds_it() -> None:
    """After many retardation times H_V and H₂ in series bear at every place: H_V/(1 + H_V/H₂)."""
    changes = {**LEVEL, "snow.unloading_ratio": 1.0, "snow.penetration": "elastic"}
    stands = set_up(load_scenario("carved-46m", changes={**changes, **DELAYED}))
    first = stands.height
    stands.dynamics.advance(0.4)
    hardness = stands.scenario.contact.snow.snow_hardness * 1e-9
    softer = set_up(load_scenario("carved-46m", changes={**changes, "snow.H_V_N_per_mm3": hardness / 1.5}))
    assert softer.height < first - 2e-5
    assert first - stands.height == pytest.approx(first - softer.height, rel=5e-3)


def glided(**changes: float) -> Setup:
    """Straight on, with a ski whose edges are straight: all that the normal force does goes into the snow."""
    scenario = load_scenario(
        "carved-46m",
        changes={"sledge.edge_angle_deg": 0.0, "start.heading_deg": 0.0, "solver.line_spacing_mm": 10.0, **changes},
    )
    ski = replace(scenario.ski, width=np.full_like(scenario.ski.width, 0.07))
    return set_up(replace(scenario, ski=ski))


def in_snow(setup: Setup) -> float:
    return setup.dynamics.part("snow_energies")[0] + setup.dynamics.contact.groove_energy


@pytest.mark.parametrize("changes", [DAMPED, pytest.param(DELAYED, marks=pytest.mark.slow)], ids=["damped", "delayed"])
def test_what_the_normal_force_gives_is_in_the_snow_or_taken_by_its_rate(changes: dict[str, float]) -> None:
    setup = glided(**changes)
    before = in_snow(setup)
    setup.dynamics.advance(0.2)
    kept, given = in_snow(setup) - before, -setup.dynamics.part("work")[2]
    taken = setup.dynamics.part("work")[5] + setup.dynamics.contact.delayed_energy
    assert taken > 0.15 * given
    assert kept + taken == pytest.approx(given, rel=0.03)


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_the_account_of_a_turn_closes(changes: dict[str, float]) -> None:
    run = carved(**changes, **{"run.duration_s": 0.3})
    lost = run.energies["snow_damping"]
    assert run.outcome == "finished"
    assert present(run.energy_balance_error) < 1e-4
    assert lost[-1] > 0.9
    if "snow.delayed_share" not in changes:
        assert np.diff(lost).min() >= 0.0
    assert run.energies["penetration"].min() > -1e-3 * run.energy_exchanged


@pytest.mark.parametrize(("changes", "within"), [(DAMPED, 1e-9), (DELAYED, 2e-5)], ids=["damped", "delayed"])
def test_a_turn_to_the_other_side_is_the_mirror_image(changes: dict[str, float], within: float) -> None:
    """In a groove that the delayed depth curves, rounding decides which of two knots, alike to it, is dropped."""
    ends = []
    for side in (1.0, -1.0):
        mirrored = {"start.heading_deg": -90.0 * side, "sledge.edge_angle_deg": 30.0 * side, "run.duration_s": 0.15}
        ends.append(carved(**changes, **mirrored).place[-1])
    assert ends[1] == pytest.approx(ends[0] * [1.0, -1.0, 1.0], abs=within)


def test_newtons_method_knows_what_the_dashpot_does() -> None:
    """Its matrix holds c over the step: without it the iterations are many times as many."""
    setup = set_up(load_scenario("carved-46m", changes={"snow.damping_N_s_per_mm3": 0.01}))
    setup.dynamics.advance(0.25)
    steps, _, _, _, iterations = setup.dynamics.counts
    assert iterations < 4.5 * steps


def test_a_dashpot_bears_a_part_where_the_depth_grows() -> None:
    """Under the shovel: a carving ski lies less deep with it, and deeper with a delayed depth; at 0.3 s."""
    runs = [carved(**how, **{"run.duration_s": 0.3}) for how in ({}, DAMPED, DELAYED)]
    assert not runs[0].energies["snow_damping"].any()
    depths = [run.skis.depth[30].max() for run in runs]
    assert depths[1] < 0.99 * depths[0] < 0.98 * depths[2]
