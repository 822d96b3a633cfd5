"""Many cases of one reader in a child process, since a case may hang, crash or take memory."""

import json
import os
import resource
import signal
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from .case import Fault, run_case
from .reader import Reader

HANG_S: Final = 60.0
"""Processor time of a case after which it counts as hung."""
WAIT_S: Final = 900.0
"""The same in elapsed time: a case that waits for something."""
MEMORY_BYTES: Final = 6 << 30
"""Address space beyond which a process gets no more."""


def run_batches(readers: Sequence[Reader], numbers: range, rows: Path, *, minutes: float, size: int = 100) -> bool:
    """Try the cases that the rows do not list yet, in batches; False if the time ended before all were tried."""
    ends = time.monotonic() + 60.0 * minutes
    done = {(row["reader"], row["first"]) for row in read_rows(rows) if row["row"] == "batch"}
    for first in numbers[::size]:
        for reader in readers:
            if (reader.name, first) in done:
                continue
            if time.monotonic() >= ends:
                return False
            lines = [json.dumps(row) for row in run_batch(reader, range(first, min(first + size, numbers.stop)))]
            with rows.open("a", encoding="utf-8") as file:
                file.write("".join(f"{line}\n" for line in lines))
            print(lines[-1], flush=True)
    return True


def read_rows(path: Path) -> Iterator[dict[str, Any]]:
    """All rows of a file, if it exists; a line that a kill cut off is left out."""
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        if line.endswith("}"):
            yield json.loads(line)


def run_batch(reader: Reader, numbers: range) -> Iterator[dict[str, Any]]:
    """Faults of some cases, and last the row of the batch; a process that dies is begun again behind its case."""
    first, was_read, seconds, slowest = numbers.start, 0, 0.0, 0.0
    reader.files()
    while first < numbers.stop:
        lines, ended = _in_process(reader, range(first, numbers.stop))
        for row in lines:
            if row["row"] == "fault":
                yield row
            elif row["row"] == "case":
                was_read, seconds, slowest = (
                    was_read + row["read"],
                    seconds + row["seconds"],
                    max(slowest, row["seconds"]),
                )
        begun = [row["number"] for row in lines if row["row"] == "begun"]
        first = (begun[-1] if begun else first) + 1
        if ended:
            yield Fault(reader.name, first - 1, *ended).as_row()
            seconds += HANG_S if ended[0] == "hang" else 0.0
        else:
            first = numbers.stop
    yield {
        "row": "batch", "reader": reader.name, "first": numbers.start, "count": len(numbers), "read": was_read,
        "seconds": round(seconds, 2), "slowest_s": round(slowest, 2),
    }  # fmt: skip


def _in_process(reader: Reader, numbers: range) -> tuple[list[dict[str, Any]], tuple[str, str] | None]:
    """Rows of a child process, and how it died."""
    take, give = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(take)
        _child(reader, numbers, give)
    os.close(give)
    with os.fdopen(take, "rb") as stream:
        lines = [json.loads(line) for line in stream.read().splitlines() if line.endswith(b"}")]
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        kind = "hang" if number in (signal.SIGPROF, signal.SIGALRM) else "crash"
        return lines, (kind, signal.Signals(number).name)
    code = os.WEXITSTATUS(status)
    return lines, ("crash", f"exit status {code}") if code else None


def _child(reader: Reader, numbers: range, give: int) -> None:
    status = 1
    try:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
        for end in (signal.SIGPROF, signal.SIGALRM):
            signal.signal(end, signal.SIG_DFL)
        with TemporaryDirectory(prefix="skisnow-fuzzing-") as name:
            os.chdir(name)
            for number in numbers:
                _write(give, {"row": "begun", "number": number})
                signal.setitimer(signal.ITIMER_PROF, HANG_S)
                signal.setitimer(signal.ITIMER_REAL, WAIT_S)
                outcome = run_case(reader, number, Path(name))
                signal.setitimer(signal.ITIMER_PROF, 0.0)
                for fault in outcome.faults:
                    _write(give, fault.as_row())
                _write(give, {"row": "case", "read": outcome.was_read, "seconds": outcome.seconds})
        status = 0
    finally:
        os._exit(status)


def _write(give: int, row: dict[str, Any]) -> None:
    os.write(give, json.dumps(row).encode() + b"\n")
