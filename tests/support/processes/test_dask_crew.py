"""What is done with Dask, by a stand-in for its client: counting, waiting for it, its errors."""

import threading
from concurrent.futures import Future, ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any

import pytest

from skisnow._support.errors import SkisnowError
from skisnow._support.processes import dask_cluster
from skisnow._support.processes.batch import run_batch
from skisnow._support.processes.dask_cluster import crew_of_client, crew_of_scheduler, is_plain
from tests.coded import raises


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
        monkeypatch.setattr(dask_cluster, "time", SimpleNamespace(monotonic=lambda: self.now))


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    return Clock(monkeypatch)


def test_workers_are_counted_once_a_second(clock: Clock) -> None:
    client = Client()
    crew = crew_of_client(client, dict)
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
    crew = crew_of_client(client, dict)
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
    crew = crew_of_client(Client(), dict)
    for error in (ImportError("x"), RuntimeError("Can't get attribute 'f'"), ValueError("error while deserializing")):
        told = crew.told(error)
        assert told is not None and told.fields == {"error": str(error)}
    assert "worker died" in str(crew.told(LostWorkerError("worker died")))
    assert crew.told(ValueError("of the function")) is None


def test_the_client_is_closed_at_the_end() -> None:
    client = Client()
    crew_of_client(client, dict, client.close).end(at_once=False)
    assert client.status == "closed"


def test_who_does_not_answer_is_reported_with_what_to_start() -> None:
    assert "tcp://h:1 (refused)" in dask_cluster._unanswered("tcp://h:1", OSError("refused"))
    assert "uses certificates" in dask_cluster._unanswered("tls://h:1", OSError("refused"))
    assert [is_plain(f"{kind}://h:1") for kind in ("tcp", "tls", "wss", "ws")] == [True, False, False, True]


def test_a_scheduler_that_dask_does_not_reach_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    class Distributed:
        @staticmethod
        def Client(address: str, *, timeout: float, **_: Any) -> None:
            raise OSError(f"{address} refused for {timeout:g} s")

    monkeypatch.setattr(dask_cluster, "_distributed", lambda: Distributed)
    with raises(SkisnowError, "no_scheduler", address="tcp://h:1"):
        crew_of_scheduler("tcp://h:1", dict)
