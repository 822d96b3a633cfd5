"""The bytes and the text of a plain file: neither a pipe that is waited for, nor a device without end."""

from __future__ import annotations

import stat
from pathlib import Path

from .errors import GivenError


def plain_bytes(path: str | Path, *, most_bytes: int) -> bytes:
    """Read a file.

    Raises
    ------
    GivenError
        It is not there, may not be read, is no plain file, or has more bytes; or no file can have such a name.
    """
    try:
        if not stat.S_ISREG((place := Path(path)).stat().st_mode):
            kind = "a folder" if place.is_dir() else "a pipe, a device or the like, no plain file"
            raise GivenError(f"{path} cannot be read: it is {kind}. Check the path.")
        with place.open("rb") as stream:
            data = stream.read(most_bytes + 1)
    except GivenError:
        raise
    except OSError as error:
        raise GivenError(f"{path} cannot be read: {error.strerror or error}. Check the path.") from error
    except UnicodeEncodeError as error:
        raise GivenError(f"{path!r} cannot be read: its name is no valid text. Correct it.") from error
    except ValueError as error:  # the system's paths end at a NUL character
        raise GivenError(f"{str(path)!r} is no path: it has a NUL character. Correct it.") from error
    if len(data) > most_bytes:
        raise GivenError(f"{path} is too large: at most {most_bytes / 2**20:g} MiB are read of such a file.")
    return data


def is_file(path: str | Path) -> bool:
    """Whether there is a file of such a name; no error where none can have it."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):
        return False


def plain_text(path: str | Path, *, most_bytes: int) -> str:
    """Read a file as UTF-8 text, with or without byte order mark; lines end with a line feed, however they did.

    Raises
    ------
    GivenError
        As in `plain_bytes`, or it is no UTF-8 text.
    """
    data = plain_bytes(path, most_bytes=most_bytes)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise GivenError(
            f"{path} is not UTF-8 text ({error.reason}, byte {error.start + 1}). Save it as UTF-8."
        ) from error
    return text.replace("\r\n", "\n").replace("\r", "\n")
