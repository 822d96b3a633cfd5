"""Mutated files of every reader are read or rejected in the project's own words, and single faults are noticed."""

import os
import signal
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError, RangeWarning

from .batch import read_rows, run_batch, run_batches
from .case import Fault, run_case
from .reader import Reader
from .registry import READERS
from .texts import TABLE

READY = [reader for reader in READERS if reader.is_ready]
CASES = 200
"""Of all readers together."""


def faults_of(reader: Reader, numbers: range, folder: Path) -> list[Fault]:
    return [fault for number in numbers for fault in run_case(reader, number, folder).faults]


@pytest.mark.parametrize("reader", READY, ids=lambda reader: reader.name)
def test_mutated_files(reader: Reader, tmp_path: Path) -> None:
    assert faults_of(reader, range(-(-CASES // len(READY))), tmp_path) == []


@pytest.mark.slow
@pytest.mark.parametrize("reader", READY, ids=lambda reader: reader.name)
def test_many_mutated_files(reader: Reader) -> None:
    assert [row for row in run_batch(reader, range(10_000, 12_000)) if row["row"] == "fault"] == []


def made_up(read: Callable[[Path], object], name: str = "made up") -> Reader:
    return Reader(
        name=name, target="a.csv", files=lambda: {"a.csv": b"x,y\n1,2\n3,4\n"}, read=read, mutations=TABLE, covers=()
    )


def raising(error: BaseException) -> Callable[[Path], object]:
    def read(_: Path) -> object:
        raise error

    return read


def warning(category: type[Warning]) -> Callable[[Path], object]:
    return lambda _: warnings.warn("x", category, stacklevel=1)


@pytest.mark.parametrize(
    ("read", "kinds"),
    [
        (raising(ParameterError("a.csv: wrong")), []),
        (raising(ValueError("x")), ["traceback"]),
        (raising(MemoryError()), ["traceback"]),
        (raising(OSError("x")), ["traceback"]),
        (raising(RecursionError("x")), ["traceback"]),
        (warning(RangeWarning), []),
        (warning(RuntimeWarning), ["warning"]),
    ],
)
def test_what_counts_as_a_fault(read: Callable[[Path], object], kinds: list[str], tmp_path: Path) -> None:
    assert [fault.kind for fault in run_case(made_up(read), 1, tmp_path).faults] == kinds


def test_nothing_of_a_case_is_left(tmp_path: Path) -> None:
    def litter(folder: Path) -> None:
        (folder / "more").mkdir()
        (folder / "more" / "file").touch()

    run_case(made_up(litter), 1, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_case_that_kills_its_process_or_takes_memory_is_named_and_the_others_go_on(tmp_path: Path) -> None:
    """The second case dies, the third takes 1.1 GB; each process of the batch adds to the same count."""
    count = tmp_path / "count"

    def read(_: Path) -> object:
        with count.open("a") as file:
            file.write("x")
        number = count.stat().st_size
        if number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        return bytearray(b"x") * 1_100_000_000 if number == 3 else None

    rows = list(run_batch(made_up(read), range(5, 10)))
    # on a busy machine so much memory also takes long
    faults = [(row["number"], row["kind"]) for row in rows if row["row"] == "fault" and row["kind"] != "slow"]
    assert faults == [(6, "crash"), (7, "memory")]
    assert (rows[-1]["first"], rows[-1]["count"], rows[-1]["read"]) == (5, 5, 4)


def test_a_long_run_continues_behind_the_rows_that_are_there(tmp_path: Path) -> None:
    rows, readers = tmp_path / "rows.jsonl", [made_up(lambda _: 1, "one"), made_up(raising(KeyError("x")), "other")]
    assert not run_batches(readers, range(20, 24), rows, minutes=0.0, size=2)
    assert run_batches(readers[:1], range(20, 24), rows, minutes=5.0, size=2)
    with rows.open("a") as file:
        file.write('{"row": "batch", "rea\n')  # cut off by a kill
    assert run_batches(readers, range(20, 24), rows, minutes=5.0, size=2)
    batches = [(row["reader"], row["first"]) for row in read_rows(rows) if row["row"] == "batch"]
    assert batches == [("one", 20), ("one", 22), ("other", 20), ("other", 22)]
    assert sum(row["row"] == "fault" for row in read_rows(rows)) == 4
