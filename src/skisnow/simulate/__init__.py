"""Skis in snow: the equilibrium of a ski at rest or carving."""

from __future__ import annotations

from .carve import Equilibrium, carve, rest

__all__ = ["Equilibrium", "carve", "rest"]
