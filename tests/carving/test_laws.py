"""Laws of the snow given to `carve`: the core's own through the door, exact cases, what is refused."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow import SnowProperties
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.carving.equilibrium import carve
from skisnow.carving.laws import equivalent_snow
from skisnow.carving.result import Equilibrium
from skisnow.carving.solve import Conditions, Solution, refined, solved
from skisnow.forces.penetration import (
    ElasticPoint,
    HypoplasticPoint,
    MeanPressureLaw,
    MeanPressurePoint,
    VolumeWithAnglePoint,
)
from skisnow.forces.shear import AngleShear, ConstantShear, DensityShear, MachiningShear
from skisnow.ski import read_ski
from skisnow.ski.beam import CLAMP_LENGTH, ClampedSki, clamped
from tests.coded import Coded, coded, raises
from tests.present import present

from .laws import Deepening, Power, Pushing
from .synthetic import rigid_ski, snow
from .test_jacobian import conditions

CASE: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0}
FEDEROLF = MeanPressurePoint(pressure_slope=0.034e9, pressure_offset=0.35e6, unloading_ratio=10.0)
LENGTH, WIDTH = 1.6, 0.065
GROOVES: list[dict[str, Any]] = [{}, {"groove": "path", "elements": 40}]


def alike(found: Equilibrium, expected: Equilibrium, rel: float) -> None:
    assert found.outcome == expected.outcome == "equilibrium"
    for name in ("turn_radius_boot", "turn_radius_boot_other_spread", "turn_radius_chord", "side_force_limit"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=rel)
    for name in ("edge_depth", "bending", "twist"):
        theirs = getattr(expected, name)
        assert getattr(found, name) == pytest.approx(theirs, abs=rel * float(np.max(np.abs(theirs))))
    force = present(expected.force_per_length)
    # where snow unloads at 2 N/mm³ over 4 mm, Newton's last 10⁻¹² m are 10⁻⁵ N/m
    assert found.force_per_length == pytest.approx(force, abs=max(rel, 5e-9) * float(np.max(force)))


@pytest.mark.parametrize("choice", [*GROOVES, {"side_force_spread": "base-reaction"}, {"moment_balance": "free"}])
def test_a_constant_law_is_s_f(choice: dict[str, Any]) -> None:
    known = carve(read_ski("slalom"), snow(0.2), **CASE, **choice, unloading_ratio=10.0)
    found = carve(
        read_ski("slalom"), snow(0.2, 0.1), **CASE, **choice, unloading_ratio=10.0, shear=ConstantShear(0.35e6)
    )
    alike(found, known, 1e-12)


@pytest.mark.parametrize("choice", [*GROOVES, {"side_force_spread": "base-reaction"}, {"twist": False}])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_the_cores_law_through_the_door(ratio: float, choice: dict[str, Any]) -> None:
    law = HypoplasticPoint(0.2e9, ratio) if ratio > 1.0 else ElasticPoint(0.2e9)
    known = carve(read_ski("slalom"), snow(0.2), **CASE, **choice, unloading_ratio=ratio)
    alike(carve(read_ski("slalom"), snow(5.0), **CASE, **choice, penetration=law), known, 1e-9)


def test_a_bevelled_base_through_the_door() -> None:
    ski = replace(read_ski("slalom"), base_bevel=math.radians(1.0))
    known = carve(ski, snow(0.2), **CASE, unloading_ratio=10.0)
    alike(carve(ski, snow(0.2), **CASE, penetration=HypoplasticPoint(0.2e9, 10.0)), known, 1e-9)


@pytest.mark.parametrize("angle_deg", [20.0, 45.0, 75.0])
def test_federolfs_law_under_a_rigid_wedge(angle_deg: float) -> None:
    """F = (A e² + B e - B ε_B/2) L/tan ϑ; the pressure's part across is what the turn needs, with nothing to spare."""
    angle = math.radians(angle_deg)
    found = carve(rigid_ski(), snow(0.2), edge_angle=angle, load=800.0, penetration=FEDEROLF)
    needed = 800.0 * math.tan(angle) / LENGTH + 0.5 * 0.35e6 * FEDEROLF.ramp_depth
    depth = (math.sqrt(0.35e6**2 + 4.0 * 0.034e9 * needed) - 0.35e6) / (2.0 * 0.034e9)
    assert depth > FEDEROLF.ramp_depth
    assert found.edge_depth == pytest.approx(np.full(320, depth), rel=1e-6)
    assert (found.outcome, found.holds) == ("equilibrium", True)
    assert found.side_force_limit == pytest.approx(800.0 * math.tan(angle), rel=1e-7)


