"""Tables of a campaign and their text."""

import pytest
from tests.key_names import DROP_CONE_DEPTH
from tests.present import present

from skisnow._support.csv_text import RECORDS_AT_ONCE, UnreadableTextError, decode, inspect_csv
from skisnow.campaign import Problem

from ..conftest import SmallCampaign

Where = tuple[str, str, int | None, str | None, str | None, str | None]

PEN, SHEAR, DENSITY, CONE = "penetration.csv", "shear.csv", "density.csv", "drop_cone.csv"


def where(problem: Problem) -> Where:
    return (problem.code, problem.file, problem.row, problem.column, problem.experiment, problem.value)


# file, what is replaced, by what, the only problem
CHANGES: list[tuple[str, str, str, Where]] = [
    (PEN, "140.5,2.5", "140.5,tief", ("not_a_number", PEN, 3, "depth_mm", "P1", "tief")),
    (PEN, "140.5,2.5", "140.5,nan", ("not_a_number", PEN, 3, "depth_mm", "P1", "nan")),
    (PEN, "140.5,2.5", "140.5,", ("not_a_number", PEN, 3, "depth_mm", "P1", "")),
    (PEN, "140.5,2.5", '140.5,"2,5"', ("not_a_number", PEN, 3, "depth_mm", "P1", "2,5")),
    (PEN, "140.5,2.5", "140.5,1_0", ("not_a_number", PEN, 3, "depth_mm", "P1", "1_0")),
    (PEN, "140.5,2.5", "140.5,1e999", ("not_a_number", PEN, 3, "depth_mm", "P1", "1e999")),
    (PEN, "140.5,2.5", "140.5,-0.01", ("out_of_range", PEN, 3, "depth_mm", "P1", "-0.01")),
    (PEN, "210.5,3.75", "0,3.75", ("out_of_range", PEN, 4, "load_N", "P1", "0")),
    (PEN, "a,350", "a,ca. 350", ("not_a_number", PEN, 2, "snow_density_kg_per_m3", "P1", "ca. 350")),
    (PEN, "a,350", "a,0", ("out_of_range", PEN, 2, "snow_density_kg_per_m3", "P1", "0")),
    (PEN, "a,350", "a,917.1", ("out_of_range", PEN, 2, "snow_density_kg_per_m3", "P1", "917.1")),
    (PEN, "P1,Süd,piece,30,140.5", "P1,,piece,30,140.5", ("out_of_range", PEN, 3, "site", "P1", "")),
    (PEN, "P1,Süd,piece,30,140.5", "P1,Süd, ,30,140.5", ("out_of_range", PEN, 3, "tool", "P1", "")),
    (PEN, '"hard, wet"', "hard, wet", ("unreadable_file", PEN, 4, None, None, "wet")),
    (PEN, '"hard, wet"', '"hard, wet', ("unreadable_file", PEN, 4, None, None, '"')),
    (PEN, "load_N", "load", ("missing_column", PEN, 1, "load_N", None, "load")),
    (PEN, "remark", "spot", ("unreadable_file", PEN, 1, "spot", None, "spot")),
    (SHEAR, "blade,90,5.5", "blade,0,5.5", ("out_of_range", SHEAR, 2, "edge_angle_deg", "S1", "0")),
    (SHEAR, "blade,90,5.5", "blade,90.1,5.5", ("out_of_range", SHEAR, 2, "edge_angle_deg", "S1", "90.1")),
    (SHEAR, "6,300,10", "6,0,10", ("out_of_range", SHEAR, 3, "lever_arm_mm", "S2", "0")),
    (SHEAR, "6,300,10", "6,300,-1", ("out_of_range", SHEAR, 3, "moment_Nm", "S2", "-1")),
    (SHEAR, "a,14.5", "a,-1", ("out_of_range", SHEAR, 2, "drop_cone_depth_mm", "S1", "-1")),
    (SHEAR, "S2,", ",", ("out_of_range", SHEAR, 3, "experiment", None, "")),
    (DENSITY, "410.5", "1000", ("out_of_range", DENSITY, 2, "snow_density_kg_per_m3", "D1", "1000")),
    (DENSITY, "D2,Nord,300", ",Nord,300", ("out_of_range", DENSITY, 3, "sample", None, "")),
    (CONE, "12.5", "-12.5", ("out_of_range", CONE, 2, "drop_cone_depth_mm", "C1", "-12.5")),
    (CONE, "C1,Süd,2", "C1,Süd,", ("out_of_range", CONE, 3, "repeat", "C1", "")),
    (CONE, "C1,Süd,2", "C1,Süd,2,9", ("unreadable_file", CONE, 3, None, None, "13.5")),
]


