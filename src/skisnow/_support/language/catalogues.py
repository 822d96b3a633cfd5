"""The words of pages and reports in another language: a catalogue of gettext, one file for each language.

Pages and reports are written in English. What is shown is looked up as a whole; where the English text has places for
what users wrote and what was computed, ``{}`` in the catalogue, the text is recognized by what stands around them. What
is in such a place is looked up in turn: a message of the library inside a sentence of the page is translated with it.
A text that is not recognized is looked up as a sentence with its full stop, then sentence by sentence, then by the
parts between its semicolons and commas.
"""

from __future__ import annotations

import re
from ast import literal_eval
from copy import copy
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ..errors import ParameterError
from ..messages import ENGLISH, Message, translations

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Set
    from pathlib import Path

_LINE: Final = re.compile(r'(?:(msgid|msgstr) )?(".*")')
_PLACE: Final = re.compile(r"\{\d*\}")
FIRST, LAST = "\ue000", "\ue001"
"""Around the number of what was put away from a page: it has words of its own, or none."""
_AROUND: Final = re.compile(rf"((?:{FIRST}\d+{LAST}| )*)(.*?)((?:{FIRST}\d+{LAST}| )*)", re.DOTALL)
_SENTENCES: Final = re.compile(rf"(?<=\.)(?<!Fig\.)( )(?=[^\W_a-z]|[{FIRST}(])")
"""Between two of them: before a capital, a Greek letter, a number, a bracket or what was put away."""
_BETWEEN: Final = (" · ", "; ", ", ")
"""What stands between parts that are said one after the other."""
LEAST_LETTERS: Final = 3
"""A text with fewer letters around its places would be recognized in anything."""
_KNOWN: Final = 4096
DECIMAL, TO = "0.5", "to"
"""Their translations tell the decimal sign, and what stands between the ends of a range."""
_NUMBER: Final = re.compile(r"(?<![\w.,/])(\d+)\.(\d+)(?![\w/]|\.\w)")
_RANGE: Final = re.compile(r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹°]) to (?=[−\d])")
_PAIR: Final = re.compile(r"\[([−\d][^\s\[\],]*), ([−\d][^\s\[\],]*)\]")


@dataclass(frozen=True)
class _Pattern:
    around: list[str]
    translation: str

    @cached_property
    def text(self) -> re.Pattern[str]:
        """The whole text, its places as groups."""
        return re.compile("(.*?)".join(map(re.escape, self.around)), re.DOTALL)

    def places(self, text: str) -> tuple[str, ...] | None:
        """What stands in the places of a text that is recognized."""
        at = 0
        for piece in self.around:  # quicker than the expression, for a text that is not
            at = text.find(piece, at) + len(piece)
            if at < len(piece):
                return None
        found = self.text.fullmatch(text)
        return found.groups() if found else None


