"""Shear experiments of several rows: one moment for each turning angle."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from skisnow.campaign import check_campaign, read_campaign

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
    tests = campaign.shear
    assert tests is not None
    assert tests.experiment == ("S1", "S2", "S3")
    assert tests.moment.tolist() == [30.0, 20.0, 22.0]
    assert tests.row.tolist() == [3, 5, 6]
    assert tests.turning is not None
    assert tests.turning.first.tolist() == [0, 3, 3, 4]
    assert tests.turning.moment.tolist() == [10.0, 30.0, 25.0, 22.0]
    np.testing.assert_allclose(np.degrees(tests.turning.turning_angle), [0.1, 0.3, 0.5, 1.5])
    assert tests.turning.test_of_reading.tolist() == [0, 0, 0, 2]
    assert "2 experiments, 4 readings" in repr(tests.turning)
    assert campaign.pole_stiffness == pytest.approx(90 / math.radians(1.0))


def test_without_angles_each_row_is_an_experiment(tmp_path: Path) -> None:
    tests = read_campaign(written(tmp_path, *(row.rpartition(",")[0] for row in ALONE), head=HEAD)).shear
    assert tests is not None
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
def test_what_belongs_to_two_experiments_is_refused(rows: list[str], row: int, column: str, tmp_path: Path) -> None:
    found = [each for each in check_campaign(written(tmp_path, *rows)) if each.severity == "error"]
    assert [(each.code, each.row, each.column) for each in found] == [("mixed_experiment", row, column)]
