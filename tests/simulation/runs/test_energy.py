"""Energy, convergence, loads of friction, and differences between runs whose cause is known."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow import ModelLimitWarning, Run
from skisnow.contact import SnowContact, SnowField
from skisnow.forces.friction.law import ActsOn
from skisnow.scenario import load_scenario
from skisnow.simulation.run import LOST
from skisnow.simulation.simulated_run import simulate
from skisnow.simulation.verification import refine, verification_dict
from tests.key_names import DAMPING, EDGE_ANGLE

from ...carving.synthetic import circular_sidecut
from ...contact.conftest import edged, straight
from .sledges import GRAVITY, arc_base, rigid_ski, scenario
from .test_steady_circle import EDGE_DEG, LENGTH, RADIUS, SIDECUT, SPEED, sufficient_strength

SHARE = 0.005

CONTACTS = {"hypoplastic": {}, "elastic": {"snow.penetration": "elastic", "snow.unloading_ratio": 1.0}}


def closes(run: Run, changes: object) -> None:
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < SHARE, changes
    # nothing is returned that was not stored; rounding and steps leave a thousandth
    for name in LOST:
        assert run.energies[name].min() > -1e-3 * run.energy_exchanged, name


@pytest.mark.parametrize("contact", CONTACTS)
def test_one_second(contact: str) -> None:
    run = simulate(load_scenario("carved-46m", changes={**CONTACTS[contact], "run.duration_s": 1.0}))
    closes(run, contact)


def test_a_long_slip_sideways() -> None:
    """Straight down the slope across the skis, on the uphill edges: lines lie far from where they were laid."""
    changes = {
        "start.heading_deg": 90.0, "start.speed_m_per_s": 0.5, "sledge.edge_angle_deg": 8.0, "slope.angle_deg": 20.0,
        "snow.H_V_N_per_mm3": 0.5, "snow.S_f_N_per_mm2": 0.01, "run.duration_s": 2.0,
    }  # fmt: skip
    run = simulate(load_scenario("carved-46m", changes=changes))
    assert run.place[-1, 0] > 6.0
    closes(run, changes)


@pytest.mark.slow
def test_a_ski_that_hardly_touches() -> None:
    """Edges near level, of which some lines bear next to nothing: the account was open by 9 MJ of 2 kJ."""
    changes = {
        "snow.H_V_N_per_mm3": 1.2607458945051342,
        "snow.S_f_N_per_mm2": 0.24391902164090504,
        "sledge.edge_angle_deg": 2.1525122132417494,
        "sledge.centre_of_mass_height_m": 0.1581388696764569,
        "sledge.stance_width_m": 0.4186669263157286,
        "start.heading_deg": 79.36815377914232,
        "start.speed_m_per_s": 3.8168448101453025,
        "slope.angle_deg": 19.764378024404245,
        "run.duration_s": 1.5,
    }
    closes(simulate(load_scenario("carved-46m", changes=changes)), changes)


def test_friction_that_falls_with_speed_never_drives_the_ski() -> None:
    """mu = 0.02 - 0.01 v is 0 at 2 m/s; faster than that the loss stays, and the run is one without friction."""
    changes = {"friction.mu_0": 0.02, "friction.mu_1_s_per_m": -0.01, "run.duration_s": 1.5, "start.speed_m_per_s": 0.5}
    with pytest.warns(ModelLimitWarning) as caught:
        run = simulate(load_scenario("carved-46m", changes=changes))
    assert [each.message.code for each in caught if isinstance(each.message, ModelLimitWarning)] == [
        "friction_below_zero"
    ]
    lost = run.energies["friction"]
    fast = run.speed > 2.0
    assert fast.sum() > 5
    assert np.diff(lost).min() >= 0.0
    assert np.ptp(lost[fast]) <= 1e-3 * lost.max()
    closes(run, changes)


@pytest.mark.parametrize(
    "changes",
    [
        # a dashpot whose force changes much within the error of a step
        {DAMPING: 1.6, "snow.compaction_resistance": False, "solver.tolerance_mm": 0.48,
         "start.heading_deg": -145.0},
        # a start that the dashpot brakes within a first step
        {DAMPING: 4.8, "snow.H_V_N_per_mm3": 0.004, "sledge.mass_kg": 11.0,
         EDGE_ANGLE: -80.0, "sledge.inertia_kg_m2": [6.6, 6.6, 6.6], "start.speed_m_per_s": 1.0},
    ],
)  # fmt: skip
def test_a_strong_dashpot_closes(changes: dict[str, object]) -> None:
    run = simulate(load_scenario("carved-46m", changes={**changes, "run.duration_s": 0.1, "solver.method": "fast"}))
    closes(run, changes)
    assert run.energies["snow_damping"][-1] > 0.01


def test_a_run_is_repeated_with_closer_lines() -> None:
    """A light sledge on few lines: each that tip or tail passes counts for much of it."""
    changes = {
        "sledge.mass_kg": 0.46, "solver.line_spacing_mm": 200.0, "run.duration_s": 0.5, "solver.method": "fast",
        "start.speed_m_per_s": 0.55, "sledge.edge_angle_deg": 35.0, "snow.H_V_N_per_mm3": 0.02,
    }  # fmt: skip
    given = load_scenario("carved-46m", changes=changes)
    with pytest.warns(ModelLimitWarning) as caught:
        run = simulate(given)
    assert "repeated_with_closer_lines" in {getattr(each.message, "code", None) for each in caught}
    assert run.numbers["line_spacing_m"] == pytest.approx(0.200 / 4.0)
    assert run.scenario == given
    closes(run, changes)


MOST = 2.0
"""(cm)"""

CARVES = [(0.04, 0.2), (0.2, 0.5), (1.0, 1.0), (90.0, 10.0)]
"""H_V, S_f (N/mm³, N/mm²) that carve; 0.04 to 0.40 N/mm² were measured on slopes: the last three lie beyond."""
SKIDS = [(0.04, 0.04), (0.2, 0.1), (1.0, 0.25), (90.0, 0.3)]
"""H_V, S_f that skid."""


def moves(hardness: float, strength: float, **more: float) -> dict[str, Any]:
    """How far the end moves (cm) under each refinement; every run reaches its end."""
    changes = {"snow.H_V_N_per_mm3": hardness, "snow.S_f_N_per_mm2": strength, **more}
    run = simulate(load_scenario("carved-46m", changes=changes))
    assert run.outcome == "finished"
    found = verification_dict(refine(run, simulate))
    assert len(found) == 4
    assert {each["outcome"] for each in found.values()} == {"finished"}
    return {key: each["end_moves_cm"] for key, each in found.items()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hardness", "strength"),
    [
        pytest.param(
            *snow,
            marks=[pytest.mark.xfail(reason="closer lines move it by 39 mm, 20 are allowed", strict=True)]
            if snow == (0.04, 0.04)
            else [],
        )
        for snow in CARVES + SKIDS
    ],
)
def test_the_end_hardly_moves(hardness: float, strength: float) -> None:
    """The skids with edges that give way by half a millimetre; nearer to the limit they hang on the last decimetres."""
    skids = (hardness, strength) in SKIDS
    found = moves(hardness, strength, **({"shear_displacement_mm": 0.5} if skids else {}))
    assert max(found.values()) < MOST, found
    assert skids or min(found.values()) > 0.0  # the choice reached the solver


@pytest.mark.slow
def test_the_carving_snows_carve() -> None:
    """R_sc cos ϑ is 16.7 m; what carves turns within 5 % of it, what skids misses it by a quarter and more."""
    for snows, lowest, highest in ((CARVES, 0.95, 1.05), (SKIDS, 1.25, math.inf)):
        for hardness, strength in snows:
            changes = {"snow.H_V_N_per_mm3": hardness, "snow.S_f_N_per_mm2": strength}
            run = simulate(load_scenario("carved-46m", changes=changes))
            share = run.run_length / abs(run.heading[-1] - run.heading[0]) / 16.72
            assert lowest < share < highest, (hardness, strength, share)


FRICTION, EDGE = 0.05, math.radians(EDGE_DEG)


def circle(acts_on: ActsOn) -> Run:
    """Level, on rigid skis whose edges are the arc, slowed by friction only, at 80 % of the grip.

    With much more grip both ends of a ski pull against each other, which loads the base beyond the balance.
    """
    given = scenario(
        ski=rigid_ski(length=LENGTH, width=circular_sidecut(SIDECUT), base_height=arc_base(SIDECUT, EDGE_DEG)),
        strength=sufficient_strength() / 0.8,
        unloading_ratio=1.0,
        compaction=False,
        edge_deg=EDGE_DEG,
        stance=0.3,
        friction=FRICTION,
        speed=SPEED,
        duration=2.0,
    )
    return simulate(replace(given, contact=replace(given.contact, friction_acts_on=acts_on)))


def test_on_the_snow_normal_the_circle_brakes_as_a_straight_run() -> None:
    """v² = v₀² - 2 μ g s."""
    run = circle("snow-normal")
    way = np.linalg.norm(np.diff(run.place[:, :2], axis=0), axis=1).sum()
    assert SPEED**2 - run.speed[-1] ** 2 == pytest.approx(2.0 * FRICTION * GRAVITY * way, rel=2e-3)


def test_on_the_base_it_brakes_with_the_side_force() -> None:
    """m v dv/ds = -μ (m g cos ϑ + m v² sin ϑ/R) at a fixed edge angle, so that with a = 2 μ sin ϑ/R and b = R g cot ϑ
    v² = (v₀² + b) exp(-a s) - b."""
    run = circle("base-normal")
    way = np.linalg.norm(np.diff(run.place[:, :2], axis=0), axis=1).sum()
    a, b = 2.0 * FRICTION * math.sin(EDGE) / RADIUS, RADIUS * GRAVITY / math.tan(EDGE)
    lost = SPEED**2 + b - (SPEED**2 + b) * math.exp(-a * way)
    assert SPEED**2 - run.speed[-1] ** 2 == pytest.approx(lost, rel=2e-3)


def test_in_balance_it_is_the_closed_form_of_a_leaning_skier() -> None:
    """v²(s) = R g sinh(asinh(v₀²/(R g)) - 2 μ s/R), where the edge angle follows tan ϑ = v²/(R g) at every speed.

    A rigid runner is held at that angle, at the depth that bears the weight, by the share of its grip that the circle
    asks for; its drag gives the speed by a fourth-order rule of Runge and Kutta.
    """
    radius, weight, speed, hardness, reach = 12.0, 800.0, 9.0, 2e8, 0.5e-3

    def drag(square: float) -> float:
        angle = math.atan(square / (radius * GRAVITY))
        depth = math.sqrt(2.0 * weight * math.tan(angle) / (hardness * 1.6))
        strength = 2.0 * weight * math.tan(angle) / (1.6 * depth)
        snow = SnowField(hardness, strength, 1.0, FRICTION, "base-normal", "along-ski", shear_displacement=reach)
        contact = SnowContact(snow, [straight()])
        height, turned = 0.03 * math.sin(angle) - depth, edged(angle)[None]
        contact.update([[0.0, 0.0, height]], turned, 1e-3)
        motion = [[math.sqrt(square), 0, 0, 0, 0, 0]]
        found = contact.force([[1e-3 * math.sqrt(square), -0.5 * reach, height]], turned, motion, 1e-3).wrench[0]
        assert found[1:3] == pytest.approx([weight * math.tan(angle), weight], rel=1e-9)
        return float(2.0 * GRAVITY * found[0] / weight)  # dv²/ds

    way, steps, square = 20.0, 10, speed**2
    for _ in range(steps):
        h = way / steps
        first = drag(square)
        second = drag(square + 0.5 * h * first)
        third = drag(square + 0.5 * h * second)
        square += h / 6.0 * (first + 2.0 * second + 2.0 * third + drag(square + h * third))
    scale = radius * GRAVITY
    exact = scale * math.sinh(math.asinh(speed**2 / scale) - 2.0 * FRICTION * way / radius)
    assert square == pytest.approx(exact, rel=1e-5)


# Differences between runs, and from solutions apart, whose cause is known: docs/validation/simulated-turn.md


def run(**changes: Any) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


@pytest.mark.slow
def test_on_ice_fixed_steps_keep_a_change_of_rounding_small() -> None:
    """7 · 10⁻¹² m/s of the start. Steps that adapt are shortened elsewhere, which moves the end by their error."""
    ice: dict[str, Any] = {"H_V_N_per_mm3": 90.0, "S_f_N_per_mm2": 0.3, "duration_s": 3.0}
    ends = [
        run(**ice, **{"solver.fixed": True, "solver.step_ms": 0.25, "start.speed_m_per_s": 7.0 * factor}).place[-1]
        for factor in (1.0, 1.0 + 1e-12)
    ]
    assert 1e-12 < math.dist(*ends) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(("hardness", "strength"), [(0.2, 0.1), (1.0, 0.25), (5.0, 0.3)])
def test_skids_end_within_the_error_of_the_method(hardness: float, strength: float) -> None:
    snow: dict[str, Any] = {"H_V_N_per_mm3": hardness, "S_f_N_per_mm2": strength, "length_m": 15.0}
    ends = [run(**snow, **more).place[-1] for more in ({}, {"solver.fixed": True, "solver.step_ms": 0.125})]
    assert math.dist(*ends) < 7e-3


@pytest.mark.slow
def test_a_bent_ski_carries_the_sum_of_what_presses_on_its_base() -> None:
    """Friction at 52° acts on Σ max(0, N cos ϑ + Z sin ϑ), which is far above that sum for the whole ski."""
    angle = math.radians(52.0)
    turn = run(edge_angle_deg=52.0, mu_0=0.05, acts_on="base-normal", duration_s=2.0)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(turn.place, axis=0), axis=1))])
    load = np.gradient(turn.energies["friction"], way) / 0.05
    skis, spacing = turn.skis, np.abs(np.gradient(turn.skis.station))
    aside = np.sign((skis.shear_per_length * spacing).sum(axis=-1))[..., None] * skis.shear_per_length
    on_base = (skis.force_per_length * math.cos(angle) + aside * math.sin(angle)) * spacing
    whole, parts = on_base.sum(axis=(1, 2)), np.maximum(on_base, 0.0).sum(axis=(1, 2))
    late = slice(len(way) // 2, None)
    assert np.median(load[late] / parts[late]) == pytest.approx(1.0, abs=0.06)
    assert np.median(load[late] / whole[late]) > 1.5
