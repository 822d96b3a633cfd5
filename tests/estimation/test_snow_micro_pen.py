"""Recordings of a SnowMicroPen in a campaign: their numbers, their place beside plate tests, the regressions."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Literal, cast

import jsonschema
import numpy as np
import pytest

import skisnow
from skisnow._support.units import MM
from skisnow.campaign import read_snow_micro_pen
from skisnow.campaign.snow_micro_pen import SnowMicroPenProfile, SnowMicroPenSettings, snow_surface
from skisnow.cli.shell import json_schema
from skisnow.estimation.snow_micro_pen import SnowMicroPenAnalysis, depth_profile, evaluate_profile
from skisnow.interop.site_pit import site_pit
from skisnow.report.campaign.summary import summary
from skisnow.snow.measured_range import PENETROMETER_RELATIONS

from ..campaign.recordings import AIR_N, LONG, SHORT, built, plain_snow, recording
from .conftest import MakeCampaign

# snowmicropyn 1.4.0 in a Python of its own, files loaded by Profile.load: samples from 5 to 30 mm below our surface, in
# windows of params[NAME].window_size that begin half a window apart; of each loewe2012.calc_step(1/242, window), and
# .density and .ssa of the median force and L. Medians of f0 (N), delta and L (mm), means of density and SSA.
NUMBERS: dict[str, dict[str, tuple[float, ...]]] = {
    LONG: {
        "mean": (0.5079085436316922,),
        "median": (0.4094567059073597,),
        "proksch-2015": (0.0193883254532, 0.0844113641501, 0.329525198212, 306.466075390, 12.5352047991),
        "calonne-2020": (0.00764012403621, 0.0588163604506, 0.220151932454, 257.892542716, 31.5593110471),
        "king-2020a": (0.07130599743836033, 0.2196506831189536, 0.644862947902178, 242.84051581208405, math.nan),
        "king-2020b": (0.07130599743836033, 0.2196506831189536, 0.644862947902178, 243.8179975617213, math.nan),
    },
    SHORT: {
        "mean": (8.619316088641947,),
        "median": (8.90759076050017,),
        "proksch-2015": (0.188680218998, 0.306426500405, 0.476160155023, 407.958364037, 7.23603471095),
        "calonne-2020": (0.0643051812593, 0.204307012798, 0.278438121374, 392.871449608, 18.6450808683),
        "king-2020a": (0.3924067775582786, 0.691823426056025, 0.6511207870721158, 279.14716294667215, math.nan),
        "king-2020b": (0.3924067775582786, 0.691823426056025, 0.6511207870721158, 277.1521208875662, math.nan),
    },
}  # fmt: skip


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_numbers_are_those_of_the_instrument_s_own_program(name: str) -> None:
    """To 1e-6: the header's distance of the samples has seven digits, 1/242 mm has all."""
    found = evaluate_profile(read_snow_micro_pen(recording(name)), SnowMicroPenSettings())
    assert found.mean_force == pytest.approx(NUMBERS[name]["mean"][0], rel=1e-12)
    assert found.median_force == pytest.approx(NUMBERS[name]["median"][0], rel=1e-12)
    for relation, windows in found.windows.items():
        own = (
            windows.rupture_force,
            windows.deflection / MM,
            windows.element_size / MM,
            windows.snow_density,
            windows.specific_surface_area,
        )
        np.testing.assert_allclose(own, NUMBERS[name][relation], rtol=1e-6)


def made(force: np.ndarray[tuple[int], np.dtype[np.float64]], step: float = 1e-5) -> SnowMicroPenProfile:
    """A recording with a sample every hundredth of a millimetre, by a tip of 5 mm."""
    return cast("Any", SimpleNamespace(
        force=force, depth=step * np.arange(len(force)), sample_distance=step, tip_diameter=5e-3,
    ))  # fmt: skip


