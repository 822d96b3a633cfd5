"""results.json: the contract, on the reference campaign and on campaigns that lack almost everything."""

import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jsonschema
import numpy as np
import pytest

import skisnow
from skisnow.campaign import Campaign, read_campaign, write_reference
from skisnow.cli.shell import json_schema
from skisnow.estimation import analyse, results_dict
from skisnow.estimation.analysis import _relation_facts
from skisnow.estimation.result_rows import (
    experiment_hardness,
    experiment_results,
    first_hardness,
    selected_model,
    whole_degrees,
    without_nan,
)
from skisnow.estimation.results import _published_relations, results_json
from skisnow.snow.published.hand_hardness import RESISTANCE_SOURCE
from tests.coded import raises
from tests.key_names import DROP_CONE_DEPTH, SNOW_DENSITY
from tests.present import present

from .conftest import MakeCampaign

SCHEMA = jsonschema.Draft202012Validator(json_schema("results"))
Json = dict[str, Any]


def results_of(campaign: Campaign | Path, **options: Any) -> Json:
    """Analyse, go through JSON, hold against the schema."""
    text = results_json(skisnow.results_dict(skisnow.analyse(campaign, n_resamples=100, **options))).decode("utf-8")
    assert "NaN" not in text
    assert "Infinity" not in text
    results: Json = json.loads(text)
    SCHEMA.validate(results)
    return results


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    folder = tmp_path_factory.mktemp("reference") / "campaign"
    write_reference(folder, seed=1)
    return read_campaign(folder)


@pytest.fixture(scope="module")
def results(reference: Campaign) -> Json:
    return results_of(reference)


def test_every_experiment_is_there_in_the_order_of_the_file(results: Json, reference: Campaign) -> None:
    rows = results["penetration"]["experiments"]
    assert [row["experiment"] for row in rows] == list(present(reference.penetration).experiment)
    assert [row["experiment"] for row in results["shear"]["experiments"]] == list(present(reference.shear).experiment)
    assert len(rows) == 236
    assert sum(row["n_loads"] for row in rows) == 236 * 7
    assert len(results["shear"]["experiments"]) == 108


@pytest.mark.parametrize("terms", ["linear", "constant"])
def test_the_paper_s_order_of_the_definitions(results: Json, terms: str) -> None:
    rmse = {row["id"]: row["rmse_N"] for row in results["penetration"]["models"]}
    H_e, H_A, H_V = (rmse[f"{symbol}:a={terms},b={terms}"] for symbol in ("H_e", "H_A", "H_V"))
    assert H_e > H_A > H_V
    last = [value for name, value in rmse.items() if name.startswith("H_V")]
    assert max(last) < 1.05 * min(last)
    assert results["penetration"]["campaign_model"]["priors"]["mean_exponent"] == 1.0


def test_coefficients_are_in_the_units_of_the_table(results: Json, reference: Campaign) -> None:
    """rmse worked out again from the file's own numbers: N, mm, mm², mm³, rad."""
    tests = present(reference.penetration)
    tool, series = reference.tools[tests.tool[0]], tests.series_of_reading
    rows = results["penetration"]["experiments"]
    used = np.array([row["used"] for row in rows])[series]
    angle = tests.edge_angle[series]
    A_mm2 = tool.contact_area(tests.penetration_depth, angle) * 1e6
    V_mm3 = tool.displaced_volume(tests.penetration_depth, angle) * 1e9
    keys = {"H_e": "H_e_N_per_mm", "H_A": "H_A_N_per_mm2", "H_V": "H_V_N_per_mm3"}
    for model in results["penetration"]["models"]:
        H = np.array([row[keys[model["hardness"]]] for row in rows])[series]
        law = H * ((model["a0"] + model["a1"] * angle) * A_mm2 + (model["b0"] + model["b1"] * angle) * V_mm3)
        rmse = math.sqrt(float(np.mean((law - tests.load)[used] ** 2)))
        assert model["rmse_N"] == pytest.approx(rmse, rel=1e-9), model["id"]


