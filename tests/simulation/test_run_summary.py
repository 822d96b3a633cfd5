"""summary.json of a straight run known in closed form."""

import json
import math
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from skisnow.cli.schema import json_schema
from skisnow.scenario import scenario_file
from skisnow.simulation.run import Run
from skisnow.simulation.run_summary import run_warnings, summary_dict
from skisnow.simulation.simulated_run import REMEDIES

from .straight_run import STRAIGHT, straight_run

SCHEMA = json_schema("summary")
ASKED = scenario_file("carved-46m", changes=STRAIGHT)
CONTRACT = {
    *("outcome", "remedy", "run_length_m", "simulated_s", "wall_s", "steps", "rejected_steps", "energies"),
    *("energy_balance_error", "scenario", "provenance", "turn_radius_median_m", "turn_radius_p5_m"),
}
ENERGIES = {
    *("kinetic_J", "potential_J", "elastic_ski_J", "elastic_snow_J", "delayed_snow_J"),
    *("kinetic_start_J", "potential_start_J", "elastic_ski_start_J", "elastic_snow_start_J"),
    "delayed_snow_start_J",
    *("lost_penetration_J", "lost_shear_J", "lost_friction_J", "lost_drag_J", "lost_damping_J"),
    "lost_snow_damping_J",
}
MASS = 80.0 + 2.0 * ASKED.scenario.ski.mass
# 10 degrees, μ = 0.05, g = 9.81 m/s², from 5 m/s over 2 s
ACCELERATION = 9.81 * (0.17364817766693033 - 0.05 * 0.984807753012208)
SPEED = 5.0 + 2.0 * ACCELERATION
LENGTH = 10.0 + 2.0 * ACCELERATION


def test_summary_has_the_keys_of_the_contract_and_holds_to_its_schema() -> None:
    found = json.loads(json.dumps(summary_dict(straight_run(ASKED.scenario), ASKED.values), allow_nan=False))
    jsonschema.validate(found, SCHEMA)
    assert set(found) >= CONTRACT
    assert set(found["energies"]) == ENERGIES
    assert (found["outcome"], found["steps"], found["rejected_steps"], found["wall_s"]) == ("finished", 1000, 7, 0.5)


