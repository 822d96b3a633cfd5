"""Rows that a process keeps: after kills and after damage."""

import os
import random
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import closing
from pathlib import Path

import pytest

from skisnow._support.errors import OutputError, ParameterError
from skisnow._support.processes.batch import run_batch
from skisnow._support.processes.kept_rows import KeptRows, forget, json_text
from tests.coded import raises

POINTS = [[("n", n), ("third", n / 3.0), ("text", 'a "quoted", ü\nline')] for n in range(25)]
ROWS = [dict(point) for point in POINTS]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "rows.partial"


def rows_in(path: Path, fingerprint: str = "f") -> dict[int, object]:
    kept = KeptRows.opened(path, fingerprint)
    try:
        return dict(kept.rows())
    finally:
        kept.close()


def test_a_row_that_cannot_be_kept_is_reported_with_its_file(place: Path) -> None:
    kept = KeptRows.opened(place, "f")
    kept.add([(0, json_text(ROWS[0]))])
    kept._database.execute("pragma max_page_count = 3")  # as a disk that is full
    with raises(OutputError, "cannot_write"):
        kept.add([(number, '{"text":"' + "x" * 9000 + '"}') for number in (1, 2)])
    assert dict(kept.rows()) == {0: ROWS[0]}
    kept.close()


def test_rows_stay_in_a_file_of_their_own_and_go_with_it(place: Path) -> None:
    kept = KeptRows.opened(place, "f", about={"points": "25"})
    assert kept.add([(7, json_text(ROWS[7])), (3, json_text(ROWS[3]))]) == 2
    assert (len(kept), list(kept.numbers()), 3 in kept, 4 in kept) == (2, [3, 7], True, False)
    assert kept.row(7) == ROWS[7]
    assert kept.about()["points"] == "25"
    kept.remove()
    assert not list(place.parent.iterdir())


def test_the_same_row_is_not_taken_twice(place: Path) -> None:
    kept = KeptRows.opened(place, "f")
    kept.add([(0, "{}")])
    with pytest.raises(ParameterError):
        kept.add([(1, "{}"), (0, "{}")])
    assert list(kept.numbers()) == [0]  # all of an addition or none
    kept.close()


def test_rows_of_another_batch_are_rejected_and_two_runs_at_once_are_rejected(place: Path) -> None:
    KeptRows.opened(place, "f").close()
    with raises(ParameterError, "another_study"):
        KeptRows.opened(place, "g")
    KeptRows.opened(place, "f").close()
    first = KeptRows.opened(place, "f")
    for _ in range(2):
        with raises(OutputError, "in_use"):
            KeptRows.opened(place, "f")
    assert first._database.execute("PRAGMA busy_timeout").fetchone() == (0,)  # neither waits for the other
    first.add([(0, "{}")])
    first.close()
    assert rows_in(place) == {0: {}}


def test_rows_that_are_read_are_nobody_elses_meanwhile(place: Path) -> None:
    KeptRows.opened(place, "f").close()
    reader = KeptRows.read(place)
    with raises(OutputError, "in_use"):
        KeptRows.opened(place, "f")
    reader.close()
    KeptRows.opened(place, "f").close()


@pytest.mark.parametrize(
    "change", ["replace(sql, 'primary key', 'xxxxxxxxxxx')", "replace(sql, 'checksum', 'checksux')"]
)
def test_a_file_whose_tables_have_changed_is_damaged(change: str, place: Path) -> None:
    """Without its key a point has no number."""
    kept = KeptRows.opened(place, "f")
    kept.add([(3, "{}")])
    kept.close()
    with closing(sqlite3.connect(place)) as database:
        database.execute("pragma writable_schema = on")
        database.execute(f"update sqlite_master set sql = {change} where name = 'rows'")
        database.commit()
    with raises(ParameterError, "damaged"):
        KeptRows.opened(place, "f")


@pytest.mark.parametrize("damage", [b"what hours have found", b"SQLite format 3\0" + b"\1" * 5000])
def test_a_file_that_is_none_of_rows_is_reported_and_left(damage: bytes, place: Path) -> None:
    place.write_bytes(damage)
    with raises(ParameterError, "damaged"):
        KeptRows.opened(place, "f")
    assert place.read_bytes() == damage
    with raises(ParameterError, "damaged"):
        KeptRows.read(place)


def test_a_database_of_something_else_is_reported_and_left(place: Path) -> None:
    other = sqlite3.connect(place)
    other.execute("create table about (name, value)")
    other.commit()
    other.close()
    with raises(ParameterError, "damaged"):
        KeptRows.opened(place, "f")
    with raises(ParameterError, "damaged"):
        KeptRows.read(place)


