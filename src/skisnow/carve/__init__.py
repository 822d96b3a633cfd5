"""A flexible ski at rest in snow, or carving steadily: the question, the equilibrium, the answer.

The package can be called: `skisnow.carve(ski, snow, …)` is `skisnow.carve.equilibrium.carve`.
"""

from __future__ import annotations

from ..callable_packages import make_callable
from .equilibrium import rest
from .result import Equilibrium

__all__ = ["Equilibrium", "rest"]

make_callable(__name__, ".equilibrium", "carve")
