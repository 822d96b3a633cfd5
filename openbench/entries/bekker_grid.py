"""Bekker and Wong's pressure on a square grid of nodes, as the soil contact model (SCM) has it.

``python -m openbench.entries.bekker_grid CASE_FOLDER RESULT``. Nodes stand 2 mm apart in x and y; one that lies under a
body carries its pressure on its square. Sinkage z has a plastic part z_p: pressure K (z - z_p) up to the yield
(k_c/b + k_phi) zⁿ, here n = 1, k_c = 0, k_phi = H and K = k, which on one node is the law of the cases. What is seen is
what a grid does to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .files import main
from .sand_fits import bekker

FloatArray = npt.NDArray[np.float64]
Case = dict[str, Any]
Values = dict[str, list[float] | None]
Depth = Callable[[FloatArray, FloatArray], FloatArray]
NODES = 0.002
"""Distance of the nodes (m)."""


class Grid:
    """Nodes of a rectangle, and how far each was pressed for good."""

    def __init__(self, snow: dict[str, float], low: tuple[float, float], high: tuple[float, float]) -> None:
        x, y = (
            np.arange(math.floor(a / NODES), math.ceil(b / NODES)) * NODES + 0.5 * NODES
            for a, b in zip(low, high, strict=True)
        )
        self.x, self.y = np.meshgrid(x, y, indexing="ij")
        self.hard, self.stiff = (
            snow["snow_hardness_N_per_m3"],
            snow["snow_hardness_N_per_m3"] * snow["unloading_ratio_1"],
        )
        self.plastic = np.zeros_like(self.x)

    def pressure(self, sinkage: FloatArray) -> FloatArray:
        """Of the nodes (N/m²)."""
        return np.clip(self.stiff * (sinkage - self.plastic), 0.0, self.hard * np.maximum(sinkage, 0.0))

    def press(self, depth: Depth, *, keep: bool = True) -> float:
        """Force of a body whose base lies so deep at each place (N)."""
        sinkage = depth(self.x, self.y)
        p = self.pressure(sinkage)
        if keep:
            self.plastic = np.maximum(self.plastic, np.where(p > 0.0, sinkage - p / self.stiff, 0.0))
        return float(p.sum()) * NODES**2

    def under(self, depth_at: Callable[[float], Depth], load: float) -> float:
        """Depth (m) under a load, by halving; then the grid keeps it."""
        low, high = 0.0, 0.05
        for _ in range(45):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.press(depth_at(middle), keep=False) > load else (middle, high)
        self.press(depth_at(low))
        return low

    def energy(self) -> float:
        """Lost for good (J): 1/2 H (1 - H/k) z² of each node's largest sinkage z = z_p/(1 - H/k)."""
        kept = 1.0 - self.hard / self.stiff
        return float(0.5 * self.hard / kept * np.sum(self.plastic**2)) * NODES**2


def rectangle(length: float, width: float, depth: float, *, heading: float = 0.0, along: float = 0.0) -> Depth:
    """A level base; elsewhere nothing presses."""
    c, s = math.cos(heading), math.sin(heading)

    def at(x: FloatArray, y: FloatArray) -> FloatArray:
        inside = (np.abs(c * x + s * y - along) < 0.5 * length) & (np.abs(c * y - s * x) < 0.5 * width)
        return np.where(inside, depth, -1.0)

    return at


def wedge(
    length: float, angle: float, depth: float, *, heading: float = 0.0, at: tuple[float, float] = (0.0, 0.0)
) -> Depth:
    """The base lies to the right of its edge and rises from it."""
    c, s = math.cos(heading), math.sin(heading)

    def lies(x: FloatArray, y: FloatArray) -> FloatArray:
        ahead, right = c * (x - at[0]) + s * (y - at[1]), s * (x - at[0]) - c * (y - at[1])
        inside = (np.abs(ahead) < 0.5 * length) & (right > 0.0)
        return np.where(inside, depth - right * math.tan(angle), -1.0)

    return lies


def plate(case: Case) -> Values:
    length, width = case["body"]["length_m"], case["body"]["width_m"]
    first, second = (Grid(case["snow"], (-length, -width), (length, width)) for _ in range(2))
    return {
        "force_N": [first.press(rectangle(length, width, depth)) for depth in case["motion"]["depth_m"]],
        "depth_m": [second.under(lambda d: rectangle(length, width, d), load) for load in case["loads"]["load_N"]],
    }


def edge(case: Case) -> Values:
    length, motion = case["body"]["length_m"], case["motion"]
    at, depth, depths, forces = (motion["x_m"], motion["y_m"]), motion["depth_by_heading_m"], [], []
    for angle in map(math.radians, case["body"]["edge_angle_deg"]):
        grid = Grid(case["snow"], (-0.25, -0.1), (0.25, 0.1))
        depths += [grid.under(lambda d, a=angle: wedge(length, a, d, at=at), load) for load in case["loads"]["load_N"]]  # type: ignore[misc]
        for heading in map(math.radians, motion["heading_deg"]):
            fresh = Grid(case["snow"], (-0.25, -0.25), (0.25, 0.25))
            forces.append(fresh.press(wedge(length, angle, depth, heading=heading, at=at)))
    return {"depth_m": depths, "force_by_heading_N": forces}


