"""Rate-dependent snow: a dashpot parallel to the spring, and a Kelvin element in series with it."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray

DAMPING: Final = 0.0
"""c of p = H_V ε + c ε̇ (N s/m³) (modelling assumption, not in the paper's law)."""
DELAYED_SHARE: Final = 0.0
"""H_V/H₂: the delayed depth under a load that stays, over the depth at once (modelling assumption: none)."""
RETARDATION_TIME: Final = 0.1
"""c₂/H₂ (s), in which 1 - 1/e of the delayed depth has come (modelling assumption; only for a delayed depth)."""
DELAYED_SPACING: Final = 1e-3
"""Spacing of places across a groove that keep their delayed depth (m) (modelling assumption, see tests of convergence).
"""


def creep_depth(
    time: npt.ArrayLike,
    *,
    pressure: float,
    snow_hardness: float,
    damping: float = DAMPING,
    delayed_share: float = DELAYED_SHARE,
    retardation_time: float = RETARDATION_TIME,
) -> FloatArray:
    """Depth (m) under a pressure that stays, of snow that was never pressed: p/H_V at once and the delayed depth later.

    time: since the pressure came (s), ≥ 0.
    pressure: p (Pa), ≥ 0.
    snow_hardness, damping, delayed_share, retardation_time: H_V (N/m³), c (N s/m³), H_V/H₂ and c₂/H₂ (s). One of c and
        H_V/H₂ must be 0.
    Returns: ε = p/H_V (1 - e^(-H_V t/c)) with a dashpot, p/H_V (1 + H_V/H₂ (1 - e^(-t/τ))) with a delayed depth.
    Raises ValueError: both are given: then the depth has no such plain form.

    A delayed share of a half, after the retardation time: 1 + 0.5 (1 - 1/e).

    >>> deep = creep_depth(2.0, pressure=2e5, snow_hardness=2e8, delayed_share=0.5, retardation_time=2.0)
    >>> round(float(deep) * 1e3, 3)
    1.316
    """
    if damping > 0.0 and delayed_share > 0.0:
        raise ValueError("creep_depth: a dashpot and a delayed depth together have no plain form; give one of them")
    since, at_once = np.asarray(time, float), pressure / snow_hardness
    if damping > 0.0:
        return np.asarray(-at_once * np.expm1(-snow_hardness * since / damping))
    return np.asarray(at_once * (1.0 - delayed_share * np.expm1(-since / retardation_time)))
