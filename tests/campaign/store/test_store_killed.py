"""Processes that are killed while they write the store or exchange entries."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import IO

import numpy as np
import pytest
from tests.present import present

from skisnow.campaign.store import Journals, Store, sync

from .postgresql_server import Server
from .test_journal import TOML, reading
from .test_store import write

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="the trials are forked")

FORKING = """
import os, sys
from pathlib import Path
import skisnow.campaign.store.migrations, skisnow.campaign.reading.campaign
from skisnow.campaign.store import Store, sync

try:
    import psycopg
except ImportError:
    pass
def adding(place, folder, diary):
    diary = os.open(diary, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    def progress(done, total):
        os.write(diary, b"writing " if 2 * done >= total else b"reading ")
    os.write(diary, b"opening ")
    with Store.open(Path(place)) as store:
        store.add(Path(folder), progress=progress)
        os.write(diary, b"added ")
    os.write(diary, b"closed ")

def syncing(here, there, diary):
    diary = os.open(diary, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    with Store.open(Path(here)) as own, Store.open(there) as group:
        os.write(diary, b"begun ")
        sync(own, group)

while line := sys.stdin.readline():
    pid = os.fork()
    if pid == 0:
        work, *given = line.rstrip("\\n").split("\\t")
        globals()[work](*given)
        os._exit(0)
    print(pid, flush=True)
    sys.stdin.readline()  # until then the number stays the child's, even if it has ended
    print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), flush=True)
"""
N_FILES, FILE_BYTES = 24, 200_000
TABLES = ("campaign", "campaign_file", "content", "chunk")


def rows(store: Store) -> list[int]:
    """Count the rows of each table: a campaign of n files has 1, n, n, n, its files being smaller than a chunk."""
    with store.engine.connect() as connection:
        return [connection.exec_driver_sql(f"SELECT count(*) FROM {table}").scalar_one() for table in TABLES]


@dataclass
class Nursery:
    """Forks a child for each trial and reports how it ended."""

    process: subprocess.Popen[str]
    asking: IO[str]
    answers: IO[str]

    def trial(
        self, work: str, first: Path, second: Path | str, diary: Path, delay_s: float | None
    ) -> tuple[int, str, float]:
        """Exit code, last word of the diary, duration in s; the delay counts from when a synchronisation begins."""
        diary.unlink(missing_ok=True)
        self.asking.write(f"{work}\t{first}\t{second}\t{diary}\n")
        self.asking.flush()
        pid = int(self.answers.readline())
        start = time.perf_counter()
        while work == "syncing" and not diary.exists():
            time.sleep(0.001)
        if delay_s is not None:
            time.sleep(delay_s)
            os.kill(pid, signal.SIGKILL)
        self.asking.write("how did it end?\n")
        self.asking.flush()
        code = int(self.answers.readline())
        duration_s = time.perf_counter() - start
        words = diary.read_text().split() if diary.exists() else []
        return code, words[-1] if words else "nothing", duration_s


@pytest.fixture(scope="module")
def nursery() -> Iterator[Nursery]:
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # a process with threads should not fork
    with subprocess.Popen(
        [sys.executable, "-c", FORKING], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        yield Nursery(process, present(process.stdin), present(process.stdout))
        present(process.stdin).close()
        assert process.wait(timeout=300) == 0


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A campaign of 4.8 MB, more than SQLite keeps in memory: half-written pages do reach the disk."""
    folder = tmp_path / "campaign"
    folder.mkdir()
    generator = np.random.default_rng(1)
    for number in range(N_FILES):
        (folder / f"{number}.PNT").write_bytes(generator.bytes(FILE_BYTES))
    return folder


def kill_many(nursery: Nursery, folder: Path, tmp_path: Path, n_kills: int) -> Counter[tuple[str, bool]]:
    """Kill at ``n_kills`` moments; counts how far the child was, and whether the campaign is in the store.

    Among those where it is not, ``half-written log`` counts where pages of it were on the disk already.
    """
    base = tmp_path / "base.sqlite3"
    small = tmp_path / "small"
    small.mkdir()
    (small / "a").write_bytes(b"a")
    with Store.open(base) as store:
        small_id = store.add(small).id
    place, diary = tmp_path / "trial" / "store.sqlite3", tmp_path / "diary"

    def start_anew(index: int) -> None:
        shutil.rmtree(place.parent, ignore_errors=True)
        place.parent.mkdir()
        if index % 2:  # every other time the store has to be made, too
            shutil.copyfile(base, place)

    def whole_s(index: int) -> float:
        """How long an import takes that is not killed."""
        start_anew(index)
        code, word, duration_s = nursery.trial("adding", place, folder, diary, None)
        assert (code, word) == (0, "closed")
        return duration_s

    span_s = [1.1 * whole_s(0), 1.1 * whole_s(1)]  # a little beyond the end
    generator = np.random.default_rng(n_kills)
    seen: Counter[tuple[str, bool]] = Counter()
    for index, moment in enumerate(generator.permutation(n_kills) + generator.uniform(size=n_kills)):
        start_anew(index)
        code, word, _ = nursery.trial("adding", place, folder, diary, span_s[index % 2] * moment / n_kills)
        assert code in (-signal.SIGKILL, 0)
        log = place.with_name(place.name + "-wal")
        log_bytes = log.stat().st_size if log.exists() else 0
        with Store.open(place) as store:
            assert store.verify() == ()
            n_small = index % 2
            assert rows(store) in ([n_small] * 4, [n_small + n for n in (1, N_FILES, N_FILES, N_FILES)])
            others = {stored.id: stored for stored in store.list()}
            assert (others.pop(small_id, None) is not None) == bool(n_small)
            assert [stored.n_files for stored in others.values()] in ([], [N_FILES])
            if others:
                assert next(iter(others.values())).n_bytes == N_FILES * FILE_BYTES
                assert word not in ("nothing", "opening", "reading")
            else:
                assert word not in ("added", "closed")
                assert not store.add(folder).already_stored  # and it can be added at once
                seen["half-written log", False] += log_bytes > FILE_BYTES
        seen[word, bool(others)] += 1
    return seen


