"""Questions about a ski in snow: what is missing, said twice or not meant, and numbers that look like a slip."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import carve, load_snow, read_ski
from skisnow._support.errors import ParameterError
from skisnow.carving.answer import answer_dict, answer_question, answers_dict, equilibrium_dict
from skisnow.carving.equilibrium import rest
from skisnow.carving.question import SKI_FACTORS, CarveQuestion, carve_question, implausible_values, require_clamp
from skisnow.carving.result import Equilibrium
from skisnow.ski.editing import SkiEdit, edit_stations, edited_ski
from skisnow.snow import SnowProperties
from skisnow.snow.properties import GREATEST_LIKELY_HARDNESS
from tests.coded import Coded, coded, raises

ASKED: dict[str, object] = {"ski": "slalom", "edge_angle_deg": 45.0, "load_N": 800.0, "unloading_ratio": 10.0}
SNOW: dict[str, object] = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
NEITHER_WAY = "Give H_V_N_per_mm3 and S_f_N_per_mm2, or results, or published"


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (ASKED, coded("missing", choices=NEITHER_WAY)),
        (
            ASKED | SNOW | {"results": "r.json"},
            coded("contradiction", first="H_V_N_per_mm3", second="results", choices=NEITHER_WAY),
        ),
        (
            ASKED | {"results": "r.json", "published": "race-piste"},
            coded("contradiction", first="results", second="published"),
        ),
        (ASKED | {"H_V_N_per_mm3": 0.2}, coded("missing")),
        (ASKED | SNOW | {"site": "A"}, coded("contradiction")),
        (ASKED | {"published": "race-piste", "site": "A"}, coded("contradiction")),
        (SNOW | {"ski": "slalom", "load_N": 800.0, "unloading_ratio": 1.0}, coded("missing", name="edge_angle_deg")),
        (
            {name: ASKED[name] for name in ("ski", "edge_angle_deg", "load_N")} | SNOW,
            coded("missing", name="unloading_ratio"),
        ),
        (ASKED | SNOW | {"edge_angle": 45.0}, coded("unknown_name", name="edge_angle", similar="edge_angle_deg")),
        (ASKED | SNOW | {"load_N": 0.0}, coded("out_of_range", name="load_N", value="0.0", unit="N")),
    ],
)
def test_incomplete_or_contradictory_questions_are_errors(values: dict[str, object], expected: Coded) -> None:
    with raises(ParameterError, expected):
        carve_question(values)


def test_a_ski_at_rest_needs_neither_shear_stress_nor_unloading() -> None:
    asked = {"ski": "slalom", "edge_angle_deg": 45.0, "load_N": 800.0, "H_V_N_per_mm3": 0.2}
    assert carve_question({**asked, "at_rest": True}) == CarveQuestion(
        ski="slalom", edge_angle_deg=45.0, load_N=800.0, H_V_N_per_mm3=0.2, at_rest=True
    )
    assert carve_question(ASKED | {"results": "r.json", "site": "A"}).site == "A"


def test_half_a_clamp_ends_before_tip_and_tail() -> None:
    """The paper's tool is 0.2 m long and held in its middle."""
    tool = read_ski("paper-tool")
    require_clamp(tool, math.nextafter(0.2, 0.0))
    with raises(ParameterError, "out_of_range", clamp_length=0.2, name="paper-tool", most=0.2):
        require_clamp(tool, 0.2)


def test_a_clamp_in_millimetres_that_would_not_fit_either_is_no_guess() -> None:
    assert 200.0 * 1e-3 == 0.2
    with raises(ParameterError, "out_of_range"):
        require_clamp(read_ski("paper-tool"), 200.0)


@pytest.mark.parametrize(
    ("length", "told"),
    [
        (1.8, "--clamp-length-m 0"),
        (19.9, "--clamp-length-m 0"),
        (1708.0, "--clamp-length-m 0"),
    ],
)
def test_a_clamp_that_is_too_long_is_rejected(length: float, told: str) -> None:
    """The boot of the giant-slalom ski stands 0.8535 m before its tail."""
    with pytest.raises(ParameterError) as refused:
        require_clamp(read_ski("giant-slalom"), length)
    assert str(refused.value).endswith(f"allows less than 1.71 m: write {told}")


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"load_N": 19.9}, "load_N is 19.9: is it in kg or kN? It is read as newtons (80 kg weigh 785 N)"),
        ({"load_N": 5000.1}, "load_N is 5000.1: is it in kg or kN?"),
        ({"edge_angle_deg": 0.5}, "edge_angle_deg is 0.5: that looks like radians. If it is, write 28.65"),
        ({"H_V_N_per_mm3": 2e8}, "H_V_N_per_mm3 is 2e+08: is it in N/m³? If it is, write 0.2"),
    ],
)
def test_a_number_that_looks_like_another_unit_is_told(changed: dict[str, float], told: str) -> None:
    (said,) = implausible_values(replace(carve_question(ASKED | SNOW), **changed))  # type: ignore[arg-type]
    assert said.startswith(told)
    assert said.text("de").split(maxsplit=2)[:2] == [said.split()[0], "ist"]


