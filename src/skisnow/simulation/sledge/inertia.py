"""Mass matrix of a rigid sledge with two flexible skis.

Kinetic energy ½∫|v + ω × ρ + n ẇ|² dm over sledge and skis, and ½∫ρI (ω_x - φ̇)² ds for the skis' sections, with ρ
the unbent place in the sledge's frame: in the matrix the deflection counts as velocity, not as change of place
(modelling assumption: w is far below the distances of the sledge), so that the matrix is constant. The equations of
motion keep what of the deflection's own position does not vanish with w: v × ω acts on the skis. Energy and momenta
then drift by no more than mass × w × v × ω.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...scenario.sledge import RigidSledge
from ...ski.beam.clamped import ClampedSki
from ...ski.beam.elements import GAUSS_POINTS, GAUSS_WEIGHTS, deflection_shape, twist_shape
from .frames import base_normal, cross_matrix

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SledgeInertia:
    """Mass matrix in blocks: rigid body, coupling, skis.

    Attributes
    ----------
    rigid
        (6, 6): velocity of the origin and angular velocity, in the sledge's frame.
    coupling
        (skis, size, 6): what the unknowns of the left and the right ski add.
    mass
        Of sledge and skis (kg).
    first_moment
        (3,) mass times the place of the common centre of mass (kg m).
    ski
        (6, 6) of one undeformed ski about its boot, in its own axes.
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
