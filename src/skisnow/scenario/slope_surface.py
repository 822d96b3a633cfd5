"""The surface of a slope of any kind, in the coordinates of its scenario."""

from __future__ import annotations

import math
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ..geometry import surfaces
from .slope import Plane, Profile
from .terrain import Terrain

FloatArray: TypeAlias = npt.NDArray[np.float64]
Slope: TypeAlias = Plane | Profile | Terrain

PROFILE_STEP: Final = 0.02
"""Spacing (m) of a profile's table."""


def surface_of(slope: Slope) -> surfaces.Plane | surfaces.Grid:
    """What a `SnowField` takes."""
    if isinstance(slope, Plane):
        return surfaces.Plane()
    if isinstance(slope, Terrain):
        return slope.surface
    start, end = slope.ends
    x = np.linspace(start, end, math.ceil((end - start) / PROFILE_STEP) + 1)
    return surfaces.Grid.along(x, slope.heights(x))


def heights_of(slope: Slope, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
    """Heights (m) at places x, y (m, of one shape): z of the snow."""
    if isinstance(slope, Plane):
        return np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))
    return slope.surface.heights(x, y) if isinstance(slope, Terrain) else slope.heights(x)


def normals_of(slope: Slope, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
    """Unit normals (…, 3) out of the snow at places x, y (m, of one shape)."""
    along_x, along_y = _gradients(slope, np.asarray(x, float), np.asarray(y, float))
    stretch = np.sqrt(1.0 + along_x**2 + along_y**2)
    return np.stack([-along_x, -along_y, np.ones_like(along_x)], axis=-1) / stretch[..., None]


def _gradients(slope: Slope, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    if isinstance(slope, Terrain):
        return slope.surface.gradients(x, y)
    return (np.zeros_like(x) if isinstance(slope, Plane) else slope.gradients(x)), np.zeros_like(x)


def down_and_left(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors (…, 3) in surfaces with these normals (…, 3): towards x as seen from above, and to the left."""
    ahead = np.stack([normal[..., 2], np.zeros_like(normal[..., 0]), -normal[..., 0]], axis=-1)
    ahead = ahead / np.linalg.norm(ahead, axis=-1, keepdims=True)
    return ahead, np.cross(normal, ahead)


def reach_of(slope: Slope) -> tuple[tuple[float, float], tuple[float, float]]:
    """The first and last x, and y (m), that the slope has; infinite where it has no end."""
    endless = (-math.inf, math.inf)
    if isinstance(slope, Terrain):
        x, y = slope.surface.x, slope.surface.y
        return (float(x[0]), float(x[-1])), (float(y[0]), float(y[-1]))
    return (endless if isinstance(slope, Plane) else slope.ends), endless
