"""One set of physics checks over every law for a place on the snow, and the exact answers of the hypoplastic one."""

import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises, warns

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.penetration import (
    POINT_LAWS,
    ElasticPoint,
    HypoplasticPoint,
    LayeredPoint,
    MeanPressurePoint,
    PointLaw,
    ProfilePoint,
    VolumeWithAnglePoint,
)

FEW = settings(max_examples=15)
"""For each of many laws."""
H_V = 0.2e9
RATIOS = (1.0, 2.0, 5.0, 10.0, 50.0, math.inf)
A, B, RAMP = 0.034e9, 0.35e6, 1e-3
SAMPLES: tuple[PointLaw, ...] = (
    ElasticPoint(H_V),
    *(HypoplasticPoint(H_V, ratio) for ratio in RATIOS),
    VolumeWithAnglePoint(H_V, 10.0),
    MeanPressurePoint(A, B, 2.0, RAMP),
    MeanPressurePoint(A, B, 10.0, RAMP),
    MeanPressurePoint(A / 4.0, B / 4.0, 5.0, RAMP),
    LayeredPoint(H_V, 10.0, layer_depth=0.02, lower_hardness=5.0 * H_V),
    LayeredPoint(H_V, 2.0, layer_depth=0.02, lower_hardness=0.2 * H_V),
    ProfilePoint(H_V, 2.0, (0.0, 0.02, 0.03), (1.0, 5.0, 0.2)),
)
EVERY_LAW = pytest.mark.parametrize("law", SAMPLES, ids=repr)


def stronger(law: PointLaw) -> PointLaw:
    if isinstance(law, MeanPressurePoint):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            return MeanPressurePoint(3 * law.pressure_slope, 3 * law.pressure_offset, law.unloading_ratio, RAMP)
    if isinstance(law, LayeredPoint):
        return LayeredPoint(3 * H_V, law.unloading_ratio, law.layer_depth, 3 * law.lower_hardness)
    if isinstance(law, ProfilePoint):
        return replace(law, snow_hardness=3 * H_V)
    if isinstance(law, HypoplasticPoint | VolumeWithAnglePoint):
        return type(law)(3 * H_V, law.unloading_ratio)
    return ElasticPoint(3 * H_V)


def at_5_cm(law: PointLaw) -> float:
    """Stress of first loading (N/m²)."""
    if isinstance(law, MeanPressurePoint):
        return 2.0 * law.pressure_slope * 0.05 + law.pressure_offset
    if isinstance(law, LayeredPoint):
        return H_V * law.layer_depth + law.lower_hardness * (0.05 - law.layer_depth)
    if isinstance(law, ProfilePoint):
        return H_V * (0.02 + 5.0 * 0.01 + 0.2 * 0.02)
    return (0.99 if isinstance(law, VolumeWithAnglePoint) else 1.0) * H_V * 0.05


def steepest(law: PointLaw) -> float:
    """Growth of the stress with depth (N/m³) at most."""
    if isinstance(law, MeanPressurePoint):
        return law.unloading_ratio * (2.0 * law.pressure_slope + law.pressure_offset / RAMP)
    if isinstance(law, LayeredPoint):
        return law.unloading_ratio * max(H_V, law.lower_hardness)
    if isinstance(law, ProfilePoint):
        return law.unloading_ratio * 5.0 * H_V
    ratio = getattr(law, "unloading_ratio", 1.0)
    return float(ratio if ratio < 1e6 else 1.0) * H_V


def zero_at_zero_depth(law: PointLaw) -> None:
    assert np.all(law.stress(np.array([-0.01, 0.0]), 0.0) == 0.0)
    assert np.all(law.stress(np.array([-0.01, 0.0]), 0.02) == 0.0)
    assert float(law.stress(1e-12, 0.0)) <= 1e-9 * float(law.stress(0.01, 0.0))  # a ramp of 1 mm gives 6e-10


def never_tension(law: PointLaw) -> None:
    depth, deepest = np.meshgrid(np.linspace(-0.01, 0.05, 121), np.linspace(0.0, 0.05, 51))
    assert np.all(law.stress(depth, deepest) >= 0.0)


