"""Messages show parts of a text and a place, and limits at their edges."""

from __future__ import annotations

import math

import pytest

from skisnow._support.user_files import GivenError, workbook
from skisnow._support.user_files.text_files import (
    DEEPEST,
    LARGEST_WHOLE,
    LONGEST_KEY,
    LONGEST_TEXT,
    named,
    require_sound,
    shown,
    too_deep,
)
from tests.coded import Coded, coded, raises


def test_a_text_in_a_message_is_short_and_prints() -> None:
    assert shown("x" * 60) == "x" * 60
    assert shown("x" * 61) == "x" * 60 + "…"
    assert shown("a\n\0ü\u200b") == "a??ü?"
    assert (shown("abcd", 4), shown("abcde", 4)) == ("abcd", "abcd…")


def test_places() -> None:
    assert named((1, "a", "b", 3)) == "[1].a.b[3]"
    assert named(("x\n",)) == "x?"
    assert (too_deep().line, too_deep(7).line) == (None, 7)


def test_a_message_names_file_and_line_as_far_as_they_are_known() -> None:
    assert str(GivenError("wrong")) == "wrong"
    assert str(GivenError("wrong", line=3)) == "line 3: wrong"
    found = GivenError("wrong", line=3).of("a.toml")
    assert (str(found), found.what, found.line) == ("a.toml, line 3: wrong", "wrong", 3)
    assert str(GivenError("wrong", sentence="All of it.")) == "All of it."


def nested(depth: int) -> object:
    return {"a": nested(depth - 1)} if depth > 1 else []


@pytest.mark.parametrize(
    "value", [LARGEST_WHOLE, -LARGEST_WHOLE - 1, "x" * LONGEST_TEXT, {"k" * LONGEST_KEY: 1}, nested(DEEPEST), "ü", True]
)
def test_at_the_edge_all_is_sound(value: object) -> None:
    require_sound(value, infinite=False)


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (LARGEST_WHOLE + 1, coded("number_too_large", place="the value")),
        (-LARGEST_WHOLE - 2, "number_too_large"),
        ([1, [2, -math.inf]], coded("number_too_large", place="[2][2]")),
        ({"a": {"k" * (LONGEST_KEY + 1): 1}}, coded("text_too_long", count=201)),
        (nested(DEEPEST + 1), coded("nested_too_deep", deepest=32)),
        ("ü\0", "invalid_character"),
        ("\udfff", "invalid_character"),
        ("\ud800", "invalid_character"),
    ],
)
def test_beyond_it_is_not(value: object, told: str | Coded) -> None:
    with raises(GivenError, told):
        require_sound(value, infinite=False)


def test_letters_beside_the_halves_are_sound_and_infinite_numbers_where_they_are_allowed() -> None:
    require_sound("\ud7ff\ue000", infinite=False)
    require_sound([math.inf, math.nan], infinite=True)


def test_a_sheet_has_as_many_rows_as_excel_writes() -> None:
    assert workbook.MOST_ROWS == 1_048_576
