"""`skisnow carve` as a user meets it."""

import itertools
import json
import math
from pathlib import Path
from typing import Any

import pytest

import skisnow
from skisnow._support.errors import SkisnowError
from skisnow.carving.answer import CarveAnswer, answer_dict
from skisnow.carving.question import CarveQuestion
from skisnow.cli import main
from skisnow.cli.shell import json_schema
from skisnow.ski.ski_file import keys_text
from tests.key_names import FORCE_PER_LENGTH, WAIST_WIDTH

from .json_answer import json_answer

SCHEMA = json_schema("carve")
CONTRACT = [
    "outcome", "holds", "side_force_N", "side_force_limit_N", "turn_radius_boot_m", "turn_radius_chord_m",
    "contact_length_m", "afterbody_depth_ratio", "station_m", "edge_depth_mm", "force_per_length_N_per_m", "bending_mm",
    "twist_deg", "residual_force_N", "residual_moment_Nm",
]  # fmt: skip
ASKED = ["--ski", "slalom", "--edge-angle-deg", "45", "--load-N", "800"]
SNOW = ["--H-V-N-per-mm3", "0.2", "--S-f-N-per-mm2", "0.35", "--unloading-ratio", "10"]
Printed = pytest.CaptureFixture[str]


def answer(words: list[str], printed: Printed) -> Any:
    return json_answer(["carve", *words], SCHEMA, printed)


def refusal(words: list[str], printed: Printed) -> str:
    assert main(["carve", *words]) == 1
    out, err = printed.readouterr()
    assert out == ""
    return err


def test_json_has_the_keys_of_the_contract_and_one_number_for_each_station(capsys: Printed) -> None:
    found = answer([*ASKED, *SNOW], capsys)
    assert set(CONTRACT) <= set(found)
    lists = [found[key] for key in CONTRACT if isinstance(found[key], list)]
    assert len(lists) == 5
    assert {len(each) for each in lists} == {len(found["station_m"])}
    assert found["station_m"] == sorted(found["station_m"], reverse=True)
    assert found["station_m"][0] > 0 > found["station_m"][-1]
    assert found["outcome"] == "equilibrium"
    assert found["side_force_N"] == pytest.approx(800.0, rel=1e-12)  # load × tan 45°
    assert found["inputs"]["H_V_N_per_mm3"] == 0.2
    assert found["provenance"]["skisnow"]


def test_rigid_tool_at_rest_is_as_deep_as_the_closed_form(capsys: Printed) -> None:
    """e = sqrt(2 F tan ϑ/(H_V L)) for a rigid edge of length L: 11.07 mm at 490 N, 45°, 0.04 N/mm³, 200 mm."""
    words = ["--ski", "paper-tool", "--edge-angle-deg", "45", "--load-N", "490", "--H-V-N-per-mm3", "0.04"]
    found = answer([*words, "--at-rest", "--clamp-length-m", "0"], capsys)
    expected = math.sqrt(2.0 * 490.0 / (0.04 * 200.0))
    # EI = 10⁶ N m² is not quite rigid
    assert found["edge_depth_mm"] == pytest.approx([expected] * len(found["station_m"]), rel=1e-5)
    assert found[FORCE_PER_LENGTH] == pytest.approx([490.0 / 0.2] * len(found["station_m"]), rel=1e-5)
    assert (found["side_force_N"], found["holds"]) == (0.0, True)
    assert found["side_force_limit_N"] is found["inputs"]["S_f_N_per_mm2"] is None


def test_slipping_edge_is_an_answer(capsys: Printed) -> None:
    words = [*ASKED, "--published", "glacier", "--unloading-ratio", "10"]
    found = answer(words, capsys)
    assert (found["outcome"], found["holds"]) == ("slips", False)
    assert found["side_force_limit_N"] < found["side_force_N"]
    assert found["inputs"]["H_V_N_per_mm3"] == 90.0
    assert main(["carve", *words]) == 0
    text = capsys.readouterr().out
    assert found["remedy"] in text
    assert "grip holds" in text


def test_swallowed_ski_has_an_outcome_in_words_and_no_numbers(capsys: Printed) -> None:
    words = [*ASKED, "--H-V-N-per-mm3", "1e-5", "--S-f-N-per-mm2", "0.35", "--unloading-ratio", "10"]
    found = answer(words, capsys)
    assert found["outcome"] == "sinks"
    assert found["turn_radius_boot_m"] is found["edge_depth_mm"] is found["holds"] is None
    assert main(["carve", *words]) == 0
    assert "sinks: no balance" in capsys.readouterr().out


