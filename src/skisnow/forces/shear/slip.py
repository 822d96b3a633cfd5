"""Shear displacement: how far an edge moves across until the snow resists with its full strength."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray

SHEAR_DISPLACEMENT: Final = 0.02e-3
"""u_y (m) (modelling assumption: not measured). The law of the paper, all of S_f or nothing, is its limit 0.

With this one a circle at 80 % of the grip is half a percent wide, and a smaller one gains nothing:
docs/methods/side-force.md.
"""


RESIDUAL_RATIO: Final = 1.0
"""Strength after slip over that before it (modelling assumption: the paper measured where shearing starts)."""
SLIP_WEAKENING: Final = 1e-3
"""Slip (m) over which it is reached (modelling assumption)."""


def strength_left(
    slip: npt.ArrayLike, *, residual_ratio: float = RESIDUAL_RATIO, slip_weakening: float = SLIP_WEAKENING
) -> FloatArray:
    """Share of a strength that is left after a slip: 1 - (1 - r) min(slip/d, 1).

    slip: how far the edge has slipped across at a place on the snow (m), ≥ 0.
    residual_ratio: r, 0 to 1; 1: nothing is lost.
    slip_weakening: d (m), > 0.

    Range: r and d are not measured for groomed snow. Mössner and others (2013) presume that snow that is being sheared
    is weaker than S_f. McClung (1977, J. Glaciol. 19(81)) found softening after the peak in direct shear of snow. To
    fall in proportion to the slip is the plainest form of slip weakening (modelling assumption).

    Half of the strength, reached over 2 mm: after 1 mm three quarters are left.

    >>> float(strength_left(1e-3, residual_ratio=0.5, slip_weakening=2e-3))
    0.75
    """
    gone = np.minimum(np.asarray(slip, float) / slip_weakening, 1.0)
    result: FloatArray = 1.0 - (1.0 - residual_ratio) * gone
    return result


Bearing: TypeAlias = Literal["whole-edge", "loaded-height"]
"""Height by which an edge holds against a motion inwards: all of its depth, or the part whose base bears, the square
root of the force over that of virgin snow (modelling assumption)."""
