"""Workbooks as text, and workbooks that were made to do harm."""

from __future__ import annotations

import io
import zipfile
from datetime import date, datetime
from typing import Any

import pytest
from openpyxl import Workbook

from skisnow._support.user_files import GivenError, workbook, workbook_sheets
from tests.coded import Coded, coded, raises


def packed(**sheets: list[list[Any]]) -> bytes:
    book = Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def with_part(data: bytes, name: str, content: bytes | None) -> bytes:
    """The same archive with one part more, or with another one in its place."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for part in old.infolist():
            if part.filename != name:
                new.writestr(part, old.read(part))
        if content is not None:
            new.writestr(name, content)
    return stream.getvalue()


def read(data: bytes) -> dict[str, workbook.Rows | None]:
    return workbook_sheets(data, wanted=lambda _: True)


def test_cells_are_texts_and_rows_keep_their_numbers() -> None:
    rows: list[list[Any]] = [
        [],
        ["Tag", "Last\n[N]", "", ""],
        [datetime(2026, 11, 23), 12.0, 0.1, True],
        [datetime(2026, 11, 23, 9, 5)],
    ]
    found = read(packed(A=rows, B=[["x", None, date(2026, 1, 2)]], C=[[]]))
    assert found == {
        "A": [[], ["Tag", "Last [N]"], ["2026-11-23", "12", "0.1", "TRUE"], ["2026-11-23T09:05:00"]],
        "B": [["x", "", "2026-01-02"]],
        "C": [],
    }


def test_numbers_follow_those_that_were_typed_as_text_with_a_decimal_comma() -> None:
    """Excel keeps a cell as text where it came so; its neighbours are numbers, and the two mean the same kind."""
    mixed: list[list[Any]] = [["Tiefe", "Moment"], ["3,25", 43.5], ["4", 12.0], [1.25, 1e-7]]
    assert read(packed(A=mixed))["A"] == [["Tiefe", "Moment"], ["3,25", "43,5"], ["4", "12"], ["1,25", "1e-07"]]
    pointed: list[list[Any]] = [["a, b", "3.25"], [43.5, "x"]]
    assert read(packed(A=pointed))["A"] == [["a, b", "3.25"], ["43.5", "x"]]


def test_a_sheet_that_is_not_wanted_is_named_alone() -> None:
    assert workbook_sheets(packed(A=[["x"]], B=[["y"]]), wanted=lambda name: name == "B") == {"A": None, "B": [["y"]]}


SHEET = b'<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>%s</sheetData></worksheet>'
FIRST = "xl/worksheets/sheet1.xml"


@pytest.mark.parametrize(
    ("part", "content", "told"),
    [
        ("xl/bomb.bin", b"\0" * ((1 << 20) + 1), coded("too_large", limit=1)),
        (FIRST, b'<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]>' + SHEET % b"", "not_readable"),
        (FIRST, "<!DOCTYPE a>".encode("utf-16") + SHEET[:0], "not_readable"),
        (FIRST, b"<a>" * 65, "too_large"),
        (FIRST, SHEET % b'<row r="99999999"><c r="A1"><v>1</v></c></row>', coded("too_large", limit=1000)),
        (FIRST, SHEET % b'<row r="1"><c r="ALM1"><v>1</v></c></row>', coded("too_large", row=1, count=1001)),
        (FIRST, SHEET % b'<row r="7"><c r="C7"><f>1+1</f></c></row>', coded("formula_without_value", cell="C7")),
        (FIRST, SHEET % b'<row r="7"><c r="C7"><v>', "not_readable"),
        ("xl/workbook.xml", None, "not_readable"),
    ],
)
def test_what_a_table_has_no_need_of_is_refused(
    part: str, content: bytes | None, told: str | Coded, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workbook, "MOST_ROWS", 1000)
    monkeypatch.setattr(workbook, "MOST_UNPACKED_BYTES", 1 << 20)
    with raises(GivenError, told):
        read(with_part(packed(A=[["x"]]), part, content))


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"PK\3\4 and no more", "not_readable"),
        (b"", "not_readable"),
        (b"\xd0\xcf\x11\xe0" + b"\0" * 600, "not_readable"),
        (b"PK\1\2" * 2001, coded("too_large", limit=2000)),
        (b" " * (workbook.MOST_WORKBOOK_BYTES + 1), "too_large"),
    ],
)
def test_what_is_no_workbook_is_refused(data: bytes, told: str | Coded) -> None:
    with raises(GivenError, told):
        read(data)


def test_a_formula_gives_the_value_that_is_stored_with_it() -> None:
    cell = b'<row r="1"><c r="A1"><f>1+1</f><v>2.5</v></c></row>'
    assert read(with_part(packed(A=[["x"]]), FIRST, SHEET % cell)) == {"A": [["2.5"]]}
