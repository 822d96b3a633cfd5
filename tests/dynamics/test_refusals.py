"""What no run can be made of is refused by name."""

from __future__ import annotations

import math
from typing import Any

import pytest

from skisnow.contact import Runner, SnowContact
from skisnow.dynamics import Dynamics, StepControl
from skisnow.errors import ParameterError

from .sledges import body_of, clamped_ski, given, placed, snow_of


@pytest.mark.parametrize("name", ["first", "tolerance", "longest", "shortest", "closeness"])
@pytest.mark.parametrize("value", [0.0, -1e-3, math.inf, math.nan])
def test_lengths_and_tolerances(name: str, value: float) -> None:
    given_so: dict[str, Any] = {name: value}
    with pytest.raises(ParameterError, match=rf"StepControl: {name} is {value!r}"):
        StepControl(**given_so)


@pytest.mark.parametrize("kept", [0, -1])
def test_matrix_kept(kept: int) -> None:
    with pytest.raises(ParameterError, match=rf"matrix_kept is {kept}; it must be 1 or more"):
        StepControl(matrix_kept=kept)


@pytest.mark.parametrize("count", [1, 3])
def test_number_of_runners(count: int) -> None:
    scenario = given()
    runner = Runner.of(scenario.ski, nodes=clamped_ski(scenario, 40).node)
    contact = SnowContact(snow_of(scenario), [runner] * count)
    with pytest.raises(ParameterError, match=rf"the body has 2 skis, the contact {count} runners"):
        Dynamics(body_of(scenario), contact, *placed(scenario, height=0.02), StepControl())
