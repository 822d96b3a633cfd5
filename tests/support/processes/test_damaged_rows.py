"""A damaged file of finished points is one error that names it, whatever is damaged in it."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.processes.kept_rows import KeptRows, row_text

ROWS = {number: {"n": number, "text": "x" * 400} for number in range(40)}


@pytest.fixture
def place(tmp_path: Path) -> Path:
    path = tmp_path / "rows.partial"
    kept = KeptRows.opened(path, "f", about={"points": "40"})
    kept.add((number, row_text(row)) for number, row in ROWS.items())
    kept.close()
    with closing(sqlite3.connect(path)) as database:
        database.execute("pragma journal_mode = delete")
    return path


def read_all(path: Path) -> Mapping[int, object]:
    kept = KeptRows.opened(path, "f")
    try:
        return {number: kept.row(number) for number in kept.numbers()} | dict(kept.rows())
    finally:
        kept.close()


def test_sound_rows_are_read(place: Path) -> None:
    assert read_all(place) == ROWS


@pytest.mark.parametrize(
    "statement",
    [
        "update rows set row = replace(row, 'x', 'y') where number = 7",
        "update rows set row = 5 where number = 7",
        "update rows set row = cast(x'ff' as text) where number = 7",
        "update rows set number = 1000 where number = 7",
        "update rows set checksum = 0 where number = 7",
        "update about set value = '41' where name = 'points'",
        "delete from about where name = 'fingerprint'",
        "delete from about",
        "alter table rows drop column checksum",
        "alter table rows rename column row to words",
        "drop table rows",
        "alter table rows rename to r; create view rows as select * from r",
        "insert into rows values (-1, '{}', 0)",
    ],
)
def test_a_change_of_the_content_is_an_error(place: Path, statement: str) -> None:
    with closing(sqlite3.connect(place, isolation_level=None)) as database:
        database.executescript(statement)
    with pytest.raises(ParameterError) as caught:
        read_all(place)
    assert place.name in str(caught.value)


def test_damaged_pages_are_an_error(place: Path) -> None:
    """Each page in turn, its head and its content."""
    sound = place.read_bytes()
    for begin in range(0, len(sound), 4096):
        for at in (begin + (100 if begin == 0 else 0), begin + 2000):
            place.write_bytes(sound[:at] + b"\xa5" * 64 + sound[at + 64 :])
            try:
                assert read_all(place) == ROWS  # where the place is not used
            except ParameterError as error:
                assert place.name in str(error)


def test_rows_that_are_gone_are_computed_again(place: Path) -> None:
    with closing(sqlite3.connect(place, isolation_level=None)) as database:
        database.execute("delete from rows where number in (3, 39)")
    assert read_all(place) == {number: row for number, row in ROWS.items() if number not in (3, 39)}
