"""Pools of processes and batches."""

import itertools
import os
import signal
import time
from concurrent.futures import Future
from multiprocessing import Pipe
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from skisnow._support.errors import ParameterError, SkisnowError
from skisnow._support.messages import Message
from skisnow._support.processes.batch import (
    LARGEST_FOR_A_PIPE,
    Pool,
    _compute_in_worker,
    begin_worker,
    compute_rows,
    process_crew,
    run_batch,
    worker_count,
)
from skisnow._support.processes.kept_rows import KeptRows, NumberedText
from tests.coded import raises


def own_process(_point: Any) -> dict[str, Any]:
    return {"process": os.getpid()}


def waiting(seconds: float) -> dict[str, Any]:
    time.sleep(seconds)
    return {}


def killed(_point: Any) -> dict[str, Any]:
    os.kill(os.getpid(), signal.SIGTERM)
    return {}


def texts(rows: list[list[NumberedText]]) -> set[str]:
    return {text for chunk in rows for _, text in chunk}


def test_processes_stay_from_one_call_to_the_next() -> None:
    with Pool(own_process, 2, advice="") as pool:
        seen = [texts(list(pool.rows([(n, None) for n in range(4)]))) for _ in range(3)]
    others = set().union(*seen)
    assert 1 <= len(others) <= 2
    assert f'{{"process":{os.getpid()}}}' not in others


def test_what_still_runs_is_ended_with_the_pool() -> None:
    """A point would take a minute; another is taken, and the rest is left."""
    begun = time.monotonic()
    with Pool(waiting, 2, advice="") as pool:
        assert next(iter(pool.rows([(0, 0.0), (1, 60.0), (2, 60.0)]))) == [(0, "{}")]
    assert time.monotonic() - begun < 40.0


def test_a_process_that_is_killed_is_reported_with_advice() -> None:
    with (
        raises(SkisnowError, "pool_failed", advice="Take fewer."),
        Pool(killed, 2, advice=Message("Take fewer.")) as pool,
    ):
        list(pool.rows([(0, None), (1, None)]))


def test_workers_are_at_least_one_and_as_many_as_cores_where_left_out() -> None:
    assert worker_count(3) == 3
    assert 1 <= worker_count(None) <= (os.cpu_count() or 1)
    with raises(ParameterError, "too_few_workers", workers=0):
        worker_count(0)


@pytest.mark.parametrize(("counted", "cores"), [(6, 6), (None, 1)])
def test_cores_of_a_system_without_affinity(counted: int | None, cores: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: counted)
    assert worker_count(None) == cores


def test_quick_points_are_handed_over_many_at_a_time() -> None:
    """One by one until it is known how long they take, then in chunks that all fit through a pipe."""
    with Pool(own_process, 2, advice="") as pool:
        chunks = [len(chunk) for chunk in pool.rows([(n, None) for n in range(1000)])]
    assert sum(chunks) == 1000
    assert chunks[0] == 1
    assert 10 < max(chunks) <= LARGEST_FOR_A_PIPE
    assert len(chunks) < 500


def test_only_a_pool_starts_a_worker() -> None:
    with raises(SkisnowError, "no_pool"):
        _compute_in_worker([(0, None)])


@pytest.mark.parametrize(("points", "each"), [([2.0], 2.0), ([1.0, 3.0], 2.0), ([], 0.0)])
def test_a_chunk_reports_time_per_point(points: list[float], each: float, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]

    def lasting(seconds: float) -> dict[str, Any]:
        clock[0] += seconds
        return {}

    monkeypatch.setattr("skisnow._support.processes.batch.time.perf_counter", lambda: clock[0])
    assert compute_rows(lasting, list(enumerate(points))).seconds_per_point == each


@pytest.mark.parametrize(
    ("error", "finished", "at_once"), [(None, True, False), (None, False, True), (KeyboardInterrupt, True, True)]
)
def test_workers_end_at_once_after_an_error(error: type[BaseException] | None, finished: bool, at_once: bool) -> None:
    pool, said, future = Pool(dict, 2, advice=""), list[bool](), Future[Any]()
    if finished:
        future.set_result(None)

    class Ends:
        def close(self, at_once: bool) -> None:
            said.append(at_once)

    pool._crew, pool._running = cast("Any", Ends()), {future}
    pool.__exit__(error, None, None)
    assert said == [at_once]
    assert future.cancelled() is not finished


@pytest.mark.parametrize(("at_once", "order"), [(True, ["let go", "shut down"]), (False, ["shut down", "let go"])])
def test_processes_are_let_go_before_or_behind_their_last_point(
    at_once: bool, order: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process whose leash is closed ends; what waits is taken back."""
    done: list[str] = []

    def shut_down(*, wait: bool, cancel_futures: bool) -> None:
        assert wait
        assert cancel_futures
        done.append("shut down")

    leash = SimpleNamespace(close=lambda: done.append("let go"))
    context = SimpleNamespace(Pipe=lambda **_: (None, leash))
    monkeypatch.setattr("skisnow._support.processes.batch.worker_context", lambda: context)
    executor = SimpleNamespace(shutdown=shut_down)
    monkeypatch.setattr("skisnow._support.processes.batch.ProcessPoolExecutor", lambda *_, **_options: executor)
    process_crew(dict, 2).close(at_once)
    assert done[:2] == order


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


def with_process(point: Any) -> dict[str, Any]:
    return dict(point) | own_process(point)


@pytest.mark.parametrize("workers", [1, 2])
def test_rows_are_in_the_order_of_the_points_and_progress_counts_up_to_all(workers: int) -> None:
    """Several points are computed in other processes if there are several workers."""
    told: list[tuple[int, int]] = []
    rows = run_batch(POINTS, with_process, workers=workers, progress=lambda done, total: told.append((done, total)))
    assert {row.pop("process") == os.getpid() for row in rows} == {workers == 1}
    assert rows == ROWS
    assert told[0] == (0, 25)
    assert told[-1] == (25, 25)
    assert all(a[0] < b[0] for a, b in itertools.pairwise(told))


def test_one_point_is_computed_in_this_process() -> None:
    assert run_batch(POINTS[:1], own_process, workers=2) == [own_process(None)]


def test_a_worker_leaves_an_interrupt_to_its_parent() -> None:
    before = signal.getsignal(signal.SIGINT)
    parent, child = Pipe()
    try:
        begin_worker(child)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        parent.send("the thread ends, and not the process")
        signal.signal(signal.SIGINT, before)


def test_an_empty_batch_ends_at_once() -> None:
    assert run_batch([], dict) == []


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


def test_no_worker_is_rejected() -> None:
    with raises(ParameterError, "too_few_workers", workers=0):
        run_batch(POINTS, dict, workers=0)
