"""The chain from a campaign to a turn, in Python and by its command; runs are replaced by ones in closed form."""

import inspect
import json
import math
import re
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from referencing import Registry, Resource

import skisnow
from skisnow import Analysis, Run, Scenario
from skisnow import pipeline as pipeline_turn
from skisnow._support.errors import ParameterError
from skisnow.campaign.reference import reference_campaign
from skisnow.cli import main
from skisnow.cli.shell import json_schema
from skisnow.forces.shear.law import SHEAR_DISPLACEMENT
from skisnow.parameters import values_of
from skisnow.pipeline import MEASURED, PRIORS, inputs_with
from skisnow.report.turn.chain import turn_dict
from skisnow.scenario.identify_section import prior_of
from skisnow.ski import write_ski
from skisnow.snow import SnowProperties
from tests.coded import Coded, coded, raises
from tests.present import present

from ..report.runs import circle_run

PACKAGE = Path(skisnow.__file__).parent
Printed = pytest.CaptureFixture[str]
TURN = {"slope.angle_deg": 5.0, "start.speed_m_per_s": 4.5, "sledge.edge_angle_deg": 40.0}


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Scenario]:
    """The scenarios that were simulated; the softer the snow, the tighter the circle that comes out."""
    scenarios: list[Scenario] = []

    def circle(scenario: Scenario) -> Run:
        scenarios.append(scenario)
        contact = scenario.contact
        radius = 10.0 * (contact.snow.snow_hardness / 4.42e8) ** 0.1 + (contact.unloading_ratio == 1.0)
        return replace(circle_run(radius=radius, count=61, unloading_ratio=contact.unloading_ratio), scenario=scenario)

    monkeypatch.setattr(pipeline_turn, "simulate", circle)
    return scenarios


def test_the_chain_simulates_each_contact_and_each_drawn_snow(analysis: Analysis, asked: list[Scenario]) -> None:
    said: list[str] = []
    turn = skisnow.load_scenario("carved-46m", changes=TURN)
    found = skisnow.turn(analysis, "C", turn, ski="carver", runs=4, seed=3, workers=1, progress=said.append)
    snow = analysis.snow("site C", unloading_ratio=10.0)
    drawn = pipeline_turn.drawn_scenarios(asked[0], PRIORS, 4, 3)
    assert found.snow == snow
    assert [each.contact.snow for each in asked[:7]] == [snow, snow, snow, *(each.contact.snow for each in drawn)]
    assert [each.contact.unloading_ratio for each in asked[:3]] == [10.0, 1.0, 10.0]
    assert [each.contact.unloading_ratio for each in asked[3:7]] == [each.contact.unloading_ratio for each in drawn]
    assert [each.solver.method for each in asked] == ["default"] * 2 + ["fast"] * 13
    assert {each.ski.name for each in asked} == {skisnow.read_ski("carver").name}
    assert {each.sledge.edge_angle for each in asked[:7]} == {turn.sledge.edge_angle}
    assert (found.site, found.synthetic, found.seed, found.ensemble_error) == ("site C", True, 3, 0.0)
    assert list(found.runs) == ["hypoplastic, k_u / H_V = 10", "elastic"]
    assert [each.snow for each in found.ensemble] == [each.contact.snow for each in drawn]
    assert [each.values["ski.stiffness_factor"] for each in found.ensemble] == [each.stiffness_factor for each in drawn]
    assert found.analysis is analysis
    assert said[-1] == "run 13 of 13"
    assert [f"the turn with the contact “{contact}”" for contact in found.runs] == said[:2]
    assert "is wider than" in found.sentences[0]
    assert "<" not in "".join(found.sentences)


def test_a_measured_unloading_ratio_is_the_one_of_the_turn(analysis: Analysis, asked: list[Scenario]) -> None:
    """Over all sites of the reference campaign it is measured; a given one comes first."""
    measured = present(analysis.snow().unloading_ratio)
    found = skisnow.turn(analysis, scenario=skisnow.load_scenario("carved-46m", changes=TURN), runs=3, workers=1)
    assert found.snow.unloading_ratio == measured
    assert [each.contact.unloading_ratio for each in asked[:2]] == [measured, 1.0]
    assert next(iter(found.runs)) == f"hypoplastic, k_u / H_V = {measured:.3g}"
    turn = skisnow.load_scenario("carved-46m", changes=TURN)
    given = skisnow.turn(analysis, scenario=turn, unloading_ratio=4.0, runs=3, workers=1)
    assert given.snow.unloading_ratio == 4.0


