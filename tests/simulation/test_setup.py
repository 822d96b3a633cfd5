"""Setup of a run and its verification with finer choices."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import skisnow
from skisnow import BootMoment, BootPose, Run, Scenario
from skisnow._support.errors import ParameterError
from skisnow.contact import Laws
from skisnow.geometry.surfaces import Grid
from skisnow.scenario import Plane, Skier, Solver, load_scenario
from skisnow.simulation import run_setup, simulated_run
from skisnow.simulation.run_setup import Setup, _boot_drive, _start, _strength_share, laid_out
from skisnow.simulation.simulated_run import simulate
from skisnow.simulation.verification import (
    Refinement,
    limit_warnings,
    nudged_scenarios,
    refined_solvers,
    repetitions,
    verification_dict,
    verify,
)
from tests.key_names import DELAYED_SPACING, EDGE_ANGLE, LINE_SPACING, SHEAR_DISPLACEMENT

from ..carving.synthetic import plain_ski
from .runs.sledges import load, scenario
from .straight_run import STRAIGHT, straight_run


@pytest.mark.parametrize(("load", "sinks"), [(1699.0, False), (1701.0, True)])
def test_snow_that_does_not_bear_a_ski_a_decimetre_deep(load: float, sinks: bool) -> None:
    """1.7 m by 0.1 m, 0.1 m deep in 0.1 MN/m³: 1700 N."""
    ski = SimpleNamespace(
        station=np.array([0.9, 0.2, -0.8]), at=lambda station: SimpleNamespace(width=np.full_like(station, 0.1))
    )
    contact = SimpleNamespace(hardness_at=lambda x, y: 1e5 + x + y)
    snow = SimpleNamespace(contact=contact, start=SimpleNamespace(x=0.0, y=0.0), ski=ski)
    stub = cast("Any", SimpleNamespace(scenario=snow, numbers={"load_N": load}))
    assert cast("Any", Setup.sinks).fget(stub) is sinks


@pytest.mark.parametrize(
    ("edge", "above"), [(0.0, -0.01), (math.pi / 6.0, 0.01), (-math.pi / 6.0, 0.01), (math.pi / 2.0, 0.03)]
)
def test_a_sledge_begins_as_high_over_the_snow_as_its_lower_edges_are_deep(edge: float, above: float) -> None:
    """A waist of 0.08 m, 10 mm deep: edged by 30° the middle of its base is 0.04 m sin 30° - 0.01 m over the snow."""
    ski = SimpleNamespace(at=lambda _: SimpleNamespace(width=0.08))
    parts: dict[str, Any] = {"slope": Plane(0.3), "ski": ski, "sledge": SimpleNamespace(edge_angle=edge)}
    begun = SimpleNamespace(x=2.0, y=3.0, heading=math.pi / 3.0)
    place, rotation = _start(cast("Any", SimpleNamespace(start=begun, **parts)), 0.01)
    assert place == pytest.approx([2.0, 3.0, above], abs=1e-12)
    cos, sin = 0.5, math.sqrt(0.75)
    assert rotation == pytest.approx(np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))


IN_THE_AIR = SimpleNamespace(touches=False)


@pytest.mark.parametrize(
    ("parts", "flying", "skied", "outcome"),
    [
        ({"tilt": (1.04, 0.0)}, 0.29, False, None),
        ({"tilt": (1.05, 0.0)}, 0.3, False, "tipped_over"),
        ({"tilt": (1.05, 0.0)}, 0.3, True, "fell"),
        ({"tilt": (0.0, 0.7)}, 0.3, False, "tipped_over"),
        ({"tilt": (0.0, 0.69), "height": -0.6}, 0.3, False, "airborne"),
        ({"tilt": (0.0, 0.7), "dynamics": IN_THE_AIR}, 0.3, False, "airborne"),
        ({"height": 1.9, "tilt": (1.2, 0.7), "dynamics": IN_THE_AIR}, 0.3, True, None),
        ({"height": 2.1, "dynamics": IN_THE_AIR}, 0.3, True, "airborne"),
        ({"height": -0.51, "past_end": True}, 0.0, False, "sunk"),
        ({"height": -0.49, "past_end": True}, 0.0, False, "end_of_slope"),
    ],
)
def test_what_ends_a_run_on_its_way(parts: dict[str, Any], flying: float, skied: bool, outcome: str | None) -> None:
    """Leaning by 60°, on the snow by 40° ahead, 0.3 s in the air (a skier above 2 m), sunk, off."""
    scenario = SimpleNamespace(skier=Skier() if skied else None)
    usual: dict[str, Any] = {"tilt": (0.0, 0.0), "height": 0.0, "past_end": False}
    usual |= {"dynamics": SimpleNamespace(touches=True), "drive": None}
    stub = cast("Any", SimpleNamespace(scenario=scenario, **usual | parts))
    assert simulated_run._current_outcome(stub, flying) == outcome


def test_boots_that_nothing_carries_turn_as_a_level_between_their_skis() -> None:
    """Skis at 0.2 and 0.4 rad, one up and one down as much: ahead at 0.3, left, and off the snow."""
    boots = np.zeros((2, 6, 3))
    boots[:, 1] = [[math.cos(0.2), math.sin(0.2), 0.3], [math.cos(0.4), math.sin(0.4), -0.1]]
    dynamics, drive = SimpleNamespace(boots=boots), SimpleNamespace(held=True)
    normal = np.array([0.0, 0.0, 1.0])
    stub = SimpleNamespace(dynamics=dynamics, drive=drive, place=np.zeros(3), slope_normal=lambda *_: normal)
    cos, sin = math.cos(0.3), math.sin(0.3)
    found = cast("Any", Setup.attitude).fget(stub)
    assert found == pytest.approx(np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))


@pytest.mark.parametrize(("method", "elements", "spacing"), [("default", 54.0, 0.01), ("fast", 36.0, 0.0125)])
def test_a_ski_that_bends_in_short_waves_has_elements_and_lines_to_each(
    method: str, elements: float, spacing: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """1.8 m of giant-slalom ski and waves of 0.1 m: three elements and ten lines each, two and eight of `fast`."""
    scenario, contact = load_scenario("carved-46m", changes={"solver.method": method}), run_setup._contact
    monkeypatch.setattr(run_setup, "_contact", lambda each: (*contact(each)[:2], 0.1))
    found = laid_out(scenario).numbers
    assert float(scenario.ski.station[0] - scenario.ski.station[-1]) == pytest.approx(1.8)
    assert found["elements"] == elements
    assert found["line_spacing_m"] == pytest.approx(spacing)


@pytest.mark.parametrize("edge_deg", [0.0, 45.0])
def test_elements_and_lines_follow_from_the_waves_of_a_beam_on_an_elastic_foundation(edge_deg: float) -> None:
    """Hetényi: 1/λ = (4 EI/k)^(1/4), k = H_V times the width that bears.

    Flat, all of the ski bears; edged by 45° as much as the wedge is deep, of which F = H_V L e²/2 over 0.8 of the ski.
    """
    given = scenario(ski=plain_ski(length=1.6, width=0.065, bending=300.0), hardness=60.0, edge_deg=edge_deg)
    force = load(given) / 2.0
    bears = math.sqrt(2.0 * force / (60e9 * 0.8 * 1.6)) if edge_deg else 0.065
    wave = (4.0 * 300.0 / (60e9 * bears)) ** 0.25
    found = laid_out(given).numbers
    assert found["load_N"] == pytest.approx(force, rel=1e-9)
    assert found["line_spacing_m"] == pytest.approx(wave / 10.0, rel=1e-9)
    assert found["elements"] == math.ceil(3.0 * 1.6 / wave) > 36.0


@pytest.mark.parametrize(("method", "length", "spacing"), [("default", 0.05, 0.02), ("fast", 0.075, 0.025)])
def test_in_soft_snow_elements_and_lines_have_their_largest_size(method: str, length: float, spacing: float) -> None:
    """1.8 m of giant-slalom ski, and two lines of snow or more on each element."""
    changes = {"snow.H_V_N_per_mm3": 0.02, "solver.method": method}
    found = laid_out(load_scenario("carved-46m", changes=changes)).numbers
    assert 1.8 / found["elements"] == pytest.approx(length)
    assert found["line_spacing_m"] == spacing


def test_boots_are_moved_by_one_alone() -> None:
    """A function, the table of the scenario (which holds the body in the slope's frame), or nothing."""

    def control(_: BootMoment) -> list[BootPose]:
        return []

    def asked(*, frame: str = "", by: Any = None) -> Any:
        boots = cast("Any", SimpleNamespace(frame=frame)) if frame else None
        return _boot_drive(cast("Any", SimpleNamespace(boots=boots, skier=None)), by)

    assert asked() is None
    assert (asked(by=control).control, asked(by=control).held) == (control, False)
    assert (asked(frame="sledge").held, asked(frame="slope").held) == (False, True)
    with pytest.raises(ParameterError, match=r"boots\.file"):
        asked(frame="sledge", by=control)


def test_the_strength_over_the_place_is_a_share_of_its_mean() -> None:
    strength = Grid.along([0.0, 10.0], [0.3e6, 0.5e6])
    for known, mean in ((None, 0.4e6), (strength, None)):
        assert _strength_share(cast("Any", SimpleNamespace(failure_shear_stress=known, mean_stress=mean))) == 1.0
    assert _strength_share(None) == 1.0
    share = _strength_share(cast("Any", SimpleNamespace(failure_shear_stress=strength, mean_stress=0.4e6)))
    assert isinstance(share, Grid)
    assert share.values_at(np.array([0.0, 5.0, 10.0]), np.zeros(3)) == pytest.approx([0.75, 1.0, 1.25])


def test_a_stiffness_factor_multiplies_both_stiffnesses() -> None:
    """Sixteen times EI: waves, and with them the spacing of lines, of twice the length. 1 is the ski itself."""
    plain = scenario(ski=plain_ski(length=1.6, width=0.065, bending=300.0), hardness=20.0)
    stiff = plain.with_(stiffness_factor=16.0)
    assert stiff.flexing_ski.torsional_stiffness == pytest.approx(16.0 * plain.ski.torsional_stiffness)
    ratio = laid_out(stiff).numbers["line_spacing_m"] / laid_out(plain).numbers["line_spacing_m"]
    assert ratio == pytest.approx(2.0, rel=1e-9)
    assert plain.flexing_ski is plain.ski


def test_a_rounding_of_the_camber_is_that_of_the_ski_file(tmp_path: Path) -> None:
    """By the key of a scenario as by that of a ski file; a ski without camber has neither."""
    plain = load_scenario("carved-46m")
    keys = (Path(skisnow.ski.__file__).parent / "catalogue" / "giant-slalom.toml").read_text(encoding="utf-8")
    (tmp_path / "rounded.toml").write_text(keys + "camber_rounding_mm = 50\n", encoding="utf-8")
    said = skisnow.read_ski(tmp_path / "rounded.toml")
    rounded = plain.with_(camber_rounding_mm=50)
    assert rounded.ski.base_height == pytest.approx(said.base_height, abs=1e-15)
    assert np.max(np.abs(rounded.ski.base_height - plain.ski.base_height)) > 1e-4
    assert rounded.with_(camber_rounding_mm=100).ski.base_height == pytest.approx(plain.ski.base_height, abs=1e-15)
    with pytest.raises(ParameterError, match="no camber"):
        plain.with_(clamp_length_m=0.0).with_(ski="paper-tool", camber_rounding=0.05)


@pytest.mark.parametrize("law", ["constant", "by-angle", "machining"])
def test_the_law_of_shear_is_that_of_the_scenarios_snow(law: str) -> None:
    given = load_scenario("carved-46m", changes={"shear.law": law, "snow.S_f_N_per_mm2": 0.3})
    found = run_setup._snow_field(given, Laws())
    assert found.failure_shear_stress == pytest.approx(0.3e6)
    assert found.shear == given.shear.of(0.3e6)
    assert (found.shear is None) == (law == "constant")


KEYS = ["solver.tolerance_mm", "solver.elements", "solver.line_spacing_mm", "solver.groove_tolerance"]
NUDGED = ["start.speed_m_per_s", "sledge.edge_angle_deg", "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"]


def test_each_repetition_refines_one_choice_from_what_was_in_force() -> None:
    """A fixed step instead of the tolerance; the places of a delayed depth if there is one."""
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))  # in force: 40 elements, 18 mm, 4 mm
    plain = run.scenario.solver
    assert refined_solvers(run) == {
        "solver.tolerance_mm": replace(plain, tolerance=plain.tolerance / 2.0),
        "solver.elements": replace(plain, elements=80),
        LINE_SPACING: replace(plain, line_spacing=0.009),
        "solver.groove_tolerance": replace(plain, groove_tolerance=5e-5),
    }
    changes = {"fixed": True, "step_ms": 0.4, "delayed_share": 0.2}
    found = refined_solvers(straight_run(load_scenario("carved-46m", changes=STRAIGHT | changes)))
    assert list(found) == ["solver.step_ms", *KEYS[1:], DELAYED_SPACING]
    assert found["solver.step_ms"].step == pytest.approx(0.2e-3, rel=1e-15)
    assert found[DELAYED_SPACING].delayed_spacing == pytest.approx(0.5e-3)


