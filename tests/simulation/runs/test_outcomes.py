"""How runs end: each outcome with the results so far, and never with numbers that are finite nonsense."""

import functools
import os
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

from skisnow import Run
from skisnow.dynamics import Dynamics, Ended, StepControl
from skisnow.scenario import Plane, Profile, Scenario, load_scenario
from skisnow.simulation.run_record import Record
from skisnow.simulation.run_setup import set_up
from skisnow.simulation.simulated_run import computed_run, simulate

from ...carving.synthetic import shovel
from .sledges import rigid_ski, scenario


def is_sound(run: Run) -> bool:
    """Finite everywhere, of one length, in order, told in words, and no energy out of nothing."""
    histories = (run.place, run.attitude, run.velocity, run.heading, run.skis.track, *run.energies.values())
    assert all(np.isfinite(each).all() for each in histories)
    assert all(len(each) == len(run.time) for each in histories)
    assert np.all(np.diff(run.time) > 0.0)
    assert run.remedy
    assert run.energy_balance_error is None or run.energy_balance_error < 0.02
    return True


def flat_scenario(slope: Plane | Profile, *, speed: float, x: float) -> Scenario:
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    return scenario(ski=ski, slope=slope, start=(x, 0.0), speed=speed, duration=20.0, centre_height=0.1)


def test_finished() -> None:
    begin = time.perf_counter()
    run = simulate(load_scenario("carved-46m", changes={"run.duration_s": 0.3137}))
    assert run.outcome == "finished"
    assert 0.0 < run.wall_s <= time.perf_counter() - begin
    assert run.time[-1] == 0.3137
    assert run.time[:-1] == pytest.approx(np.arange(32) * 0.01, abs=1e-12)
    assert is_sound(run)


@pytest.mark.parametrize("length", [0.005, 3.0])
def test_distance_reached(length: float) -> None:
    """The last interval is aimed by the speed at its begin: 1 m/s² over 10 ms miss by less than 0.1 mm."""
    run = simulate(load_scenario("carved-46m", changes={"run.length_m": length, "run.duration_s": 5.0}))
    assert run.outcome == "distance_reached"
    assert run.run_length == pytest.approx(length, abs=2e-5)
    arc = np.linalg.norm(np.diff(run.place, axis=0), axis=1).sum()
    assert run.run_length == pytest.approx(arc, rel=1e-5)
    assert is_sound(run)


def test_end_of_slope_and_tipped_over_and_airborne_off_a_kicker() -> None:
    """A straight ramp of 12 m: the tips, 0.8 m before the boots, reach its end within one output's way."""
    x = np.arange(0.0, 12.01, 0.5)
    run = simulate(flat_scenario(Profile(x, -0.17 * x), speed=5.0, x=1.0))
    assert run.outcome == "end_of_slope"
    tip = run.place[-1, 0] + 0.8 * run.attitude[-1, 0, 0]
    assert 12.0 < tip < 12.0 + 0.011 * run.speed[-1]
    assert is_sound(run)
    run = simulate(load_scenario("carved-46m", changes={"sledge.centre_of_mass_height_m": 0.6}))
    assert run.outcome == "tipped_over"
    assert run.attitude[-1, 2, 2] == pytest.approx(0.5, abs=0.1)  # the cosine of 60°
    assert run.attitude[-1, 2, 1] > 0.5  # out of a left turn: to the right, the left side comes up
    assert is_sound(run)
    # A ramp that rises 5 % and breaks off at x = 8 m: the middle of mass goes on in a parabola for 0.3 s.
    x = np.arange(0.0, 60.01, 0.25)
    run = simulate(flat_scenario(Profile(x, np.where(x < 8.0, 0.05 * (x - 8.0), -0.45 * (x - 8.0))), speed=14.0, x=2.0))
    assert run.outcome == "airborne"
    assert is_sound(run)
    air = run.time > run.time[-1] - 0.25
    assert np.all(run.skis.force_per_length[air] == 0.0)
    energy = run.energies["kinetic"][air] + run.energies["potential"][air] + run.energies["elastic_ski"][air]
    assert np.ptp(energy) < 1e-4 * run.energies["kinetic"][-1]
    # the boots' middle is 0.1 m below the centre of mass and turns about it by a few hundredths
    fall = np.polyfit(run.time[air], run.place[air, 2], 2)
    assert fall[0] == pytest.approx(-9.81 / 2.0, rel=0.05)


def test_sunk() -> None:
    run = simulate(load_scenario("carved-46m", changes={"snow.H_V_N_per_mm3": 1e-6}))
    assert run.outcome == "sunk"
    assert is_sound(run)