def growing_with_depth(law: PointLaw) -> None:
    for deepest in (0.0, 0.01, 0.04):
        stress = law.stress(np.linspace(-0.01, 0.05, 601), deepest)
        assert np.all(np.diff(stress) >= 0.0) and stress[-1] == pytest.approx(at_5_cm(law))


def continuous_in_depth(law: PointLaw) -> None:
    for deepest in (0.0, 0.01, 0.04):
        depth = np.linspace(-0.01, 0.05, 6001)
        assert np.abs(np.diff(law.stress(depth, deepest))).max() <= 1.001 * steepest(law) * 1e-5


CHECKS: dict[str, Callable[[PointLaw], None]] = {
    "zero at zero depth": zero_at_zero_depth,
    "never tension": never_tension,
    "growing with depth": growing_with_depth,
    "continuous in depth": continuous_in_depth,
}


def test_every_registered_law_has_a_sample() -> None:
    assert {type(law) for law in SAMPLES} == set(POINT_LAWS)


@EVERY_LAW
@pytest.mark.parametrize("name", CHECKS)
def test_physics(name: str, law: PointLaw) -> None:
    if name == "continuous in depth" and repr(law) == repr(HypoplasticPoint(H_V, math.inf)):  # rigid-plastic
        with pytest.raises(AssertionError):
            CHECKS[name](law)
    else:
        CHECKS[name](law)


def work(law: PointLaw, start: float, end: float, deepest: float) -> float:
    """∫ p dε on one leg from the stress alone: exact between kinks, where p is linear, by the middle of each piece."""
    residual = float(law.residual_depth(deepest))
    low, high = min(start, end), max(start, end)
    edges = [low, *sorted({e for e in (0.0, residual, deepest, *law.bends) if low < e < high}), high]
    total = 0.0
    for left, right in pairwise(edges):
        total += float(law.stress((left + right) / 2, deepest)) * (right - left)
    return total if end >= start else -total


PATHS = st.lists(st.floats(-0.02, 0.08), min_size=1, max_size=20)


@EVERY_LAW
@FEW
@given(PATHS)
def test_work_is_stored_plus_lost_on_any_load_path(law: PointLaw, path: list[float]) -> None:
    """The first law of thermodynamics at one place, and no energy back beyond what is stored."""
    depth = deepest = done = 0.0
    lost_before = 0.0
    for target in path:
        done += work(law, depth, target, deepest)
        depth, deepest = target, float(law.deepest_after(target, deepest))
        stored, lost = float(law.stored_energy(depth, deepest)), float(law.lost_energy(deepest))
        scale = 0.5 * H_V * 0.08**2 * len(path)  # the largest work of a leg, for the rounding of the sum
        assert done == pytest.approx(stored + lost, rel=1e-9, abs=1e-12 * scale)
        assert stored >= 0.0 and lost >= lost_before >= 0.0
        lost_before = lost


@EVERY_LAW
@FEW
@given(PATHS)
def test_a_closed_loop_gives_nothing(law: PointLaw, path: list[float]) -> None:
    depth = deepest = done = 0.0
    for target in [*path, 0.0]:
        done += work(law, depth, target, deepest)
        depth, deepest = target, float(law.deepest_after(target, deepest))
    assert done >= -1e-9 * H_V * 0.08**2
    assert done == pytest.approx(float(law.lost_energy(deepest)), rel=1e-9, abs=1e-12 * H_V * 0.08**2 * len(path))


@EVERY_LAW
@FEW
@given(PATHS)
def test_a_second_round_over_the_same_groove_costs_nothing(law: PointLaw, path: list[float]) -> None:
    deepest = max(0.0, *path)
    legs = list(pairwise([0.0, *path, 0.0]))
    again = math.fsum(work(law, a, b, deepest) for a, b in legs)
    assert abs(again) <= 1e-9 * H_V * 0.08**2 * len(legs)


@EVERY_LAW
@FEW
@given(st.floats(-0.01, 0.06), st.floats(0.0, 0.06))
def test_scaling_with_the_hardness(law: PointLaw, depth: float, deepest: float) -> None:
    assert float(stronger(law).stress(depth, deepest)) == pytest.approx(
        3 * float(law.stress(depth, deepest)), rel=1e-12
    )
    for energy in ("lost_energy", "residual_depth"):
        expected = float(getattr(law, energy)(deepest)) * (3 if energy == "lost_energy" else 1)
        assert float(getattr(stronger(law), energy)(deepest)) == pytest.approx(expected, rel=1e-12)


