"""How words of the command line become numbers."""

from __future__ import annotations

import argparse

import pytest

from skisnow.cli.options import number


def test_an_end_that_is_not_given_is_open() -> None:
    assert number("N", highest=5.0)("-1e9") == -1e9
    assert number("N", lowest=5.0)("1e9") == 1e9
    assert number("N")("-3.5") == -3.5


def test_ends_are_allowed_but_the_lowest_above_which_it_must_be() -> None:
    within = number("s", lowest=0.0, highest=10.0)
    assert (within("0"), within("10")) == (0.0, 10.0)
    for word in ("-1e-9", "10.1", "nan"):
        with pytest.raises(argparse.ArgumentTypeError, match="from 0 to 10"):
            within(word)
    above = number("s", lowest=0.0, highest=10.0, above=True)
    assert (above("1e-9"), above("10")) == (1e-9, 10.0)
    with pytest.raises(argparse.ArgumentTypeError, match="above 0 to 10"):
        above("0")


@pytest.mark.parametrize(
    ("unit", "word", "told"), [("N", "800 N", "in N, .* 800"), ("", "1,5", r" 1\.5"), ("m", "much", "in m")]
)
def test_what_is_no_number_gets_an_example(unit: str, word: str, told: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=told):
        number(unit)(word)