def test_several_skis_share_one_answer_one_table_and_one_figure(tmp_path: Path, capsys: Printed) -> None:
    words = [*ASKED, "--ski", "giant-slalom", *SNOW]
    figure = tmp_path / "two.png"
    found = answer([*words, "--figure", str(figure)], capsys)
    slalom, giant = found["skis"]
    assert slalom == answer([*ASKED, *SNOW], capsys)
    assert giant["turn_radius_boot_m"] > slalom["turn_radius_boot_m"]
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert main(["carve", *words]) == 0
    head, *_ = (line for line in capsys.readouterr().out.splitlines() if line.startswith(" "))
    assert head.split() == ["slalom", "giant-slalom", "giant-slalom/%"]


@pytest.mark.parametrize("at_rest", [(), pytest.param(("--at-rest",), marks=pytest.mark.slow)])
def test_a_figure_in_german(tmp_path: Path, at_rest: tuple[str, ...]) -> None:
    figure = tmp_path / "carve.svg"
    assert main(["carve", *ASKED, *SNOW, *at_rest, "--figure", str(figure), "--language", "de"]) == 0
    text = figure.read_text("utf-8")
    assert "(m), Schuh = 0" in text and "Last 800 N" in text and ">slalom<" in text
    for english in ("along", "depth", "load", "circle", "boot", "carve", "rest:", "length", "twist", "surface"):
        assert english not in text


