"""In the air: a parabola, momentum and energy kept, a top that turns as Euler knew it."""

import math
from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.dynamics import Body, Dynamics, Ended, StepControl

from ..simulation.runs.sledges import GRAVITY, rigid_ski
from ..simulation.runs.sledges import scenario as edged_scenario
from .sledges import body_of, clamped_ski, fixed, given, rigid, sledge

FloatArray = npt.NDArray[np.float64]
DURATION: Final = 0.3
HEIGHT: Final = 1.0
SCENARIO: Final = given(sledge__centre_of_mass_forward_m=0.05)
WEIGHTLESS: Final = np.zeros(3)
MOVES: Final = np.array([3.0, -1.0, 0.5])


def flown(body: Body, velocity: FloatArray, control: StepControl, duration: float = DURATION) -> Dynamics:
    dynamics = sledge(SCENARIO, control, body=body, height=HEIGHT)
    dynamics.begin(velocity)
    assert dynamics.advance(duration) is Ended.REACHED
    assert not dynamics.touches
    assert dynamics.part("work")[:3].tolist() == [0.0, 0.0, 0.0]
    assert dynamics.part("snow_energies").tolist() == [0.0, 0.0, 0.0, 0.0]
    assert dynamics.part("snow_losses").tolist() == [0.0, 0.0, 0.0, 0.0, 0.0]
    return dynamics


def test_parabola_and_energy_of_a_fall() -> None:
    """All falls alike, nothing bends. BDF2 is exact but for the first step: Euler's puts ½ g h² too much into the
    place, of which each later increment keeps a third: ½ (1 + 1/3 + 1/9 + …) = ¾."""
    body = replace(body_of(SCENARIO), drag=0.0)
    start = sledge(SCENARIO, height=HEIGHT)
    v = start.rotation @ MOVES
    for step in (1e-3, 1e-4):
        flight = flown(body, np.concatenate([MOVES, np.zeros(3)]), fixed(step))
        known = start.position + v * DURATION + 0.5 * body.gravity * DURATION**2
        assert flight.position == pytest.approx(known + 0.75 * body.gravity * step**2, abs=1e-12)
        assert flight.rotation @ flight.velocity[:3] == pytest.approx(v + body.gravity * DURATION, abs=1e-11)
        assert np.abs(flight.part("beam_dofs")).max() < 1e-12
    # What is lost in height is gained in speed; drag is accounted for.
    body = body_of(SCENARIO)
    start = sledge(SCENARIO, body=body, height=HEIGHT)
    velocity = np.concatenate([MOVES, np.zeros(3)])
    start.begin(velocity)
    flight = flown(body, velocity, StepControl())
    taken = flight.part("work")[3] + flight.part("work")[4]
    assert flight.part("work")[3] > 1.0
    assert sum(flight.part("energies")) + taken == pytest.approx(sum(start.part("energies")), abs=1e-3)
    mass = body.mass
    assert start.part("energies")[0] == pytest.approx(0.5 * mass * float(MOVES @ MOVES), rel=1e-12)


def test_snow_that_hardly_holds_an_edge_is_sheared_along_a_parabola() -> None:
    """Weight g pulls across and turns the sideways motion within a step h, at the end of which y is as at its start.

    At a share s of it the edge of the tip meets a line, beyond y by ½ g h² s (1 - s): so far it comes back. Along the
    arc of a steady rate it would not move across.
    """
    step, speed, depth, displacement = 5e-3, 10.0, 2e-3, 5e-5
    on_edge = edged_scenario(ski=rigid_ski(), edge_deg=45.0)
    body = replace(rigid(body_of(on_edge), np.array([6.0, 8.0, 10.0])), gravity=np.array([0.0, GRAVITY, 0.0]))
    snow = SnowField(1.0, 1.0, 10.0, shear_displacement=displacement, part_along=3e-4, part_across=1.0)
    contact = SnowContact(snow, [Runner.of(on_edge.ski, nodes=clamped_ski(on_edge, 40).node)] * 2, spacing=1e-3)
    height = 0.5 * float(on_edge.ski.at(0.0).width) * math.sin(math.radians(45.0)) - depth
    dynamics = Dynamics(body, contact, np.array([0.0, 0.0, height]), np.eye(3), fixed(step))
    dynamics.begin(np.array([speed, -7.5 * GRAVITY * step, 0.0, 0.0, 0.0, 0.0]))
    assert dynamics.advance(8 * step) is Ended.REACHED
    sections = contact.sections()
    share = 1.0 - (on_edge.ski.station[0] - sections.position_along_ski) / (speed * step)
    met = (share > 0.05) & (share < 0.95)
    sheared = sections.shear[met] / (1e-3 * depth)
    expected = 0.5 * GRAVITY * step**2 * share[met] * (1.0 - share[met]) / displacement
    assert sheared == pytest.approx(-expected, abs=0.03)  # half a line, 0.5 mm, of the tip's way of 50 mm


