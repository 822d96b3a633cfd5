"""What a run keeps of each moment of output."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .advance import (
    OF_DAMPING,
    OF_DRAG,
    OF_FRICTION,
    OF_RELEASED,
    OF_SHEAR,
    OF_SIDEWAYS,
    Memory,
    mechanical_energy,
)
from .along import along_skis
from .archive import Archive
from .compiled import PLAIN
from .forces import HELD, SPRINGY
from .lines import Lines
from .model import Model, Snow, State, World
from .path import energy_in_snow, surface

FloatArray: TypeAlias = npt.NDArray[np.float64]

ENERGIES = 10
"""Kinetic, potential, elastic in the skis, elastic in the snow; lost to penetration, shear, friction, drag, damping
since the start; held by the edges (J)."""


class History(NamedTuple):
    """Moments, one in each row (n)."""

    time: FloatArray  # (n,) s
    place: FloatArray  # (n, 3)
    turn: FloatArray  # (n, 3, 3)
    velocity: FloatArray  # (n, 3) in space
    energies: FloatArray  # (n, ENERGIES)
    along: FloatArray  # (n, 5, 2, m) see `along_skis`
    edge: FloatArray  # (n, 2, 3) the edge that is down at the boot, on the slope's surface
    boot_depth: FloatArray  # (n, 2) of that edge


def new_history(moments: int, nodes: int) -> History:
    """Room for that many moments of skis with that many nodes."""
    return History(
        np.zeros(moments),
        np.zeros((moments, 3)),
        np.zeros((moments, 3, 3)),
        np.zeros((moments, 3)),
        np.zeros((moments, ENERGIES)),
        np.zeros((moments, 5, 2, nodes)),
        np.zeros((moments, 2, 3)),
        np.zeros((moments, 2)),
    )


def longer(history: History) -> History:
    """The same history with room for twice as many moments."""
    return History(*(np.concatenate([each, np.zeros_like(each)]) for each in history))


@compiled(**PLAIN)
def note(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, memory: Memory, share: FloatArray,
    lost_before: float, held_first: float, history: History, row: int,
) -> None:  # fmt: skip
    """Write the present moment into a row; `lost_before` and `held_first` (J) are the snow's at the start."""
    state, work, power = memory.state, memory.clock.work, memory.start.power
    history.time[row] = memory.clock.time[0]
    for a in range(3):
        history.place[row, a] = state.place[a]
        total = 0.0
        for b in range(3):
            history.turn[row, a, b] = state.turn[a, b]
            total += state.turn[a, b] * state.velocity[b]
        history.velocity[row, a] = total
    energies = history.energies[row]
    energies[0], energies[1], energies[2] = mechanical_energy(model, world, state)
    left = energy_in_snow(snow, lines, archive) - lost_before
    energies[3] = power[SPRINGY] + power[HELD]
    energies[4], energies[5] = _accounts(
        left - work[OF_SIDEWAYS] + work[OF_RELEASED], work[OF_SHEAR] - (power[HELD] - held_first)
    )
    energies[6], energies[7], energies[8] = work[OF_FRICTION], work[OF_DRAG], work[OF_DAMPING]
    energies[9] = power[HELD]
    along_skis(model, state, memory.start, share, history.along[row])
    for k in range(2):
        _note_edge(model, world, state, k, history.edge[row, k])
        history.boot_depth[row, k] = _at_boot(model.node, history.along[row, 0, k])


@compiled(**PLAIN)
def _accounts(penetration: float, shear: float) -> tuple[float, float]:
    """Losses to penetration and to shear (J), neither negative, their sum as it is.

    An edge that is pressed deeper holds more: what its hold gains so is paid by what presses. And what sideways motion
    stressed and then lifts the skis comes from the shear, which pays for sideways motion.
    """
    by_press = min(shear, 0.0)
    lifted = min(penetration + by_press, 0.0)
    return penetration + by_press - lifted, shear - by_press + lifted


@compiled(**PLAIN)
def _note_edge(model: Model, world: World, state: State, k: int, edge: FloatArray) -> None:
    """Fill in the edge that is down at the boot, brought to the slope's surface (m)."""
    boot = int(np.rint(-model.tail / (model.tip - model.tail) * (len(model.table) - 1)))
    half, height = model.table[boot, 0], model.table[boot, 2]
    R, lateral, normal = state.turn, model.lateral, model.normal
    leans = R[2, 1] * lateral[1] + R[2, 2] * lateral[2]
    side = -np.sign(leans) * half if abs(leans) > 1e-9 else 0.0
    y = model.middle[k, 1] + height * normal[1] + side * lateral[1]
    z = height * normal[2] + side * lateral[2]
    for a in range(3):
        edge[a] = state.place[a] + R[a, 1] * y + R[a, 2] * z
    edge[2] = surface(world, edge[0])[0]


@compiled(**PLAIN)
def _at_boot(node: FloatArray, values: FloatArray) -> float:
    """Value at station 0, interpolated between the nodes, which go from tip to tail."""
    i = 0
    while i < len(node) - 2 and node[i + 1] > 0.0:
        i += 1
    f = node[i] / (node[i] - node[i + 1])
    return values[i] + f * (values[i + 1] - values[i])
