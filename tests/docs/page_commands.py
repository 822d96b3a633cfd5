"""Commands and programs that a page shows, in the order of the page."""

from __future__ import annotations

import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = (
    "README.md",
    *sorted(
        path.relative_to(ROOT).as_posix() for part in ("start", "how-to") for path in ROOT.glob(f"docs/{part}/*.md")
    ),
)
FIRST_WORDS = ("skisnow ", ".venv/bin/skisnow ", "python ", "make ", "pip ", "dask ", "cc ", "#!/bin/bash")
BLOCK = re.compile(r"^(?P<mark><!-- [^\n]* -->\n)?```(?P<language>\w*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
MARK = re.compile(r"<!-- (?P<kind>not run|needs): (?P<reason>[\w ]+) -->")
REASONS = {"server", "scheduler", "package index", "other checks"}
PACKAGES = {"fmpy", "mujoco", "exudyn"}
"""Reasons of a mark, and packages without which a block cannot be run."""


@dataclass(frozen=True)
class Block:
    """A block of commands, a Python program or a doctest, with its mark, if any: a reason or a package."""

    line: int
    language: str
    text: str
    mark: str | None

    @property
    def is_run(self) -> bool:
        """True unless it is marked; a package that it needs may be installed."""
        return self.mark is None or (self.mark in PACKAGES and importlib.util.find_spec(self.mark) is not None)

    @property
    def is_doctest(self) -> bool:
        """True for a Python session with its output."""
        return self.language == "python" and ">>>" in self.text


def blocks(page: str) -> list[Block]:
    """All blocks of a page that a reader would run; output is not among them."""
    text = (ROOT / page).read_text(encoding="utf-8")
    result = []
    for match in BLOCK.finditer(text):
        language, content = match["language"], match["text"]
        if language == "python" or (language in ("", "sh", "bash") and content.startswith(FIRST_WORDS)):
            mark = MARK.match(match["mark"] or "")
            line = text.count("\n", 0, match.start("text")) + 1
            result.append(Block(line, language, content, mark["reason"] if mark else None))
    return result
