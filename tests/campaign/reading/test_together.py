"""Files that belong to one campaign: branches of a series, and tables read together."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from tests.present import present

from skisnow.campaign import check_campaign, read_campaign
from skisnow.campaign.problems import Problem

from ..conftest import SmallCampaign

Where = tuple[str, str, int | None, str | None, str | None, str | None]

PEN, SHEAR, DENSITY, CONE = "penetration.csv", "shear.csv", "density.csv", "drop_cone.csv"


def where(problem: Problem) -> Where:
    return (problem.code, problem.file, problem.row, problem.column, problem.experiment, problem.value)


CHANGES: list[tuple[str, str, str, list[Where]]] = [
    (PEN, "piece,30,140", "piece,35,140", [("mixed_experiment", PEN, 3, "edge_angle_deg", "P1", "35")]),
    (PEN, "Süd,piece,30,140", "Nord,piece,30,140", [("mixed_experiment", PEN, 3, "site", "P1", "Nord")]),
    (PEN, "P2,Nord,disc 100,0,140", "P2,Nord,roll,0,140", [("mixed_experiment", PEN, 6, "tool", "P2", "roll")]),
    (PEN, "210.5,3.75,a", "210.5,3.75,b", [("mixed_experiment", PEN, 4, "spot", "P1", "b")]),
    (PEN, "210.5,3.75,a", "210.5,3.75,", []),
    (PEN, "piece,30,140", "piece,30.0,140", []),
    (SHEAR, "S2", "S1", [("mixed_experiment", SHEAR, 3, "experiment", "S1", "S1")]),
    (CONE, "C2,Süd", "C1,Nord", [("mixed_experiment", CONE, 4, "site", "C1", "Nord")]),
    (PEN, "disc 100,0,140", "disc 100,5,140", [
        ("mixed_experiment", PEN, 6, "edge_angle_deg", "P2", "5"),
        ("out_of_range", PEN, 6, "edge_angle_deg", "P2", "5"),
    ]),
    (SHEAR, "Nord,blade", "Nord,spade", [("unknown_plate", SHEAR, 3, "plate", "S2", "spade")]),
]  # fmt: skip


@pytest.mark.parametrize(("file", "old", "new", "expected"), CHANGES)
def test_rows_that_disagree(small: SmallCampaign, file: str, old: str, new: str, expected: list[Where]) -> None:
    assert small[file].count(old) == 1
    small.replace(file, old, new)
    assert [where(problem) for problem in small.check()] == expected


def test_an_experiment_that_is_reported_in_two_places(small: SmallCampaign) -> None:
    small[PEN] += "P1,Süd,piece,30,280.5,5,a,,,\n"
    (problem,) = small.check()
    assert where(problem) == ("mixed_experiment", PEN, 7, "experiment", "P1", "P1")
    assert "row 2" in problem.allowed


def test_the_spot_may_be_in_any_row_and_samples_of_one_name_are_fine(small: SmallCampaign) -> None:
    small[PEN] = small[PEN].replace("1.25,a", "1.25,").replace("3.75,a", "3.75,")
    tests = present(small.read().penetration)
    assert tests.spot == ("a", "")
    small.replace(DENSITY, "D2", "D1")
    assert small.check() == ()


def test_unknown_tool_is_reported_once_in_each_experiment(small: SmallCampaign) -> None:
    small[PEN] = small[PEN].replace("piece", "Piece").replace("disc 100", "disc")
    problems = small.check()
    assert [where(problem) for problem in problems] == [
        ("unknown_tool", PEN, 2, "tool", "P1", "Piece"),
        ("unknown_tool", PEN, 5, "tool", "P2", "disc"),
    ]
    assert "disc 100, piece, roll" in problems[0].allowed


def test_unknown_tool_of_two_experiments(small: SmallCampaign) -> None:
    table = small[PEN].replace("piece", "Piece").replace("disc 100", "Piece")
    small[PEN] = table.replace("P2,Nord,Piece,0", "P2,Nord,Piece,30")
    unknown = [problem for problem in small.check() if problem.code == "unknown_tool"]
    assert [(problem.experiment, problem.row) for problem in unknown] == [("P1", 2), ("P2", 5)]


@pytest.mark.parametrize("tool", ["disc 100", "roll"])
def test_tools_without_an_edge_lie_flat(small: SmallCampaign, tool: str) -> None:
    small.replace(PEN, "disc 100,0", f"{tool},10")
    problems = small.check()
    assert [where(problem) for problem in problems] == [("out_of_range", PEN, 5, "edge_angle_deg", "P2", "10")]


STEEP = ("angle_above_60", PEN, 2, "edge_angle_deg", "P1")
RADIANS = ("angles_look_like_radians", PEN, None, "edge_angle_deg", None)


@pytest.mark.parametrize(
    ("angle", "warnings"),
    [
        ("60", []),
        ("60.5", [(*STEEP, "60.5")]),
        ("89.9", [(*STEEP, "89.9")]),
        ("1.6", []),
        ("1.5708", [(*RADIANS, "1.5708 to 1.5708")]),
        ("0.5236", [(*RADIANS, "0.5236 to 0.5236")]),
        ("0", []),
    ],
)
def test_angles_above_60_degrees_or_like_radians_are_warned_of(
    small: SmallCampaign, angle: str, warnings: list[tuple[object, ...]]
) -> None:
    small.replace(PEN, "piece,30", f"piece,{angle}")
    problems = small.check()
    assert [where(problem) for problem in problems] == warnings
    assert all(problem.severity == "warning" for problem in problems)


def test_angles_like_radians_are_quoted_from_the_smallest(small: SmallCampaign) -> None:
    small.replace(SHEAR, "blade,90", "blade,1.2")
    small.replace(SHEAR, "blade,45", "blade,0.5")
    (problem,) = small.check()
    assert where(problem) == ("angles_look_like_radians", SHEAR, None, "edge_angle_deg", None, "0.5 to 1.2")


def test_each_steep_experiment_is_reported_once(small: SmallCampaign) -> None:
    small[PEN] = small[PEN].replace("piece,30", "piece,75").replace("disc 100,0", "piece,80")
    assert [where(problem) for problem in small.check()] == [
        ("angle_above_60", PEN, 2, "edge_angle_deg", "P1", "75"),
        ("angle_above_60", PEN, 5, "edge_angle_deg", "P2", "80"),
    ]


# Shear experiments of several rows: one moment for each turning angle


TOML = 'pole_stiffness_Nm_per_deg = 90\n[[plate]]\nname = "blade"\nlength_mm = 100\n'
HEAD = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm"
TURNED = ["S1,A,blade,90,5,250,10,0.1", "S1,A,blade,90,5,250,30,0.3", "S1,A,blade,90,5,250,25,0.5"]
ALONE = ["S2,A,blade,60,6,240,20,", "S3,A,blade,60,6,240,22,1.5"]


def written(folder: Path, *rows: str, head: str = HEAD + ",turning_angle_deg") -> Path:
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    (folder / "shear.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return folder


def test_the_row_of_the_largest_moment_is_the_experiment(tmp_path: Path) -> None:
    campaign = read_campaign(written(tmp_path, *TURNED, *ALONE))
    tests = present(campaign.shear)
    assert tests.experiment == ("S1", "S2", "S3")
    assert tests.moment.tolist() == [30.0, 20.0, 22.0]
    assert tests.row.tolist() == [3, 5, 6]
    assert tests.turning is not None
    assert tests.turning.first.tolist() == [0, 3, 3, 4]
    assert tests.turning.moment.tolist() == [10.0, 30.0, 25.0, 22.0]
    np.testing.assert_allclose(np.degrees(tests.turning.turning_angle), [0.1, 0.3, 0.5, 1.5])
    assert tests.turning.series_of_reading.tolist() == [0, 0, 0, 2]
    assert re.search(r"moment +4: 10 to 30", repr(tests.turning))
    assert campaign.pole_stiffness == pytest.approx(90 / math.radians(1.0))


def test_without_angles_each_row_is_an_experiment(tmp_path: Path) -> None:
    tests = present(read_campaign(written(tmp_path, *(row.rpartition(",")[0] for row in ALONE), head=HEAD)).shear)
    assert tests.turning is None
    assert len(tests) == 2


@pytest.mark.parametrize(
    ("rows", "row", "column"),
    [
        ([TURNED[0], TURNED[1].replace(",5,", ",6,")], 3, "depth_mm"),
        ([TURNED[0], TURNED[1].replace("250", "240")], 3, "lever_arm_mm"),
        ([TURNED[0], TURNED[1].replace(",90,", ",80,")], 3, "edge_angle_deg"),
        ([TURNED[0], TURNED[1].rpartition(",")[0] + ","], 3, "experiment"),
        ([*TURNED, *ALONE, TURNED[2]], 7, "experiment"),
        ([ALONE[0], ALONE[0]], 3, "experiment"),
    ],
)
def test_what_belongs_to_two_experiments_is_rejected(rows: list[str], row: int, column: str, tmp_path: Path) -> None:
    found = [each for each in check_campaign(written(tmp_path, *rows)) if each.severity == "error"]
    assert [(each.code, each.row, each.column) for each in found] == [("mixed_experiment", row, column)]


UNLOADED_TOML = '[[tool]]\nname = "ski"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
UNLOADED_HEAD = "experiment,site,tool,edge_angle_deg,load_N,depth_mm,time,branch\n"


def written_unloaded(folder: Path, *rows: tuple[str, float, float, str]) -> Path:
    (folder / "campaign.toml").write_text(UNLOADED_TOML, encoding="utf-8")
    lines = (f"{name},A,ski,45,{load:g},{depth:g},t{load:g}{branch[:1]},{branch}" for name, load, depth, branch in rows)
    (folder / "penetration.csv").write_text(UNLOADED_HEAD + "".join(f"{line}\n" for line in lines), encoding="utf-8")
    return folder


def errors(folder: Path) -> list[Problem]:
    return [problem for problem in check_campaign(folder) if problem.severity == "error"]


UP = [("P1", 10, 1.0, "loading"), ("P1", 20, 2.0, ""), ("P1", 30, 3.0, "Loading")]
DOWN = [("P1", 20, 2.9, "unloading"), ("P1", 10, 2.7, " UNLOADING ")]
OTHER = [("P2", 10, 1.0, ""), ("P2", 30, 3.5, ""), ("P2", 10, 3.1, "unloading")]


def test_both_branches_stand_apart_with_their_rows(tmp_path: Path) -> None:
    tests = present(read_campaign(written_unloaded(tmp_path, *UP, *DOWN, *OTHER)).penetration)
    assert tests.first.tolist() == [0, 3, 5]
    assert tests.row.tolist() == [2, 3, 4, 7, 8]
    np.testing.assert_allclose(tests.penetration_depth, np.array([1.0, 2.0, 3.0, 1.0, 3.5]) * 1e-3)
    assert tests.further["time"] == ("t10l", "t20", "t30L", "t10", "t30")
    back = present(tests.unloading)
    assert back.first.tolist() == [0, 2, 3]
    assert back.row.tolist() == [5, 6, 9]
    assert back.load.tolist() == [20.0, 10.0, 10.0]
    assert back.series_of_reading.tolist() == [0, 0, 1]
    np.testing.assert_allclose(back.penetration_depth, np.array([2.9, 2.7, 3.1]) * 1e-3)
    assert re.search(r"load +3: 10 to 20", repr(back))


def test_a_depth_read_once_more_stands_beside_its_reading(tmp_path: Path) -> None:
    folder = written_unloaded(tmp_path, *UP, *DOWN)
    lines = (folder / "penetration.csv").read_text("utf-8").splitlines()
    cells = ["depth_after_mm", "", "2.05", "", "9", ""]
    text = "\n".join(f"{line},{cell}" for line, cell in zip(lines, cells, strict=True))
    (folder / "penetration.csv").write_text(text + "\n", encoding="utf-8")
    tests = present(read_campaign(folder).penetration)
    np.testing.assert_allclose(present(tests.depth_after), [np.nan, 2.05e-3, np.nan])


def test_without_unloading_there_is_none(tmp_path: Path) -> None:
    tests = present(read_campaign(written_unloaded(tmp_path, *UP)).penetration)
    assert tests.unloading is None


@pytest.mark.parametrize(
    ("rows", "code", "row", "told"),
    [
        ([*UP, ("P1", 20, 2.9, "down")], "out_of_range", 5, "unloading"),
        ([*UP, *DOWN, ("P1", 40, 4.0, "loading")], "branch_order", 7, "unloading: a row"),
        ([*OTHER, ("P3", 20, 2.9, "unloading")], "branch_order", 5, "first load"),
    ],
)
def test_impossible_input_is_rejected_with_its_row(
    rows: list[tuple[str, float, float, str]], code: str, row: int, told: str, tmp_path: Path
) -> None:
    (found,) = errors(written_unloaded(tmp_path, *rows))
    assert (found.code, found.row, found.column, found.file) == (code, row, "branch", "penetration.csv")
    assert told in present(found.allowed)
    assert "another experiment" in found.action
