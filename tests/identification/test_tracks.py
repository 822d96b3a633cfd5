"""Parameters from tracks: straight runs in closed form, and one real simulated run."""

import argparse
import math
import re
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow._support.processes.kept_rows import Row
from skisnow.cli.identify import _with_fall_line
from skisnow.identification import Identification, identification_dict, identify, track_positions
from skisnow.identification.simulations import RunTask, grip_limit_sentences
from skisnow.identification.track_positions import estimated_noise
from skisnow.parameters import values_of
from skisnow.scenario import Scenario, load_scenario
from skisnow.simulation.run import Run
from skisnow.simulation.simulated_run import simulate
from skisnow.track.projection import GeodeticPoint
from skisnow.track.track import Track
from tests.coded import raises
from tests.present import present

from ..simulation.straight_run import straight_run
from . import straight_tracks
from .straight_tracks import SCENARIO, SD, TRUE_FRICTION, TRUE_SPEED, track

SLOPE = math.radians(10.0)


@pytest.fixture
def _straight(monkeypatch: pytest.MonkeyPatch) -> None:
    straight_tracks.put(monkeypatch)


def found_from(data: Any, free: str = "mu_0,speed", **more: Any) -> Identification:
    return identify("carved-46m", data, free, changes=SCENARIO, workers=1, **more)


