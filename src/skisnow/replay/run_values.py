"""Checks of the numbers in a run.nc, which may be damaged: the drawing needs finite ones of a plausible size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from ..scenario.keys import SCENARIO_KEYS

FloatArray: TypeAlias = npt.NDArray[np.float64]

LARGEST: Final = 1e9
"""Largest number of a run in SI; also its squares are numbers in the single precision of a replay."""
SMALLEST_RADIUS: Final = 1e-3
"""Smallest radius of a turn (m)."""
_ORTHOGONAL: Final = 1e-6


def require_drawable(arrays: Mapping[str, FloatArray]) -> None:
    """Check a run's arrays, named as in run.nc with vectors in one.

    Raises
    ------
    ParameterError
        A number is not finite or too large, times do not rise, or an attitude is not a rotation.
    """
    require_finite(arrays)
    if np.any(np.diff(arrays["time"]) <= 0.0):
        raise ParameterError("time does not rise")
    if np.any(np.diff(arrays["station"]) >= 0.0):
        raise ParameterError("station does not fall from tip to tail")
    attitude = arrays["attitude"]
    product = attitude @ attitude.swapaxes(-1, -2)
    if attitude.shape[-2:] != (3, 3) or not np.allclose(product, np.eye(3), atol=_ORTHOGONAL):
        raise ParameterError("attitude is not a rotation")


def require_finite(arrays: Mapping[str, FloatArray]) -> None:
    """Check that numbers are finite and not too large; errors as in `require_drawable`."""
    for name, values in arrays.items():
        # the radius of a straight path is infinite
        sound = np.abs(values) >= SMALLEST_RADIUS if name == "turn_radius" else np.abs(values) <= LARGEST
        if not sound.all():
            place = np.unravel_index(int(np.argmin(sound)), values.shape)
            raise ParameterError(f"{name} is {values[place]:g} at place {', '.join(str(each + 1) for each in place)}")


def scenario_value(values: Mapping[str, Any], name: str) -> Any:
    """A value of the run's scenario by its full name; None if the scenario lacks it.

    Raises
    ------
    ParameterError
        It is missing, or outside the range of its key.
    """
    value = values.get(name)
    if value is None:
        return None
    return SCENARIO_KEYS[name].in_range(value)


def needed_value(values: Mapping[str, Any], name: str) -> Any:
    """The same of a value that every run has."""
    value = scenario_value(values, name)
    if value is None:
        raise ParameterError(f"{name} is missing")
    return value
