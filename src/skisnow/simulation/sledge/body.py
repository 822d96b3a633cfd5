"""A sledge on two skis as a body in motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...dynamics import Body, FlexibleSki
from ...scenario.sledge import RigidSledge
from ...ski.beam.banded import lowest_eigenvalue
from ...ski.beam.clamped import ClampedSki
from .frames import base_lateral, base_normal
from .inertia import sledge_inertia

FloatArray: TypeAlias = npt.NDArray[np.float64]


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

    Parameters
    ----------
    sledge, ski
        The rigid part, and the ski of both sides.
    damping_ratio
        Of the ski's first bending mode as it is clamped, ≥ 0: damping in proportion to the stiffness.
    gravity
        In space (m/s²), (3,).
    drag, drag_height
        ½ ρ C_d A (kg/m), height of the centre of pressure (m).
    asides
        Places of the boots to the left (m), one for each ski: one of 0 is a sledge on one ski, or on a monoski. Left
        out: two, with the stance width between them.
    """
    sides = (sledge.stance_width / 2.0, -sledge.stance_width / 2.0) if asides is None else asides
    inertia = sledge_inertia(sledge, ski, sides)
    axes = np.array([[1.0, 0.0, 0.0], base_lateral(sledge.edge_angle), base_normal(sledge.edge_angle)])
    mass, stiffness = _lower(ski.mass), _lower(ski.stiffness)
    damping = 2.0 * damping_ratio / _first_bending_frequency(ski)
    skis = tuple(
        FlexibleSki(
            boot=np.array([0.0, y, 0.0]), axes=axes, unknown=_first_unknowns(ski), mass=mass, stiffness=stiffness,
            coupling=inertia.coupling[k], damping=damping, inertia=inertia.ski,
        )
        for k, y in enumerate(sides)
    )  # fmt: skip
    return Body(
        inertia=inertia.rigid, mass=inertia.mass, first_moment=inertia.first_moment, skis=skis, gravity=gravity,
        drag=drag, drag_height=drag_height,
    )  # fmt: skip


def _first_unknowns(ski: ClampedSki) -> FloatArray:
    """First unknown of each node, -1 where held: (nodes,)."""
    return np.append(ski.dof[:, 0], ski.dof[-1, 3]).astype(float)


def _lower(matrix: FloatArray) -> FloatArray:
    """Lower half of a symmetric band: from (n, 11) to (n, 6)."""
    lower = np.ascontiguousarray(matrix[:, 5::-1])
    for i in range(5):
        lower[i, i + 1 :] = 0.0
    return lower


def _first_bending_frequency(ski: ClampedSki) -> float:
    """Angular frequency (rad/s) of the softest bending mode of the clamped ski."""
    deflection = np.where(np.arange(ski.size) % 3 == 0, np.linspace(-1.0, 1.0, ski.size), 0.0)
    start = np.stack([np.maximum(deflection, 0.0), np.minimum(deflection, 0.0)], axis=1)  # forebody and afterbody
    return float(np.sqrt(lowest_eigenvalue(ski.stiffness, ski.mass, start)))
