"""Numbers, dates, rows and JSON as text: significant digits, intervals, p values, months as words."""

from __future__ import annotations

import json
from datetime import UTC, date, datetime
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from markupsafe import Markup

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Style: TypeAlias = Literal["typeset", "plain", "latex"]
"""Typeset: Unicode minus and powers; plain: what any terminal shows; latex: for text mode, by siunitx."""

ABSENT: Final = {"typeset": "–", "plain": "-", "latex": "--"}
_SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SMALLEST_P: Final = 0.001


def significant(value: float | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """A number with so many significant digits; the digits before the point are kept below 10⁶.

    >>> significant(0.034412), significant(1652.4), significant(-2.0e-7), significant(None)
    ('0.0344', '1652', '−2.00×10⁻⁷', '–')
    """
    if value is None:
        return ABSENT[style]
    if value == 0:
        return _signed("0", style)
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(power)
    if -4 <= exponent < 6:
        return _signed(f"{value:.{max(digits - 1 - exponent, 0)}f}", style)
    if style == "plain":
        return f"{mantissa}e{exponent}"
    if style == "latex":
        return rf"\num{{{mantissa}e{exponent}}}"
    return f"{_signed(mantissa, style)}×10{str(exponent).translate(_SUPERSCRIPTS)}"


def plain(value: float | None, digits: int = 3) -> str:
    """A number for a terminal; a hyphen for None."""
    return significant(value, digits, style="plain")


def _signed(text: str, style: Style) -> str:
    if style == "typeset":
        return text.replace("-", "−")
    return rf"\num{{{text}}}" if style == "latex" else text


def interval(pair: Sequence[float] | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """Both ends of an interval.

    >>> interval([-0.5, 2.0])
    '[−0.500, 2.00]'
    """
    if pair is None:
        return ABSENT[style]
    low, high = pair
    return f"[{significant(low, digits, style=style)}, {significant(high, digits, style=style)}]"


def aligned_rows(rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a table for a terminal, all columns right-aligned.

    >>> aligned_rows([("gate", "time (s)"), ("1", "2.50")])
    ['gate  time (s)', '   1      2.50']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]


def json_text(contents: Mapping[str, Any]) -> str:
    """JSON with one space of indentation; NaN and infinity raise ValueError."""
    return json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)


def from_to(pair: Sequence[float] | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """Minimum and maximum of a range.

    >>> from_to([0.04, 90.0])
    '0.0400 to 90.0'
    """
    if pair is None:
        return ABSENT[style]
    return " to ".join(significant(end, digits, style=style) for end in pair)


def probability(p: float | None, *, style: Style = "typeset") -> str:
    """A p value with two digits; below 0.001 and above 0.99 only the limit.

    >>> probability(0.5234), probability(3e-12), probability(0.9999)
    ('0.52', '< 0.001', '> 0.99')
    """
    if p is None:
        return ABSENT[style]
    less, more = ("$<$", "$>$") if style == "latex" else ("<", ">")
    if p < _SMALLEST_P:
        return f"{less} {_SMALLEST_P}"
    return f"{more} 0.99" if p > 0.99 else significant(p, 2, style=style)


def p_equals(p: float | None, *, style: Style = "typeset") -> str:
    """A p value inside a sentence: ``p = 0.52`` or ``p < 0.001``, not broken over lines where typeset."""
    text = probability(p, style=style)
    sentence = f"p {text}" if text[0] in "<>" else f"p = {text}"
    return sentence.replace(" ", "\u00a0") if style == "typeset" else sentence


def counted(number: int, singular: str, plural: str | None = None) -> str:
    """A number with its noun.

    >>> counted(1, "site"), counted(12345, "reading"), counted(2, "series", "series")
    ('1 site', '12\u202f345 readings', '2 series')
    """
    return f"{whole(number)} {singular if number == 1 else plural or singular + 's'}"


def whole(number: int) -> str:
    """A count; five digits and more are grouped by thousands."""
    return str(number) if abs(number) < 10_000 else f"{number:,}".replace(",", "\u202f")


_MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip


def date_words(day: str) -> str:
    """An ISO date in words; any other text unchanged.

    >>> date_words("2026-01-09"), date_words("2026-02-30")
    ('9 January 2026', '2026-02-30')
    """
    try:
        parsed = date.fromisoformat(day)
    except ValueError:
        return day
    return f"{parsed.day} {_MONTHS[parsed.month - 1]} {parsed.year}"


def days_words(first: str, last: str) -> Markup:
    """First and last day of a campaign; a common month and year appear once.

    >>> print(days_words("2026-01-09", "2026-01-12").striptags())
    9 to 12 January 2026
    >>> print(days_words("2026-01-30", "2026-02-02").striptags())
    30 January to 2 February 2026
    >>> print(days_words("2025-12-30", "2026-01-02").striptags())
    30 December 2025 to 2 January 2026
    """
    if first == last:
        return _time_element(first, date_words(first))
    begin, end = date_words(first).split(), date_words(last).split()
    if len(begin) == len(end) == 3 and begin[2] == end[2]:  # of one year
        begin = begin[:1] if begin[1] == end[1] else begin[:2]
    return _time_element(first, " ".join(begin)) + " to " + _time_element(last, date_words(last))


def moment_words(moment: str) -> Markup:
    """Day and minute of an ISO time, in UTC if it has a time zone.

    >>> print(moment_words("2026-01-09T14:58:12+00:00").striptags())
    9 January 2026, 14:58 UTC
    """
    try:
        time = datetime.fromisoformat(moment)
    except ValueError:
        return Markup.escape(moment)
    zone = "" if time.tzinfo is None else " UTC"
    time = time if time.tzinfo is None else time.astimezone(UTC)
    return _time_element(moment, f"{date_words(time.date().isoformat())}, {time:%H:%M}{zone}")


def _time_element(iso_time: str, words: str) -> Markup:
    return Markup('<time datetime="{}">{}</time>').format(iso_time, words)
