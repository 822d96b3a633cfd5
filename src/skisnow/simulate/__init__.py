"""The simulated run of a sledge on two skis: what comes out of a scenario, and how exact it is.

The package can be called: `skisnow.simulate(turn)` is `skisnow.simulate.simulated_run.simulate`.
"""

from __future__ import annotations

from ..callable_packages import make_callable
from .run import Run

__all__ = ["Run"]

make_callable(__name__, ".simulated_run", "simulate")