def test_nested_tests_cover_all_pairs_and_say_where_they_do_not_hold(results: Json) -> None:
    tests = results["penetration"]["tests"]
    assert len(tests) == 11
    bounded = {row["id"] for row in results["penetration"]["models"] if row["at_bound"]}
    for test in tests:
        assert test["valid_classically"] == (not {test["full"], test["reduced"]} & bounded)
        rows = {row["id"]: row for row in results["penetration"]["models"]}
        full, reduced = rows[test["full"]], rows[test["reduced"]]
        assert test["df"] == [full["n_parameters"] - reduced["n_parameters"], full["n"] - full["n_parameters"]]
        assert test["rmse_change_percent"] == pytest.approx(100 * (reduced["rmse_N"] / full["rmse_N"] - 1), abs=1e-9)


def test_regressions_are_the_planned_ones_in_order(results: Json) -> None:
    found = [(row["response"], row["terms"][1], row["group"]) for row in results["regressions"]]
    pooled = [entry[:2] for entry in found if entry[2] == "all"]
    assert pooled == [
        ("S_f_N_per_mm2", "edge_angle_rad"),
        ("S_f_N_per_mm2", SNOW_DENSITY),
        ("S_f_N_per_mm2", DROP_CONE_DEPTH),
        ("H_V_N_per_mm3", SNOW_DENSITY),
        ("H_V_N_per_mm3", DROP_CONE_DEPTH),
        ("S_f_N_per_mm2", "H_V_N_per_mm3"),
    ]
    assert [row["n"] for row in results["regressions"] if row["group"] != "all"] == [20, 30]
    soft = next(row for row in results["regressions"] if row["n"] == 30)
    # Eqn 13 is the truth of the soft site: 0.059 (1 - 0.266 ϑ)
    assert soft["interval"][0][0] < soft["b"][0] < soft["interval"][0][1]
    assert soft["interval"][1][0] < -0.059 * 0.266 < soft["interval"][1][1] or soft["p"] < 0.01


def test_sites_share_a_letter_where_their_pair_of_that_quantity_is_not_shown_to_differ(results: Json) -> None:
    """In the reference campaign H_V of sites C and E differs, S_f does not."""
    letters = {(row["quantity"][:3], row["site"]): set(row["letters"]) for row in results["site_means"]}
    pairs = [row for row in results["group_comparisons"] if row["by"] == "site"]
    assert len(pairs) == 28 + 21
    for row in pairs:
        a, b = letters[row["quantity"], row["group_a"]], letters[row["quantity"], row["group_b"]]
        assert bool(a & b) == (row["p_holm"] >= 0.05), row


def test_comparison_with_eqn_11_is_that_of_the_model_with_a_linear_factor_of_the_volume(results: Json) -> None:
    (model,) = (row for row in results["penetration"]["models"] if row["id"] == "H_V:a=none,b=linear")
    own = {row["quantity"]: row for row in results["comparisons"] if "Eqn 11" in row["source"]}
    for quantity, key in (("b0", "b0"), ("b1_per_rad", "b1")):
        assert (own[quantity]["own"], own[quantity]["own_interval"]) == (model[key], model["intervals"][key])


def test_reason_of_the_chosen_model_states_its_distance_from_the_best_above_five_thousandths_of_a_percent() -> None:
    def reason(*rmse: float) -> Json:
        fits = [SimpleNamespace(model=SimpleNamespace(id=name), rmse=value, n_parameters=n)
                for name, value, n in zip(("best", "simple"), rmse, (3, 1), strict=True)]  # fmt: skip
        analysis: Any = SimpleNamespace(selected=fits[1], table=SimpleNamespace(fits=fits))
        chosen = present(selected_model(analysis))
        assert chosen["id"] == "simple"
        fields: Json = chosen["reason"].fields
        return fields

    more = {"rmse": 0.51, "parameters": 1, "best_rmse": 0.5, "best": "best", "best_parameters": 3}
    assert reason(0.5, 0.51) == {**more, "more": pytest.approx(2.0)}
    assert reason(10.0, 10.0006)["more"] == pytest.approx(0.006)
    for same in (10.0, 10.0004), (0.0, 0.0):
        assert reason(*same).keys() == more.keys()
    assert reason(10.0, 9.0) == {"rmse": 9.0, "parameters": 1}