@pytest.mark.parametrize(
    "changed",
    [{"load_N": 20.0}, {"load_N": 5000.0}, {"edge_angle_deg": 0.0}, {"H_V_N_per_mm3": GREATEST_LIKELY_HARDNESS}],
)
def test_the_last_usual_numbers_are_not_suspected(changed: dict[str, float]) -> None:
    assert implausible_values(replace(carve_question(ASKED | SNOW), **changed)) == ()  # type: ignore[arg-type]


FIRM = SnowProperties(2e8, 5e5, source="given as numbers")
NUMBERS: dict[str, object] = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
REQUEST: dict[str, object] = {"ski": "slalom", "edge_angle_deg": 45.0, "load_N": 800.0, "elements": 80}
CHOSEN: dict[str, object] = {
    "moment_Nm": 20.0,
    "clamp_length_m": 0.2,
    "side_force_bending": False,
    "groove": "path",
    "moment_balance": "free",
    "twist": False,
}


def is_same(one: Equilibrium, other: Equilibrium) -> bool:
    return json.dumps(equilibrium_dict(one)) == json.dumps(equilibrium_dict(other))


def test_every_input_reaches_the_turn_and_numbers_of_numpy_are_numbers() -> None:
    ski, angle = read_ski("slalom"), math.radians(45.0)
    plain = carve(ski, FIRM, edge_angle=angle, load=800.0, unloading_ratio=10.0, elements=80)
    assert is_same(answer_question(carve_question(REQUEST | NUMBERS | {"unloading_ratio": 10.0})).equilibrium, plain)
    chosen = carve(
        ski, FIRM, edge_angle=angle, load=800.0, unloading_ratio=10.0, elements=80, moment=20.0, clamp_length=0.2,
        side_force_bending=False, groove="path", moment_balance="free", twist=False,
    )  # fmt: skip
    answer = answer_question(carve_question(REQUEST | NUMBERS | CHOSEN | {"unloading_ratio": 10.0}))
    assert is_same(answer.equilibrium, chosen)
    assert not is_same(chosen, plain)
    # As `np.radians` gives them.
    asked: dict[str, Any] = {"unloading_ratio": 10.0, "elements": 80}
    plain = carve(read_ski("slalom"), FIRM, edge_angle=math.radians(45), load=800.0, **asked)
    other = carve(read_ski("slalom"), FIRM, edge_angle=np.radians(45), load=np.float64(800.0), **asked)
    assert other.turn_radius_boot == plain.turn_radius_boot


def test_the_unloading_ratio_of_the_snow_is_taken_where_none_is_given() -> None:
    ski = read_ski("slalom")
    asked: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "elements": 80}
    plain, known = (carve(ski, FIRM, unloading_ratio=ratio, **asked) for ratio in (10.0, 3.0))
    snow = replace(FIRM, unloading_ratio=3.0)
    assert is_same(carve(ski, snow, **asked), known)
    assert is_same(carve(ski, snow, unloading_ratio=10.0, **asked), plain)
    assert not is_same(plain, known)
    with raises(ParameterError, "missing", source="given as numbers"):
        carve(ski, FIRM, **asked)


def test_every_input_reaches_the_ski_at_rest() -> None:
    chosen = rest(
        read_ski("slalom"), FIRM, edge_angle=math.radians(45.0), load=800.0, elements=80, moment=20.0,
        clamp_length=0.2, twist=False,
    )  # fmt: skip
    answer = answer_question(carve_question(REQUEST | CHOSEN | {"H_V_N_per_mm3": 0.2, "at_rest": True}))
    assert answer.equilibrium.side_force == 0.0
    assert is_same(answer.equilibrium, replace(chosen, side_force_limit=None))


def test_the_units_of_the_names() -> None:
    answer = answer_question(carve_question(REQUEST | NUMBERS | {"unloading_ratio": math.inf}))
    found, same = answer.equilibrium, answer_dict(answer)
    assert same == json.loads(json.dumps(same, allow_nan=False))
    for key, values, factor in (
        ("station_m", found.station, 1.0),
        ("edge_depth_mm", found.edge_depth, 1e3),
        ("force_per_length_N_per_m", found.force_per_length, 1.0),
        ("bending_mm", found.bending, 1e3),
        ("twist_deg", found.twist, 180.0 / math.pi),
        ("edge_line_mm", found.edge_line, 1e3),
    ):
        assert same[key] == pytest.approx(np.asarray(values) * factor, rel=1e-12), key
    assert (same["outcome"], same["holds"]) == (found.outcome, found.holds)
    assert same["side_force_N"] == pytest.approx(800.0, rel=1e-12)  # at 45 degrees
    assert same["turn_radius_boot_m"] == found.turn_radius_boot
    assert same["inputs"]["unloading_ratio"] == 1000.0
    assert (same["inputs"]["H_V_N_per_mm3"], same["inputs"]["S_f_N_per_mm2"]) == (0.2, 0.5)
    assert same["ski"]["length_m"] == read_ski("slalom").length


