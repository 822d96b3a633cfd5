"""The turn: a body on two rigid skis, by skisnow's dynamics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from skisnow.contact import Runner, SnowContact
from skisnow.dynamics import Body, Dynamics, Ended, FlexibleSki, StepControl

from .effort import Effort, snow_field

FloatArray = npt.NDArray[np.float64]
CLAMPED = np.full(2, -1.0)
NOTHING = np.zeros((0, 6))


def sledge(case: dict[str, Any]) -> Body:
    """Rigid skis are beams all of whose nodes are clamped."""
    body, motion = case["body"], case["motion"]
    angle, slope = math.radians(body["edge_angle_deg"]), math.radians(motion["slope_deg"])
    c, s = math.cos(angle), math.sin(angle)
    axes = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    skis = tuple(
        FlexibleSki(
            boot=np.array(boot),
            axes=axes,
            unknown=CLAMPED,
            mass=NOTHING,
            stiffness=NOTHING,
            coupling=NOTHING,
            damping=0.0,
        )
        for boot in body["boots_m"]
    )
    return Body(
        inertia=np.diag([body["mass_kg"]] * 3 + list(body["inertia_kg_m2"])),
        mass=body["mass_kg"],
        first_moment=np.zeros(3),
        skis=skis,
        gravity=motion["gravity_m_per_s2"] * np.array([math.sin(slope), 0.0, -math.cos(slope)]),
        drag=body["drag_kg_per_m"],
    )


def solve(case: dict[str, Any], effort: Effort) -> dict[str, list[float] | None]:
    """Place, heading and speed at the times, on each snow."""
    rows = [row for ratio in case["snow"]["unloading_ratio_1"] for row in run(case, effort, ratio)]
    return {
        "place_m": [float(v) for x, y, _, _ in rows for v in (x, y)],
        "heading_rad": [float(heading) for _, _, heading, _ in rows],
        "speed_m_per_s": [float(speed) for *_, speed in rows],
    }


def run(case: dict[str, Any], effort: Effort, ratio: float) -> list[tuple[float, float, float, float]]:
    """x, y, heading and speed at the times."""
    body, motion = case["body"], case["motion"]
    station = np.array(body["station_m"])
    runner = Runner(station, np.array(body["width_m"]) / 2.0, np.array(body["base_height_m"]), station[[0, -1]])
    contact = SnowContact(snow_field(effort, case["snow"], ratio=ratio), [runner] * 2, spacing=effort.spacing)
    heading = math.radians(motion["start_heading_deg"])
    c, s = math.cos(heading), math.sin(heading)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    control = StepControl(tolerance=effort.tolerance)
    dynamics = Dynamics(sledge(case), contact, np.array(motion["start_place_m"]), rotation, control)
    dynamics.begin(np.array([motion["start_speed_m_per_s"], 0.0, 0.0, 0.0, 0.0, 0.0]))
    rows = []
    for time in motion["time_s"]:
        if dynamics.advance(time) is not Ended.REACHED:
            raise RuntimeError(f"the run ended before {time} s")
        place, ahead = dynamics.position, dynamics.rotation[:, 0]
        speed = float(np.linalg.norm(dynamics.velocity[:3]))
        rows.append((float(place[0]), float(place[1]), math.atan2(ahead[1], ahead[0]), speed))
    return rows
