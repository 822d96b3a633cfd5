"""Tracks in NMEA 0183: sentences GGA, GNS, GLL, RMC, VTG, GST, ZDA of any talker.

Sentences with one time of day make one point, whatever their talker. A time of day that falls by more than half a day
begins the next day. Dates count from the first point with a fix: before it receivers send arbitrary dates. Heights
are above the ellipsoid if every point with a height has the geoid's separation, otherwise above mean sea level.

A sentence begins at any `$` and ends before the next `$` or line end, so that joined lines and bytes of other protocols
cost nothing else. A file may have no checksums: a sentence without one is read unless another of its kind has one.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, date, datetime, time, timedelta
from typing import Any, Final

import numpy as np

from ..._support.messages import Message
from ..._support.units import DEGREE
from ..track import Solution, solution_array
from .recording import NOT_FINITE_CELL, Recording, track_error

__all__ = ["SENTENCE", "read_nmea"]

KNOT: Final = 1852.0 / 3600.0
"""m/s in a knot."""
KM_PER_H: Final = 1.0 / 3.6
"""m/s in a km/h."""
QUALITIES: Final[dict[float, Solution]] = {1.0: "code", 2.0: "code", 3.0: "code", 4.0: "fixed", 5.0: "float"}
"""Kind of solution by the quality in GGA; others are dead reckoning, manual input, or simulated."""
MODES: Final[dict[str, Solution]] = {"A": "code", "D": "code", "P": "code", "R": "fixed", "F": "float"}
"""Kind of solution by the mode in GNS, a letter for each satellite system."""
YEARS: Final = (1900, 2200)
"""First and last year of a valid date; others are damage."""
PLACES: Final = ("GGA", "GNS", "RMC", "GLL")
"""Sentences with a place, the best first: GGA and GNS have heights, GLL has neither height nor date."""
NO_TIME: Final = Message("sentences without a time")
OTHER_TALKER: Final = Message("places of other talkers at the same time")
NO_PLACE: Final = Message("times without a sentence that has a place")
_DAY, _HALF_A_DAY = 86400.0, 43200.0
_RECENT: Final = 5
"""Epochs back to which a late sentence may belong."""


@dataclass(eq=False)
class _Epoch:
    """Values of the NMEA sentences with the same time of day."""

    time: time
    row: int
    seen: set[tuple[str, str]] = field(default_factory=set)
    day: date | None = None
    placed_by: str = ""
    place: tuple[float, float] = (math.nan, math.nan)
    height: float = math.nan
    separation: float = math.nan
    speed: float = math.nan
    course: float = math.nan
    sd: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    fixes: dict[str, bool] = field(default_factory=dict)
    solution: Solution = ""
    has_not_finite_cell: bool = False

    @property
    def second_of_day(self) -> float:
        """Time of day in seconds after midnight."""
        at = self.time
        return at.hour * 3600.0 + at.minute * 60.0 + at.second + at.microsecond * 1e-6

    @property
    def has_fix(self) -> bool:
        """True if no kind of sentence denies the fix; places at exactly 0, 0 are written without one."""
        return all(self.fixes.values()) and math.isfinite(sum(self.place)) and self.place != (0.0, 0.0)

    def take(self, message: Any) -> bool:
        """Add one sentence; False if it is a second one of its kind with a place, which is not used."""
        kind = message.msgID
        self.seen.add((message.talker, kind))
        used = self._take_place(message) if kind in PLACES else True
        if kind == "RMC":
            self._take_speed(_number(message, "spd") * KNOT, _number(message, "cog"))
            day = getattr(message, "date", None)
            self.day = day if isinstance(day, date) else self.day
        elif kind == "VTG":
            speed = _number(message, "sogk") * KM_PER_H
            speed = speed if math.isfinite(speed) else _number(message, "sogn") * KNOT
            self._take_speed(speed, _number(message, "cogt"))
        elif kind == "GST":
            self.sd = (_number(message, "stdLong"), _number(message, "stdLat"), _number(message, "stdAlt"))
        elif kind == "ZDA":
            self.day = _whole_date(message) or self.day
        return used

    def _take_place(self, message: Any) -> bool:
        """Use the place of the best sentence; of equal ones the first that has any."""
        kind = message.msgID
        place = (_number(message, "lat"), _number(message, "lon"))
        has_place = math.isfinite(sum(place))
        self.fixes[kind] = self.fixes.get(kind, False) or _has_fix(message)
        if self.placed_by and (not has_place or PLACES.index(kind) >= PLACES.index(self.placed_by)):
            return not has_place or kind != self.placed_by
        if has_place:
            self.placed_by, self.place = kind, place
        if has_place and kind in ("GGA", "GNS"):
            self.height, self.separation = _number(message, "alt"), _number(message, "sep")
            self.solution = _solution(message)
        return True

    def _take_speed(self, speed: float, course: float) -> None:
        """Set speed and course, each only if it has no value yet."""
        if math.isnan(self.speed):
            self.speed = speed
        if math.isnan(self.course):
            self.course = course


def read_nmea(data: bytes, name: str) -> Recording:
    """Read the sentences of a file; other lines are skipped.

    Raises FieldDataError: no sentence GGA, GNS, GLL or RMC with a time and a right checksum, or without checksums, is
        in the file.
    """
    counts: dict[Message, int] = {WRONG_CHECKSUM: 0, NO_TIME: 0}
    epochs = _read_epochs(data, counts)
    fixed = [number for number, epoch in enumerate(epochs) if epoch.has_fix]
    if fixed:
        counts[Message("times before the first fix")] = sum(map(_has_place, epochs[: fixed[0]]))
        epochs = epochs[fixed[0] :]
    if not any(map(_has_place, epochs)):
        allowed = Message("sentences GGA, GNS, GLL or RMC with times, and with right checksums or none")
        action = Message("Switch these sentences on in the receiver, or copy the file again.")
        counted = ", ".join(f"{count} {words}" for words, count in counts.items() if count)
        raise track_error("empty_file", name, allowed, action, value=counted)
    times, start = _times(epochs)
    counts[NO_PLACE] = sum(not _has_place(epoch) and any(kind == "GST" for _, kind in epoch.seen) for epoch in epochs)
    placed = [number for number, epoch in enumerate(epochs) if _has_place(epoch)]
    epochs, times = [epochs[number] for number in placed], times[placed]
    keys = ("speed", "course", "height", "separation", "sd")
    speed, course, height, separation, sd = (np.array([getattr(epoch, key) for epoch in epochs]) for key in keys)
    direction = course * DEGREE
    velocity = np.column_stack([speed * np.sin(direction), speed * np.cos(direction), np.full(len(epochs), np.nan)])
    heights = "above mean sea level, as recorded"
    if np.isfinite(height).any() and np.isfinite(separation[np.isfinite(height)]).all():
        height = height + separation
        heights = "above the ellipsoid (mean sea level and the geoid's separation of the sentences)"
    return Recording(
        name=name,
        places_in_file=[f"row {epoch.row}" for epoch in epochs],
        time=times,
        place=np.column_stack([np.array([epoch.place for epoch in epochs]), height]),
        start=None if start is None else start + timedelta(seconds=float(times[0])),
        speed=speed,
        speed_kind="over the ground (horizontal)",
        velocity=None if np.isnan(course).all() else velocity,
        place_sd=None if np.isnan(sd).all() else sd,
        fix=np.array([epoch.has_fix for epoch in epochs]),
        solution=solution_array([epoch.solution for epoch in epochs]),
        not_finite=np.array([epoch.has_not_finite_cell for epoch in epochs]),
        heights=heights,
        left_out=counts,
    )


def _has_place(epoch: _Epoch) -> bool:
    """True if the epoch has a sentence that contains a place."""
    return any(kind in PLACES for _, kind in epoch.seen)


def _read_epochs(data: bytes, counts: dict[Message, int]) -> list[_Epoch]:
    """Sentences of a file grouped by their time of day; counts those without a time or of another talker."""
    epochs: list[_Epoch] = []
    for row, message, has_not_finite_cell in sentences(data, counts):
        at = getattr(message, "time", "")
        if message.msgID == "VTG" and epochs:  # has no time
            epoch = epochs[-1]
        elif isinstance(at, time):
            epoch = _epoch_at(epochs, at, message, row)
        else:
            counts[NO_TIME] += 1
            continue
        if not epoch.take(message):
            counts[OTHER_TALKER] = counts.get(OTHER_TALKER, 0) + 1
        epoch.has_not_finite_cell |= has_not_finite_cell
    return epochs


def _epoch_at(epochs: list[_Epoch], at: time, message: Any, row: int) -> _Epoch:
    """The epoch of this time among the last ones, or a new one; the same sentence again begins a new one."""
    for epoch in reversed(epochs[-_RECENT:]):
        if epoch.time == at:
            if (message.talker, message.msgID) not in epoch.seen:
                return epoch
            break
    epochs.append(_Epoch(at, row))
    return epochs[-1]


def _times(epochs: list[_Epoch]) -> tuple[np.ndarray[Any, np.dtype[np.float64]], datetime | None]:
    """Seconds from the first epoch, over midnights, and its moment if any sentence has a date.

    An epoch with a place but without a fix is put after the epoch with a fix before it, and changes no date.
    """
    day, dated = 0, None
    seconds: list[float] = []
    before = epochs[0]
    for epoch in epochs:
        trusted = epoch.has_fix or not _has_place(epoch)
        falls = epoch.second_of_day < before.second_of_day - _HALF_A_DAY
        if not trusted:
            seconds.append((day + falls) * _DAY + epoch.second_of_day)
            continue
        if epoch.day is not None and dated is not None:
            day = (epoch.day - dated).days
        elif falls:
            day += 1
        if epoch.day is not None and dated is None:
            dated = epoch.day - timedelta(days=day)
        seconds.append(day * _DAY + epoch.second_of_day)
        before = epoch
    start = None if dated is None else datetime.combine(dated, epochs[0].time, UTC)
    return np.array(seconds) - seconds[0], start


def _has_fix(message: Any) -> bool:
    """True if RMC or GLL is valid, GGA has a quality above 0, or GNS a mode other than N for any satellites."""
    if message.msgID in ("RMC", "GLL"):
        return getattr(message, "status", "") == "A"
    if message.msgID == "GGA":
        return _number(message, "quality") > 0.0
    return bool(set(getattr(message, "posMode", "")) - {"N"})


def _solution(message: Any) -> Solution:
    """Kind of solution: of GGA by its quality; of GNS by its modes, the least accurate system's."""
    if message.msgID == "GGA":
        return QUALITIES.get(_number(message, "quality"), "")
    modes = {MODES[mode] for mode in str(getattr(message, "posMode", "")) if mode in MODES}
    return next((solution for solution in ("code", "float", "fixed") if solution in modes), "")


