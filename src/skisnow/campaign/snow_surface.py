"""Where the snow begins in a force profile: the tip comes down through the air first.

The force in the air is not 0 and drifts, and something the tip touches on its way leaves a spike. So the surface is
where the force rises above what it was in the air just before, and stays there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.units import MM

FloatArray = npt.NDArray[np.float64]

BLOCK: Final = 0.5 * MM
"""The force is averaged over it, and the surface is found to it (modelling assumption)."""
AIR: Final = 20.0 * MM
"""The air's force is the median over this length before a block (modelling assumption)."""
LEAST_AIR: Final = 5.0 * MM
"""A recording that begins nearer to the snow does not show the air's force (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class SnowSurface:
    """Where it is (m from where the recording began), and the force in the air before it (N)."""

    depth: float
    air_force: float


def snow_surface(force: FloatArray, sample_distance: float, *, rise: float, hold: float) -> SnowSurface | None:
    """The first block whose force, and that of all blocks over ``hold`` below it, is ``rise`` above the air's.

    Parameters
    ----------
    force
        N, from the first sample on.
    sample_distance
        m.
    rise
        N, above 0.
    hold
        m.

    Returns
    -------
    The surface, or None where no block is such.

    Examples
    --------
    A spike at 12 mm, snow from 30 mm:

    >>> force = np.full(500, 0.05)
    >>> force[120:125], force[300:] = 0.4, 0.3
    >>> found = snow_surface(force, 1e-4, rise=0.01, hold=5e-3)
    >>> round(found.depth * 1e3, 3), round(found.air_force, 3)
    (30.0, 0.05)
    """
    size = max(round(BLOCK / sample_distance), 1)
    length = size * sample_distance
    blocks = force[: len(force) // size * size].reshape(-1, size).mean(axis=1)
    held, air, least = (max(round(each / length), 1) for each in (hold, AIR, LEAST_AIR))
    for index in range(least, len(blocks) - held):
        level = float(np.median(blocks[max(index - air, 0) : index]))
        if (blocks[index : index + held + 1] >= level + rise).all():
            return SnowSurface(index * length, level)
    return None
