"""Tracks in binary formats: UBX of u-blox receivers, decoded with pyubx2, and FIT of sports watches, with fitdecode.

UBX: each NAV-PVT gives a point. A NAV-HPPOSLLH of the same time of week replaces its place: to 0.1 mm instead of 1 cm.
A NAV-COV gives its standard deviations. Frames are recognised by their two sync bytes and their checksum, so a damaged
frame does not affect others. Heights are above the ellipsoid. ``hAcc`` is used as √(σ_east² + σ_north²), each with half
of the variance (modelling assumption: u-blox's manual only calls it an estimate of the horizontal accuracy).

FIT: the messages ``record``. Heights are above mean sea level according to the watch, often barometric.
``gps_accuracy``, in whole metres, is used as ``hAcc`` of UBX; 0 means unknown.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any, Final

import numpy as np

from ..._support.messages import Message
from ..._support.units import MM
from ..track import Solution, solution_array
from .nmea import SENTENCE
from .recording import Recording, track_error

SYNC: Final = b"\xb5\x62"
LENGTHS: Final = {b"\x01\x07": (84, 92), b"\x01\x14": (36,), b"\x01\x36": (64,)}
"""Lengths in bytes of NAV-PVT (84: u-blox 7, 92: later), NAV-HPPOSLLH and NAV-COV; a request has the length 0."""
_BEGIN: Final = re.compile(SYNC + rb"(\x01[\x07\x14\x36])")
_DAMAGED: Final = Message("messages with a wrong checksum or cut short")
_NO_TIME: Final = Message("messages without a valid time")
_COUNTS: Final = (_DAMAGED, _NO_TIME)
_NO_FIX: Final = (0, 5)  # none; time only
CARRIER_SOLUTIONS: Final[dict[int, Solution]] = {0: "code", 1: "float", 2: "fixed"}
"""Kind of solution by ``carrSoln``."""


@dataclass(eq=False)
class _Epoch:
    """A NAV-PVT with its offset in the file and its time, and NAV-HPPOSLLH and NAV-COV of the same time of week."""

    offset: int
    moment: datetime
    message: Any
    precise: Any = None
    covariance: Any = None


def read_ubx(data: bytes, name: str) -> Recording:
    """Read the messages NAV-PVT of a file, with NAV-HPPOSLLH and NAV-COV; other messages are ignored.

    Raises FieldDataError: no message NAV-PVT with a right checksum and a valid time is in the file.
    """
    counts = dict.fromkeys(_COUNTS, 0)
    epochs = _epochs(data, counts)
    if not epochs:
        counted = ", ".join(f"{count} {words}" for words, count in counts.items())
        allowed = Message("messages NAV-PVT with right checksums and valid times")
        action = Message("Switch NAV-PVT on in the receiver, or copy the file again.")
        raise track_error("empty_file", name, allowed, action, value=counted)
    counts[Message("NMEA sentences next to messages NAV-PVT")] = len(SENTENCE.findall(data))
    table = np.array([_epoch_row(epoch) for epoch in epochs])
    start = epochs[0].moment
    return Recording(
        name=name,
        places_in_file=[f"byte {epoch.offset + 1}" for epoch in epochs],
        time=np.array([(epoch.moment - start).total_seconds() for epoch in epochs]),
        place=table[:, 0:3],
        start=start,
        speed=table[:, 3],
        speed_kind="over the ground (horizontal)",
        velocity=table[:, 4:7],
        place_sd=table[:, 7:10],
        speed_sd=table[:, 10],
        fix=table[:, 11] > 0.0,
        # u-blox 7 does not state the kind of solution and gives code solutions only
        solution=solution_array(
            [CARRIER_SOLUTIONS.get(int(getattr(epoch.message, "carrSoln", 0)), "") for epoch in epochs]
        ),
        heights="above the ellipsoid",
        left_out=counts,
    )


def has_places(data: bytes) -> bool:
    """True if the bytes have a NAV-PVT with a right checksum and a valid time."""
    messages = _messages(data, dict.fromkeys(_COUNTS, 0))
    return any(message.identity == "NAV-PVT" and _time_of_message(message) is not None for _, message in messages)


def _epochs(data: bytes, counts: dict[Message, int]) -> list[_Epoch]:
    """Every NAV-PVT with a valid time, and the other messages of its time of week."""
    epochs: list[_Epoch] = []
    precise: dict[int, Any] = {}
    covariances: dict[int, Any] = {}
    for offset, message in _messages(data, counts):
        if message.identity == "NAV-HPPOSLLH":
            if not message.invalidLlh:
                precise[message.iTOW] = message
        elif message.identity == "NAV-COV":
            covariances[message.iTOW] = message
        elif (moment := _time_of_message(message)) is not None:
            epochs.append(_Epoch(offset, moment, message))
        else:
            counts[_NO_TIME] += 1
    for epoch in epochs:
        epoch.precise = precise.get(epoch.message.iTOW)
        epoch.covariance = covariances.get(epoch.message.iTOW)
    return epochs


def _messages(data: bytes, counts: dict[Message, int]) -> Iterator[tuple[int, Any]]:
    """Each message that is read, with its offset; damaged frames are added to `counts`."""
    from pyubx2 import VALNONE, UBXReader, calc_checksum

    end = 0
    for match in _BEGIN.finditer(data):
        begin = match.start()
        length = int.from_bytes(data[begin + 4 : begin + 6], "little")
        frame = data[begin : begin + 8 + length]
        if begin < end or not length:  # within a message; a request
            continue
        is_whole = length in LENGTHS[match[1]] and len(frame) == 8 + length
        if is_whole and calc_checksum(frame[2:-2]) == frame[-2:]:
            end = begin + len(frame)
            yield begin, UBXReader.parse(frame, validate=VALNONE)
        else:
            counts[_DAMAGED] += 1


def _time_of_message(message: Any) -> datetime | None:
    """UTC time of a UBX message; None if its date or time is invalid."""
    if not (message.validDate and message.validTime):
        return None
    try:
        whole = datetime(message.year, message.month, message.day, message.hour, message.min, tzinfo=UTC)
    except ValueError:
        return None
    # a leap second is second 60; nanoseconds may be negative
    return whole + timedelta(seconds=message.second, microseconds=message.nano / 1000.0)


def _epoch_row(epoch: _Epoch) -> tuple[float, ...]:
    """Place (°, °, m), speed, velocity, their standard deviations, and 1 with a fix, otherwise 0."""
    message, place = epoch.message, epoch.precise or epoch.message
    velocity = (message.velE * MM, message.velN * MM, -message.velD * MM)
    has_fix = bool(message.gnssFixOk) and message.fixType not in _NO_FIX and not getattr(message, "invalidLlh", 0)
    deviations = (*_place_sd(place, epoch.covariance), _speed_sd(message, epoch.covariance, velocity))
    return (place.lat, place.lon, place.height * MM, message.gSpeed * MM, *velocity, *deviations, float(has_fix))


def _place_sd(place: Any, covariance: Any) -> tuple[float, float, float]:
    """Standard deviations of the place: east, north, up (m)."""
    if covariance is not None and covariance.posCovValid:
        variances = (covariance.posCovEE, covariance.posCovNN, covariance.posCovDD)
        if min(variances) > 0.0 and math.isfinite(sum(variances)):
            east, north, up = map(math.sqrt, variances)
            return east, north, up
    horizontal = place.hAcc * MM / math.sqrt(2.0)
    return horizontal, horizontal, place.vAcc * MM


def _speed_sd(message: Any, covariance: Any, velocity: tuple[float, float, float]) -> float:
    """Standard deviation (m/s) of the component along the velocity; at rest or without NAV-COV ``sAcc``."""
    speed = math.hypot(*velocity)
    if covariance is None or not covariance.velCovValid or speed == 0.0:
        return float(message.sAcc * MM)
    east, north, up = (part / speed for part in velocity)
    c, down = covariance, -up
    variance = north * north * c.velCovNN + east * east * c.velCovEE + down * down * c.velCovDD
    variance += 2.0 * (north * east * c.velCovNE + north * down * c.velCovND + east * down * c.velCovED)
    return math.sqrt(variance) if 0.0 < variance < math.inf else float(message.sAcc * MM)


SEMICIRCLE: Final = 180.0 / 2**31
"""Degrees in a semicircle, the unit of FIT's latitude and longitude."""
_MARK, _MARK_AT = b".FIT", 8
_HEADERS: Final = (12, 14)
"""Bytes of a header."""
_CHECKSUM: Final = 2