def test_all_that_is_not_known_is_drawn_over_its_prior(analysis: Analysis) -> None:
    nominal = skisnow.load_scenario("carved-46m").with_(snow=analysis.snow("C", unloading_ratio=10.0))
    drawn = [values_of(each) for each in pipeline_turn.drawn_scenarios(nominal, PRIORS, 200, 1)]
    for prior in PRIORS:
        values = np.array([each[prior.key] for each in drawn])
        low, high = prior.ends(values_of(nominal)[prior.key] or 0.0)
        # a Latin hypercube: one in each of 200 slices of the logarithm
        assert np.quantile(values, [0.0, 0.5, 1.0]) == pytest.approx([low, np.sqrt(low * high), high], rel=0.02)
    logs = np.log([[each[key] for key in (*MEASURED, *(prior.key for prior in PRIORS))] for each in drawn])
    assert np.max(np.abs(np.corrcoef(logs.T) - np.eye(7))) < 0.15  # 2 / √200


def test_the_ensemble_is_computed_quickly_whatever_the_turn_asks_for(asked: list[Scenario]) -> None:
    """Rows of 0.05 s of an error-controlled run, and what they are kept for."""
    turn = skisnow.load_scenario("carved-46m").with_(duration_s=1.0)
    row = pipeline_turn.simulate_fast(turn.with_(solver=replace(turn.solver, fixed=True, output_interval=0.01)))
    (solver,) = (each.solver for each in asked)
    assert (solver.method, solver.fixed, solver.output_interval) == ("fast", False, 0.05)
    run = circle_run(radius=10.0 * (turn.contact.snow.snow_hardness / 4.42e8) ** 0.1, count=61)
    assert row["outcome"] == run.outcome
    assert np.array(row["track"]) == pytest.approx(np.array([run.time, run.place[:, 0], run.place[:, 1]]))
    assert json.loads(json.dumps(row)) == row


def test_how_far_quick_ends_beside_the_turn_is_reported(analysis: Analysis, monkeypatch: pytest.MonkeyPatch) -> None:
    """3 cm down and 4 cm aside: 5 cm."""

    def beside(scenario: Scenario) -> Run:
        run = replace(circle_run(radius=12.0, count=61), scenario=scenario)
        return (
            run if scenario.solver.method == "default" else replace(run, place=run.place + np.array([0.03, -0.04, 0.0]))
        )

    monkeypatch.setattr(pipeline_turn, "simulate", beside)
    assert skisnow.turn(analysis, "C", runs=3, workers=1).ensemble_error == pytest.approx(0.05)


def test_the_usual_priors_are_what_their_origins_say() -> None:
    """Half of a groove stays, or all but 2 %; μ from 0.023 to 0.139 about their middle; stiffness by 30 %."""
    ratio, way, friction, stiffness, rounding = PRIORS
    assert [1.0 - 1.0 / end for end in (ratio.low, ratio.high)] == pytest.approx([0.5, 0.98])
    assert way.low == pytest.approx(1e3 * SHEAR_DISPLACEMENT)
    assert way.high == 0.5
    middle = math.sqrt(0.023 * 0.139)
    assert [friction.low, friction.high] == pytest.approx([0.023 / middle, 0.139 / middle], rel=0.02)
    assert [stiffness.low, stiffness.high] == pytest.approx([1.0 / 1.3, 1.3], rel=2e-3)
    assert (rounding.low, rounding.high) == (50.0, 200.0)
    assert [each.about for each in PRIORS] == [False, False, True, False, False]


def test_the_camber_is_rounded_in_a_band_only_where_it_is_one_number(tmp_path: Path) -> None:
    turn = skisnow.load_scenario("carved-46m")
    write_ski(turn.ski, tmp_path / "heights.toml")
    heights = turn.with_(ski=tmp_path / "heights.toml")
    both = [[each.key for each in inputs_with((), scenario)] for scenario in (turn, heights)]
    assert both[0] == [*both[1], "ski.camber_rounding_mm"]
    with raises(ParameterError, "no_camber"):
        heights.with_(camber_rounding_mm=50)


