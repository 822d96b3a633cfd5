"""Dates as people write them: the month as a word, so that nobody takes it for the day."""

from __future__ import annotations

from datetime import UTC, date, datetime

from markupsafe import Markup

_MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip


def date_words(day: str) -> str:
    """A day that was written year first; what is none stays as it is.

    >>> date_words("2026-01-09"), date_words("2026-02-30")
    ('9 January 2026', '2026-02-30')
    """
    try:
        found = date.fromisoformat(day)
    except ValueError:
        return day
    return f"{found.day} {_MONTHS[found.month - 1]} {found.year}"


def days_words(first: str, last: str) -> Markup:
    """First and last day of a campaign, what they share said once.

    >>> print(days_words("2026-01-09", "2026-01-12").striptags())
    9 to 12 January 2026
    >>> print(days_words("2026-01-30", "2026-02-02").striptags())
    30 January to 2 February 2026
    >>> print(days_words("2025-12-30", "2026-01-02").striptags())
    30 December 2025 to 2 January 2026
    """
    if first == last:
        return _marked(first, date_words(first))
    begin, end = date_words(first).split(), date_words(last).split()
    if len(begin) == len(end) == 3 and begin[2] == end[2]:  # of one year
        begin = begin[:1] if begin[1] == end[1] else begin[:2]
    return _marked(first, " ".join(begin)) + " to " + _marked(last, date_words(last))


def moment_words(moment: str) -> Markup:
    """When something was computed, in UTC to the minute.

    >>> print(moment_words("2026-01-09T14:58:12+00:00").striptags())
    9 January 2026, 14:58 UTC
    """
    try:
        found = datetime.fromisoformat(moment)
    except ValueError:
        return Markup.escape(moment)
    if found.tzinfo is None:
        return _marked(moment, f"{date_words(found.date().isoformat())}, {found:%H:%M}")
    there = found.astimezone(UTC)
    return _marked(moment, f"{date_words(there.date().isoformat())}, {there:%H:%M} UTC")


def _marked(written: str, words: str) -> Markup:
    return Markup('<time datetime="{}">{}</time>').format(written, words)
