"""The sledge's equations of motion again: plain NumPy, dense matrices, vectors, no compiled loop.

Derived apart: Hamel's equations for velocities in the sledge's frame, forces by virtual work. A base point at station
s, b across, is at s x + h m + b t from the boot, h its height with the bend w, t = cos φ l - sin φ m; it moves by
m δw - b r δφ.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm, lu_factor, lu_solve

from skisnow.simulate.motion.model import PADDING, Snow, State, World
from skisnow.simulate.sledge import RigidSledge
from skisnow.ski.beam.clamped import ClampedSki

from .reference_snow import Line, Touch, anchor, pressure_sums

FloatArray = npt.NDArray[np.float64]
_POINT, _WEIGHT = np.polynomial.legendre.leggauss(4)


@dataclass
class Motion:
    """Place and turn in space, velocities in the sledge's frame, unknowns of both skis and their rates."""

    place: FloatArray
    turn: FloatArray
    velocity: FloatArray
    bend: FloatArray
    rate: FloatArray

    def speeds(self) -> FloatArray:
        """All velocities in one vector (6 + 2 n)."""
        return np.concatenate([self.velocity, self.rate.ravel()])


def motion_of(state: State) -> Motion:
    """Out of the arrays of the compiled loops."""
    inner = slice(PADDING, -PADDING)
    return Motion(
        state.place.copy(),
        state.turn.copy(),
        state.velocity.copy(),
        state.bend[:, inner].copy(),
        state.bend_rate[:, inner].copy(),
    )


