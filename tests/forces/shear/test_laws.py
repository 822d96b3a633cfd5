"""The shear laws against numbers of the papers."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.forces.shear import (
    AngleShear,
    ConstantShear,
    DensityShear,
    IceCuttingShear,
    MachiningShear,
    NaturalDensityShear,
)
from skisnow.snow import published_snow


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


@pytest.mark.parametrize("density", [-1.0, 0.0, 100.0, 151.6, 918.0, math.nan])
def test_equation_14_refuses_a_negative_strength(density: float) -> None:
    with raises(ParameterError, "out_of_range"):
        DensityShear(density)


@pytest.mark.parametrize("density", [-1.0, 0.0, 50.0, 112.2, 918.0, math.nan])
def test_domine_refuses_where_the_square_rises_again(density: float) -> None:
    """At 50 kg/m³ the square would give 41 Pa, more than the 0.6 Pa at 120."""
    with raises(ParameterError, "out_of_range"):
        NaturalDensityShear(density)


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


def test_ice_scaled_by_0_02() -> None:
    """By hand at 0.5 mm and 60°: γ = -π/6; (8 + 2·π/6 + 1·0.5) N/mm² · 0.5 mm · 0.02."""
    law = IceCuttingShear(((8e6, -2e6), (1e9, 0.0)))
    expected = (8.0 + math.pi / 3 + 0.5) * 0.5 * 0.02 * 1000.0
    force = float(law.failure_force(0.5e-3, 1.0, math.radians(60.0)))
    assert force == pytest.approx(expected)
    # normal to the cutting face: upright it pushes sideways only
    assert float(law.thrust_force(0.5e-3, 1.0, math.radians(60.0))) == pytest.approx(force / math.tan(math.pi / 3))


def test_ice_coefficients_that_pull_are_refused() -> None:
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
def test_what_no_snow_can_have_is_refused(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError, match="must be"):
        make()


@pytest.mark.parametrize("name", ["race-piste", "recreational-piste", "spring-snow", "fresh-snow", "glacier"])
def test_a_published_snow_is_inside_the_range(name: str) -> None:
    stress = published_snow(name).failure_shear_stress
    assert stress is not None
    assert float(ConstantShear(stress).failure_force(0.001, 1.0, 0.5)) == pytest.approx(stress * 1e-3)
