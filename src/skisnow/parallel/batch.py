"""Many points, one function, all cores: parallel, resumable, and the same rows whatever the number of workers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from .kept_rows import KeptRows, Row
from .pool import PointFunction, Pool, workers_in_force

Progress: TypeAlias = Callable[[int, int], None]
"""Takes the number of finished points and that of all."""


def run_batch(
    points: Sequence[Any],
    function: PointFunction,
    *,
    kept: KeptRows | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Rows of all points, in their order.

    Parameters
    ----------
    points
        What the function takes; with several workers they are pickled.
    function
        From a point to a row of JSON values. With several workers it is pickled once for each of them: a function of a
        module, or an instance of a class of a module. An error that it raises ends the batch; a function whose points
        may fail one by one turns its errors into rows.
    kept
        Rows that are finished already, and where to keep new ones; None: nowhere.
    workers
        Number of processes; None: as many as this process has cores; 1: this process itself.
    progress
        Called with the number of finished points and that of all.

    Returns
    -------
    list of dict
        One row for each point.

    Raises
    ------
    ParameterError
        The number of workers is below 1.
    SkisnowError
        A worker ended unexpectedly; what was finished is kept.

    See Also
    --------
    skisnow.study : points from a file.

    Notes
    -----
    Workers are started afresh ("spawn"), on every system alike. A script that calls this with several workers needs
    the usual ``if __name__ == "__main__":``.

    References
    ----------
    The page docs/how-to/study.md.
    """
    kept = kept if kept is not None else KeptRows()
    wanted = workers_in_force(workers)
    missing = [(number, point) for number, point in enumerate(points) if number not in kept.rows]

    def tell() -> None:
        if progress is not None:
            progress(len(kept.rows), len(points))

    tell()
    advice = "finished points are kept. Start again, with fewer workers"
    with Pool(function, max(1, min(wanted, len(missing))), advice=advice) as pool:
        for done in pool.rows(missing):
            kept.add(done)
            tell()
    return [kept.rows[number] for number in range(len(points))]
