"""The bytes and the text of a plain file: neither a pipe that is waited for, nor a device without end."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import Final

from ..errors import ParameterError
from ..messages import Message


def plain_bytes(path: str | Path, *, most_bytes: int) -> bytes:
    """Read a file.

    Raises
    ------
    GivenError
        It is not there, may not be read, is no plain file, or has more bytes; or no file can have such a name.
    """
    try:
        if not stat.S_ISREG((place := Path(path)).stat().st_mode):
            if place.is_dir():
                problem = Message("{path} cannot be read: it is a folder. Check the path.", path=path)
            else:
                problem = Message(
                    "{path} cannot be read: it is a pipe, a device or the like, no plain file. Check the path.",
                    path=path,
                )
            raise GivenError(problem, code="cannot_read")
        with place.open("rb") as stream:
            data = stream.read(most_bytes + 1)
    except GivenError:
        raise
    except OSError as error:
        raise GivenError(
            Message("{path} cannot be read: {reason}. Check the path.", path=path, reason=error.strerror or error),
            code="cannot_read",
        ) from error
    except UnicodeEncodeError as error:
        raise GivenError(
            Message("{path!r} cannot be read: its name is no valid text. Correct it.", path=path), code="cannot_read"
        ) from error
    except ValueError as error:  # the system's paths end at a NUL character
        raise GivenError(
            Message("{path!r} is no path: it has a NUL character. Correct it.", path=path), code="invalid_character"
        ) from error
    if len(data) > most_bytes:
        raise GivenError(
            Message(
                "{path} is too large: at most {limit:g} MiB are read of such a file.",
                path=path,
                limit=most_bytes / 2**20,
            ),
            code="too_large",
        )
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
            Message(
                "{path} is not UTF-8 text ({reason}, byte {byte}). Save it as UTF-8.",
                path=path,
                reason=error.reason,
                byte=error.start + 1,
            ),
            code="not_text",
        ) from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


class GivenError(ParameterError):
    """A file, or a text in its stead, cannot be read.

    Parameters
    ----------
    what
        Problem and what is allowed, without the file.
    code
        As in `skisnow.SkisnowError`.
    line
        Line of the file, where one can be named.
    title
        The file, or another name of the text; empty until it is known.
    sentence
        The whole message, if it is not made of the others.
    """

    def __init__(
        self, what: str, *, code: str = "", line: int | None = None, title: str = "", sentence: str = ""
    ) -> None:
        super().__init__(sentence or _placed(what, line, title), code=code)
        self.what, self.line = what, line

    def of(self, title: str) -> GivenError:
        """The same error of a file."""
        return GivenError(self.what, code=self.code, line=self.line, title=title)


def _placed(what: str, line: int | None, title: str) -> str:
    if line and title:
        return Message("{file}, line {line}: {problem}", file=title, line=line, problem=what)
    if line:
        return Message("line {line}: {problem}", line=line, problem=what)
    return Message("{file}: {problem}", file=title, problem=what) if title else what


MOST_DIGITS: Final = 18
"""Of a number that fits into 64 bits. Python itself rejects texts of more than 4,300 digits with a ValueError."""


def natural_number(text: str) -> int | None:
    """Whole number of 0 or more; None if the text is anything else than 1 to 18 decimal digits.

    >>> natural_number("42"), natural_number("-1"), natural_number("9" * 5000)
    (42, None, None)
    """
    return int(text) if len(text) <= MOST_DIGITS and text.isdecimal() else None
