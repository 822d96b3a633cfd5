"""From a campaign to a turn with objects alone."""

import json
import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import netcdf_file

import skisnow
from skisnow import Analysis, Run, SnowProperties
from skisnow._support.errors import ParameterError
from skisnow.campaign import Campaign
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation.results import results_json
from tests.coded import Coded, coded, raises
from tests.key_names import EDGE_ANGLE
from tests.present import present

from .conftest import without_figures
from .report.runs import RADIUS, SPEED, circle_run


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    return reference_campaign(1).campaign()


@pytest.fixture(scope="module")
def analysis(campaign: Campaign) -> Analysis:
    return skisnow.analyse(campaign, n_resamples=100)


class Written:
    """Files that are opened for writing while it listens."""

    listens = False
    files: tuple[object, ...] = ()

    def __init__(self) -> None:
        sys.addaudithook(self._hear)  # stays until Python ends

    def _hear(self, event: str, args: tuple[Any, ...]) -> None:
        if not self.listens or event != "open" or isinstance(args[0], int):
            return  # a number is a pipe, to a process of the test runner's say; a file had its name when it was opened
        if isinstance(args[1], str) and set(args[1]) & set("wax+"):
            self.files += (args[0],)


@pytest.fixture
def no_disk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    written = Written()
    written.listens = True
    yield
    written.listens = False
    assert written.files == ()
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def campaign_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a campaign, written before anything listens."""
    made = tmp_path_factory.mktemp("campaign")
    skisnow.write_reference(made / "campaign", seed=1)
    return made / "campaign"


@pytest.mark.usefixtures("no_disk")
def test_a_dozen_lines_without_the_disk(campaign_folder: Path) -> None:
    campaign = skisnow.read_campaign(campaign_folder)
    analysis = skisnow.analyse(campaign, n_resamples=100)
    snow = analysis.snow("C", unloading_ratio=10)
    ski = skisnow.read_ski("carver")
    turn = skisnow.load_scenario("carved-46m").with_(snow=snow, ski=ski, speed_m_per_s=4.5, duration_s=0.1)
    run = skisnow.simulate(turn)
    assert run.outcome == "finished"
    assert run.scenario.contact.snow is snow
    assert run.scenario.contact.unloading_ratio == 10
    assert run.scenario.ski is ski
    assert run.track.time[-1] == pytest.approx(0.1, rel=1e-12)
    assert len(run.to_dataframe()) == len(run.track) == 11
    assert run.to_xarray().sizes["time"] == 11
    assert run.plot().axes


def test_snow_of_a_site_is_that_of_results_json(analysis: Analysis, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    path.write_bytes(results_json(analysis.results))
    for site in ("site C", None):
        told = skisnow.read_snow(path, site=site)
        assert replace(analysis.snow(site), source=told.source) == told
    assert analysis.snow("C", unloading_ratio=3.0).unloading_ratio == 3.0
    assert replace(analysis.snow("C", unloading_ratio=3.0), unloading_ratio=None) == analysis.snow("site C")


def test_snow_of_a_site_by_hand_and_an_unknown_site_is_rejected_with_those_that_there_are(analysis: Analysis) -> None:
    tests, found = analysis.campaign.penetration, analysis.penetration
    mine = present(found).screened.used & (np.array(present(tests).site) == "site C")
    by_hand = math.exp(float(np.mean(np.log(present(found).hardness["H_V"].value[mine]))))
    assert analysis.snow("C").snow_hardness == pytest.approx(by_hand, rel=1e-12)
    with pytest.raises(ParameterError, match=r"'Z'; .*'site A', .*C'"):
        analysis.snow("Z")
    with pytest.raises(ParameterError, match=r"unloading_ratio is 0\.5"):
        analysis.snow("C", unloading_ratio=0.5)


def test_results_of_one_analysis_are_the_same_whenever_they_are_requested(analysis: Analysis) -> None:
    assert skisnow.results_dict(analysis) == skisnow.results_dict(analysis) == analysis.results


def test_a_report_takes_one_object(campaign: Campaign, analysis: Analysis, tmp_path: Path) -> None:
    """Results of one campaign beside another one can no longer be asked for."""
    with pytest.raises(TypeError):
        skisnow.write_report(campaign, analysis.results, tmp_path)  # type: ignore[call-arg, arg-type]
    with pytest.raises(ParameterError, match=r"write_report\(analyse\(.*Campaign"):
        skisnow.write_report(campaign, tmp_path)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_with_changes_by_part_and_by_key() -> None:
    turn = skisnow.load_scenario("carved-46m")
    other = turn.with_(H_V_N_per_mm3=0.4, edge_angle_deg=35, mu_0=0.02, centre_of_mass_forward_m=0.1, step_ms=0.25)
    snow, sledge = other.contact.snow, other.sledge
    assert (snow.snow_hardness, snow.failure_shear_stress) == (0.4e9, turn.contact.snow.failure_shear_stress)
    assert snow.source.endswith("H_V given as a number")
    assert (sledge.edge_angle, sledge.centre_of_mass) == (math.radians(35.0), (0.1, turn.sledge.centre_of_mass[1]))
    assert (other.contact.friction, other.solver.step) == (0.02, 0.25e-3)
    assert turn.sledge.edge_angle == math.radians(30.0)
    assert turn.with_(slope=skisnow.scenario.Plane(0.1)).slope == skisnow.scenario.Plane(0.1)
    assert turn.with_(ski="slalom").ski.name == "slalom"


def test_a_number_for_the_snow_takes_the_interval_of_the_measured_one_away(analysis: Analysis) -> None:
    turn = skisnow.load_scenario("carved-46m").with_(snow=analysis.snow("C"))
    other = turn.with_(S_f_N_per_mm2=0.3).contact.snow
    assert (other.failure_shear_stress, other.failure_shear_stress_interval) == (0.3e6, None)
    assert other.snow_hardness_interval == turn.contact.snow.snow_hardness_interval


def test_a_snow_takes_its_unloading_ratio_along_only_where_it_has_one() -> None:
    turn = skisnow.load_scenario("carved-46m")
    soft = SnowProperties(1e8, 2e5, source="mine")
    assert turn.with_(snow=soft).contact.unloading_ratio == turn.contact.unloading_ratio == 10.0
    assert turn.with_(snow=replace(soft, unloading_ratio=3.0)).contact.unloading_ratio == 3.0
    assert turn.with_(snow=replace(soft, unloading_ratio=3.0), unloading_ratio=1).contact.unloading_ratio == 1.0


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"edge_angel_deg": 3}, coded("unknown_name", similar=EDGE_ANGLE)),
        ({"edge_angle_deg": 91}, coded("out_of_range", name=EDGE_ANGLE, value="91")),
        (
            {"slope": skisnow.Profile(np.arange(60.0), -0.2 * np.arange(60.0)), "angle_deg": 5},
            coded("wrong_kind", name="slope.angle_deg", part="slope"),
        ),
        ({"penetration": "elastic"}, coded("wrong_kind", name="snow.penetration")),
        ({"snow": 0.2}, coded("wrong_kind", kind="float")),
        ({"snow": SnowProperties(1e8, None, source="mine")}, coded("no_data", source="mine")),
        ({"stance_width_m": 0.05}, coded("contradiction", stance=0.05)),
    ],
)
def test_impossible_changes_of_a_scenario_are_errors(changes: dict[str, Any], expected: Coded) -> None:
    with raises(ParameterError, expected):
        skisnow.load_scenario("carved-46m").with_(**changes)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of a circle at 8 m/s."""
    with without_figures():
        return circle_run().report(tmp_path_factory.mktemp("run") / "new").parent


