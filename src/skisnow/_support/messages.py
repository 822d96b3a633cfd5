"""Messages for users: templates with named fields, which are translated when they are shown.

Write each message where it arises, as whole sentences in English. `build_backend/messages.py` extracts the templates
into ``translations/<language>/<package>.po`` and compiles these files.

>>> message = Message("The depth of {depth_mm} mm is above {limit_mm:.1f} mm.", depth_mm=12.5, limit_mm=10.0)
>>> print(message)
The depth of 12.5 mm is above 10.0 mm.
>>> message.fields["depth_mm"]
12.5
"""

from __future__ import annotations

import gettext
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import date, datetime
from functools import cache
from numbers import Real
from pathlib import Path
from string import Formatter
from typing import Any, Final

ENGLISH: Final = "en"
LANGUAGE_OF_ERRORS: Final = "SKISNOW_LANGUAGE"
"""Environment variable with the language in which a command prints its errors; the lab sets it."""
FOLDER: Final = Path(__file__).parent / "translations"
_LANGUAGE: Final = ContextVar[str]("language")
_MONTHS: Final = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


_languages_of_pages: list[Callable[[], str]] = []


@contextmanager
def in_language(language: str) -> Iterator[None]:
    """Set the current language in the block, which `str(message)` and the numbers of `report.formatting` use."""
    before = _LANGUAGE.set(language)
    try:
        yield
    finally:
        _LANGUAGE.reset(before)


def current_language() -> str:
    """Code of the language set by `in_language`, otherwise that of the current page of the lab, otherwise "en"."""
    language = _LANGUAGE.get(None)
    if language is not None:
        return language
    return _languages_of_pages[0]() if _languages_of_pages else ENGLISH


def use_language_of_pages(language: Callable[[], str]) -> None:
    """Register the function that returns the language of the current page, used when `in_language` sets none."""
    _languages_of_pages[:] = [language]


class Message(str):
    """English text of a template with its fields; `str(message)` and f-strings give it in the current language.

    template: whole sentences with named fields, as for `str.format`. Must be a literal (or marked by `template`), so
        that it is extracted for translation.
    fields: values: text, numbers, dates and paths; a tuple of numbers is an interval or a vector ([1.5, 3]), a list is
        an enumeration. Messages, errors and problems are translated, text is not.
    """

    template: str
    plural: str | None
    fields: dict[str, Any]

    def __new__(cls, template: str, /, **fields: Any) -> Message:
        return _message(template, None, fields)

    def text(self, language: str = ENGLISH) -> str:
        """The message in a language, with its numbers and dates as written there."""
        if language == ENGLISH:
            return super().__str__()
        return _translate_and_fill(self.template, self.plural, self.fields, language)

    def __str__(self) -> str:
        return self.text(current_language())

    def __reduce__(self) -> tuple[Any, ...]:
        return _message, (self.template, self.plural, self.fields)


def count_message(singular: str, plural: str, /, *, count: int, **fields: Any) -> Message:
    """Message with the template for one or for several, by the field ``count``.

    >>> print(count_message("{count} test of {name}", "{count} tests of {name}", count=2, name="Ann"))
    2 tests of Ann
    """
    return _message(singular, plural, {"count": count, **fields})


def template(text: str) -> str:
    """Mark a text for extraction by the translation tools, such as a template in a table; returns it unchanged."""
    return text


def joined(messages: Sequence[object], between: str = " ") -> Message:
    """One message of several whole ones, such as sentences of a paragraph, with a text between them."""
    names = [f"part_{number}" for number in range(len(messages))]
    return Message(between.join(f"{{{name}}}" for name in names), **dict(zip(names, messages, strict=True)))


def languages() -> dict[str, str]:
    """Name of each language in itself, by its code; English first."""
    codes = [ENGLISH, *sorted(path.stem for path in FOLDER.glob("*.mo"))]
    return {code: translations(code).gettext(template("English")) for code in codes}


def translated(value: object, language: str) -> str:
    """Text of a value, such as a message, number, date or list, in a language."""
    return _formatter(language).format_field(value, "")


@cache
def translations(language: str) -> gettext.NullTranslations:
    """Compiled translations of a language; those of English return each text unchanged."""
    if language == ENGLISH:
        return gettext.NullTranslations()
    with (FOLDER / f"{language}.mo").open("rb") as file:
        return gettext.GNUTranslations(file)


@cache
def decimal_sign(language: str) -> str:
    """Decimal sign of a language, from the translation of "0.5"."""
    return translations(language).gettext(template("0.5"))[1]


