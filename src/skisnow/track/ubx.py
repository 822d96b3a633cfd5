"""Tracks in UBX, the binary messages of u-blox receivers: NAV-PVT, decoded with pyubx2.

Frames are found by their two sync bytes and their checksum, so that a damaged one costs itself alone. Heights are those
above the ellipsoid. ``hAcc`` is taken as √(σ_east² + σ_north²), each with half of the variance (Choice; u-blox's manual
calls it an estimate of the horizontal accuracy and says no more).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from typing import Any, Final

import numpy as np

from ..units import MM
from .recording import Recording
from .trouble import refusal

SYNC: Final = b"\xb5\x62"
NAV_PVT: Final = b"\x01\x07"
LENGTHS: Final = (84, 92)
"""Of NAV-PVT in bytes: of u-blox 7, and of all later receivers; a request for the message has none."""
_HEAD, _CHECKSUM = 6, 2
_NO_FIX: Final = (0, 5)  # none; time only


def read_ubx(data: bytes, name: str) -> Recording:
    """The recording in the NAV-PVT messages of a file; other messages are left alone.

    Raises
    ------
    FieldDataError
        No message NAV-PVT with a right checksum and a valid time is in the file.
    """
    counts = {"messages with a wrong checksum or cut short": 0, "messages without a valid time": 0}
    offsets: list[str] = []
    moments: list[datetime] = []
    rows: list[tuple[float, ...]] = []
    for offset, message in _messages(data, counts):
        moment = _moment(message)
        if moment is None:
            counts["messages without a valid time"] += 1
            continue
        offsets.append(f"byte {offset + 1}")
        moments.append(moment)
        rows.append(_row(message))
    if not rows:
        told = ", ".join(f"{count} {words}" for words, count in counts.items())
        raise refusal(
            "empty_file",
            name,
            value=told,
            allowed="messages NAV-PVT with right checksums and valid times",
            action="Switch NAV-PVT on in the receiver, or copy the file again.",
        )
    table = np.array(rows)
    return Recording(
        name=name,
        places_in_file=offsets,
        time=np.array([(moment - moments[0]).total_seconds() for moment in moments]),
        place=table[:, 0:3],
        is_geodetic=True,
        time_scale="UTC",
        start=moments[0],
        speed=table[:, 3],
        speed_kind="over the ground (horizontal)",
        velocity=table[:, 4:7],
        place_sd=table[:, 7:10],
        speed_sd=table[:, 10],
        fix=table[:, 11] > 0.0,
        heights="above the ellipsoid",
        left_out=counts,
    )


def _messages(data: bytes, counts: dict[str, int]) -> Iterator[tuple[int, Any]]:
    """Every NAV-PVT with its offset; counts frames that are damaged."""
    from pyubx2 import VALNONE, UBXReader, calc_checksum

    at = data.find(SYNC)
    while at >= 0:
        length = int.from_bytes(data[at + 4 : at + _HEAD], "little")
        end = at + _HEAD + length + _CHECKSUM
        body = data[at + 2 : end - _CHECKSUM]
        if end > len(data) or calc_checksum(body) != data[end - _CHECKSUM : end]:
            counts["messages with a wrong checksum or cut short"] += 1
            end = at + len(SYNC)
        elif body[:2] == NAV_PVT and length in LENGTHS:
            yield at, UBXReader.parse(data[at:end], validate=VALNONE)
        at = data.find(SYNC, end)


def _moment(message: Any) -> datetime | None:
    if not (message.validDate and message.validTime):
        return None
    try:
        whole = datetime(message.year, message.month, message.day, message.hour, message.min, tzinfo=UTC)
    except ValueError:
        return None
    # a leap second is second 60; nanoseconds may be negative
    return whole + timedelta(seconds=message.second, microseconds=message.nano / 1000.0)


def _row(message: Any) -> tuple[float, ...]:
    horizontal = message.hAcc * MM / math.sqrt(2.0)
    return (
        message.lat,
        message.lon,
        message.height * MM,
        message.gSpeed * MM,
        message.velE * MM,
        message.velN * MM,
        -message.velD * MM,
        horizontal,
        horizontal,
        message.vAcc * MM,
        message.sAcc * MM,
        float(bool(message.gnssFixOk) and message.fixType not in _NO_FIX),
    )