def test_end_moves_by_what_the_choice_changes() -> None:
    """The made-up run misses by 40 mm / elements: from 40 to 80 its end moves by 0.5 mm.

    A start that is 0.1 % faster than 5 m/s ends 0.005 m/s · 2 s = 1 cm farther; no other does.
    """
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    repeated = verify(run, straight_run)
    found = verification_dict(repeated)
    assert list(found) == [*KEYS, SHEAR_DISPLACEMENT, *NUDGED]
    moved = {key: each["end_moves_cm"] for key, each in found.items() if key in KEYS}
    assert moved == pytest.approx({**dict.fromkeys(KEYS, 0.0), "solver.elements": 0.05}, rel=1e-9, abs=1e-12)
    assert {key: (each["was"], each["now"]) for key, each in found.items() if key in KEYS} == {
        "solver.tolerance_mm": pytest.approx((0.001, 0.0005)),
        "solver.elements": (40.0, 80.0),
        LINE_SPACING: pytest.approx((18.0, 9.0)),
        "solver.groove_tolerance": pytest.approx((1e-4, 5e-5)),
    }
    assert {each["outcome"] for each in found.values()} == {"finished"}
    by_key = {each.key: each for each in repeated}
    assert repetitions(run) == (*KEYS, SHEAR_DISPLACEMENT, *(key for key in NUDGED for _ in "+-"))
    half, speed = by_key["snow.shear_displacement_mm"], by_key["start.speed_m_per_s"]
    assert (half.was, half.now) == pytest.approx((0.02, 0.01), rel=1e-12)
    assert speed.end_moves == pytest.approx(0.01, rel=1e-9)
    assert abs(speed.now - 5.0) == pytest.approx(0.005, rel=1e-9)
    speeds = [each.start.speed for each in nudged_scenarios(run)["start.speed_m_per_s"]]
    assert speeds == pytest.approx([5.005, 4.995], rel=1e-12)
    assert [by_key[key].end_moves for key in NUDGED[1:]] == pytest.approx([0.0] * 3, abs=1e-12)
    assert limit_warnings(run, repeated) == ()


