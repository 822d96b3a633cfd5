"""What no carve can be asked is refused before anything is computed."""

from __future__ import annotations

import math
from typing import Any

import pytest

from skisnow import carve, published_snow, read_ski
from skisnow._support.errors import ParameterError


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"moment": math.nan}, "moment is nan N m; it must be finite"),
        ({"moment": math.inf}, "moment is inf N m; it must be finite"),
        ({"load": 0.0}, "load is 0.0 N; it must be a finite force above 0"),
        ({"load": math.inf}, "load is inf N"),
        ({"unloading_ratio": 0.99}, "k_u/H_V must be 1"),
        ({"edge_angle": -0.01}, "it must be from 0 to"),
    ],
)
def test_numbers_that_no_turn_has(asked: dict[str, float], told: str) -> None:
    sound: dict[str, Any] = {"edge_angle": 0.5, "load": 800.0, "unloading_ratio": 10.0}
    with pytest.raises(ParameterError, match=told):
        carve(read_ski("slalom"), published_snow("race-piste"), **sound | asked)
