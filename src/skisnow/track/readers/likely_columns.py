"""What headings of a foreign table of a track likely mean, to be proposed and never taken."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

_METRES, _DEGREES = ("", "m"), ("", "°", "deg", "grad")
_WORDS: Final = {
    "time": (("zeit", "time", "t", "zeitstempel", "timestamp"), ("",)),
    "time_s": (("zeit", "time", "t"), ("s", "sec", "sek")),
    "x_m": (("x", "rechtswert", "east", "easting", "ost"), _METRES),
    "y_m": (("y", "hochwert", "north", "northing", "nord"), _METRES),
    "z_m": (("z",), _METRES),
    "lat": (("latitude", "breite", "breitengrad"), _DEGREES),
    "lon": (("lng", "long", "longitude", "länge", "längengrad"), _DEGREES),
    "alt_m": (("alt", "altitude", "elevation", "höhe", "height"), _METRES),
    "speed_m_per_s": (("speed", "v", "geschwindigkeit"), ("", "m/s")),
}
"""For each column the words that may stand for it, and the units in which its numbers may stay as they are."""
_HEADING: Final = re.compile(
    r"(?P<word>[^\W\d_]+)"
    r"(?:[\s_]*[\[(/]\s*(?P<bracketed>[^\])]*?)\s*[\])]?|[\s_]+(?P<unit>\S+))?"
)


def likely_columns(headings: Sequence[str]) -> dict[str, str]:
    """Which columns the headings of a table likely stand for; one in another unit stands for none.

    >>> likely_columns(["Zeit [s]", "x (m)", "Y", "Geschwindigkeit [km/h]"])
    {'Zeit [s]': 'time_s', 'x (m)': 'x_m', 'Y': 'y_m'}
    """
    found: dict[str, str] = {}
    for heading in headings:
        column = _column(" ".join(unicodedata.normalize("NFC", heading).split()).casefold())
        if column is not None and column not in found.values() and column not in headings:
            found[heading] = column
    return found


def _column(heading: str) -> str | None:
    match = _HEADING.fullmatch(heading)
    if match is None:
        return None
    unit = match["bracketed"] or match["unit"] or ""
    return next((name for name, (words, units) in _WORDS.items() if match["word"] in words and unit in units), None)
