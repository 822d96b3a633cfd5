"""Motions of a ski prescribed by hand, and what the snow answers along them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from skisnow.contact import Runner, SnowContact, SnowField

FloatArray = npt.NDArray[np.float64]

HARDNESS, STRENGTH, RATIO, FRICTION, LOAD = 2e8, 3e5, 10.0, 0.05, 800.0
SIDECUT, HALF_WAIST, LENGTH = 18.0, 0.033, 1.7
STATIONS = np.linspace(0.5 * LENGTH, -0.5 * LENGTH, 41)
NODES = STATIONS[::4]
SKI = Runner(STATIONS, HALF_WAIST + STATIONS**2 / (2.0 * SIDECUT), np.zeros(41), NODES)
DT = 4e-3
SPACING = 0.02


@dataclass(frozen=True)
class Moment:
    """Where the boot is on the snow, how the ski points and stands, how it moves."""

    x: float
    y: float
    heading: float
    angle: float
    depth: float
    speed: float
    turning: float
    slip: float = 0.0

    def pose(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Position, rotation, velocity; the beam bent so that the deeper edge lies level on its circle."""
        heading = self.heading + self.slip
        c, s, ca, sa = math.cos(heading), math.sin(heading), math.cos(self.angle), math.sin(self.angle)
        rotation = np.array([[c, -s * ca, -s * sa], [s, c * ca, c * sa], [0.0, -sa, ca]])
        bend = math.tan(self.angle) / SIDECUT
        beam = np.column_stack([0.5 * bend * NODES**2, -bend * NODES, np.zeros(len(NODES))])
        height = HALF_WAIST * abs(sa) - self.depth
        moves = [self.speed * math.cos(self.heading), self.speed * math.sin(self.heading), 0.0, 0.0, 0.0, self.turning]
        return np.array([[self.x, self.y, height]]), rotation[None], np.array([moves]), beam


def _depth(angle: float) -> float:
    """Of the deeper edge (m) where the snow bears the load: a wedge, or on a nearly flat base a trapezium."""
    per_length, width = LOAD / (HARDNESS * LENGTH), 2.0 * HALF_WAIST
    wedge = math.sqrt(2.0 * per_length * math.tan(angle))
    return wedge if wedge < width * math.sin(angle) else per_length / width + HALF_WAIST * math.sin(angle)


def _driven(
    steps: int, angle: Callable[[float], float], speed: Callable[[float], float], slip: Callable[[float], float]
) -> Iterator[Moment]:
    x = y = heading = 0.0
    for step in range(steps):
        t = step * DT
        turning = speed(t) * math.tan(angle(t)) / math.sin(angle(t)) / SIDECUT if abs(angle(t)) > 1e-9 else 0.0
        depth = _depth(angle(t)) * (1.0 + 0.05 * math.sin(40.0 * t))
        yield Moment(x, y, heading, angle(t), depth, speed(t), turning, slip(t))
        x += DT * speed(t) * math.cos(heading + 0.5 * DT * turning)
        y += DT * speed(t) * math.sin(heading + 0.5 * DT * turning)
        heading += DT * turning


def _ramp(t: float, begin: float, end: float) -> float:
    return min(max((t - begin) / (end - begin), 0.0), 1.0)


def carve() -> Iterator[Moment]:
    """From rest, flat, to 8 m/s; then edged to 45 degrees in half a second, and one turn on."""
    return _driven(
        400, lambda t: math.radians(45) * _ramp(t, 0.4, 0.9), lambda t: 8.0 * _ramp(t, 0.0, 0.4), lambda _: 0.0
    )


def skid() -> Iterator[Moment]:
    """At 8 m/s and 30 degrees, turned across its way by up to 15 degrees."""
    return _driven(
        300,
        lambda _: math.radians(30),
        lambda _: 8.0,
        lambda t: math.radians(15) * math.sin(math.pi * _ramp(t, 0.2, 1.2)),
    )


def crossing() -> Iterator[Moment]:
    """Straight, over a carved track at 40 degrees."""
    for step in range(150):
        along = 0.03 * step - 2.25
        yield Moment(4.0 + along * math.cos(0.7), along * math.sin(0.7), 0.7, 0.1, _depth(0.1), 7.5, 0.0)


@dataclass(frozen=True)
class Answer:
    """Forces (n, 3) and moments (n, 3) along a path, and the energy lost in grooves (J)."""

    force: FloatArray
    moment: FloatArray
    energy: float

    def as_lists(self) -> list[Any]:
        """To be written as JSON."""
        return [self.force.tolist(), self.moment.tolist(), self.energy]

    @classmethod
    def of(cls, lists: list[Any]) -> Answer:
        """What `as_lists` gave."""
        return cls(np.array(lists[0]), np.array(lists[1]), float(lists[2]))

    def apart(self, other: Answer) -> list[float]:
        """Rms difference of force and moment as a share of the rms, and of the energy (%)."""
        parts = [(self.force, other.force), (self.moment, other.moment)]
        shares = [float(np.linalg.norm(a - b) / np.linalg.norm(b)) for a, b in parts]
        return [100.0 * each for each in (*shares, abs(self.energy - other.energy) / other.energy)]


def answered(path: Iterator[Moment], contact: SnowContact) -> Answer:
    """What the snow answers along a path, which is accepted step by step."""
    wrenches = []
    for step, moment in enumerate(path):
        position, rotation, velocity, beam = moment.pose()
        dt = DT if step else 0.0
        wrenches.append(contact.force(position, rotation, velocity, dt, beam_dofs=[beam]).wrench[0])
        contact.update(position, rotation, dt, beam_dofs=[beam])
    found = np.array(wrenches)
    return Answer(found[:, :3], found[:, 3:], contact.groove_energy)


def all_answers(changes: dict[str, Any]) -> dict[str, Answer]:
    """Of the three paths, in a snow with these changes."""
    spacing = float(changes.pop("spacing", SPACING))
    given: dict[str, Any] = {"friction": FRICTION, **changes}

    def fresh(snow: SnowField | None = None) -> SnowContact:
        return SnowContact(snow or SnowField(HARDNESS, STRENGTH, RATIO, **given), [SKI], spacing=spacing)

    first = fresh()
    for moment in _driven(250, lambda _: 0.5, lambda _: 8.0, lambda _: 0.0):
        position, rotation, _, beam = moment.pose()
        first.update(position, rotation, DT, beam_dofs=[beam])
    return {
        "carve": answered(carve(), fresh()),
        "skid": answered(skid(), fresh()),
        "crossing": answered(crossing(), fresh(first.snow)),
    }
