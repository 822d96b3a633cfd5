"""Surfaces of a slope: z(x, y) out of the undisturbed snow, and what varies over the place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError
from ..shown import ShownFields

FloatArray: TypeAlias = npt.NDArray[np.float64]

EVEN = 1e-9
"""Share of the spacing by which places of a grid may lie unevenly: rounding."""


@dataclass(frozen=True, slots=True)
class Plane:
    """The plane z = 0: the slope's own axes, x down the fall line, y left, z out of the snow (m)."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Grid(ShownFields):
    """Values over evenly spaced places, joined by smooth patches.

    Attributes
    ----------
    x, y
        Places (m), (n,) and (m,), evenly spaced and rising; one place in x or y: the same at every x or y.
    values
        (n, m): height (m), or what varies over the place in its own unit.

    Notes
    -----
    Ferguson's bicubic patches with slopes from central differences: value and slope are continuous, a plane is exact.
    Beyond its border a height goes on along its slope, another quantity with its last value.

    Raises
    ------
    ParameterError
        Places are not evenly spaced and rising, shapes do not fit, or a number is not finite.
    """

    x: FloatArray
    y: FloatArray
    values: FloatArray

    def __post_init__(self) -> None:
        for name in ("x", "y", "values"):
            array = np.array(getattr(self, name), float, ndmin=2 if name == "values" else 1)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
            if not np.all(np.isfinite(array)):
                raise ParameterError(f"Grid: {name} holds a number that is not finite")
        for name, places in (("x", self.x), ("y", self.y)):
            _require_even(name, places)
        if self.values.shape != (len(self.x), len(self.y)):
            raise ParameterError(
                f"Grid: values have shape {self.values.shape}; for {len(self.x)} places in x and {len(self.y)} in y it "
                f"must be {(len(self.x), len(self.y))}"
            )

    @classmethod
    def along(cls, x: npt.ArrayLike, values: npt.ArrayLike) -> Grid:
        """Values over x (n,), the same at every y: a profile."""
        return cls(np.asarray(x, float), np.zeros(1), np.asarray(values, float)[:, None])


def _require_even(name: str, places: FloatArray) -> None:
    if places.ndim != 1 or not len(places):
        raise ParameterError(f"Grid: {name} must be a row of one place or more, its shape is {places.shape}")
    step = np.diff(places)
    if len(step) and (step.min() <= 0.0 or np.ptp(step) > EVEN * len(step) * np.abs(places).max()):
        raise ParameterError(
            f"Grid: places in {name} must rise evenly; their steps go from {step.min():g} to {step.max():g} m"
        )
