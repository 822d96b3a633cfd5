"""Outputs of a carve that have derivatives: their values, and how they grow with state, snow and ski."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.units import MM
from .edge_line import BOOT_REACH, EdgeLine, circle_radius, sections_at

if TYPE_CHECKING:
    from ..ski.beam import ClampedSki
    from .solve import Conditions, Solution


AT_BOOT: Final = np.array([[BOOT_REACH], [0.0], [-BOOT_REACH]])
"""Places (m) of the circle of the boot's turn radius."""
_NEAR: Final = 1e-7  # m, over which the slope of the edge line is taken


@dataclass(frozen=True, slots=True, eq=False)
class CarveRequest:
    """Ski, snow and conditions of an equilibrium, with its solution; `strength`: S_f (N/m²)."""

    model: ClampedSki
    conditions: Conditions
    strength: float | None
    solution: Solution
    elements: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OutputGrowth:
    """An output, and its partial derivatives by each quantity that it is computed from.

    value: The output.
    depth, force, weight, place: By depth (m) and force (N/m) of the stations, their length and place (m); None: none.
    edge_angle, load, strength: By ϑ (rad), load (N), S_f (N/m²).
    edge, edge_by: Places of the edge line (m), and the derivatives by the ski's section there, shape (4, k): width,
        height of the base, deflection (m), twist (rad).
    """

    value: float
    depth: FloatArray | None = None
    force: FloatArray | None = None
    weight: FloatArray | None = None
    place: FloatArray | None = None
    edge_angle: float = 0.0
    load: float = 0.0
    strength: float = 0.0
    edge: FloatArray = field(default_factory=lambda: np.zeros(0))
    edge_by: FloatArray = field(default_factory=lambda: np.zeros((4, 0)))

    def scaled(self, unit: float) -> OutputGrowth:
        """Output and derivatives divided by a unit of the output."""
        parts = [(part.name, getattr(self, part.name)) for part in fields(self) if part.name != "edge"]
        divided: dict[str, Any] = {name: value / unit for name, value in parts if value is not None}
        return replace(self, **divided)

    def by_unknowns(self, model: ClampedSki) -> FloatArray:
        """Derivatives by the unknowns of the beam (size,)."""
        out = np.zeros(model.size)
        if len(self.edge):
            dof, deflection, twist = sections_at(model, tuple(self.edge.tolist()))[2]
            shape = self.edge_by[2, :, None] * deflection + self.edge_by[3, :, None] * twist
            np.add.at(out, dof[dof >= 0], shape[dof >= 0])
        return out


