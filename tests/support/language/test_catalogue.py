"""Texts that are recognized, their places, sentences and parts; numbers; the file of a language."""

from __future__ import annotations

from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.language import ENGLISH, Catalogue, catalogue, codes, languages, require_language
from skisnow._support.language import catalogues as known_languages
from skisnow._support.language.catalogues import FIRST, LAST, read_catalogue

WORDS = {
    "snow": "Schnee",
    "The ski slips.": "Der Ski rutscht.",
    "the edge holds.": "die Kante hält.",
    "{} of the tool {}": "{1} hat {0}",
    "Stored: {}.": "Gespeichert: {0}.",
    "Stored: {} of {} tests.": "{0} von {1} Versuchen gespeichert.",
    "Ω holds.": "Ω hält.",
    "depth": "Tiefe",
    "width": "Breite",
}
GERMAN = Catalogue(WORDS)


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("snow", "Schnee"),
        ("ice", "ice"),
        ("", ""),
        ("The\N{NO-BREAK SPACE}ski slips.", "Der Ski rutscht."),
        ("The ski slips", "Der Ski rutscht"),  # as a sentence, whose stop goes again
        ("the ski slips", "Der Ski rutscht"),
        ("the edge holds", "die Kante hält"),
        ("depth of the tool 7", "7 hat Tiefe"),  # places in another order, each looked up
        ("Stored: snow.", "Gespeichert: Schnee."),
        ("Stored: 2 of 3 tests.", "2 von 3 Versuchen gespeichert."),  # the longer one
        ("Not Stored: snow.", "Not Stored: snow."),
        ("Stored: snow", "Stored: snow"),
        ("Stored: snow. The ski slips.", "Gespeichert: Schnee. Der Ski rutscht."),
        ("Stored: Fig. 3.", "Gespeichert: Fig. 3."),
        ("depth, width", "Tiefe, Breite"),
        ("depth; width, snow", "Tiefe; Breite, Schnee"),
        ("depth · snow; width", "Tiefe · Schnee; Breite"),
        ("ice, water", "ice, water"),
        ("ice, snow", "ice, Schnee"),
        ("The ski slips. (snow)", "Der Ski rutscht. (snow)"),
        ("The ski slips. Ω holds. 3 of the tool 4", "Der Ski rutscht. Ω hält. 4 hat 3"),
        ("The ski slips. so", "The ski slips. so"),  # no sentence begins small
        (f"{FIRST}1{LAST} snow {FIRST}22{LAST}", f"{FIRST}1{LAST} Schnee {FIRST}22{LAST}"),
        (f"{FIRST}1{LAST}snow", f"{FIRST}1{LAST}Schnee"),
        (f"snow{FIRST}1{LAST}", f"Schnee{FIRST}1{LAST}"),
        (f"{FIRST}1{LAST} ice", f"{FIRST}1{LAST} ice"),
        (f"The ski slips. {FIRST}1{LAST}", f"Der Ski rutscht. {FIRST}1{LAST}"),
    ],
)
def test_a_text_is_looked_up(english: str, german: str) -> None:
    assert GERMAN.translated(english) == german


def test_two_sentences_in_a_place_are_taken_where_they_are_not_known_one_by_one() -> None:
    """What a place holds is at most one sentence; a text is taken as a whole where nothing else would be said of it."""
    found = Catalogue({"Refused: {}": "Abgelehnt: {0}", "It is wet.": "Es ist nass.", "Dry.": "Trocken."})
    assert found.translated("Refused: It is wet. Dry.") == "Abgelehnt: Es ist nass. Trocken."
    assert found.translated("Refused: It is wet. Cold.") == "Abgelehnt: Es ist nass. Cold."
    assert found.translated("Refused: cold. Wet.") == "Abgelehnt: cold. Wet."


def test_names_that_users_gave_stay() -> None:
    kept = GERMAN.keeping({"snow"})
    assert (kept.translated("snow"), kept.translated("Stored: snow.")) == ("snow", "Gespeichert: snow.")
    assert kept.translated("depth") == "Tiefe"
    assert GERMAN.translated("snow") == "Schnee"


def test_as_given() -> None:
    assert GERMAN.as_given("Stored: {}.") == "Gespeichert: {0}."
    assert GERMAN.as_given("Stored: 3.") == "Stored: 3."


