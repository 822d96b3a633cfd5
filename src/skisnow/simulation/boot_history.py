"""The boots over time: where they were, and what the skis did to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.display import Facts, Shown, field_facts
from ..geometry.boot_axes import angles_of

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class BootHistory(Shown):
    """Index 0 the time (n), 1 the boot (0 left, 1 right).

    Attributes
    ----------
    place
        (n, 2, 3) in the slope's axes (m).
    axes
        (n, 2, 3, 3): ahead, left across the base, off the base, as rows in the slope's axes.
    own_force, own_moment
        (n, 2, 3) of the ski on its boot, about it, in the boot's axes (N, N m).
    centre_of_mass
        (n, 3) of the body that they carry, without the skis (m).
    """

    place: FloatArray
    axes: FloatArray
    own_force: FloatArray
    own_moment: FloatArray
    centre_of_mass: FloatArray

    @property
    def force(self) -> FloatArray:
        """(n, 2, 3) of the ski on its boot, in the slope's axes (N)."""
        return np.asarray(np.einsum("nkca,nkc->nka", self.axes, self.own_force))

    @property
    def moment(self) -> FloatArray:
        """(n, 2, 3) of the ski on its boot, about it, in the slope's axes (N m)."""
        return np.asarray(np.einsum("nkca,nkc->nka", self.axes, self.own_moment))

    @property
    def angles(self) -> FloatArray:
        """(n, 2, 3) edge angle, pitch and heading in the slope's axes (rad)."""
        return angles_of(self.axes)

    def _facts(self) -> Facts:
        return field_facts(
            self, {"place": "m", "axes": "", "own_force": "N", "own_moment": "N m", "centre_of_mass": "m"}
        )
