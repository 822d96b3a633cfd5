"""Simulated runs for a search: several processes that stay, and every finished run kept, also for the next start."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import TracebackType
from typing import Self

from .._support.processes.executors import ExecutorLike
from .._support.processes.kept_rows import KeptRows, Row
from .._support.processes.pool import Pool, workers_in_force
from .run_simulation import RunSimulation, RunTask


@dataclass(slots=True)
class Simulations:
    """Runs tasks, all at once, each only once.

    Attributes
    ----------
    simulate
        What does one.
    kept
        Rows that are finished, and where new ones are kept.
    workers
        Number of processes; None: as many as this process has cores; 1: this process itself.
    progress
        Called with the number of runs computed so far.
    executor
        What computes; None: processes of this computer.
    computed, found
        How many were computed here, and how many were finished before.
    """

    simulate: RunSimulation
    kept: KeptRows = field(default_factory=KeptRows)
    workers: int | None = None
    progress: Callable[[int], None] = field(default=lambda _: None)
    executor: ExecutorLike | None = None
    computed: int = 0
    found: int = 0
    _pool: Pool = field(init=False)
    _before: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        advice = "finished runs are kept. Start again with --resume, with fewer workers"
        self._pool = Pool(self.simulate, workers_in_force(self.workers), advice=advice, executor=self.executor)
        self._before = frozenset(self.kept.numbers())

    def __call__(self, tasks: Sequence[RunTask]) -> list[Row]:
        """Rows of all tasks, in their order.

        Raises
        ------
        SkisnowError
            A process ended unexpectedly; what was finished is kept.
        """
        numbers = [task_number(task) for task in tasks]
        missing = {number: task for number, task in zip(numbers, tasks, strict=True) if number not in self.kept}
        self.found += sum(number in self._before for number in dict.fromkeys(numbers))
        for rows in self._pool.rows(list(missing.items())):
            self.computed += self.kept.add(rows)
            self.progress(self.computed)
        return [self.kept.row(number) for number in numbers]

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the processes."""
        self._pool.__exit__(kind, error, trace)
        self.kept.close()


def task_number(task: RunTask) -> int:
    """The same number for the same task, at every start.

    >>> task_number(RunTask({"friction.mu_0": 0.05}, 0, False))
    851841852695433548
    """
    text = json.dumps([sorted(task.values.items()), task.run, task.final])
    return int(hashlib.sha256(text.encode()).hexdigest()[:15], 16)
