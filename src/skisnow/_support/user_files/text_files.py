"""The bytes and the text of a plain file: neither a pipe that is waited for, nor a device without end."""

from __future__ import annotations

import json
import math
import re
import stat
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final, Self, TypeAlias

from ..errors import ParameterError, as_template
from ..messages import Message


def plain_bytes(path: str | Path, *, most_bytes: int) -> bytes:
    """Read a regular file; ContentError if it is missing, unreadable, no regular file, or has more bytes."""
    try:
        if not stat.S_ISREG((place := Path(path)).stat().st_mode):
            raise ContentError("{path} cannot be read: it is a folder, a pipe or the like. Check the path.").tag(
                "cannot_read", path=path
            )
        with place.open("rb") as stream:
            data = stream.read(most_bytes + 1)
    except ContentError:
        raise
    except OSError as error:
        raise ContentError("{path} cannot be read: {reason}. Check the path.").tag(
            "cannot_read", path=path, reason=error.strerror or error
        ) from error
    except ValueError as error:
        raise ContentError("{path!r} is not a path: it is not valid text, or has a NUL character. Correct it.").tag(
            "invalid_character", path=path
        ) from error
    if len(data) > most_bytes:
        raise ContentError("{path} is too large: at most {limit:g} MiB are read of such a file.").tag(
            "too_large", path=path, limit=most_bytes / 2**20
        )
    return data


def is_file(path: str | Path) -> bool:
    """True if a file with this name exists; False without an error for impossible names."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):
        return False


def plain_text(path: str | Path, *, most_bytes: int) -> str:
    """Read a file as UTF-8 text, with or without byte order mark; lines end with a line feed, however they did."""
    data = plain_bytes(path, most_bytes=most_bytes)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ContentError("{path} is not UTF-8 text ({reason}, byte {byte}). Save it as UTF-8.").tag(
            "not_text", path=path, reason=error.reason, byte=error.start + 1
        ) from error
    return text.replace("\r\n", "\n").replace("\r", "\n")


class ContentError(ParameterError):
    """A file, or a text used instead of a file, cannot be read.

    what, fields: problem and allowed values, without the file.
    line: line of the file, or None.
    title: name of the file or text; "" until it is known.
    sentence: whole message, instead of one composed of the others.
    """

    def __init__(self, what: str, *, line: int | None = None, title: str = "", sentence: str = "") -> None:
        super().__init__(sentence or _with_place(what, line, title))
        self.what, self.line, self.title, self.sentence = what, line, title, sentence

    def tag(self, code: str, /, **fields: Any) -> Self:
        """Set the code of the error and the fields of its problem's template; returns the same error."""
        self.what = as_template(self.what, fields)
        self.args = (self.sentence or _with_place(self.what, self.line, self.title),)
        self.code = code
        return self

    def of(self, title: str) -> ContentError:
        """New error with the same problem and line, and the title of the file."""
        return ContentError(self.what, line=self.line, title=title).tag(self.code)


def _with_place(what: str, line: int | None, title: str) -> str:
    """Problem `what` with the file's title and the line before it, as far as they are known."""
    if line and title:
        return Message("{file}, line {line}: {problem}", file=title, line=line, problem=what)
    if line:
        return Message("line {line}: {problem}", line=line, problem=what)
    return Message("{file}: {problem}", file=title, problem=what) if title else what


MOST_DIGITS: Final = 18
"""Digits of a 64-bit number. Python itself rejects texts of more than 4,300 digits with a ValueError."""


def natural_number(text: str) -> int | None:
    """Whole number of 0 or more; None if the text is anything else than 1 to 18 decimal digits.

    >>> natural_number("42"), natural_number("-1"), natural_number("9" * 5000)
    (42, None, None)
    """
    return int(text) if len(text) <= MOST_DIGITS and text.isdecimal() else None


DEEPEST: Final = 32
"""Tables and lists within one another; the program's own files have six at most."""

LONGEST_KEY: Final = 200
LONGEST_TEXT: Final = 100_000
LARGEST_WHOLE: Final = 2**63 - 1
"""TOML's; others programs that read JSON stop earlier."""

Place: TypeAlias = tuple[str | int, ...]


def require_sound(value: object, *, infinite: bool, place: Place = ()) -> None:
    """Raise a ContentError for overlong or invalid texts, too large or non-finite numbers, and too deep nesting.

    infinite: True if a number may be infinite or NaN, as TOML allows.
    place: keys and indices that lead to the value, for messages.
    """
    if isinstance(value, str):
        _require_text(value, place, LONGEST_TEXT)
    elif isinstance(value, int):
        if not -LARGEST_WHOLE - 1 <= value <= LARGEST_WHOLE:
            problem = Message(
                "{place} is beyond the whole numbers, ±{largest}. Write it with a decimal point.",
                place=named(place),
                largest=LARGEST_WHOLE,
            )
            raise ContentError(problem).tag("number_too_large")
    elif isinstance(value, float):
        if not infinite and not math.isfinite(value):
            raise ContentError("{place} is beyond the numbers, ±1.8e308. Correct it.").tag(
                "number_too_large", place=named(place)
            )
    elif isinstance(value, dict | list):
        if len(place) >= DEEPEST:
            raise too_deep()
        if isinstance(value, dict):
            for key in value:
                _require_text(key, (*place, key), LONGEST_KEY)
        pairs = value.items() if isinstance(value, dict) else enumerate(value, start=1)
        for key, inner in pairs:
            require_sound(inner, infinite=infinite, place=(*place, key))


