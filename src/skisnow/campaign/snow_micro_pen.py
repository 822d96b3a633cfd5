"""Recordings of a SnowMicroPen: force against depth from its binary ``.PNT`` files, settings, surface of the snow.

A file is a header of 512 bytes, then force samples of two bytes, all big endian and signed, then padding to full
blocks. The layout is the one that the instrument's makers document in their own reader, snowmicropyn (WSL Institute for
Snow and Avalanche Research SLF).
"""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, date, datetime
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NoReturn, TypeAlias

import numpy as np

from .._support.arrays import FloatArray, IntArray
from .._support.errors import FieldDataError
from .._support.messages import Message
from .._support.units import CM, MM, Facts, Shown, amount
from .._support.user_files.text_files import ContentError, plain_bytes
from ..parameters import Allowed, Declared, Quantity
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
        _refuse(path.name, failure.what, Message("a readable file"), Message("Check its name and permissions."))
    return parse_snow_micro_pen(path.name, data)


def parse_snow_micro_pen(name: str, data: bytes) -> SnowMicroPenProfile:
    """Parse the bytes of a ``.PNT`` file; errors as `read_snow_micro_pen`."""
    if not data:
        allowed = Message("a recording of a SnowMicroPen")
        _refuse(name, "0 bytes", allowed, Message("Copy it from the instrument again."), "empty_file")
    if len(data) < HEADER_BYTES:
        allowed = Message(
            "at least {header_bytes} bytes, the header of a SnowMicroPen recording", header_bytes=HEADER_BYTES
        )
        _refuse(name, f"{len(data)} bytes", allowed, Message("Copy the file from the instrument again."))
    header: dict[str, Any] = {}
    for key, offset, form in _FIELDS:
        values = struct.unpack_from(f">{form}", data, offset)
        header[key] = values[0] if len(values) == 1 else values
    _require_plausible_header(name, header, len(data))
    counts = np.frombuffer(data, dtype=">i2", count=header["samples"], offset=HEADER_BYTES).astype(np.float64)
    distance, height = header["sample_distance_mm"] * MM, header["height_cm"]
    latitude, longitude = _position_or_none(header)
    return SnowMicroPenProfile(
        name=_text(header["name"]),
        comment=_text(header["comment"][: max(header["comment_length"], 0)]),
        depth=np.arange(counts.size) * distance,
        force=counts * header["force_per_count"],
        sample_distance=distance,
        tip_diameter=header["tip_diameter_um"] * _MICROMETRE,
        recorded_on=_recording_day(name, header["clock"]),
        latitude_deg=latitude,
        longitude_deg=longitude,
        height=None if height == _NO_HEIGHT_CM or not np.isfinite(height) else height * CM,
    )


def _refuse(name: str, value: str, allowed: Message, action: Message, code: str = "unreadable_file") -> NoReturn:
    """Raise a FieldDataError with one problem of the file `name`."""
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
            action = Message("This is another kind of file, or a damaged one.")
            _refuse(file, f"{name} {header[name]:g}", allowed, action)
    counts = {"samples": header["samples"], "needed": HEADER_BYTES + _SAMPLE_BYTES * header["samples"]}
    if size < counts["needed"]:
        allowed = Message("{needed} bytes or more for the {samples} samples that the header counts", **counts)
        action = Message("The file is cut off; copy it from the instrument again.")
        _refuse(file, f"{size} bytes", allowed, action)


def _text(raw: bytes) -> str:
    """Text (Latin-1) of bytes up to the first NUL, without surrounding spaces."""
    return raw.split(b"\0", 1)[0].decode("latin-1").strip()


def _recording_day(file: str, clock: tuple[int, ...]) -> date | None:
    """Day in the name of the file, else of the instrument's clock; None if none of them is a date."""
    names = [(int(digits[:4]), int(digits[4:6]), int(digits[6:])) for digits in re.findall(r"(?<!\d)\d{8}(?!\d)", file)]
    for fields in (*names, clock):
        try:
            return datetime(*fields, tzinfo=UTC).date()  # type: ignore[arg-type,misc]
        except ValueError:
            continue
    return None


def _position_or_none(header: dict[str, Any]) -> tuple[float, float] | tuple[None, None]:
    """Latitude and longitude (°) with the signs of their hemispheres; two None if invalid or both are 0."""
    latitude, longitude = header["latitude_deg"], header["longitude_deg"]
    signs = {ord("N"): 1.0, ord("E"): 1.0, ord("S"): -1.0, ord("W"): -1.0}
    north, east = header["hemisphere"].upper()
    valid = north in b"NS" and east in b"EW" and abs(latitude) <= 90 and abs(longitude) <= 180
    if not valid or latitude == longitude == 0:
        return None, None
    # The magnitudes: a firmware that already wrote signs beside its flags would else lose them.
    return signs[north] * abs(latitude), signs[east] * abs(longitude)


