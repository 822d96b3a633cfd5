"""Balance and summary of a run."""

import json
import math
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import jsonschema
import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.errors import ParameterError
from skisnow.cli.shell import json_schema
from skisnow.scenario import Profile, load_scenario, scenario_file
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Run
from skisnow.simulation.run_forces import balance_of
from skisnow.simulation.run_summary import run_warnings, summary_dict
from skisnow.simulation.simulated_run import REMEDIES
from tests.present import present

from .straight_run import STRAIGHT, straight_run

FloatArray = npt.NDArray[np.float64]

ANGLE = math.radians(20.0)
PLAIN = load_scenario("carved-46m", changes={**STRAIGHT, "angle_deg": 20.0})
TIME = np.linspace(0.0, 2.0, 401)
SPEED, RADIUS, HEIGHT = 9.0, 15.0, 0.9
STANCE, LEFT, RIGHT = 0.4, 300.0, 500.0
INNER = slice(4, -4)


def moved(*, lean: float = 0.4, rise: float = 0.0, roll: float = 0.0, load: float = 1.0) -> Run:
    """The centre of mass on a circle to the left, up and down by `rise` (m), the body rolling by `roll` (rad).

    Its skis stand to its right, where it leans to, and bear LEFT and RIGHT (N), or a share of it.
    """
    heading = SPEED / RADIUS * TIME - 0.5
    ahead, to_left = (np.stack([np.cos(a), np.sin(a), 0.0 * a], axis=1) for a in (heading, heading + math.pi / 2.0))
    up = np.broadcast_to([0.0, 0.0, 1.0], ahead.shape)
    centre = RADIUS * np.stack([np.sin(heading), -np.cos(heading), 0.0 * heading], axis=1)
    height = HEIGHT + rise * np.sin(5.0 * TIME)
    middle = centre - HEIGHT * math.tan(lean) * to_left
    tilt = roll * np.sin(4.0 * TIME)[:, None]
    body = np.stack([ahead, np.cos(tilt) * to_left - np.sin(tilt) * up, np.sin(tilt) * to_left + np.cos(tilt) * up], 2)
    flat = np.stack([ahead, to_left, up], axis=1)
    run = straight_run(PLAIN)
    return replace(
        run,
        time=TIME,
        place=middle,
        attitude=body,
        boots=BootHistory(
            place=np.stack([middle + side * STANCE / 2.0 * to_left for side in (1.0, -1.0)], axis=1),
            axes=np.repeat(flat[:, None], 2, axis=1),
            own_force=np.broadcast_to(load * np.array([[0.0, 0.0, LEFT], [0.0, 0.0, RIGHT]]), (len(TIME), 2, 3)),
            own_moment=np.zeros((len(TIME), 2, 3)),
            centre_of_mass=centre + height[:, None] * up,
        ),
    )


def needed(run: Run, rise: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """To the left and off the snow, what the skis give a kilogram of a body on that path (m/s²)."""
    heading = SPEED / RADIUS * TIME - 0.5
    g = run.scenario.gravity
    to_left = SPEED**2 / RADIUS + g * math.sin(ANGLE) * np.sin(heading)
    return to_left, g * math.cos(ANGLE) - 25.0 * rise * np.sin(5.0 * TIME)


def test_lean_and_pressure_are_those_of_the_places_and_forces_and_skis_in_a_plough_lean_no_less() -> None:
    """The load's centre lies where it balances 300 N on the left and 500 N on the right ski, 0.4 m apart."""
    found = balance_of(moved())
    aside = HEIGHT * math.tan(0.4)
    pressure = STANCE / 2.0 * (LEFT - RIGHT) / (LEFT + RIGHT)
    assert found.lean == pytest.approx(np.full(len(TIME), 0.4))
    assert found.pressure == pytest.approx(np.full(len(TIME), pressure))
    assert found.pressure_lean == pytest.approx(np.full(len(TIME), math.atan2(aside - pressure, HEIGHT)))
    assert found.leg == pytest.approx(np.full(len(TIME), math.hypot(aside, HEIGHT)))
    assert found.load == pytest.approx(np.broadcast_to([LEFT, RIGHT], (len(TIME), 2)))
    assert found.angulation == pytest.approx(np.full(len(TIME), -0.4))  # flat skis under a body that leans
    # Each turned by 30 degrees: the mean of their axes is shorter than either, and the way ahead is the same.
    run = moved()
    turned = []
    for ski, angle in enumerate((-math.pi / 6.0, math.pi / 6.0)):
        own = present(run.boots).axes[:, ski]
        ahead = math.cos(angle) * own[:, 0] + math.sin(angle) * own[:, 1]
        turned.append(np.stack([ahead, np.cross(own[:, 2], ahead), own[:, 2]], axis=1))
    found = balance_of(replace(run, boots=replace(present(run.boots), axes=np.stack(turned, axis=1))))
    assert found.lean == pytest.approx(np.full(len(TIME), 0.4))
    assert found.pressure == pytest.approx(balance_of(run).pressure)


def test_a_moment_of_the_skis_moves_the_pressure() -> None:
    """40 N m about the axis ahead, under 800 N: 5 cm, to the left as a heavier left ski."""
    run = moved()
    moment = np.zeros((len(TIME), 2, 3))
    moment[:, :, 0] = 20.0
    turned = balance_of(replace(run, boots=replace(present(run.boots), own_moment=moment)))
    assert turned.pressure - balance_of(run).pressure == pytest.approx(np.full(len(TIME), 40.0 / 800.0))


def test_skis_that_hardly_bear_have_no_centre_of_pressure() -> None:
    for share, known in ((0.0624, False), (0.0626, True)):  # of 800 N: 50 N
        found = balance_of(moved(load=share))
        assert np.isfinite(found.pressure).all() == np.isfinite(found.pressure_lean).all() == known
        assert np.isfinite(found.pressure).any() == known
    assert np.isfinite(balance_of(moved(load=0.0)).lean).all()


def test_a_body_in_balance_leans_as_what_its_skis_give_it_and_roll_and_rise_take_their_part() -> None:
    """tan Ψ = (v²/R + g sin α sin θ)/(g cos α), with θ from the fall line: uphill of it the slope helps."""
    run = moved()
    found = balance_of(run)
    aside, up = needed(run)
    assert np.tan(found.balanced_lean[INNER]) == pytest.approx((aside / up)[INNER], rel=1e-3)
    assert np.tan(found.rolling_lean[INNER]) == pytest.approx((aside / up)[INNER], rel=1e-3)
    for each in (found.balanced_lean, found.rolling_lean):
        assert np.isnan(each[[0, 1, -2, -1]]).all()
        assert np.isfinite(each[2:-2]).all()
    # I φ''/(m z) to the left, and the rise of the centre of mass beside gravity.
    run = moved(rise=0.05, roll=0.2)
    found = balance_of(run)
    aside, up = needed(run, rise=0.05)
    sledge = run.scenario.sledge
    height = HEIGHT + 0.05 * np.sin(5.0 * TIME)
    rolled = -16.0 * 0.2 * np.sin(4.0 * TIME) * sledge.inertia[0] / (sledge.mass * height)
    assert np.max(np.abs(rolled)) > 0.1
    assert np.tan(found.rolling_lean[INNER]) == pytest.approx(((aside + rolled) / up)[INNER], rel=2e-3)
    steady = aside / (run.scenario.gravity * math.cos(ANGLE))
    assert np.tan(found.balanced_lean[INNER]) == pytest.approx(steady[INNER], rel=2e-3)


def test_a_straight_profile_is_a_plane() -> None:
    """The same motion in axes with z upwards: every number is the same."""
    run = moved(rise=0.05, roll=0.2)
    assert run.boots is not None
    c, s = math.cos(ANGLE), math.sin(ANGLE)
    level = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])  # rows: the slope's axes
    x = np.linspace(-60.0, 60.0, 25)
    other = replace(
        run,
        scenario=run.scenario.with_(slope=Profile(x, -math.tan(ANGLE) * x)),
        place=run.place @ level,
        attitude=level.T @ run.attitude,
        boots=replace(
            run.boots,
            place=run.boots.place @ level,
            axes=run.boots.axes @ level,
            centre_of_mass=run.boots.centre_of_mass @ level,
        ),
    )
    one, two = balance_of(run), balance_of(other)
    for name in ("lean", "pressure_lean", "balanced_lean", "rolling_lean", "leg", "pressure", "load"):
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-9, nan_ok=True), name


