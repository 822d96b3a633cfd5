"""The migrations lead to the tables of the program, from any start, quietly and from anywhere."""

import logging
import runpy
import shutil
import sqlite3
from pathlib import Path

import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory

import skisnow.campaign.store.migrations
from skisnow._support.errors import StoreError
from skisnow.campaign.store import Store
from skisnow.campaign.store.engine import writing
from skisnow.campaign.store.migrations import alembic_config, downgrade, is_known, upgrade
from skisnow.campaign.store.schema import APPLICATION_ID, REVISION, metadata

HERE = Path(skisnow.campaign.store.migrations.__file__).parent


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "store.sqlite3"


def schema(place: Path) -> dict[str, str]:
    """Each table and index with its SQL, blanks apart."""
    connection = sqlite3.connect(place)
    rows = connection.execute("SELECT name, sql FROM sqlite_master WHERE name <> 'alembic_version'").fetchall()
    connection.close()
    return {name: "".join((sql or "").split()) for name, sql in rows if not name.startswith("sqlite_autoindex_alembic")}


def test_tables_equal_migrations(place: Path) -> None:
    with Store.open(place) as store, store.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True, "compare_server_default": True})
        assert compare_metadata(context, metadata) == []


def test_an_upgraded_empty_store_has_the_schema_of_a_new_one(place: Path, tmp_path: Path) -> None:
    with Store.open(place) as store, writing(store.engine) as connection:
        downgrade(connection, "base")
    assert schema(place) == {}
    Store.open(place).close()
    Store.open(tmp_path / "new.sqlite3").close()
    assert schema(place) == schema(tmp_path / "new.sqlite3")
    assert {"campaign", "content", "chunk", "campaign_file", "journal", "journal_entry"} <= schema(place).keys()


def test_the_program_knows_its_newest_migration() -> None:
    script = ScriptDirectory.from_config(alembic_config())
    assert script.get_heads() == [REVISION]
    assert is_known(REVISION)
    assert not any(map(is_known, ("9999", "", REVISION[:2])))


def test_every_migration_goes_down_and_up_again(place: Path) -> None:
    Store.open(place).close()
    new = schema(place)
    revisions = [script.revision for script in ScriptDirectory.from_config(alembic_config()).walk_revisions()]
    with Store.open(place) as store:
        for _ in revisions:
            with writing(store.engine) as connection:
                downgrade(connection, "-1")
        assert schema(place) == {}
        with writing(store.engine) as connection:
            upgrade(connection)
        assert schema(place) == new
        with store.engine.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA application_id").scalar_one() == APPLICATION_ID
            assert connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalar_one() == REVISION


def test_a_migration_that_fails_changes_nothing(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def breaks(connection: object) -> None:
        upgrade(connection)  # type: ignore[arg-type]
        raise ZeroDivisionError

    monkeypatch.setattr("skisnow.campaign.store.migrations.upgrade", breaks)
    with pytest.raises(ZeroDivisionError):
        Store.open(place)
    assert schema(place) == {}
    monkeypatch.undo()
    with Store.open(place) as store:
        assert store.list() == ()


def test_rows_that_point_nowhere_stop_a_migration(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def orphans(connection: object) -> None:
        upgrade(connection)  # type: ignore[arg-type]
        connection.exec_driver_sql("INSERT INTO chunk VALUES ('a', 0, x'00')")  # type: ignore[attr-defined]

    monkeypatch.setattr("skisnow.campaign.store.migrations.upgrade", orphans)
    with pytest.raises(StoreError, match="point nowhere"):
        Store.open(place)
    assert schema(place) == {}


def test_a_newer_store_is_refused_and_left_alone(place: Path) -> None:
    Store.open(place).close()
    connection = sqlite3.connect(place)
    connection.execute("UPDATE alembic_version SET version_num = '9999'")
    connection.commit()
    connection.close()
    before = place.read_bytes()
    for create in (True, False):
        with pytest.raises(StoreError) as caught:
            Store.open(place, create=create)
        assert caught.value.code == "unknown_schema"
        assert "9999" in str(caught.value)
        assert REVISION in str(caught.value)
    assert place.read_bytes() == before


def test_migrating_is_quiet_and_needs_no_ini(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
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
