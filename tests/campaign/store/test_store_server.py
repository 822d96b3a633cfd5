"""A group's store on a PostgreSQL server does what the one in a file does, and tells no password."""

import logging
import sqlite3
import subprocess
import sys
import traceback
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, create_engine, make_url, text
from tests.coded import raises
from tests.present import present

from skisnow._support.errors import StoreError
from skisnow.campaign.store import Journals, Store, replay_journal, store_place
from skisnow.campaign.store import server as server_module
from skisnow.campaign.store.engine import database_errors, writing
from skisnow.campaign.store.engine import reading as reading_of
from skisnow.campaign.store.migrations import alembic_config, downgrade, upgrade
from skisnow.campaign.store.schema import APPLICATION_ID, MARK, REVISION, metadata
from skisnow.campaign.store.server import _CONNECTING, _STATES, ServerAddress, broken_references, open_server, reason

from .postgresql_server import PASSWORD, QUOTED, Server
from .test_journal import campaign_with, reading
from .test_store import FILES, contents, write


@pytest.fixture
def address(server: Server) -> str:
    return server.emptied()


def test_a_campaign_is_given_back_byte_for_byte(address: str, tmp_path: Path) -> None:
    folder = write(tmp_path / "campaign", FILES)
    with Store.open(tmp_path / "store.sqlite3") as file, Store.open(address) as store:
        added = store.add(folder)
        assert added.id == file.add(folder).id
        assert store.add(folder).already_stored
        store.export(added.id[:4], tmp_path / "out")
        (ours,), (its,) = store.list(), file.list()
        assert [each.path for each in ours.files] == [each.path for each in its.files]
        assert store.verify() == ()
    assert contents(tmp_path / "out") == FILES


@pytest.mark.parametrize(
    ("statements", "said"),
    [
        (["UPDATE chunk SET data = '\\x00' WHERE position = 2"], "SMP.PNT: the bytes"),
        (["UPDATE campaign SET added_at = 'yesterday'"], "is damaged"),
        (["SET session_replication_role = replica", "DELETE FROM content WHERE size = 0"], "table campaign_file"),
        (["UPDATE journal_entry SET cells = replace(cells, '2.25', '2.35') WHERE sequence = 3"], "row 2, entry 3"),
    ],
)
def test_verify_finds(server: Server, statements: list[str], said: str, tmp_path: Path) -> None:
    address = server.new_database() if "DROP" in statements[0] else server.emptied()
    with Store.open(address) as store:
        store.add(write(tmp_path / "campaign", FILES))
        campaign_with(Journals(store), "1.5", "2.25")
        assert store.verify() == ()
        server.execute(*statements, database=str(store.path).rpartition("/")[2])
        found = [str(finding) for finding in store.verify()]
    assert any(said in finding for finding in found), found


def test_tables_equal_migrations_in_both_directions(server: Server) -> None:
    with Store.open(server.new_database()) as store:
        with store.engine.connect() as connection:
            context = MigrationContext.configure(connection, opts={"compare_type": True})
            assert compare_metadata(context, metadata) == []
        revisions = [script.revision for script in ScriptDirectory.from_config(alembic_config()).walk_revisions()]
        for _ in revisions:
            with writing(store.engine) as connection:
                downgrade(connection, "-1")
        with writing(store.engine) as connection:
            upgrade(connection)
        with store.engine.connect() as connection:
            assert compare_metadata(MigrationContext.configure(connection), metadata) == []
            assert connection.execute(text("SELECT version_num FROM alembic_version")).scalar_one() == REVISION


ENTER = """
import sys
from skisnow.campaign.store import Journals, NewEntry, Store
address, id_, who = sys.argv[1:]
print("ready", flush=True)
sys.stdin.readline()
with Store.open(address) as store:
    for number in range(20):
        cells = {"experiment": f"{who}{number}", "load_N": "20", "depth_mm": "1"}
        entry = NewEntry(action="add", file="penetration.csv", test=f"{who}{number}", position=0, cells=cells, who=who)
        Journals(store).append(id_, entry, seen=0)
"""


