"""Cells of text to numbers, and nothing else to numbers: no ``nan``, no ``1_000``, no digits of other scripts.

A file writes decimal points or decimal commas, never both: in a file with decimal commas 1.234 could be a thousand.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.spreadsheet_text import decimal_mark, is_number, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..records import FloatArray

__all__ = ["decimal_mark", "is_number", "number", "numbers"]

_BETWEEN: Final = "\x1f"  # the unit separator: in no number


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
