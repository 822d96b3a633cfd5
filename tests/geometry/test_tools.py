"""Surfaces of tools."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.compiled import core
from skisnow.geometry import Disc, LyingCylinder, PlainWedge, SkiPiece, Tool, in_form
from skisnow.geometry.surfaces import Grid

PAPER_TOOL = SkiPiece(length=0.200, width=0.062)
TOOLS: list[tuple[Tool, tuple[float, ...]]] = [
    (PAPER_TOOL, (0.0, 5.0, 30.0, 45.0, 60.0)),
    (PlainWedge(length=0.200, width=0.062), (0.0, 5.0, 30.0, 45.0, 60.0)),
    (Disc(diameter=0.08), (0.0,)),
    (LyingCylinder(radius=0.05, width=0.1), (0.0,)),
]
CASES = [(tool, math.radians(angle)) for tool, angles in TOOLS for angle in angles]


@pytest.mark.parametrize(("angle_deg", "tangent"), [(30.0, 1 / math.sqrt(3)), (45.0, 1.0), (60.0, math.sqrt(3))])
def test_edged_ski_piece_is_the_wedge_of_eqn_2(angle_deg: float, tangent: float) -> None:
    angle, e = math.radians(angle_deg), 0.004
    assert float(PAPER_TOOL.contact_area(e, angle)) == pytest.approx(0.200 * e / tangent, rel=1e-14)
    assert float(PAPER_TOOL.displaced_volume(e, angle)) == pytest.approx(0.200 * e * e / 2 / tangent, rel=1e-14)


def test_flat_ski_piece_is_eqn_3() -> None:
    assert float(PAPER_TOOL.contact_area(0.003, 0.0)) == pytest.approx(200 * 62 * 1e-6, rel=1e-14)
    assert float(PAPER_TOOL.displaced_volume(0.003, 0.0)) == pytest.approx(200 * 62 * 3 * 1e-9, rel=1e-14)


def test_paper_depths_at_490_newton_and_45_degrees() -> None:
    """H_V V = 490 N gives 11.1 mm for H_V = 0.04 N/mm³ and 0.23 mm for 90 N/mm³."""
    for hardness, depth_mm in ((0.04e9, 11.1), (90e9, 0.23)):
        depth = float(PAPER_TOOL.depth_at_volume(490.0 / hardness, math.radians(45.0)))
        assert depth * 1e3 == pytest.approx(depth_mm, abs=0.05 if depth_mm > 1 else 0.005)


def test_at_five_degrees_the_base_goes_under_at_5_4_mm() -> None:
    rim = float(PlainWedge(0.2, 0.062).maximum_depth(math.radians(5.0)))
    assert rim * 1e3 == pytest.approx(5.4, abs=0.05)
    above, below = PAPER_TOOL.contact_area(np.array([0.999, 1.001]) * rim, math.radians(5.0))
    assert above < below == pytest.approx(0.2 * 0.062 * math.cos(math.radians(5.0)))


@given(
    depth=st.floats(0.0, 0.06),
    angle=st.floats(math.radians(2.0), math.radians(85.0)),
    length=st.floats(0.05, 2.0),
    width=st.floats(0.03, 0.1),
)
def test_volume_is_the_integral_of_depth_over_area(depth: float, angle: float, length: float, width: float) -> None:
    """Numerical integration of the base's depth below the surface, point by point across the ski."""
    across = (np.arange(20000) + 0.5) / 20000 * width
    below = np.maximum(depth - across * math.sin(angle), 0.0)
    step = width / 20000 * math.cos(angle)
    tool = SkiPiece(length, width)
    # midpoint rule: the one clipped cell costs at most half a cell
    tolerance = 2.0 * length * step * (depth + width)
    assert float(tool.displaced_volume(depth, angle)) == pytest.approx(
        length * float(below.sum()) * step, abs=tolerance * 1e-3 + 1e-18, rel=1e-6
    )
    assert float(tool.contact_area(depth, angle)) == pytest.approx(
        length * float((below > 0).sum()) * step, abs=length * step
    )


