from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import PchipInterpolator
from tests.coded import Coded, coded, raises, warns
from tests.key_names import WRONG_CELL_COUNT

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.ski import read_ski
from skisnow.ski.table_file import StationTable, evenly_spread

Written = Callable[..., Path]


# a ski 1.6 m long of five rows, its mass by the trapezoid (0.8·(1+2)/2·2) = 2.4 kg
ROWS = """station_m,width_mm,base_height_mm,EI_N_m2,GJ_N_m2,mass_per_length_kg_per_m
0.8,110,45,100,60,1
0.4,80,1,250,140,1.5
0,68,5,440,175,2
-0.4,78,1,260,140,1.5
-0.8,100,10,100,60,1
"""
WIDTHS = ("tip_width_mm", "waist_width_mm", "tail_width_mm")
REPLACED = ("length_mm", *WIDTHS, "mass_kg", "camber_mm", "EI_N_m2", "GJ_N_m2")


@pytest.fixture
def with_table(ski_file: Written) -> Callable[..., Path]:
    def written(text: str = ROWS, **changes: object) -> Path:
        path = ski_file(**{**dict.fromkeys(REPLACED), "table": "rows.csv", **changes})
        (path.parent / "rows.csv").write_text(text, encoding="utf-8")
        return path

    return written


def test_the_rows_are_in_the_ski_and_a_dense_table_keeps_its_own_stations(with_table: Written) -> None:
    ski = read_ski(with_table())
    at = ski.at([0.8, 0.4, 0.0, -0.4, -0.8])
    assert at.width * 1e3 == pytest.approx([110, 80, 68, 78, 100], abs=1e-9)
    assert at.base_height * 1e3 == pytest.approx([40, -4, 0, -4, 5], abs=1e-9)  # taken from the boot, where 5 stands
    assert at.bending_stiffness == pytest.approx([100, 250, 440, 260, 100], abs=1e-9)
    assert at.torsional_stiffness == pytest.approx([60, 140, 175, 140, 60], abs=1e-9)
    assert ski.mass == pytest.approx(2.4, rel=0.02)  # the cubic between the rows is no trapezoid
    assert ski.length == pytest.approx(1.6)
    assert np.max(-np.diff(ski.station)) <= 2.5e-3 + 1e-12
    stations = np.linspace(0.8, -0.8, 801)
    rows = [f"{s:.6f},{68 + 60 * s**2:.6f},0,300,100,1.5" for s in stations]
    ski = read_ski(with_table("\n".join([ROWS.splitlines()[0], *rows])))
    assert ski.station == pytest.approx(stations, abs=1e-9)
    # 60 mm/m² of width: an edge of curvature 0.06 per metre, radius 1/0.06
    assert ski.sidecut_radius_of_edge_line == pytest.approx(1 / 0.06, rel=5e-3)


def test_a_table_of_one_column_leaves_the_rest_to_the_keys(with_table: Written) -> None:
    keys: dict[str, object] = {"tip_width_mm": 116, "waist_width_mm": 68, "tail_width_mm": 101, "mass_kg": 2.0}
    stiffness: dict[str, object] = {"GJ_N_m2": [100], "camber_mm": 6, "length_mm": 1600}
    ski = read_ski(with_table("station_m,EI_N_m2\n0.8,100\n0.0,400\n-0.8,100\n", **keys, **stiffness))
    assert ski.waist_width == pytest.approx(0.068)
    assert ski.mass == pytest.approx(2.0, rel=1e-12)
    assert float(ski.at(ski.contact_points[0]).base_height) == pytest.approx(-0.006, abs=1e-12)
    assert float(ski.at(0.0).bending_stiffness) == pytest.approx(400.0)


SEMICOLONS = ROWS.replace(",", ";").replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        ROWS.partition("\n")[0].upper() + "\n" + ROWS.partition("\n")[2],
        "\ufeff# measured on a table\n" + ROWS.replace(",", "\t") + "\n",
        "\ufeff" + SEMICOLONS,
        "sep=;\n" + SEMICOLONS,
    ],
)
def test_tables_of_any_program_are_read(with_table: Written, text: str) -> None:
    at, again = (read_ski(with_table(each)).at([0.5, -0.5]) for each in (ROWS, text))
    assert np.array_equal(at.width, again.width)
    assert np.array_equal(at.bending_stiffness, again.bending_stiffness)


def test_a_point_among_decimal_commas_could_be_a_thousand(with_table: Written) -> None:
    text = ROWS.replace(",", ";").replace(".", ",").replace(";440;", ";1.440;")
    with raises(ParameterError, "wrong_kind", name="line 4, EI_N_m2", value="'1.440'"):
        read_ski(with_table(text))


