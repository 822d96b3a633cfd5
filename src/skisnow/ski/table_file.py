"""A table of a ski in a CSV file: a row for each station, from tip to tail."""

from __future__ import annotations

import csv
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.spreadsheet_text import (
    SEPARATOR_NAMES,
    NoTextError,
    column_names,
    decimal_mark,
    decoded,
    named_separator,
    with_decimal_point,
)
from .._support.user_files import plain_bytes
from ..parameters import nearest
from .file_keys import COLUMNS
from .file_values import checked, refuse, warn_of_unusual
from .station_table import StationTable

if TYPE_CHECKING:
    from pathlib import Path

FloatArray = npt.NDArray[np.float64]

MOST_BYTES: Final = 1 << 20
"""Of a table: a row for each 2.5 mm of a ski takes 200 kB at most."""


def read_table(path: Path) -> dict[str, StationTable]:
    """Read the columns of a table, in SI, by their names; ``station_m`` is the station of each.

    The first line names the columns: ``station_m`` and any of ``width_mm``, ``base_height_mm``, ``EI_N_m2``,
    ``GJ_N_m2``, ``mass_per_length_kg_per_m``. Separators are commas, semicolons or tabs, decimals have a point or a
    comma, one of them in a file; lines beginning with # are remarks.

    Raises
    ------
    ParameterError
        The file cannot be read, a column is unknown or missing, a cell is no number or outside its range, or the
        stations do not fall. Line numbers are those of the file.
    """
    separator, lines = _lines(path)
    first, cells = lines[0]
    header = column_names(cells, COLUMNS)
    for place, name in enumerate(header):
        if name not in COLUMNS:
            raise ParameterError(f"{path}, line {first}: the column {name!r} is not known. {nearest(name, COLUMNS)}.")
        if name in header[:place]:
            raise ParameterError(f"{path}, line {first}: the column {name} stands there twice. Remove one.")
    if "station_m" not in header or len(header) < 2:
        raise ParameterError(f"{path}, line {first}: needed are the column station_m and one or more others. Add it.")
    mark = decimal_mark([(cell for _, cells in lines[1:] for cell in cells)], separator=separator)
    rows = [_row(path, line, header, cells, mark) for line, cells in lines[1:]]
    columns = dict(zip(header, np.array(rows).T, strict=True))
    numbers = [line for line, _ in lines[1:]]
    station = columns["station_m"]  # in m, as it is
    _require_falling(path, station, numbers)
    for name, column in columns.items():
        places = {f"line {line}, {name}": float(value) for line, value in zip(numbers, column, strict=True)}
        warn_of_unusual(path, places, COLUMNS[name])
    return {name: StationTable(station, column * COLUMNS[name].factor) for name, column in columns.items()}


def _lines(path: Path) -> tuple[str, list[tuple[int, list[str]]]]:
    """The separator, and the lines that are no remarks with their cells."""
    try:
        text = decoded(plain_bytes(path, most_bytes=MOST_BYTES)).text
    except NoTextError as error:
        raise ParameterError(f"{path} is no text ({error.place} is no {error.encoding}). Save it as UTF-8.") from error
    named = named_separator(text)
    first = 2 if named in SEPARATOR_NAMES else 1
    separator = named if named is not None and first == 2 else next((mark for mark in ";\t" if mark in text), ",")
    rows = enumerate(csv.reader(text.splitlines()[first - 1 :], delimiter=separator), start=first)
    try:
        lines = [(line, [cell.strip() for cell in row]) for line, row in rows if any(map(str.strip, row))]
    except csv.Error as error:
        raise ParameterError(f"{path} is no table of cells ({error}). Is a quote never closed?") from error
    lines = [(line, cells) for line, cells in lines if not cells[0].startswith("#")]
    if len(lines) < 3:
        raise ParameterError(f"{path}: a table needs a line of column names and two rows or more. Complete it.")
    return separator, lines


def _row(path: Path, line: int, header: list[str], cells: list[str], mark: str) -> list[float]:
    if len(cells) != len(header):
        raise ParameterError(f"{path}, line {line}: {len(cells)} cells stand under {len(header)} columns. Correct it.")
    return [_cell(path, line, name, cell, mark) for name, cell in zip(header, cells, strict=True)]


def _cell(path: Path, line: int, name: str, cell: str, mark: str) -> float:
    column = replace(COLUMNS[name], name=f"line {line}, {name}")
    try:
        value: object = float(cell if mark == "." else with_decimal_point(cell))
    except ValueError:
        value = cell
    number = checked(path, value, column)
    assert isinstance(number, float)
    return number


def _require_falling(path: Path, station: FloatArray, lines: list[int]) -> None:
    rising = np.flatnonzero(np.diff(station) >= 0)
    if rising.size:
        place, value = f"line {lines[rising[0] + 1]}, station_m", float(station[rising[0] + 1])
        allowed = f"less than the {station[rising[0]]:g} before it"
        refuse(path, place, value, allowed, "List the rows from tip to tail, positive in front of the boot")
