"""A ski and the profile of its base."""

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.coded import Coded, coded, raises

from skisnow import read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.ski import Ski
from skisnow.ski.layout import LONGEST, BaseShape, layout_of_lengths
from skisnow.ski.ski import radius_of_least_squares_circle

N = 801
STATION = np.linspace(0.8, -0.8, N)


def arc_table(radius: float = 14.0, **changes: Any) -> Ski:
    """A ski whose edge is a true circle of the given radius, 60 mm wide at the waist."""
    tables: dict[str, Any] = {
        "name": "arc",
        "source": "test",
        "station": STATION,
        "width": 0.060 + 2.0 * (radius - np.sqrt(radius**2 - STATION**2)),
        "base_height": np.zeros(N),
        "bending_stiffness": np.full(N, 200.0),
        "torsional_stiffness": np.full(N, 100.0),
        "mass_per_length": np.full(N, 1.5),
        "running_length": 1.4,
        "sidecut_length": 1.5,
    }
    return Ski(**{**tables, **changes})


def test_both_radii_of_a_true_arc_and_tapered_ski_has_the_depth_of_its_mean_width() -> None:
    ski = arc_table(radius=14.0)
    # interpolated linearly over 2 mm the edge is off by h²/8R = 4e-8 m of a sagitta of 20 mm
    assert ski.sidecut_radius_of_edge_line == pytest.approx(14.0, rel=1e-5)
    # of a circle L²/8δ = R (1 + cos φ)/2 with φ = half the arc: 0.07 % less here
    half_arc = math.asin(0.75 / 14.0)
    assert ski.sidecut_radius_of_three_widths == pytest.approx(14.0 * (1.0 + math.cos(half_arc)) / 2.0, rel=1e-5)
    ski = arc_table(width=0.060 + 0.02 * (STATION / 0.75) ** 2 + 0.004 * STATION / 0.75)
    assert ski.sidecut_widths == pytest.approx((0.084, 0.060, 0.076), abs=1e-6)
    assert ski.sidecut_depth == pytest.approx(0.010, abs=1e-6)
    assert ski.sidecut_radius_of_three_widths == pytest.approx(1.5**2 / 0.080, rel=1e-4)


def test_straight_ski_has_no_radius_and_length_mass_and_torsional_inertia() -> None:
    ski = arc_table(width=np.full(N, 0.062))
    assert ski.sidecut_radius_of_three_widths == math.inf
    assert ski.sidecut_radius_of_edge_line == math.inf
    assert (ski.tip_width, ski.waist_width, ski.tail_width) == (0.062, 0.062, 0.062)
    ski = arc_table(width=np.full(N, 0.06), mass_per_length=np.linspace(1.0, 2.0, N))
    assert ski.length == pytest.approx(1.6, abs=1e-15)
    assert ski.mass == pytest.approx(1.5 * 1.6, rel=1e-12)  # the trapezoid is exact for a line
    assert ski.torsional_inertia_per_length[0] == pytest.approx(1.0 * 0.06**2 / 12.0, rel=1e-15)


def test_sections_between_stations() -> None:
    ski = arc_table(bending_stiffness=200.0 + 100.0 * STATION)
    sections = ski.at([[0.1234, -0.4321]])
    assert sections.bending_stiffness == pytest.approx(np.array([[212.34, 156.79]]), rel=1e-12)
    assert sections.station.shape == (1, 2)
    assert float(ski.at(0.8).width) == ski.width[0]


@pytest.mark.parametrize("station", [0.81, -0.8001, math.nan])
def test_no_sections_beyond_the_ski(station: float) -> None:
    with raises(ParameterError, "invalid_ski"):
        arc_table().at(station)


def test_tables_are_copied_and_cannot_be_written() -> None:
    stiffness = np.full(N, 200.0)
    ski = arc_table(bending_stiffness=stiffness)
    stiffness[0] = 1.0
    assert ski.bending_stiffness[0] == 200.0
    with pytest.raises(ValueError, match="read-only"):
        ski.width[0] = 1.0


def test_replaced_field_is_checked_too() -> None:
    with raises(ParameterError, "invalid_ski", bevel=1.0):
        dataclasses.replace(arc_table(), base_bevel=1.0)


