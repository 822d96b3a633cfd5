"""What no carve can be asked is refused before anything is computed; what snow and ski ask of a run."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from skisnow import carve, published_snow, read_ski
from skisnow.errors import ParameterError
from skisnow.scenario import read_scenario
from skisnow.simulate import run_setup
from skisnow.simulate.run_setup import Setup, laid_out


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


@pytest.mark.parametrize(("load", "sinks"), [(1699.0, False), (1701.0, True)])
def test_snow_that_does_not_bear_a_ski_a_decimetre_deep(load: float, sinks: bool) -> None:
    """1.7 m by 0.1 m, 0.1 m deep in 0.1 MN/m³: 1700 N."""
    ski = SimpleNamespace(
        station=np.array([0.9, 0.2, -0.8]), at=lambda station: SimpleNamespace(width=np.full_like(station, 0.1))
    )
    snow = SimpleNamespace(contact=SimpleNamespace(snow=SimpleNamespace(snow_hardness=1e5)), ski=ski)
    stub = cast("Any", SimpleNamespace(scenario=snow, numbers={"load_N": load}))
    assert cast("Any", Setup.sinks).fget(stub) is sinks


def test_a_ski_that_bends_in_short_waves_has_five_elements_to_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """1.8 m of giant-slalom ski and waves of 0.1 m: 90 elements, and a line of snow every centimetre."""
    scenario, contact = read_scenario("carved-46m"), run_setup._contact
    monkeypatch.setattr(run_setup, "_contact", lambda each: (*contact(each)[:2], 0.1))
    found = laid_out(scenario).numbers
    assert float(scenario.ski.station[0] - scenario.ski.station[-1]) == pytest.approx(1.8)
    assert found["elements"] == 90.0
    assert found["line_spacing_m"] == pytest.approx(0.01)