def test_each_input_has_a_column_of_shares_in_its_order(analysis: Analysis, monkeypatch: pytest.MonkeyPatch) -> None:
    """H_V and S_f at 2.5 % and the median, then a quarter and an eighth of the logarithm of two priors."""

    def shares(count: int, inputs: int, generator: np.random.Generator) -> np.ndarray:
        assert (count, inputs) == (1, 4)
        assert generator.random() == np.random.default_rng(8).random()
        return np.array([[0.025, 0.5, 0.25, 0.125]])

    monkeypatch.setattr(pipeline_turn, "latin_hypercube", shares)
    snow = analysis.snow("C", unloading_ratio=10.0)
    two = (prior_of("snow.unloading_ratio=2:32"), prior_of("ski.stiffness_factor=0.25:4"))
    (first,) = pipeline_turn.drawn_scenarios(skisnow.load_scenario("carved-46m").with_(snow=snow), two, 1, 8)
    assert first.contact.snow.snow_hardness == pytest.approx(present(snow.snow_hardness_interval)[0])
    assert first.contact.snow.failure_shear_stress == pytest.approx(snow.failure_shear_stress)
    assert first.contact.unloading_ratio == pytest.approx(4.0)
    assert first.stiffness_factor == pytest.approx(0.25 * math.sqrt(2.0))


def test_a_latin_hypercube_has_one_in_each_slice() -> None:
    shares = pipeline_turn.latin_hypercube(50, 3, np.random.default_rng(1))
    assert shares.shape == (50, 3)
    assert np.floor(np.sort(shares, axis=0) * 50.0).T.tolist() == [list(range(50))] * 3
    assert np.ptp(shares * 50.0 % 1.0) > 0.9
    assert np.abs(np.corrcoef(shares.T) - np.eye(3)).max() < 0.4


def with_measured(analysis: Analysis, **known: Any) -> Analysis:
    """The analysis as if these had been measured at every site."""
    found = copy(analysis)

    def snow(site: str | None = None, *, unloading_ratio: float | None = None) -> SnowProperties:
        measured = replace(analysis.snow(site), **known)
        if unloading_ratio is None:
            return measured
        return replace(measured, unloading_ratio=unloading_ratio, unloading_ratio_interval=None)

    object.__setattr__(found, "snow", snow)
    return found


MEASURED_HERE: dict[str, Any] = {
    "unloading_ratio": 9.0,
    "unloading_ratio_interval": (6.0, 16.0),
    "shear_displacement": 2.5e-4,
    "shear_displacement_interval": (2.0e-4, 3.125e-4),
}
"""k_u/H_V with an interval that is uneven about it, and u_y (m)."""
RATIO, WAY = "snow.unloading_ratio", "snow.shear_displacement_mm"


def test_what_the_campaign_measured_is_drawn_from_its_interval(analysis: Analysis) -> None:
    """Quantiles of a Latin hypercube: one of 200 slices each; all else is drawn as it was before, number by number."""
    plain = analysis.snow("C", unloading_ratio=9.0)
    snow = replace(plain, **MEASURED_HERE)
    turn = skisnow.load_scenario("carved-46m").with_(snow=plain)
    measured = turn.with_(snow=snow)
    before = [values_of(each) for each in pipeline_turn.drawn_scenarios(turn, inputs_with((), turn), 200, 1)]
    drawn = [values_of(each) for each in pipeline_turn.drawn_scenarios(measured, inputs_with((), measured), 200, 1)]
    for key, expected in ((RATIO, [6.0, 9.0, 16.0]), (WAY, [0.2, 0.25, 0.3125])):
        assert np.quantile([each[key] for each in drawn], [0.025, 0.5, 0.975]) == pytest.approx(expected, rel=0.01)
        assert [each[key] for each in before] != [each[key] for each in drawn]
    others = (*MEASURED, *(prior.key for prior in PRIORS[2:]))
    assert [[each[key] for key in others] for each in drawn] == [[each[key] for key in others] for each in before]


@pytest.mark.usefixtures("asked")
def test_turning_angles_of_a_campaign_tell_the_spread_of_u_y(tmp_path: Path, capsys: Printed) -> None:
    """From the files to turn.json; the site's discs were not taken off."""
    assert main(["reference", str(tmp_path / "campaign"), "--seed", "1", "--turning-angles", "--creep"]) == 0
    capsys.readouterr()
    words = ["turn", str(tmp_path / "campaign"), "--site", "C", "--runs", "3", "--workers", "1", "--json"]
    assert main(words) == 0
    told = json.loads(capsys.readouterr().out)
    assert (spreads(told)[RATIO], spreads(told)[WAY]) == ("prior", "measured")
    low, high = told["snow"]["shear_displacement_interval_mm"]
    assert low < told["snow"]["shear_displacement_mm"] < high
    assert low < 0.25 < high
    (way,) = (each for each in told["ensemble"]["inputs"] if each["key"] == WAY)
    assert (way["value"], way["low"], way["high"]) == (told["snow"]["shear_displacement_mm"], low, high)


