"""A track: where something was, when, and how well that is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Track:
    """Points in the order of their file; nothing is left out, what is doubtful is marked.

    Attributes
    ----------
    name
        For messages and figures: the file's name, or what the user called it.
    time : (n,) s
        From the first point, on the file's own time scale.
    place : (n, 3) m
        In the track's frame; the height is NaN where it was not recorded.
    speed : (n,) m/s
        As recorded; NaN where it was not.
    velocity : (n, 3) m/s or None
        As recorded, in the track's frame; rows of NaN where it was not.
    place_sd : (n, 3) m or None
        Standard deviation of each coordinate as the receiver states it, NaN where it does not.
    speed_sd : (n,) m/s or None
        Standard deviation of the speed as the receiver states it.
    odometer : (n,) m or None
        The device's own distance.
    start : datetime or None
        Of the first point, where the file has a date.
    time_scale
        ``"UTC"``, ``"GPS"``, ``"local"`` (of the file, without a date or zone).
    frame
        In words: the slope's axes, or the local projection with its origin.
    marks
        CODE to (n,) bool: which points carry the mark. Marked points stay.
    """

    name: str
    time: FloatArray
    place: FloatArray
    speed: FloatArray
    time_scale: str
    frame: str
    velocity: FloatArray | None = None
    place_sd: FloatArray | None = None
    speed_sd: FloatArray | None = None
    odometer: FloatArray | None = None
    start: datetime | None = None
    marks: Mapping[str, npt.NDArray[np.bool_]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.time)

    @property
    def marked(self) -> dict[str, int]:
        """How many points carry each mark, marks without any left out."""
        return {code: int(np.sum(where)) for code, where in self.marks.items() if np.any(where)}
