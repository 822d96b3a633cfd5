"""The known word that a misspelt one means."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from .errors import ParameterError


def nearest(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question, and all of them."""
    words = list(known)
    return f"{meant(word, words)}There are {', '.join(words)}"


def meant(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question with a space behind; empty where none is like it.

    >>> meant("angel", ["angle", "mass"])
    'Is angle meant? '
    """
    like = most_like(word, known)
    return f"Is {like} meant? " if like else ""


def most_like(word: str, known: Iterable[str]) -> str | None:
    """The known word most like a misspelt one; None where none is like it."""
    by_small = {each.lower(): each for each in known}
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
        raise ParameterError(f"{name} is {value!r}. {nearest(str(value), words)}.")
