"""Places where a store can be, cannot be, can only be read; several processes at one store; connections."""

import errno
import os
import shutil
import sqlite3
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import event, func, select, text
from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign.store import Store, schema
from skisnow.campaign.store import engine as store_engine
from skisnow.campaign.store.engine import writing

from .reasons import CANNOT_OPEN, LOCKED, NO_STORE, READ_ONLY


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "campaign").mkdir()
    (tmp_path / "campaign" / "penetration.csv").write_bytes(b"raw")
    return tmp_path / "campaign"


@pytest.fixture
def id_(folder: Path, place: Path) -> str:
    with Store.open(place) as store:
        return store.add(folder).id


def test_connections_are_set_up(place: Path) -> None:
    with Store.open(place, busy_timeout_s=12.0) as store, store.engine.connect() as connection:
        found = {
            pragma: connection.exec_driver_sql(f"PRAGMA {pragma}").scalar_one()
            for pragma in ("foreign_keys", "synchronous", "journal_mode", "busy_timeout", "application_id")
        }
    full = 2
    application_id = int.from_bytes(b"SkiS")
    assert found == {
        "foreign_keys": 1,
        "synchronous": full,
        "journal_mode": "wal",
        "busy_timeout": 12_000,
        "application_id": application_id,
    }


def test_default_patience_is_thirty_seconds(place: Path) -> None:
    with Store.open(place) as store, store.engine.connect() as connection:
        assert connection.exec_driver_sql("PRAGMA busy_timeout").scalar_one() == 30_000


def test_writing_takes_the_lock_at_once_and_rolls_back(place: Path) -> None:
    with Store.open(place, busy_timeout_s=0.0) as store:
        insert = text("INSERT INTO content VALUES ('a', 1)")
        with pytest.raises(KeyboardInterrupt), writing(store.engine) as connection:
            connection.execute(insert)
            raise KeyboardInterrupt
        with writing(store.engine):
            other = sqlite3.connect(place, timeout=0.0, isolation_level=None)
            with pytest.raises(sqlite3.OperationalError, match="locked"):
                other.execute("BEGIN IMMEDIATE")
            other.close()
        with store.engine.connect() as connection:
            assert connection.scalar(select(func.count()).select_from(schema.content)) == 0


def test_rows_must_point_somewhere(place: Path) -> None:
    with (
        Store.open(place) as store,
        raises(StoreError, "not_written"),
        store_engine.database_errors(place, "not_written"),
        writing(store.engine) as connection,
    ):
        connection.execute(text("INSERT INTO chunk VALUES ('a', 0, x'00')"))
    with Store.open(place) as store, store.engine.connect() as connection:
        assert connection.scalar(select(func.count()).select_from(schema.chunk)) == 0


def test_odd_names_of_the_store(tmp_path: Path, folder: Path) -> None:
    for name in ("a b?mode=memory#c%20d.sqlite3", "ö雪.db", "no suffix"):
        place = tmp_path / "odd ?#%" / name
        with Store.open(place) as store:
            store.add(folder)
        assert place.is_file()
        with Store.open(place, create=False) as store:
            assert len(store.list()) == 1


