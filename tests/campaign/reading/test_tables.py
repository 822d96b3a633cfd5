"""What is wrong in a table is reported with its file, row, column, experiment and value."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from skisnow.campaign import Problem, check_campaign

WriteCampaign = Callable[[Mapping[str, str | bytes]], Path]
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
def test_a_wrong_cell(
    write_campaign: WriteCampaign, small_campaign: dict[str, str], file: str, old: str, new: str, expected: Where
) -> None:
    assert small_campaign[file].count(old) == 1
    small_campaign[file] = small_campaign[file].replace(old, new)
    problems = [problem for problem in check_campaign(write_campaign(small_campaign)) if problem.severity == "error"]
    assert [where(problem) for problem in problems] == [expected]


@pytest.mark.parametrize("angle", ["-1", "90", "120"])
def test_a_penetration_angle_out_of_range(
    write_campaign: WriteCampaign, small_campaign: dict[str, str], angle: str
) -> None:
    small_campaign[PEN] = small_campaign[PEN].replace("piece,30", f"piece,{angle}")
    assert [where(problem) for problem in check_campaign(write_campaign(small_campaign))] == [
        ("out_of_range", PEN, row, "edge_angle_deg", "P1", angle) for row in (2, 3, 4)
    ]


def test_limits_that_are_still_allowed(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    small_campaign[PEN] = small_campaign[PEN].replace("70.5,0.5", "0.001,0").replace("a,360", "a,917")
    small_campaign[SHEAR] = small_campaign[SHEAR].replace("blade,45,6,300,10", "blade,0.5,0,0.1,0")
    small_campaign[CONE] = small_campaign[CONE].replace("12.5", "0")
    found = check_campaign(write_campaign(small_campaign))
    # allowed, and so far from the other rows that a warning asks for their unit
    assert [(each.severity, *where(each)[:4]) for each in found] == [
        ("warning", "unlikely_unit", PEN, 5, "load_N"),
        ("warning", "unlikely_unit", SHEAR, 3, "lever_arm_mm"),
    ]


def test_every_problem_is_found_at_once(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    for file, old, new, _ in (CHANGES[0], CHANGES[7], CHANGES[17], CHANGES[23], CHANGES[25]):
        small_campaign[file] = small_campaign[file].replace(old, new)
    expected = [where for *_, where in (CHANGES[0], CHANGES[7], CHANGES[17], CHANGES[23], CHANGES[25])]
    assert [where(problem) for problem in check_campaign(write_campaign(small_campaign))] == expected


def test_missing_columns_name_the_nearest(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    small_campaign[SHEAR] = (
        small_campaign[SHEAR].replace("moment_Nm", "Moment (Nm)").replace("lever_arm_mm", "x").replace("site", "Site")
    )
    problems = check_campaign(write_campaign(small_campaign))
    assert [where(problem) for problem in problems] == [
        ("missing_column", SHEAR, 1, "site", None, "Site"),
        ("missing_column", SHEAR, 1, "lever_arm_mm", None, None),
        ("missing_column", SHEAR, 1, "moment_Nm", None, "Moment (Nm)"),
        ("unknown_column", SHEAR, 1, "Site", None, "Site"),
        ("unknown_column", SHEAR, 1, "x", None, "x"),
        ("unknown_column", SHEAR, 1, "Moment (Nm)", None, "Moment (Nm)"),
    ]
    assert "'Moment (Nm)'" in problems[2].action


def test_points_in_a_file_of_commas(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    """Also a quoted comma counts, so that 1.234 could be a thousand."""
    text = "test;site;repeat;drop_cone_depth_mm\nC1;S;1;12,5\nC1;S;2;13,5\nC2;S;1;1.234\n"
    problems = check_campaign(write_campaign({**small_campaign, CONE: text}))
    errors = [problem for problem in problems if problem.severity == "error"]
    assert [where(problem) for problem in errors] == [("not_a_number", CONE, 4, "drop_cone_depth_mm", "C2", "1.234")]
    assert "decimal commas" in errors[0].action
    quoted = 'test,site,repeat,drop_cone_depth_mm\nC1,S,1,"12,5"\nC1,S,2,13\n'
    problems = check_campaign(write_campaign({**small_campaign, CONE: quoted}))
    assert [where(problem) for problem in problems] == [("separator", CONE, None, None, None, "decimal comma")]


@pytest.mark.parametrize(("cell", "separator", "mark"), [("12 mm", ",", "."), ("1x", ";", ",")])
def test_a_cell_that_is_no_number_in_either_way_of_writing(
    write_campaign: WriteCampaign, small_campaign: dict[str, str], cell: str, separator: str, mark: str
) -> None:
    rows = ["test,site,repeat,drop_cone_depth_mm", f"C1,S,1,12{mark}5", f"C1,S,2,13{mark}5", f"C2,S,1,{cell}"]
    first, *others = (row.split(",", 3) for row in rows)
    text = "".join(separator.join(row) + "\n" for row in (first, *others))
    problems = check_campaign(write_campaign({**small_campaign, CONE: text}))
    (error,) = [problem for problem in problems if problem.severity == "error"]
    assert where(error) == ("not_a_number", CONE, 4, "drop_cone_depth_mm", "C2", cell)
    assert f" 12{mark}5" in error.action


def test_text_in_a_column_that_nobody_named(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    text = "sample,,site,snow_density_kg_per_m3\nD1,,S,400\nD2,?,S,300\n"
    problems = check_campaign(write_campaign({**small_campaign, DENSITY: text}))
    assert [where(problem) for problem in problems] == [("unreadable_file", DENSITY, 3, None, None, "?")]


@pytest.mark.parametrize("file", [PEN, SHEAR, DENSITY, CONE])
@pytest.mark.parametrize("content", [b"", b"\r\n \r\n", b"\xef\xbb\xbf", "header"])
def test_empty_files(
    write_campaign: WriteCampaign, small_campaign: dict[str, str], file: str, content: str | bytes
) -> None:
    if content == "header":
        content = small_campaign[file].splitlines()[0] + "\r\n;,\t\r\n"
        assert content.startswith(("experiment", "sample", "test"))
        content = content.replace(";,\t", ",,")
    problems = check_campaign(write_campaign({**small_campaign, file: content}))
    assert [(problem.severity, problem.code, problem.file) for problem in problems] == [("error", "empty_file", file)]


@pytest.mark.parametrize("file", [PEN, SHEAR, DENSITY, CONE, "campaign.toml", "corrections.csv"])
def test_binary_files(write_campaign: WriteCampaign, small_campaign: dict[str, str], file: str) -> None:
    workbook = b"PK\x03\x04\x14\x00\x06\x00\x08\x00\x00\x00!\x00"
    (problem,) = check_campaign(write_campaign({**small_campaign, file: workbook}))
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", file)
    assert "CSV" in problem.action


def test_no_measurements(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    description = {"campaign.toml": small_campaign["campaign.toml"]}
    (problem,) = check_campaign(write_campaign(description))
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", PEN)
    assert SHEAR in problem.allowed


def test_a_hundred_thousand_columns(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    small_campaign[DENSITY] = ",".join(f"column {place}" for place in range(100_000)) + "\n1\n"
    problems = [problem for problem in check_campaign(write_campaign(small_campaign)) if problem.severity == "error"]
    assert [where(problem) for problem in problems] == [("unreadable_file", DENSITY, 1, None, None, "100000 cells")]


def test_reading_ends_after_many_errors(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    """100,000 wrong rows; the last problem names the row at which reading ended."""
    small_campaign[CONE] += "9\n" * 100_000
    problems = [each for each in check_campaign(write_campaign(small_campaign)) if each.file == CONE]
    assert 10_000 < len(problems) < 30_000
    (last,) = (each for each in problems if each.code == "unreadable_file")
    assert last.row is not None
    assert last.row < 15_000


def test_repeated_rows_are_listed_up_to_a_number(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    *_, row = small_campaign[DENSITY].splitlines()
    small_campaign[DENSITY] += f"{row}\n" * 5000
    problems = [each for each in check_campaign(write_campaign(small_campaign)) if each.code == "repeated_row"]
    assert len(problems) == 1001
    assert sum(each.row is None and "4000" in str(each.value) for each in problems) == 1
