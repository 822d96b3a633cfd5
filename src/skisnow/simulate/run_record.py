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
from .motion.along import along_skis
from .motion.forces import HELD, SPRINGY
from .motion.path import energy_in_snow
from .run import LOST, STORED, SkiHistory
from .run_setup import Setup

FloatArray: TypeAlias = npt.NDArray[np.float64]

GAINED_SHARE, GAINED = 0.05, 10.0
"""Share of the energy turned over, and energy (J), that may seem to be gained before numbers have run away (Choice)."""
_MECHANICAL = 3  # kinetic, potential, elastic in the skis


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
        same = bool(self._moments) and moment.time <= self._moments[-1].time
        if (replace or same) and len(self._moments) > 1:
            self._moments[-1:] = [moment]
        else:
            self._moments.append(moment)
        self.run_length = length

    @property
    def gains_energy(self) -> bool:
        """Whether motion, height and bend hold more energy than at the start: numbers have run away."""
        first, last = self._moments[0].energies, self._moments[-1].energies
        gained = float(last[:_MECHANICAL].sum() - first[:_MECHANICAL].sum())
        turned_over = float(first[0] + max(0.0, first[1] - last[1]))
        return not gained <= GAINED_SHARE * turned_over + GAINED

    def drop(self) -> None:
        """Forget the last moment."""
        if len(self._moments) > 1:
            gone = self._moments.pop()
            self.run_length -= _arc(self._moments[-1], gone)

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
            "heading": _heading(attitude, np.array([self.setup.slope_normal(float(m.place[0])) for m in moments])),
            "turn_radius": turn_radius(time, velocity, attitude[:, :, 2]),
            "skis": SkiHistory(station=station, **(skis or _no_skis(len(station)))),
            "energies": {name: energies[:, i] for i, name in enumerate((*STORED, *LOST))},
        }


def _heading(attitude: FloatArray, normal: FloatArray) -> FloatArray:
    """Angle of the skis to the fall line in the slope's plane, positive left (rad): (n, 3, 3) and (n, 3) to (n,)."""
    ahead, normal = attitude[:, :, 0], normal.reshape(-1, 3)
    down = ahead[:, 0] * normal[:, 2] - ahead[:, 2] * normal[:, 0]
    return np.asarray(np.unwrap(np.arctan2(ahead[:, 1], down)))


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
    """Radius of the path (n,) in the snow's surface, positive left, infinite where straight (m).

    By central differences.
    """
    if len(time) < 2:
        return np.full(len(time), np.inf)
    speed = np.linalg.norm(velocity, axis=1)
    acceleration = np.gradient(velocity, time, axis=0)
    turning = np.einsum("ij,ij->i", np.cross(velocity, acceleration), normal)
    moving = (speed > 0.01) & (np.abs(turning) > 1e-6 * speed**3)
    return np.where(moving, speed**3 / np.where(moving, turning, 1.0), np.inf)


def _skis(setup: Setup) -> dict[str, FloatArray]:
    """Histories along the skis, at the nodes."""
    nodes = len(setup.model.node)
    along = np.zeros((5, 2, nodes))
    along_skis(setup.model, setup.memory.state, setup.memory.start, setup.shares, along)
    edge = np.array([_boot_edge(setup, k) for k in range(2)])
    boot = [float(np.interp(0.0, setup.model.node[::-1], along[0, k, ::-1])) for k in range(2)]
    return dict(zip(_NAMES, (edge, np.array(boot), *along), strict=True))


_NAMES = ("track", "depth", "edge_depth", "force_per_length", "shear_per_length", "bending", "twist")


def _no_skis(stations: int) -> dict[str, FloatArray]:
    empty = {name: np.zeros((0, 2, stations)) for name in _NAMES}
    return empty | {"track": np.zeros((0, 2, 3)), "depth": np.zeros((0, 2))}


def _boot_edge(setup: Setup, k: int) -> FloatArray:
    """The edge that is down at the boot, brought to the slope's surface (m)."""
    model, state = setup.model, setup.memory.state
    place = round(-model.tail / (model.tip - model.tail) * (len(model.table) - 1))
    half, height = model.table[place, 0], model.table[place, 2]
    lateral = state.turn @ model.lateral
    side = -np.sign(lateral[2]) if abs(lateral[2]) > 1e-9 else 0.0
    edge = state.place + state.turn @ (model.middle[k] + height * model.normal) + side * half * lateral
    edge[2] = setup.surface_height(float(edge[0]))
    return np.asarray(edge)