def test_killed_at_many_moments(nursery: Nursery, folder: Path, tmp_path: Path) -> None:
    seen, rounds = Counter[tuple[str, bool]](), 0
    while not seen["writing", False] and rounds < 5:  # killed while the transaction was open
        rounds += 1
        place = tmp_path / str(rounds)
        place.mkdir()
        seen += kill_many(nursery, folder, place, 6)
    assert seen.total() - seen["half-written log", False] == 6 * rounds
    assert seen["writing", False] >= 1, seen


@pytest.mark.slow
def test_killed_at_very_many_moments(nursery: Nursery, folder: Path, tmp_path: Path) -> None:
    seen = kill_many(nursery, folder, tmp_path, 200)
    assert seen["writing", False] >= 20, seen
    assert seen["half-written log", False] >= 5, seen
    assert seen["reading", False] >= 1, seen
    assert any(is_stored for _, is_stored in seen), seen


N_SERIES, N_CAMPAIGNS, SYNCED_BYTES = 3, 3, 300_000


def entered_offline(place: Path, who: str, folder: Path, generator: np.random.Generator) -> None:
    """Campaigns in entry, and stored ones, one of which the other laptop has, too."""
    with Store.open(place) as store:
        for name in (f"{who}'s day", "the same day"):
            journals = Journals(store)
            id_ = journals.begin(TOML.replace("a day", name), who=who)
            for test in range(N_SERIES):
                last = 0
                for position in range(2):
                    entry = reading(f"{who} {test}", position, str(20 * position + 20), str(position + 1))
                    last = journals.append(id_, replace(entry, who=who), seen=last).sequence
        for number in range(N_CAMPAIGNS):
            store.add(write(folder / who / str(number), {"raw": generator.bytes(SYNCED_BYTES), "both": b"same"}))
        store.add(write(folder / who / "shared", {"raw": b"shared" * 1000}))


def state(store: Store) -> tuple[list[str], list[str], Counter[str]]:
    """Campaigns, journals, and how often each test is there."""
    journals = Journals(store)
    entries = [entry for head in journals.list() for entry in journals.entries(head.id)]
    return (
        sorted(stored.id for stored in store.list()),
        sorted(head.id for head in journals.list()),
        Counter(f"{entry.test}, {entry.position}, {entry.uid}" for entry in entries),
    )


def synchronise_killed(
    nursery: Nursery, group: str, laptops: dict[str, Path], generator: np.random.Generator
) -> Counter[str]:
    """Synchronise each laptop, killed at random moments, until it came to its end twice; counts how it went."""
    seen: Counter[str] = Counter()
    for place in laptops.values():
        delay_s, ended = 0.02, 0
        while ended < 2:
            diary = place.with_suffix(".diary")
            code, _, _ = nursery.trial("syncing", place, group, diary, float(generator.uniform(0, delay_s)))
            assert code in (-signal.SIGKILL, 0)
            ended += code == 0
            seen["ended" if code == 0 else "killed"] += 1
            delay_s *= 1.6  # later each time: what was done need not be done again
        with Store.open(place) as own:
            assert own.verify() == ()
    return seen


@pytest.mark.parametrize(
    ("where", "seed"),
    [
        ("server", 1),
        *(pytest.param(*each, marks=pytest.mark.slow) for each in product(("file", "server"), range(2, 22))),
    ],
)
def test_nothing_is_lost_and_nothing_comes_twice(
    nursery: Nursery, where: str, seed: int, empty_file: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    generator = np.random.default_rng(seed)
    laptops = {who: Path(shutil.copy(empty_file, tmp_path / f"{who}.sqlite3")) for who in ("Ada", "Bo")}
    for who, place in laptops.items():
        entered_offline(place, who, tmp_path, generator)
    if where == "server":
        server: Server = request.getfixturevalue("server")
        group = server.emptied()
    else:
        group = str(shutil.copy(empty_file, tmp_path / "group.sqlite3"))
    seen = synchronise_killed(nursery, group, laptops, generator)
    assert seen["killed"] >= 2, seen
    with Store.open(laptops["Ada"]) as ada, Store.open(laptops["Bo"]) as bo, Store.open(group) as shared:
        for laptop in (ada, bo, ada):
            assert sync(laptop, shared).problems == ()
        found = [state(store) for store in (ada, bo, shared)]
        assert found[0] == found[1] == found[2]
        campaigns, journals, entries = found[0]
        assert len(campaigns) == 2 * N_CAMPAIGNS + 1
        assert len(journals) == 4
        assert set(entries.values()) == {1}
        assert len(entries) == 4 * (2 * N_SERIES + 1)
        assert [store.verify() for store in (ada, bo, shared)] == [()] * 3
