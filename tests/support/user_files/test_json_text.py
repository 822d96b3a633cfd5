"""JSON beyond its limits, and what Python takes for JSON though it is none."""

from __future__ import annotations

import json

import pytest

from skisnow._support.user_files import GivenError, json_value
from skisnow._support.user_files.sound_values import DEEPEST


def test_what_is_within_the_limits_is_as_json_reads_it() -> None:
    text = '{"a": [1, -9223372036854775808, 1.5e-3, null, true, "\\u00e9 \\ud83c\\udfbf"], "b": {"a": {}}}'
    assert json_value(text) == json.loads(text)
    assert json_value(text.encode()) == json.loads(text)
    edge = "[" * DEEPEST + "]" * DEEPEST
    assert json_value(edge) == json.loads(edge)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1), "nested more than 32 deep"),
        ('{"a":' * 100_000, "nested more than 32 deep"),
        ("9" * 5000, "a whole number has 5000 digits"),
        ('{"a": [0, 9223372036854775808]}', r"a\[2\] is beyond the whole numbers"),
        ('{"a": 1e400}', "a is beyond the numbers"),
        ("[NaN]", "NaN is no number of JSON"),
        ("-Infinity", "-Infinity is no number of JSON"),
        ('{"a": 1, "b": 2, "a": 3}', "the key a stands twice"),
        (r'{"a": "\u0000"}', "a has a NUL character"),
        (r'{"a": "\ud800"}', "half a letter"),
        ('{"a": 1', "is no JSON text: .*line 1"),
        ("", "is no JSON text"),
    ],
)
def test_beyond_the_limits(text: str, told: str) -> None:
    with pytest.raises(GivenError, match=told) as error:
        json_value(text, title="some.json")
    assert str(error.value).startswith("some.json")
