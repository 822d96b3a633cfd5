"""Layering and weather."""

import math
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import skisnow
from skisnow._support.errors import FieldDataError
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.campaign import Problem, reference_campaign
from skisnow.cli.shell import json_schema
from skisnow.estimation import layering as layering_module
from skisnow.estimation import quality_flags
from skisnow.estimation.campaign_model import fit_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.layering import growing_hardness, layered, layering
from skisnow.estimation.readings import Readings, ReadingUncertainty
from skisnow.estimation.screening import hardness_outliers, screened_penetration
from skisnow.estimation.weather import weather_at_tests, weather_results
from skisnow.interop.site_pit import site_pit
from tests.present import present

from .conftest import MakeCampaign
from .test_hardness import LOADS, TOOL, pressed

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
    nan = math.nan
    np.testing.assert_allclose(present(analysis.weather).quantities["air_temperature_C"], [nan, nan, nan, nan, -6.0])


def test_without_the_section_nothing_is_reported(make_campaign: MakeCampaign) -> None:
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
def test_a_wrong_section_rejects_the_campaign(make_campaign: MakeCampaign, lines: str, column: str, value: str) -> None:
    assert (f"weather.{column}", value) in refused_cells(campaign(make_campaign, f"\n[weather]\n{lines}\n"))


def test_a_damaged_file_rejects_the_campaign(make_campaign: MakeCampaign) -> None:
    folder = campaign(make_campaign)
    (folder / "s.smet").write_text(SMET.replace("0.7", "wet"))
    assert refused_cells(folder) == [("RH", "wet")]


