"""Ends of every measured range as the publications print them, and bounds of every parameter that have one."""

import math
import warnings
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import pytest
from tests.coded import raises, warns

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces import parameter_checks
from skisnow.forces.friction import LinearFriction
from skisnow.forces.penetration import HypoplasticPoint, LayeredPoint, MeanPressurePoint, PointLaw, ProfilePoint
from skisnow.forces.shear import (
    AngleShear,
    ConstantShear,
    DensityShear,
    IceCuttingShear,
    MachiningShear,
    NaturalDensityShear,
    ShearLaw,
)

DEGREE: Final = math.pi / 180.0
RANGES: Final[dict[str, tuple[float, float, str, float, str]]] = {
    "SNOW_HARDNESS": (0.0219, 90.0, "N/mm³", 1e9, "2013"),
    "FAILURE_SHEAR_STRESS": (0.04, 0.5216, "N/mm²", 1e6, "2013"),
    "PENETRATION_EDGE_ANGLE": (0.0, 60.0, "°", DEGREE, "2013"),
    "GROOMED_SNOW_DENSITY": (420.0, 740.0, "kg/m³", 1.0, "2013"),
    "NATURAL_SNOW_DENSITY": (112.291, 500.0, "kg/m³", 1.0, "2011"),
    "PRESSURE_SLOPE": (0.0036, 0.034, "N/mm³", 1e9, "2006"),
    "PRESSURE_OFFSET": (0.058, 0.35, "N/mm²", 1e6, "2006"),
    "ICE_CUTTING_DEPTH": (0.0, 1.0, "mm", 1e-3, "1985"),
    "ICE_CUTTING_EDGE_ANGLE": (30.0, 75.0, "°", DEGREE, "1985"),
    "GLIDE_FRICTION": (0.023, 0.139, "", 1.0, "2021"),
    "DRAG_AREA": (0.23, 0.66, "m²", 1.0, "2022"),
}
"""Lowest and highest in the unit of the warning, that unit and its size in SI, and year of the measurement."""


def test_every_range_is_listed() -> None:
    ranges = {name for name, value in vars(parameter_checks).items() if hasattr(value, "warn_outside")}
    assert ranges - {"MeasuredRange"} == set(RANGES)


@pytest.mark.parametrize("name", RANGES)
def test_ends_of_a_measured_range(name: str) -> None:
    lowest, highest, unit, size, year = RANGES[name]
    measured = getattr(parameter_checks, name)
    assert year in str(measured.source)
    assert (measured.lowest / size, measured.highest / size) == pytest.approx((lowest, highest), rel=2e-3)
    step = 1e-3 * (measured.highest - measured.lowest)
    between = 0.5 * (measured.lowest + measured.highest)
    for value in (measured.lowest - step, measured.highest + step):
        with warns(RangeWarning, "outside_measured", unit=unit, relation="a law", value=value / size):
            measured.warn_outside([between, value], "a law")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        measured.warn_outside([measured.lowest, between, measured.highest], "a law")


def test_edge_angles_go_from_0_to_a_right_angle() -> None:
    """To one part in 10⁹; the first wrong one is named."""
    right = math.pi / 2.0
    good = [0.0, 0.5, right, right * (1.0 + 0.9e-9)]
    assert parameter_checks.edge_angles(good).tolist() == good
    assert parameter_checks.edge_angles(0.5).shape == ()
    for wrong in (-1e-12, right * (1.0 + 1.1e-9), 1.6):
        with raises(ParameterError, "out_of_range", edge_angle=wrong):
            parameter_checks.edge_angles([0.1, wrong, 60.0])


def test_friction_is_compared_at_10_m_per_s() -> None:
    with warns(RangeWarning, "outside_measured", value=0.2, relation="LinearFriction at 10 m/s"):
        LinearFriction(0.1, 0.01)


MACHINING: Final = MachiningShear(0.1e6, 0.2, least_shear_plane=0.1)
LAWS: Final[tuple[ShearLaw, ...]] = (
    ConstantShear(0.1e6),
    AngleShear(0.1e6, 0.266),
    DensityShear(500.0),
    NaturalDensityShear(300.0),
    MACHINING,
    IceCuttingShear(((8e6, -2e6), (1e9, 0.0))),
)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_stress_and_thrust_for_loops_are_those_of_the_forces(law: ShearLaw) -> None:
    depth, angle = np.array([2e-4, 5e-4, 9e-4]), np.array([0.7, 0.9, 1.1])
    stress, thrust = law.stress_and_thrust(depth, angle)
    assert stress == pytest.approx(law.failure_force(depth, 3.0, angle) / (3.0 * depth), rel=1e-12)
    assert thrust == pytest.approx(law.thrust_force(depth, 3.0, angle) / (3.0 * depth), rel=1e-12, abs=1e-9)
    assert (thrust != 0.0).all() == isinstance(law, MachiningShear | IceCuttingShear)


