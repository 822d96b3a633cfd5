"""How long a simulation will take, from the runs that the lab has made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from .._support.user_files import GivenError, read_json

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from .runs import Job

SLOWNESS: Final = 1.0
"""Computing time over simulated time where no run has told it yet (modelling assumption: a laptop of 2025)."""
AROUND_S: Final = 8.0
"""Start, files and report of a run, where none has told it yet (modelling assumption)."""
LOOKED_AT: Final = 5
_NEVER_S: Final = 1e9
"""Thirty years: whatever is typed of such an end, no time is told for it."""


def estimated_s(folder: Path, jobs: list[Job], values: Mapping[str, Any]) -> float | None:
    """How long a run takes (s); None where its end does not say how far it goes.

    Parameters
    ----------
    folder
        Where the runs are.
    jobs
        The newest first.
    values
        Of the scenario, by key.
    """
    simulated = simulated_s(values)
    if simulated is None:
        return None
    told = _last(folder, jobs)
    around = sum(each.took - each.wall for each in told) / len(told) if told else AROUND_S
    return slowness(folder, jobs, values.get("solver.method")) * simulated + around


def slowness(folder: Path, jobs: list[Job], method: object) -> float:
    """Computing time over simulated time of the last runs with this method."""
    alike = [each for each in _last(folder, jobs) if each.method == method]
    return sum(each.wall for each in alike) / sum(each.simulated for each in alike) if alike else SLOWNESS


def duration_words(seconds: float) -> str:
    """In words, as exact as it is known.

    >>> duration_words(42.0), duration_words(600.0), duration_words(20_000.0)
    ('40 s', '10 min', '6 h')
    """
    if seconds < 90.0:
        return f"{max(5, 5 * round(seconds / 5))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{round(minutes / 60)} h"


def _last(folder: Path, jobs: list[Job]) -> list[_Told]:
    return [found for job in jobs if (found := _told(folder, job)) is not None][:LOOKED_AT]


def simulated_s(values: Mapping[str, Any]) -> float | None:
    """How long the run goes on (s): its duration, or its length at the speed of the start, the shorter one."""
    duration, length, speed = (values.get(key) for key in ("run.duration_s", "run.length_m", "start.speed_m_per_s"))
    ends = [float(duration)] if duration else []
    if length and speed:
        ends.append(float(length) / float(speed))
    return min((end for end in ends if 0.0 < end < _NEVER_S), default=None)  # what is typed may be "inf" or "nan"


class _Told(NamedTuple):
    """A finished run: how long its process took, how long of that was computing, how much was simulated (s)."""

    took: float
    wall: float
    simulated: float
    method: str


def _told(folder: Path, job: Job) -> _Told | None:
    if not job.took_s:
        return None
    try:
        summary = read_json(folder / job.name / "summary.json")
        method = str(summary["scenario"]["solver"]["method"])
        return _Told(job.took_s, float(summary["wall_s"]), float(summary["simulated_s"]), method)
    except (GivenError, KeyError, TypeError, ValueError):
        return None