def test_step_too_small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where steps below 2 ms are none, a tolerance of 1e-12 m is out of reach."""
    monkeypatch.setattr("skisnow.simulation.run_setup.StepControl", functools.partial(StepControl, shortest=2e-3))
    run = simulate(load_scenario("carved-46m", changes={"solver.tolerance_mm": 1e-9, "solver.step_ms": 5.0}))
    assert run.outcome == "step_too_small"
    assert len(run.time) >= 1


@pytest.mark.slow
def test_run_of_countless_short_steps_ends() -> None:
    """In soft, strong snow that creeps, each step of some microseconds takes ten iterations."""
    changes: dict[str, Any] = {"snow.H_V_N_per_mm3": 0.0046, "snow.S_f_N_per_mm2": 11.7, "snow.delayed_share": 8.9}
    changes |= {"slope.gravity_m_per_s2": 14.6, "snow.penetration": "elastic", "start.speed_m_per_s": 0.18}
    changes |= {"shear.law": "machining", "shear.transverse_friction": 0.31}
    run = simulate(load_scenario("carved-46m", changes=changes | {"solver.method": "fast", "solver.elements": 8}))
    assert run.outcome == "step_too_small"
    assert 0.0 < run.time[-1] < 0.05


@pytest.mark.parametrize(
    ("changes", "solver", "apart"),
    [
        ({}, {"solver.fixed": True, "solver.step_ms": 5.0}, 0.01),
        ({"snow.H_V_N_per_mm3": 90.0, "snow.S_f_N_per_mm2": 10.0}, {"solver.fixed": True, "solver.step_ms": 2.0}, 0.01),
        ({"start.speed_m_per_s": 50.0}, {"solver.fixed": True, "solver.step_ms": 5.0}, 1.0),
    ],
    ids=["soft", "hard-ice", "at-50-m-per-s"],
)
def test_long_fixed_steps_do_not_diverge(changes: dict[str, object], solver: dict[str, object], apart: float) -> None:
    """Newton's method at the step's end has no edge of stability; a step that it does not solve is halved.

    How far they end from the controlled ones after 2 and 12 m.
    """
    shorter = {"run.duration_s": 0.25}
    run = simulate(load_scenario("carved-46m", changes={**changes, **solver, **shorter}))
    controlled = simulate(load_scenario("carved-46m", changes={**changes, **shorter}))
    assert run.outcome == controlled.outcome == "finished"
    assert run.steps < 255
    assert np.linalg.norm(run.place[-1] - controlled.place[-1]) < apart


def test_diverged_numbers_end_as_not_finite(monkeypatch: pytest.MonkeyPatch) -> None:
    """Results computed before are kept."""
    advance = Dynamics.advance

    def diverging(self: Dynamics, until: float) -> Ended:
        return advance(self, until) if until < 0.035 else Ended.NOT_FINITE

    monkeypatch.setattr(Dynamics, "advance", diverging)
    run = simulate(load_scenario("carved-46m"))
    assert run.outcome == "not_finite"
    assert run.time == pytest.approx([0.0, 0.01, 0.02, 0.03])
    assert is_sound(run)


def test_the_moment_that_gains_energy_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Energy out of nothing ends the run at the moment before, and its path is as long as it was there."""

    def gains(self: Record) -> bool:
        return self.setup.dynamics.time > 0.035

    plain = simulate(load_scenario("carved-46m", changes={"run.duration_s": 0.03}))
    monkeypatch.setattr(Record, "gains_energy", property(gains))
    run = simulate(load_scenario("carved-46m"))
    assert run.outcome == "not_finite"
    assert run.time == pytest.approx([0.0, 0.01, 0.02, 0.03])
    np.testing.assert_array_equal(run.place, plain.place)
    assert run.run_length == pytest.approx(plain.run_length, rel=1e-12)
    assert is_sound(run)


def test_open_energy_is_no_finish(monkeypatch: pytest.MonkeyPatch) -> None:
    """The end of a run that gives a tenth too little or too much does not stand, whatever it was."""
    given = load_scenario("carved-46m", changes={"run.duration_s": 0.05})
    setup = set_up(given)
    record = Record(setup)
    record.advance(0.05)
    closed = computed_run(setup, record, "finished", 0.1)
    assert (closed.outcome, closed.has_residual_above(0.02)) == ("finished", False)
    kept = Record.histories

    def opened(self: Record) -> dict[str, Any]:
        found = kept(self)
        found["energies"]["damping"] += 0.12 * closed.energy_exchanged * found["time"] / found["time"][-1]
        return found

    monkeypatch.setattr(Record, "histories", opened)
    for outcome in ("finished", "distance_reached", "tipped_over", "airborne"):
        run = computed_run(setup, record, outcome, 0.1)
        assert run.outcome == "energy_open"
        assert "smaller steps" in run.remedy
    assert computed_run(setup, record, "interrupted", 0.1).outcome == "interrupted"


def test_fast_is_a_looser_tolerance() -> None:
    """A tenth of the tolerance makes up for it, but for the parts in which the history is marched."""
    given = load_scenario("carved-46m", changes={"run.duration_s": 0.3})
    ends = [
        simulate(given.with_(method=method, tolerance_mm=mm))
        for method, mm in (("fast", 3e-5), ("default", 3e-4), ("fast", 3e-4))
    ]
    alike, default, fast = (run.place[-1] for run in ends)
    assert np.abs(alike - default).max() < 1e-4
    assert 1e-6 < np.abs(fast - default).max() < 2e-3
    assert ends[2].steps < 0.7 * ends[1].steps


@pytest.mark.parametrize("changes", [{"solver.fixed": True}, {}], ids=["fixed", "controlled"])
def test_pauses_change_no_bit(changes: dict[str, object], monkeypatch: pytest.MonkeyPatch) -> None:
    """The core comes back to Python after every seventh step, or never: the same steps."""
    given = load_scenario("carved-46m", changes={"run.duration_s": 0.2, **changes})
    whole = simulate(given)
    monkeypatch.setattr("skisnow.dynamics.motion.STEPS_AT_ONCE", 7)
    pieces = simulate(given)
    assert whole.steps == pieces.steps > 70
    assert np.array_equal(whole.place, pieces.place)


def test_an_interrupt_is_heard_inside_of_an_output() -> None:
    """A second of simulated time in steps of a microsecond takes half a minute; the signal comes after a moment."""
    given = load_scenario(
        "carved-46m", changes={"run.output_ms": 1000.0, "solver.fixed": True, "solver.step_ms": 0.001}
    )
    ctrl_c = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    ctrl_c.start()
    run = simulate(given)
    ctrl_c.join()
    assert run.outcome == "interrupted"
    assert len(run.time) == 1
