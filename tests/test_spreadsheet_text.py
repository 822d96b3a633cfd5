"""Texts in tables that people open: never a formula, always the same text again."""

from __future__ import annotations

import random

import pytest

from skisnow.spreadsheet_text import guarded, unguarded


@pytest.mark.parametrize(
    "text",
    ["=1+1", '=HYPERLINK("http://x")', "+1+1", "-A1", "@SUM(A1)", "\tx", "\rx", "＝1", "-1 mm", "--1", "-", "=-1"],
)
def test_what_a_spreadsheet_takes_for_a_formula_begins_with_an_apostrophe(text: str) -> None:
    assert guarded(text) == f"'{text}"


@pytest.mark.parametrize("text", ["-1.5", "+2", "-1,5", "-1e-3", "0", "A-1", "it's", "'tis", "", " "])
def test_numbers_and_harmless_texts_stay(text: str) -> None:
    assert guarded(text) == text
    assert unguarded(text) == text


def test_every_text_comes_back() -> None:
    random_ = random.Random(1)
    cells = set()
    for _ in range(5000):
        text = "".join(random_.choices("'=+-@1. a\t", k=random_.randrange(6)))
        cells.add((text, guarded(text)))
        assert unguarded(guarded(text)) == text
        assert guarded(text)[:1] not in tuple("=@\t")
    assert len({cell for _, cell in cells}) == len(cells)  # no two texts share a cell
