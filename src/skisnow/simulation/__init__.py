"""The simulated run of a sledge on two skis: what comes out of a scenario, and how exact it is."""

from __future__ import annotations

from .run import Run

__all__ = ["Run"]
