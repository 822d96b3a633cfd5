"""Migrations of the store, and what it rejects."""

import errno
import logging
import os
import runpy
import shutil
import sqlite3
from pathlib import Path

import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from tests.coded import raises

import skisnow.campaign.store.migrations
from skisnow._support.errors import StoreError
from skisnow.campaign.store import Store
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.folder import _sync_folder, campaign_name, changed_files, unsafe_because
from skisnow.campaign.store.migrations import alembic_config, downgrade, is_known, upgrade
from skisnow.campaign.store.schema import APPLICATION_ID, REVISION, metadata

from .reasons import NOT_ALLOWED
from .test_store import write

FILES = {
    "campaign.toml": b"name = 'A'",
    "penetration.csv": b"experiment,site\n" * 1000,
    "shear.csv": b"experiment,site\n",
    "empty.csv": b"",
    "raw/day 1/SMP.PNT": bytes(2 << 20),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write(tmp_path / "Brenner 2012", FILES)


def test_links_and_pipes_are_rejected_and_named(folder: Path, place: Path) -> None:
    (folder / "link.csv").symlink_to(folder / "shear.csv")
    (folder / "raw" / "folder link").symlink_to(folder)
    os.mkfifo(folder / "pipe")
    with Store.open(place) as store:
        with raises(StoreError, "not_a_file") as caught:
            store.add(folder)
        assert store.list() == ()
    for name in ("link.csv", "raw/folder link", "pipe"):
        assert name in str(caught.value)


def test_the_folder_itself_may_be_reached_by_a_link(folder: Path, place: Path, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(folder)
    with Store.open(place) as store:
        assert store.add(tmp_path / "link").id == store.add(folder).id


@pytest.mark.parametrize("name", [b"not text \xff.csv", b"C:drive.csv"])
def test_names_that_could_not_be_given_back_are_rejected(name: bytes, folder: Path, place: Path) -> None:
    try:
        Path(os.fsdecode(bytes(folder) + b"/" + name)).write_bytes(b"")
    except OSError:
        pytest.skip("this file system has no such names itself")
    with Store.open(place) as store:
        with raises(StoreError, "unsafe_name"):
            store.add(folder)
        assert store.list() == ()


def test_no_folder_no_file_no_store_within(tmp_path: Path, place: Path) -> None:
    file = write(tmp_path, {"file": b"x"}) / "file"
    (tmp_path / "empty" / "folder").mkdir(parents=True)
    with Store.open(place) as store:
        with raises(StoreError, "no_folder"):
            store.add(tmp_path / "absent")
        with raises(StoreError, "no_folder"):
            store.add(file)
        with raises(StoreError, "no_files"):
            store.add(tmp_path / "empty")
        with raises(StoreError, "inside_folder"):
            store.add(tmp_path)


def test_a_file_that_cannot_be_read(folder: Path, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(file: Path, _: int) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(file))

    monkeypatch.setattr("skisnow.campaign.store.folder.read_chunks", forbidden)
    with Store.open(place) as store:
        with raises(StoreError, "not_read", reason=NOT_ALLOWED):
            store.add(folder)
        assert store.list() == ()


def rewrite_unseen(file: Path) -> None:
    """Change one byte, then restore size and time of change: only the content can tell."""
    state = file.stat()
    file.write_bytes(b"\xff" + file.read_bytes()[1:])
    os.utime(file, ns=(state.st_atime_ns, state.st_mtime_ns))


@pytest.mark.parametrize(
    "meddle",
    [
        lambda folder: rewrite_unseen(folder / "penetration.csv"),
        lambda folder: (folder / "penetration.csv").write_bytes(b"shorter"),
        lambda folder: (folder / "empty.csv").write_bytes(b"no longer"),
        lambda folder: (folder / "new.csv").write_bytes(b"new"),
        lambda folder: os.utime(folder / "campaign.toml", ns=(1, 1)),
        lambda folder: (folder / "penetration.csv").unlink(),
    ],
    ids=["unseen", "shorter", "longer", "came", "touched", "went"],
)
@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_campaign_that_changes_meanwhile_is_rejected(meddle, share, folder: Path, place: Path, request) -> None:  # type: ignore[no-untyped-def]
    if share == 1.0 and "unseen" in request.node.callspec.id:
        pytest.skip("what was stored then is what was hashed: the campaign as it was")
    left = [meddle]

    def meddling(done_bytes: int, total_bytes: int, /) -> None:
        if left and done_bytes >= share * total_bytes:
            left.pop()(folder)

    with Store.open(place) as store:
        with pytest.raises(StoreError) as caught:
            store.add(folder, progress=meddling)
        assert caught.value.code in ("changed_meanwhile", "not_read")
        assert not left
        assert store.list() == ()
        assert store.verify() == ()


# Names of campaigns and paths that are safe to write


@pytest.mark.parametrize(
    ("raw", "name"),
    [
        ('name = "Sölden"'.encode(), "Sölden"),
        ("\ufeffname = 'Sölden'\r\n".encode(), "Sölden"),
        ('name = "Sölden"'.encode("utf-16"), "Sölden"),
        ('name = "Sölden"'.encode("cp1252"), "Sölden"),
        (b'name = """\n two\n\tlines """', "two lines"),
        (b'name = "  "', "the folder"),
        (b"name = 3", "the folder"),
        (b"place = 'x'", "the folder"),
        (b"name = ", "the folder"),
        (b"\xff\xfe\x00", "the folder"),
        (b"\x00\x01\x02", "the folder"),
    ],
)
def test_name(raw: bytes, name: str, tmp_path: Path) -> None:
    folder = tmp_path / "the folder"
    folder.mkdir()
    assert campaign_name(folder) == "the folder"
    (folder / "campaign.toml").write_bytes(raw)
    assert campaign_name(folder) == name


NOWHERE = ["", ".", "..", "/", "/a", "//a", "a//b", "a/", "a/../b", "./a", "C:", "c:/a", "z:a", "a\0b", "\udcff"]
NOT_ON_WINDOWS = [
    "back\\slash", "nul", "end.", "q?", "1:2", "NUL.txt", "a/Com1", "lpt9.csv", "COM¹", "con .txt", "CONIN$",
]  # fmt: skip
NOT_ON_WINDOWS += ["a./b", "a ", "ab:c", "a\\b", "a\tb", "a|b"]
ANYWHERE = [
    "a", "a/b.csv", "...a", "a b/ä", "null", "com10", "console.csv", "a.nul", ".hidden", "a.b/c d", "com", "ünï",
]  # fmt: skip


def test_paths_that_are_safe() -> None:
    paths = [*NOWHERE, "...", *NOT_ON_WINDOWS, *ANYWHERE]
    unsafe_here, on_windows = (
        [path for path in paths if unsafe_because(path, for_windows=windows) is not None] for windows in (False, True)
    )
    assert unsafe_here == NOWHERE
    assert on_windows == [*NOWHERE, "...", *NOT_ON_WINDOWS]


def test_changes_between_listings() -> None:
    before = {"same": (1, 1), "grown": (1, 1), "touched": (1, 1), "went": (1, 1)}
    after = {"same": (1, 1), "grown": (2, 1), "touched": (1, 2), "came": (1, 1)}
    assert changed_files(before, after) == ["came", "grown", "touched", "went"]


HERE = Path(skisnow.campaign.store.migrations.__file__).parent


@pytest.fixture
def migrated_place(tmp_path: Path) -> Path:
    return tmp_path / "store.sqlite3"


def schema(migrated_place: Path) -> dict[str, str]:
    """Each table and index with its SQL, blanks apart."""
    connection = sqlite3.connect(migrated_place)
    rows = connection.execute("SELECT name, sql FROM sqlite_master WHERE name <> 'alembic_version'").fetchall()
    connection.close()
    return {name: "".join((sql or "").split()) for name, sql in rows if not name.startswith("sqlite_autoindex_alembic")}


def test_tables_equal_migrations(migrated_place: Path) -> None:
    with Store.open(migrated_place) as store, store.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True, "compare_server_default": True})
        assert compare_metadata(context, metadata) == []