def _number(message: Any, name: str) -> float:
    """Number in a sentence's field; NaN if it is blank, no number or not finite."""
    value = getattr(message, name, "")
    try:
        read = float(value) if isinstance(value, int | float) else math.nan
    except OverflowError:
        return math.nan
    return read if math.isfinite(read) else math.nan


def _whole_date(message: Any) -> date | None:
    """Date in a sentence; None if it is missing, impossible, or outside of the accepted years."""
    try:
        day = date(int(message.year), int(message.month), int(message.day))
    except (AttributeError, ValueError, OverflowError):
        return None
    return day if YEARS[0] <= day.year <= YEARS[1] else None


_READ: Final = re.compile(rb"[A-Z][A-Z0-9](GGA|GNS|GLL|RMC|VTG|GST|ZDA)")
SENTENCE: Final = re.compile(rb"\$[A-Z]{2}(GGA|GNS|GLL|RMC|VTG|GST|ZDA),")
LONGEST: Final = 1_000
"""Maximum bytes of a sentence: NMEA allows 82, receivers write somewhat more."""
WRONG_CHECKSUM: Final = Message("sentences with a wrong checksum")
NO_CHECKSUM: Final = Message("sentences without a checksum, next to others with one")
UNREADABLE: Final = Message("sentences with a cell that cannot be read")
_PIECE: Final = re.compile(rb"\$([A-Z][A-Z0-9]{2,9}),([\x20-\x23\x25-\x7e]*)")
_CHECKSUM: Final = re.compile(r"[0-9A-Fa-f]{2}")
_LINE_END: Final = re.compile(rb"\r\n|\r|\n")


