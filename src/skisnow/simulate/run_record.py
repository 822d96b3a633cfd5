"""What is kept of a run, output by output."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .motion.advance import (
    OF_DAMPING,
    OF_DRAG,
    OF_FRICTION,
    OF_RELEASED,
    OF_SHEAR,
    OF_SIDEWAYS,
    mechanical_energy,
)
from .motion.forces import HELD, SPRINGY
from .motion.model import PADDING
from .motion.path import energy_in_snow
from .run import LOST, STORED, SkiHistory
from .run_setup import Setup

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Moment:
    time: float
    place: FloatArray
    attitude: FloatArray
    velocity: FloatArray
    skis: dict[str, FloatArray]
    energies: FloatArray


@dataclass(slots=True)
class Record:
    """The moments kept so far."""

    setup: Setup
    run_length: float = 0.0
    _moments: list[_Moment] = field(default_factory=list)
    _lost_before: float = field(init=False)

    def __post_init__(self) -> None:
        self._lost_before = energy_in_snow(self.setup.snow, self.setup.lines, self.setup.archive)

    def add(self, *, replace: bool = False) -> None:
        """Keep the present moment; with `replace` in place of the last one."""
        state = self.setup.memory.state
        moment = _Moment(
            self.setup.time,
            state.place.copy(),
            state.turn.copy(),
            state.turn @ state.velocity[:3],
            _skis(self.setup),
            self._energies(),
        )
        length = self.run_length
        if self._moments:
            length += _arc(self._moments[-1], moment)
        if replace and len(self._moments) > 1:
            self._moments[-1:] = [moment]
        else:
            self._moments.append(moment)
        self.run_length = length

    def _energies(self) -> FloatArray:
        setup = self.setup
        clock, power = setup.memory.clock, setup.memory.start.power
        kinetic, potential, elastic = mechanical_energy(
            setup.model, setup.world, setup.memory.state, setup.memory.scratch
        )
        left = energy_in_snow(setup.snow, setup.lines, setup.archive) - self._lost_before
        work = clock.work
        first = self._moments[0].energies[-1] if self._moments else power[HELD]
        return np.array(
            [
                kinetic,
                potential,
                elastic,
                power[SPRINGY] + power[HELD],
                left - work[OF_SIDEWAYS] + work[OF_RELEASED],
                work[OF_SHEAR] - (power[HELD] - first),
                work[OF_FRICTION],
                work[OF_DRAG],
                work[OF_DAMPING],
                power[HELD],
            ]
        )

    def histories(self) -> dict[str, Any]:
        """The arrays of a `Run`."""
        moments = self._moments
        attitude = np.array([m.attitude for m in moments]).reshape(-1, 3, 3)
        velocity = np.array([m.velocity for m in moments]).reshape(-1, 3)
        time = np.array([m.time for m in moments])
        energies = np.array([m.energies for m in moments]).reshape(len(moments), -1)
        station = self.setup.model.node
        skis = {name: np.array([m.skis[name] for m in moments]) for name in moments[0].skis} if moments else {}
        return {
            "time": time,
            "place": np.array([m.place for m in moments]).reshape(-1, 3),
            "attitude": attitude,
            "velocity": velocity,
            "heading": np.unwrap(np.arctan2(attitude[:, 1, 0], attitude[:, 0, 0])),
            "turn_radius": turn_radius(time, velocity, attitude[:, :, 2]),
            "skis": SkiHistory(station=station, **(skis or _no_skis(len(station)))),
            "energies": {name: energies[:, i] for i, name in enumerate((*STORED, *LOST))},
        }


def _arc(one: _Moment, other: _Moment) -> float:
    """Length of path between two moments (m), by the speeds at both ends and the chord."""
    chord = float(np.linalg.norm(other.place - one.place))
    before, after = np.linalg.norm(one.velocity), np.linalg.norm(other.velocity)
    if before * after == 0.0:
        return chord
    cosine = float(one.velocity @ other.velocity / (before * after))
    angle2 = max(0.0, 2.0 * (1.0 - cosine))
    return chord * (1.0 + angle2 / 24.0) if angle2 < 1.0 else chord


def turn_radius(time: FloatArray, velocity: FloatArray, normal: FloatArray) -> FloatArray:
    """Radius of the path (n,) in the snow's surface, positive left, infinite where straight (m), by central differences."""
    if len(time) < 2:
        return np.full(len(time), np.inf)
    speed = np.linalg.norm(velocity, axis=1)
    acceleration = np.gradient(velocity, time, axis=0)
    turning = np.einsum("ij,ij->i", np.cross(velocity, acceleration), normal)
    moving = (speed > 0.01) & (np.abs(turning) > 1e-6 * speed**3)
    return np.where(moving, speed**3 / np.where(moving, turning, 1.0), np.inf)


