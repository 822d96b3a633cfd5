"""Rules of the International Ski Federation that a course can be checked against."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from .course import Course, Discipline


@dataclass(frozen=True, slots=True, kw_only=True)
class Rules:
    """Limits of one discipline.

    Attributes
    ----------
    article
        Article of the International Ski Competition Rules (ICR), book IV.
    width
        Minimum and maximum width of a gate (m).
    least_distance
        Minimum distance between the nearest poles of successive gates (m).
    turns_per_drop
        Minimum and maximum number of changes of direction per metre of drop.
    """

    article: str
    width: tuple[float, float]
    least_distance: float
    turns_per_drop: tuple[float, float]


RULES: Final[dict[Discipline, Rules | None]] = {
    "giant-slalom": Rules(article="FIS ICR 901.2", width=(4.0, 8.0), least_distance=10.0, turns_per_drop=(0.11, 0.15)),
    "slalom": None,
}
"""Rules by discipline; None: nothing is checked, because no citable text was available."""


def course_warnings(course: Course, *, drop: float | None = None) -> tuple[str, ...]:
    """Sentences on departures of a course from the rules of its discipline, which are allowed for training.

    Parameters
    ----------
    course
        Course with its discipline.
    drop
        Difference in height from the first gate to the last (m); None if unknown.

    Notes
    -----
    Giant slalom: gates 4 to 8 m wide, 10 m or more between the nearest poles of successive gates (ICR 901.2.3), and
    changes of direction for 11 to 15 % of the metres of drop (901.2.4; of the whole course, start to finish).
    """
    rules = None if course.discipline is None else RULES[course.discipline]
    return () if rules is None else tuple(_departures(course, rules, drop))


def _departures(course: Course, rules: Rules, drop: float | None) -> Iterator[str]:
    low, high = rules.width
    for gate in course.gates:
        if gate.outer is not None and not low <= gate.width <= high:
            yield f"gate {gate.name} is {gate.width:.2f} m wide; {rules.article} asks for {low:g} to {high:g} m"
    for before, gate in zip(course.gates, course.gates[1:], strict=False):
        poles = [np.array([pole for pole in (one.turning, one.outer) if pole is not None]) for one in (before, gate)]
        apart = float(np.linalg.norm(poles[0][:, None] - poles[1][None], axis=2).min())
        if apart < rules.least_distance:
            yield (
                f"gates {before.name} and {gate.name} are {apart:.2f} m apart; {rules.article} asks for "
                f"{rules.least_distance:g} m or more between their nearest poles"
            )
    if drop is not None and drop > 0.0:
        least, most = (round(share * drop) for share in rules.turns_per_drop)
        turns = sum(one.side != other.side for one, other in zip(course.gates, course.gates[1:], strict=False))
        if not least <= turns <= most:
            yield (
                f"the course changes its direction {turns} times over {drop:.0f} m of drop; {rules.article} asks for "
                f"{least} to {most}"
            )
