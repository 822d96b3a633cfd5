"""Penetration laws in Python: the core's own law again, and laws of which the force is known."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.forces.penetration import (
    ElasticPoint,
    HypoplasticPoint,
    LayeredPoint,
    MeanPressurePoint,
    PointLaw,
    VolumeWithAnglePoint,
)
from tests.coded import raises

from .conftest import edged, straight

H, S, LENGTH, WIDTH = 2e8, 5e5, 1.6, 0.06
GIANT_SLALOM = read_ski("giant-slalom")
SKI = Runner.of(GIANT_SLALOM, nodes=np.linspace(GIANT_SLALOM.station[0], GIANT_SLALOM.station[-1], 9))
AT_REST = np.zeros((1, 6))


@dataclass(frozen=True)
class Power(PointLaw):
    """p = a ε^n, elastic: a law written here."""

    factor: float
    exponent: float

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        depth, _ = np.broadcast_arrays(np.asarray(depth, float), np.asarray(deepest, float))
        return np.asarray(self.factor * np.maximum(depth, 0.0) ** self.exponent)

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        return np.zeros(np.shape(deepest))

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        return self.stress(depth, deepest) * np.maximum(depth, 0.0) / (self.exponent + 1.0)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        return np.zeros(np.shape(deepest))


def placed(angle: float, depth: float) -> tuple[FloatArray, FloatArray]:
    """A straight runner whose deeper edge lies ``depth`` below the plane."""
    return np.array([[0.0, 0.0, 0.5 * WIDTH * abs(math.sin(angle)) - depth]]), edged(angle)[None]


def wrench(law: PointLaw, angle: float, depth: float) -> FloatArray:
    contact = SnowContact(SnowField(1.0, 0.0, 1.0, penetration=law), [straight()])
    return contact.force(*placed(angle, depth), AT_REST, 0.0).wrench[0]


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.5, 3.0])
def test_a_flat_base_bears_the_law_times_its_area(exponent: float) -> None:
    e, law = 2e-3, Power(1e9, exponent)
    assert wrench(law, 0.0, e)[2] == pytest.approx(1e9 * e**exponent * LENGTH * WIDTH, rel=1e-12)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.5, 2.0, 3.0, 5.0])
def test_an_edge_bears_the_integral_over_its_wedge(exponent: float) -> None:
    """∫ a (x tan ϑ)^n dx over e/tan ϑ, a e^(n + 1)/((n + 1) tan ϑ), as three points of Gauss give it: exactly for whole
    powers to the fifth."""
    angle, e = math.radians(40), 2e-3
    exact = 1e9 * e ** (exponent + 1.0) * LENGTH / ((exponent + 1.0) * math.tan(angle))
    points, weights = 0.5 + math.sqrt(0.15) * np.array([-1.0, 0.0, 1.0]), np.array([5.0, 8.0, 5.0]) / 18.0
    share = (exponent + 1.0) * float(weights @ points**exponent)
    assert share == pytest.approx(1.0, abs=4e-3 if exponent < 1.0 else 5e-4 if exponent % 1.0 else 1e-14)
    assert wrench(Power(1e9, exponent), angle, e)[2] == pytest.approx(exact * share, rel=1e-12)


def walk(snow: SnowField, seed: int) -> tuple[FloatArray, SnowContact]:
    """Wrenches, beam loads and energies of a bent ski on a random walk, deep and shallow, slipping and turning."""
    rng = np.random.default_rng(seed)
    contact = SnowContact(snow, [SKI])
    angle = float(rng.uniform(-1.2, 1.2))
    rotation = edged(angle)
    position = np.array([0.0, 0.0, 0.034 * abs(math.sin(angle)) - 2e-3])
    beam = rng.normal(size=(9, 3)) * [1e-3, 3e-3, 1e-2]
    out = []
    for step in range(25):
        rotation = rotation @ edged(*(float(rng.normal(0.0, 3e-3)) for _ in range(3)))
        position = position + rotation @ (rng.normal(size=3) * [4e-3, 1e-3, 5e-4])
        pose = position[None], rotation[None]
        found = contact.force(*pose, rng.normal(size=(1, 6)), 1e-3 * (step > 0), beam_dofs=[beam])
        out.append(np.concatenate([found.wrench[0], found.beam_loads[0].ravel(), [contact.elastic_energy]]))
        contact.update(*pose, 1e-3 * (step > 0), beam_dofs=[beam])
    return np.array(out), contact


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_the_core_s_law_in_python_gives_the_core_s_forces(ratio: float, seed: int) -> None:
    """It is straight over each part, where Gauss's points are exact: to rounding."""
    law = HypoplasticPoint(H, ratio) if ratio > 1.0 else ElasticPoint(H)
    inside, one = walk(SnowField(H, S, ratio, 0.05), seed)
    outside, other = walk(SnowField(1.0, S, 7.0, 0.05, penetration=law), seed)
    size = np.abs(inside).max(axis=0)
    # what an edge has cut may differ by the depth of 10⁻¹² m that counts as none
    assert np.all(np.abs(inside - outside) <= 1e-8 * np.maximum(size, 1.0))
    assert np.array_equal(one.tracks(), other.tracks())
    assert other.groove_energy == pytest.approx(one.groove_energy, rel=1e-12)


