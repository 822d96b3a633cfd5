"""Skis in snow: the equilibrium of a ski at rest or carving, and the simulated run of a sledge on two skis."""

from __future__ import annotations

from .carve import Equilibrium, carve, rest
from .run import Run
from .scenario import Scenario, read_scenario, scenario_names

__all__ = ["Equilibrium", "Run", "Scenario", "carve", "read_scenario", "rest", "scenario_names"]