def test_two_who_write_at_once_lose_nothing(server: Server) -> None:
    """They race to make the tables; then each enters twenty tests."""
    address = server.new_database()
    with Store.open(address) as store:
        id_, _ = campaign_with(Journals(store))
    names = ("first", "second")
    writers = [
        subprocess.Popen(
            [sys.executable, "-W", "error", "-c", ENTER, address, id_, who],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for who in names
    ]
    for writer in writers:
        assert present(writer.stdout).readline() == "ready\n"
    for writer in writers:
        present(writer.stdin).write("go\n")
        present(writer.stdin).flush()
    assert [writer.communicate(timeout=300)[1] for writer in writers] == ["", ""]
    with Store.open(address, create=False) as store:
        entries = Journals(store).entries(id_)
        assert store.verify() == ()
    assert sorted(entry.test for entry in entries[1:]) == sorted(
        f"{who}{number}" for who in names for number in range(20)
    )
    assert [entry.sequence for entry in entries] == list(range(1, 42))


def test_a_writer_waits_for_the_other_and_says_when_it_was_too_long(address: str) -> None:
    with Store.open(address) as store, Store.open(address, busy_timeout_s=0.05) as other:
        with writing(store.engine), pytest.raises(StoreError, match="locked"):
            Journals(other).begin('name = "a"\n')
        assert Journals(other).list() == ()
        Journals(other).begin('name = "a"\n')
        assert len(Journals(store).list()) == 1


def test_reading_sees_one_state_and_writes_nothing(address: str) -> None:
    with Store.open(address) as store:
        with reading_of(store.engine) as connection:
            count = text("SELECT count(*) FROM journal")
            assert connection.execute(count).scalar_one() == 0
            Journals(store).begin('name = "a"\n')
            assert connection.execute(count).scalar_one() == 0
        with pytest.raises(StoreError, match="read-only"), store_errors(store), reading_of(store.engine) as again:
            again.execute(text("DELETE FROM journal"))


def store_errors(store: Store) -> AbstractContextManager[None]:
    return database_errors(store.path, "not_written")


def test_a_connection_that_breaks_is_reported_and_the_next_one_works(server: Server, address: str) -> None:
    with Store.open(address) as store:
        id_, last = campaign_with(Journals(store), "1.5")
        with pytest.raises(StoreError, match="connection"), store_errors(store), writing(store.engine) as connection:
            connection.execute(text("DELETE FROM journal_entry"))
            server.execute("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = 'emptied'")
            connection.execute(text("SELECT 1"))
        Journals(store).append(id_, reading("1", 1, "40", "2"), seen=last)
        assert len(replay_journal(Journals(store).entries(id_)).test("penetration.csv", "1").rows) == 2


# Addresses, passwords, refusals


@pytest.mark.parametrize(
    ("login", "database", "said"),
    [
        ("ada:not-the-word", "emptied", "is wrong"),
        ("ada", "emptied", "PGPASSWORD"),
        (f"ada:{QUOTED}", "nowhere", "does not exist"),
        (f"ada:{QUOTED}", "emptied?sslmode=require", "SSL"),
    ],
)
def test_refusals_are_reported_in_one_sentence_without_the_password(
    server: Server, login: str, database: str, said: str, caplog: pytest.LogCaptureFixture
) -> None:
    server.emptied()
    server.execute("DROP DATABASE IF EXISTS bare", "CREATE DATABASE bare")
    with caplog.at_level(logging.DEBUG), pytest.raises(StoreError, match=said) as refused:
        Store.open(server.over_the_network(database, login=login))
    told = "".join(traceback.format_exception(refused.value)) + caplog.text
    assert all(word not in told for word in (PASSWORD, QUOTED, "not-the-word"))
    assert "\n" not in str(refused.value)
    assert str(refused.value).startswith(
        f"The store postgresql://ada@127.0.0.1:{server.port}/{database.split('?', maxsplit=1)[0]}"
    )


def test_a_server_that_is_not_there(server: Server) -> None:
    with pytest.raises(StoreError, match="cannot be reached"):
        Store.open("postgresql://ada:secret@127.0.0.1:1/group")
    with pytest.raises(StoreError, match="cannot be reached"):
        Store.open(f"postgresql://ada:secret@/group?host={server.folder}/nowhere")


@pytest.mark.parametrize(
    "address", ["postgresql://ada:secret@host:port/group", "postgresql://ada:secret@host/", "mysql://ada:secret@host/x"]
)
def test_addresses_that_are_none(address: str) -> None:
    with pytest.raises(StoreError, match="postgresql://USER@HOST/DATABASE") as refused:
        Store.open(address)
    assert "secret" not in "".join(traceback.format_exception(refused.value))


def test_an_address_is_shown_without_its_password() -> None:
    place = store_place("postgres://ada:secret@snow.example:5433/group?sslpassword=hidden")
    assert (str(place), "secret" in repr(place)) == ("postgresql://ada@snow.example:5433/group", False)
    with raises(StoreError, "not_an_address"):
        Store.open(Path("postgresql://ada@host/group"))
    with raises(StoreError, "no_database"):
        store_place("postgresql://ada@host")


def test_with_a_password_over_the_network(server: Server, tmp_path: Path) -> None:
    server.execute("DROP DATABASE IF EXISTS hers", "CREATE DATABASE hers OWNER ada")
    with Store.open(server.over_the_network("hers", login=f"ada:{QUOTED}")) as store:
        assert store.add(write(tmp_path / "campaign", {"a": b"a"})).n_files == 1
        assert PASSWORD not in repr(store)


def test_a_user_with_read_permission_can_read(server: Server, address: str, tmp_path: Path) -> None:
    with Store.open(address) as store:
        id_ = store.add(write(tmp_path / "campaign", {"a": b"a"})).id
    server.execute("GRANT SELECT ON ALL TABLES IN SCHEMA public TO guest", database="emptied")
    with Store.open(server.address("emptied", user="guest")) as store:
        assert store.show(id_).n_files == 1
        with pytest.raises(StoreError, match="not allowed"):
            store.add(write(tmp_path / "other", {"b": b"b"}))


def test_other_databases_are_left_alone(server: Server) -> None:
    foreign = server.new_database()
    name = foreign.split("/")[3].split("?")[0]
    server.execute("CREATE TABLE campaign (id int)", database=name)
    with pytest.raises(StoreError, match="another program"):
        Store.open(foreign)
    latin = server.new_database("ENCODING 'LATIN1' TEMPLATE template0")
    with pytest.raises(StoreError, match="LATIN1"):
        Store.open(latin)
    with pytest.raises(StoreError, match="no store at"):
        Store.open(server.new_database(), create=False)


def test_what_is_missing_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with raises(StoreError, "not_installed", name="psycopg"):
        Store.open("postgresql://ada@host/group")


# Without a server: SQLite with PostgreSQL's functions

ADDRESS = ServerAddress(make_url("postgresql+psycopg://ada:secret@host/group?connect_timeout=5"))


class RefusalError(Exception):
    """An error of the driver with its code, which may be inside another error."""

    def __init__(self, sqlstate: str | None, said: str, orig: Exception | None = None) -> None:
        super().__init__(said)
        self.sqlstate, self.orig = sqlstate, orig


def test_reasons_of_refusals() -> None:
    for state, words in _STATES.items():
        assert reason(RefusalError(None, "outer", RefusalError(state, "timed out")), ADDRESS) == words
    for part, words in _CONNECTING:
        assert [reason(RefusalError(state, f"x {part}"), ADDRESS) for state in (None, "08001", "57P01")] == [words] * 3
        assert reason(RefusalError("22012", f"\n {part} secret...\nmore"), ADDRESS) == f"{part} ***"
    assert reason(RefusalError(None, " \n"), ServerAddress(make_url("postgresql://host/group"))) == "RefusalError"


class Cursor(sqlite3.Cursor):
    """A cursor that notes what is set for the session."""

    settings: dict[str, str] = {}  # noqa: RUF012

    def execute(self, statement: str, parameters: Any = ()) -> "Cursor":
        if statement.startswith("SELECT set_config"):
            self.settings[parameters[0]] = parameters[1]
            return self
        super().execute(statement.replace("SHOW server_encoding", "SELECT encoding()"), parameters)
        return self

    def __enter__(self) -> "Cursor":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Connected(sqlite3.Connection):
    """A connection to a file that answers as PostgreSQL does."""

    autocommit = False

    def cursor(self, *_: object) -> Cursor:  # type: ignore[override]
        return super().cursor(Cursor)


@pytest.fixture
def answers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """Answers of the functions, which a test may change; opened stores are on one file."""
    told: dict[str, Any] = {"encoding": "UTF8", "comment": MARK, "locks": []}

    def connect() -> sqlite3.Connection:
        connection = sqlite3.connect(tmp_path / "file", factory=Connected)
        connection.create_function("encoding", 0, lambda: told["encoding"])
        connection.create_function("pg_advisory_xact_lock", 1, told["locks"].append)
        connection.create_function("obj_description", 2, lambda name, _: told["comment"] if name == "campaign" else "")
        for name, count in (("quote_ident", 1), ("to_regnamespace", 1), ("current_schema", 0)):
            connection.create_function(name, count, lambda *_: "public")
        connection.execute(
            "CREATE TEMP VIEW pg_class AS SELECT name AS relname, name AS oid, 'public' AS relnamespace, "
            "'r' AS relkind FROM main.sqlite_master WHERE type = 'table'"
        )
        return connection

    def engine(_: object, **options: Any) -> Engine:
        told["options"] = options
        return create_engine("sqlite://", creator=connect)

    monkeypatch.setattr(server_module, "create_engine", engine)
    return told


def test_a_database_becomes_a_store_once(answers: dict[str, Any]) -> None:
    with raises(StoreError, "no_store", address=str(ADDRESS)):
        open_server(ADDRESS, create=False, busy_timeout_s=2.5)
    assert Cursor.settings["lock_timeout"] == "2500ms"
    assert Cursor.settings["idle_in_transaction_session_timeout"] == "300s"
    options = answers["options"]
    assert (options["pool_pre_ping"], options["hide_parameters"]) == (True, True)
    assert options["connect_args"]["tcp_user_timeout"] == "60000"
    assert "connect_timeout" not in options["connect_args"]
    engine = open_server(ADDRESS, create=True, busy_timeout_s=1e-9)
    assert (Cursor.settings["lock_timeout"], answers["locks"]) == ("1ms", [APPLICATION_ID])
    open_server(ADDRESS, create=False, busy_timeout_s=1.0)
    assert answers["locks"] == [APPLICATION_ID]
    with engine.begin() as connection:
        assert connection.execute(text("SELECT * FROM alembic_version")).scalar_one() == REVISION
        assert list(broken_references(connection)) == []
        for position in (1, 2):
            values = {"sha256": "ab", "position": position, "data": b"a"}
            connection.execute(metadata.tables["chunk"].insert().values(values))
        assert list(broken_references(connection)) == [("chunk", "content", 2)]


@pytest.mark.parametrize(
    ("statement", "answer", "code"),
    [
        ("SELECT '{}'", {"encoding": "LATIN1"}, "wrong_encoding"),
        ("SELECT '{}'", {"comment": "another"}, "other_database"),
        ("DROP TABLE {}", {}, "other_database"),
        ("DELETE FROM {}", {}, "damaged"),
        ("UPDATE {} SET {} = 9999", {}, "unknown_schema"),
    ],
)
def test_other_databases(answers: dict[str, Any], statement: str, answer: dict[str, str], code: str) -> None:
    with open_server(ADDRESS, create=True, busy_timeout_s=1.0).begin() as connection:
        connection.execute(text(statement.format("alembic_version", "version_num")))
    answers |= answer
    place = {"place" if code == "unknown_schema" else "address": str(ADDRESS)}
    with raises(StoreError, code, **place):
        open_server(ADDRESS, create=True, busy_timeout_s=1.0)
