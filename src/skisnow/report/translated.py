"""Translation of the HTML of a report: each block is looked up in the catalogue of the language.

Reports are written in English. A block (a paragraph, a cell, a caption) is looked up as plain text, with symbols such
as ``H_V``; other elements inside it, such as a bold number or the name of a file, are replaced by placeholders.
"""

from __future__ import annotations

import re
from html import unescape
from typing import TYPE_CHECKING, Final

from markupsafe import escape

from .._support.language import ENGLISH, catalogue
from .._support.language.catalogues import FIRST, LAST
from .symbols import SYMBOL, html

if TYPE_CHECKING:
    from collections.abc import Set

_WITHIN: Final = "i|b|strong|em|cite|sub|sup|small|span|a|time"
_OPAQUE: Final = re.compile(r"<(code|math)\b.*?</\1>", re.DOTALL)
"""Elements that are not translated, except the numbers and texts of a formula."""
_BORDER: Final = re.compile(rf"<(style|script)\b.*?</\1>|<(?!/?(?:{_WITHIN})\b)[^>]*>", re.DOTALL)
"""Tags that end a block."""
_ELEMENT: Final = re.compile(rf"<({_WITHIN})\b([^>]*)>([^<]*)</\1>")
_SET_SYMBOL: Final = re.compile(r"<i>([A-Za-zμ])</i><sub>(\w)</sub>|(?<![\w>])([A-Za-zμ])<sub>(\w)</sub>")
_TRANSLATED_ATTRIBUTES: Final = re.compile(r'\b(alt|aria-label|data-name)="([^"]*)"')
_IN_FORMULA: Final = re.compile(r"(?<=<mn>)[^<]+|(?<=<mtext>)[^<]+")
_UNIT: Final = re.compile(r"(.+?)( \([^()]*\))")
_PLACEHOLDER: Final = re.compile(rf"{FIRST}(\d+){LAST}")
_UNDERSCORE: Final = "\ue002"
_DAY: Final = re.compile(r"\d{1,2}")


def translated_html(page: str, language: str, *, names: Set[str] = frozenset()) -> str:
    """Translate a page or a part of one.

    Parameters
    ----------
    page
        HTML in English, with the texts of users escaped.
    language
        Code of a language with a catalogue.
    names
        Texts of users, which are not translated.

    Examples
    --------
    >>> print(translated_html("<td>yes</td><td><i>H</i><sub>V</sub> [0.5, 1]</td><td>0.1.0</td>", "de"))
    <td>ja</td><td><i>H</i><sub>V</sub> [0,5; 1]</td><td>0.1.0</td>
    """
    return page if language == ENGLISH else _Translation(language, names).of(page)


class _Translation:
    """Translation of one page, with the text that placeholders stand for."""

    def __init__(self, language: str, names: Set[str]) -> None:
        self._language = language
        self._names = names
        self._catalogue = catalogue(language).keeping(names)
        self._replaced: list[str] = []

    def of(self, page: str) -> str:
        page = _OPAQUE.sub(lambda match: self._replace_by_placeholder(self._formula(match[0])), page)
        parts, end = [], 0
        for border in _BORDER.finditer(page):
            parts += [self._block(page[end : border.start()]), self._tag(border[0])]
            end = border.end()
        whole = "".join([*parts, self._block(page[end:])])
        while _PLACEHOLDER.search(whole):
            whole = _PLACEHOLDER.sub(lambda match: self._replaced[int(match[1])], whole)
        return whole

    def _replace_by_placeholder(self, content: str) -> str:
        self._replaced.append(content)
        return f"{FIRST}{len(self._replaced) - 1}{LAST}"

    def _formula(self, element: str) -> str:
        if not element.startswith("<math"):
            return element
        return _IN_FORMULA.sub(lambda match: str(escape(self._words(unescape(match[0])))), element)

    def _tag(self, tag: str) -> str:
        if tag.startswith("<html"):
            return tag.replace(f'lang="{ENGLISH}"', f'lang="{self._language}"')
        return _TRANSLATED_ATTRIBUTES.sub(lambda match: f'{match[1]}="{escape(self._named(unescape(match[2])))}"', tag)

    def _named(self, text: str) -> str:
        """Translate an attribute: a sentence, or a name with its unit."""
        translated, unit = self._words(text), _UNIT.fullmatch(text)
        if translated == text and unit:
            return self._words(unit[1]) + unit[2]
        return translated

    def _block(self, text: str) -> str:
        if not any(map(str.isalnum, text)):
            return text
        text = SYMBOL.sub(rf"\1{_UNDERSCORE}\2", text)  # a user's name that looks like a symbol
        text = _SET_SYMBOL.sub(lambda match: f"{match[1] or match[3]}_{match[2] or match[4]}", text)
        while match := _ELEMENT.search(text):
            tag, attributes, inner = match.groups()
            translated = self._date(inner) if tag == "time" else self._set(inner)
            placeholder = self._replace_by_placeholder(self._tag(f"<{tag}{attributes}>") + f"{translated}</{tag}>")
            text = text[: match.start()] + placeholder + text[match.end() :]
        return self._set(text)

    def _set(self, text: str) -> str:
        if _UNDERSCORE in text:
            return str(escape(self._words(unescape(text.replace(_UNDERSCORE, "_")))))
        return str(html(self._words(unescape(text))))

    def _words(self, text: str) -> str:
        """Translate a text and keep the blanks around it."""
        inner = text.strip(" \n")
        begins = text.find(inner)
        translated = text[:begins] + self._catalogue.translated(inner) + text[begins + len(inner) :]
        return translated if inner in self._names else self._catalogue.with_numbers(translated)

    def _date(self, text: str) -> str:
        """Translate day and month; year and time of day are not changed."""
        parts = text.split(" ")
        return " ".join(self._catalogue.translated(f"day {part}" if _DAY.fullmatch(part) else part) for part in parts)