@dataclass(eq=False)
class _Records:
    """Values of the FIT messages ``record``, one entry each, with the number of their segment."""

    times: list[datetime] = field(default_factory=list)
    numbers: list[tuple[float, ...]] = field(default_factory=list)
    segments: list[int] = field(default_factory=list)
    without_time: int = 0
    segment: int = 0

    def add(self, message: Any) -> None:
        """Add a ``record``; begin a new segment if an ``event`` is a stop of the timer: the device pauses."""
        if message.name == "event":
            timer = message.get_value("event", fallback=None) in ("timer", 0)
            self.segment += timer and str(message.get_value("event_type", fallback="")).startswith("stop")
        if message.name != "record":
            return
        time = message.get_value("timestamp", fallback=None)
        if not isinstance(time, datetime):
            self.without_time += 1
            return
        self.times.append(time.astimezone(UTC))
        self.segments.append(self.segment)
        latitude, longitude = _number(message, "position_lat"), _number(message, "position_long")
        height, speed = _number(message, "enhanced_altitude", "altitude"), _number(message, "enhanced_speed", "speed")
        further = _number(message, "distance"), _number(message, "gps_accuracy")
        self.numbers.append((latitude * SEMICIRCLE, longitude * SEMICIRCLE, height, speed, *further))


def read_fit(data: bytes, name: str) -> Recording:
    """The recording in a FIT file.

    Raises FieldDataError: the file is not a FIT file, ends too early, or its checksum is wrong.
    """
    records = _Records()
    files, extra = _files(data)
    for part in files or [data]:
        _decode_messages(part, name, records)
        records.segment += 1
    table = np.array(records.numbers, dtype=float).reshape(-1, 6)
    accuracy = np.where(table[:, 5] > 0.0, table[:, 5], np.nan) / math.sqrt(2.0)
    place_sd = np.column_stack([accuracy, accuracy, np.full(len(table), np.nan)])
    return Recording(
        name=name,
        places_in_file=[f"record {place + 1}" for place in range(len(table))],
        time=np.array([(time - records.times[0]).total_seconds() for time in records.times]),
        place=table[:, :3],
        start=records.times[0] if records.times else None,
        speed=table[:, 3],
        speed_kind="as the device gives it",
        place_sd=None if np.isnan(accuracy).all() else place_sd,
        odometer=None if np.isnan(table[:, 4]).all() else table[:, 4],
        heights="above mean sea level, as the watch has them",
        left_out={Message("records without a date"): records.without_time},
        segment=np.array(records.segments, dtype=np.int64),
        notes=(Message("{extra} bytes outside of the FIT file are not read.", extra=extra),) if extra else (),
    )


