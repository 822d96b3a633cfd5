"""A workbook as a campaign, or as the tables of one."""

import csv
import io
import os
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.present import present

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Campaign, campaign_of_files, read_campaign
from skisnow.campaign.reading.campaign import READ_FILES
from skisnow.campaign.reading.workbook_files import description_text
from skisnow.estimation import analyse, quality_flags, results_dict

from ...support.user_files.test_workbook import packed
from ..conftest import SmallCampaign
from ..recordings import plain_snow

TABLES = ("penetration", "shear", "density", "drop_cone")
DESCRIBED: dict[str, list[list[Any]]] = {
    "campaign": [
        ["key", "value"], ["name", "north slope"], ["place", "Kühtai"], ["observers", "A. Müller; B"],
        ["gauge_resolution_mm", "0,01"], ["load_uncertainty_N", 0.5], ["moment_uncertainty_Nm", 0.02],
        ["lever_arm_uncertainty_mm", 0.4], ["load_steps_N", "70; 140,5"],
    ],
    "tools": [
        ["name", "shape", "length_mm", "width_mm", "diameter_mm", "radius_mm"],
        ["piece", "ski", 200, 62], ["disc 100", "disc", None, None, 100], ["roll", "cylinder", None, 80, None, 50],
    ],
    "Plates": [["name", "length_mm"], ["blade", 200]],
}  # fmt: skip


def cells(text: str) -> list[list[Any]]:
    """A table as a spreadsheet has it: numbers as numbers."""

    def cell(word: str) -> str | float:
        try:
            return float(word)
        except ValueError:
            return word

    return [[cell(word) for word in row] for row in csv.reader(io.StringIO(text))]


def test_a_workbook_says_what_the_files_say(small: SmallCampaign, tmp_path: Path) -> None:
    written = small.read()
    workbook = tmp_path / "Hang.xlsx"
    workbook.write_bytes(packed(**DESCRIBED, **{name: cells(small[f"{name}.csv"]) for name in TABLES}))
    found = read_campaign(workbook)
    assert found.problems == written.problems == ()
    described = ("name", "place", "observers", "tools", "plates", "gauge_resolution", "load_uncertainty", "load_steps")
    assert all(getattr(found, name) == getattr(written, name) for name in described)
    assert list(found.file_hashes) == ["Hang.xlsx"]
    ours, theirs = (analyse(each, n_resamples=100, seed=1).results for each in (found, written))
    assert ours["penetration"] == theirs["penetration"]
    assert ours["shear"] == theirs["shear"]


PRESSED = "Hang.xlsx, sheet Penetration"


def test_sheets_beside_files_and_problems_by_sheet_and_row(small: SmallCampaign) -> None:
    rows: list[list[Any]] = [["Versuch", "Ort", "Stempel", "Winkel [°]", "Last [N]", "Tiefe [mm]", "Datum"], []]
    rows.append(["P1", "Süd", "piece", 30.0, 70.5, 1.25, datetime(2026, 11, 23, 9, 10)])
    rows.append(["P1", "Süd", "piece", 30.0, 140.5, "zwei", None])
    headings = ("experiment", "site", "tool", "edge_angle_deg", "load_N", "depth_mm", "time")
    line = "".join(
        f'columns.penetration."{written}" = "{name}"\n' for written, name in zip(rows[0], headings, strict=True)
    )
    for name in ("penetration.csv", "density.csv", "drop_cone.csv"):
        del small[name]
    small["campaign.toml"] = line + small["campaign.toml"]
    (problem,) = small.check({"~$Hang.xlsx": b"open", "Hang.xlsx": packed(Penetration=rows, Diagramm=[["x"]])})
    assert (problem.code, problem.file, problem.row) == ("not_a_number", PRESSED, 4)
    rows[3][5] = 2.5
    campaign = small.read({"Hang.xlsx": packed(Penetration=rows, Diagramm=[["x"]])})
    assert present(campaign.penetration).row.tolist() == [3, 4]
    assert present(campaign.penetration).further["time"][0] == "2026-11-23T09:10:00"
    (flag,) = quality_flags(campaign)
    assert (flag.code, flag.file) == ("too_few_loads", PRESSED)
    assert campaign.unread_files == (PRESSED.replace("Penetration", "Diagramm"),)


def test_what_is_there_twice_is_rejected(small: SmallCampaign) -> None:
    book = packed(density=[["sample"]])
    (problem,) = small.check({"Hang.xlsx": book})
    assert (problem.code, problem.file, problem.value) == ("unreadable_file", "Hang.xlsx, sheet density", "density.csv")


