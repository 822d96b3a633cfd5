"""Runs on snow that takes time: against statics, mirror images, finer steps, and where its energy goes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from skisnow import Run
from skisnow.scenario import load_scenario
from skisnow.simulation.run_setup import Setup, set_up
from skisnow.simulation.simulated_run import simulate

DAMPED = {"snow.damping_N_s_per_mm3": 0.001}
DELAYED = {"snow.delayed_share": 0.5, "snow.retardation_time_ms": 50.0}
CASES = {"damped": DAMPED, "delayed": DELAYED, "both": {**DAMPED, **DELAYED}}
LEVEL = {"slope.angle_deg": 0.0, "start.heading_deg": 0.0, "start.speed_m_per_s": 0.0, "sledge.edge_angle_deg": 0.0}


def carved(**changes: float) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


def test_a_sledge_that_stands_sinks_to_where_softer_snow_holds_it() -> None:
    """After many retardation times H_V and H₂ in series bear at every place: H_V/(1 + H_V/H₂)."""
    changes = {**LEVEL, "snow.unloading_ratio": 1.0, "snow.penetration": "elastic"}
    stands = set_up(load_scenario("carved-46m", changes={**changes, **DELAYED}))
    first = stands.height
    stands.dynamics.advance(0.6)
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
    return setup.dynamics.snow_energies[0] + setup.dynamics.contact.groove_energy


@pytest.mark.parametrize("changes", [DAMPED, pytest.param(DELAYED, marks=pytest.mark.slow)], ids=["damped", "delayed"])
def test_what_the_normal_force_gives_is_in_the_snow_or_taken_by_its_rate(changes: dict[str, float]) -> None:
    setup = glided(**changes)
    before = in_snow(setup)
    setup.dynamics.advance(0.3)
    kept, given = in_snow(setup) - before, -setup.dynamics.work[2]
    taken = setup.dynamics.work[5] + setup.dynamics.contact.delayed_energy
    assert taken > 0.15 * given
    assert kept + taken == pytest.approx(given, rel=0.03)


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_the_account_of_a_turn_closes(changes: dict[str, float]) -> None:
    run = carved(**changes, **{"run.duration_s": 1.0})
    lost = run.energies["snow_damping"]
    assert run.outcome == "finished"
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < 1e-4
    assert lost[-1] > 1.0
    if "snow.delayed_share" not in changes:
        assert np.diff(lost).min() >= 0.0
    assert run.energies["penetration"].min() > -1e-3 * run.energy_exchanged


def test_without_it_nothing_is_lost_to_it() -> None:
    assert not carved(**{"run.duration_s": 0.3}).energies["snow_damping"].any()


@pytest.mark.parametrize(("changes", "within"), [(DAMPED, 1e-9), (DELAYED, 2e-5)], ids=["damped", "delayed"])
def test_a_turn_to_the_other_side_is_the_mirror_image(changes: dict[str, float], within: float) -> None:
    """In a groove that the delayed depth curves, rounding decides which of two knots, alike to it, is dropped."""
    ends = []
    for side in (1.0, -1.0):
        mirrored = {"start.heading_deg": -90.0 * side, "sledge.edge_angle_deg": 30.0 * side, "run.duration_s": 0.6}
        ends.append(carved(**changes, **mirrored).place[-1])
    assert ends[1] == pytest.approx(ends[0] * [1.0, -1.0, 1.0], abs=within)


@pytest.mark.slow
@pytest.mark.parametrize("changes", [DAMPED, DELAYED], ids=["damped", "delayed"])
def test_half_the_step_moves_the_end_as_little_as_without_it(changes: dict[str, float]) -> None:
    """Some 0.2 mm of 4 m at 1 ms, as snow that takes no time."""
    fixed = {**changes, "run.duration_s": 0.6, "solver.fixed": True}
    ends = [carved(**fixed, **{"solver.step_ms": step}).place[-1] for step in (4.0, 2.0, 1.0)]
    moved = [float(np.linalg.norm(ends[i + 1] - ends[i])) for i in range(2)]
    assert moved[0] < 1.2e-3
    assert moved[1] < 0.25e-3


def test_newtons_method_knows_what_the_dashpot_does() -> None:
    """Its matrix holds c over the step: without it the iterations are many times as many."""
    setup = set_up(load_scenario("carved-46m", changes={"snow.damping_N_s_per_mm3": 0.01}))
    setup.dynamics.advance(0.5)
    steps, _, _, _, iterations = setup.dynamics.counts
    assert iterations < 4.5 * steps


def test_a_dashpot_bears_a_part_where_the_depth_grows() -> None:
    """Under the shovel: a carving ski lies less deep with it, and deeper with a delayed depth."""
    depths = [carved(**changes, **{"run.duration_s": 0.6}).skis.depth[-1].max() for changes in ({}, DAMPED, DELAYED)]
    assert depths[1] < 0.99 * depths[0] < 0.98 * depths[2]