@pytest.mark.parametrize("degrees", [0.0, 35.0])
def test_a_rigid_ski_on_two_layers(degrees: float) -> None:
    """Flat: (H d + H_2 (e - d)) per area. On its edge H V + (H_2 - H) V₂, V₂ the volume below the border."""
    angle, e, border, lower = math.radians(degrees), 3e-3, 1e-3, 5.0 * H
    law = LayeredPoint(H, 10.0, layer_depth=border, lower_hardness=lower)
    if degrees == 0.0:
        expected = (H * border + lower * (e - border)) * LENGTH * WIDTH
    else:
        expected = LENGTH * (H * e**2 + (lower - H) * (e - border) ** 2) / (2.0 * math.tan(angle))
    assert wrench(law, angle, e)[2] == pytest.approx(expected, rel=1e-12)


def test_eqn_11_at_an_angle() -> None:
    angle, e = math.radians(50), 2e-3
    found = wrench(VolumeWithAnglePoint(H, 10.0), angle, e)[2]
    assert found == pytest.approx((0.99 + 0.14 * angle) * H * LENGTH * e * e / (2.0 * math.tan(angle)), rel=1e-12)


@pytest.mark.parametrize("degrees", [30.0, -55.0])
def test_the_mean_pressure_on_an_edge(degrees: float) -> None:
    """(A e + B) e L/tan ϑ less the ramp's B ε_B L/(2 tan ϑ); across, it holds up to tan ϑ times as much."""
    angle, e, A, B, ramp = math.radians(degrees), 3e-3, 0.034e9, 0.35e6, 0.5e-3
    contact = SnowContact(SnowField(1.0, 0.0, 1.0, penetration=MeanPressurePoint(A, B, 10.0, ramp)), [straight()])
    contact.update(*placed(angle, e), 0.0)
    found = contact.force(*placed(angle, e), AT_REST, 0.0).wrench[0]
    up = (A * e * e + B * (e - 0.5 * ramp)) * LENGTH / math.tan(abs(angle))
    assert found[1:3] == pytest.approx([0.0, up], rel=1e-12, abs=1e-9)
    # away from the turn the base is pressed deeper: it slips as deep as it was in rising as it goes
    aside = -math.copysign(2e-3, angle)
    position, rotation = placed(angle, e - abs(aside) * math.tan(abs(angle)))
    position[0, 1] = aside
    found = contact.force(position, rotation, AT_REST, 1e-3).wrench[0]
    assert found[1] / found[2] == pytest.approx(math.tan(angle), rel=1e-9)


def test_a_law_that_holds_across_by_itself_has_no_other_hold() -> None:
    with raises(ParameterError, "contradiction", kind="MeanPressurePoint"):
        SnowField(H, S, 10.0, penetration=MeanPressurePoint(0.034e9, 0.35e6, 10.0))


def test_a_law_without_an_answer_is_told() -> None:
    with np.errstate(divide="ignore"), raises(ParameterError, "invalid_law"):
        wrench(Power(math.inf, 1.0), 0.5, 1e-3)
