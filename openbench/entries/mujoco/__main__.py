"""``python -m openbench.entries.mujoco CASE_FOLDER RESULT``: the cases in which something moves by itself.

MuJoCo has no snow. A body with a free joint, or with two slides, is stepped by MuJoCo's semi-implicit Euler; before
each step the contact's wrench goes to ``xfrc_applied``, and the snow takes note of the pose.
"""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from skisnow.contact import Runner, SnowContact, SnowField

from ..files import main

FloatArray = npt.NDArray[np.float64]
Case = dict[str, Any]
Values = dict[str, list[float] | None]
ENGINE: Any = mujoco  # its compiled names are not typed
STEP = 2.5e-4
"""Of MuJoCo (s)."""
BY_HAND = "nothing moves by itself here: the library alone, without MuJoCo, is the entry skisnow"


def model(joints: str, mass: float, inertia: list[float], gravity: FloatArray) -> Any:
    """One body with these joints."""
    text = f"""<mujoco><option timestep="{STEP}" gravity="{gravity[0]} {gravity[1]} {gravity[2]}"/>
    <worldbody><body>{joints}<inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia[0]} {inertia[1]} {inertia[2]}"/>
    </body></worldbody></mujoco>"""
    return ENGINE.MjModel.from_xml_string(text)


def gravity_of(motion: Case) -> FloatArray:
    """Along the slope's axes (m/s²)."""
    slope = math.radians(motion["slope_deg"])
    return np.asarray(motion["gravity_m_per_s2"] * np.array([math.sin(slope), 0.0, -math.cos(slope)]))


def snow_of(snow: dict[str, float], ratio: float) -> SnowField:
    """The snow of a case."""
    return SnowField(
        snow["snow_hardness_N_per_m3"],
        snow.get("failure_shear_stress_N_per_m2", 0.0),
        ratio,
        friction=snow["friction_1"],
        friction_direction="along-ski",  # as the cases have it
        shear_displacement=snow.get("shear_displacement_m", 5e-4),
    )


def turn(case: Case) -> Values:
    """Case 07."""
    rows = [row for ratio in case["snow"]["unloading_ratio_1"] for row in _run(case, ratio)]
    return {
        "place_m": [v for x, y, _, _ in rows for v in (x, y)],
        "heading_rad": [heading for _, _, heading, _ in rows],
        "speed_m_per_s": [speed for *_, speed in rows],
    }


def _run(case: Case, ratio: float) -> list[tuple[float, float, float, float]]:
    body, motion = case["body"], case["motion"]
    station, width, height = (np.array(body[key], dtype=float) for key in ("station_m", "width_m", "base_height_m"))
    runner = Runner(station, width / 2.0, height)
    contact = SnowContact(snow_of(case["snow"], ratio), [runner, runner])
    sledge = model("<freejoint/>", body["mass_kg"], body["inertia_kg_m2"], gravity_of(motion))
    data, heading = ENGINE.MjData(sledge), math.radians(motion["start_heading_deg"])
    data.qpos[:] = [*motion["start_place_m"], math.cos(heading / 2.0), 0.0, 0.0, math.sin(heading / 2.0)]
    data.qvel[:2] = motion["start_speed_m_per_s"] * np.array([math.cos(heading), math.sin(heading)])
    angle, boots, rows = math.radians(body["edge_angle_deg"]), np.array(body["boots_m"]), []
    c, s = math.cos(angle), math.sin(angle)
    edged = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    for number in range(round(motion["time_s"][-1] / STEP) + 1):
        ENGINE.mj_forward(sledge, data)
        axes, velocity = data.xmat[1].reshape(3, 3).copy(), data.qvel[:3].copy()
        if any(abs(number * STEP - time) < 0.5 * STEP for time in motion["time_s"]):
            rows.append(
                (data.qpos[0], data.qpos[1], math.atan2(axes[1, 0], axes[0, 0]), float(np.linalg.norm(velocity)))
            )
        spin, arms = axes @ data.qvel[3:], boots @ axes.T
        pose = data.qpos[:3] + arms, np.array([axes @ edged] * 2)
        moves = np.column_stack([velocity + np.cross(spin, arms), np.tile(spin, (2, 1))])
        wrench = contact.force(*pose, moves, STEP if number else 0.0).wrench
        contact.update(*pose, STEP if number else 0.0)
        drag = -body["drag_kg_per_m"] * np.linalg.norm(velocity) * velocity
        data.xfrc_applied[1, :3] = wrench[:, :3].sum(axis=0) + drag
        data.xfrc_applied[1, 3:] = (wrench[:, 3:] + np.cross(arms, wrench[:, :3])).sum(axis=0)
        ENGINE.mj_step(sledge, data)
    return [(float(x), float(y), turned, speed) for x, y, turned, speed in rows]


def glide(case: Case) -> Values:
    """Case 04, on two slides."""
    body, snow, motion = case["body"], case["snow"], case["motion"]
    stations = np.array([body["tip_m"], body["bend_m"], body["tail_m"]])
    runner = Runner(stations, np.full(3, 0.5 * body["width_m"]), np.array([body["tip_height_m"], 0.0, 0.0]))
    contact = SnowContact(snow_of(snow, snow["unloading_ratio_1"]), [runner])
    slides = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
    sledge = model(slides, body["mass_kg"], [1.0, 1.0, 1.0], gravity_of(motion))
    data, weight = ENGINE.MjData(sledge), -body["mass_kg"] * gravity_of(motion)[2]
    level, low, high = np.eye(3)[None], -0.2, 0.0
    for _ in range(60):
        z = 0.5 * (low + high)
        carries = contact.force([[0.0, 0.0, z]], level, np.zeros((1, 6)), 0.0).wrench[0, 2] > weight
        low, high = (z, high) if carries else (low, z)
    data.qpos[1], data.qvel[0] = z, motion["start_speed_m_per_s"]
    ways: list[float] = []
    squares, energies = [], []
    while not ways or ways[-1] < motion["way_m"][-1]:
        (x, z), (speed, rises) = data.qpos, data.qvel
        pose = [[x, 0.0, z]], level
        found = contact.force(*pose, [[speed, 0.0, rises, 0.0, 0.0, 0.0]], STEP if ways else 0.0).wrench[0]
        contact.update(*pose, STEP if ways else 0.0)
        ways.append(float(x))
        squares.append(float(speed**2))
        energies.append(contact.groove_energy)
        data.xfrc_applied[1, :3] = [found[0] - body["drag_kg_per_m"] * speed**2, 0.0, found[2]]
        ENGINE.mj_step(sledge, data)
    tracks = contact.tracks()
    depth = float(np.median(tracks[(tracks[:, 2] > 2.0) & (tracks[:, 2] < 8.0), 5]))
    spent = np.interp([4.0, 10.0], ways, energies)
    return {
        "speed_squared_m2_per_s2": [float(v) for v in np.interp(motion["way_m"], ways, squares)],
        "groove_depth_m": [depth],
        "groove_residual_depth_m": [depth * (1.0 - 1.0 / snow["unloading_ratio_1"])],
        "groove_energy_J_per_m": [float((spent[1] - spent[0]) / 6.0)],
    }


DECLINES = dict.fromkeys(("01-plate", "02-edge", "03-cycles", "08-crossing"), BY_HAND)
DECLINES |= {"05-sand": "no law of sand", "06-carve": "MuJoCo has no beam of given EI and GJ"}
main("mujoco", {"04-glide": glide, "07-turn": turn}, DECLINES)
