"""Skis in snow: the equilibrium of a ski at rest or carving, and the simulated run of a sledge on two skis.

The room can be called: `skisnow.simulate(turn)` is `skisnow.simulate.simulated_run.simulate`.
"""

from __future__ import annotations

from ..callable_rooms import make_callable
from .carve import Equilibrium, carve, rest
from .run import Run
from .scenario import Scenario, read_scenario, scenario_names

__all__ = ["Equilibrium", "Run", "Scenario", "carve", "read_scenario", "rest", "scenario_names"]

make_callable(__name__, ".simulated_run", "simulate")
