"""Where a body stands, and the start that an earlier solver had found; what cannot start."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact
from skisnow.dynamics import Body, Dynamics, Ended, FlexibleSki, StepControl
from skisnow.scenario import load_scenario
from tests.coded import Coded, coded, raises

from .sledges import advanced, ahead, body_of, clamped_ski, given, left_over, placed, sledge, snow_of, started

FORMER = json.loads((Path(__file__).parent / "former_solver.json").read_text("utf-8"))
"""Made with `set_up` and `simulated_run` of skisnow at commit b42c536, whose solver kept the snow in cells across, took
linearly implicit Runge-Kutta steps, and settled by a Newton's method of its own. SI."""
HARD = ((60.0, 1.0), (50.0, 5.0), (45.0, 10.0), (40.0, 20.0), (40.0, 90.0), (-60.0, 90.0), (70.0, 0.2), (0.0, 0.002))


def named(start: dict[str, Any]) -> str:
    return "-".join([start["scenario"], *(f"{value:g}" for value in start["changes"].values())])


@pytest.mark.parametrize("former", FORMER["starts"], ids=named)
def test_the_start_is_that_of_the_former_solver(former: dict[str, Any]) -> None:
    """Height, roll, pitch and bend. Lines stand at multiples of the spacing from the boot as it rests, formerly as it
    was set down: at 70° that moves tips by 0.7 µm and boots by 0.1 µm, in built-in scenarios a tenth of it. Each line
    stands for the ski halfway to its neighbours, formerly for one spacing: that turns the ski by 5e-8, in built-in
    scenarios a tenth of what lines four times as close do. Where the ski is pitched by p and deflected by w, sections
    were formerly p w off their lines: each counted for p w' less of the ski, so no bend changes by more than that."""
    scenario = load_scenario(former["scenario"], changes=former["changes"])
    dynamics = sledge(scenario, elements=former["elements"], spacing=former["line_spacing"])
    assert dynamics.find_equilibrium() < 1e-9
    within = 1e-6 if former["changes"] else 1e-7
    assert dynamics.position[2] == pytest.approx(former["height"], abs=0.2 * within)
    assert dynamics.rotation[2] == pytest.approx(former["normal"], abs=0.6 * within)
    off_lines = abs(dynamics.rotation[2, 0]) * np.abs(dynamics.part("beam_dofs")[:, 1::3]).max()
    for unknown, both in former["bend"].items():
        limit = within + off_lines * np.abs(both).max()
        assert dynamics.part("beam_dofs")[:, int(unknown)] == pytest.approx(both, abs=limit), unknown


def test_place_and_heading_are_held() -> None:
    """In the body's own axes: leaning turns its heading in space by roll times pitch, and moves it by as little."""
    for edge_angle in (30.0, -60.0, 70.0):
        scenario = given(sledge__edge_angle_deg=edge_angle, start__x_m=3.0, start__y_m=-2.0)
        dynamics = sledge(scenario)
        assert dynamics.find_equilibrium() < 1e-9
        pitch, roll = dynamics.rotation[2, :2]
        heading = np.arctan2(dynamics.rotation[1, 0], dynamics.rotation[0, 0])
        assert abs(heading - scenario.start.heading) < 1.1 * abs(roll * pitch)
        moved = np.hypot(*(dynamics.position[:2] - [3.0, -2.0]))
        assert moved < 1.1 * 0.04 * np.hypot(roll, pitch)  # lifted by less than 4 cm on the way


