"""The store gives back what came in, and nothing half-way."""

import errno
import hashlib
import os
import re
import sqlite3
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import func, select, text
from tests.coded import raises

from skisnow._support.errors import StoreError
from skisnow.campaign.problems import Problem
from skisnow.campaign.store import Store, default_path, schema
from skisnow.campaign.store import folder as store_folder
from skisnow.campaign.store.folder import checked_bytes, manifest_sha256

PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\nP1,A,ski,45,100,1.5\n"
FILES = {
    "campaign.toml": 'name = "Größe"'.encode(),
    "penetration.csv": PENETRATION.encode(),
    "shear.csv": b"\xef\xbb\xbf" + PENETRATION.replace("\n", "\r\n").encode(),
    "utf16.csv": PENETRATION.encode("utf-16"),
    "windows.csv": "Schneehärte;1,5\r\n".encode("cp1252"),
    "empty.csv": b"",
    ".hidden/.DS_Store": b"\x00\x01",
    "raw/day 1/SMP.PNT": np.arange(600_000, dtype=">u4").tobytes(),  # 2.3 MiB: three chunks
    "raw/day 1/exactly one chunk": b"x" * (1 << 20),
    "ääkköset/雪.csv": b"\r\n\r",
    "Case.csv": b"upper",
    "case.csv": b"lower",
    "back\\slash and:colon.csv": b"legal here",
}