def test_a_sheet_that_looks_like_a_table_is_named(small: SmallCampaign) -> None:
    rows = cells("Versuch,Ort,Platte,Winkel,Tiefe,Hebelarm,Moment\nS1,Süd,blade,90,5,300,12\n")
    del small["shear.csv"]
    (problem,) = small.check({"Hang.xlsx": packed(Scherung=rows)})
    assert (problem.severity, problem.code, problem.value) == ("warning", "unread_sheet", "Scherung")
    assert "looks like shear" in problem.action


def test_a_workbook_that_cannot_be_read_is_a_problem(small: SmallCampaign) -> None:
    (problem,) = small.check({"Hang.xlsx": b"PK\3\4"})
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", "Hang.xlsx")
    assert ".xlsx" in problem.action


# A campaign whose files are at hand is read as one in a folder, and nothing is searched on the disk


def at_hand(files: Mapping[str, str]) -> dict[str, bytes]:
    return {name: text.encode("utf-8") for name, text in files.items()}


def numbers_of(campaign: Campaign) -> dict[str, object]:
    results = results_dict(analyse(campaign, n_resamples=100))
    return {key: value for key, value in results.items() if key != "provenance"} | {
        "files": results["provenance"]["files"]
    }


def test_results_are_those_of_the_folder(small: SmallCampaign) -> None:
    small["notes.txt"] = "wind"
    folder = small.read()
    campaign = campaign_of_files(at_hand(small))
    assert numbers_of(campaign) == numbers_of(folder)
    assert campaign.unread_files == folder.unread_files == ("notes.txt",)
    assert np.array_equal(present(campaign.penetration).load, present(folder.penetration).load)