def test_a_log_without_its_file_is_no_part_of_a_new_one(place: Path) -> None:
    """Somebody removed the file that a kill left, and not the log beside it."""
    script = "from skisnow._support.processes.kept_rows import *; from pathlib import Path; import os, signal, sys\n"
    script += "kept = KeptRows.opened(Path(sys.argv[1]), 'f'); kept.add([(0, '{}')])\n"
    script += "os.kill(os.getpid(), signal.SIGKILL)"
    subprocess.run([sys.executable, "-c", script, str(place)], check=False)
    log = place.with_name("rows.partial-wal")
    left = log.read_bytes()
    assert rows_in(place) == {0: {}}
    forget(place)
    log.write_bytes(left)
    assert rows_in(place, "g") == {}


def test_numbers_come_back_with_every_digit(place: Path) -> None:
    def many() -> Iterator[float]:
        yield from (0.1 + 0.2, 1e-320, 1.7976931348623157e308, -0.0, 1 / 3)

    points = [[("x", x)] for x in many()]
    kept = KeptRows.opened(place, "f")
    run_batch(points, dict, kept=kept, workers=1)
    kept.close()
    opened = KeptRows.opened(place, "f")
    assert [repr(opened.row(n)["x"]) for n in range(len(points))] == [repr(x) for x in many()]
    opened.close()


KEEPER = """
import sys
from pathlib import Path
from skisnow._support.processes.kept_rows import KeptRows
kept = KeptRows.opened(Path(sys.argv[1]), "f")
number = len(kept)
print(number, flush=True)
while True:
    new = range(number, number + 1 + number % 7)
    kept.add((n, '{"n":%d,"text":"%s"}' % (n, "x" * (n % 3000))) for n in new)
    number = new.stop
    print(number, flush=True)
"""


def killed_again_and_again(place: Path, kills: int, seed: int) -> None:
    """Rows reported as kept are there, and no halves; each goes on where the one before was killed."""
    rng, before = random.Random(seed), 0
    for _ in range(kills):
        with subprocess.Popen([sys.executable, "-c", KEEPER, str(place)], stdout=subprocess.PIPE) as keeper:
            assert keeper.stdout is not None
            assert int(keeper.stdout.readline()) >= before
            said = [keeper.stdout.readline() for _ in range(rng.randrange(1, 60))]
            os.kill(keeper.pid, signal.SIGKILL)
            said += keeper.stdout.readlines()
        whole = [line for line in said if line.endswith(b"\n")]
        kept = KeptRows.opened(place, "f")
        numbers = list(kept.numbers())
        assert numbers == list(range(len(numbers)))
        assert len(numbers) >= int(whole[-1])
        assert all(row == {"n": n, "text": "x" * (n % 3000)} for n, row in kept.rows() if n >= before)
        before = len(numbers)
        kept.close()


def test_killed_at_any_moment_nothing_taken_is_lost_and_none_is_there_twice(place: Path) -> None:
    killed_again_and_again(place, 3, seed=1)


@pytest.mark.slow
def test_a_hundred_kills(place: Path) -> None:
    killed_again_and_again(place, 100, seed=2)


DAMAGED_ROWS = {number: {"n": number, "text": "x" * 400} for number in range(40)}


@pytest.fixture
def damaged_place(tmp_path: Path) -> Path:
    path = tmp_path / "rows.partial"
    kept = KeptRows.opened(path, "f", about={"points": "40"})
    kept.add((number, json_text(row)) for number, row in DAMAGED_ROWS.items())
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


def test_sound_rows_are_read(damaged_place: Path) -> None:
    assert read_all(damaged_place) == DAMAGED_ROWS


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
def test_a_change_of_the_content_is_an_error(damaged_place: Path, statement: str) -> None:
    with closing(sqlite3.connect(damaged_place, isolation_level=None)) as database:
        database.executescript(statement)
    with pytest.raises(ParameterError) as caught:
        read_all(damaged_place)
    assert damaged_place.name in str(caught.value)


def test_damaged_pages_are_an_error(damaged_place: Path) -> None:
    """Each page in turn, its head and its content."""
    sound = damaged_place.read_bytes()
    for begin in range(0, len(sound), 4096):
        for at in (begin + (100 if begin == 0 else 0), begin + 2000):
            damaged_place.write_bytes(sound[:at] + b"\xa5" * 64 + sound[at + 64 :])
            try:
                assert read_all(damaged_place) == DAMAGED_ROWS  # where the place is not used
            except ParameterError as error:
                assert damaged_place.name in str(error)


def test_rows_that_are_gone_are_computed_again(damaged_place: Path) -> None:
    with closing(sqlite3.connect(damaged_place, isolation_level=None)) as database:
        database.execute("delete from rows where number in (3, 39)")
    assert read_all(damaged_place) == {number: row for number, row in DAMAGED_ROWS.items() if number not in (3, 39)}
