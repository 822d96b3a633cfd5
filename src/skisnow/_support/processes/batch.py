"""Many points, one function, all cores: parallel, resumable, and the same rows whatever the number of workers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from ..messages import Message
from .chunk import PointFunction
from .executors import ExecutorLike
from .kept_rows import KeptRows, Row
from .pool import Pool, workers_in_force

Progress: TypeAlias = Callable[[int, int], None]
"""Takes the number of finished points and that of all."""


def run_batch(
    points: Sequence[Any],
    function: PointFunction,
    *,
    kept: KeptRows | None = None,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Rows of all points, in their order.

    Parameters
    ----------
    points
        Inputs of the function; with several workers they are pickled.
    function
        From a point to a row of JSON values. With several workers it is pickled once for each of them: a function of a
        module, or an instance of a class of a module. An error that it raises ends the batch; a function whose points
        may fail one by one turns its errors into rows.
    kept
        Rows that are finished already, and where to keep new ones; None: nowhere.
    workers
        Number of processes; None: as many as this process has cores; 1: this process itself.
    executor
        Executor instead of processes of this computer: "threads"; any `concurrent.futures.Executor`, which is not
        shut down; a Dask client, the address of a Dask scheduler, or a TOML file of one. The rows do not depend on it.
    progress
        Called with the number of finished points and that of all.

    Returns
    -------
    list of dict
        One row for each point.

    Raises
    ------
    ParameterError
        The number of workers is below 1, or the executor is not valid.
    SkisnowError
        A worker ended unexpectedly, or has another skisnow; what was finished is kept.

    See Also
    --------
    skisnow.study : points from a file.

    Notes
    -----
    Workers are started afresh ("spawn"), on every system alike. A script that calls this with several workers needs
    the usual ``if __name__ == "__main__":``.

    References
    ----------
    The page docs/how-to/cluster.md.
    """
    kept = kept if kept is not None else KeptRows()
    compute_missing(points, function, kept, workers=workers, executor=executor, progress=progress)
    return [row for number, row in kept.rows() if number < len(points)]


def compute_missing(
    points: Sequence[Any],
    function: PointFunction,
    kept: KeptRows,
    *,
    numbers: range | None = None,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> None:
    """Compute the rows of points that are not kept yet, and keep them; memory does not grow with their number.

    Parameters
    ----------
    points, function, kept, workers, executor, progress
        As of `run_batch`.
    numbers
        Requested points; None: all.

    Raises
    ------
    ParameterError, SkisnowError
        As of `run_batch`.
    """
    wanted = workers_in_force(workers)
    numbers = range(len(points)) if numbers is None else numbers
    finished = bytearray(len(points))
    for number in kept.numbers():
        if 0 <= number < len(finished):
            finished[number] = True
    done = sum(finished[numbers.start : numbers.stop : numbers.step])
    missing = len(numbers) - done
    tell = progress or _silent
    tell(done, len(numbers))
    advice = Message("Finished points are kept. Start again, with fewer workers.")
    with Pool(function, max(1, min(wanted, missing)), advice=advice, executor=executor) as pool:
        for rows in pool.rows(((number, points[number]) for number in numbers if not finished[number]), missing):
            done += kept.add(rows)
            tell(done, len(numbers))


def _silent(_done: int, _total: int) -> None:
    return
