"""Whoever computes, the rows are the same; a stand-in for the client of Dask."""

import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from skisnow._support.errors import ParameterError, SkisnowError
from skisnow._support.processes import crews
from skisnow._support.processes.batch import Pool, require_executor, run_batch
from skisnow._support.processes.crews import LOST, DaskCrew, Identity, crew_of_scheduler, is_plain
from skisnow._support.processes.kept_rows import KeptRows, json_text
from skisnow.identification import identify
from tests.coded import Coded, coded, raises
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


def test_a_worker_with_another_skisnow_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    here = crews.own_identity()
    for other in (Identity("0.0.9", here.core), Identity(here.version, "0123456789abcdef")):
        identities = iter((other,))  # of the caller; the worker's are those that are installed here
        monkeypatch.setattr(crews, "own_identity", lambda identities=identities: next(identities, here))
        with raises(SkisnowError, "different_versions"):
            run_batch(POINTS, dict, executor=Here())


class Needy:
    """Needs files that are not there."""

    def __call__(self, point: Any) -> dict[str, Any]:
        return dict(point)

    def require_files(self) -> None:
        raise SkisnowError("the files are others here")


def test_a_worker_with_other_files_is_rejected() -> None:
    with pytest.raises(SkisnowError, match="files are others"):
        run_batch(POINTS, Needy(), executor=Here())


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


@pytest.mark.parametrize(("raised", "code"), [("no_snow", "no_snow"), (LOST, "pool_failed")])
def test_advice_is_for_what_was_lost_and_not_for_what_the_function_rejects(raised: str, code: str) -> None:
    class Refusing(Here):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_exception(SkisnowError("no snow").tag(raised))
            return future

    with raises(SkisnowError, code):
        run_batch(POINTS, dict, executor=Refusing())


def test_futures_that_a_lost_scheduler_cancels_are_reported() -> None:
    class Cancelling(Here):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with raises(SkisnowError, "pool_failed"):
        run_batch(POINTS, dict, executor=Cancelling())


def test_folder_of_the_parent_is_that_of_a_worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    executor = Here()
    monkeypatch.chdir(tmp_path)
    crew = crews.Crew(executor, crews.on_workers(dict), lambda: 1)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    crew.submit([(0, POINTS[0])]).result()
    assert Path.cwd() == tmp_path


@pytest.mark.parametrize(
    ("executor", "told"),
    [(3, coded("unknown_executor", executor=3)), ("host:8786", coded("unknown_executor", scheduler="host:8786"))],
)
def test_an_invalid_executor_is_rejected(executor: Any, told: str | Coded) -> None:
    with raises(ParameterError, told):
        run_batch(POINTS, dict, executor=executor)


def test_dask_that_is_not_installed_is_reported_before_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with raises(ParameterError, "package_missing", module="distributed", extra="dask"):
        require_executor("tcp://127.0.0.1:8786")


