"""Times as the reader's clock shows them."""

from __future__ import annotations

from datetime import UTC, datetime

from .._support.language import ENGLISH
from .language import language_of

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
