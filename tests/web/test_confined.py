"""Reading in a separate process: what it gives and raises comes back, and what ends it does not end the lab."""

from __future__ import annotations

import ctypes
import os
import sys
import time

import pytest

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow.web.subprocesses import BOUNDS, Bounds, confined
from tests.coded import raises


def other_process(word: str) -> tuple[str, int]:
    return word, os.getpid()


def refuse() -> None:
    raise FieldDataError(["a row is missing"])


def dies() -> None:
    ctypes.string_at(0)


def is_wrong() -> None:
    raise ZeroDivisionError


def takes_memory() -> int:
    return len(bytearray(400_000_000))


def takes_time() -> None:
    while True:
        time.sleep(0.01)


def test_the_answer_and_the_errors_come_back() -> None:
    word, process = confined(BOUNDS, other_process, "snow")
    assert word == "snow"
    assert process != os.getpid()
    with pytest.raises(FieldDataError, match="a row is missing"):
        confined(BOUNDS, refuse)


def test_what_ends_the_other_process_is_said_here(capfd: pytest.CaptureFixture[str]) -> None:
    for work in (dies, is_wrong):
        with raises(ParameterError, "cannot_read", seconds=120.0, megabytes=3000):
            confined(BOUNDS, work)
    assert "Traceback" not in capfd.readouterr().err


def test_time_has_an_end() -> None:
    with raises(ParameterError, "too_slow", seconds=0.5):
        confined(Bounds(seconds=0.5), takes_time)


@pytest.mark.skipif(sys.platform != "linux", reason="no such limit")
def test_memory_has_an_end() -> None:
    assert confined(BOUNDS, takes_memory) == 400_000_000
    with raises(ParameterError, "cannot_read", seconds=120.0, megabytes=300):
        confined(Bounds(memory_bytes=300_000_000), takes_memory)
