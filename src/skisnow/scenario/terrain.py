"""Measured terrain: heights over a grid, from a CSV table, an ESRI ASCII grid or a GeoTIFF."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import Facts, Shown, amount, ends
from .._support.user_files.text_files import is_file
from ..geometry import surfaces
from ..geometry.surfaces import Grid, smoothed
from ..parameters import Allowed, Condition, Label, Quantity, Word, require_declared
from .raster import PlacedValues, require_metres
from .raster_formats import read_esri_ascii, read_geotiff, read_grid_table
from .slope import STEEPEST_DEG, Plane, Profile

FEWEST_PLACES: Final = 2
"""In x and in y."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Terrain(Shown):
    """Heights over evenly spaced places, joined by smooth patches. The tables are read-only.

    Attributes
    ----------
    x, y
        Places (m), (n,) and (m,), rising evenly, in the coordinates of their source: x east and y north of a map.
    height
        (n, m) as measured (m).
    source
        Where they come from, in words.
    smoothing
        Length λ ≥ 0 (m): waves of this length keep half of their height, longer ones more.
    origin_x, origin_y
        The place of the source (m) at which x and y of the scenario are 0.
    surface
        Surface under the skis, in the scenario's coordinates: smoothed, and counted from the origin.

    Raises
    ------
    ParameterError
        Fewer than two places in x or y, uneven places, a number that is not finite, or a cliff; the place is named.

    See Also
    --------
    skisnow.Profile
    skisnow.scenario.Plane

    Notes
    -----
    Ferguson's bicubic patches: height and slope are continuous, a plane is exact. Smoothing is the Gaussian filter of
    ISO 16610-21 along x and y, with straight lines at the borders.

    Examples
    --------
    >>> terrain = Terrain([0.0, 1.0, 2.0], [0.0, 1.0], [[0.0, 0.1], [-0.5, -0.4], [-1.0, -0.9]])
    >>> terrain
    <Terrain of 3 × 2 places 1 m apart: x 0 to 2 m, y 0 to 1 m, height -1 to 0.1 m; given as numbers>
    >>> round(float(terrain.surface.heights(1.5, 0.5)), 12)
    -0.7
    """

    x: FloatArray
    y: FloatArray
    height: FloatArray
    source: Annotated[
        str,
        Word(
            "slope.grid",
            "heights over a grid: CSV file with the columns x_m, y_m, z_m, ESRI ASCII grid (.asc), or GeoTIFF (.tif, "
            'with the extra geotiff); only with kind = "grid"',
            word_of=str,
            names_file=True,
            condition=Condition("slope.kind", "grid"),
        ),
    ] = field(default=Message("given as numbers"), kw_only=True)
    smoothing: Annotated[
        float,
        Quantity(
            "slope.smooth_m",
            'length to which the grid is smoothed: a wave so long keeps half its height; only with kind = "grid"',
        ),
        Allowed(0.0, 1000.0, origin="choice: the surface as it was measured"),
        Condition("slope.kind", "grid"),
    ] = field(default=0.0, kw_only=True)
    origin_x: Annotated[
        float,
        Quantity(
            "slope.origin_x_m",
            "x of the grid's file (east of a map) where the scenario's x is 0; only with kind = \"grid\"",
            origin="choice: the file's own",
        ),
        Label(Message("x of the grid at the origin")),
        Condition("slope.kind", "grid"),
    ] = field(default=0.0, kw_only=True)
    origin_y: Annotated[
        float,
        Quantity(
            "slope.origin_y_m",
            "y of the grid's file (north of a map) where the scenario's y is 0; only with kind = \"grid\"",
            origin="choice: the file's own",
        ),
        Label(Message("y of the grid at the origin")),
        Condition("slope.kind", "grid"),
    ] = field(default=0.0, kw_only=True)
    surface: Grid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        require_declared(self)
        measured = Grid(self.x, self.y, self.height)  # checks and copies
        for name, values in (("x", measured.x), ("y", measured.y), ("height", measured.values)):
            object.__setattr__(self, name, values)
        if min(measured.values.shape) < FEWEST_PLACES:
            raise ParameterError(
                "a grid needs {fewest_places} places or more in x and in y; it has {n_x} and {n_y}"
            ).tag("out_of_range", fewest_places=FEWEST_PLACES, n_x=len(self.x), n_y=len(self.y))
        height = smoothed(measured.values, measured.steps, cutoff=self.smoothing)
        object.__setattr__(self, "surface", Grid(self.x - self.origin_x, self.y - self.origin_y, height))
        _require_no_cliff(self.surface)

    def _repr_facts(self) -> Facts:
        """Title with the size, spacing, ranges and smoothing of the grid, and its source."""
        n, m = self.height.shape
        step_x, step_y = (amount(step, "m") for step in self.surface.steps)
        apart = step_x if step_x == step_y else f"{step_x} and {step_y}"
        over = f"smoothed to {amount(self.smoothing, 'm')}, " if self.smoothing else ""
        reach = f"x {ends(self.surface.x, 'm')}, y {ends(self.surface.y, 'm')}"
        height = ends(np.array([self.height.min(), self.height.max()]), "m")
        return Facts(f"of {n} × {m} places {apart} apart: {reach}, height {height}; {over}{self.source}")


