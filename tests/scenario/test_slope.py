"""Planes and measured profiles: the points, between them, beyond them, and everything that is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Plane, Profile, read_profile
from tests.coded import Coded, coded, raises

MEASURED = Path(__file__).resolve().parents[3] / "shared" / "data" / "slope-profiles"
UTAH, CALIFORNIA = MEASURED / "utah-2010-surface.csv", MEASURED / "california-2002-surface.csv"
measured = pytest.mark.skipif(not UTAH.is_file(), reason="no ../shared")


@pytest.mark.parametrize("degrees", [-1.0, 75.1, 90.0, math.nan])
def test_plane_is_no_cliff(degrees: float) -> None:
    with raises(ParameterError, "out_of_range", low=0.0, high=75.0, allowed="from 0 to 75", unit="°"):
        Plane(math.radians(degrees))


def test_profile_of_a_straight_line_is_that_line_also_beyond_its_ends() -> None:
    profile = Profile(np.array([0.0, 1.0, 3.0, 6.0]), np.array([2.0, 1.5, 0.5, -1.0]))
    x = np.linspace(-2.0, 8.0, 41)
    np.testing.assert_allclose(profile.heights(x), 2.0 - 0.5 * x, atol=1e-13)  # rounding
    np.testing.assert_allclose(profile.gradients(x), -0.5, atol=1e-13)


def test_profile_passes_through_its_points_and_never_overshoots() -> None:
    """A terrace: a cubic spline would swing above and below it; monotone cubics stay between neighbouring heights."""
    x, height = np.arange(6.0), np.array([3.0, 3.0, 3.0, 1.0, 1.0, 1.0])
    profile = Profile(x, height)
    np.testing.assert_array_equal(profile.heights(x), height)
    between = profile.heights(np.linspace(0.0, 5.0, 501))
    assert between.max() == 3.0
    assert between.min() == 1.0
    assert np.all(np.diff(between) <= 0.0)


def test_gradient_is_the_derivative_of_the_height() -> None:
    x = np.linspace(0.0, 10.0, 11)
    profile = Profile(x, -0.3 * x + 0.2 * np.sin(x))
    at, step = np.linspace(0.05, 9.95, 100), 1e-6
    differences = (profile.heights(at + step) - profile.heights(at - step)) / (2.0 * step)
    np.testing.assert_allclose(profile.gradients(at), differences, atol=1e-8)  # rounding of heights over 2 micrometres
    # monotone cubics are of second order in the slope at best: 1 m apart and curvature below 0.2 1/m
    assert np.abs(profile.gradients(at) - (-0.3 + 0.2 * np.cos(at))).max() < 0.1


def test_coefficients_are_those_of_the_cubics() -> None:
    x = np.array([0.0, 1.0, 2.5, 4.0])
    profile = Profile(x, np.array([0.0, -0.4, -0.7, -1.4]))
    a, b, c, d = profile.coefficients[:, 1]
    assert ((a * 0.5 + b) * 0.5 + c) * 0.5 + d == pytest.approx(float(profile.heights(1.5)), abs=1e-15)


def test_tables_are_copied_and_read_only() -> None:
    x = np.arange(4.0)
    profile = Profile(x, -x)
    x[0] = -5.0
    assert profile.ends == (0.0, 3.0)
    with pytest.raises(ValueError, match="read-only"):
        profile.height[0] = 1.0


@pytest.mark.parametrize(
    ("x", "height", "told"),
    [
        ([0, 1, 2], [0, -1, -2], coded("wrong_shape", fewest_points=4)),
        ([0, 1, 2, 3], [0, -1, -2], coded("wrong_shape", fewest_points=4)),
        ([0, 1, 1, 2], [0, 0, 0, 0], coded("out_of_range", place=3, x=1.0, before=1.0)),
        ([0, 1, 2, math.nan], [0, 0, 0, 0], coded("not_a_number", name="x", place=4)),
        ([0, 1, 2, 3], [0, math.inf, 0, 0], coded("not_a_number", name="the height", place=2)),
        ([0, 1, 7, 8], [0, 0, 0, 0], coded("out_of_range", x=1.0, end=7.0, width=6.0)),
        ([0, 1, 2, 3, 4], [0, 0, -9, -9, -9], coded("out_of_range", x=1.0, end=2.0)),
        ([0, 1, 2, 3, 4], [0, 0, 9, 9, 9], coded("out_of_range", x=1.0, end=2.0)),
    ],
)
def test_what_is_no_profile_is_refused_with_its_place(x: list[float], height: list[float], told: str | Coded) -> None:
    with raises(ParameterError, told):
        Profile(np.array(x), np.array(height))


def test_cliff_is_told_by_the_steepest_place_between_the_points() -> None:
    """A cubic that starts and ends flat is 1.5 times as steep half-way as its chord: 1.5 × 3 = tan 77.5 degrees."""
    with raises(ParameterError, "out_of_range"):
        Profile(np.arange(4.0), np.array([0.0, 0.0, -3.0, -3.0]))
    assert Profile(np.arange(4.0), np.array([0.0, 0.0, -2.4, -2.4])).gradients(1.5) == pytest.approx(-3.6)


@measured
def test_measured_profile_is_read_as_it_stands() -> None:
    profile = read_profile(UTAH)
    assert len(profile.x) == 151
    assert profile.x[1] == 0.3048006096012192
    assert profile.height[1] == -1.724664935211867
    assert profile.ends == (0.0, 45.72009144018288)
    assert profile.gap == "error"
    assert str(UTAH) in profile.source


@measured
def test_measured_gap_is_refused_unless_asked_for() -> None:
    with raises(ParameterError, "out_of_range", x=13.96747455795386, end=24.384):
        read_profile(CALIFORNIA)
    profile = read_profile(CALIFORNIA, gap="interpolate")
    # from the kicker's lip, -1.22 m, down to -5.53 m, without a swing
    assert -5.53 < float(profile.heights(19.0)) < -1.22


@pytest.mark.parametrize("separator", [";", "\t"])
def test_profile_with_decimal_commas(tmp_path: Path, separator: str) -> None:
    plain, written = tmp_path / "plain.csv", tmp_path / "written.csv"
    text = "x,y\n0,0\n1.5,-0.25\n3,-0.5\n4.5,-0.875\n"
    plain.write_text(text, encoding="utf-8")
    written.write_text(text.replace(",", separator).replace(".", ","), encoding="utf-8")
    ours, theirs = read_profile(written), read_profile(plain)
    assert ours.x.tolist() == theirs.x.tolist() == [0.0, 1.5, 3.0, 4.5]
    assert ours.height.tolist() == theirs.height.tolist()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x,z\n0,1\n", coded("missing_column", column="y")),
        ("", coded("missing_column", column="x")),
        ("x,y\n0,0\n1,low\n", coded("not_a_number", row=3, column="y", value="low")),
        ("x,y\n0,0\n\n1\n", coded("not_a_number", row=4, column="y")),
        ("x,y\ninf,0\n", coded("not_a_number", row=2, column="x", value="inf")),
        ("x,y\n0,0\n1,-1\n", coded("wrong_shape", fewest_points=4)),
        ("x,y\n0,-0,000\n1,-0,200\n", coded("too_many_cells", row=2, count=3, columns=2)),
        ("x,y\n0,0\n1,-0.2,7\n", coded("too_many_cells", row=3, count=3, columns=2)),
    ],
)
def test_what_is_wrong_in_a_file_is_told_with_row_and_column(tmp_path: Path, text: str, told: str | Coded) -> None:
    path = tmp_path / "profile.csv"
    path.write_text(text, encoding="utf-8")
    with raises(ParameterError, told) as error:
        read_profile(path)
    assert str(error.value).startswith(str(path))


def test_file_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    with raises(ParameterError, "cannot_read"):
        read_profile(tmp_path / "nowhere.csv")
    (tmp_path / "image.csv").write_bytes(b"\xff\xfe\x00\x81")
    with raises(ParameterError, "not_text"):
        read_profile(tmp_path / "image.csv")


def test_points_of_a_profile_that_nearly_coincide_are_rejected() -> None:
    x = np.array([0.0, 1e-300, 4.0, 6.0])
    with raises(ParameterError, "out_of_range", place=2):
        Profile(x, -0.15 * x)
