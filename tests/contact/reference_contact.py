"""A runner in snow again: plain NumPy, one line at a time, all that was ever pressed kept as a list of segments.

Derived apart from the core: points of the base as vectors, ground by its definition (the deepest of all segments), the
pressure integrated by Gauss's points between all places where it may bend.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner, SnowField
from skisnow.forces.shear import MachiningShear
from tests.present import present

from .reference_pressure import pressure


@dataclass
class Hold:
    """One edge on a line at the last accepted pose: place, depth, skew, and where it held if in the snow."""

    place: float
    depth: float
    skew: float
    anchor: float = math.nan


@dataclass
class Line:
    """Across the path: origin, directions ahead, left and out of the snow; what was pressed; how both edges stood."""

    origin: FloatArray
    ahead: FloatArray
    out: FloatArray
    pressed: list[tuple[float, float, float, float]] = field(default_factory=list)
    holds: tuple[Hold, Hold] | None = None
    passed: tuple[float, float] | None = None  # along the ski at the last accepted pose, and how the depth grew ahead
    slipped: float = 0.0
    stuck: tuple[float, float, float] | None = None  # along the ski and across where friction is 0; the point's arm
    strength: float = 0.0  # of edges that hold (Pa)

    @property
    def left(self) -> FloatArray:
        return np.cross(self.out, self.ahead)


@dataclass
class Edge:
    """Left or right edge of a section: place on the line, depth, reach, position, across and off the edge.

    skew: growth of the place for each metre that the line moves ahead.
    """

    place: float
    depth: float
    reach: float
    at: FloatArray
    across: FloatArray
    off: FloatArray
    skew: float


@dataclass
class Touch:
    """Where a base meets a line: place and depth of the grip, fall of the depth, wet from and to."""

    place: float
    depth: float
    fall: float
    low: float
    high: float

    def base(self, y: FloatArray | float) -> FloatArray | float:
        return self.depth + self.fall * (y - self.place)


@dataclass
class Pose:
    """Of a boot; beam as rows of deflection, slope towards the tail, twist."""

    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    beam: FloatArray | None = None
    rate: FloatArray | None = None


class ReferenceRunner:
    """A runner over lines that are laid every ``spacing`` along it at its first pose."""

    def __init__(self, runner: Runner, snow: SnowField, pose: Pose, spacing: float) -> None:
        self.runner, self.snow, self.spacing = runner, snow, spacing
        self.table = np.linspace(runner.tail, runner.tip, max(2, math.ceil((runner.tip - runner.tail) / 1e-3)) + 1)
        rows = [np.interp(self.table, runner.position[::-1], c[::-1]) for c in (runner.half_width, runner.base_height)]
        self.columns = [*rows, *(np.gradient(row, self.table) for row in rows)]
        self.lines = [self._laid(pose, s) for s in self._stations()]

    def _stations(self) -> list[float]:
        """The core begins at the boot and lays 0.12 m beyond tip and tail, each line one spacing from the last."""
        ahead = range(math.ceil((self.runner.tip + 0.12) / self.spacing - 1e-9) + 1)
        behind = range(1, math.ceil((0.12 - self.runner.tail) / self.spacing - 1e-9) + 1)
        return [-n * self.spacing for n in reversed(behind)] + [n * self.spacing for n in ahead]

    def _laid(self, pose: Pose, s: float) -> Line:
        x = pose.rotation[:, 0]
        point = pose.position + s * x
        # on the surface z = 0 at this position along the ski
        level = x[0] ** 2 + x[1] ** 2
        along = point[2] * x[2] / level
        origin = np.array([point[0] + along * x[0], point[1] + along * x[1], 0.0])
        ahead = np.array([x[0], x[1], 0.0])
        return Line(origin, ahead / np.linalg.norm(ahead), np.array([0.0, 0.0, 1.0]))

    def force(self, pose: Pose, dt: float) -> tuple[FloatArray, FloatArray]:
        """Wrench (6,) about the boot and beam loads (nodes, 3), a time (s) after the last update."""
        wrench, loads = np.zeros(6), np.zeros((2 if self.runner.nodes is None else len(self.runner.nodes), 3))
        for section in self._sections(pose):
            is_base_down = section.edges[0].place > section.edges[1].place
            if section.share > 0.0 and section.deepest > 0.0 and is_base_down:
                section.add(wrench, loads, dt)
        return wrench, loads

    def _sections(self, pose: Pose) -> list[_Section]:
        """Each stands for the ski halfway to its neighbours, between tail and tip."""
        sections = [_Section(self, line, pose) for line in self.lines]
        station = np.array([section.station for section in sections])
        half = self.spacing / 2.0
        borders = [station[0] - half, *(station[1:] + station[:-1]) / 2.0, station[-1] + half]
        for section, share in zip(sections, np.diff(np.clip(borders, self.runner.tail, self.runner.tip)), strict=True):
            section.share = float(share)
        return sections

    def update(self, pose: Pose) -> None:
        reach = self.snow.shear_displacement
        for section in self._sections(pose):
            line, touch = section.line, section.touch
            if section.deepest <= 0.0:
                line.stuck = None
            if section.share <= 0.0:
                line.holds, line.strength = None, 0.0
                continue
            for k, edge in enumerate(section.edges):
                before = section.stood(k) if section.deepest > 0.0 else None
                if before is not None and abs(before.place - edge.place) > 1e-12:
                    line.pressed.append((before.place, before.depth, edge.place, edge.depth))
            if section.deepest > 0.0 and touch.high > touch.low:
                line.pressed.append(
                    (touch.low, float(touch.base(touch.low)), touch.high, float(touch.base(touch.high)))
                )
                line.pressed += itertools.starmap(lambda a, b: (*a, *b), itertools.pairwise(section.deepest_on_way()))
            line.passed = (section.on_ski, section.climb) if section.deepest > 0.0 else None
            holds, slipped = [], 0.0
            for k, edge in enumerate(section.edges):
                hold = Hold(edge.place, edge.depth, edge.skew)
                if edge.depth > 0.0:
                    held = section.anchor(k)
                    hold.anchor = held
                    for place in (section.farthest(k), edge.place):
                        hold.anchor = float(np.clip(hold.anchor, place - reach, place + reach))
                    slipped = max(slipped, abs(hold.anchor - held))
                holds.append(hold)
            line.strength = section.strength()[0] if section.deepest > 0.0 else 0.0
            line.slipped += slipped
            line.holds = holds[0], holds[1]
            if section.deepest > 0.0:
                line.stuck = section.held_back()


class _Section:
    share: float

    def __init__(self, whole: ReferenceRunner, line: Line, pose: Pose) -> None:
        self.whole, self.line, self.pose = whole, line, pose
        self.x, _, up = pose.rotation.T
        n, y, ahead = line.out, line.left, line.ahead
        to_line = line.origin - pose.position
        self.gap = gap = float(to_line @ ahead / (self.x @ ahead))
        tail, tip = whole.runner.tail, whole.runner.tip
        # The grip g(s) = s x + h(s) up + q(s) t(s), q = side W, lies over the line where (to_line - g(s))·ahead = 0.
        # Newton's method with dg/ds at a fixed side, from the straight axis.
        s = gap
        for _ in range(3):
            on_ski = min(max(s, tail), tip)
            self._shape(on_ski)
            side = self._grip(to_line, n, on_ski)
            grip = on_ski * self.x + self.height * up + side * self.half * self.t
            missed = float((to_line - grip) @ ahead / (self._direction(side) @ ahead))
            s = on_ski + min(max(missed, -0.1), 0.1)
        self.station = s
        self.on_ski = s = min(max(s, tail), tip)
        self._shape(s)
        axis = s * self.x + self.height * up
        depth, self.sine = float((to_line - axis) @ n), float(-self.t @ n)
        self.reach = side * self.half
        along = self._direction(side)
        self.grip_at = axis + self.reach * self.t
        place = self._crossing(to_line, self.grip_at, along)
        self.base = np.cross(along, self.t) / float(np.cross(along, self.t) @ n)
        fall = float(self.base @ y)
        self.wide = float(self.t @ y) + fall * self.sine
        grip_depth = depth + self.reach * self.sine
        self.edges = []
        for to in (1.0, -1.0):
            at, direction = axis + to * self.half * self.t, self._direction(to)
            crossing = self._crossing(to_line, at, direction)
            edge_depth = grip_depth + fall * (crossing - place)
            across_edge = np.cross(n, direction)
            across_edge /= float(np.linalg.norm(across_edge))
            off = n - float(n @ direction) / float(direction @ direction) * direction
            skew = float(direction @ y / (direction @ ahead))
            self.edges.append(Edge(crossing, edge_depth, to * self.half, at, across_edge, off / float(off @ n), skew))
        self.deepest = max(edge.depth for edge in self.edges)
        low, high = self.edges[1].place, self.edges[0].place
        if fall > 1e-12:
            low = max(low, place - grip_depth / fall)
        elif fall < -1e-12:
            high = min(high, place - grip_depth / fall)
        self.touch = Touch(place, grip_depth, fall, low, high)
        u = np.cross(n, along)
        self.per_length = 1.0 / float(np.linalg.norm(u))
        self.u, self.up = u * self.per_length, up
        self.climb = float(self.base @ np.cross(self.u, n))

    def _shape(self, s: float) -> None:
        """The bent base at a station: half width, height, their slopes, twist, directions across and off the base."""
        _, across, up = self.pose.rotation.T
        self.half, height, self.flare, slope = (
            float(np.interp(s, self.whole.table, column)) for column in self.whole.columns
        )
        self._bend(s)
        self.height = height + float(self.deflects @ self.beam)
        self.slope = slope + float(self.deflects_s @ self.beam)
        phi, self.twist_s = float(self.twists @ self.beam), float(self.twists_s @ self.beam)
        self.t, self.r = math.cos(phi) * across - math.sin(phi) * up, math.cos(phi) * up + math.sin(phi) * across

    def _grip(self, to_line: FloatArray, n: FloatArray, s: float) -> float:
        """Mean place of the edges by their depths in the snow, over the half width."""
        up = self.pose.rotation[:, 2]
        along = self.x + self.slope * up
        middle = to_line - s * self.x - self.height * up
        # depths of the base's plane where the edges, parallel to its middle, cross the line
        depths = []
        for to in (1.0, -1.0):
            to_edge = middle - to * self.half * self.t
            depths.append(float((to_edge - float(to_edge @ self.line.ahead / (along @ self.line.ahead)) * along) @ n))
        left, right = (max(each, 0.0) for each in depths)
        return (left - right) / (left + right) if left + right > 0.0 else float(np.sign(depths[0] - depths[1]))

    def _direction(self, side: float) -> FloatArray:
        """Along the base at a place across, over the half width."""
        return (
            self.x
            + self.slope * self.pose.rotation[:, 2]
            + side * self.flare * self.t
            - side * self.half * self.twist_s * self.r
        )

    def _crossing(self, to_line: FloatArray, at: FloatArray, direction: FloatArray) -> float:
        """Place on the line at which a point of the base crosses it along a direction."""
        way = float((to_line - at) @ self.line.ahead / (direction @ self.line.ahead))
        return float((at + way * direction - to_line) @ self.line.left)

    def _bend(self, s: float) -> None:
        nodes = self.whole.runner.nodes
        count = 2 if nodes is None else len(nodes)
        self.deflects, self.deflects_s, self.twists, self.twists_s = (np.zeros(3 * count) for _ in range(4))
        self.beam = np.zeros(3 * count) if self.pose.beam is None else self.pose.beam.ravel()
        self.rate = np.zeros(3 * count) if self.pose.rate is None else self.pose.rate.ravel()
        if nodes is None:
            return
        e = int(np.clip(np.searchsorted(-nodes, -s, side="left") - 1, 0, count - 2))
        h = float(nodes[e] - nodes[e + 1])
        z = float(nodes[e] - s) / h
        place = [3 * e, 3 * e + 1, 3 * e + 3, 3 * e + 4]
        cubics = np.array([[1, 0, -3, 2], [0, h, -2 * h, h], [0, 0, 3, -2], [0, 0, -h, h]])
        self.deflects[place] = cubics @ [1, z, z * z, z**3]
        self.deflects_s[place] = -(cubics @ [0, 1, 2 * z, 3 * z * z]) / h
        self.twists[[3 * e + 2, 3 * e + 5]] = 1.0 - z, z
        self.twists_s[[3 * e + 2, 3 * e + 5]] = 1.0 / h, -1.0 / h

    def deepest_on_way(self) -> list[tuple[float, float]]:
        """Places and depths of the base where it was deepest between two poses, five places, or none.

        At each share of the width the depth d(w), 0 <= w <= 1, has both ends' values, and d' changes by the climb.
        """
        deeper = 0 if self.edges[0].depth > self.edges[1].depth else 1
        if self.stood(deeper) is None or self.line.passed is None or self.edges[deeper].depth <= 0.0:
            return []
        slope_change = (self.line.passed[0] - self.on_ski) * (self.line.passed[1] - self.climb)
        if slope_change >= 0.0:
            return []
        (before, rise), (now, fall) = (self.unbent(s) for s in (self.line.passed[0], self.on_ski))
        mean = 0.5 * (self.line.passed[0] - self.on_ski) * (rise + fall)
        bent = (before - now - mean) * float(self.pose.rotation[:, 2] @ self.line.out)  # 0 for a parabola
        width = [edge.place for edge in self.edges[::-1]]
        fallen = [edge.depth - hold.depth for edge, hold in zip(self.edges, present(self.line.holds), strict=True)]
        moved = [hold.place - edge.place for edge, hold in zip(self.edges, present(self.line.holds), strict=True)]
        # d'(w) = 0 at 1 - since, which is linear across: only the places that pass their deepest on the way
        since = [0.5 + (each - bent) / slope_change for each in reversed(fallen)]
        slope = (since[1] - since[0]) / (width[1] - width[0])
        ends = sorted(width[0] + (each - since[0]) / slope for each in (0.0, 1.0)) if slope else [-math.inf, math.inf]
        if not slope and not 0.0 < since[0] < 1.0:
            return []
        low, high = max(self.touch.low, ends[0]), min(self.touch.high, ends[1])
        if not low < high:
            return []
        out = []
        for y in np.linspace(low, high, 5):
            back = since[0] + slope * (y - width[0])
            aside = float(np.interp(y, width, moved[::-1]))
            out.append((y + back * aside, float(self.touch.base(y)) - 0.5 * slope_change * back**2))
        return out

    def farthest(self, k: int) -> float:
        """Place at which an edge turned back between two poses, by the parabola with its skews; or its end."""
        before, edge = self.stood(k), self.edges[k]
        if before is None or self.line.passed is None:
            return edge.place
        slope_change = (self.line.passed[0] - self.on_ski) * (before.skew - edge.skew)
        share = 0.5 - (edge.place - before.place) / slope_change if slope_change else 0.0
        if not 0.0 < share < 1.0:
            return edge.place
        slope = edge.place - before.place - 0.5 * slope_change
        return before.place + slope * share + 0.5 * slope_change * share**2

    def unbent(self, s: float) -> tuple[float, float]:
        """Height and slope of the unbent base at a station."""
        _, height, _, slope = (float(np.interp(s, self.whole.table, column)) for column in self.whole.columns)
        return height, slope

    def stood(self, k: int) -> Hold | None:
        """An edge at the last accepted pose, if it was in the snow."""
        if self.line.holds is None or self.line.holds[k].depth <= 0.0:
            return None
        return self.line.holds[k]

    def anchor(self, k: int) -> float:
        """Where an edge holds: where it did, or where it came through the surface."""
        edge = self.edges[k]
        if self.line.holds is None:
            return edge.place
        before = self.line.holds[k]
        if before.depth > 0.0:
            return edge.place + self._eased(before, edge)
        return edge.place + (edge.place - before.place) * edge.depth / (before.depth - edge.depth)

    def _eased(self, before: Hold, edge: Edge) -> float:
        """A strength that rises leaves the force as it is; a cut that rises leaves its face."""
        displacement = before.anchor - edge.place
        if not self.line.strength:
            return displacement
        strength, thrust = self.strength()
        displacement += (before.anchor - before.place) * (min(1.0, self.line.strength / strength) - 1.0)
        left = max(thrust / strength * (before.depth - edge.depth), 0.0)
        return math.copysign(max(abs(displacement) - left, 0.0), displacement)

    def held(self) -> list[FloatArray]:
        """Force of the snow on each edge: of its wall against a motion outwards, of the base's slope inwards."""
        strength, thrust = self.strength()
        out = []
        for k, edge in enumerate(self.edges):
            deep, other = max(edge.depth, 0.0), max(self.edges[1 - k].depth, 0.0)
            used = (self.anchor(k) - edge.place) / self.whole.snow.shear_displacement if deep > 0.0 else 0.0
            used = min(max(used, -1.0), 1.0)
            is_inwards = used * edge.reach > 0.0  # the snow pushes it outwards
            area = self.share * (max(deep - other, 0.0) if is_inwards else deep)
            out.append(area * (strength * used * edge.across + thrust * abs(used) * edge.off))
        return out

    @property
    def _sliding_axes(self) -> FloatArray:
        """Along the edge, and aside in the surface or, where friction acts on what presses on the base, in the base."""
        forwards = np.cross(self.u, self.line.out)
        aside = self.u if self.whole.snow.friction_acts_on == "snow-normal" else np.cross(self.base, forwards)
        return np.array([forwards, aside / np.linalg.norm(aside)])

    def _ways(self) -> FloatArray:
        """Of the base since it stuck, along the ski and over the line: the point at the same arm, seen from there."""
        station, place, arm = present(self.line.stuck)
        return np.array([station - self.gap, self.touch.place + (arm - self.reach) / self.wide - place])

    def _way(self) -> FloatArray:
        return self._ruled(self._sliding_axes @ (self._ways() @ [self.x, self.line.left]))

    def _ruled(self, parts: FloatArray) -> FloatArray:
        return parts * [1.0, 0.0 if self.whole.snow.friction_direction == "along-ski" else 1.0]

    def held_back(self) -> tuple[float, float, float]:
        """Where friction is 0 from here on."""
        if self.line.stuck is None:
            return self.gap, self.touch.place, self.reach
        share = min(1.0, self.whole.snow.stick_displacement / max(float(np.linalg.norm(self._way())), 1e-300))
        on, over = share * self._ways()
        return self.gap + on, self.touch.place - over, self.reach

    def add(self, wrench: FloatArray, loads: FloatArray, dt: float) -> None:
        snow, line, touch = self.whole.snow, self.line, self.touch
        n, y = line.out, line.left
        ways = [
            (before.place, before.depth, edge.place, edge.depth)
            for k, edge in enumerate(self.edges)
            if (before := self.stood(k)) is not None
        ]
        force, moment = (self.share * value for value in pressure(line, touch, ways, snow))
        off = moment / force if force > 1e-6 else 0.0  # below, lost in rounding
        push_at, arm = self.grip_at + off * (y - touch.fall * n), self.reach + off * self.wide
        v, omega = self.pose.velocity[:3], self.pose.velocity[3:]
        moves = v + np.cross(omega, push_at) + float(self.deflects @ self.rate) * self.up
        moves -= float(self.twists @ self.rate) * arm * self.r
        forwards = np.cross(self.u, n)
        # Coulomb's law: against the sliding velocity in the surface, or in the base's plane where it acts on its load
        axes = self._sliding_axes
        slides = self._ruled(axes @ moves)
        way, full = (slides, snow.stick_displacement / dt if dt else 0.0)
        if line.stuck is not None:
            way, full = self._way(), snow.stick_displacement
        used = way / max(float(np.linalg.norm(way)), full)
        speed = float(np.linalg.norm(slides))
        by_twist = self.twist_s * moment / (1.0 - self.sine**2) * self.per_length
        resist = force * self.climb + by_twist if snow.compaction_resistance else 0.0
        held = self.held()
        # its load: what presses square on the base, snow's normal and side force together, or the snow's normal alone
        pressing, at_grip = force, 0.0
        if snow.friction_acts_on == "base-normal":
            pressing = force * float(n @ self.r)
            at_grip = max(float(sum(held) @ self.r), -pressing)
        mu = float(snow.friction.coefficient(speed)) if hasattr(snow.friction, "coefficient") else snow.friction
        rub = -mu * used
        if isinstance(snow.shear, MachiningShear):  # it has a friction across of its own
            rub[1] = 0.0
        push = force * n + resist * forwards + pressing * rub @ axes
        points = [(push_at, arm, push), (self.grip_at, self.reach, at_grip * rub @ axes)]
        points += [(edge.at, edge.reach, each) for edge, each in zip(self.edges, held, strict=True)]
        for at, lever, each in points:
            wrench[:3] += each
            wrench[3:] += np.cross(at, each)
            loads += (self.deflects * float(self.up @ each)).reshape(-1, 3)
            loads -= (self.twists * (lever * float(self.r @ each))).reshape(-1, 3)

    def strength(self) -> tuple[float, float]:
        """Shear strength and thrust (N/m²), less what slip has taken."""
        snow = self.whole.snow
        left = 1.0 - (1.0 - snow.residual_ratio) * np.minimum(self.line.slipped / snow.slip_weakening, 1.0)
        if snow.shear is None:
            assert isinstance(snow.failure_shear_stress, float)
            return float(left) * snow.failure_shear_stress, 0.0
        angle = math.asin(min(abs(self.sine), 1.0))
        stress = snow.shear.failure_stress(self.deepest, angle)
        thrust = snow.shear.thrust_force(self.deepest, 1.0, angle) / self.deepest
        return float(left * stress), float(left * thrust)
