"""Whoever computes, the rows are the same."""

import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from typing import Any

import pytest

from skisnow._support.errors import ParameterError, SkisnowError
from skisnow._support.processes.batch import Pool, run_batch
from skisnow._support.processes.kept_rows import KeptRows, json_text
from skisnow.identification import identify
from tests.coded import raises
from tests.identification.straight_tracks import SCENARIO, track

POINTS = [[("n", n), ("third", n / 3.0)] for n in range(40)]
ROWS = [dict(point) for point in POINTS]


class Here(Executor):
    """Computes at once, in the order in which it is asked; records how many chunks there were."""

    num_workers = 3

    def __init__(self) -> None:
        self.chunks = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.chunks += 1
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@pytest.mark.parametrize("executor", ["threads", "processes"])
def test_threads_and_processes_give_the_same_rows(executor: str) -> None:
    assert run_batch(POINTS, dict, workers=2, executor=executor) == ROWS


def test_any_executor_gives_the_same_rows_in_few_chunks_and_is_left_open() -> None:
    executor = Here()
    many = [[("n", n)] for n in range(20_000)]
    assert run_batch(many, dict, executor=executor) == [{"n": n} for n in range(20_000)]
    assert executor.chunks < 400  # never a future for each point
    with ThreadPoolExecutor(2) as threads:
        assert run_batch(POINTS, dict, executor=threads) == ROWS
        assert threads.submit(len, "open").result() == 4


def test_what_is_finished_is_not_handed_out_again() -> None:
    """Nor chunks without a point, when some were finished before."""
    kept, executor = KeptRows(), Here()
    kept.add([(number, json_text(ROWS[number])) for number in range(36)])
    assert run_batch(POINTS, dict, kept=kept, executor=executor) == ROWS
    assert 1 <= executor.chunks <= 5


@pytest.mark.slow
def test_an_identification_takes_an_executor() -> None:
    asked: dict[str, Any] = {"changes": SCENARIO}
    here = identify("carved-46m", track(seed=5), "mu_0,speed", workers=1, **asked)
    executor = Here()
    assert identify("carved-46m", track(seed=5), "mu_0,speed", executor=executor, **asked).values == here.values
    assert executor.chunks > 5


def test_an_empty_batch_starts_no_worker() -> None:
    executor = Here()
    assert run_batch([], dict, executor=executor) == []
    assert executor.chunks == 0


def slow(seconds: float) -> dict[str, Any]:
    time.sleep(seconds)
    return {}


def test_what_waits_is_taken_back_at_the_end() -> None:
    with ThreadPoolExecutor(1) as threads:
        with Pool(slow, 1, advice="", executor=threads) as pool:
            next(iter(pool.rows([(0, 0.0), *((n, 0.2) for n in range(1, 50))])))
        begun = time.monotonic()
    assert time.monotonic() - begun < 5.0  # of ten seconds


@pytest.mark.parametrize(
    ("error", "kind", "code"),
    [
        (BrokenExecutor("gone"), SkisnowError, "pool_failed"),
        (ZeroDivisionError("of the function"), ZeroDivisionError, None),
    ],
)
def test_errors_of_an_executor_and_of_the_function(error: Exception, kind: type[Exception], code: str | None) -> None:
    class Failing(Here):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(error)
            return future

    with pytest.raises(kind) as caught:
        run_batch(POINTS, dict, executor=Failing())
    assert getattr(caught.value, "code", None) == code


def test_futures_that_an_executor_cancels_are_reported() -> None:
    class Cancelling(Here):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with raises(SkisnowError, "pool_failed"):
        run_batch(POINTS, dict, executor=Cancelling())


@pytest.mark.parametrize("executor", [3, "host:8786", "tcp://host:8786"])
def test_an_invalid_executor_is_rejected(executor: Any) -> None:
    with raises(ParameterError, "unknown_executor", executor=executor):
        run_batch(POINTS, dict, executor=executor)
