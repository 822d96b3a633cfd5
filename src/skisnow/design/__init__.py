"""From the wanted turn to the ski that makes it: variables, conditions, goals, and the search; skis as measured."""

from __future__ import annotations

from .measured_ski import Measured, MeasuredSki, measured_ski
from .result import Design, DesignRow
from .search import FrontPoint, design_front, design_ski
from .ski_tables import Mapped
from .task import DesignTask, read_design

__all__ = [
    "Design",
    "DesignRow",
    "DesignTask",
    "FrontPoint",
    "Mapped",
    "Measured",
    "MeasuredSki",
    "design_front",
    "design_ski",
    "measured_ski",
    "read_design",
]
