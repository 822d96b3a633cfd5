"""Snow, runners and laws as the core takes them, and what is refused."""

import math
from typing import Any, cast

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.errors import ParameterError
from skisnow.contact import ContactState, Laws, Runner, SnowContact, SnowField
from skisnow.contact.laws import FrictionCallback, PressureCallback, StrengthCallback
from skisnow.forces.friction import ConstantFriction, FrictionLaw, LinearFriction, QuadraticFriction, WaterFilmFriction
from skisnow.forces.penetration import HypoplasticPoint
from skisnow.forces.shear import AngleShear, ConstantShear, MachiningShear
from skisnow.geometry.surfaces import Grid
from tests.coded import Coded, coded, raises

from .test_contact import SKI

H, S = 2e8, 5e5
GRID = Grid(np.array([0.0, 1.0]), np.array([0.0, 2.0]), np.array([[0.5, 1.0], [1.5, 2.0]]))


def snow(**changes: Any) -> SnowField:
    return SnowField(**{"snow_hardness": H, "failure_shear_stress": S, "unloading_ratio": 10.0} | changes)


class OwnShear:
    """Of a user."""

    def stress_and_thrust(self, depth: Any, edge_angle: Any) -> Any:
        return np.stack([depth * 0.0 + 1.0, edge_angle * 0.0])


class OwnFriction(FrictionLaw):
    """Of a user."""

    def _coefficient(self, speed: Any) -> Any:
        return 0.1 + 0.0 * speed


def test_snow_is_told_in_its_usual_units() -> None:
    shown = repr(snow(friction=0.05))
    assert "H_V 0.2 N/mm³, S_f 0.5 N/mm², k_u/H_V 10, friction 0.05, shear S_f" in shown
    assert "penetration" not in shown
    other = repr(snow(failure_shear_stress=GRID, friction=LinearFriction(0.04, 0.001)))
    assert "S_f over the place" in other
    assert "friction LinearFriction" in other
    lawful = repr(snow(shear=ConstantShear(S), penetration=HypoplasticPoint(H, 10.0)))
    assert "shear ConstantShear, penetration HypoplasticPoint" in lawful


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        *(({name: 0.0}, coded("out_of_range", name=name, value=0.0, limit=0.0)) for name in (
            "slip_weakening", "shear_displacement", "stick_displacement", "part_along",
            "part_across", "retardation_time", "delayed_spacing", "strength_share",
        )),
        *(({name: -0.1}, coded("out_of_range", name=name, value=-0.1, limit=0.0)) for name in (
            "knot_area", "damping", "delayed_share", "residual_ratio", "friction",
        )),
        *(({name: value}, coded("out_of_range", name=name, limit=limit)) for name, value, limit in (
            ("snow_hardness", 0.0, 0.0), ("snow_hardness", math.nan, 0.0), ("failure_shear_stress", -1.0, 0.0),
            ("unloading_ratio", 0.9, 1.0),
        )),
        ({"unloading_ratio": math.inf}, coded("out_of_range", name="unloading_ratio", value=math.inf)),
        ({"residual_ratio": 1.01}, coded("out_of_range", residual_ratio=1.01)),
        ({"friction_acts_on": "edge"}, coded("unknown_name", name="friction_acts_on", value="edge")),
        ({"failure_shear_stress": GRID, "strength_share": 0.9}, "contradiction"),
        ({"failure_shear_stress": GRID, "strength_share": GRID}, "contradiction"),
        ({"shear": OwnShear(), "strength_share": 0.9}, coded("contradiction", kind="OwnShear")),
        ({"penetration": HypoplasticPoint(H, 10.0), "damping": 1.0}, "contradiction"),
        ({"penetration": HypoplasticPoint(H, 10.0), "delayed_share": 0.1}, "contradiction"),
    ],
)  # fmt: skip
def test_snow_that_cannot_be(changes: dict[str, Any], words: str | Coded) -> None:
    with raises(ParameterError, words):
        snow(**changes)


def test_snow_at_the_edge_of_what_can_be() -> None:
    smallest = dict.fromkeys(("friction", "knot_area", "damping", "delayed_share", "failure_shear_stress"), 0.0)
    for changes in (
        {"residual_ratio": 1.0, "unloading_ratio": 1.0, **smallest},
        {"residual_ratio": 0.0},
        {"failure_shear_stress": GRID, "shear": ConstantShear(S), "strength_share": 0.9},
    ):
        made = snow(**changes)
        assert {name: getattr(made, name) for name in changes} == changes


def coefficients(friction: Any) -> list[float]:
    law = snow(friction=friction)._friction()
    return [law.constant, law.linear, law.square, law.film]


def test_friction_laws_are_coefficients_and_a_water_film_is_its_own_formula() -> None:
    """μ = c₀ + c₁ v + c₂ v² + a/(1 + v/v₀)."""
    assert coefficients(0.07) == coefficients(ConstantFriction(0.07)) == [0.07, 0.0, 0.0, 0.0]
    assert coefficients(LinearFriction(0.04, 0.002)) == [0.04, 0.002, 0.0, 0.0]
    assert coefficients(QuadraticFriction(0.04, 0.002, 1e-4)) == [0.04, 0.002, 1e-4, 0.0]
    own = snow(friction=OwnFriction())
    assert own.friction_in_python is own.friction
    assert snow(friction=LinearFriction(0.04, 0.002)).friction_in_python is None
    assert snow(friction=0.05).friction_in_python is None
    law = WaterFilmFriction(dry_friction=0.2, lubricated_friction=0.02, viscous_slope=0.001, film_speed=3.0)
    asked = snow(friction=law)._friction()
    assert (asked.constant, asked.linear, asked.film, asked.film_speed) == (0.02, 0.001, 0.2, 3.0)


