"""Parameters from tracks, photo-cell times, or the track left in the snow.

The package can be called: `skisnow.identify(…)` is `skisnow.identify.identify`.
"""

from __future__ import annotations

from typing import Any

from ..callable_packages import make_callable
from ..former_names import formerly, warn_of_former_name
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

read_marks = formerly("read_marks", read_measured_grooves)


def __getattr__(name: str) -> Any:
    if name != "Marks":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn_of_former_name(f"{__name__}.Marks", "MeasuredGrooves")
    return MeasuredGrooves


make_callable(__name__, ".identifying", "identify")
