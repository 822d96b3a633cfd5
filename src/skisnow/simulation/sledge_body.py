"""Frames of a sledge: x forward, y left, z up; the origin is between the boots, at the level of the bases.

Each ski is rotated about x by minus the edge angle ϑ, so that its left edge goes down for ϑ > 0:
l = cos ϑ y - sin ϑ z points across the base to the left, n = sin ϑ y + cos ϑ z away from the snow.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from ..dynamics import Body, FlexibleSki
from ..scenario.sledge import RigidSledge
from ..ski.beam import GAUSS_POINTS, GAUSS_WEIGHTS, ClampedSki, deflection_shape, lowest_eigenvalue, twist_shape


def base_normal(edge_angle: float) -> FloatArray:
    """Unit vector n (3,) normal to the base, away from the snow, for the edge angle ϑ (rad)."""
    return np.array([0.0, math.sin(edge_angle), math.cos(edge_angle)])


def base_lateral(edge_angle: float) -> FloatArray:
    """Unit vector l (3,) across the base to the left, for the edge angle ϑ (rad)."""
    return np.array([0.0, math.cos(edge_angle), -math.sin(edge_angle)])


def cross_matrix(vector: npt.ArrayLike) -> FloatArray:
    """Matrix of the cross product, a × b = A b: (…, 3) to (…, 3, 3)."""
    v = np.asarray(vector, float)
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2] = -v[..., 2], v[..., 1]
    matrix[..., 1, 0], matrix[..., 1, 2] = v[..., 2], -v[..., 0]
    matrix[..., 2, 0], matrix[..., 2, 1] = -v[..., 1], v[..., 0]
    return matrix


def rotation(quaternion: npt.ArrayLike) -> FloatArray:
    """Rotation matrix (3, 3) from the sledge's frame to space of a unit quaternion (w, x, y, z)."""
    w, x, y, z = np.asarray(quaternion, float)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


@dataclass(frozen=True, slots=True, eq=False)
class SledgeInertia:
    """Mass matrix in blocks: rigid body, coupling, skis.

    rigid: (6, 6): velocity of the origin and angular velocity, in the sledge's frame.
    coupling: (skis, size, 6): contributions of the unknowns of the left and the right ski.
    mass: of sledge and skis (kg).
    first_moment: (3,) mass times the place of the common centre of mass (kg m).
    ski: (6, 6) of one undeformed ski about its boot, in its own axes.
    """

    rigid: FloatArray
    coupling: FloatArray
    mass: float
    first_moment: FloatArray
    ski: FloatArray


def sledge_inertia(sledge: RigidSledge, ski: ClampedSki, asides: Sequence[float] | None = None) -> SledgeInertia:
    """Add up the inertia of a sledge and of one and the same ski on both sides, or at these places aside (m)."""
    sides = (sledge.stance_width / 2.0, -sledge.stance_width / 2.0) if asides is None else asides
    centre = np.array([sledge.centre_of_mass[0], 0.0, sledge.centre_of_mass[1]])
    rigid = _of_points(np.array([sledge.mass]), centre[None, :])
    rigid[3:, 3:] += np.diag(sledge.inertia)
    coupling = np.zeros((len(sides), ski.size, 6))
    for k, side in enumerate(sides):
        middle = np.array([0.0, side, 0.0])
        of_ski, coupling[k] = _of_ski(ski, middle, sledge.edge_angle)
        rigid += of_ski
    first = np.array([rigid[5, 1], rigid[3, 2], rigid[4, 0]])
    return SledgeInertia(rigid, coupling, float(rigid[0, 0]), first, _of_ski(ski, np.zeros(3), 0.0)[0])


def _of_points(mass: FloatArray, place: FloatArray) -> FloatArray:
    """Rigid mass matrix (6, 6) of points: masses (n,) at places (n, 3)."""
    arm = np.zeros((len(mass), 3, 6))
    arm[:, :, :3] = np.eye(3)
    arm[:, :, 3:] = -cross_matrix(place)
    return np.asarray(np.einsum("n,nai,naj->ij", mass, arm, arm))


