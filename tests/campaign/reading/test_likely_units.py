"""Campaigns in a wrong unit are warned of, those of the paper's sizes are not; a row pasted twice is reported."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from skisnow import analyse, results_dict, write_reference
from skisnow.campaign import Problem, check_campaign, read_campaign

TABLES = ("penetration.csv", "shear.csv", "density.csv", "drop_cone.csv")


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("units") / "reference"
    write_reference(folder, seed=1)
    return folder


def changed(reference: Path, target: Path, file: str, change: Callable[[dict[str, str], int], None]) -> Path:
    """A copy of the reference campaign with each row of one file changed in place; rows count from 0."""
    target.mkdir()
    for name in ("campaign.toml", *TABLES):
        lines = (reference / name).read_text(encoding="utf-8").splitlines()
        if name == file:
            head = lines[0].split(",")
            for index, line in enumerate(lines[1:]):
                cells = dict(zip(head, line.split(","), strict=True))
                change(cells, index)
                lines[index + 1] = ",".join(cells.values())
        (target / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return target


def times(column: str, factor: float, only: int | None = None) -> Callable[[dict[str, str], int], None]:
    def change(cells: dict[str, str], index: int) -> None:
        if only is None or index == only:
            cells[column] = f"{float(cells[column]) * factor:.10g}"

    return change


def warned(folder: Path) -> list[Problem]:
    return [problem for problem in check_campaign(folder) if problem.code in ("unlikely_unit", "repeated_row")]


def test_the_reference_campaign_is_not_warned_of(reference: Path) -> None:
    assert check_campaign(reference) == ()


@pytest.mark.parametrize(
    ("file", "column", "factor", "unit"),
    [
        ("penetration.csv", "load_N", 1e-3, "kN"),
        ("penetration.csv", "load_N", 1e3, "mN"),
        ("penetration.csv", "depth_mm", 1e-3, "m"),
        ("penetration.csv", "depth_mm", 1e3, "µm"),
        ("shear.csv", "lever_arm_mm", 1e-3, "m"),
        ("shear.csv", "lever_arm_mm", 0.1, "cm"),
        ("shear.csv", "moment_Nm", 1e3, "N mm"),
        ("shear.csv", "moment_Nm", 1e-3, "kN m"),
        ("shear.csv", "depth_mm", 1e-3, "m"),
        ("density.csv", "snow_density_kg_per_m3", 1e-3, "g/cm³"),
        ("drop_cone.csv", "drop_cone_depth_mm", 1e-3, "m"),
    ],
)
def test_a_file_in_another_unit(
    reference: Path, tmp_path: Path, file: str, column: str, factor: float, unit: str
) -> None:
    (found,) = warned(changed(reference, tmp_path / "c", file, times(column, factor)))
    assert (found.severity, found.code, found.file, found.column) == ("warning", "unlikely_unit", file, column)
    assert unit in found.action


@pytest.mark.parametrize(
    ("file", "column", "factor"),
    [
        ("penetration.csv", "load_N", 1e-3),
        ("shear.csv", "lever_arm_mm", 1e-3),
        ("shear.csv", "moment_Nm", 1e3),
        ("density.csv", "snow_density_kg_per_m3", 1e-3),
    ],
)
def test_one_row_in_another_unit(reference: Path, tmp_path: Path, file: str, column: str, factor: float) -> None:
    (found,) = warned(changed(reference, tmp_path / "c", file, times(column, factor, only=3)))
    assert (found.code, found.file, found.row, found.column) == ("unlikely_unit", file, 5, column)


def test_lengths_of_campaign_toml_in_metres(reference: Path, tmp_path: Path) -> None:
    folder = changed(reference, tmp_path / "c", "", times("", 1.0))
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    metres = text.replace("width_mm = 62", "width_mm = 0.062").replace(
        "gauge_resolution_mm = 0.01", "gauge_resolution_mm = 1e-5"
    )
    assert metres != text
    (folder / "campaign.toml").write_text(metres, encoding="utf-8")
    assert {problem.column for problem in warned(folder)} == {"gauge_resolution_mm", "tool[1].width_mm"}


def test_a_warning_of_units_stands_in_the_results(reference: Path, tmp_path: Path) -> None:
    folder = changed(reference, tmp_path / "c", "shear.csv", times("lever_arm_mm", 1e-3))
    (folder / "penetration.csv").unlink()
    (told,) = results_dict(analyse(read_campaign(folder), n_resamples=100))["campaign"]["warnings"]
    assert told["code"] == "unlikely_unit"


@pytest.mark.parametrize("file", ["density.csv", "drop_cone.csv"])
def test_a_row_pasted_twice(reference: Path, tmp_path: Path, file: str) -> None:
    folder = changed(reference, tmp_path / "c", "", times("", 1.0))
    lines = (folder / file).read_text(encoding="utf-8").splitlines()
    (folder / file).write_text("\n".join([*lines, lines[2], lines[2]]) + "\n", encoding="utf-8")
    found = warned(folder)
    assert [(each.code, each.file, each.row, str(each.value)[-5:]) for each in found] == [
        ("repeated_row", file, len(lines) + 1, "row 3"),
        ("repeated_row", file, len(lines) + 2, "row 3"),
    ]