def test_cylinder_volume_is_the_integral_of_its_circle() -> None:
    R, w = 0.05, 0.1
    tool = LyingCylinder(radius=R, width=w)
    for depth in (0.0005, 0.01, 0.05):
        half = math.sqrt(2 * R * depth - depth**2)
        x = (np.arange(200000) + 0.5) / 200000 * 2 * half - half
        section = float((np.sqrt(R**2 - x**2) - (R - depth)).sum()) * 2 * half / 200000
        assert float(tool.displaced_volume(depth, 0.0)) == pytest.approx(w * section, rel=1e-6)
        assert float(tool.contact_area(depth, 0.0)) == pytest.approx(2 * w * half, rel=1e-12)
    buried = tool.displaced_volume(0.08, 0.0) - tool.displaced_volume(0.05, 0.0)
    assert float(buried) == pytest.approx(2 * R * w * 0.03, rel=1e-12)


@pytest.mark.parametrize(("tool", "angle"), CASES)
def test_area_is_the_derivative_of_volume_and_growth_that_of_area(tool: Tool, angle: float) -> None:
    e = np.geomspace(1e-5, 0.07, 90)
    h = 1e-5 * e
    slope = (tool.displaced_volume(e + h, angle) - tool.displaced_volume(e - h, angle)) / (2 * h)
    np.testing.assert_allclose(slope, tool.contact_area(e, angle), rtol=1e-5)
    growth = (tool.contact_area(e + h, angle) - tool.contact_area(e - h, angle)) / (2 * h)
    smooth = np.abs(e - tool.maximum_depth(angle)) > 2e-5
    smooth &= np.abs(e - 0.062 * math.sin(angle)) > 2e-5
    np.testing.assert_allclose(growth[smooth], tool.area_growth(e, angle)[smooth], rtol=1e-5, atol=1e-8)


@pytest.mark.parametrize(("tool", "angle"), CASES)
def test_depth_at_volume_inverts_displaced_volume(tool: Tool, angle: float) -> None:
    e = np.concatenate(([0.0], np.geomspace(1e-6, 0.09, 200)))
    np.testing.assert_allclose(tool.depth_at_volume(tool.displaced_volume(e, angle), angle), e, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("tool", "angle"), CASES)
def test_nothing_is_displaced_at_zero_depth_and_more_with_depth(tool: Tool, angle: float) -> None:
    e = np.linspace(0.0, 0.09, 500)
    volume = tool.displaced_volume(e, angle)
    assert volume[0] == 0.0
    assert np.all(np.diff(volume) > 0)
    assert np.all(np.diff(tool.contact_area(e, angle)) >= -1e-15)


def test_continuation_joins_the_flat_tool_as_the_angle_vanishes() -> None:
    """V(ϑ) = L W cos ϑ (e - W sin ϑ/2): the difference to flat is first order in ϑ."""
    for angle in (1e-3, 1e-5):
        flat = 0.2 * 0.062 * 0.003
        assert abs(float(PAPER_TOOL.displaced_volume(0.003, angle)) - flat) < 0.2 * 0.062**2 * angle


def test_paper_form_is_a_wedge_at_every_depth() -> None:
    wedge = in_form(PAPER_TOOL, "paper")
    assert isinstance(wedge, PlainWedge)
    angle = math.radians(5.0)
    assert float(wedge.contact_area(0.02, angle)) == pytest.approx(0.2 * 0.02 / math.tan(angle))
    assert in_form(PAPER_TOOL, "extended") is PAPER_TOOL
    assert in_form(Disc(0.1), "paper") == Disc(0.1)


@pytest.mark.parametrize("length", [0.0, -0.2, math.nan, math.inf])
def test_a_tool_without_a_length_is_rejected(length: float) -> None:
    with pytest.raises(ParameterError, match="length"):
        SkiPiece(length=length, width=0.062)


@pytest.mark.parametrize(
    ("shape", "name"),
    [(SkiPiece, "width"), (PlainWedge, "length"), (PlainWedge, "width"), (Disc, "diameter"), (LyingCylinder, "radius"),
     (LyingCylinder, "width")],
)  # fmt: skip
def test_each_length_of_each_tool_is_requested(shape: type[Tool], name: str) -> None:
    whole = {field.name: 0.1 for field in fields(shape)}  # type: ignore[arg-type]
    shape(**whole)
    with pytest.raises(ParameterError, match=rf"{name}_mm is 0\.0; "):
        shape(**whole | {name: 0.0})


