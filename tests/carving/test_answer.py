"""An answer is that of `carve` or `rest` to the same question in SI, and its JSON says it in the units of its names."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow import carve, load_snow, read_ski
from skisnow._support.errors import ParameterError
from skisnow.carving.answer import answered
from skisnow.carving.answer_dict import answer_dict, answers_dict, equilibrium_dict
from skisnow.carving.equilibrium import rest
from skisnow.carving.question import carve_question
from skisnow.carving.result import Equilibrium
from skisnow.snow import SnowProperties
from tests.coded import raises

SNOW = SnowProperties(2e8, 5e5, source="given as numbers")
NUMBERS: dict[str, object] = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
ASKED: dict[str, object] = {"ski": "slalom", "edge_angle_deg": 45.0, "load_N": 800.0, "elements": 80}
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


def test_every_input_reaches_the_turn() -> None:
    ski, angle = read_ski("slalom"), math.radians(45.0)
    plain = carve(ski, SNOW, edge_angle=angle, load=800.0, unloading_ratio=10.0, elements=80)
    assert is_same(answered(carve_question(ASKED | NUMBERS | {"unloading_ratio": 10.0})).equilibrium, plain)
    chosen = carve(
        ski, SNOW, edge_angle=angle, load=800.0, unloading_ratio=10.0, elements=80, moment=20.0, clamp_length=0.2,
        side_force_bending=False, groove="path", moment_balance="free", twist=False,
    )  # fmt: skip
    answer = answered(carve_question(ASKED | NUMBERS | CHOSEN | {"unloading_ratio": 10.0}))
    assert is_same(answer.equilibrium, chosen)
    assert not is_same(chosen, plain)


def test_numbers_of_numpy_are_numbers() -> None:
    """As `np.radians` gives them."""
    asked: dict[str, Any] = {"unloading_ratio": 10.0, "elements": 80}
    plain = carve(read_ski("slalom"), SNOW, edge_angle=math.radians(45), load=800.0, **asked)
    other = carve(read_ski("slalom"), SNOW, edge_angle=np.radians(45), load=np.float64(800.0), **asked)
    assert other.turn_radius_boot == plain.turn_radius_boot


def test_the_unloading_ratio_of_the_snow_is_taken_where_none_is_given() -> None:
    ski = read_ski("slalom")
    asked: dict[str, Any] = {"edge_angle": math.radians(45.0), "load": 800.0, "elements": 80}
    plain, known = (carve(ski, SNOW, unloading_ratio=ratio, **asked) for ratio in (10.0, 3.0))
    snow = replace(SNOW, unloading_ratio=3.0)
    assert is_same(carve(ski, snow, **asked), known)
    assert is_same(carve(ski, snow, unloading_ratio=10.0, **asked), plain)
    assert not is_same(plain, known)
    with raises(ParameterError, "missing", source="given as numbers"):
        carve(ski, SNOW, **asked)


def test_every_input_reaches_the_ski_at_rest() -> None:
    chosen = rest(
        read_ski("slalom"), SNOW, edge_angle=math.radians(45.0), load=800.0, elements=80, moment=20.0,
        clamp_length=0.2, twist=False,
    )  # fmt: skip
    answer = answered(carve_question(ASKED | CHOSEN | {"H_V_N_per_mm3": 0.2, "at_rest": True}))
    assert answer.equilibrium.side_force == 0.0
    assert is_same(answer.equilibrium, replace(chosen, side_force_limit=None))


def test_the_units_of_the_names() -> None:
    answer = answered(carve_question(ASKED | NUMBERS | {"unloading_ratio": math.inf}))
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
    asked = ASKED | {"published": "race-piste"}
    told = answer_dict(answered(carve_question({**asked, "unloading_ratio": 10.0})))["inputs"]
    assert told["H_V_N_per_mm3"] == pytest.approx(snow.snow_hardness / 1e9, rel=1e-12)
    assert told["S_f_N_per_mm2"] == pytest.approx((snow.failure_shear_stress or 0.0) / 1e6, rel=1e-12)
    assert told["unloading_ratio"] == 10.0
    assert answer_dict(answered(carve_question({**asked, "at_rest": True})))["inputs"]["unloading_ratio"] is None
    with raises(ParameterError, "contradiction"):
        answered(carve_question({**asked, "unloading_ratio": 10.0, "S_f_N_per_mm2": 0.3}))


def test_numbers_that_do_not_exist_are_none() -> None:
    asked = {**ASKED, "H_V_N_per_mm3": 1e-6, "S_f_N_per_mm2": 0.5, "unloading_ratio": 1.0}
    sunk = answer_dict(answered(carve_question(asked)))
    assert sunk["outcome"] == "sinks"
    assert {sunk[key] for key in ("holds", "turn_radius_boot_m", "edge_depth_mm", "residual_moment_Nm")} == {None}
    assert len(sunk["station_m"]) > 80
    found = answered(carve_question(ASKED | NUMBERS | {"unloading_ratio": 1.0})).equilibrium
    holed = equilibrium_dict(replace(found, twist=np.array([0.0, math.nan, math.pi])))
    assert holed["twist_deg"] == [0.0, None, 180.0]


def test_one_answer_stands_alone_and_several_under_skis() -> None:
    answer = answered(carve_question(ASKED | NUMBERS | {"unloading_ratio": 1.0}))
    assert answers_dict([answer]) == answer_dict(answer)
    assert answers_dict([answer, answer]) == {"skis": [answer_dict(answer)] * 2}


def test_a_shear_stress_beyond_what_was_measured_counts_in_a_turn_alone() -> None:
    strong = ASKED | {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.9}
    (told,) = answered(carve_question({**strong, "unloading_ratio": 1.0})).warnings
    assert "S_f 0.9 N/mm² is outside" in told
    assert answered(carve_question({**strong, "at_rest": True})).warnings == ()
    assert answered(carve_question({**ASKED, "H_V_N_per_mm3": 0.2, "at_rest": True})).warnings == ()
