"""The equilibrium of a carve in plain NumPy, slow and otherwise than programs do it: their examiner.

Nothing is shared with any program but the ski's tables. No elements: each end of the ski is a cantilever whose bending
moment M(s) = ∫ q (t - s) dt and torque T(s) = ∫ m dt follow from the snow's load by quadrature, and whose deflection
follows from w″ = M/EI, φ′ = T/GJ by quadrature. The unknowns are curvature and rate of twist at knots, straight between
them. Across the ski the pressure is summed over many points, and the groove is a running maximum from tip to tail on
those points. Newton's method with differences, on snow that hardens and remembers step by step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


class Sections(Protocol):
    """Of a ski at some stations (m, N m²)."""

    @property
    def width(self) -> FloatArray: ...
    @property
    def base_height(self) -> FloatArray: ...
    @property
    def bending_stiffness(self) -> FloatArray: ...
    @property
    def torsional_stiffness(self) -> FloatArray: ...


class Ski(Protocol):
    """Tables from tip to tail."""

    @property
    def station(self) -> FloatArray: ...
    def at(self, station: npt.ArrayLike, /) -> Sections:
        """Sections anywhere between tip and tail."""


class Penetration(Protocol):
    """A law for the pressure."""

    def stress_and_energy(self, depth: FloatArray, deepest: FloatArray, angle: FloatArray, /) -> FloatArray:
        """Stress (N/m²) first."""


class Strength(Protocol):
    """A law for the strength of the snow at the edge."""

    def failure_stress(self, depth: FloatArray | float, angle: FloatArray | float, /) -> FloatArray:
        """S_f (N/m²)."""


ROOM = 1.6
"""Points across reach this often to the greatest depth's waterline."""


@dataclass(frozen=True)
class Case:
    """One question, in SI."""

    ski: Ski
    hardness: float
    edge_angle: float
    load: float
    unloading_ratio: float = 1.0
    moment: float = 0.0
    clamp_length: float = 0.0
    side_force_bending: bool = True
    twist: bool = True
    by_reaction: bool = False  # the side force goes along the edge as the snow's force, not as the depth
    boot_is_free: bool = False  # the moment is all that the boot takes about the ski's cross axis
    penetration: Penetration | None = None  # in place of hardness and ratio, from which the search comes to it
    law_share: float = 0.0  # of the pressure, on the way
    shear: Strength | None = None  # of whose strength the edge draws the same share everywhere
    knots: int = 30  # of each end
    along: int = 8  # intervals between knots
    across: int = 160


@dataclass(frozen=True)
class Answer:
    """What came out, along the ski (m, N/m, rad)."""

    station: FloatArray  # tip to tail
    edge_depth: FloatArray
    force_per_length: FloatArray
    deflection: FloatArray
    twist: FloatArray
    edge_line: FloatArray
    boot_depth: float

    def radius_at_boot(self) -> float:
        """Circle through the edge line at 0.4 m, 0 and -0.4 m."""
        return self.radius_through(0.4, -0.4)

    def radius_through(self, front: float, rear: float) -> float:
        """Circle through the edge line there and at the boot."""
        points = np.array([front, 0.0, rear])
        y = np.interp(points, self.station[::-1], self.edge_line[::-1])
        # (x - a)² + (y - b)² = r²: three equations, linear in a, b and r² - a² - b²
        a, b, c = np.linalg.solve(np.column_stack([2.0 * points, 2.0 * y, np.ones(3)]), points**2 + y**2)
        return float(math.sqrt(c + a**2 + b**2) * math.copysign(1.0, b - y[1]))

    def contact_ends(self) -> tuple[float, float]:
        """Front and rear place where the edge comes through the surface (m)."""
        below = np.flatnonzero(self.edge_depth > 0.0)
        ends = []
        for inner, step in ((below[0], -1), (below[-1], 1)):
            outer = inner + step
            if not 0 <= outer < len(self.station):
                ends.append(float(self.station[inner]))
                continue
            e0, e1 = self.edge_depth[inner], self.edge_depth[outer]
            ends.append(float(self.station[inner] + (self.station[outer] - self.station[inner]) * e0 / (e0 - e1)))
        return ends[0], ends[1]


