import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.carving.equilibrium import carve
from skisnow.ski import BaseShape, Ski, arc_ski, layout_of_lengths, read_ski
from skisnow.ski.assembling import ArcOutline, width_of_table
from skisnow.ski.table_file import StationTable
from skisnow.snow import SnowProperties


def slalom(*, boot_position: float = 0.0, base: BaseShape | None = None, stations: list[float] | None = None) -> Ski:
    return arc_ski(
        layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=boot_position),
        name="slalom", source="test", tip_width=0.116, waist_width=0.068, tail_width=0.101, mass=2.231,
        bending_stiffness=[100, 250, 440, 260, 100], torsional_stiffness=[60, 140, 175, 140, 60],
        stiffness_station=stations, base=base,
    )  # fmt: skip


def test_stiffness_is_spread_over_the_running_length_tip_first() -> None:
    ski = slalom()
    at = ski.at([0.698, 0.349, 0.0, -0.349, -0.698])
    # the quarter points are no stations of the grid: linear interpolation over 2.5 mm of a curve of 2 kN
    assert at.bending_stiffness == pytest.approx([100, 250, 440, 260, 100], abs=0.01)
    assert at.torsional_stiffness == pytest.approx([60, 140, 175, 140, 60], abs=0.01)


def test_end_stiffness_is_held_out_to_tip_and_tail() -> None:
    ski = slalom()
    assert ski.bending_stiffness[ski.station > 0.698] == pytest.approx(100.0, rel=1e-12)
    assert ski.torsional_stiffness[ski.station < -0.698] == pytest.approx(60.0, rel=1e-12)


def test_stiffness_at_stations_of_its_own() -> None:
    ski = slalom(stations=[0.6, 0.3, 0.1, -0.3, -0.5])
    assert ski.at([0.7, 0.3, 0.1]).bending_stiffness == pytest.approx([100, 250, 440], abs=0.01)


def test_mass_goes_with_the_width() -> None:
    ski = slalom()
    assert ski.mass == pytest.approx(2.231, rel=1e-12)
    assert np.ptp(ski.mass_per_length / ski.width) < 1e-12


def test_stations_are_dense_and_meet_every_point_that_matters() -> None:
    ski = slalom(boot_position=0.0213)
    steps = -np.diff(ski.station)
    assert steps.max() <= 2.5e-3 + 1e-12
    for place in (ski.station[0], *ski.sidecut_ends, *ski.contact_points, ski.sidecut_middle, 0.0):
        assert np.min(np.abs(ski.station - place)) < 1e-9


def test_boot_position_is_the_only_thing_that_moves() -> None:
    ahead, middle = slalom(boot_position=0.05), slalom()
    assert ahead.sidecut_middle == -0.05
    assert ahead.sidecut_widths == pytest.approx(middle.sidecut_widths, abs=1e-12)
    assert ahead.at(-0.05 + 0.3).width == pytest.approx(float(middle.at(0.3).width), abs=1e-7)
    assert ahead.at(-0.05 + 0.3).bending_stiffness == pytest.approx(float(middle.at(0.3).bending_stiffness), abs=0.01)


def test_camber_of_the_ski() -> None:
    ski = slalom(boot_position=-0.03, base=BaseShape(camber=0.007))
    heights = ski.at([ski.sidecut_middle, *ski.contact_points]).base_height
    assert heights[0] - heights[1:] == pytest.approx([0.007, 0.007], abs=1e-12)
    assert float(ski.at(0.0).base_height) == 0.0


def test_parts_that_do_not_fit() -> None:
    with raises(ParameterError, "wrong_shape", size=5, size_2=4):
        slalom(stations=[0.6, 0.3, 0.1, -0.3])


@settings(max_examples=40, deadline=None)
@given(
    waist=st.floats(0.05, 0.12),
    tip=st.floats(0.0, 0.06),
    tail=st.floats(0.0, 0.06),
    sidecut=st.floats(0.8, 1.7),
    running=st.floats(0.6, 0.97),
    boot=st.floats(-0.15, 0.15),
    stiffness=st.lists(st.floats(10.0, 2000.0), min_size=1, max_size=8),
)
def test_any_sensible_ski_is_a_ski(
    waist: float, tip: float, tail: float, sidecut: float, running: float, boot: float, stiffness: list[float]
) -> None:
    ski = arc_ski(
        layout_of_lengths(
            length=sidecut + 0.14, running_length=running * sidecut, sidecut_length=sidecut, boot_position=boot
        ),
        name="any",
        source="test",
        tip_width=waist + tip,
        waist_width=waist,
        tail_width=waist + tail,
        mass=2.0,
        bending_stiffness=stiffness,
        torsional_stiffness=stiffness,
        base=BaseShape(camber=0.005),
    )
    assert ski.sidecut_depth == pytest.approx((tip + tail) / 4.0, abs=1e-12)
    assert ski.mass == pytest.approx(2.0, rel=1e-12)
    assert (ski.tip_width, ski.tail_width) == pytest.approx((waist + tip, waist + tail), abs=1e-12)
    low, high = min(stiffness), max(stiffness)
    assert low * (1 - 1e-9) <= ski.bending_stiffness.min() <= ski.bending_stiffness.max() <= high * (1 + 1e-9)
    if tip + tail > 0.004:
        three, circle = ski.sidecut_radius_of_three_widths, ski.sidecut_radius_of_edge_line
        # parabola and circle part by the square of the edge's steepest slope, (4 δ + taper/2)/L
        slope = (tip + tail + abs(tip - tail) / 2.0) / sidecut
        assert math.isclose(three, circle, rel_tol=1.5 * slope**2 + 1e-4)


