"""Scenarios as bodies on skis over snow, put together here from their parts; forces on a body at rest."""

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from skisnow import Scenario
from skisnow.contact import ContactForces, Runner, SnowContact, SnowField
from skisnow.dynamics import Body, Dynamics, Ended, FlexibleSki, StepControl
from skisnow.forces.friction import FrictionLaw
from skisnow.scenario import Plane, RigidSledge, load_scenario
from skisnow.simulation.sledge_body import cross_matrix, sledge_body
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


# Bodies on one and three skis, and bodies without skis to speak of


NO_STANCE = 1e-9
"""Between the middles of two skis (m) that are to lie at one place."""


def without_skis(scenario: Scenario) -> tuple[FloatArray, float, FloatArray]:
    """Mass matrix (6, 6), mass (kg) and first moment (kg m) of a sledge alone."""
    sledge = scenario.sledge
    centre = np.array([sledge.centre_of_mass[0], 0.0, sledge.centre_of_mass[1]])
    arm = np.hstack([np.eye(3), -cross_matrix(centre)])
    inertia = sledge.mass * arm.T @ arm
    inertia[3:, 3:] += np.diag(sledge.inertia)
    return inertia, sledge.mass, sledge.mass * centre


def on_one_ski(scenario: Scenario) -> Body:
    """The sledge on a single ski under its middle: half of two skis at one place."""
    alone, mass, moment = without_skis(scenario)
    pair = body_of(scenario, sledge=replace(scenario.sledge, stance_width=NO_STANCE))
    return replace(
        pair,
        inertia=(alone + pair.inertia) / 2.0,
        mass=(mass + pair.mass) / 2.0,
        first_moment=(moment + pair.first_moment) / 2.0,
        skis=pair.skis[:1],
    )


def on_three_skis(scenario: Scenario) -> Body:
    """The sledge on its two skis and one between them."""
    alone, mass, moment = without_skis(scenario)
    sides, middle = body_of(scenario), on_one_ski(scenario)
    return replace(
        sides,
        inertia=sides.inertia + middle.inertia - alone,
        mass=sides.mass + middle.mass - mass,
        first_moment=sides.first_moment + middle.first_moment - moment,
        skis=(sides.skis[0], middle.skis[0], sides.skis[1]),
    )


def rigid(body: Body, inertia: FloatArray) -> Body:
    """The same skis without mass to speak of, on a body with this inertia about its origin, its centre of mass."""
    light = tuple(
        replace(ski, mass=1e-9 * ski.mass, coupling=np.zeros_like(ski.coupling), damping=0.0) for ski in body.skis
    )
    matrix = np.diag([body.mass] * 3 + [0.0] * 3)
    matrix[3:, 3:] = np.diag(inertia)
    return replace(body, inertia=matrix, first_moment=np.zeros(3), skis=light, drag=0.0)


# Forces on a body at rest, summed here without its compiled equations


def dense(lower: FloatArray) -> FloatArray:
    """A symmetric matrix of the lower half of its band: [i, j] is A[i, i - j]."""
    size, width = lower.shape
    full = np.zeros((size, size))
    for j in range(width):
        rows = np.arange(j, size)
        full[rows, rows - j] = full[rows - j, rows] = lower[rows, j]
    return full


def nodes_of(ski: FlexibleSki, bend: FloatArray) -> FloatArray:
    """Deflection, slope and twist at each node, (nodes, 3)."""
    free = ski.unknown >= 0
    out = np.zeros((len(free), 3))
    out[free] = bend[ski.unknown[free].astype(int)[:, None] + np.arange(3)]
    return out


def snow_forces(dynamics: Dynamics) -> ContactForces:
    """Of the snow at rest where the body is."""
    rotation, body = dynamics.rotation, dynamics.body
    boots = np.array([dynamics.position + rotation @ ski.boot for ski in body.skis])
    axes = np.array([rotation @ ski.axes.T for ski in body.skis])
    beams = [nodes_of(ski, bend) for ski, bend in zip(body.skis, dynamics.part("beam_dofs"), strict=True)]
    return dynamics.contact.force(boots, axes, np.zeros((len(boots), 6)), 0.0, beam_dofs=beams)


def left_over(dynamics: Dynamics) -> tuple[FloatArray, list[FloatArray]]:
    """Force and moment on the body (6,), and on each ski's unknowns, in the body's axes."""
    body, rotation = dynamics.body, dynamics.rotation
    weight = rotation.T @ body.gravity
    total = np.concatenate([body.mass * weight, np.cross(body.first_moment, weight)])
    snow, of_skis = snow_forces(dynamics), []
    for k, ski in enumerate(body.skis):
        force, moment = rotation.T @ snow.wrench[k, :3], rotation.T @ snow.wrench[k, 3:]
        total += np.concatenate([force, moment + np.cross(ski.boot, force)])
        of_skis.append(_on_ski(ski, weight, dynamics.part("beam_dofs")[k], snow.beam_loads[k]))
    return total, of_skis


def _on_ski(ski: FlexibleSki, weight: FloatArray, bend: FloatArray, loads: FloatArray) -> FloatArray:
    free = ski.unknown >= 0
    felt = np.zeros_like(bend)
    felt[ski.unknown[free].astype(int)[:, None] + np.arange(3)] = loads[free]
    return felt + ski.coupling[:, :3] @ weight - dense(ski.stiffness) @ bend