def test_the_inputs_of_a_named_snow_are_its_numbers() -> None:
    snow = load_snow("race-piste")
    asked = REQUEST | {"published": "race-piste"}
    told = answer_dict(answer_question(carve_question({**asked, "unloading_ratio": 10.0})))["inputs"]
    assert told["H_V_N_per_mm3"] == pytest.approx(snow.snow_hardness / 1e9, rel=1e-12)
    assert told["S_f_N_per_mm2"] == pytest.approx((snow.failure_shear_stress or 0.0) / 1e6, rel=1e-12)
    assert told["unloading_ratio"] == 10.0
    assert answer_dict(answer_question(carve_question({**asked, "at_rest": True})))["inputs"]["unloading_ratio"] is None
    with raises(ParameterError, "contradiction"):
        answer_question(carve_question({**asked, "unloading_ratio": 10.0, "S_f_N_per_mm2": 0.3}))


def test_numbers_that_do_not_exist_are_none() -> None:
    asked = {**REQUEST, "H_V_N_per_mm3": 1e-6, "S_f_N_per_mm2": 0.5, "unloading_ratio": 1.0}
    sunk = answer_dict(answer_question(carve_question(asked)))
    assert sunk["outcome"] == "sinks"
    assert {sunk[key] for key in ("holds", "turn_radius_boot_m", "edge_depth_mm", "residual_moment_Nm")} == {None}
    assert len(sunk["station_m"]) > 80
    found = answer_question(carve_question(REQUEST | NUMBERS | {"unloading_ratio": 1.0})).equilibrium
    holed = equilibrium_dict(replace(found, twist=np.array([0.0, math.nan, math.pi])))
    assert holed["twist_deg"] == [0.0, None, 180.0]


def test_one_answer_stands_alone_and_several_under_skis() -> None:
    answer = answer_question(carve_question(REQUEST | NUMBERS | {"unloading_ratio": 1.0}))
    assert answers_dict([answer]) == answer_dict(answer)
    assert answers_dict([answer, answer]) == {"skis": [answer_dict(answer)] * 2}


def test_a_shear_stress_beyond_what_was_measured_counts_in_a_turn_alone() -> None:
    strong = REQUEST | {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.9}
    (told,) = answer_question(carve_question({**strong, "unloading_ratio": 1.0})).warnings
    assert "S_f 0.9 N/mm² is outside" in told
    assert answer_question(carve_question({**strong, "at_rest": True})).warnings == ()
    assert answer_question(carve_question({**REQUEST, "H_V_N_per_mm3": 0.2, "at_rest": True})).warnings == ()
    for hardness in (0.01, 200.0):
        (told,) = answer_question(carve_question({**REQUEST, "H_V_N_per_mm3": hardness, "at_rest": True})).warnings
        assert f"H_V {hardness:g} N/mm³ is outside" in told


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"moment": math.nan}, "not_a_number"),
        ({"moment": math.inf}, coded("not_a_number", moment=float("inf"))),
        ({"load": 0.0}, coded("out_of_range", load=0.0)),
        ({"load": math.inf}, coded("out_of_range", load=float("inf"))),
        ({"unloading_ratio": 0.99}, "out_of_range"),
        ({"edge_angle": -0.01}, "out_of_range"),
    ],
)
def test_numbers_that_no_turn_has(asked: dict[str, float], told: str | Coded) -> None:
    sound: dict[str, Any] = {"edge_angle": 0.5, "load": 800.0, "unloading_ratio": 10.0}
    with raises(ParameterError, told):
        carve(read_ski("slalom"), load_snow("race-piste"), **sound | asked)


@pytest.mark.parametrize("name", SKI_FACTORS)
def test_a_factor_of_a_question_is_that_of_an_edit(name: str) -> None:
    ski = read_ski("slalom")
    edit = SkiEdit(edit_stations(ski), {SKI_FACTORS[name]: 1.1})
    asked = REQUEST | {"published": "race-piste", "unloading_ratio": 10.0}
    found, before = (answer_question(carve_question(asked | {name: factor})) for factor in (1.1, 1.0))
    edited = edited_ski(ski, edit, name="edited", source="test")
    wanted = carve(
        edited, load_snow("race-piste"), edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0, elements=80
    )
    assert found.equilibrium.turn_radius_boot == wanted.turn_radius_boot != before.equilibrium.turn_radius_boot
    assert before.ski.keys == ski.keys


ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "methods" / "carved-turn.md").read_text("utf-8")
CORE = ROOT / "src" / "core"
SOURCES = [*sorted((CORE / "carve").glob("*.?pp")), CORE / "snow" / "hypoplastic.hpp"]


def test_marks() -> None:
    """In brackets, without links; in the sources they begin a remark."""
    marked = re.findall(r"^ *// \[([a-z ]+)\]", "\n".join(each.read_text("utf-8") for each in SOURCES), re.MULTILINE)
    named = re.findall(r"\[([a-z]+(?:, [a-z]+)*)\](?!\()", PAGE)
    assert {name for group in named for name in group.split(", ")} == set(marked)
    assert {"hypoplastic", "strip", "balance"} <= set(marked)