@EVERY_LAW
def test_scalar_equals_array(law: PointLaw) -> None:
    depth, deepest = np.array([-0.01, 0.0, 0.005, 0.02])[:, None], np.array([0.0, 0.0055, 0.03])
    for method in (law.stress, law.stored_energy, law.deepest_after):
        table = method(depth, deepest)
        assert table.shape == (4, 3)
        for i, j in np.ndindex(4, 3):
            single = method(float(depth[i, 0]), float(deepest[j]))
            assert np.shape(single) == () and float(single) == table[i, j]
    for of_place in (law.residual_depth, law.lost_energy):
        assert of_place(deepest).tolist() == [float(of_place(float(value))) for value in deepest]


@pytest.mark.parametrize("ratio", RATIOS)
def test_load_unload_reload_by_hand(ratio: float) -> None:
    """Section of one cycle to 10 mm: groove, energy lost, and the branch that is met again."""
    law = HypoplasticPoint(H_V, ratio)
    kept = 1 - 1 / ratio
    assert float(law.stress(0.010, 0.0)) == pytest.approx(2e6)
    assert float(law.residual_depth(0.010)) == pytest.approx(0.010 * kept)
    assert float(law.lost_energy(0.010)) == pytest.approx(0.5 * H_V * 0.010**2 * kept)
    middle = (0.010 + float(law.residual_depth(0.010))) / 2
    expected = 1e6 if math.isfinite(ratio) else 2e6  # half-way up the branch; rigid-plastic has no way up
    assert float(law.stress(middle, 0.010)) == pytest.approx(expected, rel=1e-9)
    # at the bottom of the groove the branch ends; 1 Pa is the rounding of a depth times k_u
    released = float(law.residual_depth(0.010)) - 1e-12
    assert float(law.stress(released, 0.010)) == pytest.approx(0.0, abs=1.0)
    assert float(law.stress(0.012, 0.010)) == pytest.approx(2.4e6)  # virgin again
    assert float(law.deepest_after(0.012, 0.010)) == 0.012
    assert float(law.deepest_after(0.004, 0.010)) == 0.010


@given(st.floats(-0.01, 0.06), st.floats(0.0, 0.06))
def test_ratio_one_is_elastic(depth: float, deepest: float) -> None:
    assert float(HypoplasticPoint(H_V, 1.0).stress(depth, deepest)) == pytest.approx(
        float(ElasticPoint(H_V).stress(depth, deepest)), rel=1e-9, abs=1e-6
    )


def test_rigid_plastic_snow_lets_go_at_once_and_stores_nothing() -> None:
    law = HypoplasticPoint(H_V, math.inf)
    assert law.stress([0.01, 0.01 - 1e-15, 0.0], 0.01).tolist() == [2e6, 0.0, 0.0]
    assert float(law.stored_energy(0.01, 0.01)) == 0.0
    assert float(law.lost_energy(0.01)) == pytest.approx(0.5 * H_V * 1e-4)


@pytest.mark.parametrize("ratio", [0.99, 0.0, -1.0, math.nan, -math.inf])
def test_unloading_softer_than_loading_is_rejected(ratio: float) -> None:
    with raises(ParameterError, "out_of_range"):
        HypoplasticPoint(H_V, ratio)


def test_the_unloading_ratio_has_no_default() -> None:
    with pytest.raises(TypeError, match="unloading_ratio"):
        HypoplasticPoint(H_V)  # type: ignore[call-arg]


@pytest.mark.parametrize("make", [lambda: ElasticPoint(0.0), lambda: HypoplasticPoint(math.nan, 2.0)])
def test_hardness_must_be_above_zero(make: Callable[[], object]) -> None:
    with raises(ParameterError, "out_of_range", name="snow_hardness"):
        make()


