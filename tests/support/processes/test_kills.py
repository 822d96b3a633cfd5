"""Workers, clients and schedulers are killed again and again: no row that was kept is lost, none is computed twice."""

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("distributed", reason="Dask is not installed: skisnow[dask]")

from skisnow._support.processes.kept_rows import KeptRows

from . import napping
from .test_dask import Cluster, wait_for

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
KILLS = 20
"""Of each kind."""
POINTS_PER_KILL = 400
"""Enough that the batch goes on while workers start on a busy machine: 20 kills of each need 4 minutes of naps."""
MOST_BETWEEN = 60
"""Rows that are kept from one kill to the next, at most as drawn."""
ROOT = Path(__file__).parents[2]


@dataclass
class Batch:
    """A batch with its client, its cluster, and the rows noted as kept."""

    folder: Path
    points: int
    clusters: list[Cluster] = field(default_factory=list)
    client: subprocess.Popen[str] | None = None

    def noted(self) -> list[int]:
        """The numbers of rows that were kept, in the order of their coming."""
        place = self.folder / "kept.txt"
        return [int(line) for line in place.read_text(encoding="utf-8").split()] if place.exists() else []

    def begin_cluster(self) -> None:
        """A scheduler and two workers, in a separate folder."""
        place = self.folder / f"cluster-{len(self.clusters)}"
        place.mkdir()
        self.clusters.append(Cluster(place))
        self.clusters[-1].hire(2)

    def begin_client(self) -> None:
        words = [str(self.folder), self.clusters[-1].address, str(self.points)]
        command = [sys.executable, "-m", "tests.support.processes.napping", *words]
        self.client = subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True)

    def wait_for_rows(self, further: int) -> None:
        """Until so many rows more are kept."""
        client = self.client
        assert client is not None
        wanted = len(self.noted()) + further
        wait_for(lambda: len(self.noted()) >= wanted or client.poll() is not None)
        assert len(self.noted()) >= wanted, client.communicate()[1]

    def kill_worker(self) -> None:
        cluster = self.clusters[-1]
        cluster.kill(cluster.workers.pop(0))
        self.wait_for_rows(1)  # the other one goes on
        cluster.hire(1)

    def kill_client(self) -> None:
        assert self.client is not None
        self.client.kill()
        self.client.communicate()
        self.require_kept()
        self.begin_client()

    def kill_scheduler(self) -> None:
        assert self.client is not None
        self.clusters[-1].kill(self.clusters[-1].scheduler)
        told = self.client.communicate(timeout=300)[1]
        assert self.client.returncode == napping.LOST
        assert "finished points are kept" in told
        self.clusters[-1].close()
        self.require_kept()
        self.begin_cluster()
        self.begin_client()

    def require_kept(self) -> list[int]:
        """Nothing that was noted is lost; gives all rows that are kept."""
        kept = KeptRows.read(self.folder / "rows")
        try:
            rows = dict(kept.rows())
        finally:
            kept.close()
        assert set(self.noted()) <= set(rows)
        assert all(row == {"square": number * number} for number, row in rows.items())
        return list(rows)

    def close(self) -> None:
        if self.client is not None and self.client.poll() is None:
            self.client.kill()
            self.client.communicate()
        for cluster in self.clusters:
            cluster.close()


def killed_again_and_again(folder: Path, kills: int, seed: int) -> list[int]:
    """A batch in which each kind of process is killed so often; the numbers of rows as they were kept."""
    generator = np.random.default_rng(seed)
    batch = Batch(folder, POINTS_PER_KILL * 3 * kills)
    kinds = (batch.kill_worker, batch.kill_client, batch.kill_scheduler)
    order = generator.permutation(np.tile(np.arange(len(kinds)), kills))
    try:
        batch.begin_cluster()
        batch.begin_client()
        for kind in order:
            batch.wait_for_rows(int(generator.integers(1, MOST_BETWEEN)))
            kinds[kind]()
        assert batch.client is not None
        told = batch.client.communicate(timeout=600)[1]
        assert batch.client.returncode == 0, told
        assert batch.require_kept() == list(range(batch.points))
        return batch.noted()
    finally:
        batch.close()


@pytest.mark.slow
def test_sixty_kills_lose_nothing_and_nothing_is_computed_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{ROOT / 'src'}:{ROOT}")  # a worker elsewhere has what it is to compute
    noted = killed_again_and_again(tmp_path, KILLS, seed=23)
    assert len(noted) == len(set(noted))
