"""The recording that the reader of one format returns: the columns of a file, before a projection and before flags."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from ..projection import GeodeticPoint
from ..track import Axes

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..solution import SolutionArray

    BoolArray = npt.NDArray[np.bool_]
    FloatArray = npt.NDArray[np.float64]
    IntArray = npt.NDArray[np.int64]


@dataclass(eq=False)
class Recording:
    """Points in the order of a file; absent numbers are NaN.

    Attributes
    ----------
    name
        The file's name.
    places_in_file
        Where each point stands, for messages: ``"row 12"``.
    time : (n,) s
        On any zero; ``start`` belongs to the first.
    place : (n, 3)
        Latitude (°), longitude (°), height (m) where ``is_geodetic``, else x, y, z in m.
    velocity : (n, 3) m/s or None
        East, north, up at the point itself, or along x, y, z.
    place_sd : (n, 3) m or None
        East, north, up at the point itself, or along x, y, z.
    fix : (n,) bool or None
        Whether the receiver had a fix, where the file says so.
    solution : (n,) or None
        As in `Track`; what it says of points without a fix does not count.
    axes_in_words
        Of places that are not geodetic.
    heights
        In words: above what.
    default_origin
        Where the file itself names an origin.
    columns
        The file's own names of ``x``, ``y``, ``z``, for messages.
    segment : (n,) or None
        Number of the segment of each point, if the file separates segments.
    not_finite : (n,) bool or None
        True for points of which the file has a cell such as `nan` or `inf`.
    notes
        Sentences on how the file was read.
    """

    name: str
    places_in_file: Sequence[str]
    time: FloatArray
    place: FloatArray
    is_geodetic: bool
    time_scale: str
    start: datetime | None = None
    first_time: float = 0.0
    speed: FloatArray | None = None
    speed_kind: str = "as recorded"
    velocity: FloatArray | None = None
    place_sd: FloatArray | None = None
    speed_sd: FloatArray | None = None
    odometer: FloatArray | None = None
    fix: BoolArray | None = None
    solution: SolutionArray | None = None
    axes: Axes = "file"
    axes_in_words: str = "x, y, z of the file, in m"
    heights: str = "as in the file"
    default_origin: GeodeticPoint | None = None
    further_columns: tuple[str, ...] = ()
    left_out: Mapping[str, int] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    segment: IntArray | None = None
    not_finite: BoolArray | None = None
    notes: tuple[str, ...] = ()
