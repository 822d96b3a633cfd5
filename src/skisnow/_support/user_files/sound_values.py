"""What a parsed file may hold: limits that every reader can rely on."""

from __future__ import annotations

import math
from typing import Final, TypeAlias

from ..messages import Message
from .plain_file import GivenError

DEEPEST: Final = 32
"""Tables and lists within one another; the program's own files have six at most."""

LONGEST_KEY: Final = 200
LONGEST_TEXT: Final = 100_000
LARGEST_WHOLE: Final = 2**63 - 1
"""TOML's; others programs that read JSON stop earlier."""

Place: TypeAlias = tuple[str | int, ...]


def require_sound(value: object, *, infinite: bool, place: Place = ()) -> None:
    """Refuse what no reader can work with.

    Parameters
    ----------
    value
        As TOML or JSON gave it.
    infinite
        Whether a number may be infinite or NaN, as TOML allows when it is written so.
    place
        Keys and numbers that lead to the value.

    Raises
    ------
    GivenError
        Nesting, a key, a text or a number is beyond the limits, or a text has a NUL character or half a letter.
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
            raise GivenError(problem, code="number_too_large")
    elif isinstance(value, float):
        if not infinite and not math.isfinite(value):
            raise GivenError(
                Message("{place} is beyond the numbers, ±1.8e308. Correct it.", place=named(place)),
                code="number_too_large",
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


def too_deep(line: int | None = None) -> GivenError:
    """The error for brackets within brackets within brackets."""
    return GivenError(
        Message("brackets are nested more than {deepest} deep. Take some out.", deepest=DEEPEST),
        line=line,
        code="nested_too_deep",
    )


def _require_text(text: str, place: Place, longest: int) -> None:
    if len(text) > longest:
        raise GivenError(
            Message(
                "{place} has {count} characters; allowed are {longest}. Shorten it.",
                place=named(place),
                count=len(text),
                longest=longest,
            ),
            code="text_too_long",
        )
    if text.isascii():
        sound = "\0" not in text
    else:
        sound = not any(letter == "\0" or "\ud800" <= letter <= "\udfff" for letter in text)
    if not sound:
        raise GivenError(
            Message("{place} has a NUL character or half a letter, which no text has. Remove it.", place=named(place)),
            code="invalid_character",
        )


def named(place: Place) -> str:
    """A place for a message.

    >>> named(("tool", 2, "name")), named(())
    ('tool[2].name', 'the value')
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{shown(part)}" for part in place)
    return text.removeprefix(".") or Message("the value")


def shown(text: str, limit: int = 60) -> str:
    """A text within a message: short, and nothing that does not print."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in text[: limit + 1])
    return plain if len(plain) <= limit else plain[:limit] + "…"