def local_number(text: str) -> str:
    """A number with a decimal point as it is written in the current language."""
    return text.replace(".", decimal_sign(current_language()))


def _message(template: str, plural: str | None, fields: dict[str, Any]) -> Message:
    """Message in English whose template, plural and fields are kept for translation."""
    fields = {name: _plain(value) for name, value in fields.items()}
    message = str.__new__(Message, _translate_and_fill(template, plural, fields, ENGLISH))
    message.template, message.plural, message.fields = template, plural, fields
    return message


def _plain(value: Any) -> Any:
    """Field of a message that can be pickled: the value itself, or its text for an object of another class."""
    if isinstance(value, BaseException):
        return getattr(value, "message", None) or str(value)
    if isinstance(value, list | tuple | set | frozenset):
        return (
            type(value)(map(_plain, value))
            if type(value) in (list, tuple, set, frozenset)
            else list(map(_plain, value))
        )
    plain = value is None or isinstance(value, str | Real | date | Path | dict)
    return value if plain or callable(getattr(type(value), "text", None)) else str(value)


def _translate_and_fill(template: str, plural: str | None, fields: dict[str, Any], language: str) -> str:
    """Text of a template in a language; with a plural, the form fits the field `count`."""
    words = translations(language)
    if plural is not None:
        template = words.ngettext(template, plural, fields["count"])
    elif template:  # gettext gives the head of the file for an empty text
        template = words.gettext(template)
    return _formatter(language).vformat(template, (), fields)


class LocalFormatter(Formatter):
    """Formatter like `str.format` that writes numbers, dates and messages in a language."""

    def __init__(self, language: str) -> None:
        self._language = language
        self._sign = decimal_sign(language)

    def format_field(self, value: Any, format_spec: str) -> str:
        """Text of a field in this language: a message, number, date or list of them by local rules."""
        if callable(getattr(type(value), "text", None)):
            return format(value.text(self._language), format_spec)
        if isinstance(value, bool):
            return format(str(value), format_spec)
        if isinstance(value, Real):
            return self._format_number(value, format_spec)
        if isinstance(value, date) and not format_spec:
            month = f" {_MONTHS[value.month - 1]} " if self._language == ENGLISH else f". {value.month}. "
            return f"{value.day}{month}{value.year}" + (f", {value:%H:%M}" if isinstance(value, datetime) else "")
        if isinstance(value, list | tuple | set | frozenset | dict):
            return self._format_list(value, format_spec)
        return format(value if isinstance(value, str) or format_spec else str(value), format_spec)

    def _format_number(self, value: Any, spec: str) -> str:
        """Number with the decimal sign, minus and percent of the language; 12 digits without a format."""
        text = format(value, spec or ("" if isinstance(value, int) else ".12g"))
        if text.startswith("-") and ("+" in spec or spec[:1] == "-" or self._language != ENGLISH):
            text = f"−{text[1:]}"
        if self._sign == ".":
            return text
        return text.translate({ord("."): self._sign, ord(","): ".", ord("%"): "\N{NO-BREAK SPACE}%"})

    def _format_list(self, values: Any, spec: str) -> str:
        """Items separated by commas, or semicolons if numbers have commas; brackets for a tuple of numbers."""
        items = [self.format_field(value, spec) for value in values]
        numbers = all(isinstance(value, Real) for value in values)
        text = ("; " if numbers and any("," in item for item in items) else ", ").join(items)
        return f"[{text}]" if numbers and isinstance(values, tuple) else text


_formatter: Final = cache(LocalFormatter)
"""Formatter of a language, the same object for each call."""
_OUTCOMES: Final = (
    template("finished"), template("distance reached"), template("end of slope"), template("tipped over"),
    template("fell"), template("airborne"), template("sunk"), template("missed gate"), template("energy open"),
    template("step too small"), template("not finite"), template("interrupted"), template("converged"),
    template("not converged"), template("not identifiable"), template("too few points"), template("error"),
    template("equilibrium"), template("slips"), template("sinks"), template("bridges"), template("passed"),
    template("straddled"), template("missed"), template("backwards"), template("not reached"), template("left"),
    template("right"),
)  # fmt: skip


def outcome_words(outcome: str) -> str:
    """Words that can be translated for an outcome such as "missed_gate", or for the side of a gate."""
    words = outcome.replace("_", " ")
    return Message(words) if words in _OUTCOMES else words
