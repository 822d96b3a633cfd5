"""Air drag on the skier, as a vector."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .parameter_checks import ABOVE_ZERO, DRAG_AREA, NOT_BELOW_ZERO, CheckedParameters


@dataclass(frozen=True, slots=True)
class AirDrag(CheckedParameters):
    """F = -½ ρ C_dA w w⃗, with w⃗ the velocity relative to the air and w its size.

    drag_area: C_dA (m²), ≥ 0; 0 is drag switched off.
    air_density: ρ (kg/m³): about 1.3 at 0 °C at sea level, 1.0 at 2,000 m.

    Range: 0.23 m² (tuck) to 0.66 m² (upright), Supej and others (2022), Appl. Sci. 12, 902. The size of the velocity
    goes over all components: the force on the components taken one by one would depend on the frame.

    ½·1.2·0.5·20 = 6 kg/s; at 12 m/s along x and 16 m/s along y it takes 72 and 96 N.

    >>> drag = AirDrag(drag_area=0.5, air_density=1.2)
    >>> [round(component, 9) for component in drag.force([12.0, 16.0]).tolist()]
    [-72.0, -96.0]
    """

    drag_area: Annotated[float, NOT_BELOW_ZERO]
    air_density: Annotated[float, ABOVE_ZERO]

    def _check_further(self) -> None:
        """Warn of a drag area outside the measured range, unless it is 0."""
        if self.drag_area > 0:
            DRAG_AREA.warn_outside(self.drag_area, "AirDrag", stacklevel=4)

    def force(self, velocity: npt.ArrayLike, *, wind: npt.ArrayLike = 0.0) -> FloatArray:
        """Force (N) of the air on a body with this velocity over the ground.

        velocity: m/s, shape (..., d) with d components.
        wind: velocity of the air (m/s) in the same components (default: still air).
        Returns: shape (..., d).
        """
        relative = np.asarray(velocity, float) - np.asarray(wind, float)
        speed = np.linalg.norm(relative, axis=-1, keepdims=True)
        result: FloatArray = -0.5 * self.air_density * self.drag_area * speed * relative
        return result
