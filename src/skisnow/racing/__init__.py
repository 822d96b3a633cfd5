"""Races: the quickest line through a course, and the time that changes of ski and snow cost on it."""

from __future__ import annotations

from .line import LineTurn, RacingLine, follower_line, read_line, write_line
from .point import PointRacer
from .quickest import QuickestLine, quickest_line
from .score import Score
from .worth import Worth, compare_variants, drawn_for_race, worth_changes

__all__ = [
    "LineTurn", "PointRacer", "QuickestLine", "RacingLine", "Score", "Worth", "compare_variants", "drawn_for_race",
    "follower_line", "quickest_line", "read_line", "worth_changes", "write_line",
]  # fmt: skip