def test_a_stated_surface_leaves_the_air_before_it_and_a_recording_must_reach_the_lower_depth() -> None:
    """30 mm of air with a spike, then 2 N and in the last millimetre 9 N; the median of the air is taken off."""
    force = np.concatenate((np.full(3000, 0.05), np.full(2900, 2.0), np.full(101, 9.0)))
    force[1000:1100] = 40.0
    found = evaluate_profile(made(force), SnowMicroPenSettings(subtract_air_force=True), surface=0.03)
    assert (found.flags, found.is_used, found.surface, found.air_force) == ((), True, 0.03, 0.05)
    assert found.reach == pytest.approx(0.03)
    assert (found.mean_force, found.median_force) == pytest.approx(((24.0 * 2.0 + 9.0) / 25.0 - 0.05, 1.95))
    kept = evaluate_profile(made(force), SnowMicroPenSettings(), surface=0.03)
    assert kept.mean_force == pytest.approx(found.mean_force + 0.05)
    without_air = evaluate_profile(made(force[3000:]), SnowMicroPenSettings(), surface=0.0)
    assert (without_air.air_force, without_air.mean_force) == pytest.approx((0.0, kept.mean_force))
    # 30 mm below the surface: the sample there is the last that it needs.
    for more, flags in ((3000, ("too_short",)), (3001, ())):
        found = evaluate_profile(made(np.full(100 + more, 1.0)), SnowMicroPenSettings(), surface=1e-3)
        assert found.flags == flags
        assert math.isfinite(found.mean_force) is not bool(flags)
    both = evaluate_profile(made(np.full(200, 1.0)), SnowMicroPenSettings(), surface=1e-3, is_cancelled=True)
    assert both.flags == ("cancelled", "too_short")
    assert {windows.n for windows in both.windows.values()} == {0}


def test_without_noise_there_is_no_microstructure_and_elements_are_as_large_as_the_tip_has_ruptures() -> None:
    """Of a force that does not change, and of one that is not above 0 or mostly 0; the mean force is known."""
    scatter = np.random.default_rng(1).normal(size=4000)
    spikes = np.where(np.arange(4000) % 3 == 0, np.abs(scatter), 0.0)  # a median of 0, which no relation takes
    for force in (np.full(4000, 2.0), -1.0 - 0.1 * np.abs(scatter), spikes):
        found = evaluate_profile(made(force), SnowMicroPenSettings(), surface=0.0)
        assert found.mean_force == pytest.approx(force[500:3000].mean())
        for windows in found.windows.values():
            assert windows.n == 0
            assert math.isnan(windows.snow_density)
            assert math.isnan(windows.element_size)
    # λ L³ is the area of the tip: 2^(2/3) times the size for twice the width; ruptures follow the force.
    force = 2.0 + 0.1 * np.random.default_rng(2).normal(size=4000)
    one, wide, strong = (
        evaluate_profile(cast("Any", each), SnowMicroPenSettings(), surface=0.0)
        for each in (made(force), SimpleNamespace(**vars(made(force)) | {"tip_diameter": 1e-2}), made(2.0 * force))
    )
    for name, windows in one.windows.items():
        # f₀ = (3/2) κ₂/κ₁ and λ = (4/3) κ₁²/(κ₂ δ): noise of 0.1 N about 2 N
        assert windows.rupture_force == pytest.approx(1.5 * 0.01 / 2.0, rel=0.1)
        intensity = 4.0 / 3.0 * 4.0 / (0.01 * windows.deflection)
        assert windows.element_size**3 == pytest.approx(0.25 * math.pi * 25e-6 / intensity, rel=0.1)
        assert wide.windows[name].element_size == pytest.approx(2.0 ** (2.0 / 3.0) * windows.element_size)
        assert strong.windows[name].rupture_force == pytest.approx(2.0 * windows.rupture_force)
        assert strong.windows[name].element_size == pytest.approx(windows.element_size)


