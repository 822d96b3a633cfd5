"""Addresses of pages: what is asked is in them, whatever letters it has."""

from urllib.parse import parse_qs, urlsplit

import pytest

from skisnow._support.errors import StoreError
from skisnow.web.page_addresses import analysis, carving, correcting, entering, export, plain_stem, required_id
from tests.coded import raises


@pytest.mark.parametrize(
    ("address", "path", "query"),
    [
        (entering("ab12"), "/enter/ab12", {}),
        (entering("ab12", table="shear", test="s 1&2"), "/enter/ab12", {"table": ["shear"], "test": ["s 1&2"]}),
        (entering("a", table="b", head={"site": "A/B"}), "/enter/a", {"table": ["b"], "site": ["A/B"]}),
        (correcting("ab12", test="7"), "/correct/ab12", {"test": ["7"]}),
        (analysis("kept", "ab12"), "/analysis/kept/ab12", {}),
        (export("entry", "ab12"), "/export/entry/ab12.zip", {}),
        (carving("my ski"), "/carve", {"ski": ["my ski"]}),
        (carving("a/b", "c&d"), "/carve", {"ski": ["a/b"], "other": ["c&d"]}),
    ],
)
def test_what_is_asked_is_in_the_address(address: str, path: str, query: dict[str, list[str]]) -> None:
    parts = urlsplit(address)
    assert (parts.path, parse_qs(parts.query)) == (path, query)


def test_a_stem_is_short_and_plain() -> None:
    assert plain_stem("C:\\tracks\\Run 3.csv", "track") == "Run-3"
    assert plain_stem("-" * 5, "track") == "track"
    assert plain_stem("a" * 50 + ".csv", "track") == "a" * 40


@pytest.mark.parametrize(
    ("said", "fits"),
    [("0af3", True), ("f" * 64, True), ("0af", False), ("f" * 65, False), ("0AF3", False), ("../a", False)],
)
def test_an_id_is_four_to_sixty_four_letters_and_digits(said: str, fits: bool) -> None:
    if fits:
        assert required_id(said) == said
    else:
        with raises(StoreError, "no_campaign"):
            required_id(said)
