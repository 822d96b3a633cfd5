"""TOML beyond its limits is refused before it costs time or memory; records of our own name what is damaged."""

from __future__ import annotations

import tomllib
import tracemalloc
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pytest

from skisnow._support.user_files import GivenError, read_record, toml_values
from skisnow._support.user_files.text_files import DEEPEST, LONGEST_KEY, LONGEST_TEXT, MOST_DOTS, MOST_TOML_BYTES
from tests.coded import Coded, coded, raises

SOUND = '''# a.b.c.d "
[a."b.c".d]
x = [1.5, -2e3, 0x1F] # ]]]]
y = { z = "\\"[[[[" , w = 'C:\\a.b.c' }
text = """a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a "" [[[["""""
plain = \'\'\'a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a ''[[[[\'\'\'
day = 2013-02-01T10:00:00.5+01:00
far = [inf, nan]
[[list]]
[[list]]
'''


def test_what_is_within_the_limits_is_as_tomllib_reads_it() -> None:
    assert repr(toml_values(SOUND)) == repr(tomllib.loads(SOUND))
    brackets = "[" * (DEEPEST - 1) + "]" * (DEEPEST - 1)
    edge = f"a = {brackets}\n{'.'.join('b' * (MOST_DOTS + 1))} = 1\n{'c' * LONGEST_KEY} = 1"
    assert toml_values(edge) == tomllib.loads(edge)


@pytest.mark.parametrize(
    ("text", "line", "told"),
    [
        ("x = 1\na = " + "[" * 3000 + "]" * 3000, 2, coded("nested_too_deep", deepest=32)),
        ("a = " + "{a=" * 3000, 1, coded("nested_too_deep", deepest=32)),
        ("\n\n[" + ".".join("a" * 20_000) + "]", 3, coded("key_too_long", count=16)),
        (" . ".join('"a"' for _ in range(20_000)) + " = 1", 1, coded("key_too_long", count=16)),
        ("a = 9" * 1 + "9" * 5000, 1, coded("key_too_long", count=5001)),
        ("a = 1" + "0" * 400, 1, coded("key_too_long", count=401)),
        ("a = 1" + "0" * 30, None, coded("number_too_large", place="a")),
        ("[a]\nb = [1, -9223372036854775809]", None, coded("number_too_large", place="a.b[2]")),
        (r'profile = "\u0000.csv"', None, coded("invalid_character", place="profile")),
        (r'"a\u0000" = 1', None, "invalid_character"),
        (f'"{"k" * 201}" = 1', None, coded("text_too_long", count=201, longest=200)),
        (f'a = "{"k" * (LONGEST_TEXT + 1)}"', None, coded("text_too_long", place="a", count=100001)),
        ("a = 1\n" * MOST_TOML_BYTES, None, coded("too_large", longest=1048576)),
        ("a = 1\nb == 2", 2, "not_toml"),
        ("a = 2013-02-31", 1, "not_toml"),
    ],
)
def test_beyond_the_limits(text: str, line: int | None, told: str | Coded) -> None:
    with raises(GivenError, told) as error:
        toml_values(text, title="some.toml")
    assert error.value.line == line
    assert str(error.value).startswith("some.toml")


def test_a_key_of_many_dots_costs_no_memory() -> None:
    text = "a." * 20_000 + "a = 1"
    tracemalloc.start()
    try:
        with pytest.raises(GivenError):
            toml_values(text)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert most < 20 * len(text)


@dataclass(frozen=True)
class Record:
    name: str
    changes: Mapping[str, str]
    state: Literal["waiting", "done"] = "waiting"
    took_s: float = 0.0
    points: int = 0
    azimuth: float | None = None


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "record.json"


def test_a_sound_record(place: Path) -> None:
    place.write_text('{"name": "a", "changes": {"x": "1"}, "state": "done", "took_s": 3, "azimuth": null}')
    assert read_record(place, Record) == Record("a", {"x": "1"}, "done", 3, 0, None)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('{"name": "a"}', "changes"),
        ('{"name": 5, "changes": {}}', "name"),
        ('{"name": "a", "changes": {"x": 1}}', "changes"),
        ('{"name": "a", "changes": [], "points": 1}', "changes"),
        ('{"name": "a", "changes": {}, "state": "gone"}', "state"),
        ('{"name": "a", "changes": {}, "state": []}', "state"),
        ('{"name": "a", "changes": {}, "points": 1.5}', "points"),
        ('{"name": "a", "changes": {}, "took_s": true}', "took_s"),
        ('{"name": "a", "changes": {}, "azimuth": "south"}', "azimuth"),
        ('{"name": "a", "changes": {}, "more": 1}', "more"),
        ("[1]", "record.json"),
        ("{", "record.json"),
    ],
)
def test_a_damaged_record_names_file_and_key(place: Path, text: str, named: str) -> None:
    place.write_text(text)
    with pytest.raises(GivenError) as caught:
        read_record(place, Record)
    assert place.name in str(caught.value)
    assert named in str(caught.value)


def test_other_keys_can_be_left_out(place: Path) -> None:
    place.write_text('{"name": "a", "changes": {}, "more": 1}')
    assert read_record(place, Record, only_known=False) == Record("a", {})