def with_one(value: float) -> np.ndarray[Any, Any]:
    table = np.full(N, 100.0)
    table[600] = value
    return table


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"name": " "}, coded("invalid_ski", name=" ")),
        ({"bending_stiffness": with_one(-100.0)}, coded("invalid_ski", table="bending_stiffness", value=-100.0)),
        ({"torsional_stiffness": with_one(0.0)}, coded("invalid_ski", table="torsional_stiffness", value=0.0)),
        ({"mass_per_length": with_one(-1.0)}, coded("invalid_ski", table="mass_per_length", value=-1.0)),
        ({"width": np.full(N, -0.06)}, coded("invalid_ski", table="width", value=-0.06)),
        ({"bending_stiffness": with_one(math.nan)}, coded("invalid_ski", table="bending_stiffness", row=600)),
        ({"base_height": with_one(math.inf)}, coded("invalid_ski", table="base_height", row=600, value=float("inf"))),
        (
            {"bending_stiffness": np.full(N - 1, 100.0)},
            coded("invalid_ski", table="bending_stiffness", shape="(800,)", needed="(801,)"),
        ),
        ({"station": STATION[::-1]}, coded("invalid_ski", row=1, station=-0.798)),
        ({"station": STATION * 2.0}, coded("invalid_ski", spacing=4.0000000000000036)),
        ({"station": STATION - 0.9}, coded("invalid_ski", name="running_length")),
        ({"running_length": 1.7}, coded("invalid_ski", name="running_length")),
        ({"sidecut_length": 1.7}, coded("invalid_ski", name="sidecut_length")),
        ({"running_length": -1.0}, coded("invalid_ski", name="running_length", length=-1.0)),
        ({"sidecut_length": math.nan}, coded("invalid_ski", name="sidecut_length")),
        ({"base_bevel": -0.01}, coded("invalid_ski", bevel=-0.01)),
        ({"edge_width": 0.04}, coded("invalid_ski", width=0.04)),
        ({"base_height": np.full(N, 0.001)}, coded("invalid_ski", height=0.001)),
        ({"width": 0.06 + 0.01 * STATION}, coded("invalid_ski", waist=60.0)),
        ({"width": 0.06 - 0.01 * STATION}, coded("invalid_ski", waist=60.0)),
    ],
)
def test_what_is_no_ski(changes: dict[str, Any], named: str | Coded) -> None:
    with raises(ParameterError, named):
        arc_table(**changes)


def two_rows(rows: int = 2) -> dict[str, Any]:
    tables = ("width", "bending_stiffness", "torsional_stiffness", "mass_per_length")
    values = {name: np.full(rows, 0.06) for name in tables}
    station = np.array([0.001, -0.001])[:rows]
    return {"name": "short", "source": "", "station": station, "base_height": np.zeros(rows), **values}


def test_two_rows_make_a_table_and_one_does_not() -> None:
    ski = Ski(**two_rows(), running_length=0.002, sidecut_length=0.002)
    assert ski.at(0.0).width == pytest.approx(0.06)
    with raises(ParameterError, "invalid_ski", table="station", shape="(1,)", needed="(1,)"):
        Ski(**two_rows(1), running_length=0.002, sidecut_length=0.002)


@pytest.mark.parametrize("radius", [8.0, 13.0, 100.0, 1000.0])
def test_points_of_a_circle_return_its_radius(radius: float) -> None:
    x = np.linspace(-0.7, 0.9, 301)  # not symmetric about the arc's lowest point
    y = radius - np.sqrt(radius**2 - (x - 0.1) ** 2)
    # a sagitta of 0.3 mm is known to 1e-16 m: 11 digits are left at the largest radius
    assert radius_of_least_squares_circle(x, y) == pytest.approx(radius, rel=1e-9)


def test_radius_does_not_change_when_the_edge_is_turned_moved_or_mirrored_and_a_straight_edge_has_no_radius() -> None:
    turn = np.linspace(-0.06, 0.05, 101)
    x, y = 13.0 * np.sin(turn), 13.0 * (1.0 - np.cos(turn))
    c, s = math.cos(0.3), math.sin(0.3)
    assert radius_of_least_squares_circle(c * x - s * y + 2.0, -(s * x + c * y) - 1.0) == pytest.approx(13.0, rel=1e-9)
    x = np.linspace(-0.7, 0.7, 101)
    assert radius_of_least_squares_circle(x, 0.03 + 0.01 * x) == math.inf


def test_least_squares_where_points_scatter() -> None:
    """Against the minimum of the summed squared distances, searched for directly."""
    from scipy.optimize import least_squares

    x = np.linspace(-0.7, 0.7, 201)
    y = x**2 / 26.0 + 1e-4 * np.sin(40.0 * x + 0.4)

    def distances(circle: FloatArray) -> FloatArray:
        return np.hypot(x - circle[0], y - circle[1]) - circle[2]

    direct = least_squares(distances, [0.0, 13.0, 13.0], xtol=1e-15, ftol=1e-15, gtol=1e-15)
    # scatter over radius is 1e-5, which is what the two definitions may differ by
    assert radius_of_least_squares_circle(x, y) == pytest.approx(direct.x[2], rel=1e-5)


TOML = "mass_kg = 2.2\nEI_N_m2 = [100, 440, 100]\nGJ_N_m2 = [60, 175, 60]\n"


def test_a_table_that_is_no_plain_file(tmp_path: Path) -> None:
    """/dev/zero has no end."""
    path = tmp_path / "ski.toml"
    path.write_text('table = "/dev/zero"\nrunning_length_mm = 1396\nsidecut_length_mm = 1458\n' + TOML)
    with raises(ParameterError, "cannot_read"):
        read_ski(path)


