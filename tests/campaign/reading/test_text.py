"""Bytes to text and records: encodings, what is binary, separators, lines."""

from __future__ import annotations

import itertools

import pytest

from skisnow.campaign.reading.text import RECORDS_AT_ONCE, UnreadableTextError, decode, inspect_csv


def records(data: bytes) -> list[tuple[int, list[str]]]:
    return [pair for lines, rows in inspect_csv(data).records() for pair in zip(lines, rows, strict=True)]


@pytest.mark.parametrize(
    ("data", "text", "foreign"),
    [
        (b"", "", None),
        ("Höhe".encode(), "Höhe", None),
        ("Höhe".encode("utf-8-sig"), "Höhe", None),
        ("\ufeffHöhe".encode("utf-8-sig"), "Höhe", None),  # two byte order marks
        ("Höhe".encode("utf-16"), "Höhe", "UTF-16"),
        (b"\xfe\xff" + "Höhe".encode("utf-16-be"), "Höhe", "UTF-16"),
        ("Höhe 5–6 €".encode("cp1252"), "Höhe 5–6 €", "Windows-1252"),
    ],
)
def test_decode(data: bytes, text: str, foreign: str | None) -> None:
    decoded = decode(data)
    assert decoded.text == text
    assert decoded.foreign_encoding == foreign


@pytest.mark.parametrize(
    "data",
    [
        b"PK\x03\x04\x14\x00\x06\x00\x08\x00",  # a workbook
        b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR",
        b"a,b\n1,\x00\n",
        b"\xff\xfea",  # half a UTF-16 character
        b"\xef\xbb\xbfa\xff",  # promises UTF-8
        b"\xe9\x81",  # 0x81 is not a Windows-1252 character
        "a,b\n1,2\n".encode("utf-16-le"),  # without byte order mark
        "a,b\n1,2\n".encode("utf-32"),
        bytes(range(1, 32)) * 10,
        b"\xe9" + bytes([1, 2, 3, 4]) * 3,
    ],
)
def test_binary_is_refused(data: bytes) -> None:
    with pytest.raises(UnreadableTextError) as caught:
        decode(data)
    assert "binary" in caught.value.action


@pytest.mark.parametrize(
    ("data", "separator"),
    [
        (b"a,b;c,d\n", ","),
        (b"a;b;c\n1,5;2,5;3,5\n", ";"),
        (b'"a,b,c,d";e\n', ";"),
        (b'"a\nb,c,d";e\n', ";"),
        (b"a\tb\n", "\t"),
        (b"a\n", ","),
        (b";;;\r\n\r\na,b\r\n", ","),
        (b"sep=;\na,b,c;d\n", ";"),
        (b'"sep=\t"\r\na,b\n', "\t"),
        (b"SEP=,\na;b;c\n", ","),
    ],
)
def test_separator(data: bytes, separator: str) -> None:
    assert inspect_csv(data).separator == separator


def test_separator_that_is_not_read() -> None:
    with pytest.raises(UnreadableTextError) as caught:
        inspect_csv(b"sep=|\na|b\n")
    assert (caught.value.row, caught.value.value) == (1, "sep=|")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_of_records(end: str) -> None:
    lines = ["a,b", "", ' , "  "', "1,2", '"x', 'y",3', "\u00a0,", "4", '5," 6"']
    assert records(end.join(lines).encode()) == [
        (1, ["a", "b"]),
        (4, ["1", "2"]),
        (5, [f"x{end}y", "3"]),
        (8, ["4"]),
        (9, ["5", " 6"]),
    ]


def test_other_line_separators_do_not_count() -> None:
    assert records("a,b\n1\u20282,\x853\x0b\n4,5\n".encode())[2][0] == 3


def test_lines_below_a_line_that_names_the_separator() -> None:
    assert records(b"sep=;\r\na;b\r\n\r\n1;2\r\n") == [(2, ["a", "b"]), (4, ["1", "2"])]


@pytest.mark.parametrize("more", [0, 1, 60_000])
def test_open_quote_names_its_row(more: int) -> None:
    """At the end, one line on, and beyond the longest cell of the csv module; rows before it are still given."""
    data = b'a,b\n1,2\n3,"4' + b"\n5,6" * more
    chunks = inspect_csv(data).records()
    assert next(chunks) == ([1, 2], [["a", "b"], ["1", "2"]])
    with pytest.raises(UnreadableTextError) as caught:
        next(chunks)
    assert caught.value.row == 3


@pytest.mark.parametrize("cell", ["x" * 200_000, '"' + "x" * 200_000 + '"', '"' + "5,6\n" * 60_000])
def test_a_cell_without_end_is_not_taken_for_an_open_quote_alone(cell: str) -> None:
    with pytest.raises(UnreadableTextError) as caught:
        list(inspect_csv(f"a,b\n1,2\n3,{cell}".encode()).records())
    assert caught.value.row == 3
    assert "131072" in str(caught.value.value) and "32767" in str(caught.value.allowed)


@pytest.mark.parametrize("count", [RECORDS_AT_ONCE - 1, RECORDS_AT_ONCE, RECORDS_AT_ONCE + 1])
def test_no_record_is_lost_between_portions(count: int) -> None:
    data = "\n".join(map(str, range(count))).encode()
    assert records(data) == [(index + 1, [str(index)]) for index in range(count)]
    with pytest.raises(UnreadableTextError) as caught:
        list(inspect_csv(data + b'\n"').records())
    assert caught.value.row == count + 1


def test_records_come_in_portions() -> None:
    data = b"1\n" * (3 * RECORDS_AT_ONCE)
    sizes = [len(rows) for _, rows in inspect_csv(data).records()]
    assert sum(sizes) == 3 * RECORDS_AT_ONCE
    assert all(size <= RECORDS_AT_ONCE for size in itertools.chain(sizes))


@pytest.mark.parametrize("columns", [1_001, 100_000])
def test_a_table_with_more_columns_than_a_person_fills_is_refused(columns: int) -> None:
    text = inspect_csv(("x," * (columns - 1) + "x\n").encode())
    with pytest.raises(UnreadableTextError) as caught:
        list(text.records())
    assert (caught.value.row, caught.value.value) == (1, f"{columns} cells")
    assert caught.value.allowed == "at most 1000 columns"


def test_a_cell_longer_than_a_spreadsheet_holds_is_refused() -> None:
    fits, too_long = "x" * 32_767, "x" * 32_768
    assert next(inspect_csv(f"a,b\n1,{fits}\n".encode()).records())[1][1] == ["1", fits]
    with pytest.raises(UnreadableTextError) as caught:
        list(inspect_csv(f"a,b\n1,{too_long}\n".encode()).records())
    assert caught.value.row == 2
    assert "32767" in caught.value.allowed
