"""A synchronisation that is killed at any moment loses nothing and doubles nothing; done again, it goes on.

A nursery process imports the program once and forks a child for each trial, which synchronises and is killed with
SIGKILL after a random delay: two laptops, one after the other, with their group's store, until a run came to its end.
"""

from __future__ import annotations

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

import numpy as np
import pytest

from skisnow.campaign.store import Journals, Store, sync

from .postgresql_server import Server
from .test_journal import TOML, reading
from .test_store import write

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="the trials are forked")

NURSERY = """
import os, sys
from pathlib import Path
import skisnow.campaign.store.migrations
from skisnow.campaign.store import Store, sync

try:
    import psycopg
except ImportError:
    pass
while line := sys.stdin.readline():
    pid = os.fork()
    if pid == 0:
        here, there = line.rstrip("\\n").split("\\t")
        with Store.open(Path(here)) as own, Store.open(there) as group:
            os.write(1, b"begun\\n")
            sync(own, group)
        os._exit(0)
    print(pid, flush=True)
    sys.stdin.readline()  # until then the number stays the child's, even if it has ended
    print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), flush=True)
"""
SLOW = [pytest.param(*each, marks=pytest.mark.slow) for each in product(("file", "server"), range(2, 22))]
N_SERIES, N_CAMPAIGNS, FILE_BYTES = 3, 3, 300_000


@dataclass
class Nursery:
    """Forks a child for each trial and reports how it ended."""

    process: subprocess.Popen[str]

    def trial(self, here: Path, there: str, delay_s: float) -> int:
        """The exit code of a synchronisation that is killed after a while."""
        asking, answers = self.process.stdin, self.process.stdout
        assert asking is not None
        assert answers is not None
        asking.write(f"{here}\t{there}\n")
        asking.flush()
        told = {answers.readline().strip() for _ in range(2)}  # the number, and that it has begun, in any order
        pid = int(next(iter(told - {"begun"})))
        time.sleep(delay_s)
        os.kill(pid, signal.SIGKILL)
        asking.write("how did it end?\n")
        asking.flush()
        return int(answers.readline())


@pytest.fixture
def nursery() -> Iterator[Nursery]:
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # a process with threads should not fork
    with subprocess.Popen(
        [sys.executable, "-c", NURSERY], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        yield Nursery(process)
        assert process.stdin is not None
        process.stdin.close()
        assert process.wait(timeout=60) == 0


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
            store.add(write(folder / who / str(number), {"raw": generator.bytes(FILE_BYTES), "both": b"same"}))
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


def kill_many(nursery: Nursery, group: str, laptops: dict[str, Path], generator: np.random.Generator) -> Counter[str]:
    """Synchronise each laptop, killed at random moments, until it came to its end twice; counts how it went."""
    seen: Counter[str] = Counter()
    for place in laptops.values():
        delay_s, ended = 0.02, 0
        while ended < 2:
            code = nursery.trial(place, group, float(generator.uniform(0, delay_s)))
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
    seen = kill_many(nursery, group, laptops, generator)
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
