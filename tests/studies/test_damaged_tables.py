"""A study's table in SQLite that is damaged, or was changed by another program."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.parameters import Quantity
from skisnow.studies import read_table
from skisnow.studies.rows import ROWS_OF_A_BLOCK
from skisnow.studies.writing import write_table
from tests.coded import raises

COLUMNS = ("ski", "load_N", "at_rest", "outcome", "warnings", "study")
KEYS = {
    "ski": Quantity("ski", "", kind="text"),
    "load_N": Quantity("load_N", ""),
    "at_rest": Quantity("at_rest", "", kind="switch"),
}
COUNT = 2 * ROWS_OF_A_BLOCK + 5


def values() -> list[list[Any]]:
    return [["slalom", 700.0 + n, n % 2 == 0, "equilibrium", "", "f"] for n in range(COUNT)]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    path = tmp_path / "table.sqlite"
    write_table(path, COLUMNS, values)
    return path


def change(place: Path, statement: str) -> None:
    with closing(sqlite3.connect(place, isolation_level=None)) as database:
        database.executescript(statement)


def loads(place: Path) -> list[Any]:
    return [row["load_N"] for row in read_table(place, KEYS).rows]


def test_rows_that_another_program_removed_leave_the_others(place: Path) -> None:
    """Blocks are counted by rows, not by their numbers."""
    change(place, "delete from study where rowid <= 3 or rowid = 1500")
    wanted = [row[1] for number, row in enumerate(values(), start=1) if number > 3 and number != 1500]
    assert loads(place) == wanted


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        ("update study set outcome = x'00' where rowid = 1203", ("row 1203", "outcome")),
        ("update study set load_N = 'heavy' where rowid = 1203", ("row 1203", "load_N", "heavy")),
        ("update study set at_rest = x'00' where rowid = 1203", ("row 1203", "at_rest")),
        ("update study set warnings = cast(x'ff' as text) where rowid = 1203", ()),
        ("alter table study drop column outcome", ("outcome",)),
        ("alter table study rename to other", ("study",)),
        ("alter table study rename to other; create view study as select * from other", ("study",)),
    ],
)
def test_what_is_no_table_of_a_study_names_the_place(place: Path, statement: str, named: tuple[str, ...]) -> None:
    change(place, statement)
    with pytest.raises(ParameterError) as caught:
        loads(place)
    assert all(word in str(caught.value) for word in (place.name, *named))


def test_damaged_pages_are_an_error(place: Path) -> None:
    sound = place.read_bytes()
    for begin in range(4096, len(sound), 4096):
        place.write_bytes(sound[:begin] + b"\xa5" * 64 + sound[begin + 64 :])
        with raises(ParameterError, "cannot_read"):
            loads(place)
