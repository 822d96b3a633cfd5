"""Language of a page: the one chosen on a page before, else the one that the browser prefers. Local times."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from nicegui import Client, ui

from .._support.language import ENGLISH, catalogue, languages
from .._support.language.catalogue import DECIMAL
from .._support.messages import Message

if TYPE_CHECKING:
    from collections.abc import Set

    from starlette.requests import Request

COOKIE: Final = "skisnow-language"
_OF_PAGES: Final = WeakKeyDictionary[Client, str]()


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
        _OF_PAGES[client] = language_of_request(client.request)
    return _OF_PAGES[client]


def language_of_request(request: Request) -> str:
    """The code of the language that a request asks for."""
    return language_asked(request.cookies.get(COOKIE), request.headers.get("accept-language", ""))


def said(text: str, client: Client | None = None) -> str:
    """A text in the language of the page, its numbers as there."""
    words = catalogue(language_of(client))
    if isinstance(text, Message):
        return text.text(language_of(client))
    return words.with_numbers(words.translated(text))


def said_template(template: str, *fields: str, client: Client | None = None) -> str:
    """A template with ``{}`` for each field in the language of the page; the fields stay as they are."""
    return catalogue(language_of(client)).as_given(template).format(*fields)


def decimal_mark(client: Client | None = None) -> str:
    """Of numbers in the language of the page."""
    return said(DECIMAL, client)[1]


def number_said(number: str, client: Client | None = None) -> str:
    """A stored number with the decimal mark of the page's language; the page's script takes both marks for one."""
    return number.replace(".", decimal_mark(client))


def said_as_written(text: str, names: Set[str]) -> str:
    """A text in the language of the page; names and numbers as they stand in the file that it tells of."""
    return catalogue(language_of()).keeping(names).translated(text)


def said_list(text: str, client: Client | None = None) -> str:
    """A list such as ``Load (N): 400 to 1200, 4 values; ski: mine``, its names and values each by themselves."""
    return "; ".join(": ".join(said(word, client) for word in part.split(": ", 1)) for part in text.split("; "))


_MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"]


def minute_words(at: datetime | str) -> str:
    """Day and time in the time zone of the machine that the lab runs on, as the page's language writes it.

    Parameters
    ----------
    at
        A time, or its text as ISO 8601 has it; without a zone it is UTC.
    """
    time = datetime.fromisoformat(at) if isinstance(at, str) else at
    return _written((time if time.tzinfo else time.replace(tzinfo=UTC)).astimezone(), language_of())


def _written(time: datetime, language: str) -> str:
    """The same in words.

    >>> _written(datetime(2026, 3, 5, 9, 7), "en"), _written(datetime(2026, 3, 5, 9, 7), "de")
    ('5 Mar 2026, 09:07', '5. 3. 2026, 09:07')
    """
    if language == ENGLISH:
        return f"{time.day} {_MONTHS[time.month - 1]} {time.year}, {time:%H:%M}"
    return f"{time.day}. {time.month}. {time.year}, {time:%H:%M}"
