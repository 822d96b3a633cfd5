"""Numbers as people type them."""

from __future__ import annotations

import pytest

from skisnow._support.errors import ParameterError
from skisnow.web.words import typed_number
from tests.coded import raises


@pytest.mark.parametrize(("text", "value"), [("0,5", 0.5), (" 12.25 ", 12.25), ("−3", -3.0), ("1e-3", 1e-3)])
def test_as_hands_write_them(text: str, value: float) -> None:
    assert typed_number("the length", text) == value


@pytest.mark.parametrize("text", ["", "1x", "1.5.2", "nan", "inf", "1 2"])
def test_what_is_none_is_told(text: str) -> None:
    with raises(ParameterError, "not_a_number", field="the length", value=text):
        typed_number("the length", text)
