"""Laws of shear."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises, warns

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.shear import (
    LAWS,
    AngleShear,
    ConstantShear,
    DensityShear,
    IceCuttingShear,
    MachiningShear,
    NaturalDensityShear,
    ShearLaw,
)
from skisnow.snow import published_snow

FEW = settings(max_examples=25)
"""For each of many laws."""
ALL_ANGLES = np.radians(np.linspace(0.0, 90.0, 91))
LEAST, MOST = math.radians(30.0), math.radians(75.0)
"""Edge angles at which every law is finite and none is outside its range."""
ICE = ((8e6, -2e6), (1e9, 0.0))


@dataclass(frozen=True)
class Sample:
    law: ShearLaw
    stronger: ShearLaw
    factor: float
    outside: tuple[Callable[[], object], ...]
    depths: tuple[float, float] = (0.0, 0.03)


SAMPLES = (
    Sample(
        ConstantShear(0.1e6), ConstantShear(0.3e6), 3.0, (lambda: ConstantShear(0.03e6), lambda: ConstantShear(0.6e6))
    ),
    Sample(AngleShear(0.1e6, 0.266), AngleShear(0.2e6, 0.266), 2.0, (lambda: AngleShear(0.6e6, 0.266),)),
    Sample(
        DensityShear(430.0),  # 0.0863 N/mm², twice of which Eqn 14 gives at (0.1726 + 0.047)/0.00031
        DensityShear(0.2196 / 0.00031),
        2.0,
        (lambda: DensityShear(419.0), lambda: DensityShear(741.0)),
    ),
    Sample(
        NaturalDensityShear(300.0),  # (30.81 - 11.5323)², four times of which is the square of twice the root
        NaturalDensityShear((2 * (30.81 - 11.5323) + 11.5323) / 0.1027),
        4.0,
        (lambda: NaturalDensityShear(501.0),),
    ),
    Sample(
        MachiningShear(0.05e6, 0.06),
        MachiningShear(0.15e6, 0.06),
        3.0,
        (lambda: MachiningShear(0.01e6, 0.0), lambda: MachiningShear(0.3e6, 0.0)),
    ),
    Sample(
        IceCuttingShear(ICE),
        IceCuttingShear(ICE, snow_over_ice=0.06),
        3.0,
        (
            lambda: IceCuttingShear(ICE).failure_force(1.1e-3, 1.0, LEAST + 0.1),
            lambda: IceCuttingShear(ICE).failure_stress(0.5e-3, LEAST - 0.1),
        ),
        depths=(0.0, 1e-3),
    ),
)
EVERY_SAMPLE = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: type(sample.law).__name__)


def depths(sample: Sample, count: int = 101) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.linspace(*sample.depths, count)


def angles(sample: Sample) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """All angles; of the ice law those that were measured, outside of which it warns."""
    if sample.law.edge_angle_range is None:
        return ALL_ANGLES
    return ALL_ANGLES[30:76]


def zero_at_zero_depth(sample: Sample) -> None:
    force = sample.law.failure_force(np.array([0.0, 1e-9]), 1.7, MOST)
    assert force[0] == 0.0 and force[1] <= 1e-5 * float(sample.law.failure_force(1e-3, 1.7, MOST))


def never_tension(sample: Sample) -> None:
    force = sample.law.failure_force(depths(sample)[:, None], 1.7, angles(sample))
    assert not np.any(force < 0.0)
    assert not np.any(sample.law.thrust_force(depths(sample)[:, None], 1.7, angles(sample)[1:]) < -1e-9)


def finite_at_every_edge_angle(sample: Sample) -> None:
    assert np.all(np.isfinite(sample.law.failure_force(depths(sample)[:, None], 1.7, angles(sample))))


def growing_with_depth(sample: Sample) -> None:
    force = sample.law.failure_force(depths(sample), 1.7, LEAST + 0.1)
    assert np.all(np.diff(force) > 0.0)


def continuous_in_depth(sample: Sample) -> None:
    coarse, fine = (
        np.abs(np.diff(sample.law.failure_force(depths(sample, n), 1.7, MOST - 0.1))).max() for n in (1001, 2001)
    )
    assert fine <= 0.75 * coarse


def continuous_in_angle(sample: Sample) -> None:
    def largest_step(count: int) -> float:
        angle = np.linspace(LEAST, MOST, count)
        return float(np.abs(np.diff(sample.law.failure_force(sample.depths[1], 1.7, angle))).max())

    scale = float(sample.law.failure_force(sample.depths[1], 1.7, MOST))
    assert largest_step(2001) <= max(0.75 * largest_step(1001), 1e-12 * scale)


CHECKS: dict[str, Callable[[Sample], None]] = {
    "zero at zero depth": zero_at_zero_depth,
    "never tension": never_tension,
    "finite at every edge angle": finite_at_every_edge_angle,
    "growing with depth": growing_with_depth,
    "continuous in depth": continuous_in_depth,
    "continuous in angle": continuous_in_angle,
}


def test_every_registered_law_has_a_sample() -> None:
    assert {type(sample.law) for sample in SAMPLES} == set(LAWS)


@EVERY_SAMPLE
@pytest.mark.parametrize("name", CHECKS)
def test_physics(name: str, sample: Sample) -> None:
    if name == "finite at every edge angle" and isinstance(sample.law, MachiningShear):
        with pytest.raises(AssertionError):
            CHECKS[name](sample)
    else:
        CHECKS[name](sample)


@EVERY_SAMPLE
@FEW
@given(st.floats(0.01, 1.0), st.floats(LEAST, MOST), st.floats(0.01, 2.0))
def test_scaling(sample: Sample, share: float, angle: float, length: float) -> None:
    """With the parameter, and with the length of the edge."""
    depth = share * sample.depths[1]
    force = float(sample.law.failure_force(depth, length, angle))
    assert float(sample.stronger.failure_force(depth, length, angle)) == pytest.approx(sample.factor * force, rel=1e-9)
    assert float(sample.law.failure_force(depth, 3 * length, angle)) == pytest.approx(3 * force, rel=1e-12)
    assert force == pytest.approx(float(sample.law.failure_stress(depth, angle)) * depth * length, rel=1e-12)
    thrust = float(sample.law.thrust_force(depth, length, angle))
    assert float(sample.stronger.thrust_force(depth, length, angle)) == pytest.approx(sample.factor * thrust, rel=1e-9)


@EVERY_SAMPLE
def test_scalar_equals_array(sample: Sample) -> None:
    depth, length, angle = depths(sample, 4)[:, None, None], np.array([0.5, 1.7])[:, None], np.array([LEAST, 0.8, MOST])
    for method in (sample.law.failure_force, sample.law.thrust_force):
        table = method(depth, length, angle)
        assert table.shape == (4, 2, 3)
        for i, j, k in np.ndindex(4, 2, 3):
            single = method(float(depth[i, 0, 0]), float(length[j, 0]), float(angle[k]))
            assert single.shape == () and float(single) == table[i, j, k]
    assert sample.law.failure_stress(depth[:, 0], angle).shape == (4, 3)


@EVERY_SAMPLE
def test_a_warning_outside_the_measured_range(sample: Sample) -> None:
    assert sample.outside
    for use in sample.outside:
        with warns(RangeWarning, "outside_measured") as caught:
            use()
        assert [warning.filename for warning in caught] == [__file__]


@EVERY_SAMPLE
def test_an_edge_above_the_snow_holds_nothing(sample: Sample) -> None:
    assert float(sample.law.failure_force(-0.01, 1.0, 1.0)) == 0.0
    assert float(sample.law.thrust_force(-0.01, 1.0, 1.0)) == 0.0


@EVERY_SAMPLE
def test_degrees_for_radians_are_rejected(sample: Sample) -> None:
    with raises(ParameterError, "out_of_range"):
        sample.law.failure_force(1e-3, 1.0, 60.0)
    with raises(ParameterError, "out_of_range"):
        sample.law.thrust_force(1e-3, 1.0, 60.0)


def test_equation_9_undoes_the_test_it_comes_from() -> None:
    """30 N m at 250 mm over 100 mm, 6 mm deep, is 0.2 N/mm²: 120 N, at every edge angle."""
    force = ConstantShear(0.2e6).failure_force(0.006, 0.100, np.radians([0.0, 30.0, 90.0]))
    assert force * 0.250 == pytest.approx([30.0, 30.0, 30.0])


def test_equation_13_at_90_degrees() -> None:
    """0.0344 N/mm² (0.0343 by the printed digits); in degrees it would be negative."""
    law = AngleShear.soft_snow()
    assert float(law.failure_stress(0.01, math.pi / 2)) == pytest.approx(0.0344e6, rel=0.003)
    assert float(law.failure_stress(0.01, 0.0)) == pytest.approx(0.059e6)


def test_densities_at_500() -> None:
    """Eqn 14 gives 0.108 N/mm², Domine and others 1585 Pa: groomed and natural snow."""
    assert float(DensityShear(500.0).failure_stress(0.01, 0.5)) == pytest.approx(0.108e6)
    assert float(NaturalDensityShear(500.0).failure_stress(0.01, 0.5)) == pytest.approx(1585.0, abs=1.0)
    assert DensityShear(500.0).failure_shear_stress == pytest.approx(0.108e6)
    assert NaturalDensityShear(500.0).failure_shear_stress == pytest.approx((51.35 - 11.5323) ** 2)


@pytest.mark.parametrize(
    ("law", "density"),
    [(law, density) for law in (DensityShear, NaturalDensityShear) for density in (-1.0, 0.0, 50.0, 918.0, math.nan)]
    + [(DensityShear, 100.0), (DensityShear, 151.6), (NaturalDensityShear, 112.2)],
)
def test_a_density_without_strength_is_rejected(law: Callable[[float], object], density: float) -> None:
    """Eqn 14 would be negative; at 50 kg/m³ the square of Domine would give 41 Pa, more than the 0.6 Pa at 120."""
    with raises(ParameterError, "out_of_range"):
        law(density)


@pytest.mark.parametrize(
    ("angle_deg", "depth_mm"), [(30.0, 1.25), (45.0, 2.01), (60.0, 2.85), (75.0, 3.82), (90.0, 4.99)]
)
def test_worked_example_of_machining(angle_deg: float, depth_mm: float) -> None:
    """900 N on 1.7 m of edge, S = 0.05 N/mm², μ_t = 0.06: to the printed 0.01 mm, 0.4 % at the least of them."""
    law = MachiningShear(0.05e6, 0.06)
    assert float(law.failure_force(depth_mm * 1e-3, 1.7, math.radians(angle_deg))) == pytest.approx(900.0, rel=0.004)


def test_thrust_of_machining_completes_one_force() -> None:
    """Merchant: thrust over cut is cot(ϑ - β), from the normal of the face tilted by the friction angle."""
    law = MachiningShear(0.05e6, 0.06)
    angle = np.radians([30.0, 45.0, 60.0, 75.0])
    ratio = law.thrust_force(0.002, 1.7, angle) / law.failure_force(0.002, 1.7, angle)
    np.testing.assert_allclose(ratio, 1.0 / np.tan(angle - math.atan(0.06)))


def test_machining_has_no_shear_plane_below_the_friction_angle() -> None:
    force = MachiningShear(0.05e6, 0.2).failure_force(0.002, 1.0, [0.1, math.atan(0.2), 0.3])
    assert np.isnan(force).tolist() == [True, True, False]


def test_ice_scaled_by_0_02_and_ice_coefficients_that_pull_are_rejected() -> None:
    """By hand at 0.5 mm and 60°: γ = -π/6; (8 + 2·π/6 + 1·0.5) N/mm² · 0.5 mm · 0.02."""
    law = IceCuttingShear(((8e6, -2e6), (1e9, 0.0)))
    expected = (8.0 + math.pi / 3 + 0.5) * 0.5 * 0.02 * 1000.0
    force = float(law.failure_force(0.5e-3, 1.0, math.radians(60.0)))
    assert force == pytest.approx(expected)
    # normal to the cutting face: upright it pushes sideways only
    assert float(law.thrust_force(0.5e-3, 1.0, math.radians(60.0))) == pytest.approx(force / math.tan(math.pi / 3))
    law = IceCuttingShear(((1e6, 2e6),))
    assert float(law.failure_force(0.5e-3, 1.0, math.radians(75.0))) > 0
    with raises(ParameterError, "negative_force", depth=0.0005):
        law.failure_force(0.5e-3, 1.0, np.radians([75.0, 40.0]))


@pytest.mark.parametrize(
    "make",
    [
        lambda: ConstantShear(0.0),
        lambda: ConstantShear(math.nan),
        lambda: AngleShear(-1.0, 0.2),
        lambda: AngleShear(0.05e6, 0.64),
        lambda: AngleShear(0.05e6, math.nan),
        lambda: MachiningShear(0.0, 0.1),
        lambda: MachiningShear(0.05e6, -0.1),
        lambda: IceCuttingShear(()),
        lambda: IceCuttingShear(((),)),
        lambda: IceCuttingShear(((1.0, 2.0), (1.0,))),
        lambda: IceCuttingShear(((math.nan,),)),
        lambda: IceCuttingShear(((1e6,),), snow_over_ice=0.0),
    ],
)
def test_what_no_snow_can_have_is_rejected(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError, match="must be"):
        make()


@pytest.mark.parametrize("name", ["race-piste", "recreational-piste", "spring-snow", "fresh-snow", "glacier"])
def test_a_published_snow_is_inside_the_range(name: str) -> None:
    stress = published_snow(name).failure_shear_stress
    assert stress is not None
    assert float(ConstantShear(stress).failure_force(0.001, 1.0, 0.5)) == pytest.approx(stress * 1e-3)