def test_federolfs_law_under_a_flat_rigid_base() -> None:
    """F = L W (2 A ε + B)."""
    load = 60e3
    found = carve(rigid_ski(), snow(0.2), edge_angle=0.0, load=load, penetration=FEDEROLF)
    depth = (load / (LENGTH * WIDTH) - 0.35e6) / (2.0 * 0.034e9)
    assert depth > FEDEROLF.ramp_depth
    assert found.edge_depth == pytest.approx(np.full(320, depth), rel=1e-6)


@pytest.mark.parametrize(
    ("exponent", "ratio"), [(0.5, 1.0), (0.7, 1.0), (1.0, 5.0), (1.5, 5.0), (2.0, 5.0), (3.0, 5.0)]
)
def test_another_exponent_under_a_rigid_wedge(exponent: float, ratio: float) -> None:
    """F = a eⁿ⁺¹ L/((n + 1) tan ϑ)."""
    law = Power(1e6 / 5e-3**exponent, exponent, unloading_ratio=ratio)
    found = carve(rigid_ski(), snow(0.2), **CASE, penetration=law)
    depth = (800.0 * (exponent + 1.0) / (law.factor * LENGTH)) ** (1.0 / (exponent + 1.0))
    assert found.edge_depth == pytest.approx(np.full(320, depth), rel=1e-6)


def test_a_twisted_ski_slips_on_pressure_alone() -> None:
    """Along the base's normal at each section: what is less steep than the boot holds less."""
    found = carve(read_ski("slalom"), snow(0.2), **CASE, penetration=FEDEROLF)
    assert found.twist is not None
    assert found.force_per_length is not None
    assert (found.outcome, found.holds) == ("slips", False)
    assert 0.9 * 800.0 < present(found.side_force_limit) < 0.99 * 800.0
    stiff = carve(read_ski("slalom"), snow(0.2), **CASE, penetration=FEDEROLF, twist=False)
    assert (stiff.outcome, stiff.holds) == ("equilibrium", True)


@pytest.mark.parametrize("share", [0.5, 3.0])
def test_the_answer_does_not_hang_on_where_the_search_begins(monkeypatch: pytest.MonkeyPatch, share: float) -> None:
    case: dict[str, Any] = {**CASE, "penetration": Power(3e9, 1.5, unloading_ratio=8.0)}
    known = carve(read_ski("slalom"), snow(0.2), **case)

    def other_ratio(*given: Any) -> tuple[float, float]:
        hardness, ratio = equivalent_snow(*given)
        return hardness, share * ratio

    monkeypatch.setattr("skisnow.carving.equilibrium.equivalent_snow", other_ratio)
    alike(carve(read_ski("slalom"), snow(0.2), **case), known, 1e-8)


def test_a_hardness_by_the_edge_angle() -> None:
    """Without twist it is one number: (0.99 + 0.14 ϑ) H_V."""
    law = VolumeWithAnglePoint(snow_hardness=0.2e9, unloading_ratio=10.0)
    hardness = 0.2 * (0.99 + 0.14 * math.radians(45.0))
    known = carve(read_ski("slalom"), snow(hardness), **CASE, unloading_ratio=10.0, twist=False)
    alike(carve(read_ski("slalom"), snow(0.2), **CASE, penetration=law, twist=False), known, 1e-9)


