"""Skis: their shape, stiffness and mass, their files and a catalogue. Knows no snow."""

from .assembling import arc_ski
from .layout import BaseShape, Layout, SkiSections, layout_of_lengths
from .ski import Ski
from .ski_file import read_ski, ski_named, ski_names, write_ski

__all__ = [
    "BaseShape", "Layout", "Ski", "SkiSections", "arc_ski", "layout_of_lengths", "read_ski", "ski_named", "ski_names",
    "write_ski",
]  # fmt: skip
