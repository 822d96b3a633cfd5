"""A runner's shape, and laws as the core asks them, by hand."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.errors import ParameterError
from skisnow.contact import ContactState, Laws, Runner
from skisnow.contact.laws import AskedFriction, AskedPressure, AskedStrength
from tests.coded import Coded, coded, raises

POSITION, HALF, BASE = np.array([0.5, 0.1, -0.4]), np.array([0.05, 0.03, 0.04]), np.array([0.02, 0.0, 0.01])


def runner(**changes: Any) -> Runner:
    return Runner(**{"position": POSITION, "half_width": HALF, "base_height": BASE} | changes)


def test_a_runner_from_tip_to_tail() -> None:
    given = POSITION.copy()
    found = runner(position=given)
    given[0] = 9.0
    assert (found.tip, found.tail) == (0.5, -0.4)
    assert not found.position.flags.writeable
    assert "0.9 m long, half width" in repr(found)
    assert "rigid" in repr(found)
    beam = runner(nodes=[0.5, 0.0, -0.4 + 5e-10])
    assert "3 nodes" in repr(beam)
    ski = read_ski("carver")
    base = Runner.of(ski, nodes=[ski.station[0], ski.station[-1]])
    assert base.half_width.tolist() == (0.5 * ski.width).tolist()
    assert base.base_height.tolist() == ski.base_height.tolist()
    assert base.nodes is not None
    assert Runner.of(ski).nodes is None


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"position": POSITION[:1], "half_width": HALF[:1], "base_height": BASE[:1]},
            coded("wrong_shape", name="position"),
        ),
        ({"half_width": HALF[:2]}, coded("wrong_shape", name="half_width", shape="(2,)")),
        ({"base_height": np.zeros((3, 1))}, coded("wrong_shape", name="base_height")),
        ({"base_height": BASE * math.nan}, coded("not_a_number", name="base_height")),
        ({"half_width": HALF * math.inf}, coded("not_a_number", name="half_width")),
        ({"position": [0.5, 0.5, -0.4]}, "not_falling"),
        ({"half_width": [0.05, 0.0, 0.04]}, coded("out_of_range", half_width=0.0)),
        ({"nodes": [0.5]}, "not_falling"),
        ({"nodes": [[0.5, -0.4]]}, "not_falling"),
        ({"nodes": [0.5, 0.0, 0.0, -0.4]}, "not_falling"),
        ({"nodes": [0.4, -0.4]}, coded("out_of_range", tip=0.5, tail=-0.4)),
        ({"nodes": [0.5, -0.3]}, "out_of_range"),
    ],
)
def test_what_is_no_runner(changes: dict[str, Any], words: str | Coded) -> None:
    with raises(ParameterError, words):
        runner(**changes)


class Law:
    """Of friction, shear and penetration at once, in numbers that can be told apart."""

    def __init__(self, *, broken: bool = False) -> None:
        self.share = math.inf if broken else 1.0

    def __repr__(self) -> str:
        return "Law()"

    def coefficient(self, speed: np.ndarray[Any, Any]) -> Any:
        del speed
        return 0.05

    def stress_and_thrust(self, depth: Any, edge_angle: Any) -> Any:
        return np.stack([depth * 1e3, edge_angle / np.where(edge_angle > 1.0, 0.0, self.share)])

    def residual_depth(self, deepest: Any) -> Any:
        return self.share * deepest / 2.0

    def stress_and_energy(self, depth: Any, deepest: Any, edge_angle: Any) -> Any:
        return self.share * np.stack([depth + deepest, edge_angle])

    def lost_energy(self, deepest: Any) -> Any:
        return self.share * (3.0 + 0.0 * deepest[0])


def test_friction_is_asked_for_each_speed() -> None:
    found = AskedFriction(cast("Any", Law()))(np.array([1.0, 2.0]))
    assert found.tolist() == [0.05, 0.05]
    assert found.flags.c_contiguous


@pytest.mark.filterwarnings("ignore:divide by zero")
def test_strength_is_asked_where_there_is_snow() -> None:
    asked = AskedStrength(cast("Any", Law()))
    depth, angle = np.array([0.01, 0.0, -0.02, 0.03]), np.array([0.1, 0.2, 0.3, 0.4])
    assert asked(depth, angle) == pytest.approx(np.array([[10.0, 0.0, 0.0, 30.0], [0.1, 0.0, 0.0, 0.4]]))
    assert not asked.refused
    asked(depth, np.array([0.1, 0.2, 0.3, 1.5]))
    assert str(asked.refused) == "Law() returns no finite strength at an edge angle of 85.9 degrees"
    asked(depth, angle)
    assert not asked.refused


def test_pressure_is_asked_with_what_stays() -> None:
    asked, deep = AskedPressure(cast("Any", Law())), np.array([0.01, 0.04])
    assert asked.residual(deep).tolist() == [0.005, 0.02]
    assert asked.bear(deep, 2.0 * deep, np.array([0.1, 0.2])) == pytest.approx(np.array([[0.03, 0.12], [0.1, 0.2]]))
    assert asked.lost(deep).tolist() == [3.0, 3.0]
    broken = AskedPressure(cast("Any", Law(broken=True)))
    for ask in (broken.residual, broken.lost, lambda depth: broken.bear(depth, depth, depth)):
        with raises(ParameterError, "invalid_law", law="Law()", depth=10.0):
            ask(deep)


def test_laws_are_told_by_their_names() -> None:
    assert Laws().described == {"friction": None, "shear": None, "penetration": None}
    assert "none" in repr(Laws())
    given = Laws(shear=cast("Any", Law()))
    assert given.described["friction"] is None
    assert given.described["shear"] is not None
    assert "shear Law" in repr(given)
    assert "friction" not in repr(given)


def test_bytes_that_are_no_state() -> None:
    with raises(ParameterError, "invalid_state"):
        ContactState.from_bytes(b"nothing")