def test_what_is_drawn_stays_inside_what_the_key_allows(analysis: Analysis) -> None:
    """k_u/H_V below 1 would give energy away, above 1000 is none; u_y from 0.01 to 10 mm."""
    wide: dict[str, Any] = {"unloading_ratio_interval": (1.0, 900.0), "shear_displacement_interval": (1e-5, 9e-3)}
    snow = replace(analysis.snow("C"), **{**MEASURED_HERE, **wide})
    turn = skisnow.load_scenario("carved-46m").with_(snow=snow)
    drawn = [values_of(each) for each in pipeline_turn.drawn_scenarios(turn, inputs_with((), turn), 200, 1)]
    for key, low, high in ((RATIO, 1.0, 1000.0), (WAY, 0.01, 10.0)):
        assert [min(each[key] for each in drawn), max(each[key] for each in drawn)] == [low, high]


def spreads(told: dict[str, Any]) -> dict[str, str]:
    return {each["key"]: each["spread"] for each in told["ensemble"]["inputs"]}


@pytest.mark.usefixtures("asked")
@pytest.mark.parametrize(
    ("named", "ratio", "way", "expected"),
    [
        ({}, 9.0, 0.25, ("measured", "measured")),
        ({"unloading_ratio": 4.0}, 4.0, 0.25, ("prior", "measured")),
        ({"shear_displacement": 4e-4}, 9.0, 0.4, ("measured", "prior")),
        ({"priors": [prior_of("unloading_ratio=7:7")]}, 9.0, 0.25, ("prior", "measured")),
        ({"priors": [prior_of("shear_displacement_mm=0.1:0.2")]}, 9.0, 0.25, ("measured", "prior")),
    ],
)
def test_what_is_given_comes_before_what_was_measured(
    analysis: Analysis, named: dict[str, Any], ratio: float, way: float, expected: tuple[str, str]
) -> None:
    found = skisnow.turn(with_measured(analysis, **MEASURED_HERE), "C", runs=3, workers=1, **named)
    contact = found.nominal.scenario.contact
    assert [contact.unloading_ratio, contact.shear_displacement] == pytest.approx([ratio, way * 1e-3], rel=1e-12)
    told = turn_dict(found)
    assert (spreads(told)[RATIO], spreads(told)[WAY]) == expected
    assert [spreads(told)[key] for key in MEASURED] == ["measured", "measured"]
    assert [key for key, of in spreads(told).items() if of == "prior"] == [x["key"] for x in told["ensemble"]["priors"]]
    assert told["snow"]["shear_displacement_mm"] == pytest.approx(way)
    of_measured = {each["key"]: each for each in told["ensemble"]["inputs"] if each["spread"] == "measured"}
    assert all(each["distribution"] == "log-normal" for each in of_measured.values())
    if expected[0] == "measured":
        assert [of_measured[RATIO][name] for name in ("value", "low", "high")] == [9.0, 6.0, 16.0]
    sentence = found.sentences[-1]
    assert re.findall(r"\b[HS]_[Vf]\b", sentence)[:2] == ["H_V", "S_f"]
    measured, assumed = sentence.split(" from the intervals that the campaign measured, ")
    assert ("k_u" in measured, "u_y" in measured) == tuple(each == "measured" for each in expected)
    assert ("k_u" in assumed, "u_y" in assumed) == tuple(each == "prior" for each in expected)


@pytest.mark.usefixtures("asked")
def test_the_command_s_own_values_come_before_what_was_measured(
    analysis: Analysis, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Printed
) -> None:
    measured = with_measured(analysis, **MEASURED_HERE)
    monkeypatch.setattr(pipeline_turn, "analyse", lambda *_, **__: measured)
    monkeypatch.setattr(pipeline_turn, "read_campaign", lambda *_, **__: measured.campaign)
    words = ["turn", str(tmp_path), "--site", "C", "--runs", "3", "--workers", "1", "--json"]
    sets = ["--set", "shear_displacement_mm=0.4", "--set", "unloading_ratio=5"]
    for more, ratio, way in (([], 9.0, 0.25), (sets, 5.0, 0.4), ([*sets, "--unloading-ratio", "4"], 4.0, 0.4)):
        assert main([*words, *more]) == 0
        told = json.loads(capsys.readouterr().out)
        assert (told["snow"]["unloading_ratio"], told["snow"]["shear_displacement_mm"]) == pytest.approx((ratio, way))
        assert spreads(told)[RATIO] == ("prior" if more else "measured")


