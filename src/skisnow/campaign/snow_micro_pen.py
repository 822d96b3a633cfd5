"""Recordings of a SnowMicroPen: force against depth from its binary ``.PNT`` files.

A file is a header of 512 bytes, then force samples of two bytes, all big endian and signed, then padding to full
blocks. The layout is the one that the instrument's makers document in their own reader, snowmicropyn (WSL Institute for
Snow and Avalanche Research SLF).
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass, field
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Any, Final, NoReturn

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import FieldDataError
from .._support.messages import Message
from .._support.units import CM, MM
from .._support.user_files import ContentError, plain_bytes
from .problems import error

HEADER_BYTES: Final = 512
MOST_BYTES: Final = 1 << 26
"""Maximum size of a recording: 30 million samples, 130 m of snow at the usual distance of 4 µm."""
_SAMPLE_BYTES: Final = 2
_NO_HEIGHT_CM: Final = 99999.0
_MICROMETRE: Final = 1e-6

# name, offset in bytes, format for struct
_FIELDS: Final = (
    ("sample_distance_mm", 6, "f"),
    ("force_per_count", 10, "f"),
    ("clock", 20, "6h"),
    ("speed_mm_per_s", 64, "f"),
    ("comment_length", 152, "h"),
    ("comment", 154, "102s"),
    ("name", 256, "8s"),
    ("latitude_deg", 264, "f"),
    ("longitude_deg", 268, "f"),
    ("height_cm", 272, "f"),
    ("hemisphere", 280, "2s"),
    ("samples", 358, "i"),
    ("tip_diameter_um", 376, "i"),
    ("instrument_length_mm", 386, "h"),
)


@dataclass(frozen=True, slots=True)
class SnowMicroPenProfile:
    """A recording: force against depth, and the quantities of its header that skisnow uses.

    name, comment: name and comment in the header.
    depth: distance of the tip from its start in the air above the snow, at each sample (m). The file has neither the
        position of the surface nor the reason for the end of the recording.
    force: force on the tip (N): counts of the converter times the force of one, without an offset.
    sample_distance, tip_diameter: distance from sample to sample, and diameter of the tip (m).
    recorded_on: day from the first eight digits in the file's name that are a date (20200208), else of the instrument's
        clock, which can be wrong by years; None without a date.
    latitude_deg, longitude_deg: WGS 84, north and east positive: the header has magnitudes and the flags N or S, E or
        W. None where flags or numbers are not valid, or both are 0.
    height: height above sea level (m), or None.
    """

    name: str
    comment: str
    depth: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    sample_distance: float
    tip_diameter: float
    recorded_on: date | None
    latitude_deg: float | None
    longitude_deg: float | None
    height: float | None


def read_snow_micro_pen(path: Path) -> SnowMicroPenProfile:
    """Read a ``.PNT`` file.

    Raises FieldDataError: the file cannot be read, is empty or cut off, or is not a recording of a SnowMicroPen.
    """
    path = Path(path)
    try:
        data = plain_bytes(path, most_bytes=MOST_BYTES)
    except ContentError as failure:
        _refuse(path.name, failure.what, "a readable file", "Check its name and permissions.")
    return parse_snow_micro_pen(path.name, data)


def parse_snow_micro_pen(name: str, data: bytes) -> SnowMicroPenProfile:
    """Parse the bytes of a ``.PNT`` file.

    Raises FieldDataError: as `read_snow_micro_pen`.
    """
    if not data:
        _refuse(name, "0 bytes", "a recording of a SnowMicroPen", "Copy it from the instrument again.", "empty_file")
    if len(data) < HEADER_BYTES:
        allowed = Message(
            "at least {header_bytes} bytes, the header of a SnowMicroPen recording", header_bytes=HEADER_BYTES
        )
        _refuse(name, f"{len(data)} bytes", allowed, "Copy the file from the instrument again.")
    header = {key: _unpack_value(data, offset, form) for key, offset, form in _FIELDS}
    _require_plausible_header(name, header, len(data))
    counts = np.frombuffer(data, dtype=">i2", count=header["samples"], offset=HEADER_BYTES)
    return _make_profile(name, header, counts.astype(np.float64))


def _unpack_value(data: bytes, offset: int, form: str) -> Any:
    """Value at an offset in a `struct` format, big-endian; a tuple if the format has several values."""
    values = struct.unpack_from(f">{form}", data, offset)
    return values[0] if len(values) == 1 else values


def _refuse(name: str, value: str, allowed: str, action: str, code: str = "unreadable_file") -> NoReturn:
    raise FieldDataError([error(code, name, value=value, allowed=allowed, action=action)])


def _require_plausible_header(file: str, header: dict[str, Any], size: int) -> None:
    """Check the header's numbers, because the format has no signature."""
    limits = {
        "sample_distance_mm": (1e-4, 1.0),
        "force_per_count": (1e-6, 1.0),
        "samples": (1, 2**31),
        "speed_mm_per_s": (0.0, 1000.0),
        "tip_diameter_um": (0, 100_000),
        "instrument_length_mm": (0, 10_000),
    }
    for name, (low, high) in limits.items():
        if not low <= header[name] <= high:  # NaN too
            allowed = Message(
                "a SnowMicroPen recording, whose header has {name} from {low:g} to {high:g}",
                name=name,
                low=low,
                high=high,
            )
            _refuse(file, f"{name} {header[name]:g}", allowed, "This is another kind of file, or a damaged one.")
    needed = HEADER_BYTES + _SAMPLE_BYTES * header["samples"]
    if size < needed:
        allowed = Message(
            "{needed} bytes or more for the {samples} samples that the header counts",
            needed=needed,
            samples=header["samples"],
        )
        _refuse(file, f"{size} bytes", allowed, "The file is cut off; copy it from the instrument again.")