def _skis(setup: Setup) -> dict[str, FloatArray]:
    model, state, start = setup.model, setup.memory.state, setup.memory.start
    node = model.node
    share = _shares(node)
    found: dict[str, list[FloatArray]] = {name: [] for name in _NAMES}
    for k in range(2):
        section = start.section[k, : int(start.sections[k])]
        order = np.argsort(section[:, 0])
        station, force, shear, depth = section[order].T
        edge_depth = np.interp(node, station, depth)
        track, boot_depth = _boot_edge(setup, k, float(np.interp(0.0, station, depth)))
        values = (
            track,
            boot_depth,
            edge_depth,
            _spread(node, share, station, force),
            _spread(node, share, station, shear),
        )
        bend = state.bend[k]
        first, last = model.dof[:, 0], model.dof[:, 1]
        number = np.append(first, last[-1])
        held = number < 0
        bending = np.where(held, 0.0, bend[np.where(held, 0, number + PADDING)])
        twist = np.where(held, 0.0, bend[np.where(held, 2, number + PADDING + 2)])
        for name, value in zip(_NAMES, (*values, bending, twist), strict=True):
            found[name].append(np.asarray(value))
    return {name: np.array(pair) for name, pair in found.items()}


_NAMES = ("track", "depth", "edge_depth", "force_per_length", "shear_per_length", "bending", "twist")


def _no_skis(stations: int) -> dict[str, FloatArray]:
    empty = {name: np.zeros((0, 2, stations)) for name in _NAMES}
    return empty | {"track": np.zeros((0, 2, 3)), "depth": np.zeros((0, 2))}


def _shares(node: FloatArray) -> FloatArray:
    """Length of ski (m) that each node stands for."""
    half = -np.diff(node) / 2.0
    return np.append(half, 0.0) + np.append(0.0, half)


def _spread(node: FloatArray, share: FloatArray, station: FloatArray, force: FloatArray) -> FloatArray:
    """Forces at stations as force per length at the nodes; their sum is kept."""
    upper = np.clip(np.searchsorted(-node, -station, side="right") - 1, 0, len(node) - 2)
    local = np.clip((node[upper] - station) / (node[upper] - node[upper + 1]), 0.0, 1.0)
    total = np.bincount(upper, force * (1.0 - local), len(node)) + np.bincount(upper + 1, force * local, len(node))
    return total / share


def _boot_edge(setup: Setup, k: int, depth: float) -> tuple[FloatArray, float]:
    """The edge that is down at the boot, brought to the slope's surface (m), and its depth (m)."""
    model, state = setup.model, setup.memory.state
    place = int(round(-model.tail / (model.tip - model.tail) * (len(model.table) - 1)))
    half, height = model.table[place, 0], model.table[place, 2]
    lateral = state.turn @ model.lateral
    side = -np.sign(lateral[2]) if abs(lateral[2]) > 1e-9 else 0.0
    edge = state.place + state.turn @ (model.middle[k] + height * model.normal) + side * half * lateral
    edge[2] = setup.surface_height(float(edge[0]))
    return edge, depth
