"""Slopes: a plane, and a profile of heights over horizontal distance; both the same at every y.

Coordinates of a plane: x down the fall line, y left, z out of the snow. Of a profile: x horizontal, y left, z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import csv_rows
from .._support.units import Facts, Shown, ends
from ..parameters import Allowed, Condition, Declared, Label, Quantity, Search, Word, require_declared
from .raster import number_within

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

Gap: TypeAlias = Literal["error", "interpolate"]

FEWEST_POINTS: Final = 4
SHORTEST_STEP: Final = 1e-6
"""Least distance (m) between points of a profile: below it slopes are rounding."""
LONGEST_GAP: Final = 5.0
"""Distance (m) between points of a profile beyond which it is not joined unasked (modelling assumption)."""
STEEPEST_DEG: Final = 75.0
"""Slope angle (degrees) that a slope may have; steeper is a cliff (modelling assumption)."""


@dataclass(frozen=True, slots=True, repr=False)
class Plane(Declared):
    """A plane with its inclination (rad)."""

    angle: Annotated[
        float,
        Quantity("slope.angle_deg", 'inclination of the plane; only with kind = "plane"'),
        Label(Message("slope angle"), symbol="α"),
        Allowed(0.0, STEEPEST_DEG, origin="choice: steeper is a cliff"),
        Condition("slope.kind", "plane"),
        Search(10.0, -15.0, 15.0, about=True),
    ]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profile(Shown):
    """Heights over horizontal distance, joined by cubics that do not overshoot (PCHIP). The tables are read-only.

    Attributes
    ----------
    x, height
        Horizontal distance, strictly rising, and height (m), (n,), n ≥ 4.
    source
        Where it comes from, in words.
    gap
        Action if neighbouring points are more than 5 m apart: "error", or "interpolate".

    Raises
    ------
    ParameterError
        Fewer than four points, a number that is not finite, x that does not rise, a gap, or a cliff; the place is
        named.

    See Also
    --------
    skisnow.scenario.Plane

    Notes
    -----
    Fritsch and Carlson's monotone cubics (1980) keep slope continuous; curvature jumps at the points.

    Examples
    --------
    >>> profile = Profile([0.0, 1.0, 2.0, 3.0], [0.0, -0.5, -1.0, -1.5])
    >>> profile.ends, float(profile.heights(1.5)), float(profile.gradients(1.5))
    ((0.0, 3.0), -0.75, -0.5)
    """

    x: FloatArray
    height: FloatArray
    source: Annotated[
        str,
        Word(
            "slope.profile",
            'CSV file with the columns x and y, horizontal distance and height in m; only with kind = "profile"',
            label=Message("file of the profile"),
            word_of=str,
            names_file=True,
            condition=Condition("slope.kind", "profile"),
        ),
    ] = field(default=Message("given as numbers"), kw_only=True)
    gap: Annotated[
        Gap,
        Quantity(
            "slope.profile_gap",
            "action if points of the profile are more than 5 m apart",
            origin="choice: there are no measurements in between",
        ),
        Label(Message("gaps in the profile")),
        Condition("slope.kind", "profile"),
    ] = field(default="error", kw_only=True)
    _curve: PchipInterpolator = field(init=False, repr=False)

    def __post_init__(self) -> None:
        require_declared(self)
        from scipy.interpolate import PchipInterpolator  # slow to load, and no plane asks for it

        for name in ("x", "height"):
            table = np.array(getattr(self, name), dtype=float)
            table.flags.writeable = False
            object.__setattr__(self, name, table)
        _require_points(self.x, self.height)
        if self.gap != "interpolate":
            _require_no_gap(self.x)
        object.__setattr__(self, "_curve", PchipInterpolator(self.x, self.height))
        _require_no_cliff(self.x, self.coefficients)

    def _repr_facts(self) -> Facts:
        """Title with the number of points, the ranges of x and height (m), and the source."""
        return Facts(f"of {len(self.x)} points: x {ends(self.x, 'm')}, height {ends(self.height, 'm')}; {self.source}")

    @property
    def ends(self) -> tuple[float, float]:
        """The first and the last x (m)."""
        return float(self.x[0]), float(self.x[-1])

    @property
    def coefficients(self) -> FloatArray:
        """Coefficients of the cubic in x - x[i] on each piece i, highest power first, (4, n - 1)."""
        return np.asarray(self._curve.c)

    def heights(self, x: npt.ArrayLike) -> FloatArray:
        """Heights (m) at x (m, any shape); beyond the ends the slope of the end continues."""
        at = np.asarray(x, float)
        within = np.clip(at, *self.ends)
        return np.asarray(self._curve(within) + self._curve(within, 1) * (at - within))

    def gradients(self, x: npt.ArrayLike) -> FloatArray:
        """dz/dx at x (m, any shape): below 0 where it falls; beyond the ends that of the end."""
        return np.asarray(self._curve(np.clip(np.asarray(x, float), *self.ends), 1))


def _require_points(x: FloatArray, height: FloatArray) -> None:
    """Reject too few points, numbers that are not finite, and x that does not rise from point to point."""
    if x.ndim != 1 or x.shape != height.shape or len(x) < FEWEST_POINTS:
        raise ParameterError(
            "a profile needs {fewest_points} points or more, each with x and height; there are x of shape {shape} "
            "and heights of shape {shape_2}"
        ).tag("wrong_shape", fewest_points=FEWEST_POINTS, shape=str(x.shape), shape_2=str(height.shape))
    for name, table in (("x", x), ("the height", height)):
        if not np.isfinite(table).all():
            place = int(np.argmin(np.isfinite(table)))
            raise ParameterError("{name} of point {place} of the profile is {value}; correct it").tag(
                "not_a_number", name=name, place=place + 1, value=table[place]
            )
    rises = np.diff(x) >= SHORTEST_STEP
    if not rises.all():
        place = int(np.argmin(rises))
        raise ParameterError(
            "x of the profile's point {place} is {x:g} m after {before:g} m; x must rise by {shortest_step:g} m or "
            "more from point to point. Sort the points, and keep one of those at the same place"
        ).tag("out_of_range", place=place + 2, x=x[place + 1], before=x[place], shortest_step=SHORTEST_STEP)


def _require_no_gap(x: FloatArray) -> None:
    """Reject a profile with neighbouring points too far apart in x."""
    widths = np.diff(x)
    place = int(np.argmax(widths))
    if widths[place] > LONGEST_GAP:
        raise ParameterError(
            "the profile has no point between x = {x:g} m and {end:g} m, a gap of {width:.3g} m; at most "
            '{longest_gap:g} m are joined unasked. Add points, or write slope.profile_gap = "interpolate"'
        ).tag("out_of_range", x=x[place], end=x[place + 1], width=widths[place], longest_gap=LONGEST_GAP)


def _require_no_cliff(x: FloatArray, coefficients: FloatArray) -> None:
    """Reject a slope that is too steep at an end of a cubic piece or where its curvature vanishes."""
    a, b, c, _ = coefficients
    width = np.diff(x)
    with np.errstate(divide="ignore", invalid="ignore"):
        turning = np.nan_to_num(-b / (3.0 * a), posinf=0.0, neginf=0.0)
    at = np.stack([np.zeros_like(width), np.clip(turning, 0.0, width), width])
    steepness = np.abs((3.0 * a * at + 2.0 * b) * at + c)
    worst, piece = np.unravel_index(int(np.argmax(steepness)), steepness.shape)
    if steepness[worst, piece] > math.tan(math.radians(STEEPEST_DEG)):
        degrees = math.degrees(math.atan(steepness[worst, piece]))
        raise ParameterError(
            "the profile has a cliff of {degrees:.3g} degrees between x = {x:g} m and {end:g} m; at most "
            "{steepest_deg:g} degrees are allowed, a ski cannot follow more. Correct its heights or end it there"
        ).tag("out_of_range", degrees=degrees, x=x[piece], end=x[piece + 1], steepest_deg=STEEPEST_DEG)


COLUMNS: Final = ("x", "y")
_ACTION: Final = Message("Write horizontal distance and height in m, with a decimal point, under a first line x,y.")


def read_profile(path: str | Path, *, gap: Gap = "error") -> Profile:
    """Read a profile.

    path: A CSV file with a first line ``x,y``: horizontal distance, rising, and height, both in m. Commas, semicolons
        or tabs between cells; decimal points, or commas where cells are parted otherwise. Other columns are not read.
    gap: Action if neighbouring points are more than 5 m apart: "error", or "interpolate".
    Raises ParameterError: the file cannot be read, a column is missing, a cell is not a finite number or an impossible
        one (the message names file, row, column and value), or the points do not form a profile: too few, x that does
        not rise, a gap, a cliff.
    """
    rows = csv_rows(path, COLUMNS, action=_ACTION)
    numbers = [[number_within(row, name) for name in COLUMNS] for row in rows]
    table = np.array(numbers, dtype=float).reshape(-1, 2)
    try:
        return Profile(table[:, 0], table[:, 1], gap=gap, source=str(path))
    except ParameterError as error:
        raise error.at(path) from error