def _make_profile(file: str, header: dict[str, Any], counts: FloatArray) -> SnowMicroPenProfile:
    distance = header["sample_distance_mm"] * MM
    latitude, longitude = _position_or_none(header)
    height = header["height_cm"]
    return SnowMicroPenProfile(
        name=_text(header["name"]),
        comment=_text(header["comment"][: max(header["comment_length"], 0)]),
        depth=np.arange(counts.size) * distance,
        force=counts * header["force_per_count"],
        sample_distance=distance,
        tip_diameter=header["tip_diameter_um"] * _MICROMETRE,
        recorded_on=_date_in_file_name(file) or _clock_date(header["clock"]),
        latitude_deg=latitude,
        longitude_deg=longitude,
        height=None if height == _NO_HEIGHT_CM or not np.isfinite(height) else height * CM,
    )


def _text(raw: bytes) -> str:
    """Text before the first NUL."""
    return raw.split(b"\0", 1)[0].decode("latin-1").strip()


def _clock_date(fields: tuple[int, ...]) -> date | None:
    try:
        return datetime(*fields, tzinfo=UTC).date()  # type: ignore[arg-type,misc]
    except ValueError:
        return None


def _date_in_file_name(name: str) -> date | None:
    for digits in re.findall(r"(?<!\d)\d{8}(?!\d)", name):
        try:
            return datetime.strptime(digits, "%Y%m%d").replace(tzinfo=UTC).date()
        except ValueError:
            continue
    return None


def _position_or_none(header: dict[str, Any]) -> tuple[float, float] | tuple[None, None]:
    latitude, longitude = header["latitude_deg"], header["longitude_deg"]
    signs = {ord("N"): 1.0, ord("E"): 1.0, ord("S"): -1.0, ord("W"): -1.0}
    north, east = header["hemisphere"].upper()
    valid = north in b"NS" and east in b"EW" and abs(latitude) <= 90 and abs(longitude) <= 180
    if not valid or latitude == longitude == 0:
        return None, None
    # The magnitudes: a firmware that already wrote signs beside its flags would else lose them.
    return signs[north] * abs(latitude), signs[east] * abs(longitude)
