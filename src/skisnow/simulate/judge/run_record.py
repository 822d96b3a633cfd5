"""A run taken from output to output, and what is kept of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ..motion.advance import NOT_FINITE, PAUSED, STEP_TOO_SMALL
from ..motion.forces import HELD
from ..motion.history import History, longer, new_history
from ..motion.outputs import advance_outputs
from ..motion.path import energy_in_snow
from ..run import LOST, STORED, Outcome, SkiHistory
from .run_setup import Setup

FloatArray: TypeAlias = npt.NDArray[np.float64]

GAINED_SHARE, GAINED = 0.05, 10.0
"""Share of the energy turned over, and energy (J), that may seem to be gained before numbers have run away (Choice)."""
_MECHANICAL = 3  # kinetic, potential, elastic in the skis
_ROOM = 64
"""Moments for which a record begins with room."""
_TROUBLES: Final[dict[int, Outcome]] = {STEP_TOO_SMALL: "step_too_small", NOT_FINITE: "not_finite"}


@dataclass(slots=True)
class Record:
    """The moments kept so far."""

    setup: Setup
    run_length: float = 0.0
    _history: History = field(init=False)
    _count: int = 0
    _lost_before: float = field(init=False)
    _held_first: float = field(init=False)

    def __post_init__(self) -> None:
        setup = self.setup
        self._history = new_history(_ROOM, len(setup.model.node))
        self._lost_before = energy_in_snow(setup.snow, setup.lines, setup.archive)
        self._held_first = float(setup.memory.start.power[HELD])

    def add(self) -> None:
        """Keep the present moment; nothing moves, but all loops are compiled then."""
        self.advance(np.array([self.setup.time]))

    def advance(self, moments: FloatArray, *, replace: bool = False) -> Outcome | None:
        """Let the run go on to the moments (s) and keep each, at most until one that asks for a look.

        With `replace` the first takes the place of the last one kept. The outcome if the steps cannot go on.
        """
        setup, solver = self.setup, self.setup.scenario.solver
        self._make_room(len(moments))
        setup.keep_room()
        fixed = solver.fixed or solver.method == "fast"
        noted, trouble = 0, PAUSED
        while trouble == PAUSED:  # between two calls an interrupt is heard
            more, trouble = advance_outputs(
                setup.model, setup.snow, setup.world, setup.lines, setup.archive, setup.memory, solver.method == "fast",
                solver.step, None if fixed else solver.tolerance, moments[noted:], setup.end, setup.shares,
                self._lost_before, self._held_first, self._history, self._count + noted,
            )  # fmt: skip
            noted += int(more)
        self._take(noted, replace=replace)
        return _TROUBLES.get(int(trouble))

    def _make_room(self, moments: int) -> None:
        while self._count + moments > len(self._history.time):
            self._history = longer(self._history)

    def _take(self, moments: int, *, replace: bool) -> None:
        """Count the moments that were noted after the last one."""
        for _ in range(moments):
            row = self._count
            if row:
                self.run_length += self._arc(row - 1, row)
            same = row > 0 and self._history.time[row] <= self._history.time[row - 1]
            if same or (replace and row > 1):
                for each in self._history:
                    each[row - 1 : -1] = each[row:].copy()
            else:
                self._count += 1
            replace = False

    @property
    def last_interval(self) -> float:
        """Time (s) between the last two moments; 0 while there is but one."""
        time = self._history.time
        return float(time[self._count - 1] - time[self._count - 2]) if self._count > 1 else 0.0

    @property
    def gains_energy(self) -> bool:
        """Whether motion, height and bend hold more energy than at the start: numbers have run away."""
        first, last = self._history.energies[0], self._history.energies[self._count - 1]
        gained = float(last[:_MECHANICAL].sum() - first[:_MECHANICAL].sum())
        turned_over = float(first[0] + max(0.0, first[1] - last[1]))
        return not gained <= GAINED_SHARE * turned_over + GAINED

    def drop(self) -> None:
        """Forget the last moment."""
        if self._count > 1:
            self._count -= 1
            self.run_length -= self._arc(self._count - 1, self._count)

    def _arc(self, one: int, other: int) -> float:
        """Length of path between two moments (m), by the velocities at both ends and the chord."""
        place, velocity = self._history.place, self._history.velocity
        chord = math.dist(place[one], place[other])
        before, after = math.hypot(*velocity[one]), math.hypot(*velocity[other])
        if before * after == 0.0:
            return chord
        angle2 = max(0.0, 2.0 * (1.0 - float(velocity[one] @ velocity[other]) / (before * after)))
        return chord * (1.0 + angle2 / 24.0) if angle2 < 1.0 else chord

    def histories(self) -> dict[str, Any]:
        """The arrays of a `Run`."""
        kept = History(*(each[: self._count].copy() for each in self._history))
        normal = np.array([self.setup.slope_normal(float(x)) for x in kept.place[:, 0]])
        skis = {name: kept.along[:, i] for i, name in enumerate(_ALONG)}
        return {
            "time": kept.time,
            "place": kept.place,
            "attitude": kept.turn,
            "velocity": kept.velocity,
            "heading": _heading(kept.turn, normal),
            "turn_radius": turn_radius(kept.time, kept.velocity, kept.turn[:, :, 2]),
            "skis": SkiHistory(station=self.setup.model.node, track=kept.edge, depth=kept.boot_depth, **skis),
            "energies": {name: kept.energies[:, i] for i, name in enumerate((*STORED, *LOST))},
        }


_ALONG = ("edge_depth", "force_per_length", "shear_per_length", "bending", "twist")


def _heading(attitude: FloatArray, normal: FloatArray) -> FloatArray:
    """Angle of the skis to the fall line in the slope's plane, positive left (rad): (n, 3, 3) and (n, 3) to (n,)."""
    ahead, normal = attitude[:, :, 0], normal.reshape(-1, 3)
    down = ahead[:, 0] * normal[:, 2] - ahead[:, 2] * normal[:, 0]
    return np.asarray(np.unwrap(np.arctan2(ahead[:, 1], down)))


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
