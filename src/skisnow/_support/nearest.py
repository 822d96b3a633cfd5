"""The known word that a misspelt one means."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from .errors import ParameterError
from .messages import Message


def nearest(word: str, words_allowed: Iterable[str]) -> Message:
    """The known word most like a misspelt one as a question, and all of them; sentences with their full stop."""
    words = list(words_allowed)
    like = most_like(word, words)
    if like is None:
        return Message("Allowed: {allowed}.", allowed=words)
    return Message("Did you mean {similar}? Allowed: {allowed}.", similar=like, allowed=words)


def meant(word: str, words_allowed: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question with a space behind; empty where none is like it.

    >>> meant("angel", ["angle", "mass"])
    'Did you mean angle? '
    """
    like = most_like(word, words_allowed)
    return f"Did you mean {like}? " if like else ""


def most_like(word: str, words_allowed: Iterable[str]) -> str | None:
    """The known word most like a misspelt one; None where none is like it."""
    by_small = {name.lower(): name for name in words_allowed}
    like = difflib.get_close_matches(word.lower(), by_small, n=1, cutoff=0.5)
    return by_small[like[0]] if like else None


def require_choice(name: str, value: object, choices: Iterable[str]) -> None:
    """Reject a value that is not one of a parameter's choices.

    Raises
    ------
    ParameterError
        With the choice that is most like the value.
    """
    words = list(choices)
    if value not in words:
        raise ParameterError(
            Message("{name} is {value!r}. {allowed}", name=name, value=value, allowed=nearest(str(value), words)),
            code="unknown_choice",
        )
