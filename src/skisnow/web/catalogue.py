"""The words of the pages in another language: a catalogue of gettext, one file for each language.

The pages are written in English. What is shown is looked up as a whole; where the English text has places for what
users wrote and what was computed, ``{}`` in the catalogue, the text is recognized by what stands around them. What is
in such a place is looked up in turn: a message of the library inside a sentence of the page is translated with it.
"""

from __future__ import annotations

import re
from ast import literal_eval
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from ..errors import ParameterError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

_LINE: Final = re.compile(r'(?:(msgid|msgstr) )?(".*")')
_PLACE: Final = re.compile(r"\{\d*\}")
_LETTERS: Final = 3
"""A text with fewer letters around its places would be recognized in anything."""
_KNOWN: Final = 4096


@dataclass(frozen=True, slots=True)
class _Pattern:
    text: re.Pattern[str]
    translation: str


class Catalogue:
    """English texts with their translations.

    Parameters
    ----------
    translations
        By the English text, with ``{}`` for each place; in the translation ``{0}`` is the first of them.

    Examples
    --------
    >>> german = Catalogue({"Stored: {}.": "Gespeichert: {0}.", "test {}": "Versuch {0}"})
    >>> german.translated("Stored: test 7.")
    'Gespeichert: Versuch 7.'
    >>> german.translated("what nobody has translated")
    'what nobody has translated'
    """

    def __init__(self, translations: Mapping[str, str]) -> None:
        self._whole = {english: text for english, text in translations.items() if not _PLACE.search(english)}
        open_ones = [english for english in translations if _PLACE.search(english)]
        open_ones.sort(key=lambda english: -len(_PLACE.sub("", english)))
        self._patterns = [_Pattern(_recognized(english), translations[english]) for english in open_ones]
        self.translated = lru_cache(_KNOWN)(self._translated)

    def _translated(self, text: str) -> str:
        if text in self._whole:
            return self._whole[text]
        for pattern in self._patterns:
            if found := pattern.text.fullmatch(text):
                return pattern.translation.format(*map(self._translated, found.groups()))
        return text


def _recognized(english: str) -> re.Pattern[str]:
    around = _PLACE.split(english)
    if sum(map(str.isalpha, "".join(around))) < _LETTERS:
        raise ParameterError(f"the text {english!r} has too few letters to be recognized")
    return re.compile("(.*?)".join(map(re.escape, around)), re.DOTALL)


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