def test_windows_begin_half_a_window_apart() -> None:
    """In 25 mm: one, and another for each half of one that is left. Those without noise do not count."""
    force = 2.0 + 0.1 * np.random.default_rng(2).normal(size=4000)
    found = evaluate_profile(made(force), SnowMicroPenSettings(), surface=0.0)
    for name, windows in found.windows.items():
        size = round(PENETROMETER_RELATIONS[name].window / 1e-5)
        assert windows.n == 1 + (2500 - size) // round(size / 2)
    force[500:1700] = 2.0
    fewer = evaluate_profile(made(force), SnowMicroPenSettings(), surface=0.0)
    for name, windows in fewer.windows.items():
        half = round(PENETROMETER_RELATIONS[name].window / 1e-5) // 2
        within = (1200 - 2 * half) // half + 1
        assert windows.n == found.windows[name].n - within


def test_a_place_has_the_recordings_of_its_spot_else_of_its_site() -> None:
    recordings = cast("Any", SimpleNamespace(site=("A", "A", "A", "B", "C"), spot=("1", "1", "2", "", "9")))
    found = SnowMicroPenAnalysis(recordings, ())
    values = np.array([1.0, 3.0, 8.0, 5.0, math.nan])
    places = [("A", "1"), ("A", "2"), ("A", ""), ("A", "7"), ("B", "1"), ("B", ""), ("C", "9"), ("D", "")]
    means = found.at(tuple(site for site, _ in places), tuple(spot for _, spot in places), values)
    assert means == pytest.approx([2.0, 8.0, 4.0, 4.0, 5.0, 5.0, math.nan, math.nan], nan_ok=True)


def test_what_is_not_used_has_no_number_but_is_counted() -> None:
    recordings = cast("Any", SimpleNamespace(settings=SnowMicroPenSettings()))
    force = 2.0 + 0.1 * np.random.default_rng(2).normal(size=4000)
    evaluated = [
        evaluate_profile(made(force), SnowMicroPenSettings(), surface=0.0, is_cancelled=each) for each in (False, True)
    ]
    found = SnowMicroPenAnalysis(recordings, tuple(evaluated))
    assert "1 of 2 recordings used" in repr(found)
    assert found.mean_force == pytest.approx([evaluated[0].mean_force, math.nan], nan_ok=True)
    density = evaluated[0].windows[SnowMicroPenSettings().relation].snow_density
    assert found.snow_density == pytest.approx([density, math.nan], nan_ok=True)
    assert math.isfinite(evaluated[1].mean_force)


def test_surfaces_of_the_recordings() -> None:
    """Read off the force: 185 mm, as in snowmicropyn 1.4.0; 246 mm, where that program stops at a spike at 221 mm."""
    for name, depth in ((LONG, 0.185), (SHORT, 0.246)):
        profile = read_snow_micro_pen(recording(name))
        found = snow_surface(profile.force, profile.sample_distance, rise=0.01, hold=5e-3)
        assert found is not None
        assert found.depth == pytest.approx(depth, abs=1e-3)
        assert found.air_force == pytest.approx(0.0555, abs=1e-3)


def pen(make: MakeCampaign, rows: str, contents: dict[str, bytes], extra: str = "") -> skisnow.Campaign:
    """Series 1 to 6 at three sites, two spots each, beside these recordings; H_V is 0.1 N/mm³ times the number."""
    series = [
        (f"p{number}", site, "disc", 0, load, load / (0.1 * number * 2500 * math.pi), spot)
        for number, (site, spot) in enumerate([(site, spot) for site in "ABC" for spot in "12"], start=1)
        for load in (100, 200, 300)
    ]
    folder = make(series, columns=",spot").folder
    (folder / "campaign.toml").write_text((folder / "campaign.toml").read_text() + extra)
    (folder / "snow_micro_pen.csv").write_text(rows)
    for name, data in contents.items():
        (folder / name).write_bytes(data)
    return skisnow.read_campaign(folder)


