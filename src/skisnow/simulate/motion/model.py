"""A sledge on two skis, the snow and the world around them as plain arrays for the compiled loops."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...ski.beam.banded import dense
from ...ski.beam.clamped import ClampedSki
from ..sledge import RigidSledge
from ..sledge.frames import base_lateral, base_normal
from ..sledge.inertia import sledge_inertia

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]
PlaceArray: TypeAlias = npt.NDArray[np.uint64]
"""Unsigned: the compiled loops need not ask whether an index counts from the end."""

TABLE_STEP = 1e-3
"""Spacing (m) of the tables of width and base height along the ski."""
PADDING = 5
"""Empty rows before the first and behind the last unknown of a ski: loops over a band need no ends."""


class Model(NamedTuple):
    """Sledge and skis, SI, vectors in the sledge's frame. A band keeps the lower half: [i, j] is A[i, i - j]."""

    rigid: FloatArray  # (6, 6) mass matrix of the rigid body
    coupling: FloatArray  # (2, n, 6)
    mass: FloatArray  # (n, 6) of one ski
    stiffness: FloatArray  # (n, 6)
    damping: float  # times the stiffness: structural damping (s)
    middle: FloatArray  # (2, 3) of the skis, at the boot
    lateral: FloatArray  # (3,) across the base, to the left
    normal: FloatArray  # (3,) of the base
    node: FloatArray  # (m,) along the ski, tip to tail (m)
    dof: IntArray  # (m - 1, 2) first unknown at both ends of each element, -1 where held
    at: PlaceArray  # (m - 1, 2) its place in a padded row; 0, an empty one, where held
    table: FloatArray  # (k, 4) tail to tip: half width, its slope, base height, its slope
    element: PlaceArray  # (k,) of each place of the table
    tail: float
    tip: float
    total_mass: float
    first_moment: FloatArray  # (3,)


class Snow(NamedTuple):
    """Contact parameters, SI."""

    hardness: float
    excess: float  # k_u - H_V
    shear_stress: float
    holding: float  # displacement across at which the edge's grip is used up (m)
    compaction: float  # 1.0 or 0.0
    friction: float  # μ at rest
    friction_by_speed: float  # (s/m)
    friction_speed: float  # below which friction fades to zero (m/s)
    one_sided: float  # sine of the edge angle above which the shear acts at the edge alone


class World(NamedTuple):
    """Gravity, air and slope, SI, in space."""

    gravity: FloatArray  # (3,)
    drag: float  # ½ ρ C_d A (kg/m)
    drag_height: float  # of the centre of pressure above the bases (m)
    slope_start: float  # x of the first height (m)
    slope_step: float  # between heights (m)
    heights: FloatArray  # (p, 2) height and gradient over x; one row: the plane z = 0


class State(NamedTuple):
    """Where everything is and how it moves. Skis: rows of padded unknowns."""

    place: FloatArray  # (3,) of the sledge's origin in space
    turn: FloatArray  # (3, 3) from the sledge's frame to space
    velocity: FloatArray  # (6,) of the origin and angular, in the sledge's frame
    bend: FloatArray  # (2, n + 10)
    bend_rate: FloatArray  # (2, n + 10)


def new_state(size: int) -> State:
    """A state at the origin, at rest, for skis with that many unknowns."""
    padded = size + 2 * PADDING
    return State(np.zeros(3), np.eye(3), np.zeros(6), np.zeros((2, padded)), np.zeros((2, padded)))


def sledge_model(sledge: RigidSledge, ski: ClampedSki, *, damping_ratio: float) -> Model:
    """Arrays of a sledge on two of these skis.

    Parameters
    ----------
    sledge, ski
        The rigid part, and the ski of both sides.
    damping_ratio
        Of the ski's first bending mode as it is clamped, ≥ 0: damping in proportion to the stiffness.
    """
    inertia = sledge_inertia(sledge, ski)
    tail, tip = float(ski.ski.station[-1]), float(ski.ski.station[0])
    table = np.linspace(tail, tip, max(2, math.ceil((tip - tail) / TABLE_STEP)) + 1)
    at = ski.ski.at(np.clip(table, tail, tip))
    half = at.width / 2.0
    side = sledge.stance_width / 2.0
    dof = np.ascontiguousarray(ski.dof[:, [0, 3]])
    element = np.searchsorted(-ski.node, -table, side="right") - 1
    return Model(
        rigid=inertia.rigid,
        coupling=inertia.coupling,
        mass=_lower(ski.mass),
        stiffness=_lower(ski.stiffness),
        damping=2.0 * damping_ratio / _first_bending_frequency(ski),
        middle=np.array([[0.0, side, 0.0], [0.0, -side, 0.0]]),
        lateral=base_lateral(sledge.edge_angle),
        normal=base_normal(sledge.edge_angle),
        node=ski.node,
        dof=dof,
        at=np.where(dof >= 0, dof + PADDING, 0).astype(np.uint64),
        table=np.column_stack([half, np.gradient(half, table), at.base_height, np.gradient(at.base_height, table)]),
        element=np.clip(element, 0, len(ski.dof) - 1).astype(np.uint64),
        tail=tail,
        tip=tip,
        total_mass=inertia.mass,
        first_moment=inertia.first_moment,
    )


def _lower(matrix: FloatArray) -> FloatArray:
    """Lower half of a symmetric band: from (n, 11) to (n, 6)."""
    lower = np.ascontiguousarray(matrix[:, 5::-1])
    for i in range(PADDING):
        lower[i, i + 1 :] = 0.0
    return lower


def _first_bending_frequency(ski: ClampedSki) -> float:
    """Angular frequency (rad/s) of the softest bending mode of the clamped ski."""
    from scipy.linalg import eigh

    bending = np.arange(ski.size) % 3 != 2
    stiffness, mass = dense(ski.stiffness)[np.ix_(bending, bending)], dense(ski.mass)[np.ix_(bending, bending)]
    return float(np.sqrt(eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 0])[0]))
