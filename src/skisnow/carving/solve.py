"""Equilibrium of a clamped ski in snow, found by the compiled core: elastic snow first, then the snow's memory."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from ..compiled import core
from ..ski.beam import STATION_POINTS, ClampedSki, deflection_shape, element_places, twist_shape
from .laws import STEEPEST_RATIO, SnowLaws

RIGID_PLASTIC: Final = STEEPEST_RATIO
"""Unloading ratio that represents rigid-plastic snow: the groove springs back by a thousandth of its depth."""
_CONFORMING_SHARE: Final = 0.9  # share of the running length that the first guess bends onto the snow
_NEAR: Final = 1e-4  # m, over which the first guess takes the slope of the base


class Conditions(NamedTuple):
    """Snow, load and modelling choices of an equilibrium, in SI and rad."""

    edge_angle: float
    hardness: float
    excess: float  # k_u - H_V
    load: float
    moment: float
    side_force: float
    side_force_bending: bool
    twists: bool
    bevel: float
    bevel_width: float
    side: float  # angle between base and side at the edge
    radius: float  # radius of the corner between them
    pitch_of_force: float  # share with which the snow's force takes part in the balance of moments about the boot
    pitch_of_shear: float  # share of the side force
    by_reaction: bool  # the side force goes along the edge as the snow's force, not as the depth
    laws: SnowLaws | None = None  # replace the snow's numbers; with a penetration law the search begins at those


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """State of the ski in equilibrium, all in SI.

    converged, iterations: Whether Newton's method came to an end, and its iterations in all.
    u: Unknowns of the beam, relative to the boot.
    boot_depth, boot_slope: b₀ (m) and b₁: depth of the base's middle under the boot, and its growth along the ski.
    shear_stress: τ, drawn from the snow along the edge (N/m²); by reaction: side force over the snow's force,
        everywhere.
    edge_depth, force_per_length: At the stations: e (m), and the snow's force per length along the snow normal (N/m).
    """

    converged: bool
    iterations: int
    u: FloatArray
    boot_depth: float
    boot_slope: float
    shear_stress: float
    edge_depth: FloatArray
    force_per_length: FloatArray


def solved(
    model: ClampedSki, conditions: Conditions, *, offset: FloatArray | None = None, near: Solution | None = None
) -> Solution:
    """Find the equilibrium of a ski under the conditions.

    Elastic snow first, from there to the steeper unloading; where that fails, all of it on softer snow that hardens.

    model: The clamped ski.
    conditions: Snow, load and choices.
    offset: Where the groove follows a path, of the edge from that at each station (m); None: the groove follows the
        edge.
    near: A solution that this one is thought to be close to; tried first.
    """
    from_there = None
    if near is not None:
        border = np.array([near.boot_depth, near.boot_slope, near.shear_stress])
        from_there = (near.u, border)
    laws = None if conditions.laws is None else conditions.laws.compiled
    result = core.find_carve(_core_ski(model), _core_conditions(conditions), offset, from_there, laws)
    converged, iterations, u, (depth, slope, stress), edge_depth, force = result
    return Solution(converged, iterations, u, depth, slope, stress, edge_depth, force)


def refined(
    model: ClampedSki, conditions: Conditions, near: Solution, *, places: FloatArray | None = None
) -> core.CarvePoint:
    """The equilibrium next to a solution, to the last digits, for derivatives: groove along the edge, no laws.

    model, conditions: As in `solved`.
    near: Its solution.
    places: Where across the groove is kept (m from the edge, rising from 0); None: where `solved` keeps it.
    """
    border = np.array([near.boot_depth, near.boot_slope, near.shear_stress])
    return core.CarvePoint(_core_ski(model), _core_conditions(conditions), near.u, border, places)


def _core_conditions(conditions: Conditions) -> core.CarveConditions:
    """Conditions for the compiled core, with NumPy numbers converted to Python's."""
    # numbers of NumPy, too, which the core does not know
    numbers: list[Any] = [number.item() if isinstance(number, np.generic) else number for number in conditions[:-1]]
    return core.CarveConditions(*numbers)


@functools.lru_cache(maxsize=32)
def _core_ski(model: ClampedSki) -> core.CarvedSki:
    """Ski for the compiled core: stations, stiffness, width at the boot (m), and its bend if pressed onto the snow."""
    known, front = _mesh_rows(model.node.tobytes(), model.dof.tobytes())
    rows = known.copy()
    rows[:, 2], rows[:, 3] = model.stations.width, model.stations.base_height
    waist = float(model.ski.tables_at(np.zeros(1), "width")[0][0])
    return core.carved_ski(rows, front, model.stiffness, waist, model.ski.running_length, *_bent_onto_snow(model))


@functools.lru_cache(maxsize=16)
def _mesh_rows(nodes: bytes, dofs: bytes) -> tuple[FloatArray, int]:
    """Array of the stations for the core, width and height of the base left 0, and number of unknowns before the clamp.

    The first unknown is that of the station's element; six held unknowns are between those before and behind the clamp.
    """
    node, dof = np.frombuffer(nodes), np.repeat(np.frombuffer(dofs, np.int64).reshape(-1, 6), 2, axis=0)
    length, held = (node[:-1] - node[1:])[:, None], dof < 0
    front = int(dof[np.argmax(held.any(axis=1)), 2]) + 1
    before, behind = dof[:, 0], dof[:, 3]
    first = np.where(before >= front, before + 6, np.where(behind >= front, behind + 3, front))
    deflection = deflection_shape(STATION_POINTS, length).reshape(-1, 6)
    columns = [
        element_places(node, STATION_POINTS).ravel(),
        np.repeat(length / 2.0, 2),
        np.zeros((len(dof), 2)),
        np.where((before >= 0) & (before < front), before, first),
        np.where(held, 0.0, deflection),
        np.where(held, 0.0, np.tile(twist_shape(STATION_POINTS), (len(length), 1))),
    ]
    return np.column_stack(columns), front


def _bent_onto_snow(model: ClampedSki) -> tuple[FloatArray, FloatArray]:
    """Beam unknowns of a ski that is bent onto the snow over most of its running length, and straight beyond.

    Two parts: u = tan ϑ times the first (half the width) minus the second (height of the base).
    """
    ski, node = model.ski, model.node
    dof = np.vstack([model.dof[:, :3], model.dof[-1:, 3:]])
    free = dof[:, 0] >= 0
    front, rear = ski.contact_points
    front = _CONFORMING_SHARE * min(front, float(ski.station[0]))
    rear = _CONFORMING_SHARE * max(rear, float(ski.station[-1]))
    inside = np.clip(node, rear, front)
    width, height = ski.tables_at(
        np.concatenate([inside + _NEAR, inside - _NEAR, inside, [0.0]]), "width", "base_height"
    )

    def bent(table: FloatArray) -> FloatArray:
        before, behind, here = table[:-1].reshape(3, -1)
        slope = (before - behind) / (2.0 * _NEAR)
        u = np.zeros(model.size)
        u[dof[free, 0]] = (here - table[-1] + slope * (node - inside))[free]
        u[dof[free, 1]] = -slope[free]  # the elements run from tip to tail
        return u

    return bent(width / 2.0), bent(height)
