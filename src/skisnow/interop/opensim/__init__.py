"""OpenSim's files: tables of motion and storage (.mot, .sto), markers (.trc, .c3d), and boots from markers."""

from __future__ import annotations

from .c3d import read_c3d, write_c3d
from .markers import BootMarkers, Markers, boots_of_markers, boots_text, read_trc, write_trc
from .table import MotionTable, read_motion, write_motion

__all__ = [
    "BootMarkers",
    "Markers",
    "MotionTable",
    "boots_of_markers",
    "boots_text",
    "read_c3d",
    "read_motion",
    "read_trc",
    "write_c3d",
    "write_motion",
    "write_trc",
]
