"""Plate, edge, cycles, glide and crossing on lines and cells."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .ground import Ground, Older, Shape

FloatArray = npt.NDArray[np.float64]
Values = dict[str, list[float] | None]
Case = dict[str, Any]
WEDGE = 0.08
"""Width (m) of the wedge's base."""
AT_REST = np.zeros((1, 6))
PIECES = 200
"""Of each way of a cycle."""


def level(length: float, width: float) -> Shape:
    """A rectangle."""
    return Shape(np.array([-0.5, 0.5]) * length, np.full(2, 0.5 * width), np.zeros(2))


class Pressed:
    """One runner at one place, going down and up."""

    def __init__(self, shape: Shape, snow: dict[str, float], *, heading: float = 0.0, edge_angle: float = 0.0,
                 at: tuple[float, float] = (0.0, 0.0), half: float = 0.0, older: Older | None = None,
                 spacing: float = 0.01, cell: float = 1e-4) -> None:  # fmt: skip
        c, s, cos, sin = math.cos(heading), math.sin(heading), math.cos(edge_angle), math.sin(edge_angle)
        about_up = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        self.rotation = about_up @ np.array([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]])
        self.at = np.array([*at, 0.0]) - half * self.rotation[:, 1]
        self.ground = Ground(shape, snow, 1, ends=(-2.0, 2.0), spacing=spacing, cell=cell, older=older)

    def to(self, depth: float, aside: float = 0.0) -> FloatArray:
        """Go there: the force of the snow (N), (3,)."""
        place = self.at + np.array([0.0, aside, -depth])
        return np.asarray(self.ground.act(place[None], self.rotation[None], AT_REST)[1].sum(axis=0))

    def force(self, depth: float) -> float:
        """Upwards (N), if it went there."""
        kept, self.ground = self.ground, copy.deepcopy(self.ground)
        found = float(self.to(depth)[2])
        self.ground = kept
        return found

    def under(self, load: float) -> float:
        """Depth under a load (m), by halving."""
        low, high = 0.0, 0.05
        for _ in range(45):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.force(middle) > load else (middle, high)
        self.to(low)
        return low


def plate(case: Case) -> Values:
    body = case["body"]
    first, second = (Pressed(level(body["length_m"], body["width_m"]), case["snow"], cell=1e-3) for _ in range(2))
    return {
        "force_N": [float(first.to(depth)[2]) for depth in case["motion"]["depth_m"]],
        "depth_m": [second.under(load) for load in case["loads"]["load_N"]],
    }


def edge(case: Case) -> Values:
    motion, depths, forces = case["motion"], [], []
    shape, at = level(case["body"]["length_m"], WEDGE), (motion["x_m"], motion["y_m"])
    for angle in map(math.radians, case["body"]["edge_angle_deg"]):
        under = Pressed(shape, case["snow"], edge_angle=angle, at=at, half=0.5 * WEDGE)
        depths += [under.under(load) for load in case["loads"]["load_N"]]
        for heading in map(math.radians, motion["heading_deg"]):
            turned = Pressed(shape, case["snow"], heading=heading, edge_angle=angle, at=at, half=0.5 * WEDGE)
            forces.append(turned.force(motion["depth_by_heading_m"]))
    return {"depth_m": depths, "force_by_heading_N": forces}


def cycles(case: Case) -> Values:
    body, motion = case["body"], case["motion"]

    def wedge() -> Pressed:
        return Pressed(
            level(body["length_m"], WEDGE),
            case["snow"],
            edge_angle=math.radians(body["edge_angle_deg"]),
            half=0.5 * WEDGE,
        )

    pressed, lost = wedge(), []
    for peak in motion["peak_depth_m"]:
        depths = np.concatenate([np.linspace(0.0, peak, PIECES), np.linspace(peak, 0.0, PIECES)])
        lost.append(_work(lambda d: float(pressed.to(d)[2]), depths))
    sheared = []
    for amplitude in motion["shear_amplitude_m"]:
        held, depth = wedge(), motion["shear_depth_m"]
        for y in np.linspace(0.0, amplitude, PIECES):
            held.to(depth, float(y))
        places = np.concatenate([np.linspace(a, -a, PIECES) for a in (amplitude, -amplitude)])
        sheared.append(-_work(lambda y, one=held, d=depth: float(one.to(d, y)[1]), places))  # type: ignore[misc]
    return {"energy_lost_per_cycle_J": lost, "energy_lost_per_shear_cycle_J": sheared}


