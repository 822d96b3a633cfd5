"""Tables of a ski that a maker has: any order, headings and units, from CSV files and workbooks."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.spreadsheet_text import decimal_mark, number
from .._support.user_files.text_files import plain_bytes
from ..campaign.importing.sheets import Sheet, column_letters, read_sheets
from ..campaign.reading.headings import FORM, conversion, known_unit, named_unit, plain_heading, units_for
from ..parameters import suggest_and_list

SYNONYMS: Final = {
    "station_mm": "station, position, distance, abstand, stelle, x",
    "width_mm": "width, breite",
    "base_height_mm": "base height, camber, vorspannung, höhe",
    "EI_N_m2": "ei, bending stiffness, biegesteifigkeit",
    "GJ_N_m2": "gj, torsional stiffness, torsionssteifigkeit",
    "bend_span_mm": "span, bend span, stützweite, auflagerabstand",
    "bend_load_N": "load, force, bend load, last, kraft",
    "deflection_mm": "deflection, durchbiegung",
    "torsion_length_mm": "torsion length, torsionslänge, einspannlänge",
    "torsion_moment_Nm": "moment, torque, drehmoment, torsion moment",
    "twist_deg": "twist, verdrehung, verdrehwinkel",
}
"""Columns, and what they are called in headings."""
STIFFNESSES: Final = ("EI_N_m2", "GJ_N_m2")
BEND_TEST: Final = ("bend_span_mm", "bend_load_N", "deflection_mm")
TORSION_TEST: Final = ("torsion_length_mm", "torsion_moment_Nm", "twist_deg")
_STIFFNESS_UNITS: Final = {"n m2": 1.0, "nm2": 1.0, "n mm2": 1e-6, "nmm2": 1e-6, "kn m2": 1e3, "knm2": 1e3}
"""Factors to N m², by the unit without powers and middle dots."""
_BY_WORD: Final = {
    word: name
    for name, synonyms in reversed(SYNONYMS.items())
    for word in (
        name.casefold(),
        re.sub(r"_(mm|N_m2|N|Nm|deg)$", "", name).replace("_", " ").casefold(),
        *synonyms.split(", "),
    )
}
_MOST_BYTES: Final = 1 << 22
_LARGEST: Final = 1e7  # size of a number that no ski has, in the units of the columns


@dataclass(frozen=True, slots=True)
class Mapped:
    """Columns and units that the user states for headings."""

    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in self.columns.values():
            if name not in SYNONYMS:
                raise ParameterError("the column {name!r} is not known. {allowed}").tag(
                    "unknown_name", name=name, allowed=suggest_and_list(name, SYNONYMS)
                )

    def column(self, heading: str) -> str:
        """Column of a heading: the stated one, the one whose name or synonym it is, or ""."""
        plain = plain_heading(heading)
        stated = {plain_heading(key): name for key, name in self.columns.items()}
        if plain in stated:
            return stated[plain]
        match = FORM.fullmatch(plain)
        words = re.sub(r"[\s_]+", " ", match["words"] if match else plain).strip()
        return _BY_WORD.get(plain) or _BY_WORD.get(words, "")

    def unit(self, heading: str) -> str:
        """Unit that is stated for a heading, or that it names."""
        stated = {plain_heading(key): unit for key, unit in self.units.items()}.get(plain_heading(heading))
        if stated is not None:
            return stated
        match = FORM.fullmatch(" ".join(heading.split()))
        return named_unit(heading) or ((match["in"] or "") if match else "")


def read_ski_table(path: Path, mapped: Mapped) -> dict[str, FloatArray]:
    """Columns of the first table of a file, in the units of their names, without blank rows and unknown headings.

    Raises ParameterError: no column is known, a unit is neither named nor stated, or a cell is not a number.
    """

    def count(cells: Sequence[str]) -> int:
        return sum(map(bool, map(mapped.column, cells)))

    for sheet in read_sheets(path.name, plain_bytes(path, most_bytes=_MOST_BYTES), count=count):
        for row, cells in enumerate(sheet.filled):
            places = {name: place for place, cell in enumerate(cells) if (name := mapped.column(cell))}
            if "station_mm" in places and len(places) > 1:
                return _read_columns(path, sheet, row, places, mapped)
    raise ParameterError(
        "{path} has no row with a heading for the station and one for another column. Allowed: {names}. State a "
        "heading by --column HEADING=NAME."
    ).tag("missing", path=path, names=list(SYNONYMS))


def _read_columns(
    path: Path, sheet: Sheet, header: int, places: Mapping[str, int], mapped: Mapped
) -> dict[str, FloatArray]:
    """Numbers of the columns, in the units of their headings or the row below; NaN for blank cells."""
    below = {place: sheet.cell(header + 1, place).strip("[]()") for place in places.values()}
    has_units = any(map(known_unit, below.values()))
    rows = [
        row
        for row in range(header + 1 + has_units, len(sheet.rows))
        if sheet.cell(row, places["station_mm"]) and not sheet.cell(row, 0).startswith("#")
    ]
    cells = [sheet.cell(row, place) for row in rows for place in places.values()]
    mark = decimal_mark([cells], separator=sheet.separator)
    columns = {}
    for name, place in places.items():
        heading = sheet.cell(header, place, filled=True)
        unit = mapped.unit(heading) or (below[place] if has_units else "")
        factor = _factor(path, heading, unit, name)
        columns[name] = np.array([_read_number(path, sheet, row, place, mark, factor) for row in rows])
    return columns


def _factor(path: Path, heading: str, unit: str, name: str) -> float:
    """Factor from the unit of a heading to that of its column; a heading that is the column's name has its unit."""
    if not unit and plain_heading(heading) == name.casefold():
        return 1.0
    if name in STIFFNESSES:
        plain = re.sub(r"[\s·*]+", " ", unit.replace("²", "2").replace("^2", "2")).strip().casefold()
        factor, allowed = _STIFFNESS_UNITS.get(plain), "N m², N mm², kN m²"
    else:
        found = conversion(known_unit(unit), name)
        factor, allowed = (None if found is None else found.factor), units_for(name)
    if factor is None:
        raise ParameterError(
            "{path}: the heading {heading!r} names no unit that {name} can have. Allowed: {allowed}. Write the unit in "
            "brackets, or state it by --unit HEADING=UNIT."
        ).tag("no_unit", path=path, heading=heading, name=name, allowed=allowed)
    return factor


def _read_number(path: Path, sheet: Sheet, row: int, place: int, mark: str, factor: float) -> float:
    """Number of a cell times `factor`, NaN if it is blank; rejects text and too large numbers."""
    cell = sheet.cell(row, place)
    value = factor * number(cell, "." if (row, place) in sheet.fractions else mark) if cell else np.nan
    if cell and not abs(value) <= _LARGEST:
        raise ParameterError(
            "{path}, {sheet}, cell {letters}{row}: {cell!r} is not a number within ±{largest:g}. Correct it or leave "
            "it blank."
        ).tag(
            "not_a_number", path=path, sheet=sheet.name, letters=column_letters(place), row=row + 1, cell=cell,
            largest=_LARGEST,
        )  # fmt: skip
    return value
