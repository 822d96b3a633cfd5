"""Which languages there are: English, and those that have a catalogue in the folder ``texts``."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..errors import ParameterError
from ..messages import ENGLISH
from .catalogue import Catalogue, read_catalogue

if TYPE_CHECKING:
    from collections.abc import Mapping

FOLDER: Final = Path(__file__).parent / "texts"
NAME: Final = "English"
"""What a language calls itself: in a catalogue the translation of this word."""


def codes() -> list[str]:
    """The codes of all languages; a further one is one more file."""
    return [ENGLISH, *sorted(place.stem for place in FOLDER.glob("*.po"))]


@cache
def languages() -> Mapping[str, str]:
    """What each language calls itself, by its code."""
    return {code: catalogue(code).translated(NAME) for code in codes()}


@cache
def catalogue(code: str) -> Catalogue:
    """The words of a language; English has none."""
    return Catalogue({} if code == ENGLISH else read_catalogue(FOLDER / f"{code}.po"), language=code)


def require_language(code: str) -> None:
    """Refuse a language before long work is done for it.

    Raises
    ------
    ParameterError
        There are no texts of it.
    """
    if code not in codes():
        raise ParameterError(f"the language is one of {', '.join(codes())}; {code!r} is given")
