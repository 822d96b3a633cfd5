"""Laws of penetration."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises, warns

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.penetration import (
    LAWS,
    AreaLaw,
    BilinearLaw,
    DepthLaw,
    ElementCountLaw,
    MeanPressureLaw,
    PenetrationLaw,
    VolumeLaw,
    VolumeWithAngleLaw,
)
from skisnow.geometry import Disc, LyingCylinder, PlainWedge, SkiPiece, Tool
from skisnow.snow import published_snow
from skisnow.snow.published import federolf_2006, moessner_2013

FEW = settings(max_examples=25)
"""For each of many laws."""

SKI = SkiPiece(length=0.2, width=0.062)
ANGLES = np.radians([0.0, 0.01, 1.0, 10.0, 30.0, 45.0, 60.0])
STEEP = math.radians(70.0)


@dataclass(frozen=True)
class Sample:
    law: PenetrationLaw
    stronger: PenetrationLaw
    factor: float
    outside: tuple[Callable[[], object], ...]
    """Uses outside the measured range."""
    fails: str = ""
    """Check that the law fails, as the table of docs/methods/forces.md has it."""


def steep(law: PenetrationLaw) -> Callable[[], object]:
    return lambda: law.reaction_force(SKI, 0.01, STEEP)


SAMPLES = (
    Sample(VolumeLaw(0.2e9), VolumeLaw(0.6e9), 3.0, (lambda: VolumeLaw(0.01e9), lambda: VolumeLaw(100e9))),
    Sample(VolumeLaw(0.2e9), VolumeLaw(0.1e9), 0.5, (steep(VolumeLaw(0.2e9)),)),
    Sample(
        VolumeWithAngleLaw(0.2e9),
        VolumeWithAngleLaw(0.6e9),
        3.0,
        (lambda: VolumeWithAngleLaw(0.01e9), steep(VolumeWithAngleLaw(0.2e9))),
    ),
    Sample(
        BilinearLaw(0.2e9, 0.0, 0.0, 0.9, 0.2),
        BilinearLaw(0.4e9, 0.0, 0.0, 0.9, 0.2),
        2.0,
        (steep(BilinearLaw(0.2e9, 0.0, 0.0, 0.9, 0.2)),),
    ),
    Sample(
        BilinearLaw(0.2e9, 1e-3, 1e-4, 0.9, -0.2),
        BilinearLaw(0.4e9, 1e-3, 1e-4, 0.9, -0.2),
        2.0,
        (steep(BilinearLaw(0.2e9, 1e-3, 1e-4, 0.9, -0.2)),),
        fails="zero at zero depth",
    ),
    Sample(DepthLaw(40e3), DepthLaw(100e3), 2.5, (steep(DepthLaw(40e3)),)),
    Sample(AreaLaw(0.2e6), AreaLaw(0.8e6), 4.0, (steep(AreaLaw(0.2e6)),), fails="zero at zero depth"),
    Sample(
        MeanPressureLaw(0.01e9, 0.1e6),
        MeanPressureLaw(0.03e9, 0.3e6),
        3.0,
        (
            lambda: MeanPressureLaw(0.04e9, 0.1e6),
            lambda: MeanPressureLaw(0.01e9, 0.4e6),
            lambda: MeanPressureLaw(0.01e9, 0.0),
        ),
        fails="zero at zero depth",
    ),
    Sample(ElementCountLaw(2e9, 0.1), ElementCountLaw(2e9, 0.3), 3.0, (lambda: ElementCountLaw(2e9, 1e-3),)),
    Sample(ElementCountLaw(2e9, 0.1), ElementCountLaw(6e9, 0.1), 3.0, (steep(ElementCountLaw(2e9, 0.1)),)),
)


def bodies() -> list[tuple[Tool, float]]:
    other: list[tuple[Tool, float]] = [(Disc(diameter=0.1), 0.0), (LyingCylinder(radius=0.03, width=0.1), 0.0)]
    return other + [(SKI, float(angle)) for angle in ANGLES]


def zero_at_zero_depth(law: PenetrationLaw) -> None:
    for tool, angle in bodies():
        deep = float(law.reaction_force(tool, 0.01, angle))
        assert float(law.reaction_force(tool, -1e-3, angle)) == 0.0
        assert float(law.reaction_force(tool, 0.0, angle)) == 0.0
        # the slowest beginning among these bodies is A ~ √e of the cylinder: √(10⁻¹⁴/10⁻²) = 10⁻⁶
        assert float(law.reaction_force(tool, 1e-14, angle)) <= 1e-5 * deep


def never_tension(law: PenetrationLaw) -> None:
    for tool, angle in bodies():
        force = law.reaction_force(tool, np.linspace(-0.01, 0.05, 601), angle)
        assert np.all(np.isfinite(force)) and np.all(force >= 0.0)


def growing_with_depth(law: PenetrationLaw) -> None:
    for tool, angle in bodies():
        force = law.reaction_force(tool, np.linspace(-0.01, 0.05, 601), angle)
        assert np.all(np.diff(force) >= -1e-12 * force[-1])  # rounding
        assert force[-1] > 0.0


def continuous_in_depth(law: PenetrationLaw) -> None:
    for tool, angle in bodies():
        kinks = np.array([0.03, 0.062 * math.sin(angle), 0.01])
        kinks = kinks[kinks > 0]
        below, above = (law.reaction_force(tool, kinks + side, angle) for side in (-1e-10, 1e-10))
        # the force of no law here changes more than a hundredfold within a millimetre
        assert np.all(np.abs(above - below) <= 1e-4 * (above + below))
        assert no_jump(partial(force_at, law, tool, angle), 1e-4, 0.05)


def continuous_in_angle(law: PenetrationLaw) -> None:
    for depth in (1e-3, 0.01, 0.04):
        flat, nearly = law.reaction_force(SKI, depth, np.array([0.0, 1e-9]))
        assert nearly == pytest.approx(flat, rel=1e-6)
        edge = math.asin(depth / SKI.width)
        if edge < math.radians(60.0):
            below, above = law.reaction_force(SKI, depth, np.array([edge - 1e-9, edge + 1e-9]))
            assert above == pytest.approx(below, rel=1e-6)
        assert no_jump(partial(law.reaction_force, SKI, depth), 0.0, math.radians(60.0))


def force_at(law: PenetrationLaw, tool: Tool, angle: float, depth: FloatArray) -> FloatArray:
    return law.reaction_force(tool, depth, angle)


def no_jump(force: Callable[[FloatArray], FloatArray], start: float, end: float) -> bool:
    """Halve the step: the largest change of a continuous function shrinks (√½ at a root), that of a jump does not."""
    coarse, fine = (np.abs(np.diff(force(np.linspace(start, end, n)))).max() for n in (4001, 8001))
    return bool(fine <= 0.75 * coarse)


CHECKS: dict[str, Callable[[PenetrationLaw], None]] = {
    "zero at zero depth": zero_at_zero_depth,
    "never tension": never_tension,
    "growing with depth": growing_with_depth,
    "continuous in depth": continuous_in_depth,
    "continuous in angle": continuous_in_angle,
}


def test_every_registered_law_has_a_sample() -> None:
    assert {type(sample.law) for sample in SAMPLES} == set(LAWS)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: repr(sample.law))
@pytest.mark.parametrize("name", CHECKS)
def test_physics(name: str, sample: Sample) -> None:
    if name == sample.fails:
        with pytest.raises(AssertionError):
            CHECKS[name](sample.law)
    else:
        CHECKS[name](sample.law)


@FEW
@given(st.floats(1e-6, 0.06), st.floats(0.0, math.radians(60.0)))
@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: repr(sample.law))
def test_scaling_with_the_parameter(sample: Sample, depth: float, angle: float) -> None:
    force = float(sample.law.reaction_force(SKI, depth, angle))
    assert float(sample.stronger.reaction_force(SKI, depth, angle)) == pytest.approx(sample.factor * force, rel=1e-12)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: repr(sample.law))
def test_scalar_equals_array(sample: Sample) -> None:
    depths = np.array([-1e-3, 0.0, 1e-3, 0.01, 0.05])[:, None]
    table = sample.law.reaction_force(SKI, depths, ANGLES)
    assert table.shape == (5, ANGLES.size)
    for row, depth in zip(table, depths[:, 0], strict=True):
        for value, angle in zip(row, ANGLES, strict=True):
            single = sample.law.reaction_force(SKI, float(depth), float(angle))
            assert single.shape == () and float(single) == value
    assert sample.law.reaction_force(SKI, np.array([]), 0.1).shape == (0,)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: repr(sample.law))
def test_a_warning_outside_the_measured_range(sample: Sample) -> None:
    assert sample.outside
    for use in sample.outside:
        with warns(RangeWarning, "outside_measured") as caught:
            use()
        assert [warning.filename for warning in caught] == [__file__]  # it points at the user's line


@pytest.mark.parametrize("law", [sample.law for sample in SAMPLES], ids=repr)
def test_degrees_for_radians_are_rejected(law: PenetrationLaw) -> None:
    for wrong in (45.0, -0.1, math.nan):
        with raises(ParameterError, "out_of_range"):
            law.reaction_force(SKI, 0.01, np.array([0.5, wrong]))


def test_the_plain_wedge_of_the_paper_is_not_continuous_in_the_angle() -> None:
    """The checks above rest on the continued geometry: Eqn 2 alone diverges as ϑ → 0."""
    wedge = PlainWedge(length=0.2, width=0.062)
    flat, nearly = VolumeLaw(0.2e9).reaction_force(wedge, 0.01, np.array([0.0, 1e-3]))
    assert nearly > 50 * flat


EDGED = math.radians(45.0)


@pytest.mark.parametrize(("hardness_N_per_mm3", "depth_mm"), [(0.04, 11.1), (90.0, 0.23)])
def test_depth_at_490_newton_over_the_range_of_snow(hardness_N_per_mm3: float, depth_mm: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)): the force at that depth is 490 N, within the rounding of the depth (4 % at 0.23)."""
    law = VolumeLaw(hardness_N_per_mm3 * 1e9)
    exact = math.sqrt(2 * 490.0 * math.tan(EDGED) / (law.snow_hardness * SKI.length))
    assert exact * 1e3 == pytest.approx(depth_mm, abs=0.05 if depth_mm > 1 else 0.005)
    assert float(law.reaction_force(SKI, exact, EDGED)) == pytest.approx(490.0, rel=1e-12)