def test_a_grid_keeps_its_numbers() -> None:
    grid = Grid(np.array([0.0, 0.1, 0.2]), np.array([-1.0, 1.0]), np.arange(6.0).reshape(3, 2))
    assert (grid.x.tolist(), grid.y.tolist()) == ([0.0, 0.1, 0.2], [-1.0, 1.0])
    assert grid.values.tolist() == [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]
    assert not any(array.flags.writeable for array in (grid.x, grid.y, grid.values))


def test_a_profile_is_the_same_at_every_y() -> None:
    profile = Grid.along([0.0, 2.0, 4.0], [1.0, 5.0, 2.0])
    assert (profile.x.tolist(), profile.y.tolist()) == ([0.0, 2.0, 4.0], [0.0])
    assert profile.values.tolist() == [[1.0], [5.0], [2.0]]


def test_one_place_is_enough() -> None:
    assert Grid(np.zeros(1), np.zeros(1), np.array([[3.0]])).values.tolist() == [[3.0]]


@pytest.mark.parametrize(
    ("x", "y", "values", "said"),
    [
        ([0.0, math.nan], [0.0], [[1.0], [2.0]], coded("not_a_number", name="x")),
        ([0.0, 1.0], [math.inf], [[1.0], [2.0]], coded("not_a_number", name="y")),
        ([0.0, 1.0], [0.0], [[1.0], [math.nan]], coded("not_a_number", name="values")),
        ([], [0.0], np.zeros((0, 1)), coded("wrong_shape", name="x", shape="(0,)")),
        ([0.0], [[0.0, 1.0]], [[1.0, 2.0]], coded("wrong_shape", name="y", shape="(1, 2)")),
        ([0.0, 0.0], [0.0], [[1.0], [2.0]], coded("not_rising", name="x", min=0.0, max=0.0)),
        ([1.0, 0.0], [0.0], [[1.0], [2.0]], coded("not_rising", name="x", min=-1.0, max=-1.0)),
        ([0.0], [0.0, 1.0, 3.0], [[1.0, 2.0, 3.0]], coded("not_rising", name="y", min=1.0, max=2.0)),
        ([0.0, 1.0], [0.0], [[1.0, 2.0]], coded("wrong_shape", shape="(1, 2)", n_x=2, n_y=1)),
    ],
)  # fmt: skip
def test_invalid_grid_is_rejected(x: list[float], y: list[float], values: list[list[float]], said: str | Coded) -> None:
    with raises(ParameterError, said):
        Grid(np.asarray(x), np.asarray(y), np.asarray(values))


def test_steps_may_differ_by_rounding_alone() -> None:
    """Steps of a tenth differ by some 1e-16 m; a micrometre in a metre is no rounding."""
    tenths = 0.1 * np.arange(1001)
    assert np.ptp(np.diff(tenths)) > 0.0
    Grid.along(tenths, tenths)
    with raises(ParameterError, "not_rising"):
        Grid.along([0.0, 1.0, 2.000001], np.zeros(3))


def test_patches_are_those_of_the_compiled_core() -> None:
    """Inside, on places, and beyond each border."""
    rng = np.random.default_rng(5)
    for n, m in ((9, 6), (1, 6), (2, 3), (3, 1)):
        grid = Grid(
            np.linspace(-1.0, 3.0, n) if n > 1 else np.zeros(1), np.linspace(0.0, 2.0, m), rng.normal(size=(n, m))
        )
        step_x, step_y = grid.steps
        for goes_on in (True, False):
            there = core.grid(grid.x[0], step_x, grid.y[0], step_y, grid.values.copy(), goes_on)
            for x, y in [*rng.uniform(-2.0, 4.0, (40, 2)).tolist(), (-1.0, 0.0), (3.0, 2.0)]:
                value, along_x, along_y = there.at(x, y)
                found = grid.heights(x, y) if goes_on else grid.values_at(x, y)
                assert float(found) == pytest.approx(value, abs=1e-12)
                assert [float(each) for each in grid.gradients(x, y)] == pytest.approx([along_x, along_y], abs=1e-12)
