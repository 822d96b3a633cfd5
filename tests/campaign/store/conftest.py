"""Stores in a file and on a server."""

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from skisnow.campaign.store import Store

from .postgresql_server import Server, started, why_there_is_none


@pytest.fixture(scope="session")
def server() -> Iterator[Server]:
    """A PostgreSQL server, started once."""
    if (why := why_there_is_none()) is not None:
        pytest.skip(why)
    with started() as running:
        yield running


@pytest.fixture(scope="session")
def empty_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store that holds nothing, to be copied: making one takes as long as a test."""
    place = tmp_path_factory.mktemp("empty") / "store.sqlite3"
    Store.open(place).close()
    return place


@contextmanager
def opened(place: Path | str) -> Iterator[Store]:
    """A store in a file that is held open besides: else its log is put away behind each piece of work."""
    with Store.open(place) as store, closing(sqlite3.connect(place)) as beside:
        beside.execute("SELECT * FROM journal").fetchall()
        yield store


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Place of a store that does not exist, in a folder that does not exist either."""
    return tmp_path / "deep" / "store.sqlite3"


@pytest.fixture(params=["file", "server"])
def store(request: pytest.FixtureRequest, empty_file: Path, tmp_path: Path) -> Iterator[Store]:
    """An empty store, in a file or on the server."""
    if request.param == "file":
        with opened(shutil.copy(empty_file, tmp_path / "store.sqlite3")) as store:
            yield store
        return
    with Store.open(request.getfixturevalue("server").emptied()) as store:
        yield store


@pytest.fixture
def group(request: pytest.FixtureRequest, empty_file: Path, tmp_path: Path) -> Iterator[Store]:
    """An empty store on the server; in a file without a server."""
    if why_there_is_none() is None:
        place = request.getfixturevalue("server").emptied()
    else:
        place = shutil.copy(empty_file, tmp_path / "group.sqlite3")
    with Store.open(place) as store:
        yield store
