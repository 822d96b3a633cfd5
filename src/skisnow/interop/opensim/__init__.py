"""OpenSim's files: tables of motion and storage (.mot, .sto), markers (.trc, .c3d), and boots from markers."""

from __future__ import annotations

from .c3d import read_c3d
from .motion_text import (
    BootMarkers,
    Markers,
    MotionTable,
    boots_of_markers,
    boots_text,
    read_motion,
    read_trc,
    write_motion,
    write_trc,
)

__all__ = [
    "BootMarkers",
    "Markers",
    "MotionTable",
    "boots_of_markers",
    "boots_text",
    "read_c3d",
    "read_motion",
    "read_trc",
    "write_motion",
    "write_trc",
]