@pytest.mark.parametrize(("angle_deg", "factor"), [(0.0, 0.99), (30.0, 1.063), (45.0, 1.100), (60.0, 1.137)])
def test_factors_of_equation_11(angle_deg: float, factor: float) -> None:
    """Radians, not degrees: 0.14 times 45 would be 6.3."""
    angle = math.radians(angle_deg)
    ratio = VolumeWithAngleLaw(0.2e9).reaction_force(SKI, 0.01, angle) / VolumeLaw(0.2e9).reaction_force(
        SKI, 0.01, angle
    )
    assert float(ratio) == pytest.approx(factor, abs=0.0005)  # printed to three places


def test_a_flat_tool_by_hand() -> None:
    """0.2 N/mm³ · 200 mm · 62 mm · 5 mm = 12,400 N; by depth, 40 N/mm · 5 mm; by area, 0.2 N/mm² · 12,400 mm²."""
    assert float(VolumeLaw(0.2e9).reaction_force(SKI, 0.005, 0.0)) == pytest.approx(12400.0)
    assert float(DepthLaw(40e3).reaction_force(SKI, 0.005, 0.0)) == pytest.approx(200.0)
    assert float(AreaLaw(0.2e6).reaction_force(SKI, 0.005, 0.0)) == pytest.approx(2480.0)


