"""Markers of a .c3d file, read by ezc3d."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...given import plain_bytes
from .markers import METRES, Markers
from .table import MOST_BYTES


def read_c3d(path: str | Path) -> Markers:
    """Read the markers of a .c3d file; needs ezc3d (``skisnow[c3d]``).

    Raises
    ------
    ParameterError
        ezc3d is not installed, the file cannot be read, or it has no markers or no sound unit.
    """
    try:
        import ezc3d
    except ImportError:
        raise ParameterError(
            f"{path}: .c3d files are read by ezc3d, which is not installed: pip install 'skisnow[c3d]'"
        ) from None
    plain_bytes(path, most_bytes=MOST_BYTES)
    try:
        found: Any = ezc3d.c3d(str(path))
        about = found["parameters"]["POINT"]
        names = tuple(map(str, about["LABELS"]["value"]))
        unit = str(about["UNITS"]["value"][0])
        rate = float(found["header"]["points"]["frame_rate"])
        first = int(found["header"]["points"]["first_frame"])
        points = np.asarray(found["data"]["points"], float)
    except Exception as error:  # whatever a broken file makes of it
        raise ParameterError(f"{path} cannot be read as .c3d: {error}") from error
    if not names or unit not in METRES:
        raise ParameterError(
            f"{path}: it has {len(names)} markers in {unit!r}; markers in {', '.join(METRES)} are read"
        )
    place = METRES[unit] * np.moveaxis(points[:3, : len(names)], (0, 1, 2), (2, 1, 0))
    time = (first + np.arange(len(place))) / rate
    return Markers(time, names, np.ascontiguousarray(place), rate)
