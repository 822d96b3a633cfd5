"""Scenarios as bodies on skis over snow, put together here from their parts."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skisnow import Scenario
from skisnow.contact import Runner, SnowContact, SnowField
from skisnow.dynamics import Body, Dynamics, Ended, StepControl
from skisnow.forces.friction import FrictionLaw
from skisnow.scenario import Plane, RigidSledge, load_scenario
from skisnow.simulation.sledge_body import sledge_body
from skisnow.ski.beam import ClampedSki, clamped

FloatArray = npt.NDArray[np.float64]
CARVE = "carved-46m"


def given(name: str = CARVE, /, **changes: float) -> Scenario:
    """A built-in scenario; ``snow__H_V_N_per_mm3`` changes snow.H_V_N_per_mm3."""
    return load_scenario(name, changes={key.replace("__", "."): value for key, value in changes.items()})


def fixed(step: float) -> StepControl:
    """Newton's method goes closer than in a run, so that what is left is the step's own error."""
    return StepControl(first=step, fixed=True, closeness=0.003)


def clamped_ski(scenario: Scenario, elements: int) -> ClampedSki:
    return clamped(scenario.ski, scenario.clamp_length, elements)


def gravity(scenario: Scenario) -> FloatArray:
    """In the slope's axes (m/s²)."""
    assert isinstance(scenario.slope, Plane)
    angle = scenario.slope.angle
    return scenario.gravity * np.array([math.sin(angle), 0.0, -math.cos(angle)])


def body_of(scenario: Scenario, elements: int = 40, *, sledge: RigidSledge | None = None) -> Body:
    """A sledge, if not another the scenario's, on two skis."""
    air = scenario.air
    return sledge_body(
        sledge or scenario.sledge,
        clamped_ski(scenario, elements),
        damping_ratio=scenario.damping_ratio,
        gravity=gravity(scenario),
        drag=0.5 * air.density * air.drag_area,
        drag_height=air.centre_of_pressure_height,
    )


def snow_of(scenario: Scenario, *, friction: FrictionLaw | float | None = None) -> SnowField:
    contact = scenario.contact
    stress = contact.snow.failure_shear_stress
    assert stress is not None
    assert contact.friction_by_speed == 0.0
    return SnowField(
        contact.snow.snow_hardness,
        stress,
        contact.unloading_ratio,
        friction=contact.friction if friction is None else friction,
        compaction_resistance=contact.compaction_resistance,
        shear_displacement=contact.shear_displacement,
    )


def placed(scenario: Scenario, *, height: float) -> tuple[FloatArray, FloatArray]:
    """Place and rotation of a sledge at its start, flat, that high above the snow."""
    start = scenario.start
    c, s = math.cos(start.heading), math.sin(start.heading)
    return np.array([start.x, start.y, height]), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def sledge(
    scenario: Scenario,
    control: StepControl | None = None,
    *,
    height: float = 0.02,
    elements: int = 40,
    spacing: float = 0.02,
    body: Body | None = None,
) -> Dynamics:
    """A body, if not another the scenario's, at the scenario's start."""
    body = body or body_of(scenario, elements)
    runner = Runner.of(scenario.ski, nodes=clamped_ski(scenario, elements).node)
    contact = SnowContact(snow_of(scenario), [runner] * len(body.skis), spacing=spacing)
    return Dynamics(body, contact, *placed(scenario, height=height), control or StepControl())


def started(scenario: Scenario, control: StepControl | None = None, *, elements: int = 40) -> Dynamics:
    """At rest on its snow, then at its start speed."""
    dynamics = sledge(scenario, control, elements=elements)
    assert dynamics.find_equilibrium() < 1e-9
    dynamics.begin(ahead(scenario.start.speed))
    return dynamics


def advanced(
    scenario: Scenario, duration: float, control: StepControl | None = None, *, elements: int = 40
) -> Dynamics:
    """So long after its start."""
    dynamics = started(scenario, control, elements=elements)
    assert dynamics.advance(duration) is Ended.REACHED
    return dynamics


def ahead(speed: float) -> FloatArray:
    return np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
