"""Heights from an ESRI ASCII grid: a header, then values from north to south, each row from west to east."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NoReturn

import numpy as np

from .._support.errors import ParameterError
from .._support.user_files import is_file, plain_text
from .map_system import MapSystem, map_system
from .raster import FloatArray, PlacedValues, Raster, placed_heights, require_size

MOST_BYTES: Final = 1 << 28
_MOST_BYTES_OF_SYSTEM: Final = 1 << 20
_WORDS: Final = (
    "ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy",
    "nodata_value", "nodata",
)  # fmt: skip
_ENTRY: Final = re.compile(r"\s*([A-Za-z_]+)[ \t]+(\S+)")


def read_esri_ascii(path: str | Path, *, column: str) -> PlacedValues:
    """Read a grid: x is east, y is north, in the file's coordinates (m); places are the middles of the cells.

    Line breaks between values do not matter. A ``.prj`` file of the same name gives the map system.

    Raises
    ------
    ParameterError
        The file cannot be read, its header lacks an entry, there are more or fewer numbers than cells, a cell is a
        hole, or the grid breaks a rule of `raster`; line and column are named.
    """
    text = plain_text(path, most_bytes=MOST_BYTES)
    header, first = _header(path, text)
    for word in ("ncols", "nrows"):
        if word not in header:
            _refuse(path, f"The header has no {word}. Is it an ESRI ASCII grid? Export it again")
    require_size(path, header["ncols"], header["nrows"])
    counts = int(header["ncols"]), int(header["nrows"])
    steps = _cell(path, header, "dx"), _cell(path, header, "dy")
    west, south = (_lower_left(path, header, axis, size) for axis, size in zip("xy", steps, strict=True))
    system = _system(path)
    raster = Raster(
        path=path,
        values=_values(path, text, first, counts, header.get("nodata_value", header.get("nodata"))),
        first=(west, south + (counts[1] - 1) * steps[1]),
        step=(steps[0], -steps[1]),
        height_unit=1.0 if system is None or system.height_unit is None else system.height_unit,
        system=system,
        where=lambda row, at: _where(text, first, row * counts[0] + at),
    )
    return placed_heights(raster, column=column)


def _refuse(path: str | Path, what: str) -> NoReturn:
    raise ParameterError(f"{path}: {what}")


def _header(path: str | Path, text: str) -> tuple[dict[str, float], int]:
    """Numbers by lower-case word, and the place in the text at which the values begin."""
    found: dict[str, float] = {}
    at = 0
    while (entry := _ENTRY.match(text, at)) and entry[1].lower() in _WORDS:
        try:
            found[entry[1].lower()] = float(entry[2])
        except ValueError:
            line = text.count("\n", 0, entry.start(2)) + 1
            raise ParameterError(f"{path}, line {line}: {entry[1]} is {entry[2]!r}. Allowed: a number.") from None
        at = entry.end()
    return found, at


def _cell(path: str | Path, header: Mapping[str, float], word: str) -> float:
    """Width of the cells in x (dx) or y (dy)."""
    sizes = {header[name] for name in (word, "cellsize") if name in header}
    if not sizes:
        _refuse(path, f"The header has no cellsize, and no {word}. Is it an ESRI ASCII grid? Export it again")
    if len(sizes) > 1:
        _refuse(path, f"cellsize is {header['cellsize']:g}, but {word} is {header[word]:g}. Remove one of them")
    (size,) = sizes
    if not size > 0.0:
        _refuse(path, f"{word if word in header else 'cellsize'} is {size:g}. Allowed: above 0, in m")
    return size


def _lower_left(path: str | Path, header: Mapping[str, float], axis: str, size: float) -> float:
    """The middle of the first cell."""
    corner, middle = (header.get(f"{axis}ll{word}") for word in ("corner", "center"))
    if corner is None and middle is None:
        _refuse(path, f"The header has no {axis}llcorner and no {axis}llcenter. Add the one that the grid begins with")
    found = middle if middle is not None else (corner or 0.0) + size / 2.0
    if not math.isfinite(found):
        _refuse(path, f"{axis} of the lower left is {found}. Allowed: a finite number in m")
    return found


def _values(path: str | Path, text: str, first: int, counts: tuple[int, int], no_data: float | None) -> FloatArray:
    """(rows, columns), the northern row first; NaN in a hole."""
    cells = counts[0] * counts[1]
    if len(text) - first < 2 * cells - 1:  # before memory is allocated
        _refuse_number(path, len(text[first:].split()), counts)
    values = np.empty(cells)
    count, line = 0, text.count("\n", 0, first) + 1
    for line, words in enumerate((part.split() for part in text[first:].split("\n")), start=line):  # noqa: B020
        if count + len(words) > cells:
            _refuse_number(path, len(text[first:].split()), counts)
        try:
            values[count : count + len(words)] = [float(word) for word in words]
        except ValueError:
            _refuse_word(path, line, words)
        count += len(words)
    if count < cells:
        _refuse_number(path, count, counts)
    if no_data is not None:
        values[values == no_data] = np.nan
    return values.reshape(counts[1], counts[0])


def _refuse_number(path: str | Path, found: int, counts: tuple[int, int]) -> NoReturn:
    _refuse(
        path,
        f"The file has {found} values. Allowed: ncols × nrows = {counts[0]} × {counts[1]} = {counts[0] * counts[1]}. "
        "Export it again",
    )


def _refuse_word(path: str | Path, line: int, words: list[str]) -> NoReturn:
    for column, word in enumerate(words, start=1):
        try:
            float(word)
        except ValueError:
            raise ParameterError(
                f"{path}, line {line}, column {column}: {word!r} is not a number. Use digits and a decimal point."
            ) from None
    raise AssertionError(words)


def _where(text: str, first: int, cell: int) -> str:
    """Line and column of a value by its number (0 or more)."""
    for line, words in enumerate(map(str.split, text[first:].split("\n")), start=text.count("\n", 0, first) + 1):
        if cell < len(words):
            return f"line {line}, column {cell + 1}"
        cell -= len(words)
    raise AssertionError(cell)


def _system(path: str | Path) -> MapSystem | None:
    file = Path(path).with_suffix(".prj")
    return map_system(plain_text(file, most_bytes=_MOST_BYTES_OF_SYSTEM)) if is_file(file) else None
