"""The order that a method declares is the order that is seen."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.judge.run_record import Record
from skisnow.simulate.judge.run_setup import Setup, set_up
from skisnow.simulate.judge.simulated_run import simulated_run
from skisnow.simulate.motion.model import sledge_model
from skisnow.simulate.scenario import read_scenario
from skisnow.simulate.sledge import RigidSledge

from ..beyond_ranges import beyond
from .dense_model import INNER
from .flight import Flight, first_mode, light_ski

FloatArray = npt.NDArray[np.float64]
METHODS = pytest.mark.parametrize(("method", "order"), [("ros2", 2.0), ("fast", 2.0)])


def held_fast() -> RigidSledge:
    """A sledge of ten thousand tons: heavier than any that a scenario may have, it holds its skis like a clamp."""
    return beyond(RigidSledge(1e3, (1e7, 1e7, 1e7), (0.0, 0.2), 0.5, 0.5), mass=1e7)


def orders(error: Callable[[int], float], steps: tuple[int, ...]) -> list[float]:
    """Observed orders between neighbouring numbers of steps, each twice the one before."""
    errors = [error(n) for n in steps]
    return [math.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]


@METHODS
def test_free_vibration_of_a_clamped_ski(method: str, order: float) -> None:
    """Clamped to a sledge of ten thousand tons the lowest mode swings as cos ωt; after three eighths of a period."""
    heavy = held_fast()
    model = sledge_model(heavy, light_ski(), damping_ratio=0.0)
    omega, shape = first_mode(light_ski())
    duration = 0.75 * math.pi / omega

    def error(steps: int) -> float:
        flight = Flight(model)
        flight.state.bend[:, INNER] = shape
        flight.fly(duration, steps, method=method)
        place = np.abs(flight.state.bend[0, INNER] - math.cos(omega * duration) * shape)
        speed = np.abs(flight.state.bend_rate[0, INNER] + omega * math.sin(omega * duration) * shape)
        return float(max(place[::3].max(), speed[::3].max() / omega))

    # the skis' mass is 5e-7 of the sledge's: that, and no more, is left of the mode's error
    assert orders(error, (40, 80, 160)) == pytest.approx([order, order], abs=0.12)
    assert error(640) < (5e-6 if method == "ros2" else 3e-4)


@METHODS
def test_damping_of_the_first_mode(method: str, order: float) -> None:
    """exp(-ζωt) after a tenth of a second, for ζ = 0.1."""
    heavy = held_fast()
    model = sledge_model(heavy, light_ski(), damping_ratio=0.1)
    omega, shape = first_mode(light_ski())
    assert model.damping == pytest.approx(0.2 / omega, rel=1e-9)

    def error(steps: int) -> float:
        flight = Flight(model)
        flight.state.bend[:, INNER] = shape
        flight.fly(0.1, steps, method=method)
        swing = omega * math.sqrt(1.0 - 0.01)
        decayed = math.exp(-0.1 * omega * 0.1) * (math.cos(swing * 0.1) + 0.1 * omega / swing * math.sin(swing * 0.1))
        return float(np.abs(flight.state.bend[0, INNER] - decayed * shape)[::3].max())

    assert orders(error, (200, 400, 800)) == pytest.approx([order, order], abs=0.2)


def bouncing(step: float, method: str, seconds: float) -> Setup:
    """A sledge that bounces and rocks on elastic snow without grip and friction: smooth as long as it touches."""
    changes: dict[str, object] = {
        "slope.angle_deg": 0.0,
        "snow.penetration": "elastic",
        "snow.H_V_N_per_mm3": 0.02,
        "friction.mu_0": 0.0,
        "start.speed_m_per_s": 0.0,
        "start.heading_deg": 0.0,
        "solver.fixed": True,
        "solver.elements": 12,
        "solver.step_ms": step * 1e3,
        "solver.method": method,
    }
    setup = set_up(read_scenario("carved-46m", changes=changes))
    # without grip: where an edge first takes hold depends on the step
    setup.snow = setup.snow._replace(shear_stress=0.0)
    setup.memory.state.velocity[:] = 0.0, 0.0, -0.05, 0.02, 0.05, 0.0
    Record(setup).advance(np.array([seconds]))
    return setup


@pytest.mark.slow
@METHODS
def test_bouncing_on_elastic_snow(method: str, order: float) -> None:
    """Against steps a fortieth as long; the skis' fast modes are damped away in both."""
    exact = bouncing(1e-5, "ros2", 0.04).memory.state

    def error(steps: int) -> float:
        state = bouncing(0.04 / steps, method, 0.04).memory.state
        return float(
            max(
                np.abs(state.place - exact.place).max(),
                np.abs(state.turn - exact.turn).max(),
                np.abs(state.bend[:, INNER] - exact.bend[:, INNER])[:, ::3].max(),
            )
        )

    # the edge of the contact moves along the skis: a kink of the second derivative keeps the order off by a little.
    # With longer steps ROS2 makes its matrix at every step, and is nearer to the exact motion than the order says
    assert orders(error, (200, 400, 800)) == pytest.approx([order, order], abs=0.2)
    assert error(400) < (1e-6 if method == "ros2" else 5e-5)


@pytest.mark.parametrize(("edge_angle", "most"), [(45.0, 0.2e-3), pytest.param(60.0, 1.5e-3, marks=pytest.mark.slow)])
def test_carve_in_hypoplastic_snow(edge_angle: float, most: float) -> None:
    """Distance run after two seconds against steps of 1/32 ms: from 1 to 1/2 ms at least as with order 2, then 1.

    Edges rise from the ground they cover; at 60° the middle of the ski cuts by 0.1 m/s into its groove's wall.
    """

    def run_length(step_ms: float) -> float:
        changes = {"solver.fixed": True, "solver.step_ms": step_ms, "run.duration_s": 2.0}
        changes["sledge.edge_angle_deg"] = edge_angle
        return simulated_run(read_scenario("carved-46m", changes=changes)).run_length

    exact = run_length(0.03125)
    coarse, fine, finest = (abs(run_length(h) - exact) for h in (1.0, 0.5, 0.125))
    assert math.log2(coarse / fine) > 1.8
    assert math.log2(fine / finest) > 2.0
    assert fine < most


def test_stiff_modes_are_damped_away() -> None:
    """γ = 1 - 1/√2 makes ROS2 L-stable: next to nothing is left of hω = 10⁴ after a step, of 1/√2 it were 83 %."""
    heavy = held_fast()
    omega, shape = first_mode(light_ski())
    flight = Flight(sledge_model(heavy, light_ski(), damping_ratio=0.0))
    flight.state.bend[:, INNER] = shape
    flight.fly(1e4 / omega, 1)
    assert np.abs(flight.state.bend[:, INNER])[:, ::3].max() < 1e-3 * np.abs(shape[::3]).max()