@pytest.mark.usefixtures("asked")
def test_a_prior_that_is_given_takes_the_place_of_the_usual_one(analysis: Analysis) -> None:
    given = (prior_of("unloading_ratio=7:7"), prior_of("drag_area=0.2:0.4"))
    found = skisnow.turn(analysis, "C", priors=given, runs=3, workers=1)
    assert [each.key for each in found.priors] == [*(each.key for each in PRIORS), "drag.drag_area_m2"]
    assert {each.values["snow.unloading_ratio"] for each in found.ensemble} == {7.0}
    assert all(0.2 < each.values["drag.drag_area_m2"] < 0.4 for each in found.ensemble)


def test_a_turn_near_the_limit_of_grip_is_warned_of(analysis: Analysis, monkeypatch: pytest.MonkeyPatch) -> None:
    """More than 34.8 degrees and the turn is another: 0.1 % of 34.79° reach it."""

    def folded(scenario: Scenario) -> Run:
        beyond = scenario.sledge.edge_angle > math.radians(34.8)
        return replace(circle_run(radius=20.0 if beyond else 12.0, count=61), scenario=scenario)

    monkeypatch.setattr(pipeline_turn, "simulate", folded)
    for angle, near in ((34.79, True), (34.0, False)):
        turn = skisnow.load_scenario("carved-46m").with_(edge_angle_deg=angle)
        found = skisnow.turn(analysis, "C", turn, runs=3, workers=1)
        assert bool(found.warnings) is near
    assert (
        "limit of grip"
        in skisnow.turn(
            analysis, "C", skisnow.load_scenario("carved-46m").with_(edge_angle_deg=34.79), runs=3, workers=1
        ).warnings[0]
    )


@pytest.mark.usefixtures("asked", "undrawn")
def test_the_report_is_that_of_the_chain(analysis: Analysis, tmp_path: Path) -> None:
    found = skisnow.turn(analysis, "C", runs=3, workers=1)
    page = found.report(tmp_path / "turn")
    text = page.read_text(encoding="utf-8")
    assert "snow of site C" in text
    assert "Synthetic data." in text
    assert {path.name for path in (tmp_path / "turn" / "figures").glob("*.png")} == {
        "contacts.png", "along_ski.png", "grip.png", "band.png",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("named", "told"),
    [
        ({"site": "A"}, coded("no_data", quantity="S_f")),
        ({"site": "Z"}, coded("no_data", site="Z")),
        ({"priors": [prior_of("H_V=0.1:0.2")]}, "no_data"),
        ({"unloading_ratio": 1.0}, coded("out_of_range", unloading_ratio=1.0)),
        ({"shear_displacement": 0.0}, coded("out_of_range", name="shear_displacement", value=0.0)),
        ({"runs": 2}, coded("out_of_range", name="runs", low=3)),
        ({"workers": 0}, coded("too_few_workers", workers=0)),
        ({"scenario": "carved-46"}, coded("unknown_name", similar="carved-46m")),
    ],
)
@pytest.mark.usefixtures("asked")
def test_impossible_input_is_rejected(analysis: Analysis, named: dict[str, Any], told: str | Coded) -> None:
    with raises(ParameterError, told):
        skisnow.turn(analysis, **{"site": "C", "workers": 1, **named})


def test_an_interrupted_turn_ends_the_chain(analysis: Analysis, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline_turn, "simulate", lambda _: replace(circle_run(), outcome="interrupted"))
    with pytest.raises(KeyboardInterrupt):
        skisnow.turn(analysis, "C", workers=1)


