"""A flexible ski at rest in snow, or carving steadily: the question, the equilibrium, the answer."""

from __future__ import annotations

from .equilibrium import rest
from .result import Equilibrium

__all__ = ["Equilibrium", "rest"]
