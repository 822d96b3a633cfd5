"""How long a study will take, from the studies and runs that the lab has made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from .run_estimate import AROUND_S, LOOKED_AT, duration_words, simulated_s, slowness
from .study_asked import CARVE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from .runs import Job
    from .studies import Studies, StudyJob

CARVE_S: Final = 0.03
"""Of a carved turn where no study has told it yet (modelling assumption: a laptop of 2025)."""


def unit_s(of: str, values: Mapping[str, Any]) -> float:
    """How long a point takes at slowness 1 (s): one carved turn, or the time that a run simulates; 0: unknown.

    Parameters
    ----------
    of
        `CARVE` or a scenario.
    values
        Of the scenario, by key.
    """
    return CARVE_S if of == CARVE else simulated_s(values) or 0.0


def estimate_words(studies: Studies, runs: Path, jobs: list[Job], *, points: int, method: str, unit: float) -> str:
    """How many points there are and about how long they take, in words.

    Parameters
    ----------
    studies
        What the lab has studied, and who computes.
    runs, jobs
        What the lab has simulated.
    points
        How many.
    method
        Of the solver; nothing for a carved turn.
    unit
        See `unit_s`.
    """
    if not unit:
        return f"{points} points."
    found = learned(studies.study_jobs(), method)
    if found is None:
        found = slowness(runs, jobs, method) if method else 1.0
    seconds = points * unit * found
    if studies.elsewhere:
        took = duration_words(seconds)
        return f"{points} points, about {took} of one core, shared by the workers of {studies.elsewhere}."
    return f"{points} points. Will take about {duration_words(seconds / studies.workers + AROUND_S)}."


def learned(jobs: Sequence[StudyJob], method: str) -> float | None:
    """Computing time over that of slowness 1, of the last studies of this kind; None where there is none."""
    alike = [job for job in jobs if job.state == "done" and job.method == method and job.workers and job.unit_s]
    told = [job for job in alike if job.took_s > AROUND_S][:LOOKED_AT]
    work = sum(job.points * job.unit_s for job in told)
    return sum((job.took_s - AROUND_S) * job.workers for job in told) / work if work else None