def test_none_finer_than_the_range_allows() -> None:
    changes = {**STRAIGHT, "shear_displacement_mm": 0.015, "edge_angle_deg": 0.0}
    run = straight_run(load_scenario("carved-46m", changes=changes))
    assert not {SHEAR_DISPLACEMENT, EDGE_ANGLE} & set(repetitions(run))


@pytest.mark.parametrize(("moves", "near"), [(0.004, False), (0.006, True)])
def test_near_the_limit_a_thousandth_moves_the_end_by_more_than_five_of_the_run(moves: float, near: bool) -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    moved = moves * run.run_length
    found = (
        Refinement("snow.S_f_N_per_mm2", 0.5, 0.5005, moved, "finished"),
        Refinement("solver.elements", 40.0, 80.0, 10.0 * run.run_length, "finished"),
    )
    warned = limit_warnings(run, found)
    assert len(warned) == near
    if near:
        assert warned[0].startswith(
            f"near the limit of grip: the end moves {moved:.2g} m for 0.1 % of snow.S_f_N_per_mm2"
        )


@pytest.mark.slow
def test_a_run_at_the_limit_of_its_grip_is_reported() -> None:
    """On H_V = 1, with u_y = 0.5 mm, a turn that holds gives way to a skid near S_f = 0.339, within a thousandth."""
    skidded = 30.0  # energy of shear (J): 11 where the edge holds, 50 and more where it does not

    def turn(strength: float) -> Run:
        snow = {"H_V_N_per_mm3": 1.0, "S_f_N_per_mm2": strength, "shear_displacement_mm": 0.5}
        return simulate(load_scenario("carved-46m", changes={f"snow.{key}": value for key, value in snow.items()}))

    low, high = 0.33, 0.34
    assert turn(low).energies["shear"][-1] > skidded > turn(high).energies["shear"][-1]
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if turn(middle).energies["shear"][-1] > skidded else (low, middle)
    holds, skids = turn(high), turn(low)
    moves = float(np.linalg.norm(holds.place[-1] - skids.place[-1]))
    assert limit_warnings(holds, [Refinement("snow.S_f_N_per_mm2", high, low, moves, skids.outcome)])


def test_interrupted_repetition_keeps_those_before_it() -> None:
    asked: list[Solver] = []

    def interrupted_third(scenario: Scenario) -> Run:
        asked.append(scenario.solver)
        return straight_run(scenario, outcome="interrupted" if len(asked) == 3 else "finished")

    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    assert [each.key for each in verify(run, interrupted_third)] == KEYS[:2]
    assert len(asked) == 3
