"""The recording that the reader of one format returns: the columns of a file, before a projection and before flags."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Final

from ..._support.arrays import BoolArray, IntArray
from ..._support.errors import FieldDataError
from ..._support.messages import Message, current_language, template
from ...parameters import Quantity
from ..projection import HIGHEST
from ..track import Track


@dataclass(frozen=True, eq=False, repr=False)
class Recording(Track):
    """A track as the reader of one format returns it: times with any zero, places as written, without flags.

    ``velocity`` and ``place_sd`` are east, north, up at the point itself if ``is_geodetic``, otherwise along x, y, z.

    places_in_file: place of each point in the file, for messages: ``"row 12"``.
    time_scale: as of a track (default: UTC).
    is_geodetic: True if ``place`` is latitude (°), longitude (°) and height (m), otherwise x, y, z in m.
    fix: (n,) bool or None, True if the receiver had a fix; None if unknown.
    heights: description of the reference of the heights.
    columns: names of ``x``, ``y``, ``z`` in the file, for messages.
    segment: (n,) or None, number of the segment of each point, if the file separates segments.
    not_finite: (n,) bool or None, True for points of which the file has a cell such as `nan` or `inf`.
    """

    time_scale: str = "UTC"
    _: KW_ONLY
    places_in_file: Sequence[str]
    is_geodetic: bool = True
    fix: BoolArray | None = None
    heights: str = "as in the file"
    columns: Mapping[str, str] = field(default_factory=dict)
    segment: IntArray | None = None
    not_finite: BoolArray | None = None


FARTHEST: Final = 1e8
"""Largest place, time and distance (m, s), far beyond those of a ski run."""
FASTEST_NUMBER: Final = 1e4
"""Largest speed (m/s), far beyond that of anything on snow."""
LOCAL: Final = tuple(Quantity(f"{axis}_m", axis, lowest=-FARTHEST, highest=FARTHEST, field=axis) for axis in "xyz")
GEODETIC: Final = tuple(
    Quantity(name, field, lowest=-most, highest=most, field=field)
    for name, field, most in (
        ("latitude_deg", "latitude", 90.0),
        ("longitude_deg", "longitude", 180.0),
        ("height_m", "height", HIGHEST),
    )
)
MOTION: Final = {
    field: Quantity(f"{field}_{unit}", field, lowest=lowest, highest=highest)
    for field, unit, lowest, highest in (
        ("speed", "m_per_s", -FASTEST_NUMBER, FASTEST_NUMBER),
        ("velocity", "m_per_s", -FASTEST_NUMBER, FASTEST_NUMBER),
        ("odometer", "m", -FARTHEST, FARTHEST),
        ("place_sd", "m", 0.0, FARTHEST),
        ("speed_sd", "m_per_s", 0.0, FASTEST_NUMBER),
    )
}
"""Ranges of the quantities of a point, by the field of `Track`."""


_PLACES: Final = {
    "row": template("{place}, row {number}"),
    "point": template("{place}, point {number}"),
    "record": template("{place}, record {number}"),
    "byte": template("{place}, byte {number}"),
}


@dataclass(frozen=True, slots=True)
class TrackProblem:
    """A problem in a file with a track, printable as one sentence.

    ``place`` is the place in the file: ``"row 3"`` of a text file (header: 1), ``"point 12"``, ``"byte 4711"``.
    """

    code: str
    file: str
    place: str | None
    column: str | None
    value: str | None
    allowed: Message
    action: Message

    def __str__(self) -> str:
        """The problem in one line with its code."""
        return self.text(current_language())

    def text(self, language: str) -> str:
        """The sentence in a language."""
        return Message("error {code}: {problem}", code=self.code, problem=self.sentence).text(language)

    @property
    def sentence(self) -> Message:
        """Place, problem, allowed values and fix."""
        place: str = self.file
        if self.place is not None:
            kind, number = self.place.split()
            place = Message(_PLACES[kind], place=place, number=number)
        if self.column is not None:
            place = Message("{place}, column {column}", place=place, column=self.column)
        fields = {"place": place, "allowed": self.allowed, "action": self.action}
        if self.value is None:
            return Message("{place}: allowed: {allowed}. {action}", **fields)
        return Message("{place}: found {value!r}; allowed: {allowed}. {action}", **fields, value=self.value)


_EXPORT_AGAIN: Final = Message("Correct the file, or export it again.")


def track_error(
    code: str,
    file: str,
    allowed: Message,
    action: Message = _EXPORT_AGAIN,
    *,
    place: str | None = None,
    column: str | None = None,
    value: str | None = None,
) -> FieldDataError:
    """Error with one problem, which rejects the file."""
    shown = value if value is None or len(value) <= 60 else f"{value[:57]}…"
    return FieldDataError([TrackProblem(code, file, place, column, shown, allowed, action)])


NOT_FINITE_CELL: Final = re.compile(
    r"[+-]?(?:nan(?:\([\w ]*\))?|inf(?:inity)?|1\.#(?:inf|ind|qnan|snan)0*)", re.IGNORECASE
)
"""Written by C, C++ (also of Windows), Fortran, Python and MATLAB."""


def is_not_finite(cell: str) -> bool:
    """True if a cell is written as a number that is not finite.

    >>> [is_not_finite(cell) for cell in ("-nan(ind)", "Inf", "-1.#IND00", "nano", "1.5", "")]
    [True, True, True, False, False, False]
    """
    return NOT_FINITE_CELL.fullmatch(cell.strip()) is not None
