"""JSON beyond its limits, and what Python takes for JSON though it is not."""

from __future__ import annotations

import json

import pytest

from skisnow._support.user_files import GivenError, json_value
from skisnow._support.user_files.text_files import DEEPEST
from tests.coded import Coded, coded, raises


def test_what_is_within_the_limits_is_as_json_reads_it() -> None:
    text = '{"a": [1, -9223372036854775808, 1.5e-3, null, true, "\\u00e9 \\ud83c\\udfbf"], "b": {"a": {}}}'
    assert json_value(text) == json.loads(text)
    assert json_value(text.encode()) == json.loads(text)
    edge = "[" * DEEPEST + "]" * DEEPEST
    assert json_value(edge) == json.loads(edge)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1), coded("nested_too_deep", deepest=32)),
        ('{"a":' * 100_000, coded("nested_too_deep", deepest=32)),
        ("9" * 5000, coded("number_too_large", count=5000)),
        ('{"a": [0, 9223372036854775808]}', coded("number_too_large", place="a[2]")),
        ('{"a": 1e400}', coded("number_too_large", place="a")),
        ("[NaN]", coded("not_json", word="NaN")),
        ("-Infinity", coded("not_json", word="-Infinity")),
        ('{"a": 1, "b": 2, "a": 3}', coded("repeated_key", key="a")),
        (r'{"a": "\u0000"}', coded("invalid_character", place="a")),
        (r'{"a": "\ud800"}', coded("invalid_character", place="a")),
        ('{"a": 1', "not_json"),
        ("", "not_json"),
    ],
)
def test_beyond_the_limits(text: str, told: str | Coded) -> None:
    with raises(GivenError, told) as error:
        json_value(text, title="some.json")
    assert str(error.value).startswith("some.json")