@pytest.mark.parametrize("choice", GROOVES)
def test_a_law_along_either_groove(choice: dict[str, Any]) -> None:
    found = carve(read_ski("slalom"), snow(0.2), **CASE, **choice, penetration=Power(3e9, 1.5, unloading_ratio=8.0))
    assert found.outcome == "equilibrium"
    assert abs(found.residual_force or 0.0) < 1e-5
    assert abs(found.residual_moment or 0.0) < 1e-5


def test_grip_by_the_edge_angle_and_grip_by_the_depth() -> None:
    """Eqn 13 under a rigid wedge: F = H_V e² L/(2 tan ϑ) asks for F tan ϑ of S_f0 (1 - k ϑ) e L."""
    angle = math.radians(50.0)
    stress = 0.3e6 * (1.0 - 0.5 * angle)
    load = 2.0 * stress**2 * LENGTH / 0.2e9 / math.tan(angle)
    below, above = (
        carve(rigid_ski(), snow(0.2), edge_angle=angle, load=each, unloading_ratio=1.0, shear=AngleShear(0.3e6, 0.5))
        for each in (load * (1.0 - 1e-6), load * (1.0 + 1e-6))
    )
    assert (below.holds, above.holds) == (True, False)
    assert above.side_force_limit == pytest.approx(load * math.tan(angle), rel=2e-6)
    # S_f (1 + e/d) e L.
    found = carve(rigid_ski(), snow(0.2), **CASE, unloading_ratio=1.0, shear=Deepening(0.1e6, 2e-3))
    depth = math.sqrt(2.0 * 800.0 / (0.2e9 * LENGTH))
    assert found.side_force_limit == pytest.approx(0.1e6 * (1.0 + depth / 2e-3) * depth * LENGTH, rel=1e-6)


def test_a_law_stands_in_for_s_f() -> None:
    """Snow without S_f carves on a strength by density, or on pressure along the base's normal."""
    bare = SnowProperties(0.2e9, None, source="test")
    law = DensityShear(snow_density=500.0)
    found = carve(read_ski("slalom"), bare, **CASE, unloading_ratio=10.0, shear=law)
    known = carve(read_ski("slalom"), snow(0.2, 0.108), **CASE, unloading_ratio=10.0)
    assert found.side_force_limit == pytest.approx(known.side_force_limit, rel=1e-12)
    assert carve(read_ski("slalom"), bare, **CASE, penetration=FEDEROLF).side_force_limit is not None
    with raises(ParameterError, "no_data"):
        carve(read_ski("slalom"), bare, **CASE, penetration=HypoplasticPoint(0.2e9, 10.0))


class NotFinite(Deepening):
    def _stress(self, depth: np.ndarray[Any, Any], angle: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        return np.where(np.abs(angle - CASE["edge_angle"]) < 1e-3, super()._stress(depth, angle), np.nan)


class Fades(Power):
    def stress(self, depth: Any, deepest: Any) -> Any:
        return np.where(np.asarray(depth) > 1.5e-3, np.nan, super().stress(depth, deepest))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"penetration": MeanPressureLaw(0.034e9, 0.35e6)}, "wrong_kind"),
        ({"penetration": 0.2e9}, "wrong_kind"),
        ({"penetration": HypoplasticPoint}, "wrong_kind"),
        ({"penetration": HypoplasticPoint(0.2e9, math.inf)}, "out_of_range"),
        ({"penetration": Power(0.0, 1.0)}, "invalid_law"),
        ({"penetration": Fades(1e9, 1.0, 2.0)}, "no_equilibrium"),
        ({"penetration": FEDEROLF, "shear": ConstantShear(0.2e6)}, "contradiction"),
        ({"penetration": FEDEROLF, "unloading_ratio": 10.0}, coded("contradiction", given=10.0)),
        ({"shear": 0.2e6, "unloading_ratio": 10.0}, coded("wrong_kind", shear=200000.0)),
        ({"shear": FEDEROLF, "unloading_ratio": 10.0}, "wrong_kind"),
        ({"shear": MachiningShear(0.1e6, 0.1), "unloading_ratio": 10.0}, "contradiction"),
        ({"shear": Pushing(0.1e6, 1e-3), "unloading_ratio": 10.0}, coded("contradiction", share=0.29999999999999993)),
        ({"shear": Deepening(-0.1e6, 1e-3), "unloading_ratio": 10.0}, coded("invalid_law", degrees=45.0)),
        ({"shear": NotFinite(0.1e6, 1e-3), "unloading_ratio": 10.0}, "no_equilibrium"),
    ],
)
def test_what_is_refused(given: dict[str, Any], words: str | Coded) -> None:
    with raises(ParameterError, words):
        carve(read_ski("slalom"), snow(0.2), **CASE, **given)