def test_strength_is_that_of_the_law_times_its_share() -> None:
    assert snow(strength_share=0.8)._strength() == pytest.approx(0.8 * S)
    assert snow(shear=ConstantShear(3e5))._strength() == 3e5
    shared = snow(strength_share=GRID)._strength()
    assert isinstance(shared, Grid)
    assert shared.values == pytest.approx(S * GRID.values)
    assert snow(failure_shear_stress=GRID)._strength() is GRID
    machined = MachiningShear(1e5, 0.3, least_shear_plane=0.2)
    assert snow(shear=machined)._strength() == 1e5
    for asked in (OwnShear(), MachiningShear(1e5, 0.3)):
        assert snow(shear=asked).shear_in_python is asked
    for law in (machined, ConstantShear(S), AngleShear(S, 0.5)):
        assert snow(shear=law).shear_in_python is None
    assert snow(shear=AngleShear(4e5, 0.5))._strength() == 4e5
    assert snow(shear=AngleShear(4e5, 0.5))._core_shear_law().decrease == 0.5
    assert snow(shear=machined)._core_shear_law().friction_angle == pytest.approx(math.atan(0.3))


@pytest.mark.parametrize("spacing", [0.0, -0.01, math.nan, math.inf])
def test_a_contact_needs_a_spacing_and_a_runner(spacing: float) -> None:
    with raises(ParameterError, "out_of_range") as caught:
        SnowContact(snow(), [SKI], spacing=spacing)
    assert str(caught.value.fields["spacing"]) == str(spacing)
    with raises(ParameterError, "missing"):
        SnowContact(snow(), [])
    with raises(ParameterError, "unknown_name", instruction_set="abacus"):
        SnowContact(snow(), [SKI], instruction_set="abacus")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"rotation": [np.diag([1.0, 1.0, -1.0])]}, "not_a_rotation"),
        ({"rotation": [1.1 * np.eye(3)]}, coded("not_a_rotation", off=pytest.approx(0.21))),
        ({"rotation": [np.eye(2)]}, coded("wrong_shape", name="SnowContact: rotation", shape="(1, 2, 2)")),
        ({"position": [[0.0, 0.0, math.nan]]}, coded("not_a_number", name="SnowContact: position")),
        ({"dt": -1e-9}, coded("out_of_range", dt=-1e-09)),
        ({"dt": math.nan}, "out_of_range"),
        ({"velocity": [np.zeros(5)]}, coded("wrong_shape", name="SnowContact: velocity")),
        ({"beams": [np.zeros((2, 3))] * 2}, coded("wrong_shape", name="beam_dofs", n_beams=2, n_runners=1)),
        ({"beams": [np.zeros((3, 3))]}, coded("wrong_shape", name="SnowContact: beam_dofs")),
        ({"rates": [np.full((2, 3), math.inf)]}, coded("not_a_number", name="SnowContact: beam_rates")),
    ],
)
def test_poses_that_cannot_be(changes: dict[str, Any], words: str | Coded) -> None:
    usual: dict[str, Any] = {
        "position": [np.zeros(3)], "rotation": [np.eye(3)], "velocity": None, "dt": 0.0, "beams": None, "rates": None,
    }  # fmt: skip
    contact = SnowContact(snow(), [SKI])
    contact._checked_motion(**usual)
    with raises(ParameterError, words):
        contact._checked_motion(**usual | changes)


# A runner's shape, and laws as the core asks them, by hand


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
    found = FrictionCallback(cast("Any", Law()))(np.array([1.0, 2.0]))
    assert found.tolist() == [0.05, 0.05]
    assert found.flags.c_contiguous


@pytest.mark.filterwarnings("ignore:divide by zero")
def test_strength_is_asked_where_there_is_snow() -> None:
    asked = StrengthCallback(cast("Any", Law()))
    depth, angle = np.array([0.01, 0.0, -0.02, 0.03]), np.array([0.1, 0.2, 0.3, 0.4])
    assert asked(depth, angle) == pytest.approx(np.array([[10.0, 0.0, 0.0, 30.0], [0.1, 0.0, 0.0, 0.4]]))
    assert not asked.refused
    asked(depth, np.array([0.1, 0.2, 0.3, 1.5]))
    assert asked.refused is not None
    assert asked.refused.fields["edge_angle"] == pytest.approx(math.degrees(1.5))
    asked(depth, angle)
    assert not asked.refused


def test_pressure_is_asked_with_what_stays() -> None:
    asked, deep = PressureCallback(cast("Any", Law())), np.array([0.01, 0.04])
    assert asked.residual(deep).tolist() == [0.005, 0.02]
    assert asked.bear(deep, 2.0 * deep, np.array([0.1, 0.2])) == pytest.approx(np.array([[0.03, 0.12], [0.1, 0.2]]))
    assert asked.lost(deep).tolist() == [3.0, 3.0]
    broken = PressureCallback(cast("Any", Law(broken=True)))
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