@pytest.mark.parametrize("make", [lambda: ElasticPoint(0.01e9), lambda: HypoplasticPoint(100e9, 2.0)])
def test_a_warning_outside_the_measured_range(make: Callable[[], object]) -> None:
    with warns(RangeWarning, "outside_measured", unit="N/mm³", highest=90.0) as caught:
        make()
    assert caught[0].filename == __file__


def test_the_factor_of_eqn_11() -> None:
    """0.99, 1.063, 1.100 and 1.137 at 0, 30, 45 and 60°, as the paper's Eqn 11 gives them."""
    depth, angle = np.full(4, 0.01), np.radians([0.0, 30.0, 45.0, 60.0])
    stress, energy = VolumeWithAnglePoint(H_V, 10.0).stress_and_energy(depth, depth, angle)
    assert stress / (H_V * depth) == pytest.approx([0.99, 1.063, 1.100, 1.137], abs=5e-4)
    assert energy / stress == pytest.approx(stress[0] / (2.0 * 10.0 * 0.99 * H_V), rel=1e-12)


def test_the_mean_over_a_wedge_is_that_of_federolf() -> None:
    """∫ (2 A ε + B) dε/e = A e + B, less what the ramp takes: B ε_B/(2 e)."""
    e = 0.01
    depth = (np.arange(20000) + 0.5) * e / 20000
    mean = float(np.mean(MeanPressurePoint(A, B, 10.0, RAMP).stress(depth, 0.0)))
    assert mean == pytest.approx(A * e + B - B * RAMP / (2.0 * e), rel=1e-8)


@pytest.mark.parametrize("ratio", [0.5, math.inf, math.nan])
def test_a_mean_pressure_that_unloads_more_softly_is_rejected(ratio: float) -> None:
    with raises(ParameterError, "out_of_range", kind="MeanPressurePoint"):
        MeanPressurePoint(A, B, ratio)


def test_growing_hardness_over_a_wedge() -> None:
    """F = H_0 (V + γ W/e₇), V = L e²/(2 tan ϑ), W = L e³/(3 tan ϑ), for L/tan ϑ = 1 m and γ/e₇ = 40/m."""
    law, e = LayeredPoint(H_V, 10.0, layer_depth=1.0, lower_hardness=H_V, hardness_growth=40.0), 0.01
    depth = e * (np.arange(100_000) + 0.5) / 100_000
    expected = H_V * (e**2 / 2.0 + 40.0 * e**3 / 3.0)
    assert e * float(np.mean(law.stress(depth, 0.0))) == pytest.approx(expected, rel=1e-9)
    assert law.lost_energy(e) + law.stored_energy(e, e) == pytest.approx(expected, rel=1e-12)  # ∫q too


def test_equal_layers_are_one() -> None:
    depth, deepest = np.meshgrid(np.linspace(0.0, 0.04, 41), np.linspace(0.0, 0.04, 41))
    one, two = HypoplasticPoint(H_V, 10.0), LayeredPoint(H_V, 10.0, layer_depth=0.013, lower_hardness=H_V)
    for name in ("stress", "stored_energy"):
        np.testing.assert_allclose(getattr(two, name)(depth, deepest), getattr(one, name)(depth, deepest), atol=1e-6)
    for name in ("residual_depth", "lost_energy"):
        np.testing.assert_allclose(getattr(two, name)(deepest), getattr(one, name)(deepest), rtol=1e-12, atol=1e-12)


def test_a_profile_of_two_layers_is_the_law_of_two() -> None:
    depth, deepest = np.meshgrid(np.linspace(0.0, 0.04, 41), np.linspace(0.0, 0.04, 41))
    two = LayeredPoint(H_V, 10.0, layer_depth=0.013, lower_hardness=5.0 * H_V)
    several = ProfilePoint(H_V, 10.0, (0.0, 0.006, 0.013, 0.02), (1.0, 1.0, 5.0, 5.0))
    for name in ("stress", "stored_energy"):
        np.testing.assert_allclose(
            getattr(several, name)(depth, deepest), getattr(two, name)(depth, deepest), atol=1e-6
        )
    for name in ("residual_depth", "lost_energy"):
        np.testing.assert_allclose(getattr(several, name)(deepest), getattr(two, name)(deepest), rtol=1e-12, atol=1e-12)
