"""The pages on the carved turn and its laws, and the sources of the core, name the same equations."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAMES = ("carved-turn", "carve-laws", "carve-derivatives")
PAGES = [(ROOT / "docs" / "methods" / f"{name}.md").read_text("utf-8") for name in NAMES]
CORE = ROOT / "src" / "core"
SOURCES = [*sorted((CORE / "carve").glob("*.?pp")), CORE / "snow" / "hypoplastic.hpp"]


def test_marks() -> None:
    """In brackets, without links; in the sources they begin a remark."""
    marked = re.findall(r"^ *// \[([a-z ]+)\]", "\n".join(each.read_text("utf-8") for each in SOURCES), re.MULTILINE)
    named = re.findall(r"\[([a-z]+(?:, [a-z]+)*)\](?!\()", "\n".join(PAGES))
    assert {name for group in named for name in group.split(", ")} == set(marked)
    assert {"hypoplastic", "strip", "balance"} <= set(marked)
