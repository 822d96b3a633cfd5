"""Questions about a ski in snow: what is missing, said twice or not meant, and numbers that look like a slip."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from skisnow import read_ski
from skisnow._support.errors import ParameterError
from skisnow.carving.keys import CarveQuestion
from skisnow.carving.limits import implausible_values, require_clamp
from skisnow.carving.question import carve_question
from skisnow.snow.properties import GREATEST_LIKELY_HARDNESS
from tests.coded import raises

ASKED: dict[str, object] = {"ski": "slalom", "edge_angle_deg": 45.0, "load_N": 800.0, "unloading_ratio": 10.0}
SNOW: dict[str, object] = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
NEITHER_WAY = "Give H_V_N_per_mm3 and S_f_N_per_mm2, or results, or published"


@pytest.mark.parametrize(
    ("values", "told"),
    [
        (ASKED, f"no snow is given: H_V has no default. {NEITHER_WAY}"),
        (ASKED | SNOW | {"results": "r.json"}, f"in two ways, H_V_N_per_mm3 and results. {NEITHER_WAY}"),
        (ASKED | {"results": "r.json", "published": "race-piste"}, "in two ways, results and published"),
        (ASKED | {"H_V_N_per_mm3": 0.2}, "S_f_N_per_mm2 is missing: a carved turn needs"),
        (ASKED | SNOW | {"site": "A"}, "site goes with results"),
        (ASKED | {"published": "race-piste", "site": "A"}, "site goes with results"),
        (SNOW | {"ski": "slalom", "load_N": 800.0, "unloading_ratio": 1.0}, "edge_angle_deg is missing: angle"),
        ({name: ASKED[name] for name in ("ski", "edge_angle_deg", "load_N")} | SNOW, "unloading_ratio is missing"),
        (ASKED | SNOW | {"edge_angle": 45.0}, "edge_angle is no input of a carved turn. Did you mean edge_angle_deg"),
        (ASKED | SNOW | {"load_N": 0.0}, "load_N is 0.0"),
    ],
)
def test_what_is_no_question_is_refused(values: dict[str, object], told: str) -> None:
    with pytest.raises(ParameterError) as refused:
        carve_question(values)
    assert told in str(refused.value)


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
        (20.0, "--clamp-length-m 0, or 0.02 if the number is in mm"),
        (1706.0, "--clamp-length-m 0, or 1.706 if the number is in mm"),
        (1708.0, "--clamp-length-m 0"),
    ],
)
def test_a_clamp_in_millimetres_is_guessed_where_it_may_be_one(length: float, told: str) -> None:
    """The boot of the giant-slalom ski stands 0.8535 m before its tail."""
    with pytest.raises(ParameterError) as refused:
        require_clamp(read_ski("giant-slalom"), length)
    assert str(refused.value).endswith(f"allows less than 1.71 m: write {told}")
    assert "(the default)" not in str(refused.value)


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


@pytest.mark.parametrize(
    "changed",
    [{"load_N": 20.0}, {"load_N": 5000.0}, {"edge_angle_deg": 0.0}, {"H_V_N_per_mm3": GREATEST_LIKELY_HARDNESS}],
)
def test_the_last_usual_numbers_are_not_suspected(changed: dict[str, float]) -> None:
    assert implausible_values(replace(carve_question(ASKED | SNOW), **changed)) == ()  # type: ignore[arg-type]