@pytest.mark.parametrize("executor", [None, "threads", "processes", Here()])
def test_what_is_on_this_computer_needs_no_scheduler(executor: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    searched: list[object] = []
    monkeypatch.setattr("skisnow._support.processes.batch.require_scheduler", searched.append)
    require_executor(executor)
    assert searched == []


# What is done with Dask, by a stand-in for its client: counting, waiting for it, its errors


class Client:
    """The client of a scheduler with two workers."""

    def __init__(self) -> None:
        self.status, self.threads, self.asked = "running", {"a": 3, "b": 4}, 0

    def get_executor(self, *, pure: bool) -> ThreadPoolExecutor:
        assert not pure
        return ThreadPoolExecutor(1)

    def nthreads(self, *, callback_timeout: float) -> dict[str, int]:
        assert callback_timeout > 0.0
        self.asked += 1
        if not self.threads:
            raise OSError("no answer")
        return self.threads

    def close(self) -> None:
        self.status = "closed"


class Clock:
    """Seconds since a process began."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        monkeypatch.setattr(crews, "time", SimpleNamespace(monotonic=lambda: self.now))


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    return Clock(monkeypatch)


def test_workers_are_counted_once_a_second(clock: Clock) -> None:
    client = Client()
    crew = DaskCrew(dict, client)
    clock.now += 0.1
    assert (crew.size(), crew.size(), client.asked) == (7, 7, 1)
    client.threads = {"a": 2}
    clock.now += 0.9
    assert (crew.size(), client.asked) == (7, 1)
    clock.now += 0.2
    assert (crew.size(), client.asked) == (2, 2)
    client.threads = {}
    clock.now += 1.1
    assert (crew.size(), client.asked) == (2, 3)


def test_a_scheduler_may_be_away_for_ten_seconds(clock: Clock) -> None:
    client = Client()
    crew = DaskCrew(dict, client)
    clock.now += 50.0
    crew.require_alive()
    client.status = "connecting"
    clock.now += 9.9
    crew.require_alive()
    clock.now += 0.2
    with raises(SkisnowError, "scheduler_lost"):
        crew.require_alive()
    client.status = "running"
    crew.require_alive()
    client.status = "closed"
    with raises(SkisnowError, "scheduler_lost"):
        crew.require_alive()


class LostWorkerError(Exception):
    """As Dask has one."""


LostWorkerError.__module__ = "distributed.scheduler"


def test_it_is_looked_after_while_nothing_comes_and_not_while_rows_come(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is finished is taken from a scheduler that has gone; what is not ends the work, before it is computed."""
    client, futures = Client(), list[Future[Any]]()
    client.status = "closed"
    points = [{"a": 1}, {"a": 2}]
    assert run_batch(points, dict, executor=client) == points

    class Waiting:
        def submit(self, *_: Any) -> Future[Any]:
            futures.append(Future())
            return futures[-1]

    monkeypatch.setattr(client, "get_executor", lambda **_: Waiting())
    monkeypatch.setattr("skisnow._support.processes.batch.LOOKED_AFTER_S", 0.01)

    def give_up() -> None:
        for each in futures:
            each.set_exception(TimeoutError())

    stop = threading.Timer(5.0, give_up)  # so that no process waits for ever
    stop.start()
    with raises(SkisnowError, "pool_failed"):
        run_batch(points, dict, executor=client)
    stop.cancel()
    assert not any(each.done() and not each.cancelled() for each in futures)


def test_errors_of_dask_are_reported() -> None:
    crew = DaskCrew(dict, Client())
    for error in (ImportError("x"), RuntimeError("Can't get attribute 'f'"), ValueError("error while deserializing")):
        told = crew.explain(error)
        assert told is not None and told.fields == {"error": str(error)}
    assert "worker died" in str(crew.explain(LostWorkerError("worker died")))
    assert crew.explain(ValueError("of the function")) is None


def test_the_client_is_closed_at_the_end() -> None:
    client = Client()
    DaskCrew(dict, client, client.close).end(at_once=False)
    assert client.status == "closed"


def test_who_does_not_answer_is_reported_with_what_to_start() -> None:
    assert "tcp://h:1 (refused)" in crews._no_answer_message("tcp://h:1", OSError("refused"))
    assert "uses certificates" in crews._no_answer_message("tls://h:1", OSError("refused"))
    assert [is_plain(f"{kind}://h:1") for kind in ("tcp", "tls", "wss", "ws")] == [True, False, False, True]


def test_a_scheduler_that_dask_does_not_reach_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    class Distributed:
        @staticmethod
        def Client(address: str, *, timeout: float, **_: Any) -> None:
            raise OSError(f"{address} refused for {timeout:g} s")

    monkeypatch.setattr(crews, "_distributed", lambda: Distributed)
    with raises(SkisnowError, "no_scheduler", address="tcp://h:1"):
        crew_of_scheduler("tcp://h:1", dict)
