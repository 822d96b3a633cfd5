"""The column `branch`: what was read while discs were taken off stands apart, and what cannot be is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from skisnow.campaign import check_campaign, read_campaign
from skisnow.campaign.problems import Problem

TOML = '[[tool]]\nname = "ski"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
HEAD = "experiment,site,tool,edge_angle_deg,load_N,depth_mm,time,branch\n"


def written(folder: Path, *rows: tuple[str, float, float, str]) -> Path:
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    lines = (f"{name},A,ski,45,{load:g},{depth:g},t{load:g}{branch[:1]},{branch}" for name, load, depth, branch in rows)
    (folder / "penetration.csv").write_text(HEAD + "".join(f"{line}\n" for line in lines), encoding="utf-8")
    return folder


def errors(folder: Path) -> list[Problem]:
    return [problem for problem in check_campaign(folder) if problem.severity == "error"]


UP = [("P1", 10, 1.0, "loading"), ("P1", 20, 2.0, ""), ("P1", 30, 3.0, "Loading")]
DOWN = [("P1", 20, 2.9, "unloading"), ("P1", 10, 2.7, " UNLOADING ")]
OTHER = [("P2", 10, 1.0, ""), ("P2", 30, 3.5, ""), ("P2", 10, 3.1, "unloading")]


def test_both_branches_stand_apart_with_their_rows(tmp_path: Path) -> None:
    tests = read_campaign(written(tmp_path, *UP, *DOWN, *OTHER)).penetration
    assert tests is not None
    assert tests.unloading is not None
    assert tests.first.tolist() == [0, 3, 5]
    assert tests.row.tolist() == [2, 3, 4, 7, 8]
    np.testing.assert_allclose(tests.penetration_depth, np.array([1.0, 2.0, 3.0, 1.0, 3.5]) * 1e-3)
    assert tests.further["time"] == ("t10l", "t20", "t30L", "t10", "t30")
    back = tests.unloading
    assert back.first.tolist() == [0, 2, 3]
    assert back.row.tolist() == [5, 6, 9]
    assert back.load.tolist() == [20.0, 10.0, 10.0]
    assert back.series_of_reading.tolist() == [0, 0, 1]
    np.testing.assert_allclose(back.penetration_depth, np.array([2.9, 2.7, 3.1]) * 1e-3)
    assert "2 experiments, 3 readings" in repr(back)


def test_a_depth_read_once_more_stands_beside_its_reading(tmp_path: Path) -> None:
    folder = written(tmp_path, *UP, *DOWN)
    lines = (folder / "penetration.csv").read_text("utf-8").splitlines()
    cells = ["depth_after_mm", "", "2.05", "", "9", ""]
    text = "\n".join(f"{line},{cell}" for line, cell in zip(lines, cells, strict=True))
    (folder / "penetration.csv").write_text(text + "\n", encoding="utf-8")
    tests = read_campaign(folder).penetration
    assert tests is not None
    assert tests.depth_after is not None
    np.testing.assert_allclose(tests.depth_after, [np.nan, 2.05e-3, np.nan])


def test_without_unloading_there_is_none(tmp_path: Path) -> None:
    tests = read_campaign(written(tmp_path, *UP)).penetration
    assert tests is not None
    assert tests.unloading is None


@pytest.mark.parametrize(
    ("rows", "code", "row", "told"),
    [
        ([*UP, ("P1", 20, 2.9, "down")], "out_of_range", 5, "unloading"),
        ([*UP, *DOWN, ("P1", 40, 4.0, "loading")], "branch_order", 7, "unloading: a row"),
        ([*OTHER, ("P3", 20, 2.9, "unloading")], "branch_order", 5, "first load"),
    ],
)
def test_what_cannot_be_is_refused_with_its_row(
    rows: list[tuple[str, float, float, str]], code: str, row: int, told: str, tmp_path: Path
) -> None:
    (found,) = errors(written(tmp_path, *rows))
    assert (found.code, found.row, found.column, found.file) == (code, row, "branch", "penetration.csv")
    assert found.allowed is not None
    assert told in found.allowed
    assert "another experiment" in found.action
