"""A correction that was applied while a campaign was read."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AppliedCorrection:
    """A cell that was read otherwise than the raw file has it; ``row`` is the line of that file."""

    file: str
    experiment: str
    row: int
    column: str
    old: str
    new: str
    who: str
    when: str
    why: str
