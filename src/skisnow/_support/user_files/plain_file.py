"""The bytes and the text of a plain file: neither a pipe that is waited for, nor a device without end."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import Final

from ..errors import ParameterError


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


class GivenError(ParameterError):
    """A file, or a text in its stead, cannot be read.

    Parameters
    ----------
    what
        What is wrong and what is allowed, without the file.
    line
        Of the file, where one can be named.
    title
        The file, or what else the text is called by; empty until it is known.
    sentence
        The whole message, where it is not made of the others.
    """

    def __init__(self, what: str, *, line: int | None = None, title: str = "", sentence: str = "") -> None:
        place = ", ".join(part for part in (title, f"line {line}" if line else "") if part)
        super().__init__(sentence or (f"{place}: {what}" if place else what))
        self.what, self.line = what, line

    def of(self, title: str) -> GivenError:
        """The same of a file."""
        return GivenError(self.what, line=self.line, title=title)


MOST_DIGITS: Final = 18
"""Of a number that fits into 64 bits. Python itself rejects texts of more than 4,300 digits with a ValueError."""


def natural_number(text: str) -> int | None:
    """Whole number of 0 or more; None if the text is anything else than 1 to 18 decimal digits.

    >>> natural_number("42"), natural_number("-1"), natural_number("9" * 5000)
    (42, None, None)
    """
    return int(text) if len(text) <= MOST_DIGITS and text.isdecimal() else None
