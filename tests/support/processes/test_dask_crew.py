"""What is done with Dask, by a stand-in for its client: counting, waiting for it, its errors, certificates."""

import threading
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from skisnow._support.errors import ParameterError, SkisnowError
from skisnow._support.processes import dask_cluster
from skisnow._support.processes.batch import run_batch
from skisnow._support.processes.dask_cluster import (
    SchedulerFile,
    batch_cluster,
    crew_of_client,
    crew_of_scheduler,
    is_plain,
    require_scheduler,
)
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
    cluster = Client()
    dask_cluster._closed(client, cluster)
    assert cluster.status == "closed"


def test_certificates_are_those_of_all_three_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    class Distributed:
        @staticmethod
        def Security(**named: Any) -> dict[str, Any]:
            return named

    monkeypatch.setattr(dask_cluster, "_distributed", lambda: Distributed)
    assert dask_cluster._security(None) is None
    assert dask_cluster._security({"ca_file": "a", "cert": "c"}) == {
        "require_encryption": True, "tls_ca_file": "a", "tls_client_cert": "c", "tls_scheduler_cert": "c",
        "tls_worker_cert": "c",
    }  # fmt: skip
    keyed = dask_cluster._security({"key": "k", "ciphers": "x"})
    assert (keyed["tls_worker_key"], keyed["tls_ciphers"], "tls_client_cert" in keyed) == ("k", "x", False)


def test_a_batch_system_is_asked_with_its_options(monkeypatch: pytest.MonkeyPatch) -> None:
    class Jobqueue:
        @staticmethod
        def SLURMCluster(**options: Any) -> dict[str, Any]:
            if "wrong" in options:
                raise TypeError("unexpected 'wrong'")
            return options

    monkeypatch.setattr(dask_cluster, "_jobqueue", lambda: Jobqueue)
    monkeypatch.setattr(dask_cluster, "_security", lambda tls: "secure" if tls else None)
    asked = SchedulerFile(system="slurm", options={"cores": 4})
    assert batch_cluster(asked) == {"cores": 4}
    encrypted = SchedulerFile(system="slurm", options={"cores": 4}, tls={"ca_file": "a"})
    assert batch_cluster(encrypted) == {"cores": 4, "security": "secure", "protocol": "tls://"}
    with raises(ParameterError, "rejected_by_dask", system="slurm"):
        batch_cluster(SchedulerFile(system="slurm", options={"wrong": 1}))


class Job:
    def __init__(self, *, queue: str = "", cores: int = 1, memory: str = "") -> None: ...


class SLURMJob(Job):
    def __init__(self, *, account: str = "", **options: Any) -> None: ...


class SLURMCluster:
    job_cls = SLURMJob

    def __init__(self, processes: int = 1, **options: Any) -> None: ...


@pytest.mark.parametrize("name", ["acount", "queu", "options", "self"])
def test_unknown_option_of_a_batch_system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str) -> None:
    """Options of the cluster's and the job's constructors are known, also those that one passes on to the other."""
    monkeypatch.setattr(dask_cluster, "_distributed", lambda: None)
    monkeypatch.setattr(dask_cluster, "_jobqueue", lambda: SimpleNamespace(SLURMCluster=SLURMCluster))
    file, table = tmp_path / "slurm.toml", '[slurm]\ncores = 2\nmemory = "2GB"\nqueue = "a"\naccount = "b"\n'
    file.write_text(table)
    dask_cluster.require_scheduler(file)
    file.write_text(f'{table}{name} = "c"\n')
    with pytest.raises(ParameterError) as caught:
        dask_cluster.require_scheduler(file)
    assert caught.value.code == "unknown_option"


def test_who_does_not_answer_is_reported_with_what_to_start() -> None:
    plain = dask_cluster._unanswered(SchedulerFile(address="tcp://h:1"), OSError("refused"))
    assert "tcp://h:1 (refused)" in plain
    for asked in (SchedulerFile(address="tls://h:1"), SchedulerFile(address="tcp://h:1", tls={"cert": "c"})):
        assert "uses certificates" in dask_cluster._unanswered(asked, OSError("refused"))
    assert [is_plain(f"{kind}://h:1") for kind in ("tcp", "tls", "wss", "ws")] == [True, False, False, True]


def test_what_a_scheduler_needs_is_requested_before_the_work_begins(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Dask for an address, the certificates that are named, and dask-jobqueue for a batch system only."""
    asked: list[str] = []
    monkeypatch.setattr(dask_cluster, "_distributed", lambda: asked.append("distributed"))
    jobqueue = SimpleNamespace(SLURMCluster=SLURMCluster)

    def load_jobqueue() -> SimpleNamespace:
        asked.append("jobqueue")
        return jobqueue

    monkeypatch.setattr(dask_cluster, "_jobqueue", load_jobqueue)
    require_scheduler("tcp://h:1")
    assert asked == ["distributed"]
    file = tmp_path / "scheduler.toml"
    file.write_text('[slurm]\ncores = 2\nmemory = "2GB"\n', encoding="utf-8")
    require_scheduler(file)
    assert asked == ["distributed", "distributed", "jobqueue"]
    file.write_text('address = "tls://h:1"\n[tls]\nca_file = "none.pem"\n', encoding="utf-8")
    with raises(ParameterError, "no_certificate"):
        require_scheduler(file)


def test_a_scheduler_that_dask_does_not_reach_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    class Distributed:
        @staticmethod
        def Client(address: str, *, timeout: float, **_: Any) -> None:
            raise OSError(f"{address} refused for {timeout:g} s")

    monkeypatch.setattr(dask_cluster, "_distributed", lambda: Distributed)
    with raises(SkisnowError, "no_scheduler", address="tcp://h:1"):
        crew_of_scheduler("tcp://h:1", dict)


def test_jobs_of_a_batch_system_are_ended_behind_the_client(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """So many jobs as the file states, a client of their cluster, whose threads count."""
    said: list[Any] = []
    cluster = SimpleNamespace(scale=lambda *, jobs: said.append(jobs), close=lambda: said.append("cluster closed"))

    class ClusterClient(Client):
        def __init__(self, of: Any) -> None:
            super().__init__()
            assert of is cluster

        def close(self) -> None:
            said.append("client closed")

    class Started(SLURMCluster):
        def __new__(cls, **_: Any) -> Any:
            return cluster

    monkeypatch.setattr(dask_cluster, "_distributed", lambda: SimpleNamespace(Client=ClusterClient))
    monkeypatch.setattr(dask_cluster, "_jobqueue", lambda: SimpleNamespace(SLURMCluster=Started))
    file = tmp_path / "scheduler.toml"
    file.write_text('[slurm]\njobs = 3\ncores = 2\nmemory = "2GB"\n', encoding="utf-8")
    crew = crew_of_scheduler(file, dict)
    assert crew.size() == 7
    assert crew.submit([(0, {"n": 1})]).result().rows == [(0, '{"n":1}')]
    crew.end(at_once=False)
    assert said == [3, "client closed", "cluster closed"]
