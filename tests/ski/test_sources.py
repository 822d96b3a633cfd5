"""Skis and snows by the words that name them: a name, or a file beside the one that names it."""

from pathlib import Path

import pytest

from skisnow._support.errors import ParameterError
from skisnow.ski import ski_named
from skisnow.ski.sources import Sources
from skisnow.snow import published_snow

SKI = """name = "mine"
length_mm = 1650
"""


def test_a_word_of_the_catalogue_is_no_file() -> None:
    sources = Sources()
    assert sources.ski_file("slalom") is None
    ski, told = sources.ski("slalom")
    assert ski.name == ski_named("slalom").name
    assert isinstance(told, tuple)
    assert sources.ski("slalom")[0] is ski  # read once


def test_what_looks_like_a_file_is_one_beside_who_names_it(tmp_path: Path) -> None:
    sources = Sources(tmp_path)
    assert sources.path("a.csv") == tmp_path / "a.csv"
    assert Sources().path("a.csv") == Path("a.csv")
    assert sources.ski_file("mine.toml") == tmp_path / "mine.toml"
    assert sources.ski_file("mine.JSON") == tmp_path / "mine.JSON"
    assert sources.ski_file("there/mine") == tmp_path / "there" / "mine"
    assert sources.ski_file("mine") is None
    (tmp_path / "mine").write_text(SKI, encoding="utf-8")
    assert sources.ski_file("mine") == tmp_path / "mine"
    with pytest.raises(ParameterError):
        sources.ski("no-such-ski")


def test_a_snow_is_read_once_and_one_at_hand_is_taken(tmp_path: Path) -> None:
    sources = Sources(tmp_path)
    word = {"published": "race-piste"}
    snow = sources.named_snow(word)
    assert snow.snow_hardness == published_snow("race-piste").snow_hardness
    assert sources.named_snow(word) is snow
    sources.take_snow(snow, results="results", site="A")
    assert sources.named_snow({"results": "results", "site": "A"}) is snow
    with pytest.raises(ParameterError):
        sources.named_snow({"published": None})
