"""The reports of a turn, of an identification and of the gates of two runs in German: nothing is left in English."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.messages import Message, in_language
from skisnow.identification import uncertainty as words
from skisnow.identification.result import Identification
from skisnow.report import identification as identify_report
from skisnow.report.figures.drawing import Drawing, Picture
from skisnow.report.figures.style import journal_style
from skisnow.report.race import folder as gaps_report
from skisnow.report.turn import page as turn_report
from skisnow.report.turn.chain import TurnChain
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.track.course.gates_table import GateGap

from . import test_identify_report, test_turn_report
from .test_translated import ENGLISH, VERSION, texts, written

chain, found = test_turn_report.chain, test_identify_report.found  # fixtures
KEYS = frozenset(
    {*SCENARIO_KEYS, "giant-slalom", "false", "true", "BibTeX", "Start", "Start (J)", VERSION, f", {VERSION}"}
)
NAMES = ("run A", "run B")
CHOICES = frozenset(word for key in SCENARIO_KEYS.values() for word in key.choices)
GAPS = tuple(
    GateGap(gate=gate, outcome="passed", other_outcome=other, time=own, other_time=its, gap=gap, lost=lost)
    for gate, other, own, its, gap, lost in (
        ("1", "passed", 1.5, 1.25, 0.25, 0.25),
        ("2", "missed", 2.5, None, None, None),
        ("3", "passed", 3.5, 3.75, -0.25, -0.5),
    )
)


def drawn(drawings: Iterator[Drawing], names: frozenset[str], language: str) -> list[Picture]:
    """Drawn in a language, without files; no word in a German one is English."""
    pictures = []
    with journal_style(), in_language(language):
        for each in drawings:
            shown = {re.sub(r"\$[^$]*\$", "", text) for text in written(each)} - names
            assert language == "en" or {text for text in shown if ENGLISH.search(_without(text, names))} == set()
            assert any(re.search("[a-z]{4}", text) for text in shown)
            pictures.append(Picture(each.name, each.whole_caption, each.alt, each.wide, "", b""))
    return pictures


def _without(text: str, names: frozenset[str]) -> str:
    for name in sorted(names, key=len, reverse=True):
        text = text.replace(name, "")
    return text


def left(page: Callable[[str], str], names: frozenset[str], *, fewest: int) -> set[str]:
    """Texts of a page that stay as they are or have an English word, but for names and keys."""
    english, german = (texts(page(language)) for language in ("en", "de"))
    words = {each for each in english if re.search("[A-Za-z]{4}", _without(each, names))} - KEYS
    assert len(words) > fewest
    stayed = words & german
    return stayed | {
        each for each in german - KEYS if ENGLISH.search(_without(each, names)) and "The skisnow developers" not in each
    }


def test_no_text_of_a_german_turn_is_left_in_english(chain: TurnChain) -> None:
    names = frozenset({chain.campaign, chain.site, chain.snow.source, *chain.runs, *CHOICES, "Hypoplastic,"})

    def page(language: str) -> str:
        pictures = drawn(turn_report._drawings(chain), names, language)
        return turn_report.turn_page(chain, pictures, language=language)

    assert left(page, names, fewest=120) == set()


def names_in(found: Identification) -> frozenset[str]:
    parameters = {text for row in found.parameters for text in (row.parameter.name, row.parameter.key)}
    files = {fit.name for fit in found.fits} | {name for name, _ in found.data}
    return frozenset({found.scenario, *files, *parameters})


def test_no_text_of_a_german_identification_is_left_in_english(found: Identification) -> None:
    names = names_in(found) | {"Two are hardly told apart", "By Gauss and Newton", "The search ended", "photo cells"}

    def page(language: str) -> str:
        pictures = drawn(identify_report._drawings(found), names, language)
        return identify_report.identify_page(found, pictures, language=language)

    assert left(page, names, fewest=30) == set()


def test_no_text_of_german_gaps_is_left_in_english() -> None:
    names = frozenset(NAMES)

    def page(language: str) -> str:
        pictures = drawn(gaps_report._drawings(GAPS, NAMES), names, language)
        return gaps_report.gaps_page(GAPS, NAMES, pictures, language=language)

    assert left(page, names, fewest=12) == set()


def test_a_language_without_texts_is_refused_before_anything_is_written(
    chain: TurnChain, found: Identification, tmp_path: Path
) -> None:
    writers: tuple[Callable[[Path], Path], ...] = (
        lambda folder: chain.report(folder, language="xx"),
        lambda folder: identify_report.write_identify_report(found, {}, folder, language="xx"),
    )
    for write in writers:
        with pytest.raises(ParameterError):
            write(tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_every_warning_about_identified_values_has_its_german_one() -> None:
    """Whatever pair, whatever value: as the report shows them, each with its full stop."""
    further = [words.model_warning(0.9), words.noise_warning(3.0), words.few_points_warning(4, 2) or ""]
    german = [Message("{warning}.", warning=each).text("de") for each in further]
    german += [
        Message("{warning}.", warning=each).text("de") for each in (*words._HELPS.values(), *words._ALONE.values())
    ]
    assert [each for each in german if ENGLISH.search(each)] == []
