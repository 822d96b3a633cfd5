"""Language of a page: the chosen one, otherwise the one that the browser prefers. Local times."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from .._support.language import ENGLISH, catalogue, languages
from .._support.language.catalogues import DECIMAL
from .._support.messages import Message, use_language_of_pages

if TYPE_CHECKING:
    from collections.abc import Set

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
    """A text in the language of the page, its numbers as there."""
    words = catalogue(language_of(client))
    if isinstance(text, Message):
        return text.text(language_of(client))
    return words.with_numbers(words.translated(text))


def said_template(template: str, *fields: str, client: Client | None = None) -> str:
    """A translated template with ``{}`` for each field; the fields are not translated."""
    return catalogue(language_of(client)).as_given(template).format(*fields)


def decimal_mark(client: Client | None = None) -> str:
    """Decimal mark of the page's language."""
    return said(DECIMAL, client)[1]


def number_said(number: str, client: Client | None = None) -> str:
    """A stored number with the decimal mark of the page's language; the page accepts both marks."""
    return number.replace(".", decimal_mark(client))


def said_as_written(text: str, names: Set[str]) -> str:
    """A text in the language of the page, with names and numbers as in the file."""
    return catalogue(language_of()).keeping(names).translated(text)


def said_list(text: str, client: Client | None = None) -> str:
    """A translated list such as ``Load (N): 400 to 1200, 4 values; ski: mine``; names and values are separate texts."""
    return "; ".join(": ".join(said(word, client) for word in part.split(": ", 1)) for part in text.split("; "))


_MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"]


def minute_words(at: datetime | str) -> str:
    """Day and time in the time zone of the server, in the format of the page's language.

    Parameters
    ----------
    at
        A time, or an ISO 8601 text; UTC without a time zone.
    """
    time = datetime.fromisoformat(at) if isinstance(at, str) else at
    return _written((time if time.tzinfo else time.replace(tzinfo=UTC)).astimezone(), language_of())


def _written(time: datetime, language: str) -> str:
    """Day and time in the format of a language.

    >>> _written(datetime(2026, 3, 5, 9, 7), "en"), _written(datetime(2026, 3, 5, 9, 7), "de")
    ('5 Mar 2026, 09:07', '5. 3. 2026, 09:07')
    """
    if language == ENGLISH:
        return f"{time.day} {_MONTHS[time.month - 1]} {time.year}, {time:%H:%M}"
    return f"{time.day}. {time.month}. {time.year}, {time:%H:%M}"