@pytest.mark.usefixtures("undrawn")
def test_the_report_has_a_table(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    analysis = skisnow.analyse(campaign(make_campaign), n_resamples=100)
    skisnow.write_report(analysis, tmp_path / "out")
    assert "by the station S" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert (tmp_path / "out" / "tables" / "weather.csv").exists()


ANGLE = math.radians(30.0)
FIFTY_PERCENT = 2.0 * math.log(1.5) / (math.log(LOADS[-1] / LOADS[0]) - math.log(1.5))
"""κ for which F/V grows by half from the first load to the last: (F/F₁)^((κ/2)/(1 + κ/2)) = 1.5."""


def layered_series(hardness: np.ndarray, kappa: float, scatter: float, offset: float, seed: int = 1) -> Readings:
    """The reference campaign's law, solved for the depth with scatter and an offset."""
    rng = np.random.default_rng(seed)
    volume = LOADS[-1] / hardness[:, None] * (LOADS / LOADS[-1]) ** (1.0 / (1.0 + kappa / 2.0))
    depth = TOOL.depth_at_volume(volume, ANGLE) * (1.0 + scatter * rng.standard_normal(volume.shape)) + offset
    return pressed(TOOL, ANGLE, np.maximum(depth, 0.0), LOADS)


def test_f_over_v_grows_by_half() -> None:
    readings = layered_series(np.array([1e9]), FIFTY_PERCENT, 0.0, 0.0)
    ratio = readings.load / readings.displaced_volume
    assert ratio[-1] / ratio[0] == pytest.approx(1.5)
    assert ratio[-1] == pytest.approx(1e9)


@pytest.mark.parametrize("kappa", [-0.2, 0.0, 0.3])
def test_an_exact_series_with_an_offset_gives_back_its_exponent(kappa: float) -> None:
    hardness = np.array([2e7, 1e9, 3e10])
    readings = layered_series(hardness, kappa, 0.0, 3e-5)
    exponent, _, _ = layering(readings, 1.2 * hardness, ReadingUncertainty(1e-7))
    np.testing.assert_allclose(2.0 / exponent - 2.0, kappa, atol=1e-4)


def test_a_fit_that_goes_on_moves_a_growth_by_less_than_a_hundredth_of_its_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    readings = layered_series(np.geomspace(2e7, 3e10, 60), 0.3, 0.02, 1e-5)
    H_V = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    found = []
    for settled, rounds in ((layering_module._SETTLED, layering_module._ITERATIONS), (1e-8, 4000)):
        monkeypatch.setattr(layering_module, "_SETTLED", settled)
        monkeypatch.setattr(layering_module, "_ITERATIONS", rounds)
        found.append(np.log1p(growing_hardness(readings, H_V, ReadingUncertainty(3e-6)).growth_interval))
    (first, first_half), (last, last_half) = ((ends.mean(axis=1), np.diff(ends)[:, 0] / 2.0) for ends in found)
    np.testing.assert_allclose(first_half, last_half, rtol=0.01)
    assert np.max(np.abs(first - last) / last_half) < 0.004  # 2.57 errors are the half of an interval


def test_flags_need_a_hardness_in_any_unit_of_force() -> None:
    depth = layered_series(np.full(4, 1e9), FIFTY_PERCENT, 1e-4, 0.0).penetration_depth.reshape(4, -1)
    for unit in (1.0, 1e-10):
        hardness = 1e9 * unit * np.array([1.0, 0.0, -1.0, np.nan])
        flagged = layered(pressed(TOOL, ANGLE, depth, unit * LOADS), hardness, ReadingUncertainty(1e-7))
        assert flagged.tolist() == [True, False, False, False]


def test_even_snow_is_seldom_marked_and_layered_snow_is() -> None:
    """One in a hundred of 2000 even series is 20 ± 4.4; gauge and offset as in the reference campaign."""
    uncertainty = ReadingUncertainty(0.01e-3 / math.sqrt(12))
    hardness = np.full(2000, 0.1e9)
    H = DEFINITIONS["H_V"]
    even = layered_series(hardness, 0.0, 0.02, 2e-5)
    assert 4 <= layered(even, hardness_at_largest_load(even, H), uncertainty).sum() <= 36
    for kappa in (FIFTY_PERCENT, -FIFTY_PERCENT):
        clear = layered_series(hardness, kappa, 0.005, 2e-5)
        assert layered(clear, hardness_at_largest_load(clear, H), uncertainty).mean() > 0.9


@pytest.mark.parametrize("kappa", [0.0, FIFTY_PERCENT])
def test_the_interval_of_all_readings_holds_the_truth_in_layered_snow(kappa: float) -> None:
    uncertainty, hardness = ReadingUncertainty(0.01e-3 / math.sqrt(12)), np.full(1000, 0.1e9)
    readings = layered_series(hardness, kappa, 0.01, 2e-5)
    model = fit_campaign(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), uncertainty)
    low, high = model.hardness_interval.T
    assert 0.93 < ((low <= hardness) & (hardness <= high)).mean() < 0.985
    assert abs(model.log_hardness.mean() - math.log(0.1e9)) < 0.005


def test_a_layered_series_is_flagged_and_used_and_b_then_has_no_interval(make_campaign: MakeCampaign) -> None:
    layers = layered_series(np.full(3, 0.05e9), 0.35, 0.0, 0.0).penetration_depth.reshape(3, 7) * 1e3
    even = layered_series(np.full(3, 0.05e9), 0.0, 0.002, 0.0).penetration_depth.reshape(3, 7) * 1e3
    rows = [
        (f"{name}{i}", "A", "ski", 30, load, f"{depth:.2f}")
        for name, depths in (("layered", layers), ("even", even))
        for i, each in enumerate(depths)
        for load, depth in zip(LOADS, each, strict=True)
    ]
    results = skisnow.results_dict(skisnow.analyse(make_campaign(rows), n_resamples=100))
    flags = {row["experiment"]: row["flags"] for row in results["penetration"]["experiments"]}
    assert all(flags[f"layered{i}"] == ["layered"] and flags[f"even{i}"] == [] for i in range(3))
    assert all(row["used"] for row in results["penetration"]["experiments"])
    fitted = results["penetration"]["errors_in_depth"]["models"]
    assert all(row["intervals"] == dict.fromkeys(("a0", "a1", "b0", "b1")) for row in fitted)
    assert results["penetration"]["models"][-2]["intervals"]["b0"] is not None


