"""Numbers, rows, JSON, symbols and names of users as text, HTML and text of figures."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, Literal, TypeAlias

from markupsafe import Markup

from .._support.messages import LocalFormatter, Message, current_language, decimal_sign, local_number, translations
from .._support.units import Shown

Style: TypeAlias = Literal["typeset", "plain"]
"""typeset: in the current language, with Unicode minus and powers; plain: for a terminal."""

ABSENT: Final = {"typeset": "–", "plain": "-"}
_SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SMALLEST_P: Final = 0.001
_LARGEST_P: Final = 0.99


def significant(value: float | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """A number with this number of significant digits; the digits before the point are kept below 10⁶.

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
    return f"{_signed(mantissa, style)}×10{str(exponent).translate(_SUPERSCRIPTS)}"


def plain(value: float | None, digits: int = 3) -> str:
    """Text of a number for a terminal; a hyphen for None."""
    return significant(value, digits, style="plain")


def _signed(text: str, style: Style) -> str:
    """Number with a minus sign and local decimal sign if typeset; unchanged in plain text."""
    return local_number(text.replace("-", "−")) if style == "typeset" else text


def interval(pair: Sequence[float] | None, digits: int = 3) -> str:
    """Text of an interval with both ends, typeset; a dash for None.

    >>> interval([-0.5, 2.0])
    '[−0.500, 2.00]'
    """
    if pair is None:
        return ABSENT["typeset"]
    low, high = (significant(end, digits) for end in pair)
    between = "; " if decimal_sign(current_language()) == "," else ", "
    return f"[{low}{between}{high}]"


def aligned_rows(rows: Sequence[Sequence[str]], *, left: int = 0) -> list[str]:
    """Lines of a table for a terminal; the first ``left`` columns are left-aligned, the others right-aligned.

    >>> aligned_rows([("gate", "time (s)"), ("1", "2.50")])
    ['gate  time (s)', '   1      2.50']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    sides = ["<"] * left + [">"] * (len(widths) - left)
    return [
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in zip(row, sides, widths, strict=True)) for row in rows
    ]


def named_rows(rows: Iterable[tuple[str, str]]) -> list[str]:
    """Lines for a terminal: names, and texts that begin below each other.

    >>> named_rows([("speed", "3 m/s"), ("end point", "x 1 m")])
    ['speed      3 m/s', 'end point  x 1 m']
    """
    rows = list(rows)
    width = max((len(name) for name, _ in rows), default=0)
    return [f"{name.ljust(width)}  {text}" for name, text in rows]


def facts_lines(result: Shown) -> list[str]:
    """Lines for a terminal: title and rows of the result's repr."""
    title, rows = result._repr_facts()
    return [title, *(f"  {line}" for line in named_rows(rows))]


def json_text(contents: Mapping[str, Any]) -> str:
    """JSON with one space of indentation; NaN and infinity raise ValueError."""
    return json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1)


def from_to(pair: Sequence[float], digits: int) -> str:
    """Text of a range, from its minimum to its maximum, with this number of significant digits.

    >>> from_to([0.04, 90.0], 3)
    '0.0400 to 90.0'
    """
    low, high = (significant(end, digits) for end in pair)
    return str(Message("{low} to {high}", low=low, high=high))


def probability(p: float) -> str:
    """Text of a p value with two digits; below 0.001 and above 0.99 only the limit.

    >>> probability(0.5234), probability(3e-12), probability(0.9999)
    ('0.52', '< 0.001', '> 0.99')
    """
    if _SMALLEST_P <= p <= _LARGEST_P:
        return significant(p, 2)
    sign, limit = ("<", _SMALLEST_P) if p < _SMALLEST_P else (">", _LARGEST_P)
    return f"{sign} {local_number(str(limit))}"


def p_equals(p: float) -> str:
    """Text of a p value inside a sentence: ``p = 0.52`` or ``p < 0.001``, not broken over lines."""
    text = probability(p)
    return (f"p {text}" if text[0] in "<>" else f"p = {text}").replace(" ", "\u00a0")


def counted(number: int, singular: str, plural: str) -> str:
    """A number with its noun in the current language.

    >>> counted(1, "{count} site", "{count} sites"), counted(12345, "{count} reading", "{count} readings")
    ('1 site', '12\u202f345 readings')
    """
    return translations(current_language()).ngettext(singular, plural, number).format(count=whole(number))


def whole(number: int) -> str:
    """Text of a count; five digits and more are grouped by thousands."""
    return str(number) if abs(number) < 10_000 else f"{number:,}".replace(",", "\u202f")


SYMBOL: Final = re.compile(r"(?:(?<![\w<>/])|(?<=_[A-Za-z0-9]/))([A-Za-zμ])_([A-Za-z0-9])(?![\w_])")
_PLAIN: Final = str.maketrans("−\u00a0\u202f", "-  ")
_PERCENT: Final = re.compile(r"(?<=\d) %")


def prose(template: str, **values: Any) -> Markup:
    """HTML of a template in the current language: symbols become markup, values are escaped unless they are Markup.

    >>> str(prose("H_V at {site}", site="a_b <i>"))
    '<i>H</i><sub>V</sub> at a_b &lt;i&gt;'
    """
    language = current_language()
    text = translations(language).gettext(template)
    return Markup(_HtmlFormatter(language).vformat(html(text), (), values))


class _HtmlFormatter(LocalFormatter):
    """Formatter for numbers of a language, which escapes all values except Markup for HTML."""

    def format_field(self, value: Any, format_spec: str) -> str:
        """HTML of a field: markup unchanged, all else formatted and escaped."""
        return value if isinstance(value, Markup) else Markup.escape(super().format_field(value, format_spec))


def html(text: str) -> Markup:
    """HTML of a text of skisnow in the current language, with markup for its symbols."""
    tied = _PERCENT.sub("\u00a0%", str(text))
    return Markup(SYMBOL.sub(r"<i>\1</i><sub>\2</sub>", str(Markup.escape(tied))))


def terminal_text(sentence: Markup) -> str:
    """Text of a sentence in HTML, for a terminal; symbols as ``H_V``.

    >>> terminal_text(prose("H_V is {value} N/mm³", value="−1"))
    'H_V is -1 N/mm³'
    """
    return Markup(sentence.replace("<sub>", "_")).striptags().translate(_PLAIN)


def figure_text(text: str, *, longest: int = 28) -> str:
    """Text from a user for a figure: one line without mathtext, at most `longest` characters.

    A long text is shortened in the middle, because similar names mostly differ at their ends. A leading underscore
    would hide a legend's entry, so a thin space precedes it.
    """
    line = " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())
    line = line or str(Message("(no name)"))
    head = longest // 2
    short = line if len(line) <= longest else f"{line[:head].rstrip()}…{line[head + 1 - longest :].lstrip()}"
    escaped = short.replace("$", r"\$")
    return f" {escaped}" if escaped.startswith("_") else escaped