def test_the_shear_plane_of_machining_is_held_above_its_least_angle() -> None:
    """At 0.1 rad: 2 S cot φ, and S (cot² φ - 1) out of the snow; it is reached at ϑ = arctan μ_t + 0.2."""
    assert MachiningShear(0.1e6, 0.2).least_shear_plane == 0.0
    cot = 1.0 / math.tan(0.1)
    for angle in (0.0, 0.1, math.atan(0.2) + 0.2):
        assert float(MACHINING.failure_stress(1e-3, angle)) == pytest.approx(0.2e6 * cot)
        assert float(MACHINING.thrust_force(1e-3, 2.0, angle)) == pytest.approx(0.1e6 * (cot**2 - 1.0) * 2e-3)
    beyond = math.atan(0.2) + 0.3
    assert float(MACHINING.failure_stress(1e-3, beyond)) == pytest.approx(0.2e6 / math.tan(0.15))


@pytest.mark.parametrize(
    ("make", "inside", "outside"),
    [
        (lambda value: MachiningShear(0.1e6, 0.2, least_shear_plane=value), 0.0, -1e-9),
        (lambda value: MachiningShear(0.1e6, 0.2, least_shear_plane=value), math.pi / 4.0, math.pi / 4.0 + 1e-9),
        (lambda value: AngleShear(0.1e6, value), 2.0 / math.pi - 1e-9, 2.0 / math.pi + 1e-9),
        (DensityShear, 151.62, 151.6),
        (DensityShear, 917.0, 917.1),
        (NaturalDensityShear, 112.3, 112.29),
        (NaturalDensityShear, 917.0, 917.1),
        (lambda value: HypoplasticPoint(0.2e9, value), 1.0, 1.0 - 1e-9),
        (lambda value: MeanPressurePoint(0.02e9, 0.1e6, value), 1.0, 1.0 - 1e-9),
        (lambda value: ProfilePoint(0.2e9, value, (0.0,), (1.0,)), 1.0, 1.0 - 1e-9),
        (lambda value: LayeredPoint(0.2e9, 2.0, 0.01, 0.2e9, value), 0.0, -1e-9),
        (lambda value: IceCuttingShear(((1e6, value),)), 0.0, math.inf),
    ],
)
@pytest.mark.filterwarnings("ignore::skisnow._support.errors.RangeWarning")
def test_bounds_of_parameters(make: Callable[[float], object], inside: float, outside: float) -> None:
    make(inside)
    with pytest.raises(ParameterError) as caught:
        make(outside)
    assert caught.value.code in {"out_of_range", "not_a_number"}


def test_a_density_is_refused_with_its_bounds() -> None:
    with raises(
        ParameterError, "out_of_range", snow_density=950.0, ice_density=917.0, lowest=420.0, highest=740.0
    ) as caught:
        DensityShear(950.0)
    assert caught.value.fields["minimum"] == pytest.approx(0.047 / 0.00031)


@pytest.mark.parametrize("rows", [(), ((),), ((1.0, 2.0), (1.0,)), ((), (1.0,)), ((1.0, math.nan),), ((-math.inf,),)])
def test_rows_of_ice_coefficients(rows: Any) -> None:
    with raises(ParameterError, "not_a_number", rows=rows):
        IceCuttingShear(rows)


@pytest.mark.parametrize(
    ("tops", "shares"),
    [
        ((0.0, 0.02), (1.0,)),
        ((0.01, 0.02), (1.0, 2.0)),
        ((0.0, 0.02, 0.02), (1.0, 2.0, 3.0)),
        ((0.0, -0.1), (1.0, 2.0)),
    ],
)
def test_layers_rise_from_the_surface(tops: tuple[float, ...], shares: tuple[float, ...]) -> None:
    with raises(ParameterError, "out_of_order", tops=tops, count=len(shares)):
        ProfilePoint(0.2e9, 2.0, tops, shares)
    with raises(ParameterError, "out_of_range", name="shares", value=0.0):
        ProfilePoint(0.2e9, 2.0, (0.0, 0.1), (0.0, 1.0))


def test_bends_are_the_borders_and_the_end_of_the_ramp() -> None:
    assert HypoplasticPoint(0.2e9, 2.0).bends == ()
    assert LayeredPoint(0.2e9, 2.0, 0.02, 0.4e9).bends == (0.02,)
    assert ProfilePoint(0.2e9, 2.0, (0.0, 0.02, 0.05), (1.0, 2.0, 3.0)).bends == (0.02, 0.05)
    assert MeanPressurePoint(0.02e9, 0.1e6, 2.0).bends == (0.5e-3,)
    along = {law.along_base_normal for law in (HypoplasticPoint, LayeredPoint, ProfilePoint)}
    assert (along, MeanPressurePoint.along_base_normal) == ({False}, True)


@pytest.mark.parametrize(
    "law",
    [LayeredPoint(0.2e9, 2.0, 0.02, 0.4e9), ProfilePoint(0.2e9, 2.0, (0.0, 0.02), (1.0, 2.0))],
    ids=lambda law: type(law).__name__,
)
def test_a_place_above_untouched_snow_is_unloaded(law: PointLaw) -> None:
    assert float(law.stress(-0.01, 0.0)) == float(law.stored_energy(-0.01, 0.0)) == float(law.lost_energy(-0.01)) == 0.0
    assert float(law.residual_depth(-0.01)) == -0.01
