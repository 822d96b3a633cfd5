"""The weather at each experiment: times, offsets, units, means of sites."""

import math

import pytest

from skisnow.estimation.weather import weather_at_tests, weather_results

from .conftest import MakeCampaign

STATION = """SMET 1.1 ASCII
[HEADER]
station_id = X1
latitude = 46.8
longitude = 9.8
altitude = 2540
nodata = -999
tz = 1
units_offset = 0 273.15 0 0 273.15 0
units_multiplier = 1 1 0.01 1 1 1
fields = timestamp TA RH VW TSS ISWR
[DATA]
2026-02-03T08:00 -4.0 80 3.5 -9.0 100
2026-02-03T10:00 -2.0 60 4.5 -5.0 300
2026-02-03T14:00 +2.0 40 9.5 -1.0 500
"""
NINE = {
    "air_temperature_C": -3.0,
    "relative_humidity_percent": 70.0,
    "wind_speed_m_per_s": 4.0,
    "snow_surface_temperature_C": -7.0,
    "incoming_short_wave_W_per_m2": 200.0,
}
PENETRATION = [
    ("P1", "A", "ski", 30, 100, 1.0, ""),
    ("P1", "A", "ski", 30, 200, 2.0, "2026-02-03T09:00"),
    ("P2", "A", "ski", 30, 100, 1.0, "2026-02-03 09:30+01:00"),
    ("P2", "A", "ski", 30, 200, 2.0, "2026-02-03T10:00"),
    ("P3", "C", "ski", 30, 100, 1.0, "2026-02-03T12:00"),  # 4 h lie between the readings around it
]
SHEAR = [("S1", "B", "blade", 30, 5, 300, 10, "2026-02-03T08:00Z"), ("S2", "B", "blade", 30, 5, 300, 10, "2026-02-03")]


def test_each_experiment_has_the_weather_at_its_first_time_with_a_day_and_an_hour(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(
        PENETRATION, SHEAR, columns=",time", shear_columns=",time", further={"station.smet": STATION},
        extra='[weather]\nfile = "station.smet"\n',
    )  # fmt: skip
    found = weather_at_tests(campaign)
    assert found is not None
    assert campaign.weather is not None
    assert found.kind == ("penetration",) * 3 + ("shear",) * 2
    assert (found.experiment, found.site) == (("P1", "P2", "P3", "S1", "S2"), tuple("AACBB"))
    assert found.time[0] == "2026-02-03T09:00"
    assert found.quantities.keys() == NINE.keys()
    for key, nine in NINE.items():
        first, second, between, in_utc, day_alone = found.quantities[key].tolist()
        assert (first, in_utc) == pytest.approx((nine, nine), rel=1e-9)
        assert math.isnan(between)
        assert math.isnan(day_alone)
        assert second != first
    assert "3 of 5" in repr(found)
    results = weather_results(campaign.weather, found)
    assert (results["station"], results["altitude_m"], results["utc_offset_h"]) == ("X1", 2540.0, 1.0)
    assert (results["latitude_deg"], results["longitude_deg"], results["longest_gap_h"]) == (46.8, 9.8, 3.0)
    rows = {row["site"]: row for row in results["sites"]}
    for row in (results["experiments"][3], rows["B"]):
        assert {key: row[key] for key in NINE} == pytest.approx(NINE, rel=1e-9)
    assert [(site, row["n"]) for site, row in rows.items()] == [("A", 2), ("B", 1), ("C", 0)]
    assert rows["A"]["air_temperature_C"] == pytest.approx(-2.75)
    assert math.isnan(rows["C"]["wind_speed_m_per_s"])


def test_no_station_is_no_weather(make_campaign: MakeCampaign) -> None:
    assert weather_at_tests(make_campaign(PENETRATION[:2], columns=",time")) is None
