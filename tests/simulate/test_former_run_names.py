"""Names that a run had before still give its numbers, and warn."""

from __future__ import annotations

import pytest

from skisnow.scenario import scenario_file

from .straight_run import STRAIGHT, straight_run

ASKED = scenario_file("carved-46m", changes=STRAIGHT)


@pytest.mark.parametrize(
    ("former", "name"), [("energy_turned_over", "energy_exchanged"), ("open_energy", "energy_residual")]
)
def test_a_former_number_is_given_with_a_warning(former: str, name: str) -> None:
    run = straight_run(ASKED.scenario)
    with pytest.warns(DeprecationWarning, match=f"Run.{former} is called {name} now"):
        assert getattr(run, former) == getattr(run, name)


def test_a_former_question_is_answered_with_a_warning() -> None:
    run = straight_run(ASKED.scenario)
    with pytest.warns(DeprecationWarning, match="Run.is_open_by is called has_residual_above now"):
        assert run.is_open_by(0.02) is run.has_residual_above(0.02)
