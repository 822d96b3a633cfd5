"""Score of a run through a course: its time, or the distance by which it misses gates."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from .._support.units import ShownFields
from ..track.course import CourseResult, Passage

NOT_PASSED: Final = 1000.0
"""Value that a gate that is not passed adds, so that any way that passes more gates is better (it moves no time)."""
FARTHEST: Final = 100.0
"""Distance (m) beyond which a failure is as bad as at it."""
ABREAST: Final = 0.45
"""Distance (m) between the outer sides of a racer, by which a pole beyond both was missed by more than clearance says
(modelling assumption; moves no time)."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Score(ShownFields):
    """Score of a line.

    value: Value to minimise: the time (s) if all gates are passed; else above 1000, and larger with the number of
        missed gates, the distances from them, and the distance of the end from the last gate.
    time: Time from the start to the last gate (s); None for a failed race.
    passed: Number of passed gates.
    words: How the race ended.
    gates: Result at each gate, and the time from the start (s), None for a gate that was not crossed.
    margins: Margin at each gate: distance from the nearest pole (m); below 0 if the gate was not passed. None where it
        was not crossed.
    """

    value: float
    time: float | None
    passed: int
    words: str
    gates: tuple[tuple[str, float | None], ...] = ()
    margins: tuple[float | None, ...] = ()


def score_of(result: CourseResult | None, end: tuple[float, float], *, finished: bool, words: str) -> Score:
    """Score of a run from the passage of its gates.

    result: passages of the gates; None for a run with fewer than two places.
    end: x, y (m) of the end of the run.
    finished: False for a run that ended early, such as by a fall.
    words: how the run ended.
    """
    if result is None:
        return Score(value=float("inf"), time=None, passed=0, words=words)
    times = [None if passage.time is None else passage.time - result.start_time for passage in result.passages]
    gates = tuple((passage.outcome, time) for passage, time in zip(result.passages, times, strict=True))
    margins = tuple(_margin_of_passage(passage) for passage in result.passages)
    last = times[-1]
    if finished and result.fault is None and last is not None:
        return Score(value=last, time=last, passed=result.passed, words=words, gates=gates, margins=margins)
    beside = sum(
        min(max(-passage.clearance, 0.0), FARTHEST)
        for passage in result.passages
        if passage.outcome != "passed" and passage.clearance is not None
    )
    left = max(0.0, result.course.gates[-1].turning[0] - end[0])
    missed = max(1, len(result.passages) - result.passed)
    fault = words if result.fault is None or not finished else result.fault.words
    value = NOT_PASSED * missed + beside + min(left, FARTHEST)
    return Score(value=value, time=None, passed=result.passed, words=fault, gates=gates, margins=margins)


def with_room(score: Score, room: float) -> Score:
    """Score if each gate must be passed with `room` (m) to spare: margins are smaller by it, and gates may fail."""
    if room == 0.0:
        return score
    margins = tuple(
        margin if margin is None or i >= len(score.gates) else margin - room for i, margin in enumerate(score.margins)
    )
    narrow = [i for i, margin in enumerate(margins) if margin is not None and margin <= 0.0]
    if score.time is None or not narrow:
        return replace(score, margins=margins)
    words = f"the skis passed the pole of gate {narrow[0] + 1} by less than {room:g} m"
    lacking = -sum(margins[i] or 0.0 for i in narrow)
    value = NOT_PASSED * len(narrow) + lacking
    return replace(score, value=value, time=None, passed=score.passed - len(narrow), words=words, margins=margins)


def _margin_of_passage(passage: Passage) -> float | None:
    """Clearance of a gate's pole (m), less a fixed width if the gate was missed; None if it is unknown."""
    if passage.clearance is None:
        return None
    return passage.clearance - (ABREAST if passage.outcome == "missed" else 0.0)
