"""Plate, edge, cycles and crossing: runners put into the snow by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from skisnow.contact import Runner, SnowContact

from .effort import Effort, snow_field

FloatArray = npt.NDArray[np.float64]
Values = dict[str, list[float] | None]
AT_REST = np.zeros((1, 6))
WEDGE = 0.08
"""Width (m) of the wedge's base."""


def level(length: float, width: float) -> Runner:
    """A rectangle."""
    return Runner(np.array([0.5, -0.5]) * length, np.full(2, 0.5 * width), np.zeros(2))


def turned(heading: float, edge_angle: float) -> FloatArray:
    """Rotation of a runner with its left edge down."""
    c, s, cos, sin = math.cos(heading), math.sin(heading), math.cos(edge_angle), math.sin(edge_angle)
    about_up = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return about_up @ np.array([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]])


class Pressed:
    """A runner that goes down and up at one place."""

    def __init__(self, contact: SnowContact, *, heading: float = 0.0, edge_angle: float = 0.0, x: float = 0.0,
                 y: float = 0.0, half: float = 0.0) -> None:  # fmt: skip
        self.contact, self.rotation = contact, turned(heading, edge_angle)[None]
        self.at = np.array([x, y, 0.0]) - half * self.rotation[0, :, 1]

    def pose(self, depth: float, aside: float = 0.0) -> tuple[FloatArray, FloatArray]:
        """With the deeper edge so deep (m), and so far to the left."""
        return (self.at + np.array([0.0, aside, -depth]))[None], self.rotation

    def force(self, depth: float, aside: float = 0.0) -> FloatArray:
        """Of the snow (N), (3,); nothing is kept."""
        return self.contact.force(*self.pose(depth, aside), AT_REST, 1e-3).wrench[0, :3]

    def to(self, depth: float, aside: float = 0.0) -> FloatArray:
        """Go there: the snow remembers; its force (N), (3,)."""
        self.contact.update(*self.pose(depth, aside), 1e-3)
        return self.force(depth, aside)

    def under(self, load: float, deepest: float = 0.05) -> float:
        """Depth under a load (m), and go there."""
        depth = float(brentq(lambda d: self.force(d)[2] - load, 0.0, deepest, xtol=1e-12))
        self.to(depth)
        return depth


def plate(case: dict[str, Any], effort: Effort) -> Values:
    """Case 01."""
    body, snow = case["body"], snow_field(effort, case["snow"])
    first, second = (
        Pressed(SnowContact(snow, [level(body["length_m"], body["width_m"])], spacing=effort.spacing), y=y)
        for y in (0.0, 1.0)
    )
    return {
        "force_N": [float(first.to(depth)[2]) for depth in case["motion"]["depth_m"]],
        "depth_m": [second.under(load) for load in case["loads"]["load_N"]],
    }


def edge(case: dict[str, Any], effort: Effort) -> Values:
    """Case 02."""
    motion, runner = case["motion"], level(case["body"]["length_m"], WEDGE)

    def wedge(angle_deg: float, heading_deg: float) -> Pressed:
        contact = SnowContact(snow_field(effort, case["snow"]), [runner], spacing=effort.spacing)
        angles = {"heading": math.radians(heading_deg), "edge_angle": math.radians(angle_deg)}
        return Pressed(contact, **angles, x=motion["x_m"], y=motion["y_m"], half=0.5 * WEDGE)

    depths, forces = [], []
    for angle in case["body"]["edge_angle_deg"]:
        under = wedge(angle, 0.0)
        depths += [under.under(load) for load in case["loads"]["load_N"]]
        forces += [float(wedge(angle, h).force(motion["depth_by_heading_m"])[2]) for h in motion["heading_deg"]]
    return {"depth_m": depths, "force_by_heading_N": forces}


def cycles(case: dict[str, Any], effort: Effort) -> Values:
    """Case 03."""
    body, motion = case["body"], case["motion"]
    runner = level(body["length_m"], WEDGE)

    def wedge() -> Pressed:
        contact = SnowContact(snow_field(effort, case["snow"]), [runner], spacing=effort.spacing)
        return Pressed(contact, edge_angle=math.radians(body["edge_angle_deg"]), half=0.5 * WEDGE)

    pressed, lost = wedge(), []
    for peak in motion["peak_depth_m"]:
        depths = np.concatenate([np.linspace(0.0, peak, effort.poses), np.linspace(peak, 0.0, effort.poses)])
        lost.append(float(np.trapezoid([pressed.to(float(d))[2] for d in depths], depths)))
    sheared = []
    for amplitude in motion["shear_amplitude_m"]:
        held, depth = wedge(), motion["shear_depth_m"]
        held.to(depth)
        for y in np.linspace(0.0, amplitude, effort.poses):
            held.to(depth, float(y))
        places = np.concatenate([np.linspace(a, -a, effort.poses) for a in (amplitude, -amplitude)])
        sheared.append(float(-np.trapezoid([held.to(depth, float(y))[1] for y in places], places)))
    return {"energy_lost_per_cycle_J": lost, "energy_lost_per_shear_cycle_J": sheared}


def crossing(case: dict[str, Any], effort: Effort) -> Values:
    """Case 08."""
    body, motion = case["body"], case["motion"]
    second = level(body["second_length_m"], body["second_width_m"])
    energies, depths = [], []
    for angle in map(math.radians, motion["crossing_angle_deg"]):
        snow = snow_field(effort, case["snow"])
        first = Pressed(SnowContact(snow, [level(1.0, body["first_width_m"])], spacing=effort.spacing))
        for x in np.arange(-3.0, 3.0, effort.spacing):
            first.at[0] = x
            first.to(motion["first_depth_m"])
        over = SnowContact(snow, [second], spacing=effort.spacing)
        depths.append(Pressed(over, heading=angle).under(case["loads"]["load_N"]))
        energies.append(_through(snow_of_track(case, effort), second, angle, case, effort))
    return {"energy_lost_J": energies, "depth_m": depths}


def snow_of_track(case: dict[str, Any], effort: Effort) -> SnowContact:
    """The first runner, gone by in a snow of its own."""
    body, motion = case["body"], case["motion"]
    contact = SnowContact(snow_field(effort, case["snow"]), [level(1.0, body["first_width_m"])], spacing=effort.spacing)
    first = Pressed(contact)
    for x in np.arange(-3.0, 3.0, effort.spacing):
        first.at[0] = x
        first.to(motion["first_depth_m"])
    return contact


def _through(first: SnowContact, runner: Runner, angle: float, case: dict[str, Any], effort: Effort) -> float:
    motion = case["motion"]
    over = SnowContact(first.snow, [runner], spacing=effort.spacing)
    going, before = Pressed(over, heading=angle), over.groove_energy
    ahead, half = going.rotation[0, :, 0], 0.5 * motion["way_m"]
    for s in np.linspace(-half, half, 1 + math.ceil(motion["way_m"] / (0.5 * effort.spacing))):
        going.at = s * ahead
        going.to(motion["second_depth_m"])
    return float(over.groove_energy - before)
