"""Surfaces of a slope: z(x, y) out of the undisturbed snow, and what varies over the place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.errors import ParameterError
from .._support.messages import Message
from .patches import patched

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
                raise ParameterError(
                    Message("Grid: {name} holds a number that is not finite", name=name), code="not_a_number"
                )
        for name, places in (("x", self.x), ("y", self.y)):
            _require_even(name, places)
        if self.values.shape != (len(self.x), len(self.y)):
            raise ParameterError(
                Message(
                    "Grid: values have shape {shape}; for {n_x} places in x and {n_y} in y it must be {needed}",
                    shape=str(self.values.shape),
                    n_x=len(self.x),
                    n_y=len(self.y),
                    needed=str((len(self.x), len(self.y))),
                ),
                code="wrong_shape",
            )

    @property
    def steps(self) -> tuple[float, float]:
        """Between places in x and in y (m); 1 where there is but one place."""
        x, y = (float(np.ptp(places)) / (len(places) - 1) if len(places) > 1 else 1.0 for places in (self.x, self.y))
        return x, y

    def heights(self, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
        """Heights (m) at places x, y (m, of shapes that go together); beyond the border along its slope."""
        return self._going_on(x, y)[0]

    def gradients(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """dz/dx and dz/dy at places x, y (m); beyond the border those of the border."""
        _, along_x, along_y = self._going_on(x, y)
        return along_x, along_y

    def values_at(self, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
        """Values of a grid at places x, y (m); beyond the border its last value."""
        return self._patched(x, y)[0]

    def _patched(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Value, slopes (1/m), and how far beyond the border along those slopes (in the value's unit)."""
        at = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        steps, first = self.steps, (self.x[0], self.y[0])
        counts = self.values.shape
        where = [(coordinate.ravel() - start) / step for coordinate, start, step in zip(at, first, steps, strict=True)]
        inside = [np.clip(coordinate, 0.0, count - 1.0) for coordinate, count in zip(where, counts, strict=True)]
        value, per_x, per_y = patched(self.values, *inside)
        beyond = (where[0] - inside[0]) * per_x + (where[1] - inside[1]) * per_y
        shape = at[0].shape
        slopes = (per_x / steps[0], per_y / steps[1])
        return value.reshape(shape), slopes[0].reshape(shape), slopes[1].reshape(shape), beyond.reshape(shape)

    def _going_on(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        value, along_x, along_y, beyond = self._patched(x, y)
        return value + beyond, along_x, along_y

    @classmethod
    def along(cls, x: npt.ArrayLike, values: npt.ArrayLike) -> Grid:
        """Values over x (n,), the same at every y: a profile."""
        return cls(np.asarray(x, float), np.zeros(1), np.asarray(values, float)[:, None])


def _require_even(name: str, places: FloatArray) -> None:
    if places.ndim != 1 or not len(places):
        raise ParameterError(
            Message(
                "Grid: {name} must be a row of one place or more, its shape is {shape}",
                name=name,
                shape=str(places.shape),
            ),
            code="wrong_shape",
        )
    step = np.diff(places)
    if len(step) and (step.min() <= 0.0 or np.ptp(step) > EVEN * len(step) * np.abs(places).max()):
        raise ParameterError(
            Message(
                "Grid: places in {name} must rise evenly; their steps go from {min:g} to {max:g} m",
                name=name,
                min=step.min(),
                max=step.max(),
            ),
            code="not_rising",
        )
