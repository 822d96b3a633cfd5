"""Comparison of two tracks: distances by nearest place, at equal arc length and at equal time."""

from __future__ import annotations

from .compare import compare_tracks
from .result import Comparison, Distances, FittedOffsets, comparison_dict

__all__ = ["Comparison", "Distances", "FittedOffsets", "compare_tracks", "comparison_dict"]
