"""Tracks in NMEA 0183: sentences GGA, GNS, RMC, VTG, GST, ZDA of any talker, read with pynmeagps.

Sentences with one time of day make one point. A time of day that falls by more than half a day begins the next day.
Heights are those above the ellipsoid where every point with a height tells the geoid's separation, else above mean sea
level.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from datetime import UTC, date, datetime, time, timedelta
from typing import Any, Final

import numpy as np

from ...units import DEGREE
from ..solution import Solution, solution_array
from .recording import Recording
from .refusal import refusal

KNOT: Final = 1852.0 / 3600.0
"""m/s in a knot."""
KM_PER_H: Final = 1.0 / 3.6
"""m/s in a km/h."""
SENTENCE: Final = re.compile(rb"\$[A-Z]{2}(GGA|GNS|RMC|VTG|GST|ZDA),")
QUALITIES: Final[dict[float, Solution]] = {1.0: "code", 2.0: "code", 3.0: "code", 4.0: "fixed", 5.0: "float"}
"""Of GGA; others are dead reckoning, typed in, or simulated."""
MODES: Final[dict[str, Solution]] = {"A": "code", "D": "code", "P": "code", "R": "fixed", "F": "float"}
"""Of GNS, a letter for each satellite system."""
LONGEST: Final = 1_000
"""Bytes of a sentence: NMEA allows 82, receivers write somewhat more."""
YEARS: Final = (1900, 2200)
"""Of a date that a receiver may send; others are damage."""
_DAY, _HALF_A_DAY = 86400.0, 43200.0


@dataclass(eq=False)
class _Epoch:
    """What the sentences of one time say."""

    time: time
    row: int
    seen: set[str] = field(default_factory=set)
    day: date | None = None
    place: tuple[float, float] = (math.nan, math.nan)
    height: float = math.nan
    separation: float = math.nan
    speed: float = math.nan
    course: float = math.nan
    sd: tuple[float, float, float] = (math.nan, math.nan, math.nan)
    fix: bool = True
    solution: Solution = ""

    @property
    def second_of_day(self) -> float:
        at = self.time
        return at.hour * 3600.0 + at.minute * 60.0 + at.second + at.microsecond * 1e-6

    def take(self, message: Any) -> None:
        """Add one sentence."""
        kind = message.msgID
        self.seen.add(kind)
        if kind in ("GGA", "GNS"):
            self._take_place(message)
            self.height, self.separation = _number(message, "alt"), _number(message, "sep")
            self.fix = self.fix and _has_fix(message)
            self.solution = self.solution or _solution(message)
        elif kind == "RMC":
            if not self.seen & {"GGA", "GNS"}:
                self._take_place(message)
            self.fix = self.fix and getattr(message, "status", "") == "A"
            self._take_speed(_number(message, "spd") * KNOT, _number(message, "cog"))
            self.day = _date(getattr(message, "date", None))
        elif kind == "VTG":
            speed = _number(message, "sogk") * KM_PER_H
            self._take_speed(
                speed if math.isfinite(speed) else _number(message, "sogn") * KNOT, _number(message, "cogt")
            )
        elif kind == "GST":
            self.sd = (_number(message, "stdLong"), _number(message, "stdLat"), _number(message, "stdAlt"))
        elif kind == "ZDA":
            self.day = _whole_date(message)

    def _take_place(self, message: Any) -> None:
        self.place = (_number(message, "lat"), _number(message, "lon"))

    def _take_speed(self, speed: float, course: float) -> None:
        if math.isnan(self.speed):
            self.speed = speed
        if math.isnan(self.course):
            self.course = course


def read_nmea(data: bytes, name: str) -> Recording:
    """The recording in a file of NMEA sentences; lines that are none are left alone.

    Raises
    ------
    FieldDataError
        No sentence GGA, GNS or RMC with a right checksum and a time is in the file.
    """
    counts = {"sentences with a wrong checksum": 0, "sentences without a time": 0}
    epochs = [epoch for epoch in _epochs(data, counts) if epoch.seen & {"GGA", "GNS", "RMC"}]
    if not epochs:
        raise refusal(
            "empty_file",
            name,
            value=", ".join(f"{count} {words}" for words, count in counts.items()),
            allowed="sentences GGA, GNS or RMC with right checksums and times",
            action="Switch these sentences on in the receiver, or copy the file again.",
        )
    seconds, start = _times(epochs)
    course = np.array([epoch.course for epoch in epochs]) * DEGREE
    speed = np.array([epoch.speed for epoch in epochs])
    velocity = np.column_stack([speed * np.sin(course), speed * np.cos(course), np.full(len(epochs), np.nan)])
    sd = np.array([epoch.sd for epoch in epochs])
    height, heights = _heights(epochs)
    return Recording(
        name=name,
        places_in_file=[f"row {epoch.row}" for epoch in epochs],
        time=seconds,
        place=np.column_stack([np.array([epoch.place for epoch in epochs]), height]),
        is_geodetic=True,
        time_scale="UTC",
        start=start,
        speed=speed,
        speed_kind="over the ground (horizontal)",
        velocity=None if np.isnan(course).all() else velocity,
        place_sd=None if np.isnan(sd).all() else sd,
        fix=np.array([epoch.fix for epoch in epochs]),
        solution=solution_array([epoch.solution for epoch in epochs]),
        heights=heights,
        left_out=counts,
    )


def _epochs(data: bytes, counts: dict[str, int]) -> list[_Epoch]:
    epochs: list[_Epoch] = []
    for row, line in enumerate(data.split(b"\n"), start=1):
        begin = line.find(b"$")
        if begin < 0:
            continue
        message = _message(line[begin:].strip(), counts)
        if message is None:
            continue
        if message.msgID == "VTG":  # has no time of its own
            if epochs:
                epochs[-1].take(message)
            continue
        at = getattr(message, "time", "")
        if not isinstance(at, time):
            counts["sentences without a time"] += 1
            continue
        if not epochs or epochs[-1].time != at or message.msgID in epochs[-1].seen:
            epochs.append(_Epoch(at, row))
        epochs[-1].take(message)
    return epochs


def _message(line: bytes, counts: dict[str, int]) -> Any:
    """The sentence, None where it is another one or damaged."""
    from pynmeagps import NMEAReader, calc_checksum

    content, star, checksum = line[1:].partition(b"*")
    if not star or calc_checksum(content.decode("latin-1")) != checksum[:2].decode("latin-1").upper():
        counts["sentences with a wrong checksum"] += 1
        return None
    if not SENTENCE.match(line) or not content.isascii():
        return None
    if len(line) > LONGEST:
        counts["sentences with a wrong checksum"] += 1
        return None
    try:
        return NMEAReader.parse(b"$" + content + b"*" + checksum[:2])
    except Exception:  # cells that are no numbers make pynmeagps fail in many ways
        counts["sentences with a wrong checksum"] += 1
        return None


def _times(epochs: list[_Epoch]) -> tuple[np.ndarray[Any, np.dtype[np.float64]], datetime | None]:
    """Seconds from the first point, over midnights; the first moment where any sentence has a date."""
    day, dated = 0, None
    seconds: list[float] = []
    before = epochs[0]
    for epoch in epochs:
        if epoch.day is not None and dated is not None:
            day = (epoch.day - dated).days
        elif epoch.second_of_day < before.second_of_day - _HALF_A_DAY:
            day += 1
        if epoch.day is not None and dated is None:
            dated = epoch.day - timedelta(days=day)
        seconds.append(day * _DAY + epoch.second_of_day)
        before = epoch
    start = None if dated is None else datetime.combine(dated, epochs[0].time, UTC)
    return np.array(seconds) - seconds[0], start


def _heights(epochs: list[_Epoch]) -> tuple[np.ndarray[Any, np.dtype[np.float64]], str]:
    height = np.array([epoch.height for epoch in epochs])
    separation = np.array([epoch.separation for epoch in epochs])
    if np.isfinite(height).any() and np.isfinite(separation[np.isfinite(height)]).all():
        return height + separation, "above the ellipsoid (mean sea level and the geoid's separation of the sentences)"
    return height, "above mean sea level, as recorded"


def _has_fix(message: Any) -> bool:
    """Whether GGA has a quality above 0, or GNS a mode other than N for any satellites."""
    if message.msgID == "GGA":
        return _number(message, "quality") > 0.0
    return bool(set(getattr(message, "posMode", "")) - {"N"})


def _solution(message: Any) -> Solution:
    """Of GGA by its quality; of GNS by its modes, of several systems the least exact."""
    if message.msgID == "GGA":
        return QUALITIES.get(_number(message, "quality"), "")
    modes = {MODES[mode] for mode in str(getattr(message, "posMode", "")) if mode in MODES}
    return next((each for each in ("code", "float", "fixed") if each in modes), "")


def _number(message: Any, name: str) -> float:
    value = getattr(message, name, "")
    try:
        read = float(value) if isinstance(value, int | float) else math.nan
    except OverflowError:
        return math.nan
    return read if math.isfinite(read) else math.nan


def _date(value: Any) -> date | None:
    return value if isinstance(value, date) else None


def _whole_date(message: Any) -> date | None:
    try:
        found = date(int(message.year), int(message.month), int(message.day))
    except (AttributeError, ValueError, OverflowError):
        return None
    return found if YEARS[0] <= found.year <= YEARS[1] else None
