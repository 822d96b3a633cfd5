"""Parameters from tracks, photo-cell times, or the track left in the snow."""

from __future__ import annotations

from .data_tables import PhotoCellRun, PhotoCells, read_photo_cells
from .fitting import identify
from .parameter import Parameter
from .result import Identification, Identified, identification_dict

__all__ = [
    "Identification", "Identified", "Parameter", "PhotoCellRun", "PhotoCells", "identification_dict",
    "identify", "read_photo_cells",
]  # fmt: skip
