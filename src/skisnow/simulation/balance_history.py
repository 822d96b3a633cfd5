"""How the body of a run leant over its skis, and what would have been in balance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.display import Facts, Shown, field_facts

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class BalanceHistory(Shown):
    """Over time, (n,) each, in axes along the skis, to their left and out of the snow; leans are positive to the left.

    Attributes
    ----------
    lean
        Of the line from the middle of the boots to the centre of mass, from the snow's normal (rad).
    pressure_lean
        Of the line from the centre of pressure to it (rad); NaN where the skis do not bear.
    balanced_lean
        Of a body in balance with speed v and path radius R of the centre of mass:
        tan Ψ = v²/(R g cos α) - tan α cos χ, χ from the horizontal (rad); NaN at both ends of a run.
    rolling_lean
        The same with what the body's roll and the rise of its centre of mass take: tan Ψ = (a_l + I φ''/(m z))/(a_n),
        a_l and a_n the accelerations to the left and off the snow without gravity's share, φ the body's roll, z the
        height of the centre of mass (rad); NaN at both ends.
    angulation
        Mean edge angle less the lean (rad).
    leg
        From the middle of the boots to the centre of mass (m).
    pressure
        Centre of pressure from the middle of the boots, to the left (m); NaN where the skis do not bear.
    load
        (n, 2) force of each ski on its boot along the snow's normal (N).

    See Also
    --------
    skisnow.simulate
    """

    lean: FloatArray
    pressure_lean: FloatArray
    balanced_lean: FloatArray
    rolling_lean: FloatArray
    angulation: FloatArray
    leg: FloatArray
    pressure: FloatArray
    load: FloatArray

    def _facts(self) -> Facts:
        units = dict.fromkeys(("lean", "pressure_lean", "balanced_lean", "rolling_lean", "angulation"), "rad")
        return field_facts(self, units | {"leg": "m", "pressure": "m", "load": "N"})
