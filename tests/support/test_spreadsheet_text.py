"""Tables of users by their cells; texts in tables that people open: never a formula, always the same again."""

import math
import random
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message
from skisnow._support.spreadsheet_text import (
    LONGEST_NUMBER,
    CsvRow,
    NoTextError,
    csv_rows,
    decimal_mark,
    decoded,
    encoding_of,
    is_number,
    most_frequent_separator,
    named_separator,
    number,
    protect_from_formulas,
    remove_protection,
)
from tests.coded import Coded, coded, raises


@pytest.mark.parametrize(
    "text",
    ["=1+1", '=HYPERLINK("http://x")', "+1+1", "-A1", "@SUM(A1)", "\tx", "\rx", "＝1", "-1 mm", "--1", "-", "=-1"],
)
def test_what_a_spreadsheet_takes_for_a_formula_begins_with_an_apostrophe(text: str) -> None:
    assert protect_from_formulas(text) == f"'{text}"


@pytest.mark.parametrize("text", ["-1.5", "+2", "-1,5", "-1e-3", "0", "A-1", "it's", "'tis", "", " "])
def test_numbers_and_harmless_texts_stay(text: str) -> None:
    assert protect_from_formulas(text) == text
    assert remove_protection(text) == text


def test_every_text_comes_back() -> None:
    random_ = random.Random(1)
    cells = set()
    for _ in range(5000):
        text = "".join(random_.choices("'=+-@1. a\t", k=random_.randrange(6)))
        cells.add((text, protect_from_formulas(text)))
        assert remove_protection(protect_from_formulas(text)) == text
        assert protect_from_formulas(text)[:1] not in tuple("=@\t")
    assert len({cell for _, cell in cells}) == len(cells)  # no two texts share a cell


@pytest.mark.parametrize(
    ("data", "codec", "foreign"),
    [
        ("Höhe".encode(), "utf-8", None),
        ("Höhe".encode("utf-8-sig"), "utf-8-sig", None),
        ("\ufeffHöhe".encode("utf-8-sig"), "utf-8-sig", None),  # two byte order marks
        ("Höhe".encode("utf-16"), "utf-16", "UTF-16"),
        (b"\xfe\xff" + "Höhe".encode("utf-16-be"), "utf-16", "UTF-16"),
        ("Höhe".encode("cp1252"), "cp1252", "Windows-1252"),
    ],
)
def test_encodings(data: bytes, codec: str, foreign: str | None) -> None:
    assert encoding_of(data) == (codec, foreign)
    text = decoded(data)
    assert (text.text, text.codec, text.foreign_encoding) == ("Höhe", codec, foreign)


@pytest.mark.parametrize(
    ("data", "place", "encoding"),
    [
        (b"ab\x81", "byte 3", "Windows-1252"),
        (b"a\0b", "a NUL character", "UTF-8"),
        (b"\xff\xfe" + "ab".encode("utf-16-le") + b"\x00\xdc", "byte 7", "UTF-16"),
        (b"\xff\xfe\0\0", "a NUL character", "UTF-16"),
    ],
)
def test_bytes_that_are_no_text_are_reported_by_their_place(data: bytes, place: str, encoding: str) -> None:
    with pytest.raises(NoTextError, match=f"^{place} is no {encoding} text$") as refused:
        decoded(data)
    assert (refused.value.place, refused.value.encoding) == (place, encoding)


@pytest.mark.parametrize(
    ("head", "separator"),
    [
        ("sep=;\na", ";"),
        ("SEP=,,,\r\na", ","),
        ('"sep=\t"\n', "\t"),
        ("sep=;,\n", None),
        ("a\nsep=;", None),
        ("", None),
    ],
)
def test_a_first_line_that_names_the_separator(head: str, separator: str | None) -> None:
    assert named_separator(head) == separator


@pytest.mark.parametrize(
    ("head", "separator"),
    [
        ("a;b;c,d\n", ";"), ("a,b;c", ","), ("a\tb\n1,2,3,4", "\t"), (";;\n,\na,b", ","),
        ('"a;b;c"\td', "\t"), ("", ","),
        ('"a\nb,c,d";e\n', ";"), ("a\n", ","),
    ],
)  # fmt: skip
def test_the_separator_of_the_first_line_that_says_something(head: str, separator: str) -> None:
    assert most_frequent_separator(head) == separator


@pytest.mark.parametrize(
    ("cell", "mark", "value"),
    [
        ("1.", ".", 1.0), (".5", ".", 0.5), ("+1.5E-3", ".", 1.5e-3), (" 2,5 ", ",", 2.5), ("7", ",", 7.0),
        ("1.5", ",", math.nan), ("1,5", ".", math.nan), (".", ".", math.nan), ("1e", ".", math.nan),
        ("0x1", ".", math.nan), ("-1e999", ".", math.nan),
    ],
)  # fmt: skip
def test_numbers_as_they_are_written(cell: str, mark: str, value: float) -> None:
    assert number(cell, mark) == pytest.approx(value, rel=0.0, nan_ok=True)


def test_no_number_is_longer_than_the_longest() -> None:
    assert is_number("1" * LONGEST_NUMBER, ".")
    assert not is_number("1" * (LONGEST_NUMBER + 1), ".")


@pytest.mark.parametrize(
    ("groups", "separator", "mark"),
    [
        ([["1,5", "2,5", "3.5"]], ";", ","),
        ([["1,5", "2.5", "3.5"]], ";", "."),
        ([["1,5", "2.5"]], ";", ","),
        ([["1,5", "2.5"]], ",", "."),
        ([["1", "a,b"], ["2,5"], ["3.5", "4.5"]], "\t", ","),
        ([["1", "2"], []], ";", "."),
        ([], ";", "."),
        ([["ca. 5", "0,25"]], ",", ","),
    ],
)
def test_the_first_fractions_tell_the_decimal_mark(groups: list[list[str]], separator: str, mark: str) -> None:
    assert decimal_mark(groups, separator=separator) == mark


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
def test_a_cell_without_a_finite_number_is_rejected_with_its_place(tmp_path: Path, cell: str) -> None:
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
