"""Equilibrium of a clamped ski in snow: starting shape, elastic snow first, then the snow's memory by continuation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...ski.beam.clamped import ClampedSki
from ...ski.ski import Ski
from .assembly import BORDER, Conditions, Sections, new_system
from .newton import newton

FloatArray: TypeAlias = npt.NDArray[np.float64]

TOLERANCE: Final = 1e-11
"""Size (m) of the last correction to the edge depth."""
RIGID_PLASTIC: Final = 1000.0
"""Unloading ratio that stands for rigid-plastic snow: the groove springs back by a thousandth of its depth."""
MOST_ITERATIONS: Final = 60
MOST_STAGES: Final = 40
SOFTENINGS: Final = (1000.0, 30.0, 3.0)
_SHALLOWEST_WEDGE: Final = 0.01  # rad; flatter than this the first guess treats the base as flat
_CONFORMING_SHARE: Final = 0.9  # of the running length that the first guess bends onto the snow
_CONTACT_SHARE: Final = 0.9  # of the running length that the first guess loads evenly


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """State of the ski in equilibrium, all in SI.

    Attributes
    ----------
    converged, iterations
        Whether Newton's method came to an end, and its iterations in all.
    u
        Unknowns of the beam, relative to the boot.
    boot_depth, boot_slope
        b₀ (m) and b₁: depth of the base's middle under the boot, and its growth along the ski.
    shear_stress
        τ, drawn from the snow along the edge (N/m²).
    edge_depth, force_per_length
        At the stations: e (m), and the snow's force per length along the snow normal (N/m).
    """

    converged: bool
    iterations: int
    u: FloatArray
    boot_depth: float
    boot_slope: float
    shear_stress: float
    edge_depth: FloatArray
    force_per_length: FloatArray


class _Search:
    """Newton's method on one ski, from the state that it has reached."""

    def __init__(self, model: ClampedSki, conditions: Conditions, offset: FloatArray | None) -> None:
        stations = model.stations
        n = len(stations.station)
        self._model, self._conditions = model, conditions
        self._sections = Sections(
            stations.station,
            stations.weight,
            stations.width,
            stations.base_height,
            stations.dof,
            stations.deflection,
            stations.twist,
            _places_across(model, conditions, np.zeros(1)),
            np.zeros(n) if offset is None else offset,
        )
        self._spare = new_system(model.size, n)
        self.system = new_system(model.size, n)
        self.iterations = 0
        self.restart(conditions)

    def restart(self, conditions: Conditions) -> None:
        """Go back to the first guess for these conditions."""
        self.u, self.border = _first_guess(self._model, conditions)

    def continues(self, near: Solution, conditions: Conditions) -> bool:
        """Start from another solution; back at the first guess if that fails."""
        self.u[:], self.border[:] = near.u, (near.boot_depth, near.boot_slope, near.shear_stress)
        self._sections = self._sections._replace(place=_places_across(self._model, conditions, near.edge_depth))
        converged = self.reaches(conditions)
        if not converged:
            self.restart(conditions)
        return converged

    def place_groove(self) -> None:
        """Keep the groove where the present state has its waterline."""
        place = _places_across(self._model, self._conditions, self.system.depth)
        self._sections = self._sections._replace(place=place)

    def reaches(self, conditions: Conditions) -> bool:
        """Go to the equilibrium under other conditions; stay where it was if that fails."""
        kept = self.u.copy(), self.border.copy()
        converged, iterations = newton(
            self._sections,
            conditions,
            self._model.stiffness,
            self.u,
            self.border,
            self.system,
            self._spare,
            TOLERANCE,
            MOST_ITERATIONS,
        )
        self.iterations += int(iterations)
        if not converged:
            self.u[:], self.border[:] = kept
        return bool(converged)

    def follows(self, path: Callable[[float], Conditions]) -> bool:
        """Go along a path of conditions from 0 (where it stands) to 1, in one step or as many as it needs."""
        reached, stride = 0.0, 1.0
        for _ in range(MOST_STAGES):
            target = min(reached + stride, 1.0)
            if self.reaches(path(target)):
                if target == 1.0:
                    return True
                reached, stride = target, 2.0 * stride
            else:
                stride /= 3.0
        return False


