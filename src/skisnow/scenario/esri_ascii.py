"""Heights from an ESRI ASCII grid: a header, then rows from north to south, each from west to east."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NoReturn

import numpy as np

from ..errors import ParameterError
from ..given import plain_text
from .grid_table import FloatArray, PlacedValues

MOST_BYTES: Final = 1 << 28
MOST_CELLS: Final = 50_000_000
_WORDS: Final = ("ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "nodata_value")
_NEEDED: Final = ("ncols", "nrows", "cellsize")


def read_esri_ascii(path: str | Path, *, column: str) -> PlacedValues:
    """Read a grid: x is east, y is north, in the file's coordinates (m); places are the middles of the cells.

    Raises
    ------
    ParameterError
        The file cannot be read, its header lacks something, there are more or fewer numbers than cells, one is no
        finite number or is NODATA; line and column are named.
    """
    lines = plain_text(path, most_bytes=MOST_BYTES).splitlines()
    header, first = _header(path, lines)
    n_columns, n_rows = (_count(path, header, word) for word in ("ncols", "nrows"))
    if n_columns * n_rows > MOST_CELLS:
        _refuse(path, f"{n_columns} × {n_rows} cells are too many: at most {MOST_CELLS} are read; cut out the slope")
    values = _values(path, lines, first, (n_columns, n_rows), header.get("nodata_value"))
    size = header["cellsize"]
    if not size > 0.0:
        _refuse(path, f"cellsize is {size:g}; it must be above 0, in m")
    x, y = (
        _lower_left(path, header, axis, size) + size * np.arange(count, dtype=np.float64)
        for axis, count in (("x", n_columns), ("y", n_rows))
    )
    return PlacedValues(x, y, {column: np.ascontiguousarray(values[::-1].T)})


def _refuse(path: str | Path, what: str) -> NoReturn:
    raise ParameterError(f"{path}: {what}")


def _header(path: str | Path, lines: list[str]) -> tuple[dict[str, float], int]:
    """By lower-case word, and the number of the first line of values."""
    found: dict[str, float] = {}
    for number, line in enumerate(lines):
        words = line.split()
        if not words:
            continue
        if words[0].lower() not in _WORDS:
            break
        try:
            (value,) = (float(word) for word in words[1:])
        except ValueError:
            _refuse(path, f"line {number + 1}: {line.strip()!r} must be {words[0]} and one number; correct it")
        found[words[0].lower()] = value
    else:
        number = len(lines)
    missing = [word for word in _NEEDED if word not in found]
    if missing:
        _refuse(path, f"line {number + 1}: the header has no {missing[0]}. Is it an ESRI ASCII grid? Export it again")
    return found, number


def _count(path: str | Path, header: Mapping[str, float], word: str) -> int:
    value = header[word]
    if not (value >= 2.0 and value == math.floor(value) and value < MOST_CELLS):
        _refuse(path, f"{word} is {value:g}; a surface needs a whole number of 2 or more")
    return int(value)


def _lower_left(path: str | Path, header: Mapping[str, float], axis: str, size: float) -> float:
    """The middle of the first cell."""
    corner, middle = (header.get(f"{axis}ll{word}") for word in ("corner", "center"))
    if corner is None and middle is None:
        _refuse(path, f"the header has neither {axis}llcorner nor {axis}llcenter: where does the grid begin? Add one")
    found = middle if middle is not None else (corner or 0.0) + size / 2.0
    if not math.isfinite(found):
        _refuse(path, f"{axis} of the lower left is {found}; it must be a finite number in m")
    return found


def _values(
    path: str | Path, lines: list[str], first: int, counts: tuple[int, int], no_data: float | None
) -> FloatArray:
    """(rows, columns), the northern row first."""
    n_columns, n_rows = counts
    rows = [(number, line.split()) for number, line in enumerate(lines[first:], start=first + 1) if line.strip()]
    if len(rows) != n_rows:
        _refuse(path, f"there are {len(rows)} rows of values where nrows is {n_rows}; the file is cut, or has more")
    values = np.empty((n_rows, n_columns))
    for place, (number, words) in enumerate(rows):
        if len(words) != n_columns:
            _refuse(path, f"line {number}: {len(words)} values where ncols is {n_columns}; write one row on each line")
        try:
            values[place] = [float(word) for word in words]
        except ValueError:
            pass
        else:
            bad = ~np.isfinite(values[place]) | (values[place] == (math.nan if no_data is None else no_data))
            if not bad.any():
                continue
        _refuse_value(path, number, words, no_data)
    return values


def _refuse_value(path: str | Path, number: int, words: list[str], no_data: float | None) -> NoReturn:
    for column, word in enumerate(words, start=1):
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if value == no_data:
            _refuse(
                path,
                f"line {number}, column {column}: {word} is NODATA_value: nobody measured a height there. Cut out a "
                "rectangle that is measured everywhere, or fill the gap",
            )
        if not math.isfinite(value):
            _refuse(path, f"line {number}, column {column}: {word!r} is no finite number; correct it")
    _refuse(path, f"line {number} cannot be read; correct it")