def test_numbers_are_those_of_the_closed_form() -> None:
    found = summary_dict(straight_run(ASKED.scenario), ASKED.values)
    assert found["run_length_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert found["simulated_s"] == 2.0
    assert found["end"]["x_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert found["end"]["speed_m_per_s"] == pytest.approx(SPEED, rel=1e-12)
    assert found["greatest_speed_m_per_s"] == pytest.approx(SPEED, rel=1e-12)
    assert found["least_turn_radius_m"] is None
    energies = found["energies"]
    assert energies["kinetic_start_J"] == pytest.approx(MASS * 12.5, rel=1e-12)
    assert energies["kinetic_J"] == pytest.approx(MASS * SPEED**2 / 2.0, rel=1e-12)
    assert energies["potential_J"] == pytest.approx(-MASS * 9.81 * 0.17364817766693033 * LENGTH, rel=1e-12)
    assert energies["lost_friction_J"] == pytest.approx(0.05 * MASS * 9.81 * 0.984807753012208 * LENGTH, rel=1e-12)
    assert (energies["elastic_ski_J"], energies["elastic_snow_J"]) == (1.0, 2.0)
    assert found["energy_balance_error"] < 1e-14  # rounding: the closed form balances


def test_balance_error_is_what_is_missing_of_what_was_turned_over() -> None:
    """Without the friction's loss just that is missing of kinetic start energy, no loss, and the fall in potential."""
    run = straight_run(ASKED.scenario)
    friction = float(run.energies["friction"][-1])
    without = replace(run, energies=run.energies | {"friction": np.zeros_like(run.time)})
    over = MASS * 12.5 + MASS * 9.81 * 0.17364817766693033 * LENGTH
    assert summary_dict(without)["energy_balance_error"] == pytest.approx(friction / over, rel=1e-12)


def at_rest() -> Run:
    run = straight_run(ASKED.scenario)
    return replace(run, energies={name: np.zeros_like(run.time) for name in run.energies})


def test_balance_error_is_null_where_nothing_was_turned_over() -> None:
    assert summary_dict(at_rest())["energy_balance_error"] is None


def test_least_radius_keeps_its_side() -> None:
    run = straight_run(ASKED.scenario)
    radius = np.full(len(run.time), math.inf)
    radius[3:6] = (20.0, -12.0, 15.0)
    assert summary_dict(replace(run, turn_radius=radius))["least_turn_radius_m"] == -12.0


def test_radius_of_the_turn_is_not_that_of_its_start() -> None:
    """Left out: the first half second, parts below 1 m/s, and straight parts. Without their sign."""
    run = straight_run(ASKED.scenario)
    radius, velocity = np.full(len(run.time), -20.0), run.velocity.copy()
    radius[run.time < 0.5 - 1e-9] = 0.01
    radius[-30:-10] = 0.02
    velocity[-30:-20], velocity[-20:-10] = (0.9, 0.0, 0.0), (1.0, 0.0, 0.0)
    radius[-10:] = math.inf
    counted = np.flatnonzero((run.time >= 0.5 - 1e-9) & (np.arange(len(run.time)) < len(run.time) - 30))
    radius[counted[:20]] = 12.0  # 20 of 121 moments
    assert len(counted) == 121
    found = summary_dict(replace(run, turn_radius=radius, velocity=velocity))
    assert (found["turn_radius_median_m"], found["turn_radius_p5_m"]) == (20.0, 12.0)
    none = summary_dict(run)
    assert (none["turn_radius_median_m"], none["turn_radius_p5_m"]) == (None, None)


def opened(joule: float) -> Run:
    """A run of which so much energy has gone unaccounted for."""
    run = straight_run(ASKED.scenario)
    return replace(run, energies=run.energies | {"damping": np.linspace(0.0, joule, len(run.time))})


def test_an_open_balance_is_warned_of() -> None:
    over = straight_run(ASKED.scenario).energy_exchanged
    assert run_warnings(opened(0.0049 * over)) == ()
    assert len(run_warnings(opened(0.0052 * over))) == 1
    (told,) = summary_dict(opened(0.03 * over), warnings=("another",))["warnings"][1:]
    assert "2.9 %" in told and f"{0.03 * over:.3g} J" in told
    nothing = replace(at_rest(), energies=at_rest().energies | {"damping": np.linspace(0.0, -3.0, 201)})
    assert nothing.energy_balance_error is None  # what was turned over is less than nothing: no share, but a word
    assert " 3 J: " in run_warnings(nothing)[0]
    still = replace(at_rest(), energies=at_rest().energies | {"damping": np.linspace(0.0, 0.9e-3, 201)})
    assert still.energy_balance_error == 1.0
    assert run_warnings(still) == ()  # less than 1 mJ


def test_energies_stand_at_both_ends_and_the_heading_at_the_last() -> None:
    run = straight_run(ASKED.scenario)
    rising = np.linspace(1.0, 5.0, len(run.time))
    found = summary_dict(replace(run, heading=rising / 10.0, energies=dict.fromkeys(run.energies, rising)))
    assert found["end"]["heading_deg"] == pytest.approx(math.degrees(0.5))
    energies = found["energies"]
    assert {energies[name] for name in energies if name.endswith("_start_J")} == {1.0}
    assert {energies[name] for name in energies if not name.endswith("_start_J")} == {5.0}


def test_energy_open_is_an_outcome_of_the_schema() -> None:
    found = summary_dict(replace(opened(1e4), outcome="energy_open", remedy=REMEDIES["energy_open"]), ASKED.values)
    assert list(jsonschema.Draft202012Validator(SCHEMA).iter_errors(found)) == []
    assert (found["outcome"], found["remedy"]) == ("energy_open", REMEDIES["energy_open"])
    with pytest.raises(jsonschema.ValidationError, match="energy_shut"):
        jsonschema.validate(found | {"outcome": "energy_shut"}, SCHEMA)


def test_what_is_not_finite_is_null() -> None:
    run = straight_run(ASKED.scenario)
    place = run.place.copy()
    place[-1] = math.nan
    found = summary_dict(replace(run, place=place, outcome="not_finite"))
    assert found["end"]["x_m"] is None
    json.dumps(found, allow_nan=False)


def test_scenario_stands_in_sections_with_every_key() -> None:
    found = summary_dict(straight_run(ASKED.scenario), ASKED.values)["scenario"]
    assert found["snow"]["H_V_N_per_mm3"] == 0.2
    assert found["sledge"]["inertia_kg_m2"] == [6.0, 8.0, 10.0]
    assert found["start"]["heading_deg"] == 0.0
    own = summary_dict(straight_run(ASKED.scenario))["scenario"]  # of a scenario that was built in Python
    assert own["snow"]["H_V_N_per_mm3"] == pytest.approx(0.2, rel=1e-15)
    assert {part: list(values) for part, values in own.items()} == {part: list(v) for part, v in found.items()}


def test_provenance_has_the_hash_of_each_file(tmp_path: Path) -> None:
    path = tmp_path / "scenario.toml"
    path.write_bytes(b"[run]\n")
    found = summary_dict(straight_run(ASKED.scenario), files=[path])["provenance"]
    assert found["files"] == {str(path): sha256(b"[run]\n").hexdigest()}
    assert {"skisnow", "numpy", "scipy", "python"} <= set(found["versions"])