def _of_ski(ski: ClampedSki, middle: FloatArray, edge_angle: float) -> tuple[FloatArray, FloatArray]:
    """Rigid mass matrix of a ski, and its coupling to the ski's unknowns: (6, 6) and (size, 6)."""
    length = ski.node[:-1] - ski.node[1:]
    station = ski.node[:-1, None] - length[:, None] * GAUSS_POINTS
    at = ski.ski.at(station)
    normal = base_normal(edge_angle)
    place = middle + at.base_height[..., None] * normal
    place[..., 0] += station
    mass = at.mass_per_length * GAUSS_WEIGHTS * length[:, None]
    inertia = mass * at.width**2 / 12.0
    rigid = _of_points(mass.ravel(), place.reshape(-1, 3))
    rigid[3, 3] += inertia.sum()
    moving = np.concatenate([np.broadcast_to(normal, place.shape), np.cross(place, normal)], axis=-1)
    element = np.einsum("eg,egi,egk->eik", mass, deflection_shape(GAUSS_POINTS[None, :], length[:, None]), moving)
    element[:, :, 3] -= np.einsum("eg,gi->ei", inertia, twist_shape(GAUSS_POINTS))
    coupling = np.zeros((ski.size, 6))
    held = ski.dof >= 0
    np.add.at(coupling, ski.dof[held], element[held])
    return rigid, coupling


def sledge_body(
    sledge: RigidSledge,
    ski: ClampedSki,
    *,
    damping_ratio: float,
    gravity: FloatArray,
    drag: float,
    drag_height: float,
    asides: Sequence[float] | None = None,
) -> Body:
    """A sledge on two of these skis, its origin between the boots on the level of the bases.

    damping_ratio: damping ratio of the clamped ski's first bending mode, ≥ 0: damping in proportion to the stiffness.
    gravity: in space (m/s²), (3,).
    drag, drag_height: ½ ρ C_d A (kg/m), height of the centre of pressure (m).
    asides: places of the boots to the left (m), one for each ski: one of 0 is a sledge on one ski, or on a monoski.
        By default two, with the stance width between them.
    """
    sides = (sledge.stance_width / 2.0, -sledge.stance_width / 2.0) if asides is None else asides
    inertia = sledge_inertia(sledge, ski, sides)
    axes = np.array([[1.0, 0.0, 0.0], base_lateral(sledge.edge_angle), base_normal(sledge.edge_angle)])
    mass, stiffness = _lower_band(ski.mass), _lower_band(ski.stiffness)
    deflection = np.where(np.arange(ski.size) % 3 == 0, np.linspace(-1.0, 1.0, ski.size), 0.0)
    start = np.stack([np.maximum(deflection, 0.0), np.minimum(deflection, 0.0)], axis=1)  # forebody and afterbody
    damping = 2.0 * damping_ratio / float(np.sqrt(lowest_eigenvalue(ski.stiffness, ski.mass, start)))
    unknown = np.append(ski.dof[:, 0], ski.dof[-1, 3]).astype(float)  # the first of each node, -1 where held
    skis = tuple(
        FlexibleSki(
            boot=np.array([0.0, y, 0.0]), axes=axes, unknown=unknown, mass=mass, stiffness=stiffness,
            coupling=inertia.coupling[k], damping=damping, inertia=inertia.ski,
        )
        for k, y in enumerate(sides)
    )  # fmt: skip
    return Body(
        inertia=inertia.rigid, mass=inertia.mass, first_moment=inertia.first_moment, skis=skis, gravity=gravity,
        drag=drag, drag_height=drag_height,
    )  # fmt: skip


def _lower_band(matrix: FloatArray) -> FloatArray:
    """Lower half of a symmetric band: from (n, 11) to (n, 6)."""
    lower = np.ascontiguousarray(matrix[:, 5::-1])
    for i in range(5):
        lower[i, i + 1 :] = 0.0
    return lower