def beside(column: str, key: str, value: str) -> Coded:
    """A key that gives what the table has."""
    return coded("contradiction", column=column, key=key, value=value, other=f"the column {column}")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"length_mm": 1700}, coded("contradiction", reach=1600.0, length=1700.0)),
        ({"length_mm": 1500}, coded("contradiction", length=1500.0)),
        (
            {"sidecut_length_mm": 1650},
            coded("contradiction", name="sidecut_length", length=1650.0000000000002, tip=800.0, tail=-800.0),
        ),
        ({"boot_position_mm": 150}, coded("contradiction", tip=800.0, tail=-800.0)),
        ({"waist_width_mm": 68}, beside("width_mm", "waist_width_mm", "68")),
        ({"camber_mm": 7}, beside("base_height_mm", "camber_mm", "7")),
        ({"camber_rounding_mm": 80}, beside("base_height_mm", "camber_rounding_mm", "80")),
        ({"tip_end_width_mm": 30}, beside("width_mm", "tip_end_width_mm", "30")),
        ({"EI_N_m2": [100]}, beside("EI_N_m2", "EI_N_m2", "[100]")),
        ({"stiffness_station_mm": [100]}, coded("contradiction", key="stiffness_station_mm", value="[100]")),
        ({"tail_overhang_mm": 20}, coded("contradiction", key="tail_overhang_mm", value="20")),
        ({"mass_kg": 3.0}, coded("out_of_range", value="3.0")),
        ({"rigid": True}, coded("contradiction", key="EI_N_m2")),
    ],
)
def test_keys_that_contradict_the_table(with_table: Written, changes: dict[str, object], named: str | Coded) -> None:
    with raises(ParameterError, named):
        read_ski(with_table(**changes))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (ROWS.replace("width_mm", "widht_mm"), coded("unknown_name", similar="width_mm", line=1, name="widht_mm")),
        (ROWS.replace("GJ_N_m2", "EI_N_m2"), coded("repeated", name="EI_N_m2")),
        (ROWS.replace("station_m", "width_mm", 1).replace("width_mm,width_mm", "width_mm"), "missing"),
        (ROWS.replace("440", "4 40"), coded("wrong_kind", name="line 4, EI_N_m2", value="'4 40'")),
        (ROWS.replace("440", "nan"), "out_of_range"),
        (ROWS.replace("440", "-440"), "out_of_range"),
        (
            ROWS.replace("-0.4,", "0.4,"),
            coded("out_of_range", line=5, value="0.4", before=0.0),
        ),
        (ROWS.replace("440,", ""), coded(WRONG_CELL_COUNT, line=4, n_cells=5, n_header=6)),
        (
            ROWS.replace("0.8,", "800,"),
            coded(
                "out_of_range", unit="mm", value=0.8, problem="line 2, station_m is 800.0; allowed is from −3 to 3 m"
            ),
        ),
        (ROWS.replace(",68,", ",120,"), coded("invalid_ski", waist=120.0)),
        ("station_m,width_mm\n0.8,100\n", "missing"),
        ("", "missing"),
    ],
)
def test_bad_tables_name_line_column_value_and_remedy(with_table: Written, text: str, named: str | Coded) -> None:
    path = with_table(text)
    with raises(ParameterError, named) as raised:
        read_ski(path)
    assert str(raised.value).startswith(str(path.parent))


def test_a_column_beyond_the_usual_is_warned_of_once(with_table: Written) -> None:
    text = ROWS.replace("440", "44000").replace("260", "26000")
    with warns(RangeWarning, "unusual", place="line 4, EI_N_m2", value=44000.0, count=1) as warned:
        read_ski(with_table(text))
    assert len(warned) == 1


def test_a_missing_table(ski_file: Written) -> None:
    with raises(ParameterError, "cannot_read"):
        read_ski(ski_file(table="gone.csv"))


@given(arrays(float, st.integers(1, 9), elements=st.floats(0.01, 1e4)), st.floats(-1.5, 1.5))
def test_values_stay_between_their_neighbours(values: np.ndarray, place: float) -> None:
    table = evenly_spread(values, 1.0, -1.0)
    value = float(table.at(np.array([place]))[0])
    if values.size == 1:
        low, high = values[0], values[0]
    else:
        before = int(np.clip((1.0 - place) / 2.0 * (values.size - 1), 0, values.size - 2))
        low, high = sorted(values[before : before + 2])
        if place >= 1.0:
            low = high = values[0]
        if place <= -1.0:
            low = high = values[-1]
    # the rounding of the cubic, and of the division that finds the neighbours
    assert low * (1 - 1e-9) - 1e-9 <= value <= high * (1 + 1e-9) + 1e-9


@given(
    st.lists(st.tuples(st.integers(1, 9), st.integers(-5, 5)), min_size=2, max_size=8),
    arrays(float, 5, elements=st.floats(0.0, 1.0)),
)
def test_cubics_are_those_of_scipy(points: list[tuple[int, int]], places: np.ndarray) -> None:
    """Steps of one to nine apart, values that rise, fall and stay."""
    x = np.cumsum([step for step, _ in points]) / 10.0
    y = np.array([value for _, value in points], float)
    at = x[0] + places * (x[-1] - x[0])
    assert StationTable(x[::-1], y[::-1]).at(at) == pytest.approx(PchipInterpolator(x, y)(at), rel=1e-12, abs=1e-13)


def test_a_straight_line_is_kept() -> None:
    table = StationTable(np.array([0.7, 0.1, -0.3, -0.7]), np.array([0.7, 0.1, -0.3, -0.7]) * 100 + 200)
    at = np.linspace(0.7, -0.7, 29)
    assert table.at(at) == pytest.approx(at * 100 + 200, rel=1e-12)


def test_tip_is_listed_first() -> None:
    table = evenly_spread([1.0, 2.0, 4.0], 0.6, -0.6)
    assert table.at(np.array([0.6, 0.0, -0.6])) == pytest.approx([1.0, 2.0, 4.0])


def test_bad_tables() -> None:
    with raises(ParameterError, "wrong_shape", size=3, size_2=2):
        StationTable(np.array([0.5, 0.0]), np.ones(3))
    with raises(ParameterError, "not_falling"):
        StationTable(np.array([0.0, 0.5]), np.ones(2))
    for nothing in (np.zeros(0), np.zeros((1, 2))):
        with raises(ParameterError, "wrong_shape", size=nothing.size, size_2=nothing.size):
            StationTable(nothing, nothing)