@given(st.floats(1e-4, 0.06), st.floats(0.0, math.radians(60.0)))
def test_the_general_law_contains_its_rivals(depth: float, angle: float) -> None:
    b0, b1 = moessner_2013.ANGLE_TERM
    pairs = [
        (BilinearLaw(0.2e9, 0.0, 0.0, 1.0, 0.0), VolumeLaw(0.2e9)),
        (BilinearLaw(0.2e9, 0.0, 0.0, b0, b1), VolumeWithAngleLaw(0.2e9)),
        (BilinearLaw(0.2e6, 1.0, 0.0, 0.0, 0.0), AreaLaw(0.2e6)),
    ]
    for general, special in pairs:
        assert float(general.reaction_force(SKI, depth, angle)) == pytest.approx(
            float(special.reaction_force(SKI, depth, angle)), rel=1e-12
        )


def test_bilinear_force_is_the_integral_of_its_stress_and_bilinear_rejects_snow_that_pulls() -> None:
    """Eqn 5: ∫ H (a + b ε) dA over the base, point by point, past the upper edge of the base too."""
    law = BilinearLaw(0.2e9, 1e-3, 2e-4, 0.9, 0.1)
    for depth in (0.01, 0.06):
        across = (np.arange(200_000) + 0.5) / 200_000 * SKI.width
        below = depth - across * math.sin(EDGED)
        stress = 0.2e9 * (1e-3 + 2e-4 * EDGED + (0.9 + 0.1 * EDGED) * below)
        element = SKI.length * SKI.width / 200_000 * math.cos(EDGED)
        whole = float(np.sum(np.where(below > 0, stress, 0.0))) * element
        # a strip at the rim of the contact is in or out as a whole
        assert float(law.reaction_force(SKI, depth, EDGED)) == pytest.approx(whole, rel=2e-5)
    law = BilinearLaw(0.2e9, 0.0, 0.0, 0.5, -0.6)
    assert float(law.reaction_force(SKI, 0.01, 0.8)) > 0
    with raises(ParameterError, "out_of_range", name="b", at_zero=0.5, slope=-0.6, worst=0.9):
        law.reaction_force(SKI, 0.01, np.array([0.2, 0.9]))
    with raises(ParameterError, "out_of_range", name="a", at_zero=1e-3, slope=-2e-3, worst=0.9):
        BilinearLaw(0.2e9, 1e-3, -2e-3, 0.5, 0.1).reaction_force(SKI, 0.01, np.array([0.2, 0.9]))


