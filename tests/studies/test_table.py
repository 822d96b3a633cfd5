"""A study's table that a spreadsheet program saved again."""

from __future__ import annotations

from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow.carving.keys import CARVE_KEYS
from skisnow.studies import read_table
from tests.coded import raises

PLAIN = """\
edge_angle_deg,at_rest,outcome,radius_m,tags,study
30.5,false,carves,12.25,"[1.0, 2.5]",a
45,true,sinks,,,b
"""
EXCEL = """\
edge_angle_deg;at_rest;outcome;radius_m;tags;study
30,5;FALSCH;carves;12,25;[1.0, 2.5];a
45;WAHR;sinks;;;b
""".replace("FALSCH", "FALSE").replace("WAHR", "TRUE")


@pytest.mark.parametrize(
    "data",
    [
        EXCEL.encode("utf-8-sig"),
        EXCEL.encode("cp1252"),
        f"sep=;\n{EXCEL}".encode(),
        EXCEL.replace(";", "\t").encode("utf-16"),
    ],
)
def test_decimal_commas_are_read_as_points(tmp_path: Path, data: bytes) -> None:
    plain, saved = tmp_path / "plain.csv", tmp_path / "saved.csv"
    plain.write_text(PLAIN, encoding="utf-8")
    saved.write_bytes(data)
    ours, theirs = (read_table(path, CARVE_KEYS) for path in (saved, plain))
    assert ours.rows == theirs.rows
    first = {"edge_angle_deg": 30.5, "at_rest": False, "outcome": "carves", "radius_m": 12.25}
    assert ours.rows[0] == {**first, "tags": [1.0, 2.5], "study": "a"}


def test_a_cell_that_is_no_number_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "saved.csv"
    path.write_text(f"sep=;\n{EXCEL.replace('12,25', 'zwölf')}", encoding="utf-8")
    with raises(ParameterError, "wrong_kind", name="radius_m", text="zwölf"):
        read_table(path, CARVE_KEYS)