def test_boot_position_moves_everything_backwards() -> None:
    """A boot 30 mm in front of the middle sees the middle 30 mm behind itself."""
    layout = layout_of_lengths(
        length=1.6, running_length=1.4, sidecut_length=1.46, tail_overhang=0.02, boot_position=0.03
    )
    assert layout.middle == -0.03
    assert layout.tail == pytest.approx(-0.03 - 0.73 - 0.02)
    assert layout.tip == pytest.approx(-0.03 + 0.73 + 0.12)
    assert layout.contact_points == pytest.approx((0.67, -0.73))


@pytest.mark.parametrize(
    ("lengths", "named"),
    [
        ({"running_length": 1.7}, coded("contradiction", name="running_length", length=1700.0)),
        ({"sidecut_length": 1.59}, coded("contradiction", name="sidecut_length", length=1590.0)),
        ({"running_length": 0.0}, coded("out_of_range", name="running_length", length=0.0)),
        ({"sidecut_length": float("nan")}, coded("out_of_range", name="sidecut_length")),
    ],
)
def test_lengths_that_do_not_fit(lengths: dict[str, float], named: str | Coded) -> None:
    with raises(ParameterError, named):
        layout_of_lengths(**{"length": 1.6, "running_length": 1.4, "sidecut_length": 1.46, **lengths})


LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=0.03)
SLALOM = ArcOutline(layout=LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101)


def test_the_three_widths_are_where_they_belong() -> None:
    at = np.array([1.458 / 2 - 0.03, -0.03, -1.458 / 2 - 0.03])
    assert SLALOM.width_at(at) == pytest.approx([0.116, 0.068, 0.101], abs=1e-15)


def test_narrowest_place_is_behind_the_middle() -> None:
    """Vertex of the parabola by hand: s = -(15·1458)/(4·81) = -67.5 mm, 15²/(8·81) = 0.347 mm narrower."""
    station = np.linspace(-0.3, 0.3, 60001)
    width = SLALOM.width_at(station)
    assert station[np.argmin(width)] - LAYOUT.middle == pytest.approx(-0.0675, abs=2e-5)
    assert 0.068 - width.min() == pytest.approx(0.347e-3, abs=1e-6)


def test_curvature_of_the_side_line_is_constant() -> None:
    step = 1e-3
    station = LAYOUT.middle + np.linspace(-0.7, 0.7, 1401)
    second = np.diff(SLALOM.width_at(station) / 2.0, 2) / step**2
    assert second == pytest.approx(8.0 * 0.02025 / 1.458**2, rel=1e-6)  # 8 δ / L²


def test_tip_closes_as_an_ellipse_to_a_fifth_and_the_tail_is_straight() -> None:
    front, rear = LAYOUT.widest_points
    assert SLALOM.width_at(np.array([LAYOUT.tip]))[0] == pytest.approx(0.2 * 0.116, rel=1e-12)
    # half way: sqrt(1 - 0.96/4)
    assert SLALOM.width_at(np.array([(front + LAYOUT.tip) / 2.0]))[0] == pytest.approx(0.116 * 0.76**0.5, rel=1e-12)
    assert SLALOM.width_at(np.array([rear - 0.01, LAYOUT.tail])) == pytest.approx([0.101, 0.101], rel=1e-12)


def test_straight_piece_without_tip() -> None:
    piece = layout_of_lengths(length=0.2, running_length=0.2, sidecut_length=0.2, tail_overhang=0.0)
    outline = ArcOutline(layout=piece, tip_width=0.062, waist_width=0.062, tail_width=0.062)
    assert np.all(outline.width_at(np.linspace(0.1, -0.1, 9)) == 0.062)


def test_the_tip_ends_as_wide_as_said() -> None:
    outline = ArcOutline(layout=LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101, end_width=0.058)
    front = LAYOUT.widest_points[0]
    middle, end = outline.width_at(np.array([(front + LAYOUT.tip) / 2.0, LAYOUT.tip]))
    assert end == pytest.approx(0.058, rel=1e-12)
    assert middle == pytest.approx(0.116 * (1.0 - 0.75 / 4.0) ** 0.5, rel=1e-12)


PAGE = Path(__file__).parents[2] / "docs" / "files" / "ski.md"
SIDE_LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
FRONT, REAR = SIDE_LAYOUT.widest_points
EXAMPLE = "station_m,width_mm,EI_N_m2\n0.845,25,100\n0.729,116,100\n0,68,440\n-0.729,101,100\n-0.749,101,100\n"
WIDTHS = dict.fromkeys(("tip_width_mm", "waist_width_mm", "tail_width_mm"))


