"""A report in another language: its HTML is read block by block, and each is looked up in the language's catalogue.

Reports are written in English. A block (a paragraph, a cell, a caption) is looked up as a plain text, with symbols as
``H_V``; what else is set inside it, a bold number or the name of a file, is one of the text's places.
"""

from __future__ import annotations

import re
from html import unescape
from typing import TYPE_CHECKING, Final

from markupsafe import escape

from .._support.language import ENGLISH, catalogue
from .._support.language.catalogue import FIRST, LAST
from .symbols import SYMBOL, html

if TYPE_CHECKING:
    from collections.abc import Set

_WITHIN: Final = "i|b|strong|em|cite|sub|sup|small|span|a|time"
_OPAQUE: Final = re.compile(r"<(code|math)\b.*?</\1>", re.DOTALL)
"""No words of ours, but for the numbers and texts of a formula."""
_BORDER: Final = re.compile(rf"<(style|script)\b.*?</\1>|<(?!/?(?:{_WITHIN})\b)[^>]*>", re.DOTALL)
"""What ends a block."""
_ELEMENT: Final = re.compile(rf"<({_WITHIN})\b([^>]*)>([^<]*)</\1>")
_SET_SYMBOL: Final = re.compile(r"<i>([A-Za-zμ])</i><sub>(\w)</sub>|(?<![\w>])([A-Za-zμ])<sub>(\w)</sub>")
_SAID_BY_TAGS: Final = re.compile(r'\b(alt|aria-label|data-name)="([^"]*)"')
_IN_FORMULA: Final = re.compile(r"(?<=<mn>)[^<]+|(?<=<mtext>)[^<]+")
_UNIT: Final = re.compile(r"(.+?)( \([^()]*\))")
_PUT_AWAY: Final = re.compile(rf"{FIRST}(\d+){LAST}")
_UNDERSCORE: Final = "\ue002"
_DAY: Final = re.compile(r"\d{1,2}")


def translated_html(page: str, language: str, *, names: Set[str] = frozenset()) -> str:
    """A page, or a part of one, in another language.

    Parameters
    ----------
    page
        HTML in English, with all that users wrote escaped.
    language
        Its code; there is a catalogue of it.
    names
        What users wrote and is no word of ours: it stays as it is.

    Examples
    --------
    >>> print(translated_html("<td>yes</td><td><i>H</i><sub>V</sub> [0.5, 1]</td><td>0.1.0</td>", "de"))
    <td>ja</td><td><i>H</i><sub>V</sub> [0,5; 1]</td><td>0.1.0</td>
    """
    return page if language == ENGLISH else _Translation(language, names).of(page)


class _Translation:
    """One page on its way: what was put away from the blocks, by number."""

    def __init__(self, language: str, names: Set[str]) -> None:
        self._language = language
        self._names = names
        self._catalogue = catalogue(language).keeping(names)
        self._kept: list[str] = []

    def of(self, page: str) -> str:
        page = _OPAQUE.sub(lambda found: self._put_away(self._formula(found[0])), page)
        parts, end = [], 0
        for border in _BORDER.finditer(page):
            parts += [self._block(page[end : border.start()]), self._tag(border[0])]
            end = border.end()
        whole = "".join([*parts, self._block(page[end:])])
        while _PUT_AWAY.search(whole):
            whole = _PUT_AWAY.sub(lambda found: self._kept[int(found[1])], whole)
        return whole

    def _put_away(self, content: str) -> str:
        self._kept.append(content)
        return f"{FIRST}{len(self._kept) - 1}{LAST}"

    def _formula(self, element: str) -> str:
        if not element.startswith("<math"):
            return element
        return _IN_FORMULA.sub(lambda found: str(escape(self._words(unescape(found[0])))), element)

    def _tag(self, tag: str) -> str:
        if tag.startswith("<html"):
            return tag.replace(f'lang="{ENGLISH}"', f'lang="{self._language}"')
        return _SAID_BY_TAGS.sub(lambda found: f'{found[1]}="{escape(self._named(unescape(found[2])))}"', tag)

    def _named(self, text: str) -> str:
        """What an attribute says: a sentence, or a name with its unit behind it."""
        said, unit = self._words(text), _UNIT.fullmatch(text)
        if said == text and unit:
            return self._words(unit[1]) + unit[2]
        return said

    def _block(self, text: str) -> str:
        if not any(map(str.isalnum, text)):
            return text
        text = SYMBOL.sub(rf"\1{_UNDERSCORE}\2", text)  # somebody's name that looks like a symbol
        text = _SET_SYMBOL.sub(lambda found: f"{found[1] or found[3]}_{found[2] or found[4]}", text)
        while found := _ELEMENT.search(text):
            tag, attributes, inner = found.groups()
            said = self._date(inner) if tag == "time" else self._set(inner)
            put_away = self._put_away(self._tag(f"<{tag}{attributes}>") + f"{said}</{tag}>")
            text = text[: found.start()] + put_away + text[found.end() :]
        return self._set(text)

    def _set(self, text: str) -> str:
        if _UNDERSCORE in text:
            return str(escape(self._words(unescape(text.replace(_UNDERSCORE, "_")))))
        return str(html(self._words(unescape(text))))

    def _words(self, text: str) -> str:
        """A text in the language, what stands around its words left as it is."""
        inner = text.strip(" \n")
        begins = text.find(inner)
        said = text[:begins] + self._catalogue.translated(inner) + text[begins + len(inner) :]
        return said if inner in self._names else self._catalogue.with_numbers(said)

    def _date(self, text: str) -> str:
        """A day and its month; the year and the time of day stay."""
        parts = text.split(" ")
        return " ".join(self._catalogue.translated(f"day {each}" if _DAY.fullmatch(each) else each) for each in parts)
