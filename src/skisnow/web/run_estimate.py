"""How long a simulation will take, from the runs that the lab has made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from ..given import GivenError, read_json

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from .runs import Job

SLOWNESS: Final = 1.0
"""Computing time over simulated time where no run has told it yet (modelling assumption: a laptop of 2025)."""
AROUND_S: Final = 8.0
"""Start, files and report of a run, where none has told it yet (modelling assumption)."""
LOOKED_AT: Final = 5


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
    simulated = _simulated_s(values)
    if simulated is None:
        return None
    told = [found for job in jobs if (found := _told(folder, job)) is not None][:LOOKED_AT]
    alike = [each for each in told if each.method == values.get("solver.method")]
    slowness = sum(each.wall for each in alike) / sum(each.simulated for each in alike) if alike else SLOWNESS
    around = sum(each.took - each.wall for each in told) / len(told) if told else AROUND_S
    return slowness * simulated + around


def _simulated_s(values: Mapping[str, Any]) -> float | None:
    """How long the run goes on (s): its duration, or its length at the speed of the start, the shorter one."""
    duration, length, speed = (values.get(key) for key in ("run.duration_s", "run.length_m", "start.speed_m_per_s"))
    ends = [float(duration)] if duration else []
    if length and speed:
        ends.append(float(length) / float(speed))
    return min(ends, default=None)


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