def test_table_has_skis_own_names_sidecut_radius_and_bearing_length(tmp_path: Path, capsys: Printed) -> None:
    catalogue = (Path(skisnow.__file__).parent / "ski/catalogue/slalom.toml").read_text("utf-8")
    path = tmp_path / "a.toml"
    path.write_text(catalogue.replace('name = "slalom"', 'name = "mine"'), encoding="utf-8")
    words = [*ASKED[2:], "--ski", "slalom", "--ski", str(path), *SNOW]
    found = answer(words, capsys)["skis"][0]
    assert main(["carve", *words]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert next(line for line in lines if line.startswith(" ")).split() == ["slalom", "mine", "mine/%"]
    told = {line[:44].strip(): line[44:].split()[:2] for line in lines}
    radius, bearing = (told[f"{row} (m)"][0] for row in ("sidecut radius of three widths", "loaded contact length"))
    exact = found["ski"]["sidecut_radius_of_three_widths_m"]
    assert float(radius) == pytest.approx(exact, rel=5e-3)  # three digits
    assert float(bearing) == pytest.approx(found["bearing_length_m"], rel=5e-3)
    # between neighbouring stations that carry; each end of a bearing piece is off by their distance, 1 cm, at most
    pairs = list(itertools.pairwise(zip(found["station_m"], found["force_per_length_N_per_m"], strict=True)))
    length = sum(s - t for (s, force), (t, behind) in pairs if force > 0 and behind > 0)
    ends = sum((force > 0) != (behind > 0) for (_, force), (_, behind) in pairs)
    assert found["bearing_length_m"] == pytest.approx(length, abs=0.01 * ends)
    assert found["bearing_length_m"] < found["contact_length_m"]


def test_each_choice_is_in_force_and_named(capsys: Printed) -> None:
    plain = answer([*ASKED, *SNOW], capsys)
    switches: tuple[tuple[str, str, object], ...] = (
        ("--no-side-force-bending", "side_force_bending", False),
        ("--side-force-spread base-reaction", "side_force_spread", "base-reaction"),
        ("--groove path", "groove", "path"), ("--moment-balance free", "moment_balance", "free"),
        ("--no-twist", "twist", False), ("--clamp-length-m 0", "clamp_length_m", 0.0),
        ("--footprint-stiffness-N-per-mm2 30", "footprint_stiffness_N_per_mm2", 30.0),
        ("--elements 80", "elements", 80), ("--moment-Nm 40", "moment_Nm", 40.0),
        ("--unloading-ratio inf", "unloading_ratio", 1000.0),
    )  # fmt: skip
    for words, key, value in switches:
        switched = answer([*ASKED, *SNOW, *words.split()], capsys)
        assert switched["inputs"] == plain["inputs"] | {key: value}
        assert switched["turn_radius_boot_m"] != plain["turn_radius_boot_m"], key
        assert (set(switched["twist_deg"]) == {0.0}) is (key == "twist")


def test_snow_and_intervals_of_a_campaign(tmp_path: Path, capsys: Printed, noted_errors: list[SkisnowError]) -> None:
    from skisnow import read_snow

    rows = [{"used": True, "site": "A", "H_V_N_per_mm3": value} for value in (0.1, 0.4)]
    shear = [{"used": True, "site": "A", "S_f_N_per_mm2": value} for value in (0.3, 0.5)]
    path = tmp_path / "results.json"
    path.write_text(json.dumps({"penetration": {"experiments": rows}, "shear": {"experiments": shear}}), "utf-8")
    words = [*ASKED, "--results", str(path), "--unloading-ratio", "10"]
    found = answer([*words, "--site", "A"], capsys)
    assert found["inputs"]["H_V_N_per_mm3"] == pytest.approx(0.2, rel=1e-12)  # the geometric mean
    assert found["inputs"]["S_f_N_per_mm2"] == pytest.approx(0.4, rel=1e-12)
    interval = read_snow(path).snow_hardness_interval
    assert interval is not None
    assert found["snow"]["H_V_interval_N_per_mm3"] == pytest.approx([end / 1e9 for end in interval])
    refusal([*words, "--site", "B"], capsys)
    assert (noted_errors[-1].code, "'A'" in str(noted_errors[-1])) == ("no_data", True)


def test_a_campaign_without_stress_needs_one(tmp_path: Path, capsys: Printed, noted_errors: list[SkisnowError]) -> None:
    rows = [{"used": True, "site": site, "H_V_N_per_mm3": 0.2} for site in ("site A", "B")]
    shear = [{"used": True, "site": "B", "S_f_N_per_mm2": 0.4}]
    path = tmp_path / "results.json"
    path.write_text(json.dumps({"penetration": {"experiments": rows}, "shear": {"experiments": shear}}), "utf-8")
    words = [*ASKED, "--results", str(path), "--unloading-ratio", "10", "--site"]
    told = refusal([*words, "site A"], capsys)
    assert noted_errors[-1].code == "no_data"
    assert "site A: 1 " in told and "--S-f-N-per-mm2" in told
    found = answer([*words, "site A", "--S-f-N-per-mm2", "0.3"], capsys)
    assert found["inputs"]["S_f_N_per_mm2"] == 0.3
    assert "site A: 1 " in found["snow"]["source"]
    numbers = answer([*ASKED, "--H-V-N-per-mm3", "0.2", "--S-f-N-per-mm2", "0.3", "--unloading-ratio", "10"], capsys)
    assert found["side_force_limit_N"] == pytest.approx(numbers["side_force_limit_N"], rel=1e-9)
    refusal([*words, "B", "--S-f-N-per-mm2", "0.3"], capsys)
    assert noted_errors[-1].code == "contradiction"
    assert answer([*words, "site A", "--at-rest"], capsys)["holds"] is True


def test_values_beyond_what_was_measured_are_warned_of_and_used(capsys: Printed) -> None:
    words = [*ASKED, "--H-V-N-per-mm3", "120", "--S-f-N-per-mm2", "0.9", "--unloading-ratio", "10"]
    assert main(["carve", *words, "--json"]) == 0
    out, err = capsys.readouterr()
    assert "H_V 120 N/mm³ is outside" in err
    assert "S_f 0.9 N/mm² is outside" in err
    assert json.loads(out)["inputs"]["H_V_N_per_mm3"] == 120.0
    assert len(json.loads(out)["warnings"]) == 2


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ([*ASKED, "--unloading-ratio", "10"], "missing"),
        ([*ASKED, "--published", "race-piste", *SNOW[2:]], "contradiction"),
        ([*ASKED, "--results", "nowhere.json", *SNOW[4:]], "wrong_kind"),
        ([*ASKED[2:], "--ski", "slalon", *SNOW], "unknown_name"),
        ([*ASKED[2:], "--ski", "mine/ski.toml", *SNOW], "cannot_read"),
        ([*ASKED[:3], "95", *ASKED[4:], *SNOW], "out_of_range"),
        ([*ASKED, *SNOW, "--elements", "3"], "out_of_range"),
        ([*ASKED[2:], "--ski", "paper-tool", *SNOW], "out_of_range"),
        ([*ASKED, *SNOW, "--figure", "picture.bmp"], "unknown_ending"),
    ],
)
def test_bad_input_is_rejected(words: list[str], code: str, capsys: Printed, noted_errors: list[SkisnowError]) -> None:
    assert refusal(words, capsys).count("\n") == 1
    assert noted_errors[-1].code == code


def test_a_clamp_that_is_too_long_is_rejected_in_a_sentence_with_its_option(capsys: Printed) -> None:
    assert "--clamp-length-m 0" in refusal([*ASKED, *SNOW, "--clamp-length-m", "300"], capsys)


