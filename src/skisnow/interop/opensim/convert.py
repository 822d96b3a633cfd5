"""Files of motion converted by their endings."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from ...errors import ParameterError
from .c3d import read_c3d
from .markers import read_trc, write_trc
from .table import ENDINGS, read_motion, write_motion

MARKERS_IN: Final = (".trc", ".c3d")
CONVERSIONS: Final = {
    **dict.fromkeys(ENDINGS, ENDINGS),
    **dict.fromkeys(MARKERS_IN, (".trc",)),
}
"""Endings that are read, and those that each is written as."""


def convert_motion(given: str | Path, out: str | Path) -> Path:
    """Convert a file of motion by the endings of both: .mot and .sto into each other, .c3d and .trc into .trc.

    Returns
    -------
    Path
        Of the file written.

    Raises
    ------
    ParameterError
        The endings do not go together, or the file cannot be read.
    OutputError
        The place cannot be written.
    """
    source, target = Path(given), Path(out)
    allowed = CONVERSIONS.get(source.suffix.lower())
    if allowed is None:
        raise ParameterError(f"{source} ends in none of {', '.join(CONVERSIONS)}, which are read; name it so")
    if target.suffix.lower() not in allowed:
        raise ParameterError(f"{source} is written as {' or '.join(allowed)}, not as {target.name}; name it so")
    if allowed == ENDINGS:
        write_motion(read_motion(source), target)
    else:
        write_trc(read_c3d(source) if source.suffix.lower() == ".c3d" else read_trc(source), target)
    return target