def test_mean_force_is_over_the_stated_depth_and_pairs_by_spot_else_by_site(make_campaign: MakeCampaign) -> None:
    """Six spots, forces of 1 to 6 N in proportion to H_V: the slope is 0.1 N/mm³ on a newton, and it is significant."""
    rows = "recording,site,file,spot\n" + "".join(
        f"r{number},{'ABC'[(number - 1) // 2]},r{number}.pnt,{(number - 1) % 2 + 1}\n" for number in range(1, 7)
    )
    contents = {f"r{number}.pnt": plain_snow(number, seed=number) for number in range(1, 7)}
    analysis = skisnow.analyse(pen(make_campaign, rows, contents), n_resamples=100)
    results = analysis.results
    schema = json_schema("results")
    jsonschema.validate(results, schema)
    section = results["snow_micro_pen"]
    assert (section["from_depth_mm"], section["to_depth_mm"]) == (5.0, 30.0)
    forces = [row["mean_force_N"] for row in section["recordings"]]
    assert forces == pytest.approx(range(1, 7), rel=0.002)
    assert all(row["surface_mm"] == pytest.approx(30.0, abs=0.5) for row in section["recordings"])
    assert all(row["air_force_N"] == pytest.approx(AIR_N, abs=0.001) for row in section["recordings"])
    on_force, on_density = results["regressions"][-2:]
    assert on_force["terms"] == ["intercept", "smp_mean_force_N"]
    assert on_force["b"][1] == pytest.approx(0.1, rel=0.005)
    assert on_force["p"] < 1e-6
    assert on_density["terms"] == ["intercept", "smp_snow_density_kg_per_m3"]
    assert on_density["n"] == 6


def test_recordings_without_plate_tests_are_a_campaign(tmp_path: Path) -> None:
    """The resistance is the mean force over the cross-section of the tip of 5 mm: 2 N on 19.6 mm² are 102 kPa."""
    (tmp_path / "campaign.toml").write_text('name = "pens"\n', encoding="utf-8")
    (tmp_path / "snow_micro_pen.csv").write_text("recording,site,file\nr1,A,one.PNT\n", encoding="utf-8")
    (tmp_path / "one.PNT").write_bytes(plain_snow(2.0))
    analysis = skisnow.analyse(tmp_path, n_resamples=100)
    (row,) = analysis.results["snow_micro_pen"]["recordings"]
    assert row["penetration_resistance_kPa"] == pytest.approx(2.0 / (math.pi / 4 * 0.005**2) / 1e3, rel=0.002)
    assert analysis.results["campaign"]["remarks"] == []
    assert analysis.results["group_comparisons"] == []
    (relation,) = analysis.results["published_relations"]
    assert (relation["source"], relation["n"]) == ("calonne-2020", 1)
    assert relation["snow_density_kg_per_m3"] == pytest.approx(row["snow_density_kg_per_m3"])
    assert relation["penetration_resistance_kPa"] == pytest.approx(row["penetration_resistance_kPa"])
    assert (relation["hand_hardness"], relation["hand_hardness_index"]) == ("P-", pytest.approx(3.52, abs=0.01))
    assert "hand hardness P-, index 3.52 (van Herwijnen and Pielmeier 2016)" in summary(analysis)
    notebook = analysis._repr_html_()
    assert "P-" in notebook and "not H_V" in notebook


@pytest.mark.usefixtures("undrawn")
def test_a_report_of_recordings_alone_has_their_profiles(tmp_path: Path) -> None:
    (tmp_path / "campaign.toml").write_text('name = "pens"\n', encoding="utf-8")
    (tmp_path / "snow_micro_pen.csv").write_text("recording,site,file\nr1,A,one.PNT\n", encoding="utf-8")
    (tmp_path / "one.PNT").write_bytes(plain_snow(2.0))
    skisnow.write_report(skisnow.analyse(tmp_path, n_resamples=100), tmp_path / "out")
    assert "figure-snow_profiles" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("undrawn")