COMMA = Catalogue({"0.5": "0,5", "to": "bis"})


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("2.5 mm", "2,5 mm"),
        ("from 2.5 to 3.25 N", "from 2,5 bis 3,25 N"),
        ("−1 to −0.5 °, 30° to 45°, 10⁻³ to 2", "−1 bis −0,5 °, 30° bis 45°, 10⁻³ bis 2"),
        ("go to 3, 3 to go", "go to 3, 3 to go"),
        ("[1.5, 3] and [−1, −0.5] mm", "[1,5; 3] and [−1; −0,5] mm"),
        ("[a, b], [1, b]", "[a, b], [1, b]"),
        ("version 0.1.0, x1.5, 1.5x, 2.5/3, 3/2.5, 1,2.5", "version 0.1.0, x1.5, 1.5x, 2.5/3, 3/2.5, 1,2.5"),
        ("it is 2.5.", "it is 2,5."),
    ],
)
def test_numbers(english: str, german: str) -> None:
    assert COMMA.with_numbers(english) == german


def test_numbers_of_a_language_with_a_point() -> None:
    assert Catalogue({"to": "à"}).with_numbers("[1.5, 3] and 2.5 to 3") == "[1.5, 3] and 2.5 à 3"
    assert Catalogue({}).with_numbers("[1.5, 3] and 2.5 to 3") == "[1.5, 3] and 2.5 to 3"


def test_three_letters_are_enough_to_recognize_a_text() -> None:
    assert Catalogue({"{} per {}": "{0} je {1}"}).translated("2 per 3") == "2 je 3"
    with pytest.raises(ParameterError, match="too few letters"):
        Catalogue({"{} of {}": "{0} von {1}"})


def po(folder: Path, text: str) -> Path:
    place = folder / "xx.po"
    place.write_text(text, encoding="utf-8")
    return place


HEAD = '# made by hand\nmsgid ""\nmsgstr ""\n"Language: xx\\n"\n\n'


def test_a_file_of_translations(tmp_path: Path) -> None:
    """Long texts over several lines, marks of gettext, and a head that is no text."""
    first = '#: from/somewhere.py:3\n  msgid "a \\"b\\" "\n"c {}"\nmsgstr ""\n"{0} "\n"d"\n'
    text = f'{HEAD}{first}msgid "e"\nmsgstr "é"\n'
    assert read_catalogue(po(tmp_path, text)) == {'a "b" c {}': "{0} d", "e": "é"}
    assert read_catalogue(po(tmp_path, HEAD)) == {}
    assert read_catalogue(po(tmp_path, "")) == {}


@pytest.mark.parametrize(
    ("english", "translation"), [("a {} b {}", "{1} {0}"), ("a {}", "{0} and {0}"), ("a", "b"), ("a {}", "b {0}")]
)
def test_translations_with_the_same_places(english: str, translation: str, tmp_path: Path) -> None:
    text = f'msgid "{english}"\nmsgstr "{translation}"\n'
    assert read_catalogue(po(tmp_path, text)) == {english: translation}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{HEAD}msgid 'a'\n", "xx.po, line 6: \"msgid 'a'\" is no line of a PO file"),
        ('msgctxt "a"\n', "line 1"),
        ('msgid "a"\nmsgstr "{0}"\n', "translation of 'a' has other places: '{0}'"),
        ('msgid "a {}"\nmsgstr "b"\n', "other places"),
        ('msgid "a {} {}"\nmsgstr "{0} {2}"\n', "other places"),
    ],
)
def test_what_is_no_file_of_translations(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as told:
        read_catalogue(po(tmp_path, text))
    assert words in str(told.value)


def test_which_languages_there_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert codes() == ["en", "de"]
    assert languages() == {"en": "English", "de": "Deutsch"}
    require_language("de")
    require_language(ENGLISH)
    with pytest.raises(ParameterError, match="en, de"):
        require_language("fr")
    assert catalogue("en").translated("snow") == "snow"
    for code in ("sv", "it"):
        (tmp_path / f"{code}.po").write_text("", encoding="utf-8")
    monkeypatch.setattr(known_languages, "FOLDER", tmp_path)
    assert codes() == ["en", "it", "sv"]