@pytest.mark.usefixtures("_straight")
class TestStraight:
    def test_a_track_without_noise_gives_the_truth(self) -> None:
        """The search may end a fifth of a standard error (3e-4, 3e-3 m/s) off; a linear model ends far nearer."""
        said: list[str] = []
        found = found_from(track(), progress=said.append)
        assert said[:2] == ["starting; 1 simulated runs", "starting; 2 simulated runs"]
        assert any("own solver" in words for words in said)
        assert found.outcome == "converged"
        assert found["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=1e-5)
        assert found["speed"].value == pytest.approx(TRUE_SPEED, abs=1e-4)

    def test_a_run_near_the_limit_of_grip_is_warned_of(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """S_f above 0.5002 N/mm² and the run ends a metre aside: from 0.5 a thousandth reaches that, from 0.49 not."""

        def folded(scenario: Scenario) -> Run:
            run = straight_run(scenario)
            strength = present(scenario.contact.snow.failure_shear_stress)
            return replace(run, place=run.place + np.array([0.0, float(strength > 0.5002e6), 0.0]))

        module = ModuleType("skisnow.simulation.simulated_run")
        vars(module)["simulate"] = folded
        monkeypatch.setitem(sys.modules, "skisnow.simulation.simulated_run", module)
        told = "one: near the limit of grip: the end moves 1 m for 0.1 % of snow.S_f_N_per_mm2"
        for strength, near in ((0.5, True), (0.49, False)):
            found = identify(
                "carved-46m", track(), "mu_0,speed", changes=SCENARIO | {"snow.S_f_N_per_mm2": strength}, workers=1
            )
            assert found.outcome == "converged"
            assert any(text.startswith(told) for text in found.warnings) is near

    def test_far_from_the_limit_of_grip_two_runs_check_it(self) -> None:
        """All inputs changed towards the limit and away from it; the ends are equal."""
        tasks: list[Any] = []

        def simulate(batch: Any) -> list[Row]:
            tasks.extend(batch)
            return [{"x_m": [0.0, 10.0], "y_m": [0.0, 0.0]} for _ in batch]

        values = values_of(load_scenario("carved-46m", changes=SCENARIO))
        assert grip_limit_sentences(RunTask({}, 0, final=False), values, simulate) == ()
        towards, away = (task.values for task in tasks)
        for key, sign in (("start.speed_m_per_s", 1), ("snow.H_V_N_per_mm3", 1), ("snow.S_f_N_per_mm2", -1)):
            assert towards[key] / values[key] == pytest.approx(1.0 + 1e-3 * sign)
            assert away[key] / values[key] == pytest.approx(1.0 - 1e-3 * sign)

    def test_ctrl_c_while_the_limit_is_looked_at_keeps_the_answer(self) -> None:
        def stopped(tasks: object) -> list[Row]:  # noqa: ARG001 - as it is called
            raise KeyboardInterrupt

        positions = track_positions.TrackPositions((track_positions.track_points(track()),), stopped)
        values = values_of(load_scenario("carved-46m", changes=SCENARIO))
        (told,) = replace(positions, scenario_values=values)._near_limit({})
        assert "interrupted" in told

    def test_standard_errors_are_those_of_linear_least_squares(self) -> None:
        """x = v₀ t + g (sin α - μ cos α) t²/2."""
        time = 0.1 * np.arange(41)
        design = np.column_stack([-9.81 * math.cos(SLOPE) * time**2 / 2.0, time]) / SD
        wanted = np.sqrt(np.diag(np.linalg.inv(design.T @ design)))
        found = found_from(track(seed=1))
        assert [each.standard_error for each in found.parameters] == pytest.approx(wanted, rel=1e-6)

    def test_noise_is_estimated_where_it_is_not_stated(self) -> None:
        """Third differences of 2 x 41 numbers, by their median: right to some 20 %; half is allowed."""
        one = track(seed=2, stated=False)
        assert estimated_noise(one.time, one.place[:, :2]) == pytest.approx(SD, rel=0.5)
        found, known = found_from(one), found_from(track(seed=2))
        assert found["mu_0"].standard_error == pytest.approx(known["mu_0"].standard_error, rel=0.3)
        assert any("Student's t" in method and "estimated" in method for method in found.methods)
        assert any("normal distribution" in method and "stated" in method for method in known.methods)

    def test_noise_beyond_the_stated_accuracy_widens_the_intervals_and_is_reported(self) -> None:
        one = track(seed=3)
        proud = replace(one, place_sd=present(one.place_sd) / 10.0)
        found = found_from(proud)
        assert any("stated accuracy" in text for text in found.warnings)
        assert found["mu_0"].standard_error == pytest.approx(found_from(one)["mu_0"].standard_error, rel=0.3)

    def test_two_tracks_have_starts_of_their_own(self) -> None:
        two = [track(name="slow"), track(name="fast", changes={"start.speed_m_per_s": 9.0})]
        found = found_from(two)
        assert found["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=1e-5)
        assert found["speed@slow"].value == pytest.approx(TRUE_SPEED, abs=1e-4)
        assert found["speed@fast"].value == pytest.approx(9.0, abs=1e-4)

    def test_recorded_speeds_with_an_accuracy_count(self) -> None:
        """v = v₀ + a t with 0.05 m/s beside places with 2 cm."""
        one = track()
        angle = 9.81 * (math.sin(SLOPE) - TRUE_FRICTION * math.cos(SLOPE))
        known = replace(one, speed=TRUE_SPEED + angle * one.time, speed_sd=np.full(len(one), 0.05))
        time = one.time
        places = np.column_stack([-9.81 * math.cos(SLOPE) * time**2 / 2.0, time]) / SD
        speeds = np.column_stack([-9.81 * math.cos(SLOPE) * time, np.ones_like(time)]) / 0.05
        design = np.vstack([places, speeds])
        wanted = np.sqrt(np.diag(np.linalg.inv(design.T @ design)))
        assert [each.standard_error for each in found_from(known).parameters] == pytest.approx(wanted, rel=1e-6)

    def test_a_speed_over_the_ground_is_not_taken_for_that_along_the_slope(self) -> None:
        """It is cos 10° of it, 0.08 m/s too small here; the velocity beside it has the vertical part, and counts."""
        one = track()
        along = TRUE_SPEED + 9.81 * (math.sin(SLOPE) - TRUE_FRICTION * math.cos(SLOPE)) * one.time
        ground = replace(
            one, speed=along * math.cos(SLOPE), speed_sd=np.full(len(one), 0.01), speed_kind="over the ground"
        )
        known = replace(ground, velocity=np.column_stack([along, 0.0 * along, 0.0 * along]))
        for each in (ground, known):
            assert found_from(each)["speed"].value == pytest.approx(TRUE_SPEED, abs=1e-4)
        errors = [found_from(each)["speed"].standard_error for each in (ground, known)]
        assert present(errors[1]) < 0.7 * present(errors[0])

    def test_a_parameter_without_effect_is_named(self) -> None:
        """A straight run does not feel the snow's strength."""
        found = found_from(track(seed=4), "mu_0,speed,S_f")
        assert found.outcome == "not_identifiable"
        assert not found["S_f"].identifiable
        assert found["S_f"].interval is None
        assert found["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=0.005)
        assert any(text.startswith("S_f cannot be identified") for text in found.warnings)

    def test_marked_points_are_left_out_and_counted(self) -> None:
        one = track()
        place = one.place.copy()
        place[7] += 500.0
        jump = np.arange(len(one)) == 7
        found = found_from(replace(one, place=place, flags={"jump": jump}))
        assert found["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=1e-5)
        assert any("1 points are marked" in text for text in found.warnings)

    def test_a_track_of_another_place_is_rejected(self) -> None:
        one = track()
        far = replace(one, place=one.place + np.array([350_000.0, 20_000.0, 0.0]))
        with raises(ParameterError, "other_place") as caught:
            found_from(far)
        assert "350.6 km" in str(caught.value)

    def test_a_track_that_begins_somewhat_off_is_warned_of(self) -> None:
        one = track()
        off = replace(one, place=one.place + np.array([0.0, 3.0, 0.0]))
        assert any("begins 3 m" in text for text in found_from(off).warnings)
        free = found_from(off, "mu_0,speed,start.x,start.y")
        assert free["y"].value == pytest.approx(3.0, abs=1e-4)
        assert not any("begins" in text for text in free.warnings)

    def test_three_points_are_too_few_for_three_parameters_without_accuracy(self) -> None:
        found = found_from(track(points=3, stated=False), "mu_0,speed,start.x")
        assert found.outcome == "too_few_points"
        assert found["mu_0"].value is None

    def test_points_that_are_float_among_fixed_ones_are_reported(self) -> None:
        one = track()
        solution = np.where(np.arange(len(one)) < 3, "float", "fixed")
        told = "one: of 41 points 3 float (decimetres off); the others are fixed"
        assert told in found_from(replace(one, solution=solution)).warnings

    def test_five_points_are_never_taken_silently(self) -> None:
        found = found_from(track(points=5, seed=1))
        assert any("5 points" in text for text in found.warnings)

    def test_simulations_are_kept_and_found_again(self, tmp_path: Path) -> None:
        kept = tmp_path / "simulations.partial"
        first = found_from(track(seed=5), checkpoint=kept)
        again = found_from(track(seed=5), checkpoint=kept)
        assert first.effort.simulations > 5
        assert again.effort.simulations == 0
        assert again.values == first.values

    def test_a_scenario_may_be_given_as_an_object(self, tmp_path: Path) -> None:
        """The same answer as by its name; other tables of a ski of the same name are another scenario."""
        kept = tmp_path / "simulations.partial"
        turn = load_scenario("carved-46m", changes=SCENARIO)
        found = identify(turn, track(seed=5), "mu_0,speed", workers=1, checkpoint=kept)
        assert found.values == pytest.approx(found_from(track(seed=5)).values, rel=1e-9)
        assert found.scenario.endswith("in Python")
        again = identify(turn.with_(mass_kg=80.0), track(seed=5), "mu_0,speed", workers=1, checkpoint=kept)
        assert (again.effort.simulations, again.values) == (0, found.values)
        stiffer = turn.with_(ski=replace(turn.ski, torsional_stiffness=2.0 * turn.ski.torsional_stiffness))
        with pytest.raises(ParameterError, match="another study"):
            identify(stiffer, track(seed=5), "mu_0,speed", workers=1, checkpoint=kept)

    def test_changes_of_an_object_are_those_of_with(self) -> None:
        turn = load_scenario("carved-46m", changes=SCENARIO)
        found = identify(turn, track(seed=5), "mu_0", changes={"speed_m_per_s": TRUE_SPEED}, workers=1)
        other = identify(turn.with_(speed_m_per_s=TRUE_SPEED), track(seed=5), "mu_0", workers=1)
        assert found.values == other.values != identify(turn, track(seed=5), "mu_0", workers=1).values
        with pytest.raises(ParameterError, match=r"ski\.name"):
            identify(turn, track(seed=5), "mu_0", changes={"ski.name": "slalom"}, workers=1)

    def test_an_interrupt_keeps_the_best_so_far(self, monkeypatch: pytest.MonkeyPatch) -> None:
        import sys

        calls = 0
        simulate = sys.modules["skisnow.simulation.simulated_run"].simulate

        def stopping(scenario: Any) -> Any:
            nonlocal calls
            calls += 1
            if calls == 6:
                raise KeyboardInterrupt
            return simulate(scenario)

        monkeypatch.setattr(sys.modules["skisnow.simulation.simulated_run"], "simulate", stopping)
        found = found_from(track(seed=6))
        assert found.outcome == "interrupted"
        assert found["mu_0"].value is not None
        assert identification_dict(found)["outcome"] == "interrupted"

    def test_several_starts_end_at_one_place(self) -> None:
        found = found_from(track(seed=7), starts=3, rng=np.random.default_rng(3))
        assert len(found.starts) == 3
        assert not any("several minima" in text for text in found.warnings)

    def test_posterior_of_a_linear_model_is_the_normal_distribution(self) -> None:
        """4000 samples of a chain of 16 walkers: the ends of an interval are right to a tenth of its width."""
        pytest.importorskip("emcee")
        found = found_from(track(seed=8), posterior=4000)
        for each in found.parameters:
            assert each.interval is not None
            width = each.interval[1] - each.interval[0]  # type: ignore[operator]
            assert each.posterior_interval == pytest.approx(each.interval, abs=0.1 * width)

    def test_east_north_up_needs_to_know_where_the_slope_falls(self) -> None:
        one = replace(track(), axes="east_north_up", origin=GeodeticPoint(47.0, 11.0, 2000.0))
        with raises(ParameterError, "site_missing"):
            found_from(one)


def test_east_north_up_is_turned_into_the_slope(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Down a slope that falls to the east, x east counts cos α of the way."""
    from skisnow.scenario import scenario_text

    straight_tracks.put(monkeypatch)
    one = track()
    place = np.zeros_like(one.place)
    place[:, 0], place[:, 1] = one.place[:, 0] * math.cos(SLOPE), one.place[:, 1] - one.place[0, 1]
    place[:, 2] = -one.place[:, 0] * math.sin(SLOPE)
    there = replace(one, place=place, axes="east_north_up", origin=GeodeticPoint(47.0, 11.0, 2000.0))
    path = tmp_path / "mine.toml"
    section = "\n[identify.site]\nfall_line_azimuth_deg = 90\n"
    path.write_text(scenario_text("carved-46m") + section, encoding="utf-8")
    found = identify(path, there, "mu_0,speed", changes=SCENARIO, workers=1)
    assert found["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=1e-5)
    assert any("Add start.x,start.y to --free" in str(warning) for warning in found.warnings)
    options = argparse.Namespace(scenario="carved-46m", fall_line_azimuth_deg=90.0)
    free = identify(_with_fall_line(options), there, "mu_0,speed,start.x,start.y", changes=SCENARIO, workers=1)
    assert free["mu_0"].value == pytest.approx(TRUE_FRICTION, abs=1e-5)
    assert not any("--free" in str(warning) for warning in free.warnings)
    far = path.with_name("far.toml")
    far.write_text(scenario_text("carved-46m") + section + "latitude_deg = 11\nlongitude_deg = 47\n", encoding="utf-8")
    with raises(ParameterError, "far_from_site"):
        identify(far, there, "mu_0,speed", changes=SCENARIO, workers=1)
    other = path.with_name("other.toml")  # Norway: 13.1° of latitude are 1459 km, straight through the earth 1456
    text = scenario_text("carved-46m") + section + "latitude_deg = 60.1\nlongitude_deg = 11\n"
    other.write_text(text, encoding="utf-8")
    with raises(ParameterError, "far_from_site") as caught:
        identify(other, there, "mu_0,speed", changes=SCENARIO, workers=1)
    assert re.search(r" 14\d\d km ", str(caught.value))


def test_times_that_run_backwards_are_rejected(tmp_path: Path) -> None:
    path = tmp_path / "track.csv"
    path.write_text("time_s,x_m,y_m\n0,0,0\n0.2,1,0\n0.1,2,0\n", encoding="utf-8")
    with pytest.raises((ParameterError, FieldDataError), match=r"0\.1"):
        identify("carved-46m", path, "mu_0", workers=1)


def test_friction_of_a_simulated_run_is_found_again() -> None:
    """0.6 s of the carved turn, 2 mm of noise at 20 Hz: within four standard errors, themselves small."""
    truth = {"friction.mu_0": 0.05, "start.speed_m_per_s": 7.3, "run.duration_s": 0.6}
    run = simulate(load_scenario("carved-46m", changes=truth))
    at = np.arange(0, len(run.time), 5)
    place = run.place[at] + 2e-3 * np.random.default_rng(1).standard_normal((len(at), 3))
    measured = Track(
        name="simulated", time=run.time[at], place=place, speed=np.full(len(at), np.nan), time_scale="local",
        frame="slope", place_sd=np.full((len(at), 3), 2e-3), axes="slope",
    )  # fmt: skip
    found = identify("carved-46m", measured, "mu_0,speed", workers=1)
    assert found.outcome == "converged"
    for name, true in (("mu_0", 0.05), ("speed", 7.3)):
        each = found[name]
        assert abs(present(each.value) - true) < 4.0 * present(each.standard_error)
    assert present(found["mu_0"].standard_error) < 0.005
