"""Parameters from tracks, photo-cell times, or the track left in the snow."""

from __future__ import annotations

from .identification import Identification, Identified, identification_dict
from .identifying import identify
from .measured_grooves import MeasuredGrooves, read_measured_grooves
from .parameter import Parameter
from .photo_cells import PhotoCellRun, PhotoCells, read_photo_cells

__all__ = [
    "Identification",
    "Identified",
    "MeasuredGrooves",
    "Parameter",
    "PhotoCellRun",
    "PhotoCells",
    "identification_dict",
    "identify",
    "read_measured_grooves",
    "read_photo_cells",
]