def test_the_program_knows_its_newest_migration() -> None:
    script = ScriptDirectory.from_config(alembic_config())
    assert script.get_heads() == [REVISION]
    assert is_known(REVISION)
    assert not any(map(is_known, ("9999", "", REVISION[:2])))


def test_every_migration_goes_down_and_up_again(migrated_place: Path) -> None:
    Store.open(migrated_place).close()
    new = schema(migrated_place)
    revisions = [script.revision for script in ScriptDirectory.from_config(alembic_config()).walk_revisions()]
    with Store.open(migrated_place) as store:
        for _ in revisions:
            with writing(store.engine) as connection:
                downgrade(connection, "-1")
        assert schema(migrated_place) == {}
        with writing(store.engine) as connection:
            upgrade(connection)
        assert schema(migrated_place) == new
        with store.engine.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA application_id").scalar_one() == APPLICATION_ID
            assert connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalar_one() == REVISION


def test_rows_that_point_nowhere_stop_a_migration(migrated_place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def orphans(connection: object) -> None:
        upgrade(connection)  # type: ignore[arg-type]
        connection.exec_driver_sql("INSERT INTO chunk VALUES ('a', 0, x'00')")  # type: ignore[attr-defined]

    monkeypatch.setattr("skisnow.campaign.store.migrations.upgrade", orphans)
    with raises(StoreError, "damaged"):
        Store.open(migrated_place)
    assert schema(migrated_place) == {}


def test_a_newer_store_is_rejected_and_left_alone(migrated_place: Path) -> None:
    Store.open(migrated_place).close()
    connection = sqlite3.connect(migrated_place)
    connection.execute("UPDATE alembic_version SET version_num = '9999'")
    connection.commit()
    connection.close()
    before = migrated_place.read_bytes()
    for create in (True, False):
        with pytest.raises(StoreError) as caught:
            Store.open(migrated_place, create=create)
        assert caught.value.code == "unknown_schema"
        assert "9999" in str(caught.value)
        assert REVISION in str(caught.value)
    assert migrated_place.read_bytes() == before


def test_migration_is_quiet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "alembic.ini").write_text("[alembic]\nscript_location = nowhere\n")
    monkeypatch.chdir(tmp_path)
    loggers = {name: (logging.getLogger(name).level, len(logging.getLogger(name).handlers)) for name in ("", "alembic")}
    disabled = logging.getLogger("skisnow.test").disabled
    Store.open(tmp_path / "store.sqlite3").close()
    assert capfd.readouterr() == ("", "")
    for name, (level, n_handlers) in loggers.items():
        assert (logging.getLogger(name).level, len(logging.getLogger(name).handlers)) == (level, n_handlers)
    assert logging.getLogger("skisnow.test").disabled == disabled


def test_the_next_migration_starts_from_a_form(tmp_path: Path) -> None:
    copy = tmp_path / "migrations"
    shutil.copytree(HERE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    config = alembic_config()
    config.set_main_option("script_location", str(copy))
    made = command.revision(config, message="A further table", rev_id="9998")
    assert made is not None
    names = runpy.run_path(made.path)  # type: ignore[union-attr]
    assert (names["revision"], names["down_revision"]) == ("9998", REVISION)
    assert callable(names["upgrade"])
    assert callable(names["downgrade"])


def test_a_folder_that_was_flushed_is_closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    handles: list[int] = []
    monkeypatch.setattr(os, "fsync", handles.append)
    _sync_folder(tmp_path)
    (handle,) = handles
    with pytest.raises(OSError, match="Bad file descriptor"):
        os.fstat(handle)
