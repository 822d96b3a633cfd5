"""Empty stores."""

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from skisnow.campaign.store import Store


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


@pytest.fixture
def store(empty_file: Path, tmp_path: Path) -> Iterator[Store]:
    """An empty store."""
    with opened(shutil.copy(empty_file, tmp_path / "store.sqlite3")) as store:
        yield store


@pytest.fixture
def group(empty_file: Path, tmp_path: Path) -> Iterator[Store]:
    """An empty store of a group."""
    with Store.open(shutil.copy(empty_file, tmp_path / "group.sqlite3")) as store:
        yield store
