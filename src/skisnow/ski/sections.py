"""Cross sections of a ski."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SkiSections(ShownFields):
    """Cross sections of a ski at chosen stations; every array has the shape of ``station``.

    Attributes
    ----------
    station
        From the boot, positive forward (m).
    width, base_height, bending_stiffness, torsional_stiffness, mass_per_length
        As in `Ski`.
    """

    station: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending_stiffness: FloatArray
    torsional_stiffness: FloatArray
    mass_per_length: FloatArray

    def at(self, station: FloatArray) -> SkiSections:
        """Sections at other stations (m, any shape) between these, which fall, interpolated linearly."""
        rising = self.station[::-1]

        def along(table: FloatArray) -> FloatArray:
            return np.asarray(np.interp(station, rising, table[::-1]))

        return SkiSections(
            station,
            along(self.width),
            along(self.base_height),
            along(self.bending_stiffness),
            along(self.torsional_stiffness),
            along(self.mass_per_length),
        )