def _work(force: Callable[[float], float], way: FloatArray) -> float:
    return float(np.trapezoid([force(float(x)) for x in way], way))


def crossing(case: Case) -> Values:
    """The older track lies aslant, and the second runner goes along x."""
    body, motion = case["body"], case["motion"]
    shape, half = level(body["second_length_m"], body["second_width_m"]), 0.5 * body["first_width_m"]
    energies, depths = [], []
    for angle in map(math.radians, motion["crossing_angle_deg"]):

        def older(x: FloatArray, y: FloatArray, turn: float = angle) -> FloatArray:
            off = np.abs(math.sin(turn) * x + math.cos(turn) * y)
            return np.where(off < half, motion["first_depth_m"], 0.0)

        depths.append(
            Pressed(shape, case["snow"], older=older, spacing=0.005, cell=5e-4).under(case["loads"]["load_N"])
        )
        going = Pressed(shape, case["snow"], older=older, spacing=0.005, cell=5e-4)

        for x in np.linspace(-0.5, 0.5, 121) * motion["way_m"]:
            going.at[0] = x
            going.to(motion["second_depth_m"])
        energies.append(going.ground.energy())
    return {"energy_lost_J": energies, "depth_m": depths}


def glide(case: Case) -> Values:
    """Along the slope and off the snow by Verlet's method, in steps of 1 ms."""
    body, snow, motion, h = case["body"], case["snow"], case["motion"], 1e-3
    shape = Shape(
        np.array([body["tail_m"], body["bend_m"], body["tip_m"]]),
        np.full(3, 0.5 * body["width_m"]),
        np.array([0.0, 0.0, body["tip_height_m"]]),
    )
    slope, mass = math.radians(motion["slope_deg"]), body["mass_kg"]
    pull = motion["gravity_m_per_s2"] * np.array([math.sin(slope), 0.0, -math.cos(slope)])
    start = Pressed(shape, snow, cell=2e-3)
    place = np.array([0.0, 0.0, -start.under(-mass * pull[2])])
    ground = Ground(shape, snow, 1, ends=(-1.5, motion["way_m"][-1] + 1.5), spacing=0.01, cell=2e-3)
    speed = np.array([motion["start_speed_m_per_s"], 0.0, 0.0])

    def felt() -> FloatArray:
        moves = np.concatenate([speed, np.zeros(3)])[None]
        forces = ground.act(place[None], np.eye(3)[None], moves)[1].sum(axis=0)
        return np.asarray(pull + (forces - [body["drag_kg_per_m"] * speed[0] ** 2, 0.0, 0.0]) / mass)

    push, ways, squares = felt(), [0.0], [speed[0] ** 2]
    while ways[-1] < motion["way_m"][-1]:
        place, middle = place + h * speed + 0.5 * h * h * push, speed + 0.5 * h * push
        speed = speed + h * push
        push = felt()
        speed = middle + 0.5 * h * push
        ways.append(float(place[0]))
        squares.append(float(speed[0] ** 2))
    depth = float(np.median(ground.groove(2.0, 8.0)))
    kept = 1.0 - 1.0 / snow["unloading_ratio_1"]
    energy = ground.energy(2.0, 8.0) / 6.0
    return {
        "speed_squared_m2_per_s2": [float(v) for v in np.interp(motion["way_m"], ways, squares)],
        "groove_depth_m": [depth],
        "groove_residual_depth_m": [depth * kept],
        "groove_energy_J_per_m": [energy],
    }
