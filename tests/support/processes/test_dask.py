"""Workers of a Dask scheduler, in separate processes: the bytes of one process, even if some of them are killed."""

import importlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("distributed", reason="Dask is not installed: skisnow[dask]")

from skisnow._support.errors import SkisnowError
from skisnow.studies import Study, read_study, run_study

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")

CARVE = """
out = "table.csv"
[fixed]
ski = "slalom"
published = "race-piste"
unloading_ratio = 10
elements = 40
[grid]
load_N = {{ from = 300, to = 1500, n = {loads} }}
edge_angle_deg = {{ from = 10, to = 60, n = {angles} }}
"""
RUNS = """
out = "table.csv"
scenario = "carved-46m"
[fixed]
"run.duration_s" = {duration}
[grid]
"start.speed_m_per_s" = {{ from = 6, to = 9, n = {speeds} }}
mu_0 = [0.02, 0.05]
"""
ALONE = {"OPENBLAS_NUM_THREADS": "1", "DASK_DISTRIBUTED__ADMIN__LOW_LEVEL_LOG_LENGTH": "0"}


class Cluster:
    """A scheduler and its workers; `further`: options of them all."""

    def __init__(self, folder: Path, *further: str) -> None:
        self._folder, self._further = folder, further
        place = folder / "scheduler.json"
        self.scheduler = self._started("dask_scheduler", "--port", "0", "--scheduler-file", str(place))
        self.file = place
        self.workers: list[subprocess.Popen[bytes]] = []
        wait_for(place.exists)
        self.address = __import__("json").loads(place.read_text(encoding="utf-8"))["address"]

    def hire(self, count: int) -> None:
        """Start workers, and wait until they are there."""
        begun = len(self.workers)
        self.workers += [
            self._started("dask_worker", self.address, "--nthreads", "1", "--no-nanny") for _ in range(count)
        ]
        distributed = importlib.import_module("distributed")
        with distributed.Client(self.address) as client:
            client.wait_for_workers(begun + count, timeout=120)

    def kill(self, process: subprocess.Popen[bytes]) -> None:
        """As the machine that loses its power."""
        process.send_signal(signal.SIGKILL)

    def close(self) -> None:
        """End what was started."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()

    def _started(self, program: str, *words: str) -> subprocess.Popen[bytes]:
        log = (self._folder / f"{program}.log").open("ab")
        command = [sys.executable, "-m", f"distributed.cli.{program}", *words, "--no-dashboard", "--host", "127.0.0.1"]
        command += self._further
        with log:
            return subprocess.Popen(command, cwd=self._folder, stdout=log, stderr=log, env={**os.environ, **ALONE})


def wait_for(condition: Any, patience_s: float = 120.0) -> None:
    end = time.monotonic() + patience_s
    while not condition():
        assert time.monotonic() < end, "it did not come to pass"
        time.sleep(0.05)


@pytest.fixture
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    made = Cluster(tmp_path_factory.mktemp("cluster"))
    try:
        made.hire(2)
        yield made
    finally:
        made.close()


def study_of(folder: Path, text: str) -> Study:
    folder.mkdir(exist_ok=True)
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return read_study(path)


def bytes_of_one_process(folder: Path, text: str) -> bytes:
    study = study_of(folder / "one", text)
    run_study(study, workers=1)
    found = study.out.read_bytes()
    study.out.unlink()
    return found


def test_two_workers_give_the_bytes_of_one_process(tmp_path: Path, cluster: Cluster) -> None:
    for text in (CARVE.format(loads=8, angles=8), RUNS.format(duration=0.2, speeds=3)):
        wanted = bytes_of_one_process(tmp_path, text)
        study = study_of(tmp_path / "dask", text)
        run_study(study, executor=cluster.address)
        assert study.out.read_bytes() == wanted
        study.out.unlink()


def killing(cluster: Cluster, text: str, folder: Path, after: int) -> bytes:
    """The table of a study during which a worker is killed and another one comes."""
    study = study_of(folder / "killed", text)
    killed = threading.Event()

    def tell(done: int, _total: int) -> None:
        if done >= after and not killed.is_set():
            killed.set()
            cluster.kill(cluster.workers[0])

    run_study(study, executor=cluster.address, progress=tell)
    assert killed.is_set()
    return study.out.read_bytes()


def test_a_worker_that_is_killed_loses_nothing(tmp_path: Path, cluster: Cluster) -> None:
    text = RUNS.format(duration=0.5, speeds=10)
    assert killing(cluster, text, tmp_path, after=3) == bytes_of_one_process(tmp_path, text)


def test_a_scheduler_that_is_killed_is_reported_and_the_study_continues(tmp_path: Path, cluster: Cluster) -> None:
    text = RUNS.format(duration=0.5, speeds=10)
    study = study_of(tmp_path / "killed", text)

    def tell(done: int, _total: int) -> None:
        if 3 <= done < 10:
            cluster.kill(cluster.scheduler)

    with pytest.raises(SkisnowError, match="are kept"):
        run_study(study, executor=cluster.address, progress=tell)
    told: list[int] = []
    run_study(study, workers=1, progress=lambda done, _: told.append(done))
    assert told[0] >= 3
    assert study.out.read_bytes() == bytes_of_one_process(tmp_path, text)
