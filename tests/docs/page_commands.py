"""Commands and programs that a page shows, in the order of the page."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", *sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs" / "how-to").glob("*.md")))
FIRST_WORDS = ("skisnow ", ".venv/bin/skisnow ", "python ", "make ", "pip ", "dask ", "#!/bin/bash")
BLOCK = re.compile(r"^(?P<mark><!-- [^\n]* -->\n)?```(?P<language>\w*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
NOT_RUN = re.compile(r"<!-- not run: (?P<reason>[\w ]+) -->")
REASONS = {"server", "scheduler", "package index", "mujoco", "other checks"}


@dataclass(frozen=True)
class Block:
    """A block of commands or a Python program, and the reason why it is not run, if any."""

    line: int
    language: str
    text: str
    not_run: str | None


def blocks(page: str) -> list[Block]:
    """All blocks of a page that a reader would run; output and doctests are not among them."""
    text = (ROOT / page).read_text(encoding="utf-8")
    result = []
    for match in BLOCK.finditer(text):
        language, content = match["language"], match["text"]
        program = language == "python" and ">>>" not in content
        if not program and not (language in ("", "sh", "bash") and content.startswith(FIRST_WORDS)):
            continue
        reason = NOT_RUN.match(match["mark"] or "")
        line = text.count("\n", 0, match.start("text")) + 1
        result.append(Block(line, language, content, reason["reason"] if reason else None))
    return result
