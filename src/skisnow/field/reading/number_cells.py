"""Cells of text to numbers, and nothing else to numbers: no ``nan``, no ``1_000``, no digits of other scripts.

A file writes decimal points or decimal commas, never both: in a file with decimal commas 1.234 could be a thousand.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..records import FloatArray

_FORMS: Final = {
    mark: re.compile(rf"[+-]?([0-9]+{escaped}?[0-9]*|{escaped}[0-9]+)([eE][+-]?[0-9]+)?")
    for mark, escaped in ((".", r"\."), (",", ","))
}
_BETWEEN: Final = "\x1f"  # the unit separator: in no number


def is_number(cell: str, mark: str) -> bool:
    """Tell whether a stripped cell is written as a number with this decimal mark.

    >>> is_number("-1.5e3", "."), is_number("1_000", "."), is_number("nan", "."), is_number("1.5", ",")
    (True, False, False, False)
    """
    return _FORMS[mark].fullmatch(cell) is not None


def number(cell: str, mark: str) -> float:
    """Read one cell; NaN where it is no finite number.

    >>> number(" 2,5", ","), number("1e999", ".")
    (2.5, nan)
    """
    stripped = cell.strip()
    if not is_number(stripped, mark):
        return math.nan
    value = float(stripped.replace(",", "."))
    return value if math.isfinite(value) else math.nan


def numbers(cells: Sequence[str], mark: str) -> FloatArray:
    """Read a column of cells; NaN where a cell is blank or no finite number.

    The whole column at once where it is plain, cell by cell where it is not.
    """
    together = _BETWEEN.join(cells)
    if together.isascii() and "_" not in together and not (mark == "," and "." in together):
        try:
            values = np.array(_all_numbers(together.replace(",", ".").split(_BETWEEN) if mark == "," else cells))
        except ValueError:
            return np.array([number(cell, mark) for cell in cells])
        values[~np.isfinite(values)] = np.nan
        return values
    return np.array([number(cell, mark) for cell in cells])


def _all_numbers(cells: Sequence[str]) -> list[float]:
    try:
        return list(map(float, cells))
    except ValueError:
        return [float(cell or "nan") for cell in cells]


def decimal_mark(groups: Iterable[Iterable[str]], *, separator: str) -> str:
    """Tell whether numbers are written with a decimal point or a decimal comma.

    The first group of cells with a fraction decides, by its majority; where both are equally many, a file separated by
    commas has points and any other has commas. Without any fraction it is the point.

    >>> decimal_mark([["1", "2"], ["0,5", "1,5", "2.5"]], separator=";")
    ','
    """
    for cells in groups:
        written = list(cells)
        points, commas = _count(written, "."), _count(written, ",")
        if points or commas:
            tie_is_comma = separator != ","
            return "," if commas > points or (commas == points and tie_is_comma) else "."
    return "."


def _count(cells: Iterable[str], mark: str) -> int:
    return sum(mark in cell and is_number(cell.strip(), mark) for cell in cells)
