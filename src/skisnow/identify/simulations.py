"""Simulated runs for a search: several processes that stay, and every finished run kept, also for the next start."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Self

from ..errors import SkisnowError
from ..parallel.batch import available_cores, require_workers
from ..parallel.kept_rows import KeptRows, Row, row_text
from ..parallel.worker_process import begin_worker, interrupts_ignored
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
    told
        Is told the number of runs computed so far.
    computed, found
        How many were computed here, and how many were finished before.

    Notes
    -----
    A process is started afresh ("spawn") at the first task and stays until the end: it would take long to load the
    libraries for every Jacobian. It ends with its parent, however that ends.
    """

    simulate: RunSimulation
    kept: KeptRows = field(default_factory=KeptRows)
    workers: int | None = None
    told: Callable[[int], None] = field(default=lambda _: None)
    computed: int = 0
    found: int = 0
    _pool: ProcessPoolExecutor | None = None
    _leash: Connection | None = None
    _before: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        require_workers(self.workers)
        self.workers = available_cores() if self.workers is None else self.workers
        self._before = frozenset(self.kept.rows)

    def __call__(self, tasks: Sequence[RunTask]) -> list[Row]:
        """Rows of all tasks, in their order.

        Raises
        ------
        SkisnowError
            A process ended unexpectedly; what was finished is kept.
        """
        numbers = [task_number(task) for task in tasks]
        missing = {number: task for number, task in zip(numbers, tasks, strict=True) if number not in self.kept.rows}
        self.found += sum(number in self._before for number in dict.fromkeys(numbers))
        for number, row in self._computed(missing):
            self.kept.add([(number, row_text(row))])
            self.computed += 1
            self.told(self.computed)
        return [self.kept.rows[number] for number in numbers]

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the processes at once, whatever they do."""
        if self._leash is not None:
            self._leash.close()
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
        self._pool = self._leash = None
        self.kept.close()

    def _computed(self, missing: dict[int, RunTask]) -> Iterator[tuple[int, Row]]:
        if self.workers == 1:
            for number, task in missing.items():
                yield number, self.simulate(task)
            return
        if not missing:
            return
        try:
            numbers: dict[Future[Row], int] = {}
            with interrupts_ignored():  # a process that starts inherits this: Ctrl-C is for the parent alone
                pool = self._started()
                for number, task in missing.items():
                    numbers[pool.submit(_one, task)] = number
            for future in as_completed(numbers):
                yield numbers[future], future.result()
        except BrokenProcessPool as error:
            raise SkisnowError(
                "a worker process ended unexpectedly, perhaps for want of memory; finished runs are kept. Start again "
                "with --resume, with fewer workers"
            ) from error

    def _started(self) -> ProcessPoolExecutor:
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            alive, self._leash = context.Pipe(duplex=False)
            self._pool = ProcessPoolExecutor(
                self.workers, mp_context=context, initializer=_begin, initargs=(self.simulate, alive)
            )
        return self._pool


def task_number(task: RunTask) -> int:
    """The same number for the same task, at every start.

    >>> task_number(RunTask({"friction.mu_0": 0.05}, 0, False))
    851841852695433548
    """
    text = json.dumps([sorted(task.values.items()), task.run, task.final])
    return int(hashlib.sha256(text.encode()).hexdigest()[:15], 16)


class _Worker:
    """What a worker process knows; in every other process it stays empty."""

    simulate: RunSimulation | None = None


def _begin(simulate: RunSimulation, alive: Connection) -> None:
    begin_worker(alive)
    _Worker.simulate = simulate


def _one(task: RunTask) -> Row:
    if _Worker.simulate is None:
        raise SkisnowError("a worker was not started by Simulations")
    return _Worker.simulate(task)
