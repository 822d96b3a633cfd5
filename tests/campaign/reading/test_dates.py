"""Days that are read, and days that are reported."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from skisnow.campaign import check_campaign, read_campaign
from skisnow.campaign.reading.columns import iso_moment


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("23.11.2026", "2026-11-23"),
        ("3. 4. 26 7:05", "2026-04-03T07:05:00"),
        ("23.11.2026 um 14:30 Uhr", "2026-11-23T14:30:00"),
        ("23/11/2026 14:30:15", "2026-11-23T14:30:15"),
        ("4/4/2026", "2026-04-04"),
        ("2026-11-23T09:10:00Z", "2026-11-23T09:10:00Z"),
        ("9:05", "9:05"),
    ],
)
def test_days_that_are_read(cell: str, written: str) -> None:
    assert iso_moment(cell) == written


@pytest.mark.parametrize(
    "cell", ["3/4/2026", "32.1.2026", "23.13.2026", "23.11.2026 25:00", "46000", "2026", "Montag", "25:10"]
)
def test_days_that_are_none_or_could_be_two(cell: str) -> None:
    assert iso_moment(cell) is None


def test_a_day_that_cannot_be_read_is_one_warning_and_stays(
    write_campaign: Callable[[Mapping[str, str | bytes]], Path], small_campaign: dict[str, str]
) -> None:
    table = "sample,site,snow_density_kg_per_m3,time\nD1,Süd,410,1.2.2026\nD2,Süd,400,gestern\nD3,Nord,390,3/4/2026\n"
    folder = write_campaign({**small_campaign, "density.csv": table})
    (problem,) = check_campaign(folder)
    found = (problem.severity, problem.code, problem.row, problem.column, problem.experiment)
    assert problem.value is not None and problem.value.startswith("gestern, ")
    assert found == ("warning", "unreadable_date", 3, "time", "D2")
    density = read_campaign(folder).density
    assert density is not None
    assert density.further["time"] == ("2026-02-01", "gestern", "3/4/2026")
