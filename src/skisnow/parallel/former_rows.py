"""Finished rows as skisnow kept them before they went to a database: text, a line for each."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..errors import OutputError
from ..files import cannot_write

if TYPE_CHECKING:
    from typing import IO

HEAD: Final = b"skisnow batch 1 "


def fingerprint_of_text(path: Path) -> str | None:
    """The batch that a text file of rows belongs to; "" where its first line was torn, None where it is no such file.

    Raises
    ------
    OutputError
        It cannot be read.
    """
    try:
        with path.open("rb") as file:
            head = file.readline(200)
    except OSError as error:
        raise cannot_write(path, error) from error
    if not head.endswith(b"\n"):
        return "" if HEAD.startswith(head[: len(HEAD)]) else None
    return head[len(HEAD) :].strip().decode("ascii", "replace") if head.startswith(HEAD) else None


@contextmanager
def rows_of_text(path: Path) -> Iterator[Iterator[tuple[int, str]]]:
    """Numbers and rows of a text file, up to the first line that is torn or damaged; nobody else writes it meanwhile.

    Raises
    ------
    OutputError
        It cannot be read, or another run is writing it.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise cannot_write(path, error) from error
    with file:
        _lock(file, path)
        file.readline()
        yield _rows(file)


def _rows(file: IO[bytes]) -> Iterator[tuple[int, str]]:
    for line in file:
        number, parted, text = line.partition(b" ")
        if not (line.endswith(b"}\n") and parted and number.isdigit()):
            return
        yield int(number), text[:-1].decode("ascii", "replace")


def _lock(file: IO[bytes], path: Path) -> None:
    """Where the system has no such lock nothing is done."""
    if sys.platform == "win32":
        return
    import fcntl

    try:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise OutputError(f"{path} is being written by another run of this study. Wait for it or stop it") from None
    except OSError:  # a file system without locks
        return
