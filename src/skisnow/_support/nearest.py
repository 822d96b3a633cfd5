"""The known word that a misspelt one means."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question, and all of them."""
    words = list(known)
    return f"{meant(word, words)}There are {', '.join(words)}"


def meant(word: str, known: Iterable[str]) -> str:
    """The known word most like a misspelt one as a question with a space behind; empty where none is like it.

    >>> meant("angel", ["angle", "mass"])
    'Is angle meant? '
    """
    by_small = {each.lower(): each for each in known}
    like = difflib.get_close_matches(word.lower(), by_small, n=1, cutoff=0.5)
    return f"Is {by_small[like[0]]} meant? " if like else ""