Relation: TypeAlias = Literal["proksch-2015", "calonne-2020", "king-2020a", "king-2020b"]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SnowMicroPenSettings(Declared):
    """The section ``[snow_micro_pen]`` of campaign.toml, in SI; every default is a modelling assumption."""

    from_depth: Annotated[
        float,
        Quantity(
            "from_depth_mm",
            "where the depth begins over which the force is averaged, from the snow surface; the instrument's cone of "
            "60° and 5 mm is 4.3 mm long",
        ),
        Allowed(0.0),
    ] = 5.0 * MM
    to_depth: Annotated[float, Quantity("to_depth_mm", "where it ends"), Allowed(0.0, above=True)] = 30.0 * MM
    surface_rise: Annotated[
        float,
        Quantity(
            "surface_rise_N", "the snow begins where the force rises by this above what it was in the air just before …"
        ),
        Allowed(0.0, above=True),
    ] = 0.01
    surface_hold: Annotated[float, Quantity("surface_hold_mm", "… and stays above over this length"), Allowed(0.0)] = (
        5.0 * MM
    )
    subtract_air_force: Annotated[
        bool, Quantity("subtract_air_force", "take the air's force off before anything else")
    ] = False
    relation: Annotated[
        Relation, Quantity("relation", "publication whose regression gives density and specific surface area")
    ] = "calonne-2020"


@dataclass(frozen=True, slots=True, repr=False)
class SnowMicroPenRecordings(Shown):
    """The m recordings that snow_micro_pen.csv names.

    recording, site, spot, file: names as written in the table; an absent spot is ``""``.
    surface: depth of the snow surface stated in the table, from the start of the recording (m); NaN if to be detected.
    cancelled: reason for cancelling the recording, or ``""``.
    row: line of the table.
    contents: bytes of each file.
    settings: settings of the evaluation.
    further: other columns as text.
    """

    recording: tuple[str, ...]
    site: tuple[str, ...]
    spot: tuple[str, ...]
    file: tuple[str, ...]
    surface: FloatArray
    cancelled: tuple[str, ...]
    row: IntArray
    contents: tuple[bytes, ...] = field(repr=False)
    settings: SnowMicroPenSettings = field(default_factory=SnowMicroPenSettings)
    further: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __len__(self) -> int:
        """Count the recordings."""
        return len(self.recording)

    def profile(self, index: int) -> SnowMicroPenProfile:
        """Force against depth of one recording, by its index."""
        return parse_snow_micro_pen(self.file[index], self.contents[index])

    def _repr_facts(self) -> Facts:
        """Title with the number of recordings, the depths of the forces and the sites."""
        depths = f"{amount(self.settings.from_depth / MM)} to {amount(self.settings.to_depth / MM, 'mm')}"
        return Facts(f"of {len(self)} recordings, forces from {depths}; {', '.join(dict.fromkeys(self.site))}")


BLOCK: Final = 0.5 * MM
"""Length over which the force is averaged, and accuracy of the surface (modelling assumption)."""
AIR: Final = 20.0 * MM
"""Length before a block over which the force in air is the median (modelling assumption)."""
LEAST_AIR: Final = 5.0 * MM
"""Shortest recorded length in air from which the force in air is known (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class SnowSurface:
    """Surface of the snow: depth (m) from the start of the recording, and force in the air before it (N)."""

    depth: float
    air_force: float


def snow_surface(force: FloatArray, sample_distance: float, *, rise: float, hold: float) -> SnowSurface | None:
    """Find the snow surface: the first depth from which the force stays ``rise`` above that in air over ``hold``.

    force: force (N) of each sample of the recording, `sample_distance` (m) apart; rise (N) above 0; hold (m).
    Returns None if there is no such depth.

    Example: a spike at 12 mm, snow from 30 mm.

    >>> force = np.full(500, 0.05)
    >>> force[120:125], force[300:] = 0.4, 0.3
    >>> found = snow_surface(force, 1e-4, rise=0.01, hold=5e-3)
    >>> round(found.depth * 1e3, 3), round(found.air_force, 3)
    (30.0, 0.05)
    """
    size = max(round(BLOCK / sample_distance), 1)
    length = size * sample_distance
    blocks = force[: len(force) // size * size].reshape(-1, size).mean(axis=1)
    hold_blocks, air_blocks, least_blocks = (max(round(distance / length), 1) for distance in (hold, AIR, LEAST_AIR))
    for index in range(least_blocks, len(blocks) - hold_blocks):
        level = float(np.median(blocks[max(index - air_blocks, 0) : index]))
        if (blocks[index : index + hold_blocks + 1] >= level + rise).all():
            return SnowSurface(index * length, level)
    return None
