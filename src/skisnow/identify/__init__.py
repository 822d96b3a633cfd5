"""Parameters from tracks, photo-cell times, or marks left in the snow."""

from __future__ import annotations

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