def skew(a: FloatArray) -> FloatArray:
    """a × as a matrix."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


class Body:
    """Sledge and skis as dense matrices (6 + 2 n)."""

    def __init__(self, sledge: RigidSledge, ski: ClampedSki, damping: float) -> None:
        self.ski, self.damping = ski, damping
        angle = sledge.edge_angle
        self.normal = np.array([0.0, math.sin(angle), math.cos(angle)])
        self.lateral = np.array([0.0, math.cos(angle), -math.sin(angle)])
        self.middle = [np.array([0.0, side * sledge.stance_width / 2.0, 0.0]) for side in (1.0, -1.0)]
        self.tip, self.tail = float(ski.ski.station[0]), float(ski.ski.station[-1])
        self.table = np.linspace(self.tail, self.tip, math.ceil((self.tip - self.tail) / 1e-3) + 1)
        at = ski.ski.at(np.clip(self.table, self.tail, self.tip))
        self.columns = [at.width / 2.0, at.base_height]
        self.columns += [np.gradient(column, self.table) for column in self.columns]
        self.size = 6 + 2 * ski.size
        self.mass, self.stiffness = np.zeros((self.size, self.size)), np.zeros((self.size, self.size))
        self._add_points(sledge)
        for k in range(2):
            self._add_ski(k)
        self.total = float(self.mass[0, 0])
        self.first = np.array([self.mass[5, 1], self.mass[3, 2], self.mass[4, 0]])

    def _add_points(self, sledge: RigidSledge) -> None:
        centre = np.array([sledge.centre_of_mass[0], 0.0, sledge.centre_of_mass[1]])
        rows = np.hstack([np.eye(3), -skew(centre)])
        self.mass[:6, :6] += sledge.mass * rows.T @ rows
        self.mass[3:6, 3:6] += np.diag(sledge.inertia)

    def _add_ski(self, k: int) -> None:
        """Kinetic and elastic energy, four Gauss points an element: |v + ω × ρ + n ẇ|², (ω_x - φ̇)², w''², φ'²."""
        ski = self.ski
        for front, back in zip(ski.node[:-1], ski.node[1:], strict=True):
            h = float(front - back)
            for point, weight in zip(_POINT, _WEIGHT, strict=True):
                s = float(0.5 * (front + back) - 0.5 * h * point)
                at = ski.ski.at(s)
                deflection, _, curvature, twist, twist_rate = self.shapes(k, s)
                rho = self.middle[k] + s * np.eye(3)[0] + float(at.base_height) * self.normal
                point_moves = np.outer(self.normal, deflection)
                point_moves[:, :3] += np.eye(3)
                point_moves[:, 3:6] -= skew(rho)
                turns = -twist
                turns[3] += 1.0
                piece = 0.5 * h * weight
                self.mass += piece * float(at.mass_per_length) * point_moves.T @ point_moves
                inertia = float(at.mass_per_length * at.width**2) / 12.0
                self.mass += piece * inertia * np.outer(turns, turns)
                self.stiffness += piece * float(at.bending_stiffness) * np.outer(curvature, curvature)
                self.stiffness += piece * float(at.torsional_stiffness) * np.outer(twist_rate, twist_rate)

    def shapes(self, k: int, s: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Deflection, its first and second derivative towards the tip, twist, its derivative: rows (6 + 2 n)."""
        ski = self.ski
        e = int(np.clip(np.searchsorted(-ski.node, -s, side="left") - 1, 0, len(ski.node) - 2))
        h = float(ski.node[e] - ski.node[e + 1])
        z = float(ski.node[e] - s) / h
        # cubics in z with value and slope (along z, of the element that runs towards the tail) 1 at one end
        cubics = [np.array(c, float) for c in ([1, 0, -3, 2], [0, h, -2 * h, h], [0, 0, 3, -2], [0, 0, -h, h])]
        powers = [np.array([1, z, z * z, z**3]), np.array([0, 1, 2 * z, 3 * z * z]), np.array([0, 0, 2, 6 * z])]
        rows = [np.zeros(self.size) for _ in range(5)]
        base = 6 + k * ski.size
        places = [ski.dof[e, i] for i in (0, 1, 3, 4)]
        for order, scale in enumerate((1.0, -1.0 / h, 1.0 / h**2)):
            for place, cubic in zip(places, cubics, strict=True):
                if place >= 0:
                    rows[order][base + place] = scale * float(cubic @ powers[order])
        for place, value, rate in ((ski.dof[e, 2], 1.0 - z, 1.0 / h), (ski.dof[e, 5], z, -1.0 / h)):
            if place >= 0:
                rows[3][base + place], rows[4][base + place] = value, rate
        return rows[0], rows[1], rows[2], rows[3], rows[4]

    def along(self, s: float) -> tuple[float, float, float, float]:
        """Half width, base height, and their slopes at a station."""
        half, height, flare, slope = (float(np.interp(s, self.table, column)) for column in self.columns)
        return half, height, flare, slope


def free_forces(body: Body, world: World, motion: Motion) -> FloatArray:
    """Gravity, drag and what velocities in a moving frame bring: p' = f - ω × p, L' = τ - ω × L - v × p."""
    speeds = motion.speeds()
    v, omega = motion.velocity[:3], motion.velocity[3:]
    gravity = motion.turn.T @ world.gravity
    momentum = body.mass[:6] @ speeds
    p, turning = momentum[:3], momentum[3:]
    high = np.array([0.0, 0.0, world.drag_height])
    wind = v + np.cross(omega, high)
    drag = -world.drag * float(np.linalg.norm(wind)) * wind
    force = np.zeros(body.size)
    force[:3] = body.total * gravity + drag - np.cross(omega, p)
    force[3:6] = np.cross(body.first, gravity) + np.cross(high, drag) - np.cross(omega, turning) - np.cross(v, p)
    # a bent ski is carried round with the sledge: what the kinetic energy has linear in the bend u
    coupling = body.mass[6:, :3]
    bending = coupling.T @ speeds[6:]
    force[:3] -= np.cross(omega, bending)
    force[3:6] += np.cross(v, bending)
    force[6:] = coupling @ (gravity + np.cross(v, omega))
    return force


@dataclass
class Felt:
    """Generalised force of the snow, minus its tangent, and power (W) of shear, friction and all.

    Of each ski also its stiffness in depth (N/m), and how many lines bear it.
    """

    force: FloatArray
    tangent: FloatArray
    shear: float = 0.0
    friction: float = 0.0
    stiffness: FloatArray = field(default_factory=lambda: np.zeros(2))
    met: FloatArray = field(default_factory=lambda: np.zeros(2))


def felt(body: Body, snow: Snow, spacing: float, lines: tuple[list[Line], list[Line]], motion: Motion) -> Felt:
    """Force of the snow on all lines; notes where each is touched."""
    out = Felt(np.zeros(body.size), np.zeros((body.size, body.size)))
    for k in range(2):
        frame = _Rows(body, k, lines[k][len(lines[k]) // 2], motion)
        for line in lines[k]:
            _section(body, snow, spacing, k, line, motion, frame, out)
    return out


class _Rows:
    """How depth, roll and place across of a ski's straight axis follow from the rigid body: constant for a ski."""

    def __init__(self, body: Body, k: int, line: Line, motion: Motion) -> None:
        n = motion.turn.T @ line.out
        x = np.eye(3)[0]
        t = np.cross(n, x) / np.linalg.norm(np.cross(n, x))
        self.depth, self.depth_s = self._row(body, -n, body.middle[k]), self._row(body, -n, x, moves=False)
        self.across, self.across_s = self._row(body, t, body.middle[k]), self._row(body, t, x, moves=False)
        self.forwards = self._row(body, np.cross(t, n), body.middle[k])
        self.roll = np.zeros(body.size)
        self.roll[3] = -1.0

    @staticmethod
    def _row(body: Body, direction: FloatArray, place: FloatArray, *, moves: bool = True) -> FloatArray:
        row = np.zeros(body.size)
        row[:3] = direction if moves else 0.0
        row[3:6] = np.cross(place, direction)
        return row


def sidedness(tilt: float) -> float:
    """Where the edge lies from the base's middle, over half the width: from -1 to 1, level where the base is level."""
    size = min(abs(tilt), 1.0)
    return math.copysign(3.0 * size**2 - 2.0 * size**3, tilt)


def _section(
    body: Body, snow: Snow, spacing: float, k: int, line: Line, motion: Motion, rows: _Rows, out: Felt
) -> None:
    line.touch = None
    R = motion.turn
    x, across, m = R[:, 0], R @ body.lateral, R @ body.normal
    boot = motion.place + R @ body.middle[k]
    to_line = line.origin - boot
    ahead, n, y = line.ahead, line.out, line.left
    # the station at which the edge that is down crosses the line's plane, for the unbent ski
    gap = to_line @ ahead / (x @ ahead)
    if not body.tail - spacing <= gap <= body.tip + spacing:
        return
    down = sidedness(-float(across @ n) / snow.one_sided)
    s = float(gap)
    for _ in range(2):
        half, height, _, _ = body.along(s)
        s = float(gap - (down * half * (across @ ahead) + height * (m @ ahead)) / (x @ ahead))
    share = np.clip((s - body.tail) / spacing + 0.5, 0.0, 1.0) * np.clip((body.tip - s) / spacing + 0.5, 0.0, 1.0)
    if share <= 0.0:
        return
    s = min(max(s, body.tail), body.tip)
    half, height, flare, slope = body.along(s)
    deflection, deflection_slope, _, twist, twist_slope = body.shapes(k, s)
    unknowns = np.concatenate([np.zeros(6), motion.bend.ravel()])
    height, slope = height + float(deflection @ unknowns), slope + float(deflection_slope @ unknowns)
    phi, phi_slope = float(twist @ unknowns), float(twist_slope @ unknowns)
    t, r = math.cos(phi) * across - math.sin(phi) * m, math.cos(phi) * m + math.sin(phi) * across
    axis = s * x + height * m
    depth = float((to_line - axis) @ n)
    sine = float(-t @ n)
    deep = depth + half * abs(sine)
    side = sidedness(sine / snow.one_sided)
    reach = side * half
    along_edge = x + slope * m + side * flare * t - reach * phi_slope * r
    # before the tip and behind the tail, the edge goes on straight to the line
    missing = float((to_line - axis - reach * t) @ ahead)
    edge = float((axis + reach * t + missing / float(along_edge @ ahead) * along_edge - to_line) @ y)
    if deep <= 0.0:
        line.anchor, line.above = None, (edge, deep)
        return
    base = np.cross(along_edge, t)
    base = base / (base @ n)
    fall = float(base @ y)
    touch = _touch(deep, edge, depth + reach * sine, fall, (reach + half), (half - reach), float(t @ y) + fall * sine)
    sums = pressure_sums(line, touch, snow)
    weight = float(share) * spacing
    force, moment = weight * sums.force, weight * sums.moment
    u = np.cross(n, along_edge)
    per_length = 1.0 / float(np.linalg.norm(u))
    u = u * per_length
    forwards = np.cross(u, n)
    hold = snow.shear_stress * deep * weight
    used = (anchor(line, edge, deep) - edge) / snow.holding
    shear = hold * min(max(used, -1.0), 1.0) * u
    off = moment / force if force > 0.0 else 0.0
    at_edge = R @ body.middle[k] + axis + reach * t
    at_push = at_edge + off * (y - fall * n)
    arm = reach + off * (float(t @ y) + fall * sine)
    push_moves = _moves(R, at_push, m, deflection, arm * r, twist)
    edge_moves = _moves(R, at_edge, m, deflection, reach * r, twist)
    speeds = motion.speeds()
    sliding = float(forwards @ push_moves @ speeds)
    resist = force * float(base @ forwards) + phi_slope * moment / (1.0 - sine**2) * per_length
    rub = -(snow.friction + snow.friction_by_speed * abs(sliding)) * force * sliding
    rub /= math.sqrt(sliding**2 + snow.friction_speed**2)
    push = force * n + (snow.compaction * resist + rub) * forwards
    out.force += push @ push_moves + shear @ edge_moves
    out.shear += float(shear @ edge_moves @ speeds)
    out.friction += rub * sliding
    line.touch = touch
    # tangent: the depth ε(x) = depth + x/cos θ (roll + twist), x from the ski's middle; the edge's place across
    k0, k1, k2 = (weight * value for value in sums.stiffness)
    out.stiffness[k] += k0
    out.met[k] += force > 0.0
    shift, secant = reach * float(t @ y), 1.0 / math.sqrt(1.0 - sine**2)
    k1, k2 = (k1 + shift * k0) * secant, (k2 + 2.0 * shift * k1 + shift**2 * k0) * secant**2
    # a line feels the ski go along its base and its edge: forwards the depth grows, and the edge lies aside
    rise = float(base @ forwards)
    aside = float(along_edge @ np.cross(n, x)) / float(along_edge @ x)
    sinks = rows.depth + s * rows.depth_s - rise * rows.forwards - float((n + rise * forwards) @ m) * deflection
    rolls = rows.roll + twist
    crosses = rows.across + s * rows.across_s - aside * rows.forwards + float(u @ m) * deflection
    out.tangent += k0 * np.outer(sinks, sinks) + k2 * np.outer(rolls, rolls)
    out.tangent += k1 * (np.outer(sinks, rolls) + np.outer(rolls, sinks))
    if abs(used) < 1.0 + 1e-6:  # at rest with all of its grip in use it holds
        out.tangent += hold / snow.holding * np.outer(crosses, crosses)


def _moves(
    R: FloatArray, place: FloatArray, m: FloatArray, deflection: FloatArray, arm: FloatArray, twist: FloatArray
) -> FloatArray:
    """Velocity in space of a base point (3, 6 + 2 n) by the generalised velocities."""
    matrix = np.outer(m, deflection) - np.outer(arm, twist)
    matrix[:, :3] += R
    matrix[:, 3:6] -= skew(place) @ R
    return matrix


def _touch(deep: float, edge: float, depth: float, fall: float, before: float, behind: float, wide: float) -> Touch:
    """From the right edge or the waterline to the left edge or the waterline."""
    low, high = edge - before / wide, edge + behind / wide
    if fall > 1e-12:
        low = max(low, edge - depth / fall)
    elif fall < -1e-12:
        high = min(high, edge - depth / fall)
    return Touch(low, high, edge, depth, fall, deep)


def moved(motion: Motion, change: FloatArray, speeds: FloatArray) -> Motion:
    """After a change of place given in the sledge's frame, the turn as a rotation vector."""
    return Motion(
        motion.place + motion.turn @ change[:3],
        motion.turn @ np.asarray(expm(skew(change[3:6]))),
        speeds[:6].copy(),
        motion.bend + change[6:].reshape(2, -1),
        speeds[6:].reshape(2, -1).copy(),
    )


def ros2_step(
    body: Body,
    snow: Snow,
    world: World,
    spacing: float,
    lines: tuple[list[Line], list[Line]],
    motion: Motion,
    start: Felt,
    h: float,
) -> Motion:
    """One step of Verwer and others (1999) for y = (x, v), the whole of I - γhJ one dense matrix; `start`: felt there.

    J = ((0, 1), (-M⁻¹(K + C), -M⁻¹D)); k₁ and k₂ follow from f(y) and f(y + h k₁) - 2 k₁; y ← y + h (3 k₁ + k₂)/2.
    """
    n = body.size
    D = body.damping * body.stiffness
    J = np.zeros((2 * n, 2 * n))
    J[:n, n:] = np.eye(n)
    J[n:, :n] = -np.linalg.solve(body.mass, body.stiffness + start.tangent)
    J[n:, n:] = -np.linalg.solve(body.mass, D)
    matrix = lu_factor(np.eye(2 * n) - (1.0 - math.sqrt(0.5)) * h * J)

    def slope(at: Motion, snow_force: FloatArray, turned: FloatArray) -> FloatArray:
        speeds = at.speeds()
        rates = speeds.copy()
        rates[:3] += np.cross(turned, speeds[:3])
        rates[3:6] += 0.5 * np.cross(turned, speeds[3:6])
        bend = np.concatenate([np.zeros(6), at.bend.ravel()])
        force = free_forces(body, world, at) + snow_force - body.stiffness @ bend - D @ speeds
        return np.concatenate([rates, np.linalg.solve(body.mass, force)])

    speeds = motion.speeds()
    k1 = lu_solve(matrix, slope(motion, start.force, np.zeros(3)))
    middle = moved(motion, h * k1[:n], speeds + h * k1[n:])
    touches = [(line, line.touch, line.anchor, line.above) for side in lines for line in side]
    stage = felt(body, snow, spacing, lines, middle)
    for line, touch, held, above in touches:  # the snow remembers accepted states alone
        line.touch, line.anchor, line.above = touch, held, above
    k2 = lu_solve(matrix, slope(middle, stage.force, h * k1[3:6]) - 2.0 * k1)
    total = 0.5 * h * (3.0 * k1 + k2)
    return moved(motion, total[:n], speeds + total[n:])
