"""Language of a page: the chosen one, otherwise the one that the browser prefers. Local times."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from .._support.messages import ENGLISH, Message, decimal_sign, languages, translated, use_language_of_pages

if TYPE_CHECKING:
    from starlette.requests import Request

COOKIE: Final = "skisnow-language"
_OF_PAGES: Final = WeakKeyDictionary[Client, str]()


def language_asked(chosen: str | None, accepted: str) -> str:
    """Code of an available language.

    Parameters
    ----------
    chosen
        Language from the cookie.
    accepted
        Header Accept-Language of the browser, the preferred language first.

    Examples
    --------
    >>> language_asked(None, "fr-CH, de-AT;q=0.9, en;q=0.5"), language_asked("en", "de")
    ('de', 'en')
    """
    preferred = [part.split(";")[0].strip().split("-")[0].lower() for part in accepted.split(",")]
    return next((code for code in (chosen or "", *preferred) if code in languages()), ENGLISH)


def language_of(client: Client | None = None) -> str:
    """Code of a page's language (default: of the current page)."""
    try:
        client = client or ui.context.client
        if client not in _OF_PAGES:
            _OF_PAGES[client] = language_of_request(client.request)
    except RuntimeError:  # outside of a page
        return ENGLISH
    return _OF_PAGES[client]


use_language_of_pages(language_of)


def language_of_request(request: Request) -> str:
    """Code of the language of a request."""
    return language_asked(request.cookies.get(COOKIE), request.headers.get("accept-language", ""))


def said(text: str, client: Client | None = None) -> str:
    """A message in the language of the page; other text is not translated."""
    return text.text(language_of(client)) if isinstance(text, Message) else text


def number_said(number: str, client: Client | None = None) -> str:
    """A stored number with the decimal mark of the page's language; the page accepts both marks."""
    return number.replace(".", decimal_sign(language_of(client)))


def minute_words(at: datetime | str) -> str:
    """Day and time in the time zone of the server, in the format of the page's language.

    Parameters
    ----------
    at
        A time, or an ISO 8601 text; UTC without a time zone.
    """
    time = datetime.fromisoformat(at) if isinstance(at, str) else at
    return translated((time if time.tzinfo else time.replace(tzinfo=UTC)).astimezone(), language_of())