def test_report_of_a_run_is_the_folder_of_the_command(folder: Path) -> None:
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    drawn = ("track", "motion", "along_ski", "grip", "energies")
    figures = {f"figures/{name}.{form}" for name in drawn for form in ("png", "svg", "pdf", "csv")}
    assert names == {"summary.json", "track.csv", "run.nc", "report.html", *figures}
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"] == "finished"
    assert summary["scenario"]["start"]["speed_m_per_s"] == SPEED


def test_track_of_a_run_is_what_its_file_says(folder: Path) -> None:
    track, read = circle_run().track, skisnow.read_track(folder / "track.csv")
    for name in ("time", "place", "speed"):
        assert np.array_equal(getattr(track, name), getattr(read, name)), name
    assert track.flagged == read.flagged == {}
    assert track.axes == "slope"
    assert skisnow.compare(track, read).nearest.numbers == skisnow.compare(read, read).nearest.numbers


def test_dataframe_has_the_columns_of_the_file() -> None:
    table = circle_run().to_dataframe()
    assert list(table.columns[:4]) == ["time_s", "x_m", "y_m", "z_m"]
    assert table["turn_radius_m"].to_numpy() == pytest.approx(RADIUS, rel=1e-12)
    assert table["speed_m_per_s"].iloc[0] == pytest.approx(SPEED, rel=1e-12)


def test_dataset_holds_what_the_file_holds(folder: Path) -> None:
    pytest.importorskip("xarray")
    run = circle_run()
    dataset = run.to_xarray()
    with netcdf_file(folder / "run.nc", mmap=False) as file:
        assert set(file.variables) - {"ski_name"} == set(map(str, dataset.variables)) - {"ski"}
        for name in set(file.variables) - {"ski_name"}:
            assert np.array_equal(dataset[name].values, file.variables[name][:]), name
            units: bytes = vars(file.variables[name])["units"]
            assert dataset[name].attrs["units"] == units.decode()
    outer = dataset["edge_depth"].sel(ski="right").max("station")
    assert float(outer[0]) == float(run.skis.edge_depth[0, 1].max())


@pytest.mark.parametrize(("package", "ask"), [("pandas", Run.to_dataframe), ("xarray", Run.to_xarray)])
def test_a_missing_package_is_named(package: str, ask: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ParameterError, match=rf"needs {package}, .*pip install 'skisnow\[{package}\]'"):
        ask(circle_run())


def test_a_figure_that_cannot_be_is_rejected() -> None:
    run = circle_run(count=3)
    assert run.plot("energies").axes
    with raises(ParameterError, "unknown_figure", similar="energies"):
        run.plot("enrgies")
    with raises(ParameterError, "nothing_to_draw"):
        replace(run, time=run.time[:1]).plot()
