"""The batch runner: the same rows whatever the workers and interruptions."""

import itertools
import os
import signal
from functools import partial
from multiprocessing import Pipe
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.processes.batch import run_batch
from skisnow._support.processes.crews import begin_worker
from skisnow._support.processes.kept_rows import KeptRows
from tests.coded import raises

POINTS = [[("n", n), ("third", n / 3.0), ("text", 'a "quoted", ü\nline')] for n in range(25)]
ROWS = [dict(point) for point in POINTS]
"""`dict` makes a row of a point: a function that every worker can import."""


class Stopping:
    """Answers some points, then is interrupted."""

    def __init__(self, after: int) -> None:
        self.left = after

    def __call__(self, point: Any) -> dict[str, Any]:
        if self.left == 0:
            raise KeyboardInterrupt
        self.left -= 1
        return dict(point)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "rows.partial"


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_rows_are_in_the_order_of_the_points(workers: int) -> None:
    assert run_batch(POINTS, dict, workers=workers) == ROWS


def own_process(_point: Any) -> dict[str, Any]:
    return {"process": os.getpid()}


@pytest.mark.parametrize(("workers", "points", "own"), [(1, 4, True), (2, 1, True), (2, 4, False)])
def test_other_processes_are_started_for_several_points_alone(workers: int, points: int, own: bool) -> None:
    rows = run_batch(POINTS[:points], partial(own_process), workers=workers)
    assert {row["process"] == os.getpid() for row in rows} == {own}


def test_a_worker_leaves_an_interrupt_to_its_parent() -> None:
    before = signal.getsignal(signal.SIGINT)
    parent, child = Pipe()
    try:
        begin_worker(child)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        parent.send("the thread ends, and not the process")
        signal.signal(signal.SIGINT, before)


def test_nothing_to_do_is_done() -> None:
    assert run_batch([], dict) == []


def test_progress_counts_up_to_all() -> None:
    told: list[tuple[int, int]] = []
    run_batch(POINTS, dict, workers=2, progress=lambda done, total: told.append((done, total)))
    assert told[0] == (0, 25)
    assert told[-1] == (25, 25)
    assert all(a[0] < b[0] for a, b in itertools.pairwise(told))


def test_finished_points_are_kept_over_an_interruption(place: Path) -> None:
    kept = KeptRows.opened(place, "f")
    with pytest.raises(KeyboardInterrupt):
        run_batch(POINTS, Stopping(7), kept=kept, workers=1)
    kept.close()
    again = KeptRows.opened(place, "f")
    assert dict(again.rows()) == dict(enumerate(ROWS[:7]))
    rest = Stopping(len(POINTS) - 7)  # one point more would interrupt again
    assert run_batch(POINTS, rest, kept=again, workers=1) == ROWS
    again.remove()
    assert not place.exists()


def test_error_of_the_function_ends_the_batch_and_keeps_what_was_done(place: Path) -> None:
    """A number is not a list of pairs: `dict` raises for the last point."""
    kept = KeptRows.opened(place, "f")
    with pytest.raises(TypeError):
        run_batch([*POINTS, 5], dict, kept=kept, workers=2)
    assert set(kept.numbers()) <= set(range(25))
    kept.close()


def test_no_worker_is_refused() -> None:
    with raises(ParameterError, "too_few_workers", workers=0):
        run_batch(POINTS, dict, workers=0)
