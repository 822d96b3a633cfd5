"""Files that are complete or not there: written to a temporary name, then moved into place."""

from __future__ import annotations

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator


def write_file(path: str | Path, content: str | bytes) -> None:
    """Write a file in one piece; text as UTF-8 with plain line ends. An existing file is replaced.

    Raises
    ------
    OutputError
        The place cannot be written or is full; whatever stood there before still does.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    with place_to_write(path) as place:
        place.write_bytes(data)


@contextmanager
def place_to_write(path: str | Path) -> Iterator[Path]:
    """An empty file to be filled by its name, which stands in its place when the block ends well, and else nowhere.

    Raises
    ------
    OutputError
        The place cannot be written or is full; whatever stood there before still does.
    """
    path = Path(path)
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".partial", dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        yield temporary
        with temporary.open("r+b") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
        temporary = None
    except OSError as error:
        raise cannot_write(path, error) from error
    finally:
        if temporary is not None:  # an error, or an interruption at any moment
            temporary.unlink(missing_ok=True)


def require_writable(folder: str | Path) -> None:
    """Make a folder where it is missing and try a file in it, so that long work is not done for nothing.

    Raises
    ------
    OutputError
        The folder cannot be made or written.
    """
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise cannot_write(folder, error) from error


def cannot_write(path: str | Path, error: OSError) -> OutputError:
    """The sentence for a place that cannot be written."""
    reason = error.strerror or error
    return OutputError(f"{path} cannot be written: {reason}. Choose another place or free some space.")
