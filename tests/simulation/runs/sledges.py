"""Sledges on skis whose runs are known in closed form."""

import math

import numpy as np

from skisnow import Scenario, Ski
from skisnow.scenario import Air, Contact, Plane, Profile, RigidSledge, Solver, Start, Stop

from ...carving.synthetic import Along, plain_ski, snow

STIFF = 1e9
"""EI and GJ (N m²) of a rigid ski: under 1 kN it bends by less than 0.1 µm."""
GRAVITY = 9.81


def rigid_ski(
    *, length: float = 1.6, width: float | Along = 0.065, base_height: Along | None = None, running_length: float = 1.6
) -> Ski:
    """A ski that does not bend; straight and flat unless said otherwise."""
    return plain_ski(
        length=length,
        width=width,
        base_height=base_height,
        bending=STIFF,
        torsional=STIFF,
        running_length=running_length,
    )


def scenario(
    *,
    ski: Ski,
    angle_deg: float = 0.0,
    slope: Plane | Profile | None = None,
    hardness: float = 0.2,
    strength: float = 0.5,
    unloading_ratio: float = 10.0,
    compaction: bool = True,
    friction: float = 0.0,
    drag_area: float = 0.0,
    mass: float = 80.0,
    centre_height: float = 0.0,
    stance: float = 0.5,
    edge_deg: float = 0.0,
    start: tuple[float, float] = (0.0, 0.0),
    speed: float = 0.0,
    heading_deg: float = 0.0,
    duration: float | None = 1.0,
    length: float | None = None,
    solver: Solver | None = None,
) -> Scenario:
    """A scenario of numbers; snow in N/mm³ and N/mm², angles in degrees."""
    return Scenario(
        slope=slope or Plane(math.radians(angle_deg)),
        contact=Contact(
            snow=snow(hardness, strength),
            unloading_ratio=unloading_ratio,
            compaction_resistance=compaction,
            friction=friction,
        ),
        air=Air(drag_area=drag_area, density=1.2, centre_of_pressure_height=centre_height),
        sledge=RigidSledge(
            mass=mass,
            inertia=(6.0, 8.0, 10.0),
            centre_of_mass=(0.0, centre_height),
            stance_width=stance,
            edge_angle=math.radians(edge_deg),
        ),
        ski=ski,
        start=Start(x=start[0], y=start[1], speed=speed, heading=math.radians(heading_deg)),
        stop=Stop(duration=duration, length=length),
        solver=solver or Solver(),
        gravity=GRAVITY,
    )


def total_mass(given: Scenario) -> float:
    """Of sledge and skis (kg)."""
    return given.sledge.mass + 2.0 * given.ski.mass


def load(given: Scenario) -> float:
    """Weight along the snow's normal (N)."""
    assert isinstance(given.slope, Plane)
    return total_mass(given) * given.gravity * math.cos(given.slope.angle)


def arc_base(radius: float, edge_deg: float) -> Along:
    """Base of a rigid ski with circular edges of that radius whose edge line is in the snow: bent by tan ϑ/R_sc."""
    return lambda s: math.tan(math.radians(edge_deg)) * (radius - np.sqrt(radius**2 - s**2))