@pytest.mark.usefixtures("asked", "undrawn")
def test_the_command_does_what_the_call_does(analysis: Analysis, tmp_path: Path, capsys: Printed) -> None:
    skisnow.write_reference(tmp_path / "campaign", seed=1)
    sets = [word for key, value in TURN.items() for word in ("--set", f"{key}={value}")]
    words = ["turn", str(tmp_path / "campaign"), "--site", "C", "--runs", "3", "--workers", "1", *sets]
    assert main([*words, "--out", str(tmp_path / "turn")]) == 0
    printed = capsys.readouterr()
    turn = skisnow.load_scenario("carved-46m", changes=TURN)
    found = skisnow.turn(analysis, "C", turn, runs=3, workers=1)
    assert printed.out.splitlines() == [f"snow: {found.snow.in_words}", *found.sentences]
    assert printed.err.splitlines()[-1] == f"The whole chain: {tmp_path / 'turn' / 'report.html'}"
    assert (tmp_path / "turn" / "report.html").is_file()


@pytest.mark.usefixtures("undrawn")
def test_the_command_s_json_is_that_of_the_report(asked: list[Scenario], tmp_path: Path, capsys: Printed) -> None:
    """Alone on stdout, as the schema has it, each number that of its run; turn.json holds the same."""
    skisnow.write_reference(tmp_path / "campaign", seed=1)
    words = ["turn", str(tmp_path / "campaign"), "--site", "C", "--runs", "3", "--workers", "1"]
    assert main([*words, "--json", "--out", str(tmp_path / "turn")]) == 0
    told = json.loads(capsys.readouterr().out)
    written = json.loads((tmp_path / "turn" / "turn.json").read_text(encoding="utf-8"))
    for one, other in zip(told["runs"], written["runs"], strict=True):
        assert one["summary"].pop("provenance").keys() == other["summary"].pop("provenance").keys()
    assert told == written
    assert told["snow"]["H_V_N_per_mm3"] * 1e9 == pytest.approx(asked[0].contact.snow.snow_hardness, rel=1e-12)
    assert (told["site"], told["snow"]["unloading_ratio"], told["ensemble"]["seed"]) == ("site C", 10.0, 1)
    assert [each["contact"] for each in told["runs"]] == ["hypoplastic, k_u / H_V = 10", "elastic"]
    assert told["runs"][0]["distance_from_first_m"] is None
    assert 0.0 < told["runs"][1]["distance_from_first_m"] < 2.0
    assert [each["H_V_N_per_mm3"] * 1e9 for each in told["ensemble"]["runs"]] == pytest.approx(
        [each.contact.snow.snow_hardness for each in asked[3:6]], rel=1e-12
    )


def test_the_json_keeps_to_its_schema(analysis: Analysis, asked: list[Scenario]) -> None:
    assert asked == []
    summary = json_schema("summary")
    known = Registry().with_resource(summary["$id"], Resource.from_contents(summary))
    found = turn_dict(skisnow.turn(analysis, "C", runs=3, workers=1))
    schema = json_schema("turn")
    checked = Draft202012Validator(schema, registry=known)
    checked.validate(found)
    checked.validate(turn_dict(skisnow.turn(with_measured(analysis, **MEASURED_HERE), "C", runs=3, workers=1)))
    found["runs"][0]["summary"]["outcome"] = "well"
    assert not checked.is_valid(found)
    assert set(schema["properties"]) == set(found)


def test_the_command_rejects_in_words(tmp_path: Path, capsys: Printed) -> None:
    assert main(["turn", str(tmp_path / "nowhere"), "--site", "C"]) == 1
    assert "a folder that exists" in capsys.readouterr().err
    for words in (["--runs", "2"], ["--prior", "mu_0=2"], ["--unloading-ratio", "1"], ["--set", "mas=3"]):
        try:
            status = main(["turn", str(tmp_path), *words])
        except SystemExit as ended:
            status = int(str(ended.code))
        assert status in (1, 2)
        assert words[0].lstrip("-").split("-")[0] in capsys.readouterr().err or words[0] == "--set"
    assert list(tmp_path.iterdir()) == []


def test_defaults_of_the_command_are_those_of_the_call() -> None:
    defaults = {name: each.default for name, each in inspect.signature(skisnow.turn).parameters.items()}
    assert (defaults["runs"], defaults["unloading_ratio"], defaults["scenario"]) == (64, None, "carved-46m")


def test_an_unknown_site_is_reported_before_the_analysis(analysis: Analysis, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline_turn, "analyse", lambda *_, **__: pytest.fail("analysed for nothing"))
    with raises(ParameterError, "no_data", site="Z"):
        skisnow.turn(analysis.campaign, "Z")