def _files(data: bytes) -> tuple[list[bytes], int]:
    """The FIT files that are one after the other in the bytes, and the number of bytes outside of them.

    The header of each gives its length: bytes that a device writes after the end belong to none.
    """
    files: list[bytes] = []
    inside = place = 0
    while (mark := data.find(_MARK, place)) >= 0:
        begin = mark - _MARK_AT
        size = data[begin] if begin >= place else 0
        length = size + int.from_bytes(data[begin + 4 : begin + 8], "little") + _CHECKSUM
        if size not in _HEADERS:
            place = mark + 1
            continue
        files.append(data[begin : begin + length])
        inside += len(files[-1])
        place = begin + length
    return files, len(data) - inside


def _decode_messages(data: bytes, name: str, records: _Records) -> None:
    """Add every data frame of a FIT file to `records`; rejects a damaged file."""
    import fitdecode

    try:
        with fitdecode.FitReader(
            data, check_crc=fitdecode.CrcCheck.RAISE, error_handling=fitdecode.ErrorHandling.IGNORE
        ) as reader:
            for frame in reader:
                if frame.frame_type == fitdecode.FIT_FRAME_DATA:
                    records.add(frame)
    except Exception as error:  # damaged bytes make fitdecode fail in many ways
        allowed = Message("a whole FIT file with right checksums")
        action = Message("It is damaged or ends after {read} records; copy it again.", read=len(records.times))
        value = f"{type(error).__name__}: {error}"
        raise track_error("unreadable_file", name, allowed, action, value=value) from error


def _number(message: Any, *names: str) -> float:
    """The first finite number of these fields, else NaN.

    A name may occur twice: fitdecode also adds an enhanced field that it expands from a plain one, even an invalid one.
    """
    for name in names:
        for entry in message.get_fields(name):
            if isinstance(entry.value, int | float) and math.isfinite(entry.value):
                return float(entry.value)
    return math.nan
