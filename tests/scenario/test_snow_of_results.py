"""Snow of a scenario from the results of a campaign: every way to give it, and what numbers beside it replace."""

from dataclasses import replace
from pathlib import Path

import pytest

import skisnow
from skisnow import Analysis
from skisnow._support.errors import ParameterError
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation.comparisons import SiteValue
from skisnow.estimation.results import results_json
from skisnow.scenario import load_scenario, scenario_file
from skisnow.scenario.reading import build_input, load_input
from skisnow.scenario.resolution import ContradictionError
from tests.coded import raises
from tests.key_names import SHEAR_DISPLACEMENT

from .test_reading import written


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> tuple[Analysis, Path]:
    """The reference campaign's analysis as if k_u/H_V and u_y had been measured at site C, and the folder of its
    results.json.

    Its site E has neither.
    """
    analysis = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    pressed, sheared = analysis.penetration, analysis.shear
    assert pressed is not None
    assert sheared is not None
    unloading = (replace(pressed.site_unloading[0], site="site C"), *pressed.site_unloading[1:])
    ways = (SiteValue("site C", 3, 2.5e-4, 2.0e-4, 3.2e-4), SiteValue(None, 3, 2.5e-4, 2.0e-4, 3.2e-4))
    analysis = replace(
        analysis, penetration=replace(pressed, site_unloading=unloading), shear=replace(sheared, site_displacement=ways)
    )
    folder = tmp_path_factory.mktemp("measured")
    (folder / "results.json").write_bytes(results_json(skisnow.results_dict(analysis)))
    return analysis, folder


def with_results(folder: Path, site: str, **replaced: str) -> Path:
    """carved-46m on the snow of a site, with neither k_u/H_V nor u_y unless they stand among the replaced lines."""
    lines = {"unloading_ratio": "", "shear_displacement_mm": "", **replaced}
    return written(folder, replaced={"H_V": 'results = "results.json"', "S_f": f'site = "{site}"', **lines})


@pytest.mark.parametrize("site", ["C", "E"])
def test_results_give_what_the_site_measured_by_every_way(measured: tuple[Analysis, Path], site: str) -> None:
    """A file without further numbers, a change of a scenario that has some, and the objects: one and the same."""
    analysis, folder = measured
    snow = analysis.snow(site)
    assert (snow.unloading_ratio is None, snow.shear_displacement is None) == (site == "E", site == "E")
    by_object = load_scenario("carved-46m").with_(snow=snow).contact
    changes = {"snow.results": str(folder / "results.json"), "snow.site": site}
    changed = scenario_file("carved-46m", changes=changes)
    found = [changed.scenario.contact]
    if site == "C":
        found.append(load_scenario(with_results(folder, site)).contact)
        assert changed.values["snow.unloading_ratio"] == snow.unloading_ratio
        assert changed.values[SHEAR_DISPLACEMENT] == pytest.approx(0.25, rel=1e-12)
    for contact in found:
        assert replace(contact, snow=replace(contact.snow, source=snow.source)) == by_object


def test_numbers_beside_or_after_the_results_come_before_what_was_measured(measured: tuple[Analysis, Path]) -> None:
    analysis, folder = measured
    numbers = {"unloading_ratio": "unloading_ratio = 4", "shear_displacement_mm": "shear_displacement_mm = 0.1"}
    beside = with_results(folder, "C", **numbers)
    results: dict[str, object] = {"snow.results": str(folder / "results.json"), "snow.site": "C"}
    after: dict[str, object] = {"unloading_ratio": 4.0, "shear_displacement_mm": 0.1}
    given = load_input("carved-46m").changed(results).changed(after)
    by_object = load_scenario("carved-46m").with_(snow=analysis.snow("C")).with_(**after)
    ways = [load_scenario(beside), load_scenario("carved-46m", changes=results | after), build_input(given).scenario]
    for scenario in (*ways, by_object):
        contact = scenario.contact
        assert [contact.unloading_ratio, contact.shear_displacement] == pytest.approx([4.0, 1e-4], rel=1e-12)
        # summary.json and what a scenario shows do not give an interval to a number that it is not of
        assert (contact.snow.unloading_ratio_interval, contact.snow.shear_displacement) == (None, None)
        assert "k_u/H_V 4:" in repr(scenario)


def test_elastic_snow_stays_elastic_on_measured_snow(measured: tuple[Analysis, Path]) -> None:
    path = with_results(measured[1], "C", penetration='penetration = "elastic"')
    assert load_scenario(path).contact.unloading_ratio == 1.0


def test_a_site_without_unloading_needs_a_ratio(measured: tuple[Analysis, Path]) -> None:
    with raises(ParameterError, "missing"):
        load_scenario(with_results(measured[1], "E"))


@pytest.mark.parametrize(
    ("changes", "keys"),
    [
        ({"H_V_N_per_mm3": 1, "published": "race-piste"}, ("snow.H_V_N_per_mm3", "snow.published")),
        ({"published": "race-piste", "S_f_N_per_mm2": 0.3}, ("snow.published", "snow.S_f_N_per_mm2")),
        ({"ski.name": "carver", "ski.file": "a.toml"}, ("ski.name", "ski.file")),
        ({"course.name": "slalom-20-gates", "course.file": "c.csv"}, ("course.name", "course.file")),
    ],
)
def test_two_keys_of_one_layer_contradict_each_other(changes: dict[str, object], keys: tuple[str, str]) -> None:
    with pytest.raises(ContradictionError) as error:
        load_scenario("carved-46m", changes=changes)
    assert error.value.keys == keys
