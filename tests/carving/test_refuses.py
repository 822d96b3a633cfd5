"""What no carve can be asked is refused before anything is computed."""

from __future__ import annotations

import math
from typing import Any

import pytest

from skisnow import carve, load_snow, read_ski
from skisnow._support.errors import ParameterError
from tests.coded import Coded, coded, raises


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