def write(folder: Path, files: dict[str, bytes]) -> Path:
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def contents(folder: Path) -> dict[str, bytes]:
    return {file.relative_to(folder).as_posix(): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write(tmp_path / "Brenner 2012", FILES)


def change(place: Path, statement: str) -> None:
    """Meddle with a store behind its back, foreign keys off."""
    connection = sqlite3.connect(place, isolation_level=None)
    connection.executescript(statement)
    connection.close()


def test_export_gives_back_every_byte(folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store:
        added = store.add(folder)
        exported = store.export(added.id, tmp_path / "new" / "out")
        stored, data = store.contents(added.id, {"case.csv", "empty.csv", "no.csv"})
        assert (stored.id, data) == (added.id, {"case.csv": b"lower", "empty.csv": b""})
        with raises(StoreError, "damaged", path=stored.files[0].path):
            checked_bytes(stored.files[0], [b"other"])
    assert contents(tmp_path / "new" / "out") == FILES == contents(folder)
    assert (added.n_files, added.n_bytes) == (len(FILES), sum(map(len, FILES.values())))
    assert exported.id == added.id
    assert [*(tmp_path / "new").iterdir()] == [tmp_path / "new" / "out"]
    reference = tmp_path / "plain"
    reference.mkdir()
    assert (tmp_path / "new" / "out").stat().st_mode == reference.stat().st_mode  # not the mode of a temporary folder


def test_a_campaign_is_known_by_its_content_alone(folder: Path, place: Path, tmp_path: Path) -> None:
    copy = write(tmp_path / "another name", dict(reversed(FILES.items())))
    with Store.open(place) as store:
        first, again = store.add(folder), store.add(copy)
        (copy / "case.csv").write_bytes(b"Lower")
        other = store.add(copy)
        assert [stored.id for stored in store.list()] in ([first.id, other.id], [other.id, first.id])
        assert store.verify() == ()
    assert not first.already_stored
    assert again.already_stored
    assert not other.already_stored
    assert first.id == again.id != other.id
    lines = "".join(
        f"{hashlib.sha256(data).hexdigest()} {len(data)} {path}\0"
        for path, data in sorted(FILES.items(), key=lambda item: item[0].encode())
    )
    assert first.sha256 == hashlib.sha256(("skisnow manifest 1\n" + lines).encode()).hexdigest()
    assert first.id == first.sha256[:12]


def test_shared_files_are_kept_once(tmp_path: Path, place: Path) -> None:
    one = write(tmp_path / "one", {"a": b"shared" * 1000, "b": b"shared" * 1000})
    two = write(tmp_path / "two", {"c": b"shared" * 1000})
    with Store.open(place) as store:
        ids = [store.add(one).id, store.add(two).id]
        with store.engine.connect() as connection:
            assert connection.scalar(select(func.count()).select_from(schema.content)) == 1
        for id_, folder in zip(ids, (one, two), strict=True):
            store.export(id_, tmp_path / f"out {id_}")
            assert contents(tmp_path / f"out {id_}") == contents(folder)


def test_shown_fields_of_a_stored_campaign(folder: Path, place: Path) -> None:
    with Store.open(place) as store:
        added = store.add(folder)
        stored = store.show(added.id)
        assert store.list() == (stored,)
    assert {file.path: (file.size, file.sha256) for file in stored.files} == {
        path: (len(data), hashlib.sha256(data).hexdigest()) for path, data in FILES.items()
    }
    assert (stored.name, stored.sha256) == ("Größe", added.sha256)
    assert (stored.n_errors, stored.n_warnings) == (added.n_errors, added.n_warnings)
    assert timedelta(seconds=-1) <= datetime.now(UTC) - stored.added_at <= timedelta(minutes=5)


def problem(severity: str) -> Problem:
    return Problem(severity, "x", "f", allowed="a", action="b")  # type: ignore[arg-type]


def test_counts_of_the_check_are_kept(folder: Path, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = tuple(map(problem, ["error", "warning", "warning", "flag", "flag", "flag"]))
    found += (replace(problem("warning"), needs_action=False),)
    monkeypatch.setattr("skisnow.campaign.reading.campaign.check_campaign", lambda _: found)
    with Store.open(place) as store:
        added = store.add(folder)
        assert (added.n_errors, added.n_warnings, added.check_failure) == (1, 2, None)
        assert (store.list()[0].n_errors, store.list()[0].n_warnings) == (1, 2)


def test_a_check_that_breaks_does_not_cost_the_data(folder: Path, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def breaks(_: Path) -> None:
        raise ZeroDivisionError("by zero")

    monkeypatch.setattr("skisnow.campaign.reading.campaign.check_campaign", breaks)
    with Store.open(place) as store:
        added = store.add(folder)
        assert (added.n_errors, added.n_warnings) == (None, None)
        assert added.check_failure == "ZeroDivisionError: by zero"
        assert store.list()[0].n_errors is None


def test_ids_may_be_shortened(tmp_path: Path, place: Path) -> None:
    with Store.open(place) as store:
        added = store.add(write(tmp_path / "a", {"a": b"a"}))
        for given in (added.id, added.id[:4], added.id.upper(), added.sha256, f" {added.id[:7]} "):
            assert store.show(given).id == added.id
        with raises(StoreError, "unknown_id"):
            store.show(added.sha256[1:9])
        for given in ("", added.id[:3], "xyzw", added.id[:4] + "%", "____"):
            with raises(StoreError, "not_an_id"):
                store.show(given)


def test_ambiguous_and_unknown_ids_name_the_candidates(tmp_path: Path, place: Path) -> None:
    with Store.open(place) as store:
        with raises(StoreError, "unknown_id", candidates="none"):
            store.show("0123456789ab")
        store.add(write(tmp_path / "here", {"a": b"a"}))
        with store.engine.begin() as connection:
            for digit in "ab":
                sha256 = "01234" + digit * 59
                insert = "INSERT INTO campaign VALUES (:id, :sha256, :name, '2026-01-01T00:00:00Z', 0, 0)"
                connection.execute(text(insert), {"id": sha256[:12], "sha256": sha256, "name": f"twin {digit}"})
        with raises(
            StoreError, "ambiguous_id", beginning="01234", candidates="01234aaaaaaa (twin a), 01234bbbbbbb (twin b)"
        ):
            store.show("01234")
        assert store.show("01234b").name == "twin b"
        with raises(StoreError, "unknown_id", beginning="ffff0"):
            store.export("ffff0", tmp_path / "out")


def test_progress_covers_both_readings(folder: Path, place: Path) -> None:
    told: list[tuple[int, int]] = []
    with Store.open(place) as store:
        added = store.add(folder, progress=lambda done, total: told.append((done, total)))
    total = 2 * added.n_bytes
    assert {share[1] for share in told} == {total}
    done = [share[0] for share in told]
    assert done == sorted(done)
    assert done[-1] == total


def test_export_does_not_touch_what_is_there(folder: Path, place: Path, tmp_path: Path) -> None:
    taken = write(tmp_path / "taken", {"mine": b"mine"})
    (tmp_path / "empty").mkdir()
    with Store.open(place) as store:
        id_ = store.add(folder).id
        for out in (taken, taken / "mine"):
            with raises(StoreError, "not_empty"):
                store.export(id_, out)
        with raises(StoreError, "not_written"):
            store.export(id_, taken / "mine" / "below a file")
        store.export(id_, tmp_path / "empty")
    assert contents(taken) == {"mine": b"mine"}
    assert contents(tmp_path / "empty") == FILES


@pytest.mark.parametrize("path", ["../evil", "C:/evil", "a//b", ""])
def test_export_rejects_unsafe_paths(path: str, folder: Path, place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store:
        files = store.show(store.add(folder).id).files
        sha256 = manifest_sha256(replace(file, path=path) if file.path == "case.csv" else file for file in files)
        id_ = sha256[:12]  # whoever wants to write elsewhere gives the list of files its hash
        change(
            place,
            f"UPDATE campaign SET id = '{id_}', sha256 = '{sha256}'; UPDATE campaign_file SET campaign_id = '{id_}'; "
            f"UPDATE campaign_file SET path = '{path}' WHERE path = 'case.csv'",
        )
        before = sorted(tmp_path.iterdir())
        with raises(StoreError, "unsafe_name"):
            store.export(id_, tmp_path / "out")
        assert sorted(tmp_path.iterdir()) == before
        assert any(finding.path == path and "not safe" in finding.message for finding in store.verify())


@pytest.mark.parametrize(("number", "sentence"), [(errno.ENOSPC, "no room left"), (errno.EACCES, "not allowed")])
@pytest.mark.parametrize("call", [1, len(FILES) + 1])
def test_export_to_a_disk_that_fails_leaves_nothing(
    number: int, sentence: str, call: int, folder: Path, place: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[int] = []

    def fails(handle: int) -> None:
        calls.append(handle)
        if len(calls) == call:
            raise OSError(number, os.strerror(number))

    with Store.open(place) as store:
        id_ = store.add(folder).id
        before = sorted(tmp_path.iterdir())
        with monkeypatch.context() as patched:
            patched.setattr(os, "fsync", fails)
            with pytest.raises(StoreError, match=re.escape(str(tmp_path / "out")) + f".*{sentence}"):
                store.export(id_, tmp_path / "out")
        assert sorted(tmp_path.iterdir()) == before
        store.export(id_, tmp_path / "out")
    assert contents(tmp_path / "out") == FILES


def test_a_file_whose_name_exists_is_rejected(tmp_path: Path) -> None:
    file = store_folder.StoredFile("a.csv", 1, hashlib.sha256(b"a").hexdigest())
    store_folder.write_file(tmp_path, file, [b"a"])
    with raises(StoreError, "same_name"):
        store_folder.write_file(tmp_path, file, [b"a"])


def test_the_users_own_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("platformdirs.user_data_path", lambda name: tmp_path / "share" / name)
    assert default_path() == tmp_path / "share" / "skisnow" / "store.sqlite3"
    with Store.open() as store:
        assert store.path == default_path()
    assert default_path().is_file()