def test_the_same_seed_gives_the_same_numbers(reference: Campaign, results: Json) -> None:
    again = results_of(reference)
    again["provenance"].pop("time")
    first = {**results, "provenance": {k: v for k, v in results["provenance"].items() if k != "time"}}
    assert again == first
    other = results_of(reference, seed=2)
    assert other["penetration"]["models"][0]["intervals"] != first["penetration"]["models"][0]["intervals"]
    assert other["penetration"]["models"][0]["rmse_N"] == first["penetration"]["models"][0]["rmse_N"]


def test_only_shear(make_campaign: MakeCampaign) -> None:
    results = results_of(make_campaign(shear=[("s1", "A", "blade", 90, 6, 250, 30)]))
    assert "published_relations" not in results  # they take the place of measurements
    assert results["penetration"]["experiments"] == []
    assert [row["rmse_N"] for row in results["penetration"]["models"]] == [None] * 9
    assert results["penetration"]["selected"] is None
    assert results["penetration"]["tests"] == []
    single = results["regressions"][0]
    assert (single["n"], single["b"], single["p"]) == (1, None, None)
    assert [row["n"] for row in results["regressions"]] == [1, 0, 0, 0, 0, 0]


def test_only_one_flat_series(make_campaign: MakeCampaign) -> None:
    rows = [("p1", "A", "ski", 0, load, depth) for load, depth in ((100, 1.0), (200, 2.1), (300, 2.9))]
    results = results_of(make_campaign(rows))
    assert "published_relations" not in results
    assert results["shear"]["experiments"] == []
    models = {row["id"]: row for row in results["penetration"]["models"]}
    assert models["H_V:a=linear,b=linear"]["b1"] is None
    assert models["H_V:a=linear,b=linear"]["rmse_N"] == models["H_V:a=constant,b=constant"]["rmse_N"]
    test = next(t for t in results["penetration"]["tests"] if t["reduced"] == "H_V:a=constant,b=constant")
    assert (test["F"], test["p"]) == (None, None)
    assert models["H_V:a=none,b=one"]["b0"] == 1.0
    assert models["H_V:a=none,b=one"]["intervals"] == dict.fromkeys(("a0", "a1", "b0", "b1"))


def test_nothing_used_still_shows_everything(make_campaign: MakeCampaign) -> None:
    rows = [("p1", "A", "ski", 30, load, 1.0, "tilted") for load in (100, 200, 300)]
    results = results_of(make_campaign(rows, columns=",status"))
    experiment = results["penetration"]["experiments"][0]
    assert experiment["used"] is False
    assert experiment["flags"] == ["cancelled"]
    assert experiment["H_V_N_per_mm3"] is not None
    assert results["penetration"]["selected"] is None
    assert [row["n"] for row in results["penetration"]["models"]] == [0] * 9


def test_at_zero_depth_hardness_is_null_and_the_series_takes_no_part(make_campaign: MakeCampaign) -> None:
    rows = [("p1", "A", "ski", 30, load, 0.0) for load in (100, 200, 300)]
    rows += [("p2", "A", "ski", 30, load, load / 100) for load in (100, 200, 300)]
    results = results_of(make_campaign(rows, extra="[screening]\nexclude = []\n"))
    first, second = results["penetration"]["experiments"]
    assert first["H_V_N_per_mm3"] is first["H_e_N_per_mm"] is first["H_V_interval_N_per_mm3"] is None
    assert "zero_depth" in first["flags"]
    assert (first["used"], second["used"]) == (False, True)
    assert results["penetration"]["models"][0]["n_series"] == 1


