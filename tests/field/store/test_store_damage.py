"""Damage is found and repaired; locks, a full disk and threads cost nothing that is stored."""

import sqlite3
from pathlib import Path
from threading import Thread

import pytest
from sqlalchemy import event

from skisnow.errors import StoreError
from skisnow.field.store import Store

FILES = {
    "empty.csv": b"",
    "windows.csv": "Schneehärte;1,5\r\n".encode("cp1252"),
    "case.csv": b"lower",
    "raw/SMP.PNT": b"".join(number.to_bytes(4) for number in range(600_000)),  # 2.3 MiB: three chunks
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write(tmp_path / "Brenner 2012", FILES)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "deep" / "store.sqlite3"


def write(folder: Path, files: dict[str, bytes]) -> Path:
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def change(place: Path, statement: str) -> None:
    """Meddle with a store behind its back, foreign keys off."""
    connection = sqlite3.connect(place, isolation_level=None)
    connection.executescript(statement)
    connection.close()


def flip_in_file(place: Path, data: bytes) -> None:
    """Change one bit of the file on the disk, inside a BLOB, where the database's own check does not look."""
    raw = bytearray(place.read_bytes())
    at = raw.index(data)
    raw[at] ^= 1
    place.write_bytes(raw)


def test_a_flipped_bit_is_found_named_and_repaired(folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store:
        added = store.add(folder)
        assert store.verify() == ()
    flip_in_file(place, FILES["windows.csv"])
    with Store.open(place) as store:
        findings = store.verify()
        assert [(finding.campaign, finding.path) for finding in findings] == [(added.id, "windows.csv")]
        with pytest.raises(StoreError, match=r"windows\.csv is damaged in the store"):
            store.export(added.id, tmp_path / "out")
        assert not (tmp_path / "out").exists()
        again = store.add(folder)
        assert (again.already_stored, again.n_repaired) == (True, 1)
        assert store.verify() == ()
        store.export(added.id, tmp_path / "out")
    assert contents(tmp_path / "out") == FILES


@pytest.mark.parametrize(
    ("statement", "sentence"),
    [
        ("UPDATE chunk SET data = x'00' WHERE position = 2", "no longer have the SHA-256"),
        ("UPDATE chunk SET position = 9 WHERE position = 0", "no longer have the SHA-256"),
        ("DELETE FROM chunk WHERE position = 1", "no longer have the SHA-256"),
        ("UPDATE content SET size = size + 1 WHERE size = 0", "no longer have the SHA-256"),
        ("DELETE FROM campaign_file WHERE path = 'case.csv'", "not those it was added with"),
        ("UPDATE campaign_file SET path = 'x' WHERE path = 'case.csv'", "not those it was added with"),
        ("DELETE FROM content WHERE size = 0", "points at what table content does not hold"),
        ("DELETE FROM campaign", "points at what table campaign does not hold"),
        ("PRAGMA ignore_check_constraints = 1; UPDATE content SET size = -1 WHERE size = 0", "CHECK constraint"),
        ("DROP TABLE chunk", "no longer have the SHA-256"),
        ("DROP TABLE content", "no such table"),
    ],
)
def test_verify_finds(statement: str, sentence: str, folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
        change(place, statement)
        assert any(sentence in str(finding) for finding in store.verify())


def test_verify_finds_broken_pages(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
    raw = bytearray(place.read_bytes())
    raw[4096 * 3 : -4096] = bytes(len(raw) - 4096 * 4)
    place.write_bytes(raw)
    with Store.open(place) as store:
        assert any("database disk image is malformed" in str(finding) for finding in store.verify())


# Locks, room, threads


def test_a_lock_held_too_long(folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place, busy_timeout_s=0.05) as store:
        id_ = store.add(folder).id
        other = sqlite3.connect(place, isolation_level=None)
        try:
            other.execute("BEGIN IMMEDIATE")
            with pytest.raises(StoreError, match="kept it locked for too long"):
                store.add(write(tmp_path / "other", {"a": b"a"}))
            assert [stored.id for stored in store.list()] == [id_]  # readers need not wait
            store.export(id_, tmp_path / "out")
        finally:
            other.close()
        assert not store.add(tmp_path / "other").already_stored


def test_a_full_disk_leaves_the_store_as_it_was(folder: Path, place: Path, tmp_path: Path) -> None:
    first = write(tmp_path / "first", {"a": b"a"})
    with Store.open(place) as store:
        id_ = store.add(first).id
        event.listen(store.engine, "connect", lambda connection, _: connection.execute("PRAGMA max_page_count = 200"))
        with pytest.raises(StoreError, match="no room left on the disk; free some space"):
            store.add(folder)
        assert [stored.id for stored in store.list()] == [id_]
        assert store.verify() == ()
        assert store.add(first).already_stored
    with Store.open(place) as store:  # there is room again
        assert not store.add(folder).already_stored
        assert store.verify() == ()


def test_threads_share_a_store(tmp_path: Path, place: Path) -> None:
    folders = [write(tmp_path / f"{number}", {"a": bytes([number]) * 100_000}) for number in range(8)]
    with Store.open(place) as store:
        threads = [Thread(target=store.add, args=(folder,)) for folder in folders]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert sorted(stored.name for stored in store.list()) == [str(number) for number in range(8)]
        assert store.verify() == ()
