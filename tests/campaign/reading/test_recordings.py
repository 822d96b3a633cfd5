"""snow_micro_pen.csv and the files that it names: every wrong cell is reported with its row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from skisnow.campaign import check_campaign, read_campaign

from ..recordings import plain_snow

Write = Callable[[Mapping[str, str | bytes]], Path]
SOUND = plain_snow(1.0)
HEAD = "recording,site,file\n"


def test_recordings_are_read_in_the_order_of_the_table(small_campaign: dict[str, str], write_campaign: Write) -> None:
    table = "recording,site,spot,file,surface_mm,operator\nb,Süd,a,two.PNT,30.5,X\na,Nord,,one.pnt,,Y\n"
    folder = write_campaign(
        small_campaign | {"snow_micro_pen.csv": table, "one.pnt": SOUND, "two.PNT": SOUND, "three.pnt": SOUND}
    )
    campaign = read_campaign(folder)
    found = campaign.snow_micro_pen
    assert found is not None
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
def test_wrong_cells(
    small_campaign: dict[str, str], write_campaign: Write, rows: str, row: int, column: str, words: str
) -> None:
    further: dict[str, str | bytes] = {"snow_micro_pen.csv": HEAD + rows, "one.pnt": SOUND, "two.pnt": SOUND}
    problems = check_campaign(write_campaign({**small_campaign, **further}))
    (problem,) = [each for each in problems if each.severity == "error"]
    assert (problem.row, problem.column) == (row, column)
    assert words in problem.allowed


def test_a_damaged_recording_is_told_with_its_name(small_campaign: dict[str, str], write_campaign: Write) -> None:
    further: dict[str, str | bytes] = {"snow_micro_pen.csv": HEAD + "r7,Süd,one.pnt\n", "one.pnt": SOUND[:5000]}
    (problem,) = [
        each for each in check_campaign(write_campaign({**small_campaign, **further})) if each.severity == "error"
    ]
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
def test_wrong_settings(
    small_campaign: dict[str, str], write_campaign: Write, section: str, column: str, words: str
) -> None:
    small_campaign["campaign.toml"] += f"\n[snow_micro_pen]\n{section}\n"
    (problem,) = [each for each in check_campaign(write_campaign(small_campaign)) if each.severity == "error"]
    assert (problem.code, problem.column) == ("bad_toml", column)
    assert words in problem.allowed
