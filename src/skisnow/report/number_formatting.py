"""Numbers as people read them: a few significant digits, honest powers of ten, a dash where there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Sequence

Style: TypeAlias = Literal["typeset", "plain", "latex"]
"""Typeset: Unicode minus and powers; plain: what any terminal shows; latex: for text mode, by siunitx."""

ABSENT: Final = {"typeset": "–", "plain": "-", "latex": "--"}
_SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SMALLEST_P: Final = 0.001


def significant(value: float | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """Round to significant digits, without rounding whole numbers below 10⁶ away.

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


def from_to(pair: Sequence[float] | None, digits: int = 3, *, style: Style = "typeset") -> str:
    """Minimum and maximum of a range.

    >>> from_to([0.04, 90.0])
    '0.0400 to 90.0'
    """
    if pair is None:
        return ABSENT[style]
    return " to ".join(significant(end, digits, style=style) for end in pair)


def probability(p: float | None, *, style: Style = "typeset") -> str:
    """A p value to two digits; below 0.001 only that.

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
    """A count, grouped by thousands from five digits on."""
    return str(number) if abs(number) < 10_000 else f"{number:,}".replace(",", "\u202f")
