"""Damaged entries and damaged files of a store."""

import random
import re
import shutil
import sqlite3
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
from sqlalchemy import event
from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.stored_tables import cell_of

from .reasons import LOCKED, NO_ROOM
from .test_journal import TOML, campaign_with, reading
from .test_store import change, contents, write

FILES = {
    "empty.csv": b"",
    "windows.csv": "Schneehärte;1,5\r\n".encode("cp1252"),
    "case.csv": b"lower",
    "raw/SMP.PNT": np.arange(600_000, dtype=">u4").tobytes(),  # 2.3 MiB: three chunks
}

SMALL = {"campaign.toml": b"name = 'day'\n", "sub/a.csv": b"experiment,site\n" * 300, "b.bin": bytes(range(256)) * 9}
ENTRY = (
    "INSERT INTO journal VALUES ('j', ''); PRAGMA ignore_check_constraints = 1; "
    "INSERT INTO journal_entry (journal_id, at, who, file, test, why, action, cells) VALUES ('j', '', '', '', '', '',"
)


@pytest.fixture
def place(empty_file: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(empty_file, tmp_path / "store.sqlite3"))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write(tmp_path / "Brenner 2012", FILES)


def test_a_flipped_bit_is_found_named_and_repaired(folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store:
        added = store.add(folder)
        assert store.verify() == ()
    data = FILES["windows.csv"]
    raw = bytearray(place.read_bytes())
    at = raw.index(data)
    raw[at] ^= 1
    place.write_bytes(raw)
    with Store.open(place) as store:
        findings = store.verify()
        assert [(finding.campaign, finding.path) for finding in findings] == [(added.id, "windows.csv")]
        with raises(StoreError, "damaged", path="windows.csv"):
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
        ("UPDATE chunk SET data = x'00' WHERE position = 2", "SHA-256"),
        ("DELETE FROM chunk WHERE position = 1", "SHA-256"),
        ("UPDATE content SET size = size + 1 WHERE size = 0", "SHA-256"),
        ("DELETE FROM campaign_file WHERE path = 'case.csv'", "added with"),
        ("DELETE FROM content WHERE size = 0", "table content"),
        ("DELETE FROM campaign", "table campaign"),
        ("PRAGMA ignore_check_constraints = 1; UPDATE content SET size = -1 WHERE size = 0", "CHECK constraint"),
        ("UPDATE campaign SET added_at = 'yesterday'", "damaged"),
        ("UPDATE campaign SET name = x'ff00'", "damaged"),
        ("UPDATE content SET size = 'many' WHERE size = 0", "SHA-256"),
        ("UPDATE campaign_file SET path = x'ff' WHERE path = 'case.csv'", "damaged"),
        (f"{ENTRY} x'00', '{{}}')", "entry j is damaged"),
        (f"{ENTRY} 'describe', '{{\"a\": 1}}')", "entry j is damaged"),
    ],
)
def test_verify_finds(statement: str, sentence: str, folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
        change(place, statement)
        assert any(re.search(sentence, str(finding)) for finding in store.verify())
        for read in (store.list, Journals(store).list, lambda: Journals(store).entries("j")):
            with suppress(StoreError):
                read()


def test_verify_continues_behind_each_damage(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
        change(place, f"{ENTRY} 'describe', '[1]'); DROP TABLE content; UPDATE campaign SET name = x'ff'")
        found = [str(finding) for finding in store.verify()]
    for sentence in ("no such table", "is damaged in the store", "The entry 1"):
        assert any(sentence in finding for finding in found), sentence


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE campaign_file SET path = 'cate.csv' WHERE path = 'case.csv'",
        "DELETE FROM campaign_file WHERE path = 'case.csv'",
        "DELETE FROM campaign_file",
    ],
)
def test_nothing_is_exported_under_a_damaged_name(statement: str, folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store:
        id_ = store.add(folder).id
        change(place, statement)
        with raises(StoreError, "damaged"):
            store.export(id_, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_store_of_two_versions_is_damaged(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
    change(place, "INSERT INTO alembic_version VALUES ('0001')")
    with raises(StoreError, "damaged"):
        Store.open(place)


def test_a_schema_whose_names_are_no_text_is_damaged(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
    raw = place.read_bytes()
    assert b"tablechunkchunk" in raw
    raw = raw.replace(b"tablechunkchunk", b"tablech\xf5nkchunk").replace(b"CREATE TABLE chunk", b"CREATE TABLE ch(nk")
    place.write_bytes(raw)
    with pytest.raises(StoreError, match="file is damaged"):
        Store.open(place)


def flipped(raw: bytes, random_: random.Random) -> bytes:
    """A store with bits flipped in its head, at the beginning of pages or anywhere; or cut; or with a page of zeros."""
    data = bytearray(raw)
    how = random_.randrange(5)
    if how == 3:
        return bytes(data[: random_.randrange(len(data))])
    if how == 4:
        at = random_.randrange(len(data))
        data[at : at + 4096] = bytes(len(data[at : at + 4096]))
    else:
        for _ in range(random_.choice((1, 1, 2, 5, 20))):
            anywhere = random_.randrange(len(data))
            at = (anywhere, anywhere % 100, anywhere - anywhere % 4096 + anywhere % 200)[how]
            data[at % len(data)] ^= 1 << random_.randrange(8)
    return bytes(data)


def read_damaged(folder: Path, tmp_path: Path, *, seed: int, number: int) -> int:
    """Verify, list and export so many damaged stores; how many were reported. Any other error comes through."""
    sound, damaged, random_ = tmp_path / "sound", tmp_path / "damaged", random.Random(seed)
    with Store.open(sound) as store:
        id_ = store.add(folder).id
        journal = Journals(store).begin("name = 'day'\n")
    raw, told = sound.read_bytes(), 0
    for tried in range(number):
        for path in tmp_path.glob("damaged*"):
            path.unlink()
        damaged.write_bytes(flipped(raw, random_))
        out = tmp_path / f"out{tried}"
        with suppress(StoreError), Store.open(damaged, create=False) as store:
            told += bool(store.verify())
            for read in (store.list, Journals(store).list, lambda store=store: Journals(store).entries(journal)):
                with suppress(StoreError):
                    read()
            with suppress(StoreError):
                store.export(id_, out)
        assert not out.exists() or contents(out) == SMALL
        shutil.rmtree(out, ignore_errors=True)
    return told


def test_flipped_bits_are_reported(tmp_path: Path) -> None:
    assert read_damaged(write(tmp_path / "small", SMALL), tmp_path, seed=1, number=20) > 2


@pytest.mark.slow
def test_many_flipped_bits_are_reported(tmp_path: Path) -> None:
    assert read_damaged(write(tmp_path / "small", SMALL), tmp_path, seed=2, number=1500) > 150


def test_verify_finds_broken_pages(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        store.add(folder)
    raw = bytearray(place.read_bytes())
    raw[4096 * 3 : -4096] = bytes(len(raw) - 4096 * 4)
    place.write_bytes(raw)
    with Store.open(place) as store:
        assert any("malformed" in str(finding) for finding in store.verify())


# Locks, room, threads


def test_a_lock_held_too_long(folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place, busy_timeout_s=0.05) as store:
        id_ = store.add(folder).id
        other = sqlite3.connect(place, isolation_level=None)
        try:
            other.execute("BEGIN IMMEDIATE")
            with raises(StoreError, "not_stored", reason=LOCKED):
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
        with raises(StoreError, "not_stored", reason=NO_ROOM):
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


@pytest.mark.parametrize("data", ["3", "9223372036854775807", "'text'"])
def test_a_content_that_is_not_bytes_is_damage(data: str, folder: Path, place: Path, tmp_path: Path) -> None:
    """Python would make three zeros of a 3, and no memory is enough for the largest number."""
    with Store.open(place) as store:
        added = store.add(folder)
    change(place, f"PRAGMA ignore_check_constraints = 1; UPDATE chunk SET data = {data}")
    with Store.open(place) as store:
        with pytest.raises(StoreError):
            store.export(added.id, tmp_path / "out")
        assert not (tmp_path / "out").exists()
        assert {finding.campaign for finding in store.verify()} == {added.id}


PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n1,A,piece,30,20,1.5\n1,A,piece,30,40,2.5\n"


@pytest.fixture
def journal_place(tmp_path: Path) -> Path:
    return tmp_path / "store.sqlite3"


def entered(journal_place: Path) -> str:
    """A series of three readings, entries 2 to 4, and a correction of the second one; the campaign's id."""
    with Store.open(journal_place) as store:
        journals = Journals(store)
        id_, last = campaign_with(journals, "1.5", "2.25", "3")
        corrected = replace(reading("1", 0, "40", "2.5"), action="correct", position=None, cells={"depth_mm": "2.5"})
        journals.append(id_, replace(corrected, about=last - 1, why="misheard"), seen=last)
    return id_


def change_journal(journal_place: Path, statement: str) -> None:
    connection = sqlite3.connect(journal_place, isolation_level=None)
    assert connection.execute(statement).rowcount > 0
    connection.close()


def told(journal_place: Path) -> list[str]:
    with Store.open(journal_place) as store:
        return [str(finding) for finding in store.verify()]


def cells(old: str, new: str, entry: int) -> str:
    return f"UPDATE journal_entry SET cells = replace(cells, '{old}', '{new}') WHERE sequence = {entry}"


def as_bytes(old: str, entry: int) -> str:
    """The last byte of a text becomes one that no text has, in a cell that stays a text for SQLite."""
    broken = f"x'{old[:-1].encode().hex()}{ord(old[-1]) | 0x80:02x}'"
    return f"UPDATE journal_entry SET cells = replace(cells, '{old}', CAST({broken} AS TEXT)) WHERE sequence = {entry}"


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        (cells('"3"', '"2"', 4), "penetration.csv: test 1, row 3"),
        (as_bytes("piece", 2), "penetration.csv: test 1, row 1"),
        (cells("depth_mm", "depth_mn", 3), "penetration.csv: test 1, row 2"),
        (cells("}", "|", 3), "penetration.csv: test 1, row 2"),
        (cells("a day", "a bay", 1), "campaign.toml: entry 1"),
        ("UPDATE journal_entry SET who = 'Ava' WHERE sequence = 2", "penetration.csv: test 1, row 1"),
        ("UPDATE journal_entry SET position = 6 WHERE sequence = 2", "test 1, row 7"),
        ("UPDATE journal_entry SET file = 'x.csv' WHERE sequence = 2", "x.csv: test 1, row 1"),
        ("UPDATE journal_entry SET sha256 = NULL WHERE sequence = 3", "test 1, row 2, entry 3: it has no checksum"),
    ],
)
def test_a_damaged_entry_is_named(journal_place: Path, statement: str, said: str) -> None:
    id_ = entered(journal_place)
    assert told(journal_place) == []
    change_journal(journal_place, statement)
    found = told(journal_place)
    assert any(finding.startswith(id_) and said in finding for finding in found), found


def test_a_damaged_correction_of_a_kept_campaign_is_named(journal_place: Path, tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "campaign.toml").write_text(TOML)
    (folder / "penetration.csv").write_text(PENETRATION)
    with Store.open(journal_place) as store:
        id_ = store.add(folder).id
        change(journal_place, "ALTER TABLE journal_entry ADD COLUMN sums TEXT")  # as older stores have it
        entry = replace(reading("1", 0, "", ""), action="correct", position=None, cells={"3/depth_mm": "2.75"})
        Journals(store).correct(id_, entry, seen=0, standing={"2/depth_mm": "1.5", "3/depth_mm": "2.5"})
        assert store.verify() == ()
    change_journal(journal_place, cells("2.75", "2.35", 2))
    (finding,) = told(journal_place)
    assert all(part in finding for part in (id_, "penetration.csv", "test 1", "entry 2"))
    with Store.open(journal_place) as store, raises(StoreError, "damaged", number="2"):
        Journals(store).corrections(id_)


def test_a_bit_of_a_cell_is_noticed_and_named(journal_place: Path) -> None:
    """In the file itself, where SQLite's own check does not look."""
    id_ = entered(journal_place)
    with sqlite3.connect(journal_place) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    raw = journal_place.read_bytes()
    at = raw.index(b'"depth_mm": "2.25"') + len(b'"depth_mm": "')
    assert raw.count(b"2.25") == 1
    for bit in range(0, 8 * len(b"2.25"), 3):
        flipped = bytearray(raw)
        flipped[at + bit // 8] ^= 1 << bit % 8
        journal_place.write_bytes(flipped)
        (finding,) = told(journal_place)
        assert all(part in finding for part in (id_, "penetration.csv", "row 2")), finding
        with Store.open(journal_place) as store, pytest.raises(StoreError, match="damaged"):
            Journals(store).entries(id_)


@pytest.mark.parametrize("key", ["", "/", "3/", "/depth_mm", "x/depth_mm", "-3/depth_mm", "9" * 5000 + "/depth_mm"])
def test_a_key_that_names_no_cell_is_damaged(key: str) -> None:
    with raises(StoreError, "damaged"):
        cell_of(key)