def test_of_a_few_moments_nothing_is_in_balance_and_without_boots_nothing_is_known() -> None:
    run = moved()
    for n, known in ((4, 0), (5, 1)):
        few = replace(
            run,
            time=TIME[:n],
            place=run.place[:n],
            attitude=run.attitude[:n],
            boots=BootHistory(**{name: getattr(present(run.boots), name)[:n] for name in BootHistory.__slots__}),
        )
        found = balance_of(few)
        assert np.isfinite(found.lean).all()
        assert [int(np.isfinite(each).sum()) for each in (found.balanced_lean, found.rolling_lean)] == [known, known]
    with pytest.raises(ParameterError, match="boots"):
        balance_of(straight_run(PLAIN))


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
END_SPEED = 5.0 + 2.0 * ACCELERATION
LENGTH = 10.0 + 2.0 * ACCELERATION


def test_summary_has_the_keys_of_the_contract_and_holds_to_its_schema() -> None:
    found = json.loads(json.dumps(summary_dict(straight_run(ASKED.scenario), ASKED.values), allow_nan=False))
    jsonschema.validate(found, SCHEMA)
    assert set(found) >= CONTRACT
    assert set(found["energies"]) == ENERGIES
    assert (found["outcome"], found["steps"], found["rejected_steps"], found["wall_s"]) == ("finished", 1000, 7, 0.5)


def test_numbers_are_those_of_the_closed_form_and_balance_error_is_what_is_missing_of_what_was_turned_over() -> None:
    found = summary_dict(straight_run(ASKED.scenario), ASKED.values)
    assert found["run_length_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert found["simulated_s"] == 2.0
    assert found["end"]["x_m"] == pytest.approx(LENGTH, rel=1e-12)
    assert found["end"]["speed_m_per_s"] == pytest.approx(END_SPEED, rel=1e-12)
    assert found["greatest_speed_m_per_s"] == pytest.approx(END_SPEED, rel=1e-12)
    assert found["least_turn_radius_m"] is None
    energies = found["energies"]
    assert energies["kinetic_start_J"] == pytest.approx(MASS * 12.5, rel=1e-12)
    assert energies["kinetic_J"] == pytest.approx(MASS * END_SPEED**2 / 2.0, rel=1e-12)
    assert energies["potential_J"] == pytest.approx(-MASS * 9.81 * 0.17364817766693033 * LENGTH, rel=1e-12)
    assert energies["lost_friction_J"] == pytest.approx(0.05 * MASS * 9.81 * 0.984807753012208 * LENGTH, rel=1e-12)
    assert (energies["elastic_ski_J"], energies["elastic_snow_J"]) == (1.0, 2.0)
    assert found["energy_balance_error"] < 1e-14  # rounding: the closed form balances
    # Without the friction's loss just that is missing of kinetic start energy, no loss, and the fall in potential.
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


def test_scenario_is_in_sections_with_every_key() -> None:
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