def test_nothing_is_opened(small: SmallCampaign, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise AssertionError("the disk was asked")

    files = at_hand(small)
    for name in ("stat", "lstat", "scandir", "listdir"):
        monkeypatch.setattr(os, name, refused)
    monkeypatch.setattr(Path, "open", refused)
    assert campaign_of_files(files).name == "north slope"


def test_errors_are_those_of_the_folder(small: SmallCampaign) -> None:
    small.replace("shear.csv", "12.25", "twelve")
    small["Density.csv"] = small.pop("density.csv")
    with pytest.raises(FieldDataError) as told:
        small.read()
    with pytest.raises(FieldDataError) as found:
        campaign_of_files(at_hand(small))
    assert found.value.problems == told.value.problems
    assert len(found.value.problems) == 2


def test_files_that_are_named_alone_are_reported(small: SmallCampaign) -> None:
    campaign = campaign_of_files(at_hand(small), others=("photo.jpg", ".hidden"))
    assert campaign.unread_files == ("photo.jpg",)


# snow_micro_pen.csv and the files that it names: every wrong cell is reported with its row


SOUND = plain_snow(1.0)
HEAD = "recording,site,file\n"


def test_recordings_are_read_in_the_order_of_the_table(small: SmallCampaign) -> None:
    table = "recording,site,spot,file,surface_mm,operator\nb,Süd,a,two.PNT,30.5,X\na,Nord,,one.pnt,,Y\n"
    campaign = small.read({"snow_micro_pen.csv": table, "one.pnt": SOUND, "two.PNT": SOUND, "three.pnt": SOUND})
    found = present(campaign.snow_micro_pen)
    assert (found.recording, found.site, found.spot) == (("b", "a"), ("Süd", "Nord"), ("a", ""))
    assert found.surface[0] == pytest.approx(0.0305)
    assert found.further == {"operator": ("X", "Y")}
    assert len(found.profile(1).force) == 22_500
    assert campaign.unread_files == ("three.pnt",)
    assert {"one.pnt", "two.PNT"} <= set(campaign.file_hashes)
    assert "2 recordings" in repr(found)


@pytest.mark.parametrize(
    ("rows", "row", "column", "words"),
    [
        ("r,Süd,gone.pnt\n", 2, "file", "this name"),
        ("r,Süd,../one.pnt\n", 2, "file", ".PNT"),
        ("r,Süd,notes.txt\n", 2, "file", ".PNT"),
        ("r,Süd,one.pnt\nr,Süd,two.pnt\n", 3, "recording", "row 2"),
        ("r,Süd,one.pnt\nq,Süd,one.pnt\n", 3, "file", "row 2"),
        ("r,,one.pnt\n", 2, "site", "non-empty"),
    ],
)
def test_wrong_cells(small: SmallCampaign, rows: str, row: int, column: str, words: str) -> None:
    further: dict[str, str | bytes] = {"snow_micro_pen.csv": HEAD + rows, "one.pnt": SOUND, "two.pnt": SOUND}
    (problem,) = small.errors(further)
    assert (problem.row, problem.column) == (row, column)
    assert words in problem.allowed


def test_a_damaged_recording_is_reported_with_its_name(small: SmallCampaign) -> None:
    further: dict[str, str | bytes] = {"snow_micro_pen.csv": HEAD + "r7,Süd,one.pnt\n", "one.pnt": SOUND[:5000]}
    (problem,) = small.errors(further)
    assert (problem.file, problem.experiment, problem.code) == ("one.pnt", "r7", "unreadable_file")
    assert "cut off" in problem.action


@pytest.mark.parametrize(
    ("section", "column", "words"),
    [
        ('relation = "proksch"', "snow_micro_pen.relation", "proksch-2015, calonne-2020"),
        ("to_depth_mm = 4", "snow_micro_pen.to_depth_mm", "above from_depth_mm"),
        ("from_depth_mm = -1", "snow_micro_pen.from_depth_mm", "0 or more"),
        ("subtract_air_force = 1", "snow_micro_pen.subtract_air_force", "true or false"),
        ("to_dept_mm = 4", "snow_micro_pen.to_dept_mm", "to_depth_mm"),
    ],
)
def test_wrong_settings(small: SmallCampaign, section: str, column: str, words: str) -> None:
    small["campaign.toml"] += f"\n[snow_micro_pen]\n{section}\n"
    (problem,) = small.errors()
    assert (problem.code, problem.column) == ("bad_toml", column)
    assert words in problem.allowed


def test_texts_of_the_sheets_that_describe_a_campaign() -> None:
    """Units and columns of all tables or of one; a blank row, key, heading or value gives no line."""
    sheets = {
        "columns": [
            ["heading", "column", "unit", "table"], ["Last", "load_N", "kg"], ["", "load_N", "kg"], ["", ""],
            ["Tiefe", "depth_mm", "", "shear"], ["Ort", "", "mm"],
        ],
        "campaign": [
            ["", ""], ["key", "value"], ["name", "12"], ["place", ""], ["", "x"], ["exclude", "creeps; layered ;"],
            ["gauge_resolution_mm", "0,01"], ["load_steps_N", "70;140,5"],
        ],
        "tools": [["name", "shape", "", "length_mm"], ["a", "ski", "x", "200"]],
        "plates": [["name", "length_mm"], ["", "80"]],
    }  # fmt: skip
    assert description_text(sheets).splitlines() == [
        'columns."Last" = "load_N"', 'units."Last" = "kg"', 'columns."shear"."Tiefe" = "depth_mm"',
        'units."Ort" = "mm"', '"name" = "12"', 'screening."exclude" = ["creeps", "layered"]',
        '"gauge_resolution_mm" = 0.01', '"load_steps_N" = [70.0, 140.5]', "[[tool]]", '"name" = "a"', '"shape" = "ski"',
        '"length_mm" = 200.0', "[[plate]]", '"length_mm" = 80.0',
    ]  # fmt: skip
    assert description_text({}) == ""


@pytest.mark.parametrize(("shown", "named"), [(5, True), (4, False)])
def test_a_sheet_is_named_from_six_tenths_of_the_columns_on(small: SmallCampaign, shown: int, named: bool) -> None:
    """Below a title of two cells; density.csv has three required columns, shear.csv seven."""
    del small["shear.csv"]
    head = ["Versuch", "Ort", "Platte", "Winkel", "Tiefe", "Hebelarm", "Moment"][:shown]
    found = small.check({"Hang.xlsx": packed(Blatt=[["Hang", "oben"], head, ["S1", "Süd", "blade", 90, 5][:shown]])})
    places = [(each.code, each.file, each.value) for each in found]
    assert places == ([("unread_sheet", "Hang.xlsx, sheet Blatt", "Blatt")] if named else [])
    assert all("shear" in each.allowed and "tools" in each.allowed for each in found)


def test_a_second_sheet_of_a_table_and_a_damaged_workbook(small: SmallCampaign) -> None:
    rows = cells(small.pop("density.csv"))
    (problem,) = small.check({"Hang.xlsx": packed(density=rows, **{" Density.csv": rows})})
    assert (problem.code, problem.file, problem.value) == (
        "unreadable_file", "Hang.xlsx, sheet  Density.csv", " Density.csv",
    )  # fmt: skip
    (problem,) = small.check({"Hang.xlsx": packed(density=rows), "Hang2.xlsx": b""})
    assert (problem.code, problem.file) == ("unreadable_file", "Hang2.xlsx")


@pytest.mark.parametrize(
    ("name", "read"),
    [("shear.csv", True), ("campaign.toml", True), ("Hang.XLSX", True), ("a.PNT", True), ("w.smet", True),
     ("sub/shear.csv", False), ("sub/a.pnt", False), ("~$Hang.xlsx", False), (".Hang.xlsx", False), ("a.jpg", False)],
)  # fmt: skip
def test_names_of_files_that_a_campaign_reads(name: str, read: bool) -> None:
    assert (name in READ_FILES) is read