def _circle_gradient(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Radii (k,) of circles through front, boot and rear points (m), and their derivatives by x and by y, (3, k) each.

    The radius is -a b c/(2 T), with the sides a, b, c and twice the area T of the triangle.
    """
    twice_area = (x[0] - x[2]) * (y[1] - y[2]) - (x[1] - x[2]) * (y[0] - y[2])
    by_x = -np.array([y[1] - y[2], y[2] - y[0], y[0] - y[1]]) / twice_area
    by_y = -np.array([x[2] - x[1], x[0] - x[2], x[1] - x[0]]) / twice_area
    sides = np.ones(x.shape[1])
    for i, j in ((1, 0), (1, 2), (0, 2)):
        along, across = x[i] - x[j], y[i] - y[j]
        square = along**2 + across**2
        sides *= np.sqrt(square)
        by_x[[i, j]] += along / square, -along / square
        by_y[[i, j]] += across / square, -across / square
    radius = -sides / (2.0 * twice_area)
    return radius, radius * by_x, radius * by_y


def _radius_over(
    at: CarveRequest, x: FloatArray, weight: float | FloatArray = 1.0, *, moves: bool = False
) -> tuple[OutputGrowth, FloatArray] | None:
    """Radius of the circles through the edge at places (3, k), its weighted derivatives, and those by the places."""
    angle = at.conditions.edge_angle
    line = EdgeLine(at.model, angle, at.solution)
    width, height, deflection, twist = sections = line.sections(x.ravel())
    y = line.across(*sections).reshape(x.shape)
    turns = at.conditions.side_force != 0.0
    if not turns or any(circle_radius(*zip(a, b, strict=True)) is None for a, b in zip(x.T, y.T, strict=True)):
        return None
    radius, by_x, by_y = _circle_gradient(x, y)
    by_x, by_y = weight * by_x, (weight * by_y).ravel()
    turned = angle + twist
    if moves:
        slope = (line.at(x.ravel() + _NEAR) - line.at(x.ravel() - _NEAR)) / (2.0 * _NEAR)
        by_x += (by_y * slope).reshape(x.shape)
    by_twist = -by_y * width / 2.0 * np.sin(turned)
    growth = OutputGrowth(
        value=float(radius[0]),
        edge_angle=float(by_twist.sum() + (by_y * (height + deflection)).sum() * math.cos(angle)),
        edge=x.ravel(),
        edge_by=np.array([by_y * np.cos(turned) / 2.0, by_y * math.sin(angle), by_y * math.sin(angle), by_twist]),
    )
    return growth, by_x


def _radius_at_boot(at: CarveRequest) -> OutputGrowth | None:
    """Turn radius (m) at the boot, with its derivatives; None if there is no such circle."""
    circle = _radius_over(at, AT_BOOT)
    return None if circle is None else circle[0]


def _radius_of_chord(at: CarveRequest) -> OutputGrowth | None:
    """Radius (m) of the circle through boot and contact ends, with derivatives; None without a circle."""
    ends = _contact_ends(at)
    if ends is None:
        return None
    x = np.array([[ends[0].value], [0.0], [ends[1].value]])
    circle = _radius_over(at, x, moves=True) if x[0] > 0.0 > x[2] else None
    return None if circle is None else _with_ends(circle[0], ends, float(circle[1][0, 0]), float(circle[1][2, 0]))


def _radius_median(at: CarveRequest) -> OutputGrowth | None:
    """Median turn radius (m) over the contact, with its derivatives; None without one."""
    ends = _contact_ends(at)
    if ends is None:
        return None
    line = EdgeLine(at.model, at.conditions.edge_angle, at.solution)
    circles = line.median_circles(ends[0].value, ends[1].value)
    circle = None if circles is None else _radius_over(at, circles.places, circles.weight)
    if circles is None or circle is None:
        return None
    return replace(_with_ends(circle[0], ends, circles.by_front, circles.by_rear), value=circles.radius)


def _with_ends(
    growth: OutputGrowth, ends: tuple[OutputGrowth, OutputGrowth], by_front: float, by_rear: float
) -> OutputGrowth:
    """The output's derivatives plus those through both ends of the contact, which move with depth and place."""
    depth, place = (
        np.asarray(by_front * getattr(ends[0], name) + by_rear * getattr(ends[1], name)) for name in ("depth", "place")
    )
    return replace(growth, depth=depth, place=place)


def _contact_ends(at: CarveRequest) -> tuple[OutputGrowth, OutputGrowth] | None:
    """Stations (m) of both contact ends, with derivatives, front first; None if the contact reaches tip or tail."""
    depth, station = at.solution.edge_depth, at.model.stations.station
    below = np.flatnonzero(depth > 0.0)
    if below[0] == 0 or below[-1] == len(depth) - 1:
        return None

    def end(last: int, beyond: int) -> OutputGrowth:
        by_depth, by_place = 0.0 * depth, 0.0 * depth
        fall, way = depth[last] - depth[beyond], station[beyond] - station[last]
        share = depth[last] / fall
        by_depth[last], by_depth[beyond] = -depth[beyond] * way / fall**2, depth[last] * way / fall**2
        by_place[last], by_place[beyond] = 1.0 - share, share
        return OutputGrowth(value=float(station[last] + share * way), depth=by_depth, place=by_place)

    return end(int(below[0]), int(below[0]) - 1), end(int(below[-1]), int(below[-1]) + 1)


def _contact_length(at: CarveRequest) -> OutputGrowth | None:
    """Distance (m) between the ends of contact, with its derivatives; None without contact."""
    ends = _contact_ends(at)
    if ends is None:
        return None
    front, rear = ends
    depth, place = (np.asarray(getattr(front, name) - getattr(rear, name)) for name in ("depth", "place"))
    return OutputGrowth(value=front.value - rear.value, depth=depth, place=place)


def _mask_of_largest(values: FloatArray) -> FloatArray:
    """Array that is 1 at the largest value and 0 elsewhere."""
    return np.asarray(np.eye(1, len(values), int(np.argmax(values)))[0])


def _largest_depth(at: CarveRequest) -> OutputGrowth | None:
    """Largest depth of the edge (m), with its derivatives."""
    depth = at.solution.edge_depth
    return OutputGrowth(value=float(depth.max()), depth=_mask_of_largest(depth))


def _largest_force(at: CarveRequest) -> OutputGrowth | None:
    """Largest force per length (N/m), with its derivatives."""
    force = at.solution.force_per_length
    return OutputGrowth(value=float(force.max()), force=_mask_of_largest(force))


def _deflection_at_boot(at: CarveRequest) -> OutputGrowth | None:
    """Deflection of the base (m) 0.4 m before the boot, with its derivatives."""
    x = np.array([BOOT_REACH])
    by = np.array([[0.0], [0.0], [1.0], [0.0]])
    line = EdgeLine(at.model, at.conditions.edge_angle, at.solution)
    return OutputGrowth(value=float(line.sections(x)[2][0]), edge=x, edge_by=by)


def _grip_utilisation(at: CarveRequest) -> OutputGrowth | None:
    """Side force over strength × area below the snow, with its derivatives; None without strength or side force."""
    weight, depth, conditions = at.model.stations.weight, at.solution.edge_depth, at.conditions
    if at.strength is None or conditions.side_force == 0.0:
        return None
    below = np.where(depth > 0.0, 1.0, 0.0)
    area = float(weight @ (below * depth))
    value = conditions.side_force / (at.strength * area)
    return OutputGrowth(
        value=value,
        depth=-value / area * weight * below,
        weight=-value / area * depth * below,
        edge_angle=conditions.load / math.cos(conditions.edge_angle) ** 2 / (at.strength * area),
        load=value / conditions.load,
        strength=-value / at.strength,
    )


OUTPUTS: Final[dict[str, tuple[Callable[[CarveRequest], OutputGrowth | None], float, str]]] = {
    "turn_radius_boot_m": (_radius_at_boot, 1.0, "circle through the edge at the boot and 0.4 m before and behind"),
    "turn_radius_chord_m": (_radius_of_chord, 1.0, "circle through the edge at the boot and both ends of the contact"),
    "turn_radius_median_m": (_radius_median, 1.0, "median over the contact of circles through 0.2 m of the edge"),
    "edge_depth_mm": (_largest_depth, MM, "greatest depth of the edge"),
    "grip_utilisation": (_grip_utilisation, 1.0, "side force over its limit"),
    "deflection_mm": (_deflection_at_boot, MM, "deflection of the base 0.4 m before the boot"),
    "force_per_length_N_per_m": (_largest_force, 1.0, "greatest force per length along the edge"),
    "contact_length_m": (_contact_length, 1.0, "between the ends of the contact, if it reaches neither tip nor tail"),
}
"""By name: computation, unit, definition."""


FORCE_ALONG_EDGE: Final = "force_along_edge_N_per_m"
"""Goal for the force per length at several places."""


def output_growth(name: str, at: CarveRequest) -> OutputGrowth | None:
    """An output and its derivatives, in the unit of its name; None if it does not exist."""
    compute, unit, _ = OUTPUTS[name]
    growth = compute(at)
    return None if growth is None else growth.scaled(unit)
