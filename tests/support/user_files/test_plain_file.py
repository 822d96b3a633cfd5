"""Files that are none, that have no end, that are too large: all refused, none waited for."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from skisnow._support.errors import SkisnowError
from skisnow._support.user_files import GivenError, plain_bytes, plain_text
from skisnow.scenario import load_scenario, read_profile
from skisnow.ski import read_ski
from skisnow.snow.from_results import snow_from_results
from skisnow.studies.study import read_study
from tests.coded import Coded, raises


def test_bytes_up_to_the_limit_are_read_and_not_one_more(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes(b"12345678")
    assert plain_bytes(path, most_bytes=8) == b"12345678"
    with raises(GivenError, "too_large"):
        plain_bytes(path, most_bytes=7)


def test_lines_end_with_a_line_feed_however_they_did(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes(b"\xef\xbb\xbfa\r\nb\rc\n")
    assert plain_text(path, most_bytes=100) == "a\nb\nc\n"


def test_text_of_another_encoding_names_its_byte(tmp_path: Path) -> None:
    path = tmp_path / "some"
    path.write_bytes("Höhe".encode("latin-1"))
    with raises(GivenError, "not_text", byte=2):
        plain_text(path, most_bytes=100)


@pytest.mark.parametrize(
    ("path", "told"), [("a\0b", "invalid_character"), ("\ud800", "cannot_read"), ("x" * 300, "cannot_read")]
)
def test_names_that_no_file_has(path: str, told: str | Coded) -> None:
    with raises(GivenError, told):
        plain_bytes(path, most_bytes=1)


@pytest.mark.parametrize("read", [load_scenario, read_ski, read_study, snow_from_results, read_profile])
def test_device_without_end_and_pipe_that_nobody_fills(tmp_path: Path, read: object) -> None:
    assert callable(read)
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    for place in (Path("/dev/zero"), pipe):
        with pytest.raises(SkisnowError, match="cannot be read: it is a pipe, a device or the like"):
            read(place)
