"""Parameters from tracks, photo-cell times, or the track left in the snow.

The room can be called: `skisnow.identify(…)` is `skisnow.identify.identify`.
"""

from __future__ import annotations

from ..callable_rooms import make_callable
from .identification import Identification, Identified, identification_dict
from .identifying import identify
from .marks import Marks, read_marks
from .parameter import Parameter
from .photo_cells import PhotoCellRun, PhotoCells, read_photo_cells

__all__ = [
    "Identification",
    "Identified",
    "Marks",
    "Parameter",
    "PhotoCellRun",
    "PhotoCells",
    "identification_dict",
    "identify",
    "read_marks",
    "read_photo_cells",
]

make_callable(__name__, ".identifying", "identify")