def test_the_paper_s_geometry_is_a_choice_that_the_results_name(make_campaign: MakeCampaign) -> None:
    """At 5° and 10 mm the plain wedge counts snow beside the base: V = L e²/(2 tan ϑ)."""
    rows = [("p1", "A", "ski", 5, load, load / 30) for load in (100, 200, 300)]
    campaign = make_campaign(rows)
    plain, extended = results_of(campaign, geometry="paper"), results_of(campaign)
    wedge_mm3 = 200 * 10**2 / 2 / math.tan(math.radians(5))
    assert plain["penetration"]["experiments"][0]["H_V_N_per_mm3"] == pytest.approx(300 / wedge_mm3)
    whole_mm3 = 200 * 62 * math.cos(math.radians(5)) * (10 - 31 * math.sin(math.radians(5)))
    assert extended["penetration"]["experiments"][0]["H_V_N_per_mm3"] == pytest.approx(300 / whole_mm3)
    assert plain["penetration"]["experiments"][0]["flags"] == ["beyond_tool"]
    assert extended["penetration"]["experiments"][0]["flags"] == []
    assert plain["provenance"]["options"]["geometry"] == "paper"


def test_without_any_uncertainty_a_shear_interval_is_null(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    make_campaign(shear=[("s1", "A", "blade", 90, 6, 250, 30)])
    toml = tmp_path / "campaign" / "campaign.toml"
    toml.write_text('[[plate]]\nname = "blade"\nlength_mm = 100\n', encoding="utf-8")
    results = results_of(tmp_path / "campaign")
    assert results["shear"]["experiments"][0]["S_f_interval_N_per_mm2"] is None
    assert results["campaign"]["gauge_resolution_mm"] is None


def test_snow_from_results(results: Json, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    path.write_text(json.dumps(results), encoding="utf-8")
    snow = skisnow.read_snow(path, site="site C")
    rows = [r for r in results["penetration"]["experiments"] if r["used"] and r["site"] == "site C"]
    mean = math.exp(sum(math.log(r["H_V_N_per_mm3"]) for r in rows) / len(rows))
    assert snow.snow_hardness == pytest.approx(mean * 1e9, rel=1e-12)
    with raises(skisnow._support.errors.ParameterError, "no_data"):
        skisnow.read_snow(path, site="nowhere")


def test_names_of_any_kind_survive_the_writing(make_campaign: MakeCampaign) -> None:
    names = ["plain", 'a"},{"b', "ϑ, ü"]
    quoted = ['"' + name.replace('"', '""') + '"' for name in names]
    rows = [(name, "A", "ski", 0, load, load / 100) for name in quoted for load in (100, 200, 300)]
    results = results_of(make_campaign(rows, [("s1", "A", "blade", 90, 6, 250, 30)]))
    assert [row["experiment"] for row in results["penetration"]["experiments"]] == names


def test_the_numbers_are_those_of_the_analysis(tmp_path: Path) -> None:
    write_reference(tmp_path / "campaign", seed=2)
    campaign = read_campaign(tmp_path / "campaign")
    results = results_dict(analyse(campaign, n_resamples=100))
    found = experiment_results(campaign)
    assert found["penetration"]["experiments"] == results["penetration"]["experiments"]
    assert found["shear"]["experiments"] == results["shear"]["experiments"]


def test_each_entry_of_a_list_has_a_line_of_its_own() -> None:
    """Unless a name contains what parts the rows."""
    text = results_json({"a": 1, "b": {"c": [{"d": 1, "e": [1, 2]}, {"d": 2}], "f": {}}, "g": [{"h": "},{"}]})
    rows = [b'   {"d":1,"e":[1,2]},', b'   {"d":2}']
    wanted = [b"{", b' "a": 1,', b' "b": {', b'  "c": [', *rows, b"  ],", b'  "f": {}', b" },", b' "g": [{"h":"},{"}]']
    assert text.split(b"\n") == [*wanted, b"}", b""]


def test_a_recording_without_a_density_has_a_hardness() -> None:
    recordings = SimpleNamespace(site=["A", "A", "A"], settings=SimpleNamespace(relation="relation"))
    evaluated = [SimpleNamespace(is_used=used, resistance=100e3) for used in (True, True, False)]
    pen = SimpleNamespace(
        recordings=recordings, snow_density=np.array([300.0, math.nan, math.nan]), evaluated=evaluated
    )
    analysis: Any = SimpleNamespace(campaign=SimpleNamespace(density=None), snow_micro_pen=pen)
    (row,) = _published_relations(analysis)
    assert (row["n"], row["snow_density_kg_per_m3"], row["penetration_resistance_kPa"]) == (2, 300.0, 100.0)
    assert (row["hand_hardness"], row["hardness_relation"]) == ("1F+", RESISTANCE_SOURCE)
    name, told = _relation_facts(row)
    assert name == "hardness at A"
    assert told.startswith("100 kPa, hand hardness 1F+ (index ")
    sampled = _relation_facts({**row, "penetration_resistance_kPa": None, "hand_hardness_index": None})
    assert sampled[1].startswith("hand hardness outside of the range")


def test_too_few_resamples_are_rejected(make_campaign: MakeCampaign) -> None:
    rows = [("p1", "A", "ski", 0, load, depth) for load, depth in ((100, 1.0), (200, 2.1), (300, 2.9))]
    with raises(skisnow._support.errors.ParameterError, "out_of_range"):
        skisnow.analyse(make_campaign(rows), n_resamples=39)
    for difference in (0.0, -0.1, math.inf):
        with raises(skisnow._support.errors.ParameterError, "out_of_range"):
            skisnow.analyse(make_campaign(rows), difference=difference)


def test_an_analysis_shows_the_ends_of_its_interval_and_tells_its_steps(reference: Campaign) -> None:
    steps: list[str] = []
    analysis = skisnow.analyse(reference, n_resamples=100, progress=steps.append)
    assert any("236" in step for step in steps)
    shown = dict(analysis._repr_facts().rows)
    assert f"{analysis.own_hardness.low:.4g}" in shown["H_V"]
    assert (shown["penetration"].split()[0], shown["shear"].split()[0]) == ("236", "108")
    assert shown["model"].partition(", rmse")[0] == analysis.results["penetration"]["selected"]["id"]


def test_first_hardness_is_that_of_the_first_series_on_an_edge_that_has_one(make_campaign: MakeCampaign) -> None:
    """At 45° and 2 mm the wedge has 200 mm · 2² mm²/2 = 400 mm³: 300 N give 0.75 N/mm³."""
    angles, depths = {"flat": 0, "shallow": 45, "first": 45, "second": 45}, (3.0, 0.0, 2.0, 4.0)
    rows = [(name, "A", "ski", angle, load, depth) for (name, angle), depth in zip(angles.items(), depths, strict=True)
            for load in (100, 200, 300)]  # fmt: skip
    name, hardness = present(first_hardness(make_campaign(rows)))
    assert name == "first"
    assert hardness == pytest.approx(0.75)
    assert first_hardness(make_campaign(rows[:6])) is None


def test_hardness_of_a_campaign_without_penetration_tests(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(shear=[("s1", "A", "blade", 90, 6, 250, 30)])
    assert experiment_hardness(campaign).shape == (0,)
    assert first_hardness(campaign) is None


def test_angles_are_whole_to_eleven_decimals() -> None:
    assert whole_degrees(np.radians([0.1, 35.0, 12.345678901234])) == [0.1, 35.0, 12.34567890123]


@pytest.mark.parametrize(
    ("value", "written"),
    [
        ([1.0, 2.0], [1.0, 2.0]),
        ([1.0, math.nan], None),
        ({"b": [[0.5, math.inf]]}, {"b": [None]}),
        ([1.0, math.inf, 2.0], [1.0, None, 2.0]),
        (["a", None], ["a", None]),
    ],
)
def test_an_interval_is_null_unless_both_ends_are_known(value: object, written: object) -> None:
    assert without_nan(value) == written
