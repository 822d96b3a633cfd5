"""The straight glide: two unknowns, along the slope and off the snow, by Verlet's method."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from skisnow.contact import Runner, SnowContact

from .effort import Effort, snow_field

LEVEL = np.eye(3)[None]


def solve(case: dict[str, Any], effort: Effort) -> dict[str, list[float] | None]:
    """Case 04, in steps of a twentieth of the spacing."""
    body, snow, motion = case["body"], case["snow"], case["motion"]
    runner = Runner(
        np.array([body["tip_m"], body["bend_m"], body["tail_m"]]),
        np.full(3, 0.5 * body["width_m"]),
        np.array([body["tip_height_m"], 0.0, 0.0]),
    )
    contact = SnowContact(snow_field(effort, snow), [runner], spacing=effort.spacing)
    slope, g, mass = math.radians(motion["slope_deg"]), motion["gravity_m_per_s2"], body["mass_kg"]
    pull = np.array([g * math.sin(slope), -g * math.cos(slope)])
    place, motion_now, h = np.zeros(2), np.array([motion["start_speed_m_per_s"], 0.0]), effort.spacing / 20.0

    def felt() -> Any:
        pose = np.array([[place[0], 0.0, place[1]]]), LEVEL
        velocity = np.array([[motion_now[0], 0, motion_now[1], 0, 0, 0]])
        found = contact.force(*pose, velocity, h).wrench[0]
        contact.update(*pose, h)
        return pull + np.array([found[0] - body["drag_kg_per_m"] * motion_now[0] ** 2, found[2]]) / mass

    place[1] = _static_depth(contact, mass * pull[1])
    push, ways, squares, energies = felt(), [0.0], [motion_now[0] ** 2], [contact.groove_energy]
    while ways[-1] < motion["way_m"][-1]:
        place = place + h * motion_now + 0.5 * h * h * push
        middle = motion_now + 0.5 * h * push
        motion_now = motion_now + h * push
        push = felt()
        motion_now = middle + 0.5 * h * push
        ways.append(float(place[0]))
        squares.append(float(motion_now[0] ** 2))
        energies.append(contact.groove_energy)
    tracks = contact.tracks()
    middle_of_way = (tracks[:, 2] > 2.0) & (tracks[:, 2] < 8.0)
    depth = float(np.median(tracks[middle_of_way, 5]))
    spent = np.interp([4.0, 10.0], ways, energies)
    return {
        "speed_squared_m2_per_s2": [float(v) for v in np.interp(motion["way_m"], ways, squares)],
        "groove_depth_m": [depth],
        "groove_residual_depth_m": [depth * (1.0 - 1.0 / snow["unloading_ratio_1"])],
        "groove_energy_J_per_m": [float((spent[1] - spent[0]) / 6.0)],
    }


def _static_depth(contact: SnowContact, weight: float) -> float:
    """Height of the boot (m) at which the snow carries the weight (N, downwards negative)."""
    low, high = -0.2, 0.0
    for _ in range(60):
        z = 0.5 * (low + high)
        found = contact.force([[0.0, 0.0, z]], LEVEL, np.zeros((1, 6)), 0.0).wrench[0, 2]
        low, high = (z, high) if found + weight > 0.0 else (low, z)
    return 0.5 * (low + high)