@pytest.mark.parametrize("name", federolf_2006.NAMES)
def test_federolf_is_volume_and_shear_at_the_angle_of_conversion(name: str) -> None:
    """Mössner and others 2013: N = F_n cos ϑ + F_t sin ϑ with H_V and S_f as converted, in the wedge regime."""
    snow = published_snow(name)
    slope, offset = federolf_2006.PRESSURE_LAWS[name]
    law = MeanPressureLaw(slope * 1e9, offset * 1e6)
    angle = federolf_2006.CONVERSION_ANGLE
    depth = np.array([0.001, 0.01, 0.04])
    assert snow.failure_shear_stress is not None
    normal = VolumeLaw(snow.snow_hardness).reaction_force(SKI, depth, angle)
    shear = snow.failure_shear_stress * depth * SKI.length
    both = normal * math.cos(angle) + shear * math.sin(angle)
    np.testing.assert_allclose(law.base_force(SKI, depth, angle), both, rtol=1e-12)
    # the force over the area in the snow is the mean pressure
    np.testing.assert_allclose(
        law.base_force(SKI, depth, angle) / (depth * SKI.length / math.sin(angle)), slope * 1e9 * depth + offset * 1e6
    )


def test_components_of_the_force_on_the_base_make_the_whole() -> None:
    law = MeanPressureLaw(0.02e9, 0.1e6)
    normal, side, whole = (
        float(force(SKI, 0.01, 0.5)) for force in (law.reaction_force, law.side_force, law.base_force)
    )
    assert math.hypot(normal, side) == pytest.approx(whole)
    assert side / normal == pytest.approx(math.tan(0.5))


def test_federolf_flat_starts_with_a_jump() -> None:
    force = MeanPressureLaw(0.02e9, 0.1e6).reaction_force(SKI, np.array([-1e-12, 0.0, 1e-12]), 0.0)
    assert force == pytest.approx([0.0, 0.1e6 * 0.2 * 0.062, 0.1e6 * 0.2 * 0.062])


def test_counting_elements_is_the_volume_law_and_any_tool_will_do() -> None:
    law = ElementCountLaw(elements_per_volume=5e9, force_per_element=0.04)
    depth = np.linspace(0.0, 0.06, 30)
    np.testing.assert_allclose(
        law.reaction_force(SKI, depth, EDGED), VolumeLaw(law.snow_hardness).reaction_force(SKI, depth, EDGED)
    )
    assert law.snow_hardness == pytest.approx(0.2e9)
    assert float(VolumeLaw(0.2e9).reaction_force(PlainWedge(0.2, 0.062), 0.01, EDGED)) == pytest.approx(2000.0)


@pytest.mark.parametrize(
    "make",
    [
        lambda: VolumeLaw(0.0),
        lambda: VolumeWithAngleLaw(-1.0),
        lambda: BilinearLaw(1.0, math.nan, 0.0, 1.0, 0.0),
        lambda: BilinearLaw(0.0, 0.0, 0.0, 1.0, 0.0),
        lambda: DepthLaw(math.inf),
        lambda: AreaLaw(-0.2e6),
        lambda: MeanPressureLaw(0.0, 0.1e6),
        lambda: MeanPressureLaw(0.01e9, -1.0),
        lambda: ElementCountLaw(1e9, 0.0),
    ],
)
def test_what_no_snow_can_have_is_rejected(make: Callable[[], object]) -> None:
    with pytest.raises(ParameterError) as caught:
        make()
    assert caught.value.code in {"out_of_range", "not_a_number"}


@pytest.mark.filterwarnings("error::skisnow._support.errors.RangeWarning")
@pytest.mark.parametrize("name", federolf_2006.PRESSURE_LAWS)
def test_the_pressure_laws_of_the_paper_lie_in_its_range(name: str) -> None:
    """The slopes go from 0.0036 to 0.034 N/mm³, the offsets from 0.058 to 0.35 N/mm²; beyond is warned of."""
    slope, offset = federolf_2006.PRESSURE_LAWS[name]
    MeanPressureLaw(slope * 1e9, offset * 1e6)
    for beyond in ((0.0035e9, 0.06e6), (0.0341e9, 0.06e6), (0.02e9, 0.057e6), (0.02e9, 0.351e6)):
        with raises(RangeWarning, "outside_measured"):
            MeanPressureLaw(*beyond)