def test_the_longest_ski() -> None:
    assert layout_of_lengths(length=LONGEST, running_length=1.4, sidecut_length=1.46).running_length == 1.4
    with pytest.raises(ParameterError):
        layout_of_lengths(length=LONGEST + 0.01, running_length=1.4, sidecut_length=1.46)


LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
FRONT, REAR = LAYOUT.contact_points


def heights(shape: BaseShape, *stations: float) -> list[float]:
    return [float(h) for h in shape.height_at(np.array(stations), LAYOUT)]


def test_camber_shovel_and_tail_heights_and_heights_left_out_are_the_stated_defaults() -> None:
    shape = BaseShape(camber=0.007, shovel_height=0.060, tail_height=0.010)
    boot, front, rear, tip, tail = heights(shape, 0.0, FRONT, REAR, LAYOUT.tip, LAYOUT.tail)
    assert boot == 0.0
    assert (front, rear) == pytest.approx((-0.007, -0.007), abs=1e-15)
    assert (tip - front, tail - rear) == pytest.approx((0.060, 0.010), abs=1e-15)
    tip, tail = heights(BaseShape(), LAYOUT.tip, LAYOUT.tail)
    assert (tip, tail) == pytest.approx((0.050, 0.008), abs=1e-15)


def test_base_has_no_kink_also_with_rocker_and_rocker_draws_the_contact_points_in() -> None:
    shape = BaseShape(
        camber=0.005, tip_rocker_length=0.25, tip_rocker_height=0.008, tail_rocker_length=0.1, tail_rocker_height=0.002
    )
    station = np.linspace(LAYOUT.tip, LAYOUT.tail, 100001)
    slope = np.diff(shape.height_at(station, LAYOUT)) / np.diff(station)
    # the largest curvature is that of the shovel, below 10 per metre: in steps of 0.016 mm the slope changes by 2e-4
    assert np.max(np.abs(np.diff(slope))) < 2e-4
    shape = BaseShape(camber=0.004, tip_rocker_length=0.2, tip_rocker_height=0.010)
    lowest, end = heights(shape, FRONT - 0.2, FRONT)
    assert end - lowest == pytest.approx(0.010, abs=1e-15)
    middle = (FRONT - 0.2 + REAR) / 2.0
    assert heights(shape, middle)[0] - lowest == pytest.approx(0.004, abs=1e-15)


def test_boot_away_from_the_middle_is_still_at_zero() -> None:
    layout = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=-0.1)
    shape = BaseShape(camber=0.007)
    at_boot, at_middle = shape.height_at(np.array([0.0, layout.middle]), layout)
    assert at_boot == 0.0
    assert at_middle == pytest.approx(0.007 * 0.1**2 / (0.598 * 0.698), abs=1e-15)


@pytest.mark.parametrize(
    ("shape", "named"),
    [
        (BaseShape(tip_rocker_length=0.9, tail_rocker_length=0.6), coded("contradiction", running_length=1396.0)),
        (BaseShape(tip_rocker_length=0.9, tail_rocker_length=0.4959), coded("contradiction", running_length=1396.0)),
        (BaseShape(tip_rocker_height=0.01), coded("contradiction", name="shovel", rocker_height=10.0)),
        (BaseShape(tip_rocker_length=0.1, tip_rocker_height=0.03, shovel_height=0.05), "contradiction"),
    ],
)
def test_impossible_bases_are_rejected(shape: BaseShape, named: str | Coded) -> None:
    with raises(ParameterError, named):
        shape.height_at(np.zeros(1), LAYOUT)


def test_shovel_height_without_a_shovel_is_rejected() -> None:
    piece = layout_of_lengths(length=0.2, running_length=0.2, sidecut_length=0.2, tail_overhang=0.0)
    assert np.all(BaseShape().height_at(np.linspace(0.1, -0.1, 5), piece) == 0.0)
    with raises(ParameterError, "contradiction", name="shovel", given_height=50.0):
        BaseShape(shovel_height=0.05).height_at(np.zeros(1), piece)


@pytest.mark.parametrize("rounding", [0.05, 0.2])
def test_the_arch_levels_out_over_the_rounding(rounding: float) -> None:
    """Of one curvature as far as the rounding leaves it; there it has this slope, which falls evenly to 0."""
    shape = BaseShape(camber=0.016, camber_rounding=rounding)
    plain, half = 0.698 - rounding, 0.698
    curvature = 2.0 * 0.016 / (plain * half)
    at_middle, at_start, between, at_end = heights(shape, 0.0, plain, plain + rounding / 2.0, half)
    assert at_start - at_middle == pytest.approx(-curvature * plain**2 / 2.0, abs=1e-15)
    assert at_end == pytest.approx(-0.016, abs=1e-15)
    # of the drop over the rounding three quarters are in its first half
    assert (between - at_start) / (at_end - at_start) == pytest.approx(0.75, rel=1e-12)


def test_the_rounding_takes_at_most_a_quarter_of_the_length_in_contact() -> None:
    long, longest = (BaseShape(camber=0.016, camber_rounding=each) for each in (0.5, 0.349))
    assert heights(long, 0.3, 0.5) == heights(longest, 0.3, 0.5)
