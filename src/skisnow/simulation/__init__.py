"""The simulated run of a sledge on two skis: from a scenario to its results and their accuracy."""

from __future__ import annotations

from .run import Run

__all__ = ["Run"]