def test_samples_of_pits_alone_have_a_profile_and_a_strength_by_the_published_relation(tmp_path: Path) -> None:
    """Eqn 14 at 500 kg/m³: −0.047 + 0.00031 × 500 = 0.108 N/mm²; 250 kg/m³ is outside of its range."""
    (tmp_path / "campaign.toml").write_text('name = "pits"\n', encoding="utf-8")
    (tmp_path / "density.csv").write_text(
        "sample,site,snow_density_kg_per_m3,sample_depth_mm,status\n"
        "1,A,520,300,\n2,A,480,100,\n3,B,250,,\n4,A,100,20,spilt\n",
        encoding="utf-8",
    )
    analysis = skisnow.analyse(tmp_path, n_resamples=100)
    pits, soft = analysis.results["published_relations"]
    assert (pits["site"], pits["source"], pits["n"], pits["snow_density_kg_per_m3"]) == ("A", "density.csv", 2, 500.0)
    assert pits["S_f_N_per_mm2"] == pytest.approx(0.108)
    assert (soft["site"], soft["n"], soft["S_f_N_per_mm2"]) == ("B", 1, None)
    assert (pits["hand_hardness"], soft["hand_hardness"]) == (None, "P-")  # 500 kg/m³ is harder than a knife
    assert soft["hand_hardness_index"] == pytest.approx((96 / 1.51) ** (1 / 3.15))
    jsonschema.validate(analysis.results, json_schema("results"))
    assert "0.108 N/mm²" in summary(analysis)
    (axes,) = analysis.plot("snow_profiles").axes
    (line,) = axes.lines
    assert np.asarray(line.get_xydata()).tolist() == [[480.0, 100.0], [520.0, 300.0]]
    skisnow.write_report(analysis, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "4 density samples, 2 sites<" in page  # nothing of plate tests, which there are none of
    assert page.index("figure-snow_profiles") < page.index("table-published_relations") < page.index('id="caveats"')
    assert "table-regressions" not in page and "table-marks" not in page
    pit = site_pit(analysis, "A")
    assert [(each.top, each.snow_density) for each in pit.densities] == [(0.3, 520.0), (0.1, 480.0)]


@pytest.mark.parametrize("name", ["calonne-2020", "king-2020a"])
def test_a_profile_has_the_values_of_the_windows_over_depth(name: Literal["calonne-2020", "king-2020a"]) -> None:
    """Between the two depths its mean is that of the evaluation, but for the windows at the ends."""
    profile, settings = read_snow_micro_pen(recording(LONG)), SnowMicroPenSettings(relation=name)
    found = evaluate_profile(profile, settings)
    drawn = depth_profile(profile, settings, found.surface)
    window = PENETROMETER_RELATIONS[name].window
    np.testing.assert_allclose(np.diff(drawn.depth), window / 2, rtol=0.01)
    assert drawn.depth[0] == pytest.approx(window / 2, rel=0.01)
    part = (drawn.depth > settings.from_depth) & (drawn.depth < settings.to_depth)
    assert np.nanmean(drawn.snow_density[part]) == pytest.approx(found.windows[name].snow_density, rel=0.02)
    assert np.median(drawn.force[part]) == pytest.approx(found.median_force, rel=0.05)
    assert np.isfinite(drawn.specific_surface_area).any() == (name == "calonne-2020")


def test_few_forces_are_not_called_significant(make_campaign: MakeCampaign) -> None:
    """One recording at two of the three sites: two values for four series, and the third site takes no part."""
    rows = "recording,site,file\nr1,A,one.PNT\nr2,B,two.PNT\n"
    contents = {"one.PNT": plain_snow(1.0), "two.PNT": plain_snow(2.0)}
    found = skisnow.analyse(pen(make_campaign, rows, contents), n_resamples=100)
    regression = found.results["regressions"][-2]
    assert (regression["n"], regression["predictor_values"], regression["p"]) == (4, 2, None)
    assert "2 different values" in regression["withheld"]
    forces = found.observations["penetration"].columns["smp_mean_force_N"]
    np.testing.assert_allclose(forces, [1, 1, 2, 2, math.nan, math.nan], rtol=0.002)


def test_a_misspelt_site_of_a_recording_is_noted(make_campaign: MakeCampaign) -> None:
    campaign = pen(
        make_campaign, "recording,site,file\nr1,a,1.pnt\nr2,Z,2.pnt\n", {f"{i}.pnt": plain_snow(i) for i in (1, 2)}
    )
    notes = skisnow.analyse(campaign, n_resamples=100).results["campaign"]["remarks"]
    assert any("'A', 'a'" in note for note in notes)
    assert any("describes 'Z', 'a'" in note for note in notes)


def test_recordings_that_are_not_used_say_why(make_campaign: MakeCampaign) -> None:
    """No air before the snow; too shallow; cancelled. A stated surface makes up for missing air."""
    rows = (
        "recording,site,file,surface_mm,status\n"
        "r1,A,1.pnt,,\nr2,A,2.pnt,,\nr3,A,3.pnt,,broken tip\nr4,A,4.pnt,0.0,\nr5,B,5.pnt,,\n"
    )
    buried = plain_snow(3.0, air_mm=0.0)
    contents = {
        "1.pnt": buried,
        "2.pnt": plain_snow(1.0, snow_mm=20.0),
        "3.pnt": plain_snow(1.0),
        "4.pnt": built(np.full(10_000, 1200) + np.arange(10_000) % 2),
        "5.pnt": plain_snow(2.0),
    }
    found = skisnow.analyse(pen(make_campaign, rows, contents), n_resamples=100)
    listed = found.results["snow_micro_pen"]["recordings"]
    assert [row["flags"] for row in listed] == [["no_surface"], ["too_short"], ["cancelled"], [], []]
    assert [row["used"] for row in listed] == [False, False, False, True, True]
    assert listed[1]["reach_mm"] == pytest.approx(20.0, abs=0.5)
    assert listed[1]["mean_force_N"] is None
    assert listed[3]["mean_force_N"] == pytest.approx(3.0, abs=0.002)


def test_settings_move_what_they_say(make_campaign: MakeCampaign) -> None:
    """Snow of 1 N for 20 mm, then of 3 N; 10 to 30 mm sees half of each; the air's 0.05 N is taken off."""
    force = np.concatenate((np.full(7500, AIR_N), np.full(5000, 1.0), np.full(10_000, 3.0)))
    settings = "\n[snow_micro_pen]\nfrom_depth_mm = 10\nto_depth_mm = 30\nsubtract_air_force = true\n"
    extra = settings + 'relation = "king-2020a"\n'
    campaign = pen(
        make_campaign, "recording,site,file\nr1,A,1.pnt\n", {"1.pnt": built(np.round(force / 0.0025))}, extra
    )
    section = skisnow.analyse(campaign, n_resamples=100).results["snow_micro_pen"]
    assert (section["relation"], section["subtract_air_force"]) == ("king-2020a", True)
    assert section["recordings"][0]["mean_force_N"] == pytest.approx(2.0 - AIR_N, rel=1e-3)


def test_a_campaign_without_recordings_is_as_before(make_campaign: MakeCampaign) -> None:
    rows = [(f"p{number}", "A", "disc", 0, load, load / 100) for number in (1, 2) for load in (100, 200, 300)]
    results = skisnow.analyse(make_campaign(rows), n_resamples=100).results
    assert "snow_micro_pen" not in results
    assert len(results["regressions"]) == 6


@pytest.mark.usefixtures("undrawn")
def test_the_report_has_a_table_and_a_figure(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    rows = "recording,site,file\nr1,A,one.PNT\n"
    analysis = skisnow.analyse(pen(make_campaign, rows, {"one.PNT": plain_snow(1.0)}), n_resamples=100)
    skisnow.write_report(analysis, tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "SnowMicroPen, 5 to 30 mm" in page
    assert "-hardness_mean_force" in page
    assert list((tmp_path / "out" / "tables").glob("snow_micro*.csv"))
