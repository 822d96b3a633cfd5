"""The line of an RTKLIB solution that names its columns, their separator, and the time scale."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from .refusal import refusal

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
    """The line that names the columns."""

    scale: str
    kind: str
    sexagesimal: bool
    separator: str
    columns: tuple[str, ...]

    @property
    def width(self) -> int:
        """Numbers in a row behind the time: an angle in degrees, minutes and seconds takes three."""
        return len(self.columns) + (4 if self.sexagesimal else 0)


def header_of(text: str, name: str) -> Header:
    """The header of a solution.

    Raises
    ------
    FieldDataError
        There is none, or it does not name all three coordinates.
    """
    found = HEADER.search(text)
    if found is None:
        raise refusal(
            "missing_column",
            name,
            allowed="a header line such as: %  GPST  latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m)",
            action="Switch the output of the header on in RTKLIB, and solve again.",
        )
    line, first = found[0], found[2].lower()
    kind = next(kind for kind, names in PLACES.items() if names[0] == first)
    after = line[line.lower().index(first) :]
    unit = re.match(r"[\w-]+\((.*?)\)(.)?", after)
    separator = unit[2] if unit and unit[2] in (",", ";", "\t") else " "
    cells = [cell for cell in re.split(r"[\s,;]+", after) if cell]
    columns = tuple(re.sub(r"\(.*", "", cell).lower() for cell in cells)
    absent = [column for column in PLACES[kind] if column not in columns]
    if absent:
        raise refusal(
            "missing_column",
            name,
            column=absent[0],
            value=line,
            allowed=", ".join(PLACES[kind]),
            action="The header line is damaged; solve again.",
        )
    sexagesimal = kind == "geodetic" and unit is not None and "'" in unit[1]
    return Header(SCALES.get((found[1] or "").upper(), "local"), kind, sexagesimal, separator, columns)