def solved(
    model: ClampedSki, conditions: Conditions, *, offset: FloatArray | None = None, near: Solution | None = None
) -> Solution:
    """Find the equilibrium of a ski under the conditions.

    Elastic snow first, from there to the steeper unloading; where that fails, all of it on softer snow that hardens.

    Parameters
    ----------
    model
        The clamped ski.
    conditions
        Snow, load and choices.
    offset
        Of the edge from the path at each station (m), where the groove follows the path; None: 0.
    near
        A solution that this one is thought to be close to; tried first.
    """
    search = _Search(model, conditions, offset)
    converged = near is not None and search.continues(near, conditions)
    converged = (
        converged or _loaded(search, conditions) or any(_hardened(search, conditions, share) for share in SOFTENINGS)
    )
    depth, slope, stress = (float(value) for value in search.border)
    system = search.system
    return Solution(converged, search.iterations, search.u, depth, slope, stress, system.depth, system.force)


def _loaded(search: _Search, conditions: Conditions) -> bool:
    """Elastic snow, then memory: the logarithm of the unloading ratio grows from 0."""
    if not search.reaches(conditions._replace(excess=0.0)):
        return False
    if conditions.excess == 0.0:
        return True
    search.place_groove()
    goal = math.log1p(conditions.excess / conditions.hardness)
    return search.follows(lambda share: conditions._replace(excess=conditions.hardness * math.expm1(share * goal)))


def _hardened(search: _Search, conditions: Conditions, softening: float) -> bool:
    """The same on softer snow, which is then hardened."""

    def softer(share: float) -> Conditions:
        factor = softening ** (share - 1.0)
        return conditions._replace(hardness=factor * conditions.hardness, excess=factor * conditions.excess)

    search.restart(softer(0.0))
    return _loaded(search, softer(0.0)) and search.follows(softer)


def _first_guess(model: ClampedSki, conditions: Conditions) -> tuple[FloatArray, FloatArray]:
    """A ski bent so that its edge is straight in the snow, as deep as a rigid one of that contact length would be."""
    ski, angle = model.ski, conditions.edge_angle
    length = _CONTACT_SHARE * ski.running_length
    waist = float(ski.at(0.0).width)
    wedge = math.sqrt(2.0 * conditions.load * math.tan(max(angle, _SHALLOWEST_WEDGE)) / (conditions.hardness * length))
    flat = conditions.load / (conditions.hardness * length * waist * math.cos(angle)) + waist / 2.0 * math.sin(angle)
    depth = min(wedge, flat)
    border = np.zeros(BORDER)
    border[0] = depth - waist / 2.0 * math.sin(angle)
    border[2] = conditions.side_force / (depth * length)
    return _conforming(model, angle), border


def _conforming(model: ClampedSki, angle: float) -> FloatArray:
    """Unknowns of a ski bent onto the snow over most of its running length, and straight beyond."""
    ski, node = model.ski, model.node
    dof = np.vstack([model.dof[:, :3], model.dof[-1:, 3:]])
    front, rear = (_CONFORMING_SHARE * end for end in _ends(ski))
    inside = np.clip(node, rear, front)
    near = 1e-4

    def lift(station: FloatArray) -> FloatArray:
        at = ski.at(station)
        return math.tan(angle) * at.width / 2.0 - at.base_height

    slope = (lift(inside + near) - lift(inside - near)) / (2.0 * near)
    deflection = lift(inside) - lift(np.zeros(1)) + slope * (node - inside)
    u = np.zeros(model.size)
    free = dof[:, 0] >= 0
    u[dof[free, 0]] = deflection[free]
    u[dof[free, 1]] = -slope[free]  # the elements run from tip to tail
    return u


def _ends(ski: Ski) -> tuple[float, float]:
    front, rear = ski.contact_points
    return min(front, float(ski.station[0])), max(rear, float(ski.station[-1]))


def _places_across(model: ClampedSki, conditions: Conditions, edge_depth: FloatArray) -> FloatArray:
    """Places across at which the groove is kept: about the waterline, and at the ends of bevel and base."""
    tangent = math.tan(max(conditions.edge_angle, 1e-9))
    reach = float(model.stations.width.max()) * math.cos(conditions.edge_angle)
    waterline = max(float(np.max(edge_depth)), 0.0) / tangent
    if waterline > 0.6 * reach:
        place = np.linspace(0.0, 1.05 * reach, 5)
    else:
        place = np.append(np.array([0.0, 0.5, 1.0, 1.7]) * waterline, 1.05 * reach)
    if conditions.bevel > 0.0:
        place = np.append(place, conditions.bevel_width * math.cos(conditions.edge_angle))
    return np.unique(place)