def _require_no_cliff(surface: Grid) -> None:
    """Reject terrain that is too steep at the places or halfway between them."""
    for shift in (0.0, 0.5):
        x, y = (places + shift * step for places, step in zip((surface.x, surface.y), surface.steps, strict=True))
        rows = [np.hypot(*surface.gradients(column, y)) for column in x]
        steepest = np.array([row.max() for row in rows])
        i = int(np.argmax(steepest))
        if steepest[i] > math.tan(math.radians(STEEPEST_DEG)):
            j, degrees = int(np.argmax(rows[i])), math.degrees(math.atan(steepest[i]))
            raise ParameterError(
                "the grid has a cliff of {degrees:.3g} degrees at x = {x:.10g} m, y = {y:.10g} m; at most "
                "{steepest_deg:g} degrees are allowed, a ski cannot follow more. Correct its heights, smooth it over "
                "more metres, or cut out a part without it"
            ).tag("out_of_range", degrees=degrees, x=x[i], y=y[j], steepest_deg=STEEPEST_DEG)


HEIGHT: Final = "z_m"
_ACTION: Final = Message(
    "Write one row for each place of an even grid, with a decimal point, in m, under a first line x_m,y_m,z_m; or an "
    "ESRI ASCII grid (.asc) or a GeoTIFF (.tif)."
)


def read_terrain(path: str | Path, *, smoothing: float = 0.0, origin_x: float = 0.0, origin_y: float = 0.0) -> Terrain:
    """Read measured terrain.

    path: ``.asc``, ``.agr``, or a file that begins with ``ncols``: ESRI ASCII grid. ``.tif`` or ``.tiff``: GeoTIFF,
        with the heights in the first band. Any other: CSV with the columns ``x_m``, ``y_m``, ``z_m``, rows in any
        order.
    smoothing, origin_x, origin_y: As of `Terrain` (m).
    Raises ParameterError: the file cannot be read or is not a grid; file, row, column and value are named.
    """
    raster = _read_heights(Path(path))
    require_metres(path, raster, HEIGHT, steepest=math.tan(math.radians(STEEPEST_DEG)))
    try:
        return Terrain(
            raster.x, raster.y, raster.columns[HEIGHT],
            source=str(path), smoothing=smoothing, origin_x=origin_x, origin_y=origin_y,
        )  # fmt: skip
    except ParameterError as error:
        raise error.at(path) from error


def _read_heights(path: Path) -> PlacedValues:
    """Heights with their places from an Esri ASCII grid, a GeoTIFF or a table, by ending or first bytes."""
    kind = path.suffix.lower()
    if kind in (".asc", ".agr"):
        return read_esri_ascii(path, column=HEIGHT)
    if kind in (".tif", ".tiff"):
        return read_geotiff(path, column=HEIGHT)
    if is_file(path):
        with path.open("rb") as file:
            if file.read(64).lstrip().lower().startswith(b"ncols"):
                return read_esri_ascii(path, column=HEIGHT)
    return read_grid_table(path, (HEIGHT,), action=_ACTION)


Slope: TypeAlias = Plane | Profile | Terrain

PROFILE_STEP: Final = 0.02
"""Spacing (m) of a profile's table."""


def surface_of(slope: Slope) -> surfaces.Plane | surfaces.Grid:
    """Surface of a slope in the form that `SnowField` accepts."""
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
    if isinstance(slope, Plane):
        return np.broadcast_to([0.0, 0.0, 1.0], (*np.broadcast_shapes(np.shape(x), np.shape(y)), 3))
    x, y = np.asarray(x, float), np.asarray(y, float)
    along_x, along_y = (
        slope.surface.gradients(x, y) if isinstance(slope, Terrain) else (slope.gradients(x), np.zeros_like(x))
    )
    stretch = np.sqrt(1.0 + along_x**2 + along_y**2)
    return np.stack([-along_x, -along_y, np.ones_like(along_x)], axis=-1) / stretch[..., None]


def down_and_left(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors (…, 3) in surfaces with these normals (…, 3): towards x as seen from above, and to the left."""
    ahead = np.stack([normal[..., 2], np.zeros_like(normal[..., 0]), -normal[..., 0]], axis=-1)
    ahead = ahead / np.linalg.norm(ahead, axis=-1, keepdims=True)
    return ahead, np.cross(normal, ahead)


def extent_of(slope: Slope) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ends (first, last) of x and of y (m) of a slope; infinite for a slope without end."""
    endless = (-math.inf, math.inf)
    if isinstance(slope, Terrain):
        x, y = slope.surface.x, slope.surface.y
        return (float(x[0]), float(x[-1])), (float(y[0]), float(y[-1]))
    return (endless if isinstance(slope, Plane) else slope.ends), endless
