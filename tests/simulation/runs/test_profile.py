"""A straight profile is a plane: the same run in other coordinates."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Run, Scenario
from skisnow.scenario import Plane, Profile, Solver, load_scenario
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import shovel
from .sledges import rigid_ski, scenario


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
    given = scenario(ski=ski, angle_deg=12.0, hardness=0.01, friction=0.03, drag_area=0.5, speed=6.0, duration=1.5)
    given = replace(given, contact=replace(given.contact, compaction_resistance=False))
    plane, profile, turned = both(given)
    assert profile.place == pytest.approx(turned, abs=1e-5)
    assert profile.run_length == pytest.approx(plane.run_length, abs=1e-5)
    assert profile.skis.depth == pytest.approx(plane.skis.depth, abs=1e-5)


def test_turn() -> None:
    """The snow's lines begin elsewhere by the sledge's height times tan α: the runs differ as for any other grid."""
    fixed = Solver(fixed=True, step=0.5e-3)
    given = replace(load_scenario("carved-46m", changes={"run.duration_s": 1.0}), solver=fixed)
    plane, profile, turned = both(given)
    assert profile.place[0] == pytest.approx(turned[0], abs=1e-6)
    assert profile.place == pytest.approx(turned, abs=4e-4)  # 24 mm lines: another grid moves a track by so much
    assert profile.speed == pytest.approx(plane.speed, rel=1e-4)
    for name in ("kinetic", "potential", "friction", "drag"):
        change = profile.energies[name] - profile.energies[name][0]
        assert change == pytest.approx(plane.energies[name] - plane.energies[name][0], abs=0.3), name


def test_heading_is_told_in_the_slope() -> None:
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
    changes = {"run.duration_s": 0.8, "snow.H_V_N_per_mm3": 1.0, "sledge.edge_angle_deg": edge_deg}
    given = load_scenario("carved-46m", changes=changes | {"start.heading_deg": heading_deg})
    run = simulate(replace(given, slope=hollow))
    assert run.outcome == "finished"
    assert run.place[-1, 0] > 4.0
    assert run.energies["penetration"][-1] > 1.0
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < 2e-3  # as on a plane, where the table states 0.01 to 0.5 %
