"""Runs made without a simulation: straight down the fall line with constant friction, known in closed form."""

import math
from collections.abc import Callable

import numpy as np

from skisnow.scenario import Plane, Scenario
from skisnow.simulation.run import Groove, Outcome, Run, SkiHistory

STATION = np.array([0.8, 0.0, -0.8])
DEPTH = 0.004
ASIDE = 0.04
"""How far (m) a ski of one element would miss to the left: a made-up error of the mesh, ∝ 1/elements."""
STRAIGHT = {"heading_deg": 0.0, "mu_0": 0.05, "drag_area_m2": 0.0, "duration_s": 2.0, "speed_m_per_s": 5.0}


def acceleration(scenario: Scenario) -> float:
    """Acceleration of a body on a plane with constant friction (m/s²)."""
    assert isinstance(scenario.slope, Plane)
    angle = scenario.slope.angle
    return scenario.gravity * (math.sin(angle) - scenario.contact.friction * math.cos(angle))


def straight_run(
    scenario: Scenario,
    *,
    progress: Callable[[float, float], None] | None = None,
    outcome: Outcome = "finished",
    share: float = 1.0,
) -> Run:
    """The run of a scenario without drag and with heading 0; with a share below 1 it ends before its time."""
    assert isinstance(scenario.slope, Plane)
    assert scenario.stop.duration is not None
    assert scenario.start.heading == scenario.air.drag_area == 0.0
    end = share * scenario.stop.duration
    time = np.linspace(0.0, end, round(end / scenario.solver.output_interval) + 1)
    if progress is not None:
        progress(end, 1.0)
    elements = scenario.solver.elements or 40
    speed = scenario.start.speed + acceleration(scenario) * time
    path = scenario.start.speed * time + acceleration(scenario) * time**2 / 2.0
    place = np.zeros((len(time), 3))
    place[:, 0] = scenario.start.x + path
    place[:, 1] = scenario.start.y + ASIDE / elements
    velocity = np.zeros_like(place)
    velocity[:, 0] = speed
    weight = (scenario.sledge.mass + 2.0 * scenario.ski.mass) * scenario.gravity
    none = np.zeros(len(time))
    energies = {
        "kinetic": weight / scenario.gravity * speed**2 / 2.0,
        "potential": -weight * math.sin(scenario.slope.angle) * path,
        "elastic_ski": none + 1.0,
        "elastic_snow": none + 2.0,
        "delayed_snow": none,
        "penetration": none,
        "shear": none,
        "friction": scenario.contact.friction * weight * math.cos(scenario.slope.angle) * path,
        "drag": none,
        "damping": none,
        "snow_damping": none,
    }
    return Run(
        scenario=scenario,
        outcome=outcome,
        remedy="" if outcome == "finished" else "a longer breath",
        time=time,
        place=place,
        attitude=np.broadcast_to(np.eye(3), (len(time), 3, 3)),
        velocity=velocity,
        heading=none,
        turn_radius=np.full(len(time), math.inf),
        skis=_skis(place, scenario.sledge.stance_width),
        groove=Groove(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(0)),
        energies=energies,
        run_length=float(path[-1]),
        steps=1000,
        rejected_steps=7,
        wall_s=0.5,
        numbers={"elements": float(elements), "line_spacing_m": 0.018},
    )


def _skis(place: np.ndarray, stance: float) -> SkiHistory:
    """Flat skis; the right one lies deeper, so that no two columns are alike."""
    n = len(place)
    depth = np.broadcast_to(np.array([DEPTH, 2.0 * DEPTH]), (n, 2))
    track = np.repeat(place[:, None, :], 2, axis=1)
    track[:, :, 1] += np.array([stance / 2.0, -stance / 2.0])
    flat = np.zeros((n, 2, len(STATION)))
    return SkiHistory(
        station=STATION,
        track=track,
        depth=depth,
        edge_depth=np.broadcast_to(depth[:, :, None], flat.shape),
        force_per_length=flat,
        shear_per_length=flat,
        force=np.zeros((n, 2, 3)),
        bending=flat,
        twist=flat,
    )
