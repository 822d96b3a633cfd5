"""How fast a turn is computed, and how far its end is off."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from skisnow._support.errors import SkisnowError
from skisnow.simulation.run import Run
from skisnow.simulation.simulated_run import simulate
from skisnow.simulation.verification import refined_solvers

from .cases import CASES, Case, Runs


@dataclass(frozen=True, slots=True)
class Speed:
    """The fastest of several equal runs.

    Attributes
    ----------
    case
        What was run.
    seconds, simulated_s
        Wall time, and what it simulated.
    steps, rejected_steps
        Of the integrator.
    end_off_m
        Distance between its end and the reference's.
    trouble
        Why there is no such run, or that it or its reference ended otherwise than asked; empty: neither.
    """

    case: Case
    seconds: float = np.nan
    simulated_s: float = np.nan
    steps: int = 0
    rejected_steps: int = 0
    end_off_m: float = np.nan
    trouble: str = ""

    @property
    def times_real_time(self) -> float:
        return self.simulated_s / self.seconds

    @property
    def us_per_step(self) -> float:
        """Wall time over steps that were taken: rejected ones are paid by them (µs)."""
        return 1e6 * self.seconds / self.steps if self.steps else np.nan


@dataclass(frozen=True, slots=True)
class Finer:
    """What a finer choice of the solver costs, and how far it moves the end."""

    key: str
    times_as_long: float
    end_moves_m: float


def end_distance(one: Run, other: Run) -> float:
    """Between the last places of the boots' middle (m)."""
    return float(np.linalg.norm(one.place[-1] - other.place[-1]))


def speeds(runs: Runs, *, repeats: int, cases: Sequence[Case] = CASES) -> list[Speed]:
    """Every case in turn, A B C … A B C …, the shortest time of each; then each end against its reference."""
    found: dict[str, Speed] = {}
    for number in range(repeats):
        for case in cases:
            told(f"{case.name}, run {number + 1} of {repeats}")
            found[case.name] = _faster(found.get(case.name), _once(runs, case))
    return list(found.values())


def finer(runs: Runs, changes: Mapping[str, object]) -> Iterator[Finer]:
    """A run again, finer by two in one choice: elements, line spacing, tolerance of the steps and of the groove."""
    base = runs.of(changes)
    for key, solver in refined_solvers(base).items():
        if key != "solver.step_ms":
            told(f"finer: {key}")
            run = simulate(replace(base.scenario, solver=solver))
            yield Finer(key, run.wall_s / base.wall_s, end_distance(run, base))


def told(doing: str) -> None:
    """Say what goes on."""
    print(f"  {doing}", file=sys.stderr, flush=True)


def _once(runs: Runs, case: Case) -> Speed:
    try:
        reference, run = runs.reference(case.reference), runs.of(case.changes)
    except SkisnowError as error:
        return Speed(case, trouble=f"not run: {error}")
    ended = {run.outcome, reference.outcome} - {"finished"}
    return Speed(
        case,
        run.wall_s,
        run.simulated_s,
        run.steps,
        run.rejected_steps,
        end_distance(run, reference),
        f"run ended as {run.outcome}, reference as {reference.outcome}" if ended else "",
    )


def _faster(one: Speed | None, other: Speed) -> Speed:
    return other if one is None or other.seconds < one.seconds else one