@pytest.mark.parametrize(("file", "old", "new", "expected"), CHANGES)
def test_a_wrong_cell(small: SmallCampaign, file: str, old: str, new: str, expected: Where) -> None:
    assert small[file].count(old) == 1
    small.replace(file, old, new)
    assert [where(problem) for problem in small.errors()] == [expected]


def test_limits_that_are_still_allowed(small: SmallCampaign) -> None:
    small[PEN] = small[PEN].replace("70.5,0.5", "0.001,0").replace("a,360", "a,917")
    small.replace(SHEAR, "blade,45,6,300,10", "blade,0.5,0,0.1,0")
    small.replace(CONE, "12.5", "0")
    found = small.check()
    # allowed, and so far from the other rows that a warning asks for their unit
    assert [(each.severity, *where(each)[:4]) for each in found] == [
        ("warning", "unlikely_unit", PEN, 5, "load_N"),
        ("warning", "unlikely_unit", SHEAR, 3, "lever_arm_mm"),
    ]


def test_missing_columns_name_the_nearest(small: SmallCampaign) -> None:
    small[SHEAR] = small[SHEAR].replace("moment_Nm", "Moment (Nm)").replace("lever_arm_mm", "x").replace("site", "Site")
    problems = small.check()
    assert [where(problem) for problem in problems] == [
        ("missing_column", SHEAR, 1, "site", None, "Site"),
        ("missing_column", SHEAR, 1, "lever_arm_mm", None, None),
        ("missing_column", SHEAR, 1, "moment_Nm", None, "Moment (Nm)"),
        ("unknown_column", SHEAR, 1, "Site", None, "Site"),
        ("unknown_column", SHEAR, 1, "x", None, "x"),
        ("unknown_column", SHEAR, 1, "Moment (Nm)", None, "Moment (Nm)"),
    ]
    assert "'Moment (Nm)'" in problems[2].action


@pytest.mark.parametrize(("heading", "newtons"), [("load_kg", 9.80665), ("Last [kg]", 9.80665), ("load_kN", 1e3)])
def test_a_heading_in_another_unit_is_mapped_not_renamed(small: SmallCampaign, heading: str, newtons: float) -> None:
    """Numbers in kg below the name load_N would be read as N."""
    before = small.read().penetration
    small.replace(PEN, "load_N", heading)
    missing = next(each for each in small.check() if each.code == "missing_column")
    assert repr(heading) in missing.action
    assert "'load_N'" in missing.action
    small["campaign.toml"] += f'\n[columns]\n"{heading}" = "load_N"\n'
    read = present(small.read().penetration)
    assert read.load == pytest.approx(newtons * present(before).load)


def test_points_in_a_file_of_commas(small: SmallCampaign) -> None:
    """Also a quoted comma counts, so that 1.234 could be a thousand."""
    text = "test;site;repeat;drop_cone_depth_mm\nC1;S;1;12,5\nC1;S;2;13,5\nC2;S;1;1.234\n"
    errors = small.errors({CONE: text})
    assert [where(problem) for problem in errors] == [("not_a_number", CONE, 4, DROP_CONE_DEPTH, "C2", "1.234")]
    assert "decimal mark of this file is ','" in errors[0].action
    quoted = 'test,site,repeat,drop_cone_depth_mm\nC1,S,1,"12,5"\nC1,S,2,13\n'
    problems = small.check({CONE: quoted})
    assert [where(problem) for problem in problems] == [("separator", CONE, None, None, None, "decimal comma")]


