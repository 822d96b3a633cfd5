"""A browser test that failed has one second try in `.ci/run`; nothing else has."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).resolve().parents[1] / ".ci" / "repeating.py"
TESTS = """
import pathlib
import pytest

@pytest.mark.browser
def test_slow_once():
    known = pathlib.Path("known")
    if not known.exists():
        known.touch()
        raise AssertionError

@pytest.mark.browser
def test_always(): assert {always}

def test_no_browser(): assert {no_browser}
"""
SETTINGS = "[pytest]\nmarkers = browser\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("always", "no_browser", "status", "words"),
    [
        (True, True, 0, "failed once, passed when repeated: test_a.py::test_slow_once"),
        (False, True, 1, "FAILED, not repeated or again: test_a.py::test_always"),
        (True, False, 1, "FAILED, not repeated or again: test_a.py::test_no_browser"),
    ],
)
def test_what_is_repeated(tmp_path: Path, always: bool, no_browser: bool, status: int, words: str) -> None:
    (tmp_path / "test_a.py").write_text(TESTS.format(always=always, no_browser=no_browser), encoding="utf-8")
    (tmp_path / "pytest.ini").write_text(SETTINGS, encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    command = [sys.executable, str(PROGRAM), "-q", "-p", "no:xdist"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stdout + done.stderr
    assert words in done.stdout.splitlines()[-3:]