class _End:
    """One end of the ski, from the clamp outwards: x = distance from the clamp's end."""

    def __init__(self, case: Case, sign: float) -> None:
        half = case.clamp_length / 2.0
        reach = abs(float(case.ski.station[0 if sign > 0 else -1])) - half
        count = case.knots * case.along + 1
        self.x = np.linspace(0.0, reach, count)
        self.station = sign * (half + self.x)
        self.knot = np.linspace(0.0, reach, case.knots + 1)
        at_knots = case.ski.at(sign * (half + self.knot))
        self.bending_stiffness, self.torsional_stiffness = at_knots.bending_stiffness, at_knots.torsional_stiffness
        hats = np.column_stack([np.interp(self.x, self.knot, row) for row in np.eye(case.knots + 1)])
        slope = _integral(hats, self.x)
        self.deflection_of = _integral(slope, self.x)
        self.twist_of = slope
        self.at_knots = np.arange(case.knots + 1) * case.along

    def moment_and_torque(self, normal: FloatArray, turning: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Bending moment and torque at the knots of a load per length given at x."""
        shear = _integral(normal[::-1], self.x)[::-1]
        moment = _integral(shear[::-1], self.x)[::-1]
        torque = _integral(turning[::-1], self.x)[::-1]
        return moment[self.at_knots], torque[self.at_knots]


def _integral(values: FloatArray, x: FloatArray) -> FloatArray:
    """Running integral from the first point; trapezoids on many points."""
    step = x[1] - x[0]
    total = np.zeros_like(values)
    total[1:] = np.cumsum(0.5 * step * (values[1:] + values[:-1]), axis=0)
    return total


class _Equations:
    """Residuals of curvature, rate of twist, load, moment and side force for an unknown vector."""

    def __init__(self, case: Case, deepest: float) -> None:
        self.case = case
        self.front, self.rear = _End(case, 1.0), _End(case, -1.0)
        half = case.clamp_length / 2.0
        clamp_points = math.ceil(case.clamp_length / (self.front.x[1] - self.front.x[0])) + 1 if half > 0.0 else 0
        middle = np.linspace(half, -half, clamp_points)[1:-1] if clamp_points else np.empty(0)
        self.station = np.concatenate([self.front.station[::-1], middle, self.rear.station[(half == 0.0) * 1 :]])
        at = case.ski.at(self.station)
        self.width, self.base_height = at.width, at.base_height
        gaps = -np.diff(self.station)
        self.weight = np.zeros_like(self.station)
        self.weight[:-1] += gaps / 2.0
        self.weight[1:] += gaps / 2.0
        waterline = ROOM * deepest / math.tan(case.edge_angle) if case.edge_angle > 0.0 else math.inf
        widest = float(self.width.max()) * math.cos(case.edge_angle)
        self.place = np.linspace(0.0, min(waterline, widest), case.across)

    def split(self, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        k = self.case.knots + 1
        return z[: 2 * k], z[2 * k : 4 * k] * float(self.case.twist), z[4 * k :]

    def shape(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Deflection and twist at the stations."""
        k = self.case.knots + 1
        curvature, rate, _ = self.split(z)
        ahead, behind = self.front.deflection_of @ curvature[:k], self.rear.deflection_of @ curvature[k:]
        turn_ahead, turn_behind = self.front.twist_of @ rate[:k], self.rear.twist_of @ rate[k:]
        return self.joined(ahead, behind), self.joined(turn_ahead, turn_behind)

    def joined(self, ahead: FloatArray, behind: FloatArray) -> FloatArray:
        clamped = len(self.station) - len(ahead) - len(behind)
        if clamped < 0:
            return np.concatenate([ahead[::-1], behind[1:]])
        return np.concatenate([ahead[::-1], np.zeros(clamped), behind])

    def snow(self, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Edge depth, force per length, its first moment about the middle line (growth of the angle), angle."""
        case = self.case
        depth0, slope, _ = self.split(z)[2]
        deflection, twist = self.shape(z)
        angle = case.edge_angle + twist
        lift = math.cos(case.edge_angle) * (self.base_height + deflection)
        edge = depth0 + slope * self.station - lift + self.width / 2.0 * np.sin(angle)
        depth = edge[:, None] - self.place[None, :] * np.tan(angle)[:, None]
        groove = np.full_like(depth, -np.inf)
        groove[1:] = np.maximum.accumulate(depth[:-1], axis=0)
        stiffening = (case.unloading_ratio - 1.0) * np.maximum(groove - depth, 0.0)
        stiffening[~np.isfinite(stiffening)] = 0.0
        pressure = case.hardness * np.maximum(depth - stiffening, 0.0)
        if case.penetration is not None and case.law_share > 0.0:
            deepest = np.maximum(np.maximum(groove, depth), 0.0).ravel()
            angles = np.repeat(angle, depth.shape[1])
            by_law = case.penetration.stress_and_energy(depth.ravel(), deepest, angles)[0].reshape(depth.shape)
            pressure = (1.0 - case.law_share) * pressure + case.law_share * by_law
        pressure *= np.clip(
            (self.width * np.cos(angle))[:, None] / (self.place[1] - self.place[0])
            - np.arange(len(self.place))[None, :]
            + 0.5,
            0.0,
            1.0,
        )
        step = self.place[1] - self.place[0]
        share = np.full(len(self.place), step)
        share[[0, -1]] = step / 2.0
        force = pressure @ share
        lever = (self.width / 2.0 * np.cos(angle))[:, None] - self.place[None, :]
        return edge, force, -(pressure * lever) @ share, angle

    def strength(self, edge: FloatArray, angle: FloatArray) -> FloatArray:
        """Of the edge, over that of 1 mm at the boot's edge angle."""
        law = self.case.shear
        if law is None:
            return np.ones_like(edge)
        return law.failure_stress(edge, angle) / law.failure_stress(1e-3, self.case.edge_angle)

    def residual(self, z: FloatArray) -> FloatArray:
        case = self.case
        curvature, rate, border = self.split(z)
        edge, force, moment, angle = self.snow(z)
        strength = border[2] * self.strength(edge, angle)
        shear = border[2] * force if case.by_reaction else np.maximum(edge, 0.0) * strength
        # an edge on the other side that is in the snow, too, holds its own depth of the shear
        other = (
            np.zeros_like(edge) if case.by_reaction else np.maximum(edge - self.width * np.sin(angle), 0.0) * strength
        )
        bends = float(case.side_force_bending)
        normal = math.cos(case.edge_angle) * force + bends * math.sin(case.edge_angle) * shear
        turning = moment - bends * self.width / 2.0 * np.sin(angle) * (shear - 2.0 * other)
        k, n = case.knots + 1, len(self.front.x)
        m0, t0 = self.front.moment_and_torque(normal[:n][::-1], turning[:n][::-1])
        m1, t1 = self.rear.moment_and_torque(normal[-len(self.rear.x) :], turning[-len(self.rear.x) :])
        bent = curvature - np.concatenate([m0 / self.front.bending_stiffness, m1 / self.rear.bending_stiffness])
        turned = rate - np.concatenate([t0 / self.front.torsional_stiffness, t1 / self.rear.torsional_stiffness])
        turned = turned if case.twist else z[2 * k : 4 * k]
        side = case.load * math.tan(case.edge_angle)
        whole = math.cos(case.edge_angle) * force + math.sin(case.edge_angle) * shear
        pitching = whole if case.boot_is_free else force
        loads = [
            (self.weight @ force) / case.load - 1.0,
            (self.weight @ (pitching * self.station) - case.moment) / case.load,
            (self.weight @ shear - side) / case.load if side > 0.0 else border[2],
        ]
        return np.concatenate([bent, turned, np.array(loads)])


def _tangent(equations: _Equations, z: FloatArray, scale: FloatArray, residual: FloatArray) -> FloatArray:
    columns = []
    for i in range(len(z)):
        ahead = z.copy()
        ahead[i] += scale[i]
        columns.append((equations.residual(ahead) - residual) / scale[i])
    return np.column_stack(columns)


def _newton(equations: _Equations, z: FloatArray, scale: FloatArray) -> tuple[FloatArray, bool]:
    """Newton's method, tangent by differences and kept while it serves, steps halved until the residual falls."""
    residual = equations.residual(z)
    tangent: FloatArray | None = None
    for _ in range(200):
        size = float(np.linalg.norm(residual))
        if size < 1e-9:
            return z, True
        fresh = tangent is None
        if tangent is None:
            tangent = _tangent(equations, z, scale, residual)
        step = np.linalg.lstsq(tangent, -residual, rcond=None)[0]
        share, enough = 1.0, 1e-3 if fresh else 0.9
        trial = equations.residual(z + step)
        while np.linalg.norm(trial) > (1.0 - 0.2 * share) * size and share > enough:
            share /= 2.0
            trial = equations.residual(z + share * step)
        if np.linalg.norm(trial) < size:
            z, residual = z + share * step, trial
        elif fresh:
            return z, size < 1e-7
        if np.linalg.norm(trial) > 0.3 * size:
            tangent = None
    return z, False


def solved(case: Case) -> Answer:
    """Harden the snow from a thousandth, then let it remember, in as many steps as needed."""
    k = case.knots + 1
    deepest = 0.08
    z = np.zeros(4 * k + 3)
    wedge = math.sqrt(2.0 * case.load * math.tan(max(case.edge_angle, 0.01)) / (case.hardness * 1e-3 * 1.4))
    z[4 * k] = min(wedge, 0.05) - 0.03 * math.sin(case.edge_angle)
    z[4 * k + 2] = 1e4
    scale = np.concatenate([np.full(2 * k, 1e-6), np.full(2 * k, 1e-6), [1e-8, 1e-8, 1.0]])
    for share in np.logspace(-3.0, 0.0, 7):
        soft = replace(case, hardness=case.hardness * share, unloading_ratio=1.0)
        equations = _Equations(soft, deepest)
        z, converged = _newton(equations, z, scale)
        assert converged, f"reference failed at {share} of the hardness"
        deepest = float(equations.snow(z)[0].max())
    ratios = np.geomspace(1.0, case.unloading_ratio, 1 + math.ceil(4.0 * math.log10(case.unloading_ratio)))[1:]
    for ratio in ratios:
        equations = _Equations(replace(case, unloading_ratio=float(ratio)), deepest)
        z, converged = _newton(equations, z, scale)
        assert converged, f"reference failed at the unloading ratio {ratio}"
        deepest = float(equations.snow(z)[0].max())
    for law_share in (0.5, 1.0) if case.penetration is not None else ():
        equations = _Equations(replace(case, law_share=law_share), deepest)
        z, converged = _newton(equations, z, scale)
        assert converged, f"reference failed at {law_share} of the law"
        deepest = float(equations.snow(z)[0].max())
    return _answer(equations, z)


def _answer(equations: _Equations, z: FloatArray) -> Answer:
    case = equations.case
    edge, force, _, angle = equations.snow(z)
    assert edge.max() < equations.place[-1] * math.tan(case.edge_angle) or case.edge_angle == 0.0
    deflection, twist = equations.shape(z)
    line = equations.width / 2.0 * np.cos(angle) + (equations.base_height + deflection) * math.sin(case.edge_angle)
    boot_depth = float(z[4 * (case.knots + 1)])
    return Answer(equations.station, edge, force, deflection, twist, line, boot_depth)
