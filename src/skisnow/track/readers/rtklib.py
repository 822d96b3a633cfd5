"""Tracks in RTKLIB's solution files ``.pos``, with latitude and longitude in degrees, and height.

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
from ..track import Solution, solution_array
from .recording import FASTEST_NUMBER, Recording, is_not_finite, track_error

SCALES: Final = {"GPST": "GPS", "UTC": "UTC", "JST": "JST"}
PLACES: Final = ("latitude", "longitude", "height")
_NAMED: Final = Message("{columns}", columns="latitude(deg), longitude(deg), height(m)")
HEADER: Final = re.compile(
    r"^%[ \t]*+(?:(GPST|UTC|JST)[ \t,;]*+|[,;][ \t,;]*+)?(latitude|x-ecef|e-baseline).*", re.MULTILINE | re.IGNORECASE
)


@dataclass(frozen=True, slots=True)
class Header:
    """Header line of an RTKLIB solution: time scale, kind of coordinates, separator and names of the columns."""

    scale: str
    separator: str
    columns: tuple[str, ...]


def parse_header(text: str, name: str) -> Header:
    """Find and parse the header of a solution.

    Raises FieldDataError: the header is missing, or does not name latitude and longitude in degrees, and height.
    """
    match = HEADER.search(text)
    if match is None:
        allowed = Message("a header line such as: %  GPST  latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m)")
        action = Message("Switch the output of the header on in RTKLIB, and solve again.")
        raise track_error("missing_column", name, allowed, action)
    line = match[0]
    after = line[line.lower().index(match[2].lower()) :]
    unit = re.match(r"[\w-]+\((.*?)\)(.)?", after)
    separator = unit[2] if unit and unit[2] in (",", ";", "\t") else " "
    columns = tuple(re.sub(r"\(.*", "", cell).lower() for cell in re.split(r"[\s,;]+", after) if cell)
    absent = [column for column in PLACES if column not in columns]
    if absent or (unit is not None and "'" in unit[1]):
        action = Message("Choose latitude, longitude and height in decimal degrees as the format of RTKLIB's solution.")
        column = absent[0] if absent else PLACES[0]
        raise track_error("missing_column", name, _NAMED, action, column=column, value=line)
    return Header(SCALES.get((match[1] or "").upper(), "local"), separator, columns)


LARGEST: Final = 1e12
"""Largest number in any column; squares of larger ones could overflow."""
ZONES: Final = {"UTC": UTC, "JST": timezone(timedelta(hours=9))}
GPS_BEGIN: Final = datetime(1980, 1, 6)
"""Beginning of the weeks that RTKLIB counts; GPS time has no zone."""
AXES: Final = "enu"
PAIRS: Final = ("ne", "un", "eu")
"""Pairs of axes in the names of signed roots of covariances: first with second, second with third, third with first."""
_USED: Final = {
    "q", *PLACES, *(f"{prefix}{axis}" for prefix in ("v", "sd", "sdv") for axis in AXES),
    *(f"sdv{pair}" for pair in PAIRS),
}  # fmt: skip
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
    rows, moments, table, not_finite = [], [], [], []
    for row, line in enumerate(lines, start=1):
        if not line.strip() or line.lstrip()[0] in "%+$":
            continue
        moment, values, has_not_finite_cell = _row(line, header, name, row)
        rows.append(f"row {row}")
        moments.append(moment)
        table.append(values)
        not_finite.append(has_not_finite_cell)
    numbers = np.array(table, dtype=float).reshape(len(rows), len(header.columns))
    columns = dict(zip(header.columns, numbers.T, strict=True))
    velocity = _stack_vectors(columns, "v")
    quality = columns.get("q")
    is_ellipsoidal = "/geodetic" not in "".join(lines[:40]).lower()
    return Recording(
        name=name,
        places_in_file=rows,
        time=np.array([(moment - moments[0]).total_seconds() for moment in moments]),
        place=np.column_stack([columns[name] for name in PLACES]),
        time_scale=header.scale,
        start=moments[0] if moments else None,
        speed=np.full(len(rows), np.nan) if velocity is None else np.linalg.norm(velocity, axis=1),
        speed_kind="along the path (length of the recorded velocity)",
        velocity=velocity,
        place_sd=_stack_vectors(columns, "sd"),
        speed_sd=None if velocity is None else _speed_sd(columns, velocity),
        fix=None if quality is None else quality > 0.0,
        not_finite=np.array(not_finite, dtype=bool),
        solution=None if quality is None else solution_array([QUALITIES.get(value, "") for value in quality.tolist()]),
        heights="above the ellipsoid" if is_ellipsoidal else "above the geoid",
        columns=dict(zip("xyz", PLACES, strict=True)),
    )


def _row(line: str, header: Header, name: str, row: int) -> tuple[datetime, list[float], bool]:
    """The moment, one number for each column, and True if a cell is not a finite number."""
    cells = line.replace(header.separator, " ").split()
    moment = _parse_moment(cells, header.scale)
    if moment is None:
        allowed = Message("a time such as 2022/12/27 15:51:14.000, or week and seconds")
        written = " ".join(cells[:2])
        raise track_error("not_a_time", name, allowed, place=f"row {row}", column=header.scale, value=written)
    cells = cells[2 : 2 + len(header.columns)]
    if len(cells) < len(header.columns):
        allowed = Message("{count} numbers behind the time, as in the header line", count=len(header.columns))
        raise track_error("too_few_cells", name, allowed, place=f"row {row}", value=line.strip())
    values = [number(cell) for cell in cells]
    not_finite = False
    for place, (column, cell, value) in enumerate(zip(header.columns, cells, values, strict=True)):
        if math.isfinite(value) and abs(value) <= LARGEST:
            continue
        not_finite = True
        values[place] = math.nan
        if column in _USED and not is_not_finite(cell):  # a bad cell in another column is only flagged
            allowed = Message("a finite number with a decimal point, at most {largest:g}, or nan", largest=LARGEST)
            raise track_error("not_a_number", name, allowed, place=f"row {row}", value=cell)
    return moment, values, not_finite


def _parse_moment(cells: list[str], scale: str) -> datetime | None:
    """Time in the first two cells, as date and time or as GPS week and second; None if they hold another text."""
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


def _stack_vectors(columns: dict[str, FloatArray], prefix: str) -> FloatArray | None:
    """Three columns with a common prefix as an (n, 3) array; None unless all three are in the file."""
    names = [f"{prefix}{axis}" for axis in AXES]
    return np.column_stack([columns[name] for name in names]) if {*names} <= columns.keys() else None


def _speed_sd(columns: dict[str, FloatArray], velocity: FloatArray) -> FloatArray | None:
    """Standard deviation (n,) of the component along the velocity; at rest the largest of three; NaN if impossible."""
    deviations = _stack_vectors(columns, "sdv")
    if deviations is None:
        return None
    speed = np.linalg.norm(velocity, axis=1)
    along = velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
    variance = np.sum((along * deviations) ** 2, axis=1)
    for pair, one, other in zip(PAIRS, (0, 1, 2), (1, 2, 0), strict=True):
        root = columns.get(f"sdv{pair}", np.zeros(len(speed)))
        variance += 2.0 * along[:, one] * along[:, other] * np.sign(root) * root**2
    deviation = np.where(speed > 0.0, np.sqrt(np.maximum(variance, 0.0)), deviations.max(axis=1))
    return np.where(np.abs(deviation) <= FASTEST_NUMBER, deviation, np.nan)