def spin(body: Body, dynamics: Dynamics) -> tuple[FloatArray, float]:
    """Angular momentum in space, and energy of motion, of a body whose skis weigh nothing."""
    momentum = body.inertia @ dynamics.velocity
    return dynamics.rotation @ momentum[3:], 0.5 * float(dynamics.velocity @ momentum)


def tumbling_drift(step: float) -> tuple[float, float]:
    """Of a body that tumbles about no principal axis: what it loses of angular momentum and energy, as shares."""
    body = replace(rigid(body_of(SCENARIO), np.array([6.0, 8.0, 10.0])), gravity=WEIGHTLESS)
    velocity = np.array([3.0, -1.0, 0.5, 0.8, -2.0, 1.7])
    start = sledge(SCENARIO, body=body)
    start.begin(velocity)
    (turning, energy), (turning_now, energy_now) = (
        spin(body, each) for each in (start, flown(body, velocity, fixed(step)))
    )
    return float(np.linalg.norm(turning_now - turning) / np.linalg.norm(turning)), abs(energy_now / energy - 1.0)


def test_a_tumbling_body_keeps_angular_momentum_and_energy() -> None:
    """What is lost goes down with the square of the step or faster."""
    drift = np.array([tumbling_drift(step) for step in (2e-3, 1e-3, 0.5e-3)])
    assert np.all(drift[0] < 3e-5), drift
    assert np.all(drift[:-1] / drift[1:] > 3.5), drift


def test_a_symmetric_top_nods_at_its_own_rate() -> None:
    """Without moments its angular velocity goes round its axis at (I₃ - I₁)/I₁ times the spin, in its own frame."""
    body = replace(rigid(body_of(SCENARIO), np.array([6.0, 6.0, 10.0])), gravity=WEIGHTLESS)
    spun, aside = 4.0, 1.5
    flight = flown(body, np.array([0.0, 0.0, 0.0, aside, 0.0, spun]), fixed(0.5e-3))
    angle = (10.0 - 6.0) / 6.0 * spun * DURATION
    known = [aside * math.cos(angle), aside * math.sin(angle), spun]
    assert flight.velocity[3:] == pytest.approx(known, abs=2e-6)


def test_skis_do_not_feel_a_steady_speed() -> None:
    """The same tumbling seen from a carriage: body and skis turn and bend as before, but for rounding."""
    body = replace(body_of(SCENARIO), gravity=WEIGHTLESS, drag=0.0)
    turning = np.array([3.0, -2.0, 4.0])
    resting, passing = (
        flown(body, np.concatenate([speed, turning]), fixed(0.5e-3), 0.1) for speed in (np.zeros(3), 10.0 * MOVES)
    )
    assert np.abs(resting.part("beam_dofs")).max() > 1e-3
    assert passing.part("beam_dofs") == pytest.approx(resting.part("beam_dofs"), abs=1e-12)
    assert passing.velocity[3:] == pytest.approx(resting.velocity[3:], abs=1e-11)


def centre_of_mass(dynamics: Dynamics) -> FloatArray:
    """In space, of the body with its skis as they are bent."""
    body = dynamics.body
    moment = body.first_moment.copy()
    for ski, bend in zip(body.skis, dynamics.part("beam_dofs"), strict=True):
        moment += bend @ ski.coupling[:, :3]
    return dynamics.position + dynamics.rotation @ moment / body.mass


def test_the_centre_of_mass_stays_where_it_is() -> None:
    """While the skis of a turning body bend, but for ω² times the bent mass, which the equations leave out."""
    body = replace(body_of(SCENARIO), gravity=WEIGHTLESS, drag=0.0)
    turning, duration = np.array([6.0, 0.0, 0.0]), 0.02
    still = -np.cross(turning, body.first_moment) / body.mass
    start = sledge(SCENARIO, body=body, height=HEIGHT)
    flight = flown(body, np.concatenate([still, turning]), fixed(0.25e-3), duration)
    assert np.linalg.norm(flight.position - start.position) > 1e-3
    assert np.linalg.norm(centre_of_mass(flight) - centre_of_mass(start)) < 1e-7
