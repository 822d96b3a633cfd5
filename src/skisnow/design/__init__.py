"""From the wanted turn to the ski that makes it: variables, conditions, goals, and the search."""

from __future__ import annotations

from .result import Design, DesignRow
from .search import design_ski
from .task import DesignTask, read_design

__all__ = ["Design", "DesignRow", "DesignTask", "design_ski", "read_design"]
