"""TOML and JSON are read only by `skisnow._support.user_files`."""

from __future__ import annotations

import re
from pathlib import Path

import skisnow

READERS = re.compile(r"\b(tomllib|json|orjson)\.loads?\(|\bfrom (tomllib|json|orjson) import|JSONDecoder")
ITS_OWN = {Path("_support/user_files/text_files.py"), Path("_support/user_files/json_text.py")}


def test_toml_and_json_are_read_in_one_place() -> None:
    root = Path(skisnow.__file__).parent
    found = {path.relative_to(root) for path in root.rglob("*.py") if READERS.search(path.read_text(encoding="utf-8"))}
    assert found - ITS_OWN == set()
    assert found  # the pattern finds what it looks for
