"""Planes and measured profiles: the points, between them, beyond them, and everything that is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.geometry.surfaces import Grid
from skisnow.scenario import Plane, Profile, Terrain, load_scenario, read_profile, read_terrain
from skisnow.scenario.terrain import down_and_left, heights_of, normals_of, surface_of
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
def test_what_is_no_profile_is_rejected_with_its_place(x: list[float], height: list[float], told: str | Coded) -> None:
    with raises(ParameterError, told):
        Profile(np.array(x), np.array(height))


def test_cliff_is_reported_by_the_steepest_place_between_the_points() -> None:
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
def test_measured_gap_is_rejected_unless_asked_for() -> None:
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
def test_what_is_wrong_in_a_file_is_reported_with_row_and_column(tmp_path: Path, text: str, told: str | Coded) -> None:
    path = tmp_path / "profile.csv"
    path.write_text(text, encoding="utf-8")
    with raises(ParameterError, told) as error:
        read_profile(path)
    assert str(error.value).startswith(str(path))


def test_file_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    with raises(ParameterError, "cannot_read"):
        read_profile(tmp_path / "nowhere.csv")
    (tmp_path / "image.csv").write_bytes(b"\x89PNG\x00\x81")
    with raises(ParameterError, "not_text"):
        read_profile(tmp_path / "image.csv")


def test_points_of_a_profile_that_nearly_coincide_are_rejected() -> None:
    x = np.array([0.0, 1e-300, 4.0, 6.0])
    with raises(ParameterError, "out_of_range", place=2):
        Profile(x, -0.15 * x)


ASC = """ncols 3
nrows 2
xllcorner 100.0
yllcorner 50.0
cellsize 2.0
NODATA_value -9999
5 6 7
1 2 3
"""
CSV = "x_m,y_m,z_m\n0,0,1\n1,0,2\n0,2,3\n1,2,4\n"


def written(folder: Path, text: str, name: str = "heights.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_table_is_a_grid_whatever_the_order_of_its_rows(tmp_path: Path) -> None:
    head, *rows = CSV.splitlines()
    for each in (rows, rows[::-1], [rows[2], rows[0], rows[3], rows[1]]):
        terrain = read_terrain(written(tmp_path, "\n".join([head, *each])))
        assert (terrain.x.tolist(), terrain.y.tolist()) == ([0.0, 1.0], [0.0, 2.0])
        assert terrain.height.tolist() == [[1.0, 3.0], [2.0, 4.0]]


def test_a_table_is_smoothed_and_shifted_only_where_that_is_asked(tmp_path: Path) -> None:
    path = written(tmp_path, CSV)
    terrain = read_terrain(path)
    assert (terrain.smoothing, terrain.origin_x, terrain.origin_y) == (0.0, 0.0, 0.0)
    asked = read_terrain(path, smoothing=3.0, origin_x=1.0, origin_y=2.0)
    assert (asked.smoothing, asked.origin_x, asked.origin_y) == (3.0, 1.0, 2.0)


def test_places_that_were_rounded_are_even(tmp_path: Path) -> None:
    rows = [f"{x},{y},{float(x) + float(y)}" for x in ("0", "0.333", "0.667", "1") for y in ("0", "1")]
    terrain = read_terrain(written(tmp_path, "\n".join(["x_m,y_m,z_m", *rows])))
    np.testing.assert_allclose(terrain.x, np.arange(4.0) / 3.0, atol=1e-15)
    rows = [f"{x},{y},{y}" for y, first in (("0", "0.001"), ("1", "0")) for x in (first, "1", "2", "3")]
    terrain = read_terrain(written(tmp_path, "\n".join(["x_m,y_m,z_m", *rows])))
    np.testing.assert_allclose(terrain.x, np.arange(4.0), atol=1e-15)


def test_places_that_differ_by_rounding_are_one(tmp_path: Path) -> None:
    """0.1 + 0.2 and 0.3 are the same row of places, 10^-17 m apart."""
    rows = [f"{x!r},{y},0" for x, y in ((0.1 + 0.2, 0), (0.3, 1), (0.6, 0), (0.6, 1), (0.0, 0), (0.0, 1))]
    terrain = read_terrain(written(tmp_path, "\n".join(["x_m,y_m,z_m", *rows])))
    assert terrain.x == pytest.approx([0.0, 0.3, 0.6], abs=1e-12)


def test_origin_is_where_the_scenario_begins(tmp_path: Path) -> None:
    terrain = read_terrain(written(tmp_path, ASC, "heights.asc"), origin_x=102.0, origin_y=51.0)
    assert terrain.surface.x.tolist() == [-1.0, 1.0, 3.0]
    assert float(terrain.surface.heights(0.0, 0.0)) == pytest.approx(1.5, abs=1e-14)
    assert terrain.x.tolist() == [101.0, 103.0, 105.0]


def test_smoothing_halves_a_wave_of_its_length_and_leaves_a_plane_alone() -> None:
    """ISO 16610-21: of a wave λ long 2^-(λ_c/λ)² is left: 1/2 at the cut-off, 0.84 at twice, 1/16 at half of it."""
    x, y, length = np.arange(0.0, 60.0, 0.5), np.arange(0.0, 1.5, 0.5), 6.0
    inside = (x > 12.0) & (x < 48.0)
    for wave in (3.0, 6.0, 12.0):
        bumps = np.repeat(np.sin(2.0 * np.pi * x / wave)[:, None], len(y), axis=1)
        kept = Terrain(x, y, 0.01 * bumps, smoothing=length).surface.values / 0.01
        share = 2.0 ** -((length / wave) ** 2)
        np.testing.assert_allclose(kept[inside], share * bumps[inside], atol=2e-3)  # the weights end at one length
    plane = np.add.outer(-0.3 * x, 0.1 * y)
    np.testing.assert_allclose(Terrain(x, y, plane, smoothing=length).surface.values, plane, atol=1e-11)


def test_surface_has_the_slope_of_its_plane_in_every_direction() -> None:
    terrain = Terrain(
        np.array([-1.0, 1.0]), np.array([0.0, 3.0]), np.add.outer([0.6, -0.6], [0.0, 2.4])
    )  # z = -0.6 x + 0.8 y
    assert float(heights_of(terrain, 0.5, 2.0)) == pytest.approx(1.3, abs=1e-15)
    normal = normals_of(terrain, np.zeros(2), np.array([0.0, 9.0]))
    np.testing.assert_allclose(normal, np.array([[0.6, -0.8, 1.0]] * 2) / math.sqrt(2.0), atol=1e-15)
    down, left = down_and_left(normal[0])
    np.testing.assert_allclose(down, np.array([1.0, 0.0, -0.6]) / math.hypot(1.0, 0.6), atol=1e-15)
    assert left[1] > 0.0
    np.testing.assert_allclose([left @ down, left @ normal[0], left @ left], [0.0, 0.0, 1.0], atol=1e-15)


def test_scenario_reads_its_grid_from_its_folder_and_shows_its_keys(tmp_path: Path) -> None:
    written(tmp_path, ASC, "heights.asc")
    text = '[slope]\nkind = "grid"\ngrid = "heights.asc"\norigin_x_m = 103\norigin_y_m = 52\nsmooth_m = 4\n'
    rest = load_scenario("carved-46m")
    file = written(tmp_path, text + _without_slope(), "turn.toml")
    terrain = load_scenario(file).slope
    assert isinstance(terrain, Terrain)
    assert (terrain.smoothing, terrain.origin_x, terrain.origin_y) == (4.0, 103.0, 52.0)
    smoother = load_scenario(file, changes={"slope.smooth_m": 0}).slope
    assert isinstance(smoother, Terrain)
    assert smoother.surface.values.tolist() == smoother.height.tolist()
    assert load_scenario(file).with_(smooth_m=0.0).slope.surface.values.tolist() == smoother.height.tolist()  # type: ignore[union-attr]
    assert isinstance(load_scenario(file, changes={"slope.kind": "plane", "slope.angle_deg": 9}).slope, Plane)
    changed = {"slope.kind": "grid", "slope.grid": str(tmp_path / "heights.asc"), "start.x_m": 102, "start.y_m": 52}
    assert isinstance(load_scenario("carved-46m", changes=changed).slope, Terrain)
    assert isinstance(rest.slope, Plane)
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes={"slope.smooth_m": 3})
    with raises(ParameterError, "missing", name="slope.grid"):
        load_scenario("carved-46m", changes={"slope.kind": "grid"})
    with raises(ParameterError, "contradiction"):
        load_scenario(file, changes={"start.y_m": 9})


def _without_slope() -> str:
    from skisnow.scenario import scenario_text

    _, _, rest = scenario_text("carved-46m").partition("[slope]")
    return "[" + rest.partition("\n[")[2]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x_m,y_m\n0,0\n", coded("missing_column", column="z_m")),
        (CSV.replace("2,3\n", "2,low\n"), coded("not_a_number", row=4, column="z_m", value="low")),
        (CSV.replace("0,2,3\n", "0,2,inf\n"), coded("not_a_number", row=4, column="z_m", value="inf")),
        (CSV + "1,2,4\n", coded("repeated", row=6, x_m="1", y_m="2", first=5)),
        (CSV.replace("0,2,3\n", ""), coded("missing", x=0.0, y=2.0, n_x=2, n_y=2)),
        ("x_m,y_m,z_m\n0,0,1\n0,1,1\n", coded("out_of_range", column="x_m", places="0 m")),
        ("x_m,y_m,z_m\n", coded("out_of_range", column="x_m", places="nothing")),
        (
            CSV + "1.5,0,4\n1.5,2,5\n",
            coded("uneven_places", first=0.0, last=1.5, step=0.75, row=3, column="x_m", value="1"),
        ),
        (CSV.replace("0,2,3\n", "0,2,30\n"), "out_of_range"),
        (CSV.replace("0,2,3", '0,2,"3,5"'), coded("not_a_number", value="3,5")),
        (CSV.replace("0,2,3", "0,2,3,5"), coded("too_many_cells", row=4, count=4, columns=3)),
        (
            "".join(["x_m,y_m,z_m\n", *(f"{0.1 * i * i},{0.3 * i * i},0\n" for i in range(30))]),
            coded("uneven_places", column="x_m"),
        ),
    ],
)
def test_what_is_wrong_in_a_table_is_reported_with_its_place(tmp_path: Path, text: str, said: str | Coded) -> None:
    path = written(tmp_path, text)
    with raises(ParameterError, said) as error:
        read_terrain(path)
    assert str(error.value).startswith(str(path))


@pytest.mark.parametrize(("rows", "refused"), [(10, False), (11, True)])
def test_rows_that_lie_on_no_grid_are_reported(tmp_path: Path, rows: int, refused: bool) -> None:
    """Ten and more different places along both axes for each row: a line across the grid."""
    text = "x_m,y_m,z_m\n" + "".join(f"{i},{i},0\n" for i in range(rows))
    with pytest.raises(ParameterError) as error:
        read_terrain(written(tmp_path, text))
    assert (f"{rows} rows have {rows} different x_m and {rows} different y_m" in str(error.value)) is refused


def test_a_profile_is_a_table_of_places_two_centimetres_apart_or_nearer() -> None:
    """0.05 m of it in three steps."""
    profile = Profile(np.array([0.0, 0.01, 0.03, 0.05]), np.array([0.0, -0.001, -0.004, -0.01]))
    grid = surface_of(profile)
    assert isinstance(grid, Grid)
    places = np.linspace(0.0, 0.05, 4)
    assert grid.steps[0] == pytest.approx(0.05 / 3.0)
    assert grid.heights(places, 0.0 * places) == pytest.approx(profile.heights(places), abs=1e-12)


def test_file_that_is_not_there_is_reported(tmp_path: Path) -> None:
    for name in ("none.csv", "none.asc", "none.tif"):
        with raises(ParameterError, "cannot_read"):
            read_terrain(tmp_path / name)
