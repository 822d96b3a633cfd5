"""Workbooks and XML of user files."""

import io
import sys
import zipfile
from datetime import date, datetime
from typing import Any

import pytest
from openpyxl import Workbook

from skisnow._support.user_files import workbook
from skisnow._support.user_files.text_files import ContentError
from skisnow._support.user_files.workbook import workbook_sheets
from skisnow._support.user_files.xml_elements import DEEPEST, xml_tree
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
        (
            FIRST,
            SHEET % b'<row r="7"><c r="C7"><f>1+1</f><v> </v></c></row>',
            coded("formula_without_value", cell="C7"),
        ),
        (FIRST, SHEET % b'<row r="7"><c r="C7"><v>', "not_readable"),
        ("xl/workbook.xml", None, "not_readable"),
    ],
)
def test_unneeded_content_rejected(
    part: str, content: bytes | None, told: str | Coded, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workbook, "MOST_ROWS", 1000)
    monkeypatch.setattr(workbook, "MOST_UNPACKED_BYTES", 1 << 20)
    with raises(ContentError, told):
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
def test_an_invalid_workbook_is_rejected(data: bytes, told: str | Coded) -> None:
    with raises(ContentError, told):
        read(data)


def test_a_formula_gives_the_value_that_is_stored_with_it() -> None:
    cell = b'<row r="1"><c r="A1"><f>1+1</f><v>2.5</v></c></row>'
    assert read(with_part(packed(A=[["x"]]), FIRST, SHEET % cell)) == {"A": [["2.5"]]}


TEXT = b"""<?xml version="1.0"?>
<p:pit xmlns:p="urn:pit" xmlns:q="urn:other" q:id="7" plain="x y">
  <p:layer top="0">  soft\n snow <p:grain>PP</p:grain> behind</p:layer>
  <q:note/>
  <p:layer top="12">hard</p:layer>
</p:pit>"""


def test_a_tree_has_local_names_texts_and_children() -> None:
    pit = xml_tree(TEXT)
    assert (pit.namespace, pit.name, dict(pit.attributes)) == ("urn:pit", "pit", {"id": "7", "plain": "x y"})
    assert [(each.namespace, each.name) for each in pit.children] == [
        ("urn:pit", "layer"), ("urn:other", "note"), ("urn:pit", "layer"),
    ]  # fmt: skip
    assert [each.attributes["top"] for each in pit.named("layer")] == ["0", "12"]
    first = pit.child("layer")
    assert first is pit.children[0]
    assert first.text == "  soft\n snow "
    assert pit.text_of("layer") == "soft\n snow"
    assert (pit.text_of("layer", "grain"), pit.text_of("note"), pit.text_of()) == ("PP", "", "")
    assert pit.child() is pit
    assert pit.child("grain") is None
    assert pit.child("note", "grain", "size") is None
    assert pit.text_of("note", "grain") == ""
    assert list(pit.named("grain")) == []


def nested(depth: int) -> bytes:
    return b"<a>" * depth + b"</a>" * depth


def test_what_is_beyond_a_limit_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    assert xml_tree(nested(DEEPEST)).name == "a"
    with raises(ContentError, "too_large", depth=60):
        xml_tree(nested(DEEPEST + 1))
    monkeypatch.setattr(
        sys.modules["skisnow._support.user_files.xml_elements"], "MOST_ELEMENTS", 3
    )  # the function hides it
    assert len(xml_tree(b"<a><b/><b/></a>").children) == 2
    with raises(ContentError, "too_large", count=3):
        xml_tree(b"<a><b/><b/><b/></a>")


@pytest.mark.parametrize(
    ("data", "line", "told"),
    [
        (b"<a>\n<b></a>", 2, coded("not_xml", line=2)),
        (b"", 1, "not_xml"),
        (b"<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", None, "document_type"),
    ],
)
def test_an_invalid_xml_is_rejected(data: bytes, line: int | None, told: str | Coded) -> None:
    with raises(ContentError, told) as error:
        xml_tree(data)
    assert error.value.line == line
