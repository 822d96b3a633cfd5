"""Tables of users: cells by column, decimal commas, and each refusal with file, row and column."""

import math
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message
from skisnow._support.spreadsheet_text import CsvRow, csv_rows
from tests.coded import Coded, coded, raises

ACTION = Message("Mend it.")


def rows_of(folder: Path, text: str, further: tuple[str, ...] = ("z",)) -> list[CsvRow]:
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return list(csv_rows(path, ("x", "y"), further=further, action=ACTION))


def test_cells_stand_by_column_without_blanks_and_with_their_row(tmp_path: Path) -> None:
    """Columns in any order, one that may be, one that is not read; blank rows count, a short one ends blank."""
    found = rows_of(tmp_path, " y ,z,note,x\n 2 ,3,n, 1\n\n , ,,\n5\n")
    assert [(each.row, each.cells) for each in found] == [
        (2, {"x": "1", "y": "2", "z": "3"}),
        (5, {"x": "", "y": "5", "z": ""}),
    ]
    assert (found[0].number("x"), found[0].number("y"), found[0].number("z")) == (1.0, 2.0, 3.0)
    assert found[0].path == tmp_path / "table.csv"


@pytest.mark.parametrize(
    ("text", "x", "mark"),
    [("x;y\n1,5;2\n", 1.5, ","), ("x\ty\n1,5\t2\n", 1.5, ","), ("x;y\n1.5;2\n", 1.5, "."), ("x,y\n1.5,2\n", 1.5, ".")],
)
def test_decimal_commas_where_the_separator_is_none(tmp_path: Path, text: str, x: float, mark: str) -> None:
    (row,) = rows_of(tmp_path, text)
    assert (row.number("x"), row.number("y"), row.mark) == (x, 2.0, mark)


def test_the_case_of_headings_does_not_matter(tmp_path: Path) -> None:
    (row,) = rows_of(tmp_path, "X,Y,Z\n1,2,3\n")
    assert row.cells == {"x": "1", "y": "2", "z": "3"}
    with raises(ParameterError, "repeated_column", column="x"):
        rows_of(tmp_path, "X,y,x\n1,2,3\n")


@pytest.mark.parametrize("cell", ["a", "", "inf", "nan", "1e999"])
def test_a_cell_without_a_finite_number_is_refused_with_its_place(tmp_path: Path, cell: str) -> None:
    (row,) = rows_of(tmp_path, f"x,y\n{cell},1\n")
    place = {"path": tmp_path / "table.csv", "row": 2}
    with raises(ParameterError, "not_a_number", **place, column="x", value=cell, action=ACTION):
        row.number("x")
    error = row.refused("y", Message("This is odd."), code="odd", action=Message("Look."))
    assert (error.code, str(error).startswith(f"{place['path']}, row 2, ")) == ("odd", True)
    assert math.isfinite(row.number("y"))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x,z\n1,2\n", coded("missing_column", column="y", action="Mend it.")),
        ("", coded("missing_column", column="x", action="Mend it.")),
        ("x,y,x\n1,2,3\n", coded("repeated_column", column="x")),
        ("x,y,z,z\n1,2,3,4\n", coded("repeated_column", column="z")),
        ('x,y\n1,"' + "a" * 140_000 + '"\n', coded("not_csv", action="Mend it.")),
        ("x,y\n1,2\n1,5,2\n", coded("too_many_cells", row=3, count=3, columns=2, action="Mend it.")),
    ],
)
def test_tables_that_are_none(tmp_path: Path, text: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        rows_of(tmp_path, text)


def test_blank_cells_beyond_the_last_name_and_double_names_that_nobody_reads_are_nothing(tmp_path: Path) -> None:
    (row,) = rows_of(tmp_path, "x,y,note,note\n1,2,,, ,\n", further=())
    assert row.cells == {"x": "1", "y": "2"}
