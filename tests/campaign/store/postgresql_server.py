"""A PostgreSQL server for tests: started once in a session, from the programs of the system's packages."""

import ctypes
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from skisnow.campaign.store import Store

EMPTIED = "emptied"
PASSWORD = "pa:ss@w/ord%"
QUOTED = "pa%3Ass%40w%2Ford%25"
PLACES = ("/usr/lib/postgresql/*/bin", "/usr/pgsql-*/bin", "/opt/homebrew/opt/postgresql*/bin", "/usr/local/pgsql/bin")


@dataclass(frozen=True)
class Server:
    """A server that runs: on a socket in its folder, open to all, and on a port, where a password is asked."""

    folder: Path
    programs: Path
    port: int
    numbers: Iterator[int]

    def address(self, database: str, *, user: str = "postgres") -> str:
        return f"postgresql://{user}@/{database}?host={self.folder}&port={self.port}"

    def over_the_network(self, database: str, *, login: str) -> str:
        return f"postgresql://{login}@127.0.0.1:{self.port}/{database}"

    def new_database(self, extra: str = "") -> str:
        """The address of an empty database."""
        name = f"store{next(self.numbers)}"
        self.execute(f"CREATE DATABASE {name} {extra}")
        return self.address(name)

    def emptied(self) -> str:
        """The address of a store that holds nothing, the same each time."""
        address = self.address(EMPTIED)
        if not self.execute(f"SELECT 1 FROM pg_database WHERE datname = '{EMPTIED}'"):
            self.execute(f"CREATE DATABASE {EMPTIED}")
            Store.open(address).close()
        self.execute("TRUNCATE campaign, content, chunk, campaign_file, journal, journal_entry", database=EMPTIED)
        return address

    def execute(self, *statements: str, database: str = "postgres") -> list[Any]:
        """Carry statements out, each by itself; the rows of the last one."""
        import psycopg

        with psycopg.connect(self.address(database), autocommit=True) as connection:
            for statement in statements[:-1]:
                connection.execute(statement.encode())
            cursor = connection.execute(statements[-1].encode())
            return cursor.fetchall() if cursor.description else []


def why_there_is_none() -> str | None:
    """Why no server can be started here; None where one can."""
    if os.name == "nt":
        return "the server is started on a socket"
    try:
        import psycopg  # noqa: F401
    except ImportError:
        return "psycopg is not installed"
    return (
        None if programs() is not None else "PostgreSQL's programs are not installed (Debian: apt install postgresql)"
    )


def programs() -> Path | None:
    """The folder of the newest initdb."""
    found = [Path(place) for pattern in PLACES for place in Path("/").glob(pattern[1:])]
    found = sorted((place for place in found if (place / "initdb").exists()), key=_version)
    on_path = shutil.which("initdb")
    return found[-1] if found else Path(on_path).resolve().parent if on_path else None


def _version(place: Path) -> int:
    digits = "".join(letter for letter in place.parent.name if letter.isdigit())
    return int(digits or 0)


@contextmanager
def started() -> Iterator[Server]:
    """Start a server and stop it in the end; nothing of it stays."""
    where = programs()
    assert where is not None
    folder = Path(tempfile.mkdtemp(prefix="skisnow-pg-", dir="/tmp"))  # the path of a socket must be short
    if os.geteuid() == 0:  # which the server refuses to run as
        shutil.chown(folder, "nobody")
    server = Server(folder, where, _free_port(), count(1))
    try:
        run(folder, where / "initdb", "-D", folder / "data", "-U", "postgres", "-A", "trust", "-E", "UTF8", "--no-sync",
            "--no-instructions", "--locale=C")  # fmt: skip
        hosts = "local all all trust\nhost all all 127.0.0.1/32 scram-sha-256\n"
        (folder / "data" / "pg_hba.conf").write_text(hosts)
        with running(server):
            server.execute(f"CREATE ROLE ada LOGIN PASSWORD '{PASSWORD}'", "CREATE ROLE guest LOGIN")
            yield server
    finally:
        shutil.rmtree(folder)


@contextmanager
def running(server: Server) -> Iterator[None]:
    """The server itself, which also ends where the tests are killed."""
    import psycopg

    words: list[object] = [server.programs / "postgres", "-D", server.folder / "data", "-k", server.folder]
    words += ["-p", server.port, "-c", "listen_addresses=127.0.0.1", "-c", "fsync=off", "-c", "shared_buffers=16MB"]
    with (server.folder / "log").open("w") as log:
        process = subprocess.Popen(
            list(map(str, words)),
            cwd=server.folder,
            stdout=log,
            stderr=log,
            preexec_fn=_end_with_parent,  # noqa: PLW1509 (the tests have no threads by then)
            **_as_nobody(),
        )
    try:
        give_up = time.monotonic() + 60
        while True:
            try:
                server.execute("SELECT 1")
                break
            except psycopg.OperationalError:
                assert process.poll() is None and time.monotonic() < give_up, (server.folder / "log").read_text()
                time.sleep(0.02)
        yield
    finally:
        process.send_signal(signal.SIGQUIT)  # at once, and without a last word on the disk
        process.wait(60)


def run(folder: Path, *command: object) -> None:
    subprocess.run(
        list(map(str, command)), cwd=folder, check=True, stdout=subprocess.DEVNULL, timeout=60, **_as_nobody()
    )


def _as_nobody() -> dict[str, Any]:
    return {"user": "nobody", "group": "nogroup"} if os.geteuid() == 0 else {}


def _end_with_parent() -> None:
    if sys.platform == "linux":
        set_death_signal = 1
        ctypes.CDLL(None).prctl(set_death_signal, signal.SIGQUIT)


def _free_port() -> int:
    with closing(socket.socket()) as asked:
        asked.bind(("127.0.0.1", 0))
        port: int = asked.getsockname()[1]
        return port