def test_a_relative_place_stays_where_it_was(tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with Store.open(Path("store.sqlite3")) as store:
        monkeypatch.chdir(folder)
        store.add(folder)
    assert [*folder.iterdir()] == [folder / "penetration.csv"]


# No store


def test_reading_does_not_make_a_store(place: Path) -> None:
    with raises(StoreError, "no_store"):
        Store.open(place, create=False)
    assert not place.parent.exists()


def test_other_things_are_no_stores_and_stay_as_they_are(tmp_path: Path) -> None:
    words = tmp_path / "words.txt"
    words.write_text("experiment,site\n" * 1000)
    with raises(StoreError, "not_usable", reason=NO_STORE):
        Store.open(words)
    assert words.read_text() == "experiment,site\n" * 1000
    with raises(StoreError, "not_a_file"):
        Store.open(tmp_path)
    with raises(StoreError, "not_usable"):
        Store.open(words / "store.sqlite3")


def test_another_programs_database_is_left_alone(tmp_path: Path) -> None:
    other = tmp_path / "other.sqlite3"
    connection = sqlite3.connect(other)
    connection.execute("CREATE TABLE campaign (id)")
    connection.execute("CREATE TABLE alembic_version (version_num)")
    connection.execute("INSERT INTO alembic_version VALUES ('0001')")
    connection.commit()
    connection.close()
    before = other.read_bytes()
    with raises(StoreError, "other_database"):
        Store.open(other)
    assert other.read_bytes() == before


def test_a_damaged_file(id_: str, place: Path) -> None:
    assert id_
    raw = place.read_bytes()
    place.write_bytes(raw[:100] + b"\xff" * 4000 + raw[4100:])
    with pytest.raises(StoreError, match="file is damaged"):
        Store.open(place)


# Read-only


def answers_but_takes_nothing(place: Path, id_: str, tmp_path: Path) -> None:
    new = tmp_path / "new"
    new.mkdir()
    (new / "a").write_bytes(b"a")
    with Store.open(place) as store:
        assert [stored.id for stored in store.list()] == [id_]
        assert store.show(id_[:4]).n_bytes == len(b"raw")
        assert store.verify() == ()
        store.export(id_, tmp_path / "out")
        with raises(StoreError, "not_stored", reason=READ_ONLY):
            store.add(new)
    assert (tmp_path / "out" / "penetration.csv").read_bytes() == b"raw"


def test_a_connection_that_may_not_write(id_: str, place: Path, folder: Path, tmp_path: Path) -> None:
    (folder / "more").write_bytes(b"more")
    with Store.open(place) as store:
        event.listen(store.engine, "connect", lambda connection, _: connection.execute("PRAGMA query_only = ON"))
        with raises(StoreError, "not_stored", reason=READ_ONLY):
            store.add(folder)
        with raises(StoreError, "not_written", reason=READ_ONLY):
            store.remove(id_)
        assert [stored.id for stored in store.list()] == [id_]
        assert store.verify() == ()
        store.export(id_, tmp_path / "out")


def test_another_campaign_of_the_same_id_is_rejected(id_: str, place: Path, folder: Path) -> None:
    with Store.open(place) as store:
        with store.engine.begin() as connection:
            connection.execute(text("UPDATE campaign SET sha256 = :other"), {"other": id_.ljust(64, "f")})
        with raises(StoreError, "same_id", id=id_):
            store.add(folder)


def test_a_store_beside_no_log(id_: str, place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """SQLite's behaviour if the file beside the store cannot be made, root or not."""
    connect = sqlite3.connect

    def refuses(address: str, **options: object) -> sqlite3.Connection:
        if "immutable" not in address:
            error = sqlite3.OperationalError("unable to open database file")
            error.sqlite_errorcode = sqlite3.SQLITE_CANTOPEN
            raise error
        return connect(address, **options)  # type: ignore[call-overload]

    monkeypatch.setattr(sqlite3, "connect", refuses)
    answers_but_takes_nothing(place, id_, tmp_path)
    place.with_name(place.name + "-wal").write_bytes(b"somebody is writing")
    with raises(StoreError, "not_usable", reason=CANNOT_OPEN):
        Store.open(place)
    with raises(StoreError, "not_usable", reason=CANNOT_OPEN):
        Store.open(tmp_path / "new store")


@pytest.fixture
def frozen(place: Path) -> Iterator[None]:
    """Freeze the folder and the file with the file system's immutable attribute, which binds root too."""
    place.parent.mkdir(exist_ok=True)
    targets = [str(path) for path in (place, place.parent) if path.exists()]
    chattr = shutil.which("chattr")
    if chattr is None or subprocess.run([chattr, "+i", *targets], capture_output=True, check=False).returncode:
        if chattr is not None:
            subprocess.run([chattr, "-i", *targets], capture_output=True, check=False)
        pytest.skip("the immutable attribute is not to be had here")
    yield
    subprocess.run([chattr, "-i", *targets], check=True)


@pytest.mark.usefixtures("id_", "frozen")
def test_a_frozen_store(id_: str, place: Path, tmp_path: Path) -> None:
    answers_but_takes_nothing(place, id_, tmp_path)


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="runs as root")
def test_a_store_without_write_permission(id_: str, place: Path, tmp_path: Path) -> None:
    place.chmod(0o444)
    place.parent.chmod(0o555)
    try:
        answers_but_takes_nothing(place, id_, tmp_path)
    finally:
        place.parent.chmod(0o755)


def test_a_folder_that_cannot_be_made(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(path: Path, **_: object) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.setattr(Path, "mkdir", fails)
    with raises(StoreError, "not_usable", reason=READ_ONLY):
        Store.open(place)


# Several at once

WORK = """
import sys, time
from pathlib import Path
from skisnow.campaign.reading.campaign import check_campaign
from skisnow.campaign.store import Store
place, folder, go = map(Path, sys.argv[1:4])
print("ready", flush=True)
while not go.exists():
    time.sleep(0.001)
for campaign in sorted(folder.iterdir()):
    with Store.open(place) as store:
        store.add(campaign)
"""


def run_at_once(place: Path, folders: list[Path], go: Path) -> None:
    processes = [
        subprocess.Popen(
            [sys.executable, "-W", "error", "-c", WORK, str(place), str(folder), str(go)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for folder in folders
    ]
    for process in processes:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    go.touch()
    for process in processes:
        _, told = process.communicate(timeout=300)
        assert (process.returncode, told) == (0, "")


def campaigns(folder: Path, names: list[str]) -> Path:
    for name in names:
        (folder / name).mkdir(parents=True)
        (folder / name / "data").write_bytes(name.encode() * 20_000)
    return folder


@pytest.mark.parametrize(
    "state", ["absent", *(pytest.param(each, marks=pytest.mark.slow) for each in ("old schema", "empty file"))]
)
def test_two_processes_lose_nothing(state: str, place: Path, tmp_path: Path) -> None:
    """They race to make or migrate the store, then each adds its own campaigns and two that both have."""
    if state != "absent":
        place.parent.mkdir()
        place.touch()
    if state == "old schema":
        from skisnow.campaign.store.migrations import downgrade

        with Store.open(place) as store, writing(store.engine) as connection:
            downgrade(connection, "base")
    own = [[f"{who} {number}" for number in range(2)] for who in ("first", "second")]
    folders = [campaigns(tmp_path / names[0], [*names, "both a", "both b"]) for names in own]
    run_at_once(place, folders, tmp_path / "go")
    with Store.open(place, create=False) as store:
        assert sorted(stored.name for stored in store.list()) == sorted([*own[0], *own[1], "both a", "both b"])
        assert store.verify() == ()


@pytest.mark.parametrize("lock", ["EXCLUSIVE", "IMMEDIATE"])
def test_opening_waits_for_others(place: Path, lock: str) -> None:
    """Exclusive: one who makes the store. Immediate: others can read, and SQLite itself would not wait."""
    place.parent.mkdir()
    other = sqlite3.connect(place, isolation_level=None, check_same_thread=False)
    other.execute(f"BEGIN {lock}")
    with raises(StoreError, "not_usable", reason=LOCKED):
        Store.open(place, busy_timeout_s=0.05)
    release = threading.Timer(0.3, other.rollback)
    release.start()
    with Store.open(place, busy_timeout_s=20.0) as store:
        assert store.list() == ()
    release.join()
    other.close()