def test_outlier_rule_by_hand() -> None:
    """ln H = 0, 0.1, 0.2, 0.3, 0.4 and x: limits 3.5 · 1.4826 · MAD around the median of all six."""
    H = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 0.4, 3.0]))
    used = np.ones(6, dtype=bool)
    # median 0.25, deviations .25 .15 .05 .05 .15 2.75: MAD 0.15, limit 0.778
    assert hardness_outliers(H, used, ["A"] * 6).tolist() == [False] * 5 + [True]
    inside = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 0.4, 1.02]))
    assert not hardness_outliers(inside, used, ["A"] * 6).any()


def test_a_site_needs_five_used_series_and_a_scatter() -> None:
    H = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 9.0]))
    everything = np.ones(5, dtype=bool)
    assert hardness_outliers(H, everything, ["A"] * 5).any()
    assert not hardness_outliers(H, np.array([True] * 4 + [False]), ["A"] * 5).any()
    assert not hardness_outliers(np.exp(np.array([0, 0, 0, 0, 9.0])), everything, ["A"] * 5).any()
    assert not hardness_outliers(H, everything, ["A"] * 4 + ["B"]).any()


def series_rows(name: str, hardness: float) -> list[tuple[object, ...]]:
    """A flat series of the ski piece with H_V in N/mm³."""
    return [(name, "A", "ski", 0, load, round(load / (hardness * 12400), 4)) for load in (100, 200, 300)]


@pytest.mark.parametrize(("extra", "used"), [("", True), ('[screening]\nexclude = ["hardness_outlier"]\n', False)])
def test_an_outlier_stays_unless_it_is_excluded(make_campaign: MakeCampaign, extra: str, used: bool) -> None:
    rows = [row for i, H in enumerate((0.1, 0.11, 0.12, 0.13, 0.14, 0.9)) for row in series_rows(f"p{i}", H)]
    campaign = make_campaign(rows, extra=extra, gauge=0.0001)
    found = screened_penetration(campaign, geometry="extended")
    assert found.codes()[-1] == ["hardness_outlier"]
    assert found.used.tolist() == [True] * 5 + [used]
    flag = next(p for p in quality_flags(campaign) if p.code == "hardness_outlier")
    assert (flag.severity, flag.file, flag.experiment, flag.row) == ("flag", "penetration.csv", "p5", 19)


def test_excluding_flags_keep_a_series_out(make_campaign: MakeCampaign) -> None:
    rows = [*series_rows("p1", 0.1), ("p2", "A", "ski", 0, 100, 1.0), ("p2", "A", "ski", 0, 200, 0.9)]
    campaign = make_campaign(rows)
    found = screened_penetration(campaign, geometry="extended")
    assert found.codes() == [[], ["too_few_loads", "depth_shrinks"]]
    assert found.used.tolist() == [True, False]


# The interval of a site's mean is one number, whether a report of the campaign or of a turn prints it


def test_the_snow_of_a_site_has_the_interval_of_its_mean() -> None:
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    means = {(row["quantity"], row["site"]): row for row in found.results["site_means"]}
    for letter in "CE":
        snow = found.snow(letter)
        for key, unit, value, interval in (
            ("H_V_N_per_mm3", N_PER_MM3, snow.snow_hardness, snow.snow_hardness_interval),
            ("S_f_N_per_mm2", N_PER_MM2, snow.failure_shear_stress, snow.failure_shear_stress_interval),
        ):
            row = means[key, f"site {letter}"]
            assert present(value) / unit == pytest.approx(row["mean"], rel=1e-12)
            assert [end / unit for end in present(interval)] == pytest.approx(row["interval"], rel=1e-9)


# The weather at each experiment: times, offsets, units, means of sites


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
    found = present(weather_at_tests(campaign))
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
    results = weather_results(present(campaign.weather), found)
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
