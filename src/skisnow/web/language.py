"""Which language a page is in: what the browser asks for, or what was chosen on a page before."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from .catalogue import Catalogue, read_catalogue

if TYPE_CHECKING:
    from collections.abc import Mapping

FOLDER: Final = Path(__file__).parent / "languages"
ENGLISH: Final = "en"
COOKIE: Final = "skisnow-language"
NAME: Final = "English"
"""What a language calls itself: in a catalogue the translation of this word."""
_OF_PAGES: Final = WeakKeyDictionary[Client, str]()


@cache
def languages() -> Mapping[str, str]:
    """What each language calls itself, by its code; a further one is one more file."""
    return {ENGLISH: NAME} | {
        place.stem: catalogue(place.stem).translated(NAME) for place in sorted(FOLDER.glob("*.po"))
    }


@cache
def catalogue(code: str) -> Catalogue:
    """The words of a language; English has none."""
    return Catalogue({} if code == ENGLISH else read_catalogue(FOLDER / f"{code}.po"))


def language_asked(chosen: str | None, accepted: str) -> str:
    """The code of a language that there is.

    Parameters
    ----------
    chosen
        On a page before, kept in a cookie.
    accepted
        The browser's header Accept-Language, the dearest first.

    Examples
    --------
    >>> language_asked(None, "fr-CH, de-AT;q=0.9, en;q=0.5"), language_asked("en", "de")
    ('de', 'en')
    """
    wanted = [part.split(";")[0].strip().split("-")[0].lower() for part in accepted.split(",")]
    return next((code for code in (chosen or "", *wanted) if code in languages()), ENGLISH)


def language_of(client: Client | None = None) -> str:
    """The code of a page's language; of the page that is being built or answered where none is given."""
    if client is None:
        try:
            client = ui.context.client
        except RuntimeError:  # nobody's page
            return ENGLISH
    if client not in _OF_PAGES:
        request = client.request
        _OF_PAGES[client] = language_asked(request.cookies.get(COOKIE), request.headers.get("accept-language", ""))
    return _OF_PAGES[client]


def said(text: str, client: Client | None = None) -> str:
    """A text in the language of the page."""
    return catalogue(language_of(client)).translated(text)
