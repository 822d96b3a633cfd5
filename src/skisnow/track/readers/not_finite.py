"""Cells that hold no finite number, as programs write them: `nan`, `-nan(ind)`, `inf`, `1.#QNAN`."""

from __future__ import annotations

import re
from typing import Final

NOT_FINITE_CELL: Final = re.compile(
    r"[+-]?(?:nan(?:\([\w ]*\))?|inf(?:inity)?|1\.#(?:inf|ind|qnan|snan)0*)", re.IGNORECASE
)
"""Written by C, C++ (also of Windows), Fortran, Python and MATLAB."""


def is_not_finite(cell: str) -> bool:
    """True if a cell is written as a number that is not finite.

    >>> [is_not_finite(cell) for cell in ("-nan(ind)", "Inf", "-1.#IND00", "nano", "1.5", "")]
    [True, True, True, False, False, False]
    """
    return NOT_FINITE_CELL.fullmatch(cell.strip()) is not None
