"""Tracks in RTKLIB's solution files ``.pos``: latitude, longitude, height; earth-centred; or east, north, up of a base.

The header line names the columns, their separator, and the time scale: GPST, UTC or JST. It is required. Heights are
above the ellipsoid unless the header contains "geodetic".
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta, timezone
from typing import Final

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.spreadsheet_text import number
from ..projection import GeodeticPoint, east_north_up_axes, geodetic
from ..track import Solution, solution_array
from .recording import FARTHEST, FASTEST_NUMBER, Recording, is_not_finite, track_error

SCALES: Final = {"GPST": "GPS", "UTC": "UTC", "JST": "JST"}
PLACES: Final = {
    "geodetic": ("latitude", "longitude", "height"),
    "earth_centred": ("x-ecef", "y-ecef", "z-ecef"),
    "baseline": ("e-baseline", "n-baseline", "u-baseline"),
}
HEADER: Final = re.compile(
    r"^%[ \t]*+(?:(GPST|UTC|JST)[ \t,;]*+|[,;][ \t,;]*+)?(latitude|x-ecef|e-baseline).*", re.MULTILINE | re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class Header:
    """Header line of an RTKLIB solution: time scale, kind of coordinates, separator and names of the columns."""

    scale: str
    kind: str
    sexagesimal: bool
    separator: str
    columns: tuple[str, ...]

    @property
    def width(self) -> int:
        """Number of cells in a row after the time; an angle in degrees, minutes and seconds has three."""
        return len(self.columns) + (4 if self.sexagesimal else 0)


def parse_header(text: str, name: str) -> Header:
    """Find and parse the header of a solution.

    Raises FieldDataError: the header is missing, or does not name all three coordinates.
    """
    match = HEADER.search(text)
    if match is None:
        allowed = Message("a header line such as: %  GPST  latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m)")
        action = Message("Switch the output of the header on in RTKLIB, and solve again.")
        raise track_error("missing_column", name, allowed, action)
    line, first = match[0], match[2].lower()
    kind = next(kind for kind, names in PLACES.items() if names[0] == first)
    after = line[line.lower().index(first) :]
    unit = re.match(r"[\w-]+\((.*?)\)(.)?", after)
    separator = unit[2] if unit and unit[2] in (",", ";", "\t") else " "
    cells = [cell for cell in re.split(r"[\s,;]+", after) if cell]
    columns = tuple(re.sub(r"\(.*", "", cell).lower() for cell in cells)
    absent = [column for column in PLACES[kind] if column not in columns]
    if absent:
        raise track_error("missing_column", name, ", ".join(PLACES[kind]), column=absent[0], value=line)
    sexagesimal = kind == "geodetic" and unit is not None and "'" in unit[1]
    return Header(SCALES.get((match[1] or "").upper(), "local"), kind, sexagesimal, separator, columns)


LARGEST: Final = 1e12
"""Largest number in any column; squares of larger ones could overflow."""
ZONES: Final = {"UTC": UTC, "JST": timezone(timedelta(hours=9))}
GPS_BEGIN: Final = datetime(1980, 1, 6)
"""Beginning of the weeks that RTKLIB counts; GPS time has no zone."""
AXES: Final = {"geodetic": "enu", "earth_centred": "xyz", "baseline": "enu"}
"""Letters of the axes in the names of columns."""
PAIRS: Final = {"enu": ("ne", "un", "eu"), "xyz": ("xy", "yz", "zx")}
"""Pairs of axes in the names of signed roots of covariances: first with second, second with third, third with first."""
_COVARIANCES: Final = ("sdxy", "sdyz", "sdzx")
QUALITIES: Final[dict[float, Solution]] = {
    1.0: "fixed", 2.0: "float", 3.0: "code", 4.0: "code", 5.0: "code", 6.0: "float",
}  # fmt: skip
"""Kind of solution by the column Q: fix, float, SBAS, DGPS, single, PPP (by the phase, with float cycles)."""


def read_rtklib(text: str, name: str) -> Recording:
    """The recording in a solution file.

    Raises FieldDataError: the header line is missing, a row is shorter than it, or a cell is not a number or time.
    """
    lines = text.split("\n")
    header = parse_header(text, name)
    base = _base(lines, header)
    numbered = [
        (row, line) for row, line in enumerate(lines, start=1) if line.strip() and line.lstrip()[0] not in "%+$"
    ]
    rows, moments, table, not_finite = [], [], [], []
    for row, line in numbered:
        moment, values, has_not_finite_cell = _row(line, header, name, row)
        rows.append(f"row {row}")
        moments.append(moment)
        table.append(values)
        not_finite.append(has_not_finite_cell)
    numbers = np.array(table, dtype=float).reshape(len(rows), len(header.columns))
    columns = dict(zip(header.columns, numbers.T, strict=True))
    place, is_geodetic = _place(columns, header, base)
    velocity, place_sd = _stack_vectors(columns, "v", header), _deviations_of_places(columns, header, place)
    if velocity is not None and header.kind == "earth_centred":
        axes = east_north_up_axes(place[:, 0], place[:, 1])
        velocity = np.asarray(np.einsum("nij,nj->ni", axes, velocity))
    quality = columns.get("q")
    is_ellipsoidal = "/geodetic" not in "".join(lines[:40]).lower()
    return Recording(
        name=name,
        places_in_file=rows,
        time=np.array([(moment - moments[0]).total_seconds() for moment in moments]),
        place=place,
        is_geodetic=is_geodetic,
        time_scale=header.scale,
        start=moments[0] if moments else None,
        speed=np.full(len(rows), np.nan) if velocity is None else np.linalg.norm(velocity, axis=1),
        speed_kind="along the path (length of the recorded velocity)",
        velocity=velocity,
        place_sd=place_sd,
        speed_sd=None if velocity is None else _speed_sd(columns, header),
        fix=None if quality is None else quality > 0.0,
        not_finite=np.array(not_finite, dtype=bool),
        solution=None if quality is None else solution_array([QUALITIES.get(value, "") for value in quality.tolist()]),
        axes="east_north_up",
        frame="east, north, up in m from the base station of the solution",
        heights="above the ellipsoid" if is_ellipsoidal else "above the geoid",
        default_origin=base if header.kind == "baseline" else None,
        columns=dict(zip("xyz", PLACES["geodetic" if is_geodetic else "baseline"], strict=True)),
    )


def _row(line: str, header: Header, name: str, row: int) -> tuple[datetime, list[float], bool]:
    """The moment, one number for each column, and True if a cell is not a finite number."""
    cells = line.replace(header.separator, " ").split()
    moment = _parse_moment(cells, header.scale)
    if moment is None:
        allowed = Message("a time such as 2022/12/27 15:51:14.000, or week and seconds")
        written = " ".join(cells[:2])
        raise track_error("not_a_time", name, allowed, place=f"row {row}", column=header.scale, value=written)
    cells = cells[2:]
    if len(cells) < header.width:
        allowed = Message("{count} numbers behind the time, as in the header line", count=header.width)
        raise track_error("too_few_cells", name, allowed, place=f"row {row}", value=line.strip())
    cells = cells[: header.width]
    values = [number(cell) for cell in cells]
    first_column = header.width - len(header.columns)
    axes = AXES[header.kind]
    vectors = (f"{prefix}{axis}" for prefix in ("v", "sd", "sdv") for axis in axes)
    covariances = (*_COVARIANCES, *(f"sdv{pair}" for pair in PAIRS[axes]))
    used = {"q", *PLACES[header.kind], *vectors, *covariances}  # a bad cell in another column is only flagged
    not_finite = False
    for place, (cell, value) in enumerate(zip(cells, values, strict=True)):
        if math.isfinite(value) and abs(value) <= LARGEST:
            continue
        not_finite = True
        values[place] = math.nan
        is_used = place < first_column or header.columns[place - first_column] in used
        if is_used and not is_not_finite(cell):
            allowed = Message("a finite number with a decimal point, at most {largest:g}, or nan", largest=LARGEST)
            raise track_error("not_a_number", name, allowed, place=f"row {row}", value=cell)
    return moment, _degrees(cells, values) if header.sexagesimal else values, not_finite


def _degrees(cells: list[str], values: list[float]) -> list[float]:
    """Convert degrees, minutes, seconds of latitude and longitude to degrees; a leading minus applies to all three."""
    angles = []
    for begin in (0, 3):
        degrees, minutes, seconds = values[begin : begin + 3]
        size = abs(degrees) + minutes / 60.0 + seconds / 3600.0
        angles.append(-size if cells[begin].startswith("-") else size)
    return angles + values[6:]


def _parse_moment(cells: list[str], scale: str) -> datetime | None:
    if len(cells) < 2:
        return None
    try:
        if "/" in cells[0]:
            year, month, day = map(int, cells[0].split("/"))
            hours, minutes, seconds = cells[1].split(":")
            whole = datetime(year, month, day, int(hours), int(minutes), tzinfo=ZONES.get(scale))
            second = number(seconds)
            return whole + timedelta(seconds=second) if 0.0 <= second < 61.0 else None
        week, second = number(cells[0]), number(cells[1])
        if not (0.0 <= week <= 1e4 and 0.0 <= second <= 604800.0):
            return None
        return (GPS_BEGIN + timedelta(weeks=week, seconds=second)).replace(tzinfo=ZONES.get(scale))
    except (ValueError, OverflowError):
        return None


def _base(lines: list[str], header: Header) -> GeodeticPoint | None:
    """Base station of a baseline solution if the file names a valid one."""
    if header.kind != "baseline":
        return None
    for line in lines:
        match = re.match(r"%\s*ref pos\s*:\s*(.*)", line)
        cells = match[1].replace(header.separator, " ").split() if match else []
        values = [number(cell) for cell in cells]
        if len(values) == 7:  # degrees, minutes, seconds
            values = _degrees(cells, values)
        within = len(values) == 3 and abs(values[0]) <= 90.0 and abs(values[1]) <= 180.0
        if within and abs(values[2]) <= FARTHEST and any(values):
            return GeodeticPoint(*values)
    return None


def _stack_vectors(columns: dict[str, FloatArray], prefix: str, header: Header) -> FloatArray | None:
    names = [f"{prefix}{axis}" for axis in AXES[header.kind]]
    return np.column_stack([columns[name] for name in names]) if {*names} <= columns.keys() else None


def _place(columns: dict[str, FloatArray], header: Header, base: GeodeticPoint | None) -> tuple[FloatArray, bool]:
    """Places, and whether they are latitude, longitude and height."""
    place = np.column_stack([columns[name] for name in PLACES[header.kind]])
    if header.kind == "geodetic":
        return place, True
    place = np.where(np.abs(place) <= FARTHEST, place, np.nan)
    if header.kind == "earth_centred":
        return geodetic(place), True
    if base is None:
        return place, False
    return geodetic(base.in_space + place @ east_north_up_axes(base.latitude_deg, base.longitude_deg)), True


def _deviations_of_places(columns: dict[str, FloatArray], header: Header, place: FloatArray) -> FloatArray | None:
    deviations = _stack_vectors(columns, "sd", header)
    if deviations is None or header.kind != "earth_centred":
        return deviations
    covariance = np.zeros((len(place), 3, 3))
    for axis in range(3):
        covariance[:, axis, axis] = deviations[:, axis] ** 2
    for (one, other), name in (((0, 1), "sdxy"), ((1, 2), "sdyz"), ((0, 2), "sdzx")):
        root = columns.get(name, np.zeros(len(place)))
        covariance[:, one, other] = covariance[:, other, one] = np.sign(root) * root**2  # RTKLIB's way to keep the sign
    axes = east_north_up_axes(place[:, 0], place[:, 1])
    return np.asarray(np.sqrt(np.maximum(np.einsum("nij,njk,nik->ni", axes, covariance, axes), 0.0)))


def _speed_sd(columns: dict[str, FloatArray], header: Header) -> FloatArray | None:
    """Standard deviation (n,) of the component along the velocity; at rest the largest of three; NaN if impossible."""
    velocity, deviations = (_stack_vectors(columns, prefix, header) for prefix in ("v", "sdv"))
    if velocity is None or deviations is None:
        return None
    speed = np.linalg.norm(velocity, axis=1)
    along = velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
    variance = np.sum((along * deviations) ** 2, axis=1)
    for pair, one, other in zip(PAIRS[AXES[header.kind]], (0, 1, 2), (1, 2, 0), strict=True):
        root = columns.get(f"sdv{pair}", np.zeros(len(speed)))
        variance += 2.0 * along[:, one] * along[:, other] * np.sign(root) * root**2
    deviation = np.where(speed > 0.0, np.sqrt(np.maximum(variance, 0.0)), deviations.max(axis=1))
    return np.where(np.abs(deviation) <= FASTEST_NUMBER, deviation, np.nan)
