from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.ski import read_ski

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Written = Callable[..., Path]

# a ski 1.6 m long of five rows, its mass by the trapezoid (0.8·(1+2)/2·2) = 2.4 kg
ROWS = """station_m,width_mm,base_height_mm,EI_N_m2,GJ_N_m2,mass_per_length_kg_per_m
0.8,110,45,100,60,1
0.4,80,1,250,140,1.5
0,68,5,440,175,2
-0.4,78,1,260,140,1.5
-0.8,100,10,100,60,1
"""
REPLACED = (
    "length_mm",
    "tip_width_mm",
    "waist_width_mm",
    "tail_width_mm",
    "mass_kg",
    "camber_mm",
    "EI_N_m2",
    "GJ_N_m2",
)


@pytest.fixture
def with_table(ski_file: Written) -> Callable[..., Path]:
    def written(text: str = ROWS, **changes: object) -> Path:
        path = ski_file(**{**dict.fromkeys(REPLACED), "table": "rows.csv", **changes})
        (path.parent / "rows.csv").write_text(text, encoding="utf-8")
        return path

    return written


def test_the_rows_stand_in_the_ski(with_table: Written) -> None:
    ski = read_ski(with_table())
    at = ski.at([0.8, 0.4, 0.0, -0.4, -0.8])
    assert at.width * 1e3 == pytest.approx([110, 80, 68, 78, 100], abs=1e-9)
    assert at.base_height * 1e3 == pytest.approx([40, -4, 0, -4, 5], abs=1e-9)  # taken from the boot, where 5 stands
    assert at.bending_stiffness == pytest.approx([100, 250, 440, 260, 100], abs=1e-9)
    assert at.torsional_stiffness == pytest.approx([60, 140, 175, 140, 60], abs=1e-9)
    assert ski.mass == pytest.approx(2.4, rel=0.02)  # the cubic between the rows is no trapezoid
    assert ski.length == pytest.approx(1.6)
    assert np.max(-np.diff(ski.station)) <= 2.5e-3 + 1e-12


def test_a_dense_table_keeps_its_own_stations(with_table: Written) -> None:
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


def test_the_case_of_headings_does_not_matter(with_table: Written) -> None:
    head, rows = ROWS.split("\n", 1)
    at, again = (read_ski(with_table(text)).at([0.5, -0.5]) for text in (ROWS, f"{head.upper()}\n{rows}"))
    assert np.array_equal(at.width, again.width)
    assert np.array_equal(at.bending_stiffness, again.bending_stiffness)


@pytest.mark.parametrize("separator", [";", "\t"])
def test_other_separators_remarks_and_byte_order_mark(with_table: Written, separator: str) -> None:
    text = "\ufeff# measured on a table\n" + ROWS.replace(",", separator) + "\n"
    assert read_ski(with_table(text)).waist_width == pytest.approx(0.068)


@pytest.mark.parametrize("first", ["", "sep=;\n"])
def test_decimal_commas_as_a_spreadsheet_program_writes_them(with_table: Written, first: str) -> None:
    path = with_table()
    text = first + ROWS.replace(",", ";").replace(".", ",").replace(";68;", ";68,25;")
    (path.parent / "rows.csv").write_bytes(text.encode("utf-8-sig"))
    ski = read_ski(path)
    assert ski.waist_width == pytest.approx(0.06825)
    assert ski.length == pytest.approx(1.6)


