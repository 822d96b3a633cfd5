"""Tracks in FIT, the files of sports watches, read with fitdecode: the messages ``record``.

Heights of FIT are above mean sea level according to the watch, often barometric. ``gps_accuracy``, in whole metres, is
used as √(σ_east² + σ_north²), each with half of the variance (modelling assumption: the profile only gives its name and
unit); 0 means unknown.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, Final

import numpy as np

from ..._support.messages import Message
from .recording import Recording, track_error

SEMICIRCLE: Final = 180.0 / 2**31
"""Degrees in a semicircle, the unit of FIT's latitude and longitude."""
_MARK, _MARK_AT = b".FIT", 8
_HEADERS: Final = (12, 14)
"""Bytes of a header."""
_CHECKSUM: Final = 2


@dataclass(eq=False)
class _Records:
    """The messages ``record``, one entry each, with the number of the segment."""

    times: list[datetime] = field(default_factory=list)
    numbers: list[tuple[float, ...]] = field(default_factory=list)
    segments: list[int] = field(default_factory=list)
    without_time: int = 0
    segment: int = 0

    def add_event(self, message: Any) -> None:
        """Begin a new segment if the timer stops: the device pauses."""
        timer = message.get_value("event", fallback=None) in ("timer", 0)
        stops = str(message.get_value("event_type", fallback="")).startswith("stop")
        self.segment += timer and stops

    def add_record(self, message: Any) -> None:
        time = message.get_value("timestamp", fallback=None)
        if not isinstance(time, datetime):
            self.without_time += 1
            return
        self.times.append(time.astimezone(UTC))
        self.segments.append(self.segment)
        self.numbers.append(
            (
                _number(message, "position_lat") * SEMICIRCLE,
                _number(message, "position_long") * SEMICIRCLE,
                _number(message, "enhanced_altitude", "altitude"),
                _number(message, "enhanced_speed", "speed"),
                _number(message, "distance"),
                _number(message, "gps_accuracy"),
            )
        )


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
    start = records.times[0] if records.times else None
    return Recording(
        name=name,
        places_in_file=[f"record {place + 1}" for place in range(len(table))],
        time=np.array([(time - records.times[0]).total_seconds() for time in records.times]),
        place=table[:, :3],
        is_geodetic=True,
        time_scale="UTC",
        start=start,
        speed=table[:, 3],
        speed_kind="as the device gives it",
        place_sd=None if np.isnan(accuracy).all() else place_sd,
        odometer=None if np.isnan(table[:, 4]).all() else table[:, 4],
        heights="above mean sea level, as the watch has them",
        left_out={"records without a date": records.without_time},
        segment=np.array(records.segments, dtype=np.int64),
        notes=(f"{extra} bytes outside of the FIT file are not read.",) if extra else (),
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
    import fitdecode

    try:
        with fitdecode.FitReader(
            data, check_crc=fitdecode.CrcCheck.RAISE, error_handling=fitdecode.ErrorHandling.IGNORE
        ) as reader:
            for frame in reader:
                if frame.frame_type == fitdecode.FIT_FRAME_DATA and frame.name == "record":
                    records.add_record(frame)
                elif frame.frame_type == fitdecode.FIT_FRAME_DATA and frame.name == "event":
                    records.add_event(frame)
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
