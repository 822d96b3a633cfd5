"""Addresses of pages: what is asked stands in them, whatever letters it has."""

import pytest

from skisnow._support.errors import StoreError
from skisnow.web.page_addresses import analysis, carving, correcting, entering, export, plain_stem, required_id
from tests.coded import raises


def test_addresses_of_a_campaign() -> None:
    assert entering("ab12") == "/enter/ab12"
    assert entering("ab12", table="shear", test="s 1&2") == "/enter/ab12?table=shear&test=s%201%262"
    assert entering("ab12", table="shear", head={"site": "A/B"}) == "/enter/ab12?table=shear&site=A%2FB"
    assert correcting("ab12", test="7") == "/correct/ab12?test=7"
    assert analysis("kept", "ab12") == "/analysis/kept/ab12"
    assert export("entry", "ab12") == "/export/entry/ab12.zip"


def test_address_of_a_ski_with_another_beside_it() -> None:
    assert carving("my ski") == "/carve?ski=my%20ski"
    assert carving("a/b", "c&d") == "/carve?ski=a%2Fb&other=c%26d"


def test_a_stem_is_short_and_plain() -> None:
    assert plain_stem("C:\\tracks\\Run 3.final.csv", "track") == "Run-3-final"
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