def sentences(data: bytes, counts: dict[Message, int]) -> Iterator[tuple[int, Any, bool]]:
    """Row in the file, decoded sentence, and whether a cell was `nan` or `inf`; rejected sentences are counted."""
    from pynmeagps import calc_checksum

    pieces = []
    for match in _PIECE.finditer(data):
        content, star, rest = match[0][1:].decode("ascii").partition("*")
        stated = _CHECKSUM.match(rest) if star else None
        pieces.append((match, content.rstrip(), stated and stated[0].upper()))
    checked = {match[1] for match, _, checksum in pieces if checksum}
    line_ends = [match.end() for match in _LINE_END.finditer(data)]
    for match, content, checksum in pieces:
        reason = None
        if len(content) > LONGEST:
            reason = UNREADABLE
        elif checksum is None:
            reason = NO_CHECKSUM if match[1] in checked else None
        elif calc_checksum(content) != checksum:
            reason = WRONG_CHECKSUM
        if reason is None and _READ.fullmatch(match[1]):
            cells = content.split(",")
            finite = ["" if NOT_FINITE_CELL.fullmatch(cell.strip()) else cell for cell in cells]
            message = _decode_sentence(",".join(finite))
            if message is not None:
                yield bisect_right(line_ends, match.start()) + 1, message, finite != cells
                continue
            reason = UNREADABLE
        if reason is not None:
            counts[reason] = counts.get(reason, 0) + 1


def _decode_sentence(content: str) -> Any:
    """Parsed sentence from the text between "$" and "*"; None if it cannot be decoded."""
    from pynmeagps import NMEAReader, calc_checksum

    try:
        return NMEAReader.parse(f"${content}*{calc_checksum(content)}".encode("ascii"))
    except Exception:  # pynmeagps fails in many ways for cells that are not numbers
        return None