def cycles(case: Case) -> Values:
    """No work aside: Janosi and Hanamoto's shear on a patch knows no edge."""
    body, lost = case["body"], []
    angle, grid = math.radians(body["edge_angle_deg"]), Grid(case["snow"], (-0.25, -0.05), (0.25, 0.05))
    for peak in case["motion"]["peak_depth_m"]:
        depths = np.concatenate([np.linspace(0.0, peak, 200), np.linspace(peak, 0.0, 200)])
        lost.append(float(np.trapezoid([grid.press(wedge(body["length_m"], angle, float(d))) for d in depths], depths)))
    return {"energy_lost_per_cycle_J": lost, "energy_lost_per_shear_cycle_J": None}


def crossing(case: Case) -> Values:
    body, motion, energies, depths = case["body"], case["motion"], [], []
    length, width, first = body["second_length_m"], body["second_width_m"], motion["first_depth_m"]
    for angle in map(math.radians, motion["crossing_angle_deg"]):
        over = _with_track(case, 0.5 * length)
        depths.append(over.under(lambda d, a=angle: rectangle(length, width, d, heading=a), case["loads"]["load_N"]))  # type: ignore[misc]
        grid = _with_track(case, 0.5 * (length + motion["way_m"]))
        swept = rectangle(length + motion["way_m"], width + 2 * NODES, 1.0, heading=angle)(grid.x, grid.y) > 0.0
        grid.x, grid.y, grid.plastic = grid.x[swept], grid.y[swept], grid.plastic[swept]
        before = grid.energy()
        for s in np.linspace(-0.5, 0.5, 1 + round(motion["way_m"] / 0.005)) * motion["way_m"]:
            grid.press(rectangle(length, width, motion["second_depth_m"], heading=angle, along=float(s)))
        energies.append(grid.energy() - before)
        assert first < motion["second_depth_m"]
    return {"energy_lost_J": energies, "depth_m": depths}


def _with_track(case: Case, reach: float) -> Grid:
    grid = Grid(case["snow"], (-reach - 0.05, -reach - 0.05), (reach + 0.05, reach + 0.05))
    grid.press(rectangle(10.0, case["body"]["first_width_m"], case["motion"]["first_depth_m"]))
    return grid


def glide(case: Case) -> Values:
    """The body goes from node to node: one step for each row of nodes that it comes to."""
    body, snow, motion = case["body"], case["snow"], case["motion"]
    slope, mass, half = math.radians(motion["slope_deg"]), body["mass_kg"], 0.5 * body["width_m"]
    weight, rise = mass * motion["gravity_m_per_s2"], body["tip_height_m"] / (body["tip_m"] - body["bend_m"])
    grid = Grid(snow, (body["tail_m"] - 0.1, -half), (motion["way_m"][-1] + 1.0, half))

    def base(way: float, depth: float, columns: slice) -> FloatArray:
        s = grid.x[columns] - way
        inside = (s > body["tail_m"]) & (s < body["tip_m"])
        return np.where(inside, depth - rise * np.maximum(s - body["bend_m"], 0.0), -1.0)

    def forces(way: float, depth: float, *, keep: bool) -> tuple[float, float]:
        """Upwards, and what pushes back."""
        columns = slice(*(int((way + s - grid.x[0, 0]) / NODES) for s in (body["tail_m"] - 0.01, body["tip_m"] + 0.01)))
        sinkage, plastic = base(way, depth, columns), grid.plastic[columns]
        p = np.clip(grid.stiff * (sinkage - plastic), 0.0, grid.hard * np.maximum(sinkage, 0.0))
        if keep:
            plastic[:] = np.maximum(plastic, np.where(p > 0.0, sinkage - p / grid.stiff, 0.0))
        tip = grid.x[columns] - way > body["bend_m"]
        return float(p.sum()) * NODES**2, float(p[tip].sum()) * NODES**2 * rise

    low, high = 0.0, 0.05
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if forces(0.0, middle, keep=False)[0] > weight * math.cos(slope) else (middle, high)
    z, sinking, way, speed, h = low, 0.0, 0.0, motion["start_speed_m_per_s"], 5e-4
    ways, squares = [0.0], [speed**2]
    while way < motion["way_m"][-1]:
        up, back = forces(way, z, keep=True)
        sinking += h * (weight * math.cos(slope) - up) / mass
        drag = body["drag_kg_per_m"] * speed**2 + snow["friction_1"] * up + back
        speed += h * (weight * math.sin(slope) - drag) / mass
        z, way = z + h * sinking, way + h * speed
        ways.append(way)
        squares.append(speed**2)
    middle_part = (grid.x[:, 0] > 2.0) & (grid.x[:, 0] < 8.0)
    residual, kept = grid.plastic[middle_part], 1.0 - grid.hard / grid.stiff
    lost = 0.5 * grid.hard / kept * float(np.sum(residual**2)) * NODES**2 / 6.0
    return {
        "speed_squared_m2_per_s2": [float(v) for v in np.interp(motion["way_m"], ways, squares)],
        "groove_depth_m": [float(np.median(residual)) / kept],
        "groove_residual_depth_m": [float(np.median(residual))],
        "groove_energy_J_per_m": [lost],
    }


if __name__ == "__main__":
    main(
        "bekker-grid",
        {
            "01-plate": plate,
            "02-edge": edge,
            "03-cycles": cycles,
            "04-glide": glide,
            "05-sand": bekker,
            "08-crossing": crossing,
        },
        {"06-carve": "a grid of rigid nodes has no flexible ski", "07-turn": "its shear knows no edge"},
    )