def test_an_error_in_a_law_comes_through() -> None:
    class Broken(Power):
        asked = 0

        def residual_depth(self, deepest: Any) -> Any:
            type(self).asked += 1
            if type(self).asked > 3:
                raise ZeroDivisionError("in the law")
            return super().residual_depth(deepest)

    with pytest.raises(ZeroDivisionError, match="in the law"):
        carve(read_ski("slalom"), snow(0.2), **CASE, penetration=Broken(1e9, 1.0, 5.0))


def test_a_flat_ski_asks_for_no_strength() -> None:
    """Its bits are those without a law."""
    found = carve(
        read_ski("slalom"), snow(0.2), edge_angle=0.0, load=800.0, unloading_ratio=1.0, shear=AngleShear(1e5, 0.1)
    )
    known = carve(read_ski("slalom"), snow(0.2), edge_angle=0.0, load=800.0, unloading_ratio=1.0)
    assert np.array_equal(present(found.edge_depth), present(known.edge_depth))


CASES: list[dict[str, Any]] = [
    {},
    {"ski": "giant-slalom", "angle": 65.0, "hardness": 1e9, "ratio": 300.0},
    {"ski": "carver", "angle": 20.0, "ratio": 1.0},
    {"angle": 3.0, "hardness": 0.005e9},  # it lies in the snow with both edges
    {"bevel": 1.0},
    {"bevel": 1.0, "radius": 1e-4},
    {"radius": 2e-4, "side": 1.5},
    {"by_reaction": True},
    {"pitch_of_force": math.cos(0.7), "pitch_of_shear": math.sin(0.7), "moment": 10.0},
    {"side_force_bending": False},
    {"twists": False},
]


def model_and_conditions(
    *,
    ski: str = "slalom",
    angle: float = 45.0,
    hardness: float = 0.21e9,
    ratio: float = 10.0,
    bevel: float = 0.0,
    **changes: Any,
) -> tuple[ClampedSki, Conditions]:
    shape = replace(read_ski(ski), base_bevel=math.radians(bevel))
    given = conditions(angle=angle, hardness=hardness, ratio=ratio, edges=shape.edge_shape)
    return clamped(shape, CLAMP_LENGTH, 160), given._replace(**changes)


def outputs(model: ClampedSki, given: Conditions, near: Solution | None = None) -> FloatArray:
    """Greatest force, area of the edge in the snow, and the deflection of a node, of the refined equilibrium."""
    _, u, _, depth, force = refined(model, given, near or solved(model, given)).state()
    return np.array([force.max(), model.stations.weight @ np.maximum(depth, 0.0), u[30]])


def seeds(model: ClampedSki, given: Conditions) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
    _, u, _, depth, force = refined(model, given, solved(model, given)).state()
    none, still = 0.0 * depth, 0.0 * u
    largest, node = np.eye(len(force))[np.argmax(force)], np.eye(len(u))[30]
    return [
        (still, none, largest),
        (still, np.where(depth > 0.0, model.stations.weight, 0.0), none),
        (node, none, none),
    ]


NUMBERS = ("edge_angle", "hardness", "excess", "load", "moment", "side_force", "bevel", "bevel_width",
           "pitch_of_force", "pitch_of_shear", "", "", "side", "radius")  # fmt: skip