def table(station: list[float], width_mm: list[float]) -> StationTable:
    return StationTable(np.array(station), np.array(width_mm) * 1e-3)


def test_three_rows_are_the_side_line_of_three_widths() -> None:
    coarse = table([FRONT + 0.115, FRONT, 0.0, REAR, SIDE_LAYOUT.tail], [25, 116, 68, 101, 101])
    arc = ArcOutline(layout=SIDE_LAYOUT, tip_width=0.116, waist_width=0.068, tail_width=0.101)
    at = np.linspace(FRONT, REAR, 301)
    assert width_of_table(coarse, SIDE_LAYOUT)(at) == pytest.approx(arc.width_at(at), abs=1e-12)


@pytest.mark.parametrize("rows", [3, 4, 5, 9, 30])
def test_a_parabola_is_kept_whatever_the_rows(rows: int) -> None:
    """Not evenly spaced, the ends of the sidecut not among them."""

    def width(s: np.ndarray) -> np.ndarray:
        return 0.07 + 0.004 * s + 0.066 * s**2

    station = np.sort(0.6 * np.sin(np.linspace(-1.5, 1.5, rows) + 0.05))[::-1]
    at = np.linspace(FRONT, REAR, 77)
    assert width_of_table(StationTable(station, width(station)), SIDE_LAYOUT)(at) == pytest.approx(width(at), abs=1e-12)


def test_rows_stand_as_they_are_and_nothing_swings_beyond_them() -> None:
    """A straight middle between two arcs: between its rows it narrows by no more than a parabola does."""
    station, widths = [0.84, 0.729, 0.4, 0.2, -0.2, -0.4, -0.729], [30.0, 110, 80, 68, 68, 80, 110]
    found = width_of_table(table(station, widths), SIDE_LAYOUT)
    assert found(np.array(station)) * 1e3 == pytest.approx(widths, abs=1e-9)
    middle = found(np.linspace(0.2, -0.2, 41)) * 1e3
    parabola = np.polyfit(station[1:], widths[1:], 2)[0]  # mm/m²
    assert middle.max() <= 68.0 + 1e-9
    assert middle.min() == pytest.approx(68.0 - parabola * 0.2**2, abs=1e-9)
    assert np.all(np.diff(found(np.linspace(0.729, 0.84, 50))) < 0.0)


@pytest.mark.parametrize(
    ("station", "told"),
    [
        ([0.845, 0.729, -0.729], "2 rows"),
        ([0.845, 0.8, -0.749], "0 rows"),
        ([0.84, 0.3, 0.2, 0.1, 0.0, -0.2, -0.74], "500 mm apart"),
    ],
)
def test_too_few_rows_in_the_sidecut_are_rejected(station: list[float], told: str) -> None:
    with pytest.raises(ParameterError, match=f"width_mm has .*{told}.*3 rows"):
        width_of_table(table(station, [80.0] * len(station)), SIDE_LAYOUT)


def test_the_example_of_the_page_carves_as_its_three_widths(ski_file: Callable[..., Path]) -> None:
    """The same ski from a table of five rows and from three widths; only the tip beyond the sidecut is another."""
    by_keys: dict[str, object] = {"EI_N_m2": None, "table": "rows.csv", "tail_overhang_mm": None, "length_mm": None}
    path = ski_file(**WIDTHS, **by_keys)
    (path.parent / "rows.csv").write_text(EXAMPLE, encoding="utf-8")
    by_table = read_ski(path)
    path = ski_file(**by_keys)
    stiffness = "\n".join(",".join(line.split(",")[::2]) for line in EXAMPLE.splitlines())
    (path.parent / "rows.csv").write_text(stiffness, encoding="utf-8")
    by_widths = read_ski(path)
    hard = SnowProperties(0.2e9, 0.35e6, source="x")
    found = [
        carve(ski, hard, edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
        for ski in (by_table, by_widths)
    ]
    page = PAGE.read_text(encoding="utf-8")
    assert "\n".join(f"    {line}" for line in EXAMPLE.splitlines()) in page
    assert f"a boot radius of {found[0].turn_radius_boot:.2f} m" in page
    assert found[0].turn_radius_boot == pytest.approx(found[1].turn_radius_boot, rel=1e-4)
    assert by_table.sidecut_radius_of_edge_line == pytest.approx(by_widths.sidecut_radius_of_edge_line, rel=1e-9)


def test_what_a_ski_is_says_its_side_line() -> None:
    ski = read_ski("slalom")
    told = re.fullmatch(
        r"<Ski 'slalom': 1\.593 m, 116-68-101 mm, radius of the side line ([0-9.]+) m, 2\.231 kg>", repr(ski)
    )
    assert told is not None
    three_widths = 1.458**2 / (2.0 * (0.116 + 0.101 - 2.0 * 0.068))  # L²/8δ, δ a quarter of tip + tail - 2 waist
    assert float(told[1]) == pytest.approx(three_widths, rel=2e-3)
