"""A station's readings at the times of the experiments."""

from __future__ import annotations

import math
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import skisnow
from skisnow._support.errors import FieldDataError
from skisnow.campaign import Problem
from skisnow.cli.schema import json_schema
from skisnow.interop.snowex import site_pit

from .conftest import MakeCampaign

SMET = """SMET 1.1 ASCII
[HEADER]
station_id = S
nodata = -999
tz = 0
fields = timestamp TA RH
[DATA]
2026-02-03T08:00 263.15 0.5
2026-02-03T10:00 267.15 0.7
"""
SECTION = '\n[weather]\nfile = "s.smet"\nutc_offset_h = 1\n'


def campaign(make: MakeCampaign, extra: str = SECTION, name: str = "s.smet") -> Path:
    times = {"p1": "2026-02-03T10:00", "p2": "2026-02-03T09:00Z", "p3": "2026-02-03", "p4": "2026-02-03T23:00"}
    rows = [
        (each, "A" if each < "p3" else "B", "disc", 0, load, load / 100, time if load == 200 else "")
        for each, time in times.items()
        for load in (100, 200, 300)
    ]
    shear = [("s1", "B", "blade", 90, 5, 300, 12, "2026-02-03T11:00:00")]
    folder = make(rows, shear, columns=",time", shear_columns=",time").folder
    (folder / name).write_text(SMET)
    (folder / "campaign.toml").write_text((folder / "campaign.toml").read_text() + extra)
    return folder


def test_conditions_at_the_time_of_each_experiment(make_campaign: MakeCampaign) -> None:
    """10:00 an hour ahead of UTC is 9:00 UTC, as p2 says by itself: -8 °C, 60 %. 11:00 is the last reading."""
    analysis = skisnow.analyse(campaign(make_campaign), n_resamples=100)
    section = analysis.results["weather"]
    schema = json_schema("results")
    jsonschema.validate(analysis.results, schema)
    rows = {row["experiment"]: row for row in section["experiments"]}
    air = {name: row["air_temperature_C"] for name, row in rows.items()}
    assert air == {
        "p1": pytest.approx(-8.0), "p2": pytest.approx(-8.0), "p3": None, "p4": None, "s1": pytest.approx(-6.0),
    }  # fmt: skip
    assert rows["p1"]["relative_humidity_percent"] == pytest.approx(60.0)
    assert rows["p1"]["wind_speed_m_per_s"] is None
    assert [(row["site"], row["n"]) for row in section["sites"]] == [("A", 2), ("B", 1)]
    assert section["sites"][0]["air_temperature_C"] == pytest.approx(-8.0)
    assert site_pit(analysis, "A").air_temperature_C == pytest.approx(-8.0)
    assert "s.smet" in analysis.campaign.file_hashes
    assert "3 of 5 experiments" in repr(analysis.weather)


def test_a_gap_that_is_too_long_leaves_it_open(make_campaign: MakeCampaign) -> None:
    analysis = skisnow.analyse(campaign(make_campaign, SECTION + "longest_gap_h = 1.5\n"), n_resamples=100)
    assert analysis.weather is not None
    nan = math.nan
    np.testing.assert_allclose(analysis.weather.quantities["air_temperature_C"], [nan, nan, nan, nan, -6.0])


def test_without_the_section_nothing_is_said(make_campaign: MakeCampaign) -> None:
    analysis = skisnow.analyse(campaign(make_campaign, ""), n_resamples=100)
    assert analysis.weather is None
    assert "weather" not in analysis.results
    assert analysis.campaign.unread_files == ("s.smet",)


def refused_cells(folder: Path) -> list[tuple[str | None, str | None]]:
    """Column and value of each problem of a campaign that cannot be read."""
    with pytest.raises(FieldDataError) as caught:
        skisnow.read_campaign(folder)
    return [(problem.column, problem.value) for problem in caught.value.problems if isinstance(problem, Problem)]


@pytest.mark.parametrize(
    ("lines", "column", "value"),
    [
        ('file = "gone.smet"', "file", "gone.smet"),
        ('file = "../s.smet"', "file", "../s.smet"),
        ('file = "s.smet"\nutc_offset_h = 15', "utc_offset_h", "15"),
        ("longest_gap = 2", "longest_gap", "longest_gap"),
    ],
)
def test_a_wrong_section_refuses_the_campaign(make_campaign: MakeCampaign, lines: str, column: str, value: str) -> None:
    assert (f"weather.{column}", value) in refused_cells(campaign(make_campaign, f"\n[weather]\n{lines}\n"))


def test_a_damaged_file_refuses_the_campaign(make_campaign: MakeCampaign) -> None:
    folder = campaign(make_campaign)
    (folder / "s.smet").write_text(SMET.replace("0.7", "wet"))
    assert refused_cells(folder) == [("RH", "wet")]


@pytest.mark.usefixtures("undrawn")
def test_the_report_has_a_table(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    analysis = skisnow.analyse(campaign(make_campaign), n_resamples=100)
    skisnow.write_report(analysis, tmp_path / "out")
    assert "by the station S" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert (tmp_path / "out" / "tables" / "weather.csv").exists()
