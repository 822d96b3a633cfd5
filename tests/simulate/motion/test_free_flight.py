"""In the air: energy, momentum and angular momentum kept, a parabola under gravity."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.advance import mechanical_energy
from skisnow.simulate.motion.equations import move
from skisnow.simulate.motion.model import new_state

from .dense_model import INNER, dense_mass, dense_stiffness
from .flight import Flight, first_mode, free_model, light_ski

FloatArray = npt.NDArray[np.float64]


def tumbling() -> Flight:
    """Turning about all axes, with both skis bent, one of them twisted, and swinging."""
    flight = Flight(free_model())
    flight.state.velocity[:] = 3.0, -1.0, 0.5, 0.8, -1.1, 1.7
    _, shape = first_mode(light_ski())
    flight.state.bend[0, INNER], flight.state.bend[1, INNER] = shape, -0.5 * shape
    flight.state.bend_rate[0, INNER] = 20.0 * shape
    return flight


def energy(flight: Flight) -> float:
    """Of motion and of the bent skis, from dense matrices."""
    speeds, bend = flight.speeds, np.concatenate([np.zeros(6), flight.state.bend[:, INNER].ravel()])
    model = flight.model
    return float(0.5 * speeds @ dense_mass(model) @ speeds + 0.5 * bend @ dense_stiffness(model) @ bend)


@pytest.mark.parametrize("method", ["ros2", "fast"])
def test_momenta_and_energy_are_kept(method: str) -> None:
    start = tumbling()
    momentum, turning = start.momenta()
    before = energy(start)
    drifts = []
    for steps in (100, 200, 400):
        flight = tumbling().fly(0.05, steps, method=method)
        now, turning_now = flight.momenta()
        drifts.append(
            [
                np.linalg.norm(now - momentum) / np.linalg.norm(momentum),
                np.linalg.norm(turning_now - turning) / np.linalg.norm(turning),
                abs(energy(flight) - before) / before,
            ]
        )
    drift = np.array(drifts)
    # what is left at any step is the bent skis' share in the momenta, of the size of mass × w × ω
    assert np.all(drift[-1] < 5e-6), drift
    if method == "ros2":
        assert np.all(np.abs(drift[-1] / drift[-2] - 1.0) < 0.1), drift


def test_a_free_turn_keeps_its_angle() -> None:
    """About a principal axis, skis rigid as they hang: the heading after 1 rad."""
    flight = Flight(free_model())
    flight.state.velocity[5] = 2.0
    flight.fly(0.5, 2000)
    heading = math.atan2(flight.state.turn[1, 0], flight.state.turn[0, 0])
    assert heading == pytest.approx(1.0, abs=0.02)  # the centrifugal force bends the skis and tilts the axis a little
    assert flight.state.turn.T @ flight.state.turn == pytest.approx(np.eye(3), abs=1e-12)


def test_parabola() -> None:
    """Without turning nothing bends, and a method of order 2 is exact."""
    flight = Flight(free_model(), gravity=9.81)
    flight.state.velocity[:3] = 3.0, -1.0, 0.5
    flight.fly(0.4, 100)
    known = np.array([3.0 * 0.4, -1.0 * 0.4, 0.5 * 0.4 - 0.5 * 9.81 * 0.16])
    assert flight.state.place == pytest.approx(known, abs=1e-12)
    assert flight.state.velocity == pytest.approx([3.0, -1.0, 0.5 - 9.81 * 0.4, 0.0, 0.0, 0.0], abs=1e-11)
    assert np.max(np.abs(flight.state.bend)) < 1e-13


def test_momentum_grows_by_the_weight() -> None:
    flight = tumbling()
    flight.world.gravity[2] = -9.81
    before, _ = flight.momenta()
    flight.fly(0.05, 400)
    grown = flight.momenta()[0] - before
    assert grown == pytest.approx([0.0, 0.0, -9.81 * flight.model.total_mass * 0.05], abs=1e-3)


def test_skis_do_not_feel_a_steady_speed() -> None:
    """The same tumbling seen from a carriage at 10 m/s: the skis bend as before."""
    resting, passing = tumbling(), tumbling()
    passing.state.velocity[:3] += np.array([0.0, 10.0, 0.0])
    for flight in (resting, passing):
        flight.fly(0.05, 400)
    assert resting.state.bend == pytest.approx(passing.state.bend, abs=1e-5)


def test_mechanical_energy() -> None:
    """The recorded energies against the dense ones; the weight's by raising and by turning."""
    flight = tumbling()
    flight.world.gravity[:] = 1.0, -2.0, -9.0
    kinetic, potential, elastic = mechanical_energy(flight.model, flight.world, flight.state)
    assert kinetic + elastic == pytest.approx(energy(flight), rel=1e-12)
    raised, zero = new_state(len(flight.model.mass)), np.zeros_like(flight.state.bend)
    for change in (np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 0.0, 0.3, 0.0, 0.0])):
        move(flight.state, change, zero, 1.0, raised)
        _, after, _ = mechanical_energy(flight.model, flight.world, raised)
        moved = raised.turn @ lever(flight) - flight.state.turn @ lever(flight)
        moved += flight.model.total_mass * (raised.place - flight.state.place)
        assert after - potential == pytest.approx(-flight.world.gravity @ moved, rel=1e-12)


def lever(flight: Flight) -> FloatArray:
    """Mass times the place of the centre of mass, bent skis included, in the sledge's frame."""
    model, n = flight.model, len(flight.model.mass)
    bent = dense_mass(model)[:3, 6:] @ flight.state.bend[:, INNER].ravel()
    assert bent.shape == (3,)
    assert n == flight.state.bend.shape[1] - 10
    return np.asarray(model.first_moment + bent)
