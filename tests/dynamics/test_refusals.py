"""What no run can be made of is refused by name."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact
from skisnow.dynamics import Body, Dynamics, Ended, StepControl
from tests.coded import Coded, coded, raises

from .sledges import ahead, body_of, clamped_ski, given, placed, sledge, snow_of, started

SCENARIO = given()
BODY = body_of(SCENARIO)


@pytest.mark.parametrize("name", ["first", "tolerance", "longest", "shortest", "closeness"])
@pytest.mark.parametrize("value", [0.0, -1e-3, math.inf, math.nan])
def test_lengths_and_tolerances(name: str, value: float) -> None:
    given_so: dict[str, Any] = {name: value}
    with pytest.raises(ParameterError, match=rf"StepControl: {name} is {value!r}"):
        StepControl(**given_so)


def test_shortest_above_longest() -> None:
    with raises(ParameterError, "out_of_range", shortest=0.01, longest=0.006):
        StepControl(shortest=0.01)


def test_a_first_step_is_no_longer_than_the_longest() -> None:
    """So a glide that accepts every step takes none longer."""
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
        ({"inertia": np.eye(3)}, coded("wrong_shape", name="Body: inertia", shape="(3, 3)")),
        ({"gravity": np.array([0.0, 0.0, math.nan])}, coded("not_a_number", name="Body: gravity")),
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
        ({"boot": np.zeros(2)}, coded("wrong_shape", name="FlexibleSki: boot", shape="(2,)")),
        ({"damping": math.nan}, coded("not_a_number", name="FlexibleSki: damping")),
    ],
)
def test_skis(wrong: dict[str, Any], expected: Coded) -> None:
    with raises(ParameterError, expected):
        replace(BODY.skis[0], **wrong)
