"""Values and TOML of user files."""

import json
import math
import os
import re
import tomllib
import tracemalloc
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pytest

import skisnow
from skisnow._support.errors import SkisnowError
from skisnow._support.user_files import workbook
from skisnow._support.user_files.json_text import json_value, read_record
from skisnow._support.user_files.text_files import (
    DEEPEST,
    LARGEST_WHOLE,
    LONGEST_KEY,
    LONGEST_TEXT,
    MOST_DOTS,
    MOST_TOML_BYTES,
    ContentError,
    named,
    plain_bytes,
    plain_text,
    require_sound,
    shown,
    toml_values,
    too_deep,
)
from skisnow.scenario import load_scenario, read_profile
from skisnow.ski import read_ski
from skisnow.snow.from_results import snow_from_results
from skisnow.studies.study import read_study
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
    assert str(ContentError("wrong")) == "wrong"
    assert str(ContentError("wrong", line=3)) == "line 3: wrong"
    found = ContentError("wrong", line=3).of("a.toml")
    assert (str(found), found.what, found.line) == ("a.toml, line 3: wrong", "wrong", 3)
    assert str(ContentError("wrong", sentence="All of it.")) == "All of it."


def nested(depth: int) -> object:
    return {"a": nested(depth - 1)} if depth > 1 else []


def rejection(value: object, *, infinite: bool = False) -> str | None:
    """Code of the error."""
    try:
        require_sound(value, infinite=infinite)
    except ContentError as error:
        return error.code
    return None


def test_at_the_edge_all_is_sound() -> None:
    edge = [LARGEST_WHOLE, -LARGEST_WHOLE - 1, "x" * LONGEST_TEXT, {"k" * LONGEST_KEY: 1}, "ü", True, "\ud7ff\ue000"]
    assert [rejection(value) for value in (*edge, nested(DEEPEST))] == [None] * 8
    assert rejection([math.inf, math.nan], infinite=True) is None


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
    with raises(ContentError, told):
        require_sound(value, infinite=False)


def test_a_sheet_has_as_many_rows_as_excel_writes() -> None:
    assert workbook.MOST_ROWS == 1_048_576


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
    with raises(ContentError, told) as error:
        json_value(text, title="some.json")
    assert str(error.value).startswith("some.json")


def test_bytes_up_to_the_limit_are_read_and_not_one_more(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes(b"12345678")
    assert plain_bytes(path, most_bytes=8) == b"12345678"
    with raises(ContentError, "too_large"):
        plain_bytes(path, most_bytes=7)


def test_lines_end_with_a_line_feed_however_they_did(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes(b"\xef\xbb\xbfa\r\nb\rc\n")
    assert plain_text(path, most_bytes=100) == "a\nb\nc\n"


def test_text_of_another_encoding_names_its_byte(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes("Höhe".encode("latin-1"))
    with raises(ContentError, "not_text", byte=2):
        plain_text(path, most_bytes=100)


@pytest.mark.parametrize(
    ("path", "told"), [("a\0b", "invalid_character"), ("\ud800", "invalid_character"), ("x" * 300, "cannot_read")]
)
def test_names_that_no_file_has(path: str, told: str | Coded) -> None:
    with raises(ContentError, told):
        plain_bytes(path, most_bytes=1)


@pytest.mark.parametrize("read", [load_scenario, read_ski, read_study, snow_from_results, read_profile])
def test_endless_device_and_pipe_without_writer(tmp_path: Path, read: object, noted_errors: list[SkisnowError]) -> None:
    assert callable(read)
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    for place in (Path("/dev/zero"), pipe):
        noted_errors.clear()
        with pytest.raises(SkisnowError):
            read(place)
        assert noted_errors[0].code == "cannot_read"


READERS = re.compile(r"\b(tomllib|json|orjson)\.loads?\(|\bfrom (tomllib|json|orjson) import|JSONDecoder")
ITS_OWN = {Path("_support/user_files/text_files.py"), Path("_support/user_files/json_text.py")}


def test_toml_and_json_are_read_in_one_place() -> None:
    root = Path(skisnow.__file__).parent
    found = {path.relative_to(root) for path in root.rglob("*.py") if READERS.search(path.read_text(encoding="utf-8"))}
    assert found - ITS_OWN == set()
    assert found  # the pattern finds what it looks for


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
def test_toml_beyond_the_limits(text: str, line: int | None, told: str | Coded) -> None:
    with raises(ContentError, told) as error:
        toml_values(text, title="some.toml")
    assert error.value.line == line
    assert str(error.value).startswith("some.toml")


def test_a_key_of_many_dots_costs_no_memory() -> None:
    text = "a." * 20_000 + "a = 1"
    tracemalloc.start()
    try:
        with pytest.raises(ContentError):
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
        ("[1]", "record.json"),
        ("{", "record.json"),
    ],
)
def test_a_damaged_record_names_file_and_key(place: Path, text: str, named: str) -> None:
    place.write_text(text)
    with pytest.raises(ContentError) as caught:
        read_record(place, Record)
    assert place.name in str(caught.value)
    assert named in str(caught.value)


def test_other_keys_are_ignored(place: Path) -> None:
    place.write_text('{"name": "a", "changes": {}, "more": 1}')
    assert read_record(place, Record) == Record("a", {})
