"""A measured profile of a slope from its CSV file."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Final

import numpy as np

from ..errors import ParameterError
from ..given import plain_text
from ..spreadsheet_text import decimal_mark, most_frequent_separator, number
from .slope import Gap, Profile

COLUMNS: Final = ("x", "y")
_MOST_BYTES: Final = 1 << 26
_HEAD: Final = 1 << 16
_ACTION: Final = "write horizontal distance and height in m, with a decimal point, under a first line x,y"


def read_profile(path: str | Path, *, gap: Gap = "error") -> Profile:
    """Read a profile.

    Parameters
    ----------
    path
        A CSV file with a first line ``x,y``: horizontal distance, rising, and height, both in m. Commas, semicolons or
        tabs between cells; decimal points, or commas where cells are parted otherwise. Other columns are not read.
    gap
        What to do where neighbouring points are more than 5 m apart: "error", or "interpolate" over it.

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing, a cell holds no finite number (file, row, column and value are
        named), or it is no profile: too few points, x that does not rise, a gap, a cliff.
    """
    path = Path(path)
    try:
        text = plain_text(path, most_bytes=_MOST_BYTES)
        separator = most_frequent_separator(text[:_HEAD])
        lines = list(csv.reader(io.StringIO(text), delimiter=separator))
        mark = decimal_mark([chain.from_iterable(lines[1:])], separator=separator) if separator != "," else "."
        points = list(_points(path, lines, mark))
    except csv.Error as error:
        raise ParameterError(f"{path} is no CSV text ({error}); {_ACTION}") from error
    try:
        table = np.array(points, dtype=float).reshape(-1, 2)
        return Profile(table[:, 0], table[:, 1], gap=gap, source=str(path))
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def _points(path: Path, lines: list[list[str]], mark: str) -> Iterator[tuple[float, float]]:
    head = [cell.strip() for cell in (lines[0] if lines else [])]
    missing = [name for name in COLUMNS if name not in head]
    if missing:
        raise ParameterError(f"{path}, row 1: there is no column {missing[0]} among {', '.join(head)}; {_ACTION}")
    places = [head.index(name) for name in COLUMNS]
    for row, cells in enumerate(lines[1:], start=2):
        if any(cell.strip() for cell in cells[len(head) :]):
            raise ParameterError(
                f"{path}, row {row}: {len(cells)} cells stand under {len(head)} names of columns, as a decimal comma "
                f"makes them; {_ACTION}"
            )
        if any(cell.strip() for cell in cells):
            x, y = (
                _number(path, row, name, cells[place] if place < len(cells) else "", mark)
                for name, place in zip(COLUMNS, places, strict=True)
            )
            yield x, y


def _number(path: Path, row: int, column: str, cell: str, mark: str) -> float:
    value = number(cell, mark)
    if not math.isfinite(value):
        raise ParameterError(f"{path}, row {row}, column {column}: {cell.strip()!r} is no finite number; {_ACTION}")
    return value