def too_deep(line: int | None = None) -> ContentError:
    """Error for brackets that are nested too deeply."""
    return ContentError("brackets are nested more than {deepest} deep. Remove some.", line=line).tag(
        "nested_too_deep", deepest=DEEPEST
    )


def _require_text(text: str, place: Place, longest: int) -> None:
    """Reject a text that is too long or has a NUL or a surrogate; `place`: its place for the message."""
    if len(text) > longest:
        raise ContentError("{place} has {count} characters; allowed are {longest}. Shorten it.").tag(
            "text_too_long", place=named(place), count=len(text), longest=longest
        )
    if text.isascii():
        sound = "\0" not in text
    else:
        sound = not any(letter == "\0" or "\ud800" <= letter <= "\udfff" for letter in text)
    if not sound:
        raise ContentError("{place} has a NUL character or half a letter, which no text has. Remove it.").tag(
            "invalid_character", place=named(place)
        )


def named(place: Place) -> str:
    """Text of a place in a file, its keys and indices, for a message.

    >>> named(("tool", 2, "name")), named(())
    ('tool[2].name', 'the value')
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{shown(part)}" for part in place)
    return text.removeprefix(".") or Message("the value")


def shown(text: str, limit: int = 60) -> str:
    """Text for a message: at most `limit` characters, and ? instead of characters that cannot be printed."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in text[: limit + 1])
    return plain if len(plain) <= limit else plain[:limit] + "…"


def shown_value(value: object, limit: int = 80, written: Callable[[object], str] = repr) -> str:
    """Text of a value for a message, by the function `written`, cut after `limit` characters."""
    try:
        text = written(value)
    except ValueError:  # an integer of more digits than Python writes
        return "a number of thousands of digits"
    return text if len(text) <= limit else text[:limit] + " …"


MOST_TOML_BYTES: Final = 1 << 20
MOST_DOTS: Final = 16

_TOKENS: Final = re.compile(
    r'"""(?s:\\.|[^\\])*?(?:"{3,5}|\Z)'
    r"|'''(?s:.)*?(?:'{3,5}|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+"?'
    r"|'[^'\n]*+'?"
    r"|\#[^\n]*+"
    r"|[\[\]{}=,\n]"
    r"|[\w+.:-]+"
)


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file in UTF-8."""
    return toml_values(plain_text(path, most_bytes=MOST_TOML_BYTES), title=str(path))


def toml_text(value: object) -> str:
    """A text, number, truth value or list of them as TOML writes it.

    >>> print(toml_text(["a", 1.5, True]))
    ["a", 1.5, true]
    """
    if isinstance(value, str):  # a basic string of TOML is one of JSON, but for the letter DEL
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(map(toml_text, value))}]"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def toml_values(text: str, *, title: str = "") -> dict[str, Any]:
    """Parse a TOML text of a user, with line feeds, within limits; a ContentError with its title if it is not valid."""
    try:
        if len(text) > MOST_TOML_BYTES:
            raise ContentError("the text has {count} characters; allowed are {longest}.").tag(
                "too_large", count=len(text), longest=MOST_TOML_BYTES
            )
        _require_short(text)
        values = tomllib.loads(text)
        require_sound(values, infinite=True)
    except ContentError as error:
        raise error.of(title) from None
    except RecursionError:
        raise too_deep().of(title) from None
    except ValueError as error:  # TOMLDecodeError, and dates that there are not
        line = re.search(r"at line (\d+)", str(error))
        sentence = (
            Message("{file} is not TOML: {reason}. Correct that place.", file=title, reason=str(error))
            if title
            else Message("This is not TOML: {reason}. Correct that place.", reason=str(error))
        )
        raise ContentError(str(error), line=int(line[1]) if line else None, sentence=sentence).tag(
            "not_toml"
        ) from error
    return values


def _require_short(text: str) -> None:
    """Raise a ContentError for too deep brackets, long words or keys with many dots, which slow down the parser."""
    depth = dots = 0
    for token in _TOKENS.finditer(text):
        word = token[0]
        first = word[0]
        if first in "[{":
            depth += 1
            if depth > DEEPEST:
                raise too_deep(_line_of(text, token))
        elif first in "]}":
            depth -= 1
        if first in "[]{}=,\n":
            dots = 0
        elif first not in "\"'#":
            dots += word.count(".")
            if dots > MOST_DOTS:
                raise ContentError("a key has more than {count} dots. Shorten it.", line=_line_of(text, token)).tag(
                    "key_too_long", count=MOST_DOTS
                )
            if len(word) > LONGEST_KEY:
                problem = Message(
                    "A number or key has {count} characters; allowed are {longest}. Shorten it.",
                    count=len(word),
                    longest=LONGEST_KEY,
                )
                raise ContentError(problem, line=_line_of(text, token)).tag("key_too_long")


def _line_of(text: str, token: re.Match[str]) -> int:
    """Line number of a token, from 1."""
    return text.count("\n", 0, token.start()) + 1
