"""The synthetic reference campaign: the paper's design, truth that fits its readings, the same bytes for a seed."""

import csv
import dataclasses
import itertools
import re
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from tests.key_names import DROP_CONE_DEPTH, SNOW_DENSITY
from tests.present import present

import skisnow
from skisnow._support.errors import OutputError, ParameterError
from skisnow.campaign.reading.campaign import read_campaign
from skisnow.campaign.reference import ReferenceNoise, reference_campaign, write_reference
from skisnow.campaign.reference.design import FURTHER_SHEAR_SITES, PENETRATION_SITES
from skisnow.campaign.screening import screen_penetration

QUIET = ReferenceNoise(
    gauge_resolution=0.0, load_sd=0.0, seating_sd=0.0, depth_scatter=0.0, layering_sd=0.0, shear_scatter=0.0,
    moment_sd=0.0, lever_arm_sd=0.0,
)  # fmt: skip
SEEDS = range(8)
L, W = 200.0, 62.0  # mm, the paper's tool


def volume_mm3(depth_mm: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Eqns 2 and 3; no series here is deeper than the wedge holds (checked below)."""
    edged = angle > 0
    wedge = L * depth_mm**2 / (2.0 * np.tan(np.where(edged, angle, 1.0)))
    return np.where(edged, wedge, L * W * depth_mm)


@pytest.mark.parametrize("seed", SEEDS)
def test_group_sizes_are_the_papers(seed: int) -> None:
    drawn = reference_campaign(seed)
    assert len(drawn.penetration) == 236
    assert np.array_equal(np.diff(drawn.penetration.first), np.full(236, 7))
    assert np.array_equal(drawn.penetration.load[:7], [12.0, 92.0, 172.0, 252.0, 332.0, 412.0, 492.0])
    assert len(drawn.shear) == 108
    at_90 = np.isclose(drawn.shear.edge_angle, np.pi / 2)
    per_site = {site: sum(name == site for name in drawn.shear.site) for site in set(drawn.shear.site)}
    varied = {site for site, angle in zip(drawn.shear.site, at_90, strict=True) if not angle}
    assert sorted(per_site[site] for site in varied) == [20, 30]
    assert sum(count for site, count in per_site.items() if site not in varied) == 58


def test_35_spots_at_two_sites_pair_shear_with_penetration() -> None:
    drawn = reference_campaign(3)
    series = [pair for pair in zip(drawn.penetration.site, drawn.penetration.spot, strict=True) if pair[1]]
    tests = [pair for pair in zip(drawn.shear.site, drawn.shear.spot, strict=True) if pair[1]]
    assert len(set(series)) == len(series) == 35
    assert sorted(series) == sorted(tests)
    assert len({site for site, _ in series}) == 2


@pytest.mark.parametrize("seed", SEEDS)
def test_ranges_are_the_papers(seed: int) -> None:
    drawn = reference_campaign(seed)
    hardness = drawn.snow_hardness / 1e9
    assert hardness.min() >= 0.04
    assert hardness.max() <= 90.0
    assert hardness.min() < 0.08  # the softest and the hardest site reach towards both ends
    assert hardness.max() > 60.0
    assert set(np.round(np.degrees(drawn.penetration.edge_angle), 9)) == {0.0, 15.0, 30.0, 45.0, 60.0}
    assert drawn.density.snow_density.min() >= 420.0
    assert drawn.density.snow_density.max() <= 620.0
    assert drawn.drop_cone.drop_cone_depth.min() >= 7.4e-3 - 1e-12  # 7.4 mm in m, to rounding
    assert drawn.drop_cone.drop_cone_depth.max() <= 21.2e-3 + 1e-12
    own = drawn.shear.snow_density
    assert np.count_nonzero(np.isfinite(own)) == 58
    assert np.nanmin(own) >= 420.0
    assert np.nanmax(own) <= 740.0
    stress = drawn.failure_shear_stress[np.isfinite(own)] / 1e6
    assert stress.min() >= 0.04
    assert stress.max() <= 0.40
    assert drawn.shear.penetration_depth.min() >= 2e-3 - 1e-12
    assert drawn.shear.penetration_depth.max() <= 12e-3 + 1e-12
    assert drawn.shear.moment.max() <= 60.0 + 1.5  # 60 N m, the arm's 1 mm in 250 and five sd of the gauge


def test_flat_tool_only_where_its_depth_can_be_read() -> None:
    drawn = reference_campaign(2)
    flat = drawn.penetration.edge_angle == 0
    flat_depth_mm = 492.0 / (drawn.snow_hardness / 1e9 * L * W)
    site_starts = [drawn.penetration.site.index(site) for site in sorted(set(drawn.penetration.site))]
    planned = np.zeros(236, dtype=bool)  # the first, sixth, eleventh ... series of each site
    for start, end in itertools.pairwise([*site_starts, 236]):
        planned[start:end:5] = True
    np.testing.assert_array_equal(flat, planned & (flat_depth_mm > 0.2))
    assert 0 < flat.sum() < planned.sum()


def test_without_errors_every_reading_obeys_the_papers_law() -> None:
    drawn = reference_campaign(5, noise=QUIET)
    tests = drawn.penetration
    angle = np.repeat(tests.edge_angle, 7)
    depth_mm = tests.penetration_depth * 1e3
    assert np.all((angle == 0) | (depth_mm <= W * np.sin(angle)))
    force = np.repeat(drawn.snow_hardness / 1e9, 7) * volume_mm3(depth_mm, angle)
    np.testing.assert_allclose(force, tests.load, rtol=1e-12)  # rounding of a square root and back


def test_layering_bends_the_law_and_keeps_its_end() -> None:
    noise = dataclasses.replace(QUIET, layering_sd=0.15)
    drawn = reference_campaign(5, noise=noise)
    depth = drawn.penetration.penetration_depth.reshape(-1, 7) * 1e3
    volume = volume_mm3(depth, drawn.penetration.edge_angle[:, np.newaxis])
    np.testing.assert_allclose(drawn.snow_hardness / 1e9 * volume[:, -1], 492.0, rtol=1e-12)
    slope = np.log(12.0 / 492.0) / np.log(volume[:, 0] / volume[:, -1])  # of ln F against ln V
    np.testing.assert_allclose(slope, 1.0 + drawn.layering / 2.0, rtol=1e-10)
    edged = drawn.penetration.edge_angle > 0
    order = np.log(12.0 / 492.0) / np.log(depth[edged, 0] / depth[edged, -1])  # of ln F against ln e
    np.testing.assert_allclose(order, 2.0 + drawn.layering[edged], rtol=1e-10)
    # 236 draws with sd 0.15: the sd of their sd is 0.15/√472 = 0.007; four of them
    assert abs(drawn.layering.std() - 0.15) < 0.028


def test_seating_is_what_the_gauge_reads_too_much_and_depth_scatter_is_relative_and_independent() -> None:
    drawn = reference_campaign(7, noise=dataclasses.replace(QUIET, seating_sd=2e-5))
    reading = drawn.penetration.penetration_depth
    expected = drawn.penetration_depth + np.repeat(drawn.seating_offset, 7)
    np.testing.assert_allclose(reading, np.maximum(expected, 0.0), rtol=0, atol=1e-15)
    assert (expected < 0).any()  # so that the gauge's zero was met
    assert abs(drawn.seating_offset.std() - 2e-5) < 4 * 2e-5 / np.sqrt(472)
    drawn = reference_campaign(7, noise=dataclasses.replace(QUIET, depth_scatter=0.02))
    relative = drawn.penetration.penetration_depth / drawn.penetration_depth - 1.0
    assert abs(relative.std() - 0.02) < 4 * 0.02 / np.sqrt(2 * 1652)
    by_series = relative.reshape(-1, 7).mean(axis=1)
    assert abs(by_series.std() - 0.02 / np.sqrt(7)) < 4 * 0.02 / np.sqrt(7 * 472)  # larger if a series shared its draw


def test_snow_feels_the_true_load_and_the_table_states_the_nominal_one() -> None:
    drawn = reference_campaign(7, noise=dataclasses.replace(QUIET, load_sd=0.5))
    tests = drawn.penetration
    volume = volume_mm3(tests.penetration_depth * 1e3, np.repeat(tests.edge_angle, 7))
    true_load = np.repeat(drawn.snow_hardness / 1e9, 7) * volume
    error = true_load - np.tile([12.0, 92.0, 172.0, 252.0, 332.0, 412.0, 492.0], 236)
    assert abs(error.std() - 0.5) < 4 * 0.5 / np.sqrt(2 * 1652)
    assert abs(error.mean()) < 4 * 0.5 / np.sqrt(1652)


def test_readings_are_on_the_gauges_steps() -> None:
    depth_mm = reference_campaign(1).penetration.penetration_depth * 1e3
    np.testing.assert_allclose(depth_mm * 100, np.rint(depth_mm * 100), rtol=0, atol=1e-9)
    assert depth_mm.min() >= 0


def test_switching_one_error_off_leaves_the_other_draws() -> None:
    full, still = (
        reference_campaign(9),
        reference_campaign(9, noise=ReferenceNoise(depth_scatter=0.0, shear_scatter=0.0)),
    )
    np.testing.assert_array_equal(full.snow_hardness, still.snow_hardness)
    np.testing.assert_array_equal(full.seating_offset, still.seating_offset)
    np.testing.assert_array_equal(full.layering, still.layering)
    np.testing.assert_array_equal(full.shear.snow_density, still.shear.snow_density)


def test_shear_without_errors_gives_the_printed_regressions() -> None:
    drawn = reference_campaign(4, noise=QUIET)
    tests = drawn.shear
    stress = tests.moment / (tests.lever_arm * 0.1 * tests.penetration_depth) / 1e6
    # the moment is written to 0.01 N m, half of which is 0.4 % of the smallest
    np.testing.assert_allclose(stress, drawn.failure_shear_stress / 1e6, rtol=4e-3)
    truth = drawn.failure_shear_stress / 1e6
    np.testing.assert_allclose(truth[:20], 0.25, rtol=1e-12)
    np.testing.assert_allclose(truth[20:50], 0.059 * (1 - 0.266 * tests.edge_angle[20:50]), rtol=1e-12)
    np.testing.assert_allclose(truth[50:], -0.047 + 0.00031 * tests.snow_density[50:], rtol=1e-12)
    assert np.degrees(tests.edge_angle[20:50]).min() == pytest.approx(30.0)


@pytest.mark.parametrize(("name", "sd"), [("moment_sd", 0.2), ("lever_arm_sd", 1e-3)])
def test_errors_of_the_moment_and_its_arm(name: str, sd: float) -> None:
    errors, changes = [], cast("Any", {name: sd})
    for seed in range(20):
        drawn = reference_campaign(seed, noise=dataclasses.replace(QUIET, **changes))
        force = drawn.failure_shear_stress * 0.1 * drawn.shear.penetration_depth  # N, on the 100 mm plate
        exact = force * drawn.shear.lever_arm
        errors.append((drawn.shear.moment - exact) / (1.0 if name == "moment_sd" else force))
    # 2160 draws: four standard errors of an sd are 6.1 %; rounding the moment to 0.01 N m adds at most 1 %
    assert np.std(np.concatenate(errors)) == pytest.approx(sd, rel=0.07)


def test_scatter_of_shear_stress_over_many_campaigns() -> None:
    soft, further = [], []
    for seed in range(60):
        drawn = reference_campaign(seed)
        truth = drawn.failure_shear_stress / 1e6
        soft.append(truth[20:50] - 0.059 * (1 - 0.266 * drawn.shear.edge_angle[20:50]))
        further.append(truth[50:])
    # 1800 draws: four standard errors of an sd are 6.7 %
    assert np.std(np.concatenate(soft)) == pytest.approx(0.006, rel=0.067)
    # Eqn 14's 0.059 plus the densities' spread of 0.02, less what the range cuts off
    assert 0.045 < np.std(np.concatenate(further)) < 0.065


def test_density_and_drop_cone_know_nothing_of_the_hardness() -> None:
    """Site by site, weighted by series, as a regression over all series sees them."""
    weights = [site.tests for site in PENETRATION_SITES]
    hardness = np.repeat([site.snow_hardness for site in PENETRATION_SITES], weights)
    for quantity, mean in (("snow_density", 556.0), ("drop_cone_depth", 13.6e-3)):
        values = np.repeat([getattr(site, quantity) for site in PENETRATION_SITES], weights)
        assert abs(np.corrcoef(hardness, values)[0, 1]) < 0.05  # p above 0.4 over 236 series
        assert values.mean() == pytest.approx(mean, rel=1e-3)  # the paper's mean, to its digits


def test_drop_cones_at_the_shear_tests_have_no_relation_with_density() -> None:
    drawn = reference_campaign(1)
    cone = drawn.drop_cone.site_means()
    at_90 = np.isfinite(drawn.shear.snow_density)
    sites = np.array(drawn.shear.site)[at_90]
    assert at_90.sum() == 58
    assert set(sites) <= cone.keys()
    every: list[Any] = [*PENETRATION_SITES, *FURTHER_SHEAR_SITES]
    planned = {site.name: site for site in every}
    density, depth = ([getattr(planned[site], name) for site in sites] for name in ("snow_density", "drop_cone_depth"))
    assert abs(np.corrcoef(density, depth)[0, 1]) < 0.05  # p above 0.7 over 58 tests


def test_same_seed_same_bits_another_seed_others() -> None:
    first, again, other = reference_campaign(11), reference_campaign(11), reference_campaign(12)
    for name in ("snow_hardness", "seating_offset", "layering", "penetration_depth", "failure_shear_stress"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()
        assert not np.array_equal(getattr(first, name), getattr(other, name))
    assert first.penetration.penetration_depth.tobytes() == again.penetration.penetration_depth.tobytes()


@pytest.mark.parametrize("seed", [-1, 1.5, "1", True, None])
def test_a_seed_is_an_integer(seed: object) -> None:
    with pytest.raises(ParameterError, match="integer"):
        reference_campaign(seed)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "value"), [("load_sd", -0.1), ("depth_scatter", float("nan")), ("layering_mean", 1.0)]
)
def test_impossible_noise_is_rejected(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=name):
        ReferenceNoise(**cast("Any", {name: value}))


def test_written_files_have_the_contracts_columns(tmp_path: Path) -> None:
    write_reference(tmp_path / "new" / "folder", seed=1)
    folder = tmp_path / "new" / "folder"
    assert sorted(path.name for path in folder.iterdir()) == [
        "campaign.toml",
        "density.csv",
        "drop_cone.csv",
        "penetration.csv",
        "shear.csv",
    ]
    rows = {path.stem: list(csv.DictReader(path.read_text("utf-8").splitlines())) for path in folder.glob("*.csv")}
    assert Counter(row["branch"] for row in rows["penetration"]) == {"loading": 1652, "unloading": 89 * 6}
    assert set(rows["penetration"][0]) == {
        "experiment",
        "site",
        "spot",
        "tool",
        "edge_angle_deg",
        "load_N",
        "depth_mm",
        "branch",
    }
    assert len(rows["shear"]) == 108
    assert {"experiment", "site", "plate", "edge_angle_deg", "depth_mm", "lever_arm_mm", "moment_Nm"} < set(
        rows["shear"][0]
    )
    depths = [float(row["depth_mm"]) for row in rows["penetration"] if row["branch"] == "loading"]
    np.testing.assert_allclose(depths, reference_campaign(1).penetration.penetration_depth * 1e3, rtol=0, atol=1e-9)


def test_campaign_file_says_that_it_is_synthetic(tmp_path: Path) -> None:
    write_reference(tmp_path, seed=42)
    text = (tmp_path / "campaign.toml").read_text(encoding="utf-8")
    content = tomllib.loads(text)
    assert "synthetic" in content["name"]
    assert "synthetic" in content["place"]
    comment = "\n".join(line for line in text.splitlines() if line.startswith("#"))
    assert "seed 42" in comment
    for stated in ("0.01 mm", "0.5 N", "0.02 mm", "2%", "0.3", "0.15", "0.2 N m", "1 mm"):
        assert stated in comment
    assert content["gauge_resolution_mm"] == 0.01
    assert content["load_uncertainty_N"] == 0.5
    assert content["moment_uncertainty_Nm"] == 0.2
    assert content["lever_arm_uncertainty_mm"] == 1
    assert content["load_steps_N"] == [12, 92, 172, 252, 332, 412, 492]
    assert content["tool"] == [{"name": "ski piece", "shape": "ski", "length_mm": 200, "width_mm": 62}]
    assert content["plate"] == [{"name": "plate 100 mm", "length_mm": 100}]


def test_the_same_seed_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_reference(tmp_path / name, seed=3)
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_the_numbers_of_a_seed_are_those_of_published_results(tmp_path: Path) -> None:
    """Sums of all columns of seed 3 in 2026: a campaign is named by its seed."""
    write_reference(tmp_path, seed=3, turning_angles=True, creep=True)
    sums = {
        "penetration.csv": {"edge_angle_deg": 77970.0, "depth_mm": 3669.14, "depth_after_mm": 607.43},
        "shear.csv": {"edge_angle_deg": 41100.0, "depth_mm": 3934.3, "moment_Nm": 7425.57,
                      SNOW_DENSITY: 162555.0, "turning_angle_deg": 18.8087},
        "density.csv": {SNOW_DENSITY: 22172.0},
        "drop_cone.csv": {DROP_CONE_DEPTH: 1321.2},
    }  # fmt: skip
    for file, columns in sums.items():
        rows = rows_of(tmp_path / file)
        for column, expected in columns.items():
            assert sum(float(row[column] or 0.0) for row in rows) == pytest.approx(expected, rel=1e-5), (file, column)


@pytest.mark.parametrize("name", ["campaign.toml", "shear.csv", "drop_cone.csv", "corrections.csv"])
def test_an_existing_campaign_is_not_overwritten(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError, match=f"already holds a campaign .{re.escape(name)}."):
        write_reference(tmp_path, seed=1)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"


def test_other_files_in_the_folder_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    write_reference(tmp_path, seed=1)
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_a_move_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = itertools.count(1)
    replace = Path.replace

    def full_at_the_third(self: Path, target: Path) -> Path:
        if next(calls) == 3:
            raise OSError(28, "No space left on device")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", full_at_the_third)
    with pytest.raises(OutputError, match="No space"):
        write_reference(tmp_path, seed=1)
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_the_folders_place_is_a_clear_error(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(OutputError, match="not be written"):
        write_reference(tmp_path / "taken", seed=1)


def test_the_reader_gives_back_what_was_drawn(tmp_path: Path) -> None:
    write_reference(tmp_path, seed=6)
    read, drawn = read_campaign(tmp_path), reference_campaign(6).campaign()
    assert read.problems == ()
    for name in ("name", "place", "observers", "load_steps", "tools", "plates", "excluding"):
        assert getattr(read, name) == getattr(drawn, name)
    for name in ("gauge_resolution", "load_uncertainty", "moment_uncertainty", "lever_arm_uncertainty"):
        assert getattr(read, name) == pytest.approx(getattr(drawn, name), rel=1e-15)
    for table in ("penetration", "shear", "density", "drop_cone"):
        a, b = getattr(read, table), getattr(drawn, table)
        for entry in dataclasses.fields(a):
            x, y = getattr(a, entry.name), getattr(b, entry.name)
            if entry.name == "unloading":
                for back in dataclasses.fields(x):
                    np.testing.assert_allclose(getattr(x, back.name), getattr(y, back.name), rtol=1e-15, atol=0)
            elif isinstance(y, np.ndarray):
                np.testing.assert_allclose(x, y, rtol=1e-15, atol=0)  # a last bit, where a unit is applied otherwise
            elif entry.name != "further":
                assert x == y, (table, entry.name)


def rows_of(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_what_is_requested_beside_the_usual_tables_changes_nothing_of_them(tmp_path: Path) -> None:
    """The cells of the usual columns stay; of several rows of a shear test, that of the largest moment."""
    write_reference(tmp_path / "usual", seed=3)
    write_reference(tmp_path / "more", seed=3, turning_angles=True, creep=True)
    usual, more = ({file: rows_of(tmp_path / name / file) for file in FILES} for name in ("usual", "more"))
    assert more["density.csv"] == usual["density.csv"]
    assert more["drop_cone.csv"] == usual["drop_cone.csv"]
    after = [row.pop("depth_after_mm") for row in more["penetration.csv"]]
    assert more["penetration.csv"] == usual["penetration.csv"]
    creeping = {(row["site"], row["branch"]) for row, text in zip(usual["penetration.csv"], after, strict=True) if text}
    assert creeping == {("site B", "loading")}
    angles = [float(row.pop("turning_angle_deg")) for row in more["shear.csv"]]
    assert more["shear.csv"][4::5] == usual["shear.csv"]
    assert len(angles) == 5 * len(usual["shear.csv"])
    for name in ("usual", "more"):
        assert [problem for problem in read_campaign(tmp_path / name).problems if problem.severity == "error"] == []


FILES = ("penetration.csv", "shear.csv", "density.csv", "drop_cone.csv")


@pytest.mark.parametrize("seed", [0, 1])
def test_what_is_written_of_turning_and_waiting_is_read_back(seed: int, tmp_path: Path) -> None:
    drawn = reference_campaign(seed, turning_angles=True, creep=True)
    write_reference(tmp_path, seed=seed, turning_angles=True, creep=True)
    read = read_campaign(tmp_path)
    assert read.shear is not None
    assert drawn.shear.turning is not None
    assert present(read.shear.turning).turning_angle == pytest.approx(drawn.shear.turning.turning_angle, abs=1e-12)
    assert np.array_equal(present(read.shear.turning).moment, drawn.shear.turning.moment)
    assert np.array_equal(read.shear.row, drawn.shear.row)
    assert present(read.penetration).depth_after == pytest.approx(drawn.penetration.depth_after, nan_ok=True)


def test_u_y_is_found_where_nothing_errs_and_the_interval_of_u_y_holds_its_median_and_creep_is_flagged() -> None:
    """Without errors, to the rounding of moments and of angles, 0.0001° at 250 mm: 0.4 µm of 250."""
    noise = dataclasses.replace(QUIET, turning_sd=0.0)
    drawn = reference_campaign(1, noise=noise, turning_angles=True)
    found = present(skisnow.analyse(drawn.campaign(), n_resamples=100).shear)
    assert found.displacement.value == pytest.approx(drawn.shear_displacement, rel=0.01)
    assert np.median(drawn.shear_displacement) == pytest.approx(0.25e-3, rel=0.1)
    analysis = skisnow.analyse(reference_campaign(1, turning_angles=True, creep=True).campaign(), n_resamples=100)
    snow = analysis.snow()
    low, high = present(snow.shear_displacement_interval)
    assert low < 0.25e-3 < high
    flagged = screen_penetration(analysis.campaign)["creeps"].tolist()
    sites = [site for site, flag in zip(present(analysis.campaign.penetration).site, flagged, strict=True) if flag]
    assert set(sites) == {"site B"}
    assert len(sites) > 20  # of 30 series with seven depths, each of which grows by more than 1 % in e^(-1/3) = 72 %


def test_all_numbers_of_one_seed(tmp_path: Path) -> None:
    """Sums with weights from 1 to 2; the tolerance is more than one depth that is rounded the other way."""
    drawn = reference_campaign(3, turning_angles=True, creep=True)
    tests, shear = drawn.penetration, drawn.shear
    unloading, turning = present(tests.unloading), present(shear.turning)
    sums = {
        5206042819000.0: drawn.snow_hardness, -0.0002076893733: drawn.seating_offset, 53.98197049: drawn.layering,
        3.157825925: drawn.penetration_depth, 1300.332139: drawn.unloading_ratio,
        0.04098053126: drawn.shear_displacement,
        21059608.72: drawn.failure_shear_stress, 224.6829188: tests.edge_angle, 624776.1938: tests.load,
        3.159143083: tests.penetration_depth, 3106177.787: tests.row, 0.7242676681: present(tests.depth_after),
        119206.9576: unloading.first, 169578.2289: unloading.load, 1.559189362: unloading.penetration_depth,
        876147.3583: unloading.row, 222.5392665: shear.edge_angle, 1.185951682: shear.penetration_depth,
        40.5: shear.lever_arm, 3658.85271: shear.moment, 55953.40187: shear.snow_density, 49212.0: shear.row,
        49140.83333: turning.first, 0.4923483995: turning.turning_angle, 10986.94306: turning.moment,
        33139.30769: drawn.density.snow_density, 1426.666667: drawn.density.row,
        1.967772449: drawn.drop_cone.drop_cone_depth, 8398.5: drawn.drop_cone.row,
    }  # fmt: skip
    weighted = [float(np.nansum(values * np.linspace(1.0, 2.0, values.size))) for values in sums.values()]
    assert weighted == pytest.approx(list(sums), rel=1e-5)
    write_reference(tmp_path / "all", seed=3, turning_angles=True, creep=True)
    write_reference(tmp_path / "plain", seed=3)
    of_all, of_plain = (
        " ".join(re.findall(r"[-\d.]*\d", (tmp_path / name / "campaign.toml").read_text("utf-8").split("[[")[0]))
        for name in ("all", "plain")
    )
    last = " 3 0.01 0.5 0.2 1 12 92 172 252 332 412 492"
    plain = (
        "3 2013 0.01 0 0.5 0.02 3 10 0.15 2 0.3 0.04-90 3 7 7 1 2 2 1 2 0.8 0.03 2 0.006 13 0.059 14 14 0.04-0.40 0.2 1"
    )
    assert of_plain == plain + last
    assert of_all == plain + " 0.25 0.2 0.002 0.03" + last
