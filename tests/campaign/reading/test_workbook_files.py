"""A workbook as a campaign, or as the tables of one."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

from skisnow.campaign import check_campaign, read_campaign
from skisnow.estimation import analyse, quality_flags

from ...support.user_files.test_workbook import packed

WriteCampaign = Callable[[Mapping[str, str | bytes]], Path]
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


def test_a_workbook_says_what_the_files_say(
    write_campaign: WriteCampaign, small_campaign: dict[str, str], tmp_path: Path
) -> None:
    written = read_campaign(write_campaign(small_campaign))
    workbook = tmp_path / "Hang.xlsx"
    workbook.write_bytes(packed(**DESCRIBED, **{name: cells(small_campaign[f"{name}.csv"]) for name in TABLES}))
    found = read_campaign(workbook)
    assert found.problems == written.problems == ()
    described = ("name", "place", "observers", "tools", "plates", "gauge_resolution", "load_uncertainty", "load_steps")
    assert all(getattr(found, name) == getattr(written, name) for name in described)
    assert list(found.file_hashes) == ["Hang.xlsx"]
    ours, theirs = (analyse(each, n_resamples=100, seed=1).results for each in (found, written))
    assert ours["penetration"] == theirs["penetration"]
    assert ours["shear"] == theirs["shear"]


PRESSED = "Hang.xlsx, sheet Penetration"


def test_sheets_beside_files_and_problems_by_sheet_and_row(
    write_campaign: WriteCampaign, small_campaign: dict[str, str]
) -> None:
    rows: list[list[Any]] = [["Versuch", "Ort", "Stempel", "Winkel [°]", "Last [N]", "Tiefe [mm]", "Datum"], []]
    rows.append(["P1", "Süd", "piece", 30.0, 70.5, 1.25, datetime(2026, 11, 23, 9, 10)])
    rows.append(["P1", "Süd", "piece", 30.0, 140.5, "zwei", None])
    headings = ("experiment", "site", "tool", "edge_angle_deg", "load_N", "depth_mm", "time")
    line = "".join(
        f'columns.penetration."{written}" = "{name}"\n' for written, name in zip(rows[0], headings, strict=True)
    )
    files: dict[str, str | bytes] = {"shear.csv": small_campaign["shear.csv"], "~$Hang.xlsx": b"open"}
    files["campaign.toml"] = line + small_campaign["campaign.toml"]
    files["Hang.xlsx"] = packed(Penetration=rows, Diagramm=[["x"]])
    (problem,) = check_campaign(write_campaign(files))
    assert (problem.code, problem.file, problem.row) == ("not_a_number", PRESSED, 4)
    rows[3][5] = 2.5
    files["Hang.xlsx"] = packed(Penetration=rows, Diagramm=[["x"]])
    campaign = read_campaign(write_campaign(files))
    assert campaign.penetration is not None
    assert campaign.penetration.row.tolist() == [3, 4]
    assert campaign.penetration.further["time"][0] == "2026-11-23T09:10:00"
    (flag,) = quality_flags(campaign)
    assert (flag.code, flag.file) == ("too_few_loads", PRESSED)
    assert campaign.unread_files == (PRESSED.replace("Penetration", "Diagramm"),)


def test_what_is_there_twice_is_refused(write_campaign: WriteCampaign, small_campaign: dict[str, str]) -> None:
    book = packed(density=[["sample"]])
    (problem,) = check_campaign(write_campaign({**small_campaign, "Hang.xlsx": book}))
    assert (problem.code, problem.file, problem.value) == ("unreadable_file", "Hang.xlsx, sheet density", "density.csv")


def test_a_sheet_that_looks_like_a_table_is_named(
    write_campaign: WriteCampaign, small_campaign: dict[str, str]
) -> None:
    rows = cells("Versuch,Ort,Platte,Winkel,Tiefe,Hebelarm,Moment\nS1,Süd,blade,90,5,300,12\n")
    files: dict[str, str | bytes] = {**small_campaign, "Hang.xlsx": packed(Scherung=rows)}
    del files["shear.csv"]
    (problem,) = check_campaign(write_campaign(files))
    assert (problem.severity, problem.code, problem.value) == ("warning", "unread_sheet", "Scherung")
    assert "looks like shear" in problem.action


def test_a_workbook_that_cannot_be_read_is_a_problem(
    write_campaign: WriteCampaign, small_campaign: dict[str, str]
) -> None:
    (problem,) = check_campaign(write_campaign({**small_campaign, "Hang.xlsx": b"PK\3\4"}))
    assert (problem.severity, problem.code, problem.file) == ("error", "unreadable_file", "Hang.xlsx")
    assert ".xlsx" in problem.action