def test_a_point_among_decimal_commas_could_be_a_thousand(with_table: Written) -> None:
    text = ROWS.replace(",", ";").replace(".", ",").replace(";440;", ";1.440;")
    with pytest.raises(ParameterError, match=r"line 4, EI_N_m2 is '1\.440'; it must be a number"):
        read_ski(with_table(text))


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        (
            {"length_mm": 1700},
            r"mine\.toml: its table reaches over 1600\.0 mm and is shorter than the ski, length_mm 1700",
        ),
        ({"length_mm": 1500}, r"is longer than the ski, length_mm 1500"),
        ({"sidecut_length_mm": 1650}, r"sidecut_length of 1650\.0 mm reaches .* ski only from 800\.0 to -800\.0"),
        ({"boot_position_mm": 150}, r"but the ski only from 800\.0 to -800\.0"),
        ({"waist_width_mm": 68}, "waist_width_mm = 68 cannot stand beside the column width_mm"),
        ({"camber_mm": 7}, "camber_mm = 7 cannot stand beside the column base_height_mm"),
        ({"camber_rounding_mm": 80}, "camber_rounding_mm = 80 cannot stand beside the column base_height_mm"),
        ({"tip_end_width_mm": 30}, "tip_end_width_mm = 30 cannot stand beside the column width_mm"),
        ({"EI_N_m2": [100]}, r"EI_N_m2 = \[100\] cannot stand beside the column EI_N_m2"),
        ({"stiffness_station_mm": [100]}, r"stiffness_station_mm = \[100\] cannot stand beside a table with both"),
        ({"tail_overhang_mm": 20}, "tail_overhang_mm = 20 cannot stand beside a table"),
        ({"mass_kg": 3.0}, r"mass_kg is 3\.0; allowed is 2\.\d+, which the column"),
        ({"rigid": True}, "the column EI_N_m2 cannot stand beside rigid"),
        ({"shape": "ski-def.json"}, "table = 'rows.csv' cannot stand beside shape"),
    ],
)
def test_keys_that_contradict_the_table(with_table: Written, changes: dict[str, object], named: str) -> None:
    with pytest.raises(ParameterError, match=named):
        read_ski(with_table(**changes))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (
            ROWS.replace("width_mm", "widht_mm"),
            r"rows\.csv, line 1: the column 'widht_mm' is not known\. Did you mean width_mm",
        ),
        (ROWS.replace("GJ_N_m2", "EI_N_m2"), "column EI_N_m2 stands there twice"),
        (
            ROWS.replace("station_m", "width_mm", 1).replace("width_mm,width_mm", "width_mm"),
            "needed are the column station_m",
        ),
        (ROWS.replace("440", "4 40"), r"line 4, EI_N_m2 is '4 40'; it must be a number"),
        (ROWS.replace("440", "nan"), "line 4, EI_N_m2 is nan; allowed is from 0.001 to"),
        (ROWS.replace("440", "-440"), r"line 4, EI_N_m2 is -440\.0; allowed is from 0\.001"),
        (ROWS.replace("-0.4,", "0.4,"), r"line 5, station_m is 0\.4; allowed is less than the 0 before it"),
        (ROWS.replace("440,", ""), "line 4: 5 cells stand under 6 columns"),
        (
            ROWS.replace("0.8,", "800,"),
            r"line 2, station_m is 800\.0; allowed is from -3 to 3 m\. .*mm\? .*0\.8",
        ),
        (ROWS.replace(",68,", ",120,"), "waist, 120.00 mm, is wider than its tip"),
        ("station_m,width_mm\n0.8,100\n", "a line of column names and two rows or more"),
        ("", "a line of column names and two rows or more"),
    ],
)
def test_bad_tables_name_line_column_value_and_remedy(with_table: Written, text: str, named: str) -> None:
    path = with_table(text)
    with pytest.raises(ParameterError, match=named) as raised:
        read_ski(path)
    assert str(raised.value).startswith(str(path.parent))


def test_a_column_beyond_the_usual_is_warned_of_once(with_table: Written) -> None:
    text = ROWS.replace("440", "44000").replace("260", "26000")
    with pytest.warns(RangeWarning, match=r"rows\.csv: line 4, EI_N_m2 is 44000 \(and 1 more\)") as warned:
        read_ski(with_table(text))
    assert len(warned) == 1


def test_a_missing_table(ski_file: Written) -> None:
    with pytest.raises(ParameterError, match=r"gone\.csv cannot be read"):
        read_ski(ski_file(table="gone.csv"))
