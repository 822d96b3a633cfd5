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
    ("firmware", 0, "h"),
    ("announced_samples", 2, "i"),
    ("sample_distance_mm", 6, "f"),
    ("force_per_count", 10, "f"),
    ("force_offset", 18, "h"),
    ("clock", 20, "6h"),
    ("speed_mm_per_s", 64, "f"),
    ("comment_length", 152, "h"),
    ("comment", 154, "102s"),
    ("name", 256, "8s"),
    ("latitude_deg", 264, "f"),
    ("longitude_deg", 268, "f"),
    ("height_cm", 272, "f"),
    ("dilution_of_precision", 276, "f"),
    ("hemisphere", 280, "2s"),
    ("satellites", 282, "h"),
    ("fix_mode", 284, "h"),
    ("samples", 358, "i"),
    ("tip_diameter_um", 376, "i"),
    ("overload_N", 380, "h"),
    ("instrument_serial", 384, "h"),
    ("instrument_length_mm", 386, "h"),
    ("sensor_serial", 392, "20s"),
    ("amplifier_serial", 412, "20s"),
)
_UNCHANGED: Final = (
    "force_per_count", "force_offset", "announced_samples", "dilution_of_precision", "satellites", "fix_mode",
    "overload_N", "firmware", "instrument_serial",
)  # fmt: skip
"""Fields of the header that a profile has under the same name and in the same unit."""


@dataclass(frozen=True, slots=True)
class SnowMicroPenProfile:
    """A recording: force against depth, and the header.

    file, name, comment: name of the file; name of the recording and comment in its header.
    depth: distance of the tip from its start in the air above the snow, at each sample (m). The file has neither the
        position of the surface nor the reason for the end of the recording.
    force: force on the tip (N): counts times `force_per_count`, without an offset.
    sample_distance: distance from sample to sample (m).
    force_per_count: N per count of the analogue-digital converter.
    force_offset: from the header; according to the makers unused, 0 in practice.
    announced_samples: a second, larger sample count in the header. The recording has ``len(force)`` samples; the rest
        of the file is padding.
    clock: time by the instrument's clock, UTC; None if it is not a date. It can be wrong by years, see
        `date_in_file_name`.
    date_in_file_name: date from the first eight digits in the file's name that are a date (20200208), or None.
    latitude_deg, longitude_deg: WGS 84, north and east positive: the header has magnitudes and the flags N or S, E or
        W. None where flags or numbers are not valid, or both are 0.
    height: height above sea level (m), or None.
    dilution_of_precision, satellites, fix_mode: values of the satellite receiver, from the header.
    speed: speed of the tip (m/s).
    tip_diameter, instrument_length: in m.
    overload_N: force at which the instrument stops.
    firmware, instrument_serial, sensor_serial, amplifier_serial: as in the header.
    """

    file: str
    name: str
    comment: str
    depth: FloatArray = field(repr=False)
    force: FloatArray = field(repr=False)
    sample_distance: float
    force_per_count: float
    force_offset: int
    announced_samples: int
    clock: datetime | None
    date_in_file_name: date | None
    latitude_deg: float | None
    longitude_deg: float | None
    height: float | None
    dilution_of_precision: float
    satellites: int
    fix_mode: int
    speed: float
    tip_diameter: float
    instrument_length: float
    overload_N: int
    firmware: int
    instrument_serial: int
    sensor_serial: str
    amplifier_serial: str

    @property
    def recorded_on(self) -> date | None:
        """Day of the recording: the file name's, else the clock's."""
        return self.date_in_file_name or (self.clock.date() if self.clock else None)


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
        file=file,
        name=_text(header["name"]),
        comment=_text(header["comment"][: max(header["comment_length"], 0)]),
        depth=np.arange(counts.size) * distance,
        force=counts * header["force_per_count"],
        sample_distance=distance,
        clock=_recording_time(header["clock"]),
        date_in_file_name=_date_in_file_name(file),
        latitude_deg=latitude,
        longitude_deg=longitude,
        height=None if height == _NO_HEIGHT_CM or not np.isfinite(height) else height * CM,
        speed=header["speed_mm_per_s"] * MM,
        tip_diameter=header["tip_diameter_um"] * _MICROMETRE,
        instrument_length=header["instrument_length_mm"] * MM,
        sensor_serial=_text(header["sensor_serial"]),
        amplifier_serial=_text(header["amplifier_serial"]),
        **{name: header[name] for name in _UNCHANGED},
    )


def _text(raw: bytes) -> str:
    """Text before the first NUL."""
    return raw.split(b"\0", 1)[0].decode("latin-1").strip()


def _recording_time(fields: tuple[int, ...]) -> datetime | None:
    year, month, day, hour, minute, second = fields
    try:
        return datetime(year, month, day, hour, minute, second, tzinfo=UTC)
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