def test_it_begins_where_it_was_moved_to_with_its_skis_as_bent() -> None:
    """Two metres above the snow, turned by a quarter: 1 ms later it is 2 mm on, to its own front, and falls."""
    dynamics = sledge(given())
    assert dynamics.find_equilibrium() < 1e-9
    bent = dynamics.part("beam_dofs").copy()
    assert np.abs(bent).max() > 1e-3
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    dynamics.move_to(np.array([7.0, -3.0, 2.0]), turned)
    assert dynamics.position.tolist() == [7.0, -3.0, 2.0]
    assert dynamics.rotation.tolist() == turned.tolist()
    assert dynamics.part("beam_dofs").tolist() == bent.tolist()
    dynamics.begin(np.array([2.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    dynamics.advance(1e-3)
    assert dynamics.position[:2] == pytest.approx([7.0, -2.998], abs=5e-5)
    assert not dynamics.touches
    for name, place, rotation in (("position", np.zeros(4), turned), ("rotation", np.zeros(3), np.zeros(3))):
        with raises(ParameterError, "wrong_shape", name=name):
            dynamics.move_to(place, rotation)


@pytest.mark.parametrize(("edge_angle", "hardness"), HARD)
def test_nothing_is_left_over(edge_angle: float, hardness: float) -> None:
    """Of 800 N, held directions aside: along and across the slope friction and grip would have to act."""
    scenario = given(sledge__edge_angle_deg=edge_angle, snow__H_V_N_per_mm3=hardness)
    dynamics = sledge(scenario, elements=80 if hardness > 10.0 else 60, spacing=0.01)
    assert dynamics.find_equilibrium() < 1e-9
    on_body, on_skis = left_over(dynamics)
    assert np.abs(on_body[2:5]).max() < 1e-5
    assert max(np.abs(each).max() for each in on_skis) < 1e-5


def test_half_a_second_ends_where_the_former_solver_ended() -> None:
    """A tenth of a millimetre of 3.6 m: the former run at half its step moves by 0.4 µm, but its cells are 0.3 mm wide
    and its history knows no cut within a step; the present one may err by 0.3 µm in each of some 600 steps."""
    former = FORMER["run"]
    dynamics = advanced(given(former["scenario"], snow__shear_displacement_mm=0.5), former["duration"])
    run = dynamics.position - former["place"]
    assert np.linalg.norm(run) < 1e-4
    assert np.linalg.norm(dynamics.velocity[:3]) == pytest.approx(former["speed"], rel=1e-4)


# What no run can be made of is refused by name


SCENARIO = given()
BODY = body_of(SCENARIO)


@pytest.mark.parametrize("name", ["first", "tolerance", "longest", "shortest", "closeness"])
@pytest.mark.parametrize("value", [0.0, -1e-3, math.inf, math.nan])
def test_lengths_and_tolerances(name: str, value: float) -> None:
    given_so: dict[str, Any] = {name: value}
    with pytest.raises(ParameterError, match=rf"StepControl: {name} is {value!r}"):
        StepControl(**given_so)


def test_shortest_above_longest_and_a_first_step_is_no_longer_than_the_longest() -> None:
    with raises(ParameterError, "out_of_range", shortest=0.01, longest=0.006):
        StepControl(shortest=0.01)
    rule = StepControl(shortest=0.006).compiled()
    values = rule.first, rule.fixed, rule.tolerance, rule.longest, rule.shortest, rule.closeness
    assert values == (1e-4, False, 1e-6, 6e-3, 6e-3, 0.2)
    rule = StepControl(first=0.1, fixed=True, tolerance=0.2, longest=0.03, shortest=0.01, closeness=0.5).compiled()
    values = rule.first, rule.fixed, rule.tolerance, rule.longest, rule.shortest, rule.closeness
    assert values == (0.1, True, 0.2, 0.03, 0.01, 0.5)
    # So a glide that accepts every step takes none longer.
    scenario = given(start__speed_m_per_s=1.0, snow__shear_displacement_mm=0.5)  # loose enough for long steps
    dynamics = started(scenario, StepControl(first=0.5, longest=1e-3, tolerance=1.0, closeness=1e-9))
    assert dynamics.advance(0.02) is Ended.REACHED
    assert dynamics.counts[:2] == (20, 0)


def contact_of(*elements: int) -> SnowContact:
    """A runner for each, rigid with none."""
    nodes = [clamped_ski(SCENARIO, each).node if each else None for each in elements]
    return SnowContact(snow_of(SCENARIO), [Runner.of(SCENARIO.ski, nodes=each) for each in nodes])


@pytest.mark.parametrize("count", [1, 3])
def test_number_of_runners(count: int) -> None:
    with raises(ParameterError, "wrong_shape", n_skis=2, n_runners=count):
        Dynamics(BODY, contact_of(*[40] * count), *placed(SCENARIO, height=0.02), StepControl())


@pytest.mark.parametrize("elements", [0, 12])
def test_nodes_of_another_beam(elements: int) -> None:
    nodes = len(clamped_ski(SCENARIO, elements).node) if elements else 0
    with raises(ParameterError, "wrong_shape", k=1, n_unknown=len(BODY.skis[1].unknown), nodes=nodes):
        Dynamics(BODY, contact_of(40, elements), *placed(SCENARIO, height=0.02), StepControl())


@pytest.mark.parametrize(("name", "value"), [("position", np.zeros(2)), ("rotation", np.zeros(9))])
def test_pose_of_another_shape(name: str, value: np.ndarray[Any, Any]) -> None:
    position, rotation = placed(SCENARIO, height=0.02)
    pose = {"position": position, "rotation": rotation, name: value}
    with pytest.raises(ParameterError, match=rf"{name} has shape {re.escape(str(value.shape))}"):
        Dynamics(BODY, contact_of(40, 40), pose["position"], pose["rotation"], StepControl())


def test_velocity() -> None:
    dynamics = sledge(SCENARIO)
    with raises(ParameterError, "wrong_shape", name="velocity", shape="(1,)", needed="(6,)"):
        dynamics.begin(np.array([7.0]))
    with raises(ParameterError, "not_a_number", name="velocity"):
        dynamics.begin(ahead(math.nan))


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        ({"inertia": np.eye(3)}, coded("wrong_shape", name="Body: inertia", shape="(3, 3)", needed="(6, 6)")),
        ({"first_moment": np.eye(2)}, coded("wrong_shape", name="Body: first_moment", needed="(3,)")),
        ({"gravity": np.array([0.0, 0.0, math.nan])}, coded("not_a_number", name="Body: gravity")),
        ({"drag": np.zeros(1)}, coded("wrong_shape", name="Body: drag", needed="()")),
        ({"drag_height": np.zeros(1)}, coded("wrong_shape", name="Body: drag_height", needed="()")),
        ({"mass": math.inf}, coded("not_a_number", name="Body: mass")),
        ({"skis": ()}, coded("missing")),
    ],
)
def test_bodies(wrong: dict[str, Any], expected: Coded) -> None:
    with raises(ParameterError, expected):
        replace(BODY, **wrong)


def cut(body: Body, name: str) -> dict[str, Any]:
    return {name: getattr(body.skis[0], name)[:-3]}


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        (cut(BODY, "stiffness"), coded("wrong_shape", name="FlexibleSki: stiffness", shape="(99, 6)")),
        (cut(BODY, "coupling"), coded("wrong_shape", name="FlexibleSki: coupling", shape="(99, 6)")),
        (cut(BODY, "unknown"), coded("wrong_shape", n_free=31, n=102)),
        ({"boot": np.zeros(2)}, coded("wrong_shape", name="FlexibleSki: boot", shape="(2,)", needed="(3,)")),
        ({"axes": np.eye(2)}, coded("wrong_shape", name="FlexibleSki: axes", shape="(2, 2)", needed="(3, 3)")),
        ({"mass": np.zeros((102, 3))}, coded("wrong_shape", name="FlexibleSki: mass", needed="(102, 6)")),
        ({"unknown": np.zeros((35, 1))}, coded("wrong_shape", name="FlexibleSki: unknown", needed="(35,)")),
        ({"inertia": np.eye(3)}, coded("wrong_shape", name="FlexibleSki: inertia", needed="(6, 6)")),
        ({"inertia": np.full((6, 6), math.nan)}, coded("not_a_number", name="FlexibleSki: inertia")),
        ({"damping": math.nan}, coded("not_a_number", name="FlexibleSki: damping")),
    ],
)
def test_skis(wrong: dict[str, Any], expected: Coded) -> None:
    with raises(ParameterError, expected):
        replace(BODY.skis[0], **wrong)


@pytest.mark.parametrize(("rows", "unknown"), [(4, [0, 3]), (6, [0, 0]), (6, [0, 3, 6]), (6, [-1, 3]), (6, [1, 4])])
def test_unknowns_of_nodes(rows: int, unknown: list[int]) -> None:
    """Three for each free node in any order, -1 for a clamped one."""
    ski = BODY.skis[0]

    def made(size: int, places: list[int]) -> FlexibleSki:
        band = np.ones((size, 6))
        return replace(ski, mass=band, stiffness=band, coupling=band, unknown=np.array(places))

    with raises(ParameterError, "wrong_shape", n_free=sum(each >= 0 for each in unknown), n=rows):
        made(rows, unknown)
    assert made(6, [3, -1, 0]).unknown.tolist() == [3, -1, 0]
