"""Rows of a batch on disk: appended as they come, so that an interruption at any moment keeps what was finished."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final, Self, TypeAlias

from ..errors import OutputError, ParameterError
from ..files import cannot_write
from ..given import json_value

Row: TypeAlias = dict[str, Any]
NumberedText: TypeAlias = tuple[int, str]
"""A point's number and its row as JSON text on one line."""

_HEAD: Final = "skisnow batch 1 "


@dataclass(slots=True)
class KeptRows:
    """The finished rows of one batch. Without a path they are only remembered.

    Attributes
    ----------
    path
        A text file: a first line with the batch's fingerprint, then one line for each finished point, its number and
        its row as JSON. A torn last line is dropped when the file is opened again.
    rows
        The finished rows by their points' numbers.
    """

    path: Path | None = None
    rows: dict[int, Row] = field(default_factory=dict)
    _file: IO[bytes] | None = None

    @classmethod
    def opened(cls, path: Path, fingerprint: str) -> Self:
        """Open the file of a batch, or begin it.

        Raises
        ------
        ParameterError
            The file belongs to another batch: its fingerprint differs.
        OutputError
            It cannot be written, or another run is writing it.
        """
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            file = path.open("a+b")
        except OSError as error:
            raise cannot_write(path, error) from error
        try:
            _lock(file, path)
            rows = _rows_of(file, path, fingerprint)
        except BaseException:
            file.close()
            raise
        return cls(path, rows, file)

    def add(self, rows: Iterable[NumberedText]) -> None:
        """Keep rows: after this call a kill does not lose them."""
        new = list(rows)
        if self._file is not None and self.path is not None:
            try:
                self._file.write("".join(f"{number} {text}\n" for number, text in new).encode())
                self._file.flush()
            except OSError as error:
                raise cannot_write(self.path, error) from error
        self.rows.update((number, json_value(text)) for number, text in new)

    def close(self) -> None:
        """Leave the file for a later start."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def remove(self) -> None:
        """The batch is done and its rows stand elsewhere."""
        self.close()
        if self.path is not None:
            self.path.unlink(missing_ok=True)


def row_text(row: Row) -> str:
    """A row as JSON on one line."""
    return json.dumps(row, ensure_ascii=True, separators=(",", ":"))


def _rows_of(file: IO[bytes], path: Path, fingerprint: str) -> dict[int, Row]:
    """The whole lines of the file; what follows the last of them is cut off."""
    file.seek(0)
    lines = file.read().split(b"\n")[:-1]  # what stands behind the last line end was torn off
    head = f"{_HEAD}{fingerprint}".encode()
    if not lines:
        file.truncate(0)
        file.write(head + b"\n")
        file.flush()
        return {}
    if lines[0] != head:
        raise ParameterError(
            f"{path} holds the finished points of another study, or of this one before its inputs, one of its files or "
            "skisnow changed. Undo the change to go on with them, or remove that file to begin anew"
        )
    rows: dict[int, Row] = {}
    whole = len(lines[0]) + 1
    for line in lines[1:]:
        try:
            number, text = line.split(b" ", 1)
            rows[int(number)] = json_value(text)
        except ValueError:
            break
        whole += len(line) + 1
    file.truncate(whole)
    return rows


def _lock(file: IO[bytes], path: Path) -> None:
    """Two runs at once would write into each other's lines. Where the system has no such lock nothing is done."""
    if sys.platform == "win32":
        return
    import fcntl

    try:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise OutputError(f"{path} is being written by another run of this study. Wait for it or stop it") from None
    except OSError:  # a file system without locks
        return
    if not path.exists() or not os.path.samestat(path.stat(), os.fstat(file.fileno())):
        raise OutputError(f"{path} was just finished by another run of this study. Start again to see its table")
