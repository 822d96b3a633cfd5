"""The period of a skier's control, and outputs that do not change its run."""

from typing import Any

import numpy as np
import pytest

from skisnow import Run, load_scenario, simulate
from skisnow.simulation.run_summary import run_gates

STATED_ERROR = {"fast": 15e-3, "default": 7e-3}
"""Of an end by each method (m)."""


def run_with(output_ms: float, name: Any = "skier-12deg", **changes: object) -> Run:
    return simulate(load_scenario(name, changes={"run.output_ms": output_ms} | changes))


def moments(run: Run, times: np.ndarray) -> np.ndarray:
    """Places of a run at times that it stored, (n, 3)."""
    rows = [int(np.argmin(np.abs(run.time - time))) for time in times]
    assert run.time[rows] == pytest.approx(times, abs=1e-9)
    return run.place[rows]


@pytest.mark.parametrize("method", ["fast", pytest.param("default", marks=pytest.mark.slow)])
def test_outputs_do_not_change_a_skier_s_run(method: str) -> None:
    """A relative change of the start speed by 1e-9 moves the end of this run by 0.2 m: the runs must be the same."""
    changes = {"solver.method": method, "run.duration_s": 0.8}
    reference = run_with(10.0, **changes)
    for output_ms in (8.0,):
        run = run_with(output_ms, **changes)
        assert np.linalg.norm(run.place[-1] - reference.place[-1]) < STATED_ERROR[method]
        common = np.arange(0.0, 0.801, 0.04)
        assert moments(run, common) == pytest.approx(moments(reference, common), abs=1e-9)
        assert run.steps == reference.steps


def test_outputs_between_decisions_are_on_the_way_of_the_run() -> None:
    """Places by 5 ms lie on the cubic through those of 10 ms, to the micrometres by which the body shakes."""
    fine, coarse = (
        run_with(output_ms, **{"run.duration_s": 0.5, "solver.method": "fast"}) for output_ms in (5.0, 10.0)
    )
    between = fine.place[1::2]
    step = np.diff(coarse.time)[:, None]
    middle = (coarse.place[1:] + coarse.place[:-1]) / 2.0 - step / 8.0 * np.diff(coarse.velocity, axis=0)
    assert between == pytest.approx(middle, abs=5e-5)


def test_a_fall_ends_at_the_same_time_with_all_outputs() -> None:
    changes: dict[str, object] = {
        "skier.first_turn_s": 0.0,
        "skier.edge_gain": 0.0,
        "start.speed_m_per_s": 16.0,
        "run.duration_s": 4.0,
    }
    changes |= {"solver.method": "fast"}
    runs = [run_with(output_ms, "skier-10deg", **changes) for output_ms in (5.0, 50.0)]
    assert {run.outcome for run in runs} == {"fell"}
    assert runs[1].simulated_s == pytest.approx(runs[0].simulated_s, abs=1e-9)
    assert np.ptp([run.place[-1] for run in runs], axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


def test_the_period_changes_the_run() -> None:
    """Decisions every 5 and 20 ms: another run, and the same course of its turns."""
    changes = {"solver.method": "fast", "run.duration_s": 0.4}
    short, usual, long = (run_with(10.0, **changes, **{"skier.control_period_ms": ms}) for ms in (5.0, 10.0, 20.0))
    for other in (short, long):
        assert 1e-6 < np.linalg.norm(other.place[-1] - usual.place[-1]) < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("method", ["fast", pytest.param("default", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["slalom-20-gates", "giant-slalom-20-gates"])
def test_all_gates_are_passed_and_ends_agree_with_all_outputs(name: str, method: str) -> None:
    runs = [run_with(output_ms, name, **{"solver.method": method}) for output_ms in (5.0, 10.0, 20.0)]
    for run in runs:
        result = run_gates(run)
        assert result is not None
        assert (run.outcome, result.passed) == ("finished", 20)
        assert np.linalg.norm(run.place[-1] - runs[0].place[-1]) < STATED_ERROR[method]