def test_beginning_of_an_option_stands_for_it(capsys: Printed) -> None:
    assert answer([*ASKED[:2], "--edge", "45", "--load", "800", *SNOW], capsys) == answer([*ASKED, *SNOW], capsys)


def test_interrupt_while_commands_are_loaded_ends_in_one_line(monkeypatch: pytest.MonkeyPatch, capsys: Printed) -> None:
    import skisnow.cli

    def interrupted() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(skisnow.cli, "build_parser", interrupted)
    assert main(["carve"]) == 130
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_sensitivities_are_in_the_json_and_the_table(capsys: Printed) -> None:
    words = [*ASKED, *SNOW, "--sensitivity", "load_N", "--sensitivity", "ski.waist_width_mm"]
    rows = answer(words, capsys)["sensitivity"]
    assert {row["parameter"] for row in rows} == {"load_N", WAIST_WIDTH}
    (depth,) = (row for row in rows if (row["output"], row["parameter"]) == ("edge_depth_mm", "load_N"))
    more = answer([*ASKED[:-1], "801", *SNOW], capsys)["edge_depth_mm"]
    assert max(more) - depth["value"] == pytest.approx(depth["derivative"], rel=1e-3)
    assert main(["carve", *words]) == 0
    assert WAIST_WIDTH in capsys.readouterr().out


def test_skis_are_compared_in_percent_and_by_definitions_of_the_radius(capsys: Printed) -> None:
    from skisnow.report.summaries import carve_summary, rank_warnings

    found = answer([*ASKED, "--ski", "carver", *SNOW], capsys)
    slalom, carver = found["skis"]
    percent = 100.0 * (carver["side_force_limit_N"] / slalom["side_force_limit_N"] - 1.0)
    (row,) = (line for line in carve_summary(found).splitlines() if line.startswith("shear capacity"))
    assert float(row.split()[-1]) == pytest.approx(percent, rel=0.05)
    assert list(rank_warnings(found)) == []


def test_two_definitions_of_the_radius_rank_two_skis_differently(tmp_path: Path, capsys: Printed) -> None:
    """With less camber the boot's circle becomes smaller by 4.8 %, the chord's by 0.8 %; 1.5 mm less sidecut widens
    both by more than 3 %.
    """
    from skisnow.report.summaries import rank_warnings

    keys: dict[str, Any] = dict(skisnow.read_ski("slalom").keys or {})
    keys |= {"name": "flat", "camber_mm": 1.0, "tip_width_mm": keys["tip_width_mm"] - 1.5}
    keys["tail_width_mm"] -= 1.5
    path = tmp_path / "flat.toml"
    path.write_text(keys_text(keys), encoding="utf-8")
    words = ["--ski", "slalom", "--ski", str(path), "--edge-angle-deg", "30", "--load-N", "800"]
    words += ["--published", "race-piste", "--unloading-ratio", "10"]
    found = answer(words, capsys)
    (warning,) = rank_warnings(found)
    assert (warning.code, warning.fields["one"], warning.fields["two"]) == ("ranks_differ", "slalom", "flat")
    slalom, flat = found["skis"]
    assert flat["turn_radius_boot_m"] < 0.99 * slalom["turn_radius_boot_m"]
    assert flat["turn_radius_chord_m"] > 1.02 * slalom["turn_radius_chord_m"]
    assert main(["carve", *words]) == 0
    assert str(warning) in capsys.readouterr().out


def test_intervals_of_the_snow_give_intervals_of_the_answer() -> None:
    """H_V within ±10 %: the depth falls by 0.4 % for each % of H_V."""
    snow = skisnow.SnowProperties(0.2e9, 0.35e6, source="test", snow_hardness_interval=(0.18e9, 0.22e9))
    found = skisnow.carve(
        skisnow.read_ski("slalom"), snow, edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0
    )
    exact = found.derivatives()
    (depth,) = exact.sensitivity("edge_depth_mm", ["snow.H_V_N_per_mm3"])
    assert exact.half_interval("edge_depth_mm", snow) == pytest.approx(0.02 * abs(depth.derivative), rel=1e-9)
    question = CarveQuestion(ski="slalom", edge_angle_deg=45.0, load_N=800.0, unloading_ratio=10.0)
    (radius,) = exact.sensitivity("turn_radius_boot_m", ["snow.H_V_N_per_mm3"])
    answered = CarveAnswer(question, skisnow.read_ski("slalom"), snow, found, ())
    (change,) = answer_dict(answered)["radius_changes_by_snow_m"]
    assert change == pytest.approx(0.02 * radius.derivative, rel=1e-9)