class Catalogue:
    """English texts with their translations.

    Parameters
    ----------
    translations
        By the English text, with ``{}`` for each place; in the translation ``{0}`` is the first of them.

    Examples
    --------
    >>> german = Catalogue({"Stored: {}.": "Gespeichert: {0}.", "test {}": "Versuch {0}", "0.5": "0,5"})
    >>> german.translated("Stored: test 7. Stored: test 8.")
    'Gespeichert: Versuch 7. Gespeichert: Versuch 8.'
    >>> german.translated("what nobody has translated")
    'what nobody has translated'
    >>> german.with_numbers("2.5 mm [1.5, 3], version 0.1.0")
    '2,5 mm [1,5; 3], version 0.1.0'
    """

    def __init__(self, translations: Mapping[str, str], *, language: str = ENGLISH) -> None:
        self._language = language
        self._translations = dict(translations)
        self._whole = {english: text for english, text in translations.items() if not _PLACE.search(english)}
        open_ones = [english for english in translations if _PLACE.search(english)]
        open_ones.sort(key=lambda english: -len(_PLACE.sub("", english)))
        self._patterns = [_pattern(english, translations[english]) for english in open_ones]
        self._sign = self._whole.get(DECIMAL, DECIMAL)[1]
        self._names: Set[str] = frozenset()
        self._of_text = lru_cache(_KNOWN)(self._translated)

    def translated(self, text: str) -> str:
        """A text in the language; a message by its template."""
        return text.text(self._language) if isinstance(text, Message) else self._of_text(text)

    def keeping(self, names: Set[str]) -> Catalogue:
        """The same, but for names that users gave: they stay as they are, wherever they stand alone or in a place."""
        other = copy(self)
        other._names = names
        other._of_text = lru_cache(_KNOWN)(other._translated)
        return other

    def as_given(self, english: str) -> str:
        """The translation of just this text, its places still open; the text itself where there is none."""
        if english in self._translations:
            return self._translations[english]
        return translations(self._language).gettext(english) if english else english

    def _translated(self, text: str) -> str:
        plain = text.replace("\N{NO-BREAK SPACE}", " ")
        if plain in self._names or not plain:
            return text
        if plain in self._whole:
            return self._whole[plain]
        for sentence in (f"{plain}.", f"{plain[0].upper()}{plain[1:]}."):
            if sentence in self._whole:
                return self._whole[sentence].removesuffix(".")
        sentences = _SENTENCES.split(plain)
        said = self._recognized(plain, most_sentences=1)
        if said is None and len(sentences) > 1:
            each = [self.translated(sentence) for sentence in sentences[::2]]
            if any(new == old and any(map(str.isalpha, old)) for new, old in zip(each, sentences[::2], strict=True)):
                said = self._recognized(plain, most_sentences=len(sentences))
            said = " ".join(each) if said is None else said
        return said or self._in_parts(plain) or text

    def _recognized(self, text: str, *, most_sentences: int) -> str | None:
        """By the longest pattern whose places have no more sentences than that."""
        for pattern in self._patterns:
            places = pattern.places(text)
            if places is not None and all(len(_SENTENCES.findall(each)) < most_sentences for each in places):
                return pattern.translation.format(*map(self.translated, places))
        return None

    def _in_parts(self, text: str) -> str | None:
        """What stands between things put away, then parts between semicolons, then commas; None: nothing is known."""
        around = _AROUND.fullmatch(text)
        assert around is not None  # it may be empty
        if around[1] or around[3]:
            said = around[1] + self.translated(around[2]) + around[3]
            return None if said == text else said
        for between in _BETWEEN:
            if between in text:
                said = between.join(map(self.translated, text.split(between)))
                return None if said == text else said
        return None

    def with_numbers(self, text: str) -> str:
        """A text with its numbers as the language writes them; where that takes the comma, pairs have a semicolon."""
        if TO in self._whole:
            text = _RANGE.sub(f" {self._whole[TO]} ", text)
        if self._sign == ".":
            return text
        return _NUMBER.sub(rf"\1{self._sign}\2", _PAIR.sub(r"[\1; \2]", text))


def _pattern(english: str, translation: str) -> _Pattern:
    around = _PLACE.split(english)
    if sum(map(str.isalpha, "".join(around))) < LEAST_LETTERS:
        raise ParameterError(f"the text {english!r} has too few letters to be recognized")
    return _Pattern(around, translation)


def read_catalogue(path: Path) -> dict[str, str]:
    """The translations of a PO file, as gettext's tools write them; without plural forms and contexts.

    Raises
    ------
    ParameterError
        A line is none of such a file, or a translation has other places than its English text.
    """
    found: dict[str, str] = {}
    for english, text in _entries(path):
        if sorted(set(_PLACE.findall(text))) != [f"{{{n}}}" for n in range(len(_PLACE.findall(english)))]:
            raise ParameterError(f"{path.name}: the translation of {english!r} has other places: {text!r}")
        found[english] = text
    found.pop("", None)  # the head of the file
    return found


def _entries(path: Path) -> Iterator[tuple[str, str]]:
    entry: dict[str, str] = {}
    key = ""
    for number, raw in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        said = _LINE.fullmatch(line)
        if said is None:
            raise ParameterError(f"{path.name}, line {number}: {line!r} is no line of a PO file")
        if said[1] == "msgid" and "msgstr" in entry:
            yield entry["msgid"], entry["msgstr"]
            entry = {}
        key = said[1] or key
        entry[key] = entry.get(key, "") + str(literal_eval(said[2]))
    if "msgstr" in entry:
        yield entry["msgid"], entry["msgstr"]


FOLDER: Final = Path(__file__).parent / "texts"
NAME: Final = "English"
"""What a language calls itself: in a catalogue the translation of this word."""


def codes() -> list[str]:
    """The codes of all languages; a further one is one more file."""
    return [ENGLISH, *sorted(place.stem for place in FOLDER.glob("*.po"))]


@cache
def languages() -> Mapping[str, str]:
    """What each language calls itself, by its code."""
    return {code: catalogue(code).translated(NAME) for code in codes()}


@cache
def catalogue(code: str) -> Catalogue:
    """The words of a language; English has none."""
    return Catalogue({} if code == ENGLISH else read_catalogue(FOLDER / f"{code}.po"), language=code)


def require_language(code: str) -> None:
    """Refuse a language before long work is done for it.

    Raises
    ------
    ParameterError
        There are no texts of it.
    """
    if code not in codes():
        raise ParameterError(f"the language is one of {', '.join(codes())}; {code!r} is given")
