"""The replay's page in another language: nothing that its program says is left in English."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.replay import replay_of_run, write_replay
from skisnow.replay.page import page_words

from ...report.runs import circle_run
from .browsers import Watched, drawing_in_software

TOLD = """return [...document.querySelectorAll("#replay *")].flatMap((each) => [
    each.getAttribute("aria-label"), each.getAttribute("aria-valuetext"), each.children.length ? "" : each.textContent,
  ]).filter(Boolean)"""


def test_all_that_the_program_says_has_its_german_text() -> None:
    words = page_words("de")
    assert {"Speed of play", "{} m left", "0.5"} <= set(words)
    assert [text for text, german in words.items() if text == german and len(text) > 8] == ["Film (WebM)"]


def test_a_page_in_german(chromium: Any, tmp_path: Path) -> None:
    run = replay_of_run(circle_run(), title="Ein Schwung")
    page = write_replay(run, tmp_path / "replay.html", ghost=replay_of_run(circle_run(radius=13.0)), language="de")
    with drawing_in_software(chromium) as browser:
        seen = Watched(browser, page.as_uri())
        seen.does("replay.show('forces', true); replay.seek(2.0)")
        told = seen.does(TOLD)
        assert seen.does("return document.documentElement.lang") == "de"
        seen.close()
    for words in (
        "12,0 m links",
        "8,00 m/s",
        "2,00 Sekunden",
        "Replay von Ein Schwung",
        "Gesamtkraft auf den linken Ski",
    ):
        assert words in told
    assert any("Kantwinkel" in each for each in told)
    english = {text for text, words in page_words("de").items() if text not in (words, "0.5")}
    assert english & set(told) == set()
    assert seen.complaints == []


def test_a_language_without_texts_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError):
        write_replay(circle_run(), tmp_path / "replay.html", language="xx")
    assert not list(tmp_path.iterdir())