@pytest.mark.parametrize(("cell", "separator", "mark"), [("12 mm", ",", "."), ("1x", ";", ",")])
def test_a_cell_that_is_a_number_in_no_notation(small: SmallCampaign, cell: str, separator: str, mark: str) -> None:
    rows = ["test,site,repeat,drop_cone_depth_mm", f"C1,S,1,12{mark}5", f"C1,S,2,13{mark}5", f"C2,S,1,{cell}"]
    first, *others = (row.split(",", 3) for row in rows)
    text = "".join(separator.join(row) + "\n" for row in (first, *others))
    (error,) = small.errors({CONE: text})
    assert where(error) == ("not_a_number", CONE, 4, DROP_CONE_DEPTH, "C2", cell)
    assert f" 12{mark}5" in error.action


def test_text_in_a_column_that_nobody_named(small: SmallCampaign) -> None:
    text = "sample,,site,snow_density_kg_per_m3\nD1,,S,400\nD2,?,S,300\n"
    problems = small.check({DENSITY: text})
    assert [where(problem) for problem in problems] == [("unreadable_file", DENSITY, 3, None, None, "?")]


@pytest.mark.parametrize("file", [SHEAR, DENSITY, CONE])
@pytest.mark.parametrize("content", [b"", "header"])
def test_empty_files(small: SmallCampaign, file: str, content: str | bytes) -> None:
    if content == "header":
        content = small[file].splitlines()[0] + "\r\n;,\t\r\n"
        assert content.startswith(("experiment", "sample", "test"))
        content = content.replace(";,\t", ",,")
    problems = small.check({file: content})
    assert [(problem.severity, problem.code, problem.file) for problem in problems] == [("error", "empty_file", file)]


@pytest.mark.parametrize("file", [PEN, SHEAR, DENSITY, CONE, "campaign.toml", "corrections.csv"])
def test_binary_files(small: SmallCampaign, file: str) -> None:
    workbook = b"PK\x03\x04\x14\x00\x06\x00\x08\x00\x00\x00!\x00"
    (problem,) = small.check({file: workbook})
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", file)
    assert "CSV" in problem.action


def test_no_measurements(small: SmallCampaign) -> None:
    for name in (PEN, SHEAR, DENSITY, CONE):
        del small[name]
    (problem,) = small.check()
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", PEN)
    assert SHEAR in problem.allowed


def test_reading_ends_after_many_errors(small: SmallCampaign) -> None:
    """100,000 wrong rows; the last problem names the row at which reading ended."""
    small[CONE] += "9\n" * 100_000
    problems = [each for each in small.check() if each.file == CONE]
    assert 10_000 < len(problems) < 30_000
    (last,) = (each for each in problems if each.code == "unreadable_file")
    assert present(last.row) < 15_000


def test_repeated_rows_are_listed_up_to_a_number(small: SmallCampaign) -> None:
    *_, row = small[DENSITY].splitlines()
    small[DENSITY] += f"{row}\n" * 5000
    problems = [each for each in small.check() if each.code == "repeated_row"]
    assert len(problems) == 1000


def records(data: bytes) -> list[tuple[int, list[str]]]:
    return [pair for lines, rows in inspect_csv(data).records() for pair in zip(lines, rows, strict=True)]


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
def test_binary_is_rejected(data: bytes) -> None:
    with pytest.raises(UnreadableTextError) as caught:
        decode(data)
    assert "binary" in caught.value.action


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


@pytest.mark.parametrize("columns", [1_001, 100_000])
def test_a_table_with_more_columns_than_a_person_fills_is_rejected(columns: int) -> None:
    text = inspect_csv(("x," * (columns - 1) + "x\n").encode())
    with pytest.raises(UnreadableTextError) as caught:
        list(text.records())
    assert (caught.value.row, caught.value.value) == (1, f"{columns} cells")
    assert caught.value.allowed == "at most 1000 columns"


def test_a_cell_longer_than_a_spreadsheet_holds_is_rejected() -> None:
    fits, too_long = "x" * 32_767, "x" * 32_768
    assert next(inspect_csv(f"a,b\n1,{fits}\n".encode()).records())[1][1] == ["1", fits]
    with pytest.raises(UnreadableTextError) as caught:
        list(inspect_csv(f"a,b\n1,{too_long}\n".encode()).records())
    assert caught.value.row == 2
    assert "32767" in caught.value.allowed