def richardson(model: ClampedSki, given: Conditions, name: str, step: float) -> FloatArray:
    value = getattr(given, name)

    def central(h: float) -> FloatArray:
        ends = [outputs(model, given._replace(**{name: value + side * h})) for side in (1.0, -1.0)]
        return (ends[0] - ends[1]) / (2.0 * h)

    return (4.0 * central(step / 2.0) - central(step)) / 3.0


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_gradient_is_that_of_differences_and_the_last_correction_is_rounding(case: dict[str, Any]) -> None:
    """By each number of the equations. A number that is 0 and cannot fall is left out."""
    model, given = model_and_conditions(**case)
    point = refined(model, given, solved(model, given))
    gradients = np.array([point.gradient(*seed)[1] for seed in seeds(model, given)])
    size = np.abs(outputs(model, given))
    for column, name in enumerate(NUMBERS):
        if not name or (name in ("side", "radius") and given.radius == 0.0):
            continue
        value = getattr(given, name)
        if (name in ("bevel", "bevel_width") and given.bevel == 0.0) or (name == "excess" and value == 0.0):
            continue
        scale = abs(value) or 1.0
        differences = richardson(model, given, name, (1e-5 if name == "side_force" else 1e-4) * scale)
        room = 1e-6 * np.maximum(np.abs(differences), size / scale)
        assert np.all(np.abs(gradients[:, column] - differences) <= room), name
    assert refined(model, given, solved(model, given)).state()[0] <= 1e-15  # m


@pytest.mark.parametrize("case", CASES[:7], ids=str)
def test_a_warm_start_finds_the_same(case: dict[str, Any]) -> None:
    model, given = model_and_conditions(**case)
    elsewhere = solved(model, given._replace(load=1.2 * given.load, side_force=1.2 * given.side_force))
    warm, cold = outputs(model, given, solved(model, given, near=elsewhere)), outputs(model, given)
    assert warm == pytest.approx(cold, rel=1e-11)


def test_few_places_across_are_enough() -> None:
    """Against 110 places, over random carves; five places, set by a first solution, were off by 1.6e-4 and 6e-3."""
    random = np.random.default_rng(5)
    errors = []
    for _ in range(20):
        name = str(random.choice(["slalom", "giant-slalom", "carver"]))
        hardness, ratio = np.exp(random.uniform(np.log([0.02e9, 1.0]), np.log([5e9, 50.0])))
        load, angle = random.uniform(300.0, 2500.0), random.uniform(10.0, 70.0)
        model, given = model_and_conditions(ski=name, angle=angle, hardness=hardness, ratio=ratio)
        given = given._replace(load=load, side_force=load * math.tan(given.edge_angle))
        found = solved(model, given)
        reach = 1.05 * float(model.stations.width.max()) * math.cos(given.edge_angle)
        near_edge = np.linspace(0.0, 3.0, 61)[1:] * float(found.edge_depth.max()) / math.tan(given.edge_angle)
        many = np.unique(np.concatenate([np.linspace(0.0, reach, 51), near_edge[near_edge < reach]]))
        _, _, _, depth, force = refined(model, given, found, places=many).state()
        errors.append([found.edge_depth.max() / depth.max() - 1.0, found.force_per_length.max() / force.max() - 1.0])
    assert np.abs(errors).max(axis=0) == pytest.approx([0.0, 0.0], abs=3e-3)
    assert np.median(np.abs(errors), axis=0) == pytest.approx([0.0, 0.0], abs=2e-4)


def test_without_memory_the_places_do_not_matter_next_to_it() -> None:
    """k_u/H_V = 1 has as many places as 1 + 1e-9: the answer is continuous there."""
    one, next_to = (outputs(*model_and_conditions(ratio=ratio)) for ratio in (1.0, 1.0 + 1e-9))
    assert next_to == pytest.approx(one, rel=1e-8)
