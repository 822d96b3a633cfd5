"""Commands and programs that a page shows, in the order of the page."""

import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = (
    "README.md",
    "CONTRIBUTING.md",
    *sorted(
        path.relative_to(ROOT).as_posix()
        for path in ROOT.glob("docs/**/*.md")
        if not {"_build", "_generated"} & set(path.parts)
    ),
)
FIRST_WORDS = ("skisnow ", ".venv/bin/skisnow ", "python ", "make ", "pip ", "cc ", "#!/bin/bash")
BLOCK = re.compile(
    r"^(?P<mark><!-- [^\n]* -->\n)?```(?P<language>[^\n`]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)
MARK = re.compile(r"<!-- (?P<kind>not run|needs): (?P<reason>[\w ]+) -->")
REASONS = {"package index", "server", "other checks", "data of others"}
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
    """All blocks of a page that a reader would run, without output and without the cells of a notebook."""
    path = ROOT / page
    text = path.read_text(encoding="utf-8")
    is_notebook = path.with_suffix(".ipynb").exists()  # run as a whole by `test_notebooks`
    result = []
    for match in BLOCK.finditer(text):
        language, content = match["language"], match["text"]
        is_command = language in ("", "sh", "bash") and content.startswith(FIRST_WORDS)
        if is_command or (language == "python" and not is_notebook):
            mark = MARK.match(match["mark"] or "")
            line = text.count("\n", 0, match.start("text")) + 1
            result.append(Block(line, language, content, mark["reason"] if mark else None))
    return result
