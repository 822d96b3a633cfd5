"""An executor as users name it: a word, an object, or the scheduler of a cluster."""

from __future__ import annotations

from concurrent.futures import Executor
from pathlib import Path
from typing import Any, Final, TypeAlias

from ..errors import ParameterError
from .chunk import PointFunction
from .crews import Crew, GivenCrew, ProcessCrew, ThreadCrew

ExecutorLike: TypeAlias = Executor | str | Path | Any
"""Executor: "processes" or "threads" of this computer; any `concurrent.futures.Executor`; a Dask client; the
address of a Dask scheduler, or a TOML file that says where one is or which batch system is to start one."""

LOCAL: Final = ("processes", "threads")


def crew_of(executor: ExecutorLike, function: PointFunction, workers: int) -> Crew:
    """Executor of the chunks.

    Parameters
    ----------
    executor
        In any of its forms.
    function
        From a point to a row.
    workers
        Number of workers of this computer, or of an executor that does not report its number.

    Raises
    ------
    ParameterError
        It is nothing of these, its file cannot be read, or Dask is not installed.
    SkisnowError
        The scheduler does not answer.
    """
    if isinstance(executor, Executor):
        return GivenCrew(function, executor, lambda: _workers_of(executor) or workers)
    if executor == "processes":
        return ProcessCrew(function, workers)
    if executor == "threads":
        return ThreadCrew(function, workers)
    from .dask_cluster import crew_of_client, crew_of_scheduler

    if isinstance(executor, str | Path):
        return crew_of_scheduler(executor, function)
    if hasattr(executor, "get_executor"):
        return crew_of_client(executor, function)
    raise ParameterError(
        "executor is {executor!r}; it must be one of {names}, a concurrent.futures.Executor, a Dask client, the "
        "address of a Dask scheduler or a TOML file of one",
        code="unknown_executor",
        executor=executor,
        names=list(LOCAL),
    )


def require_executor(executor: ExecutorLike | None) -> None:
    """Refuse a scheduler that nothing can come of, before the work begins.

    Raises
    ------
    ParameterError
        Dask is not installed, its address or its file cannot be read.
    """
    if executor is None or executor in LOCAL or not isinstance(executor, str | Path):
        return
    from .dask_cluster import require_scheduler

    require_scheduler(executor)


def _workers_of(executor: Executor) -> int | None:
    """Names of the number of workers: those of the standard library, MPI's of mpi4py."""
    names = ("_max_workers", "num_workers")
    workers = next((getattr(executor, name) for name in names if hasattr(executor, name)), None)
    return workers if isinstance(workers, int) and workers > 0 else None
