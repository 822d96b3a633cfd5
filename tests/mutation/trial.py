"""The tests of a room on a copy of the tree in which one error is planted."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from .mutants import Mutant

CAUGHT = "caught"
OUT_OF_TIME = "out of time"
SURVIVED = "survived"


@contextmanager
def copied_tree(root: Path) -> Iterator[Path]:
    """A folder with what git has of the tree, as it stands, and the compiled core; gone at the end."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=root, capture_output=True, text=True, check=True).stdout.split("\0")
    names += [str(path.relative_to(root)) for path in root.glob("src/skisnow/compiled/_core.*")]  # built here
    with tempfile.TemporaryDirectory(prefix="mutation-") as folder:
        for name in filter(None, names):
            if (root / name).is_file():
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(root / name, Path(folder) / name)
        yield Path(folder)


@dataclass(frozen=True)
class Trials:
    """One copy of the tree and the tests that run in it."""

    tree: Path
    tests: tuple[str, ...]  # files and folders below the tree
    limit: float  # s for each mutant

    def verdict(self, path: Path, mutant: Mutant) -> str:
        """Whether the tests catch the error in this file (given from the tree's top); the file is itself again."""
        file = self.tree / path
        source = file.read_bytes()
        try:
            file.write_text(mutant.planted(source.decode()), encoding="utf-8", newline="")
            status = self.status(path)
        finally:
            file.write_bytes(source)
        return OUT_OF_TIME if status is None else CAUGHT if status else SURVIVED

    def status(self, path: Path | None = None) -> int | None:
        """Exit status of the tests, None where time ran out; those that are named after `path` come first."""
        first = (
            [str(each.relative_to(self.tree)) for each in self.tree.glob(f"tests/**/test_{path.stem}.py")]
            if path
            else []
        )
        words = [
            sys.executable,
            "-m",
            "pytest",
            "-x",
            "-q",
            "-p",
            "no:cacheprovider",
            "-p",
            "no:xdist",
            "-p",
            "no:randomly",
        ]
        words += ["--hypothesis-profile=ci", "--doctest-modules", *dict.fromkeys([*first, *self.tests])]
        own = {"PYTHONPATH": str(self.tree / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
        return _status(words, self.tree, os.environ | own, self.limit)


def _status(words: list[str], folder: Path, environment: dict[str, str], limit: float) -> int | None:
    started = subprocess.Popen(
        words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        return started.wait(limit)
    except subprocess.TimeoutExpired:
        return None
    finally:
        _end(started)


def _end(started: subprocess.Popen[bytes]) -> None:
    """End a process and all that it started: a server that a test left behind, too."""
    with suppress(ProcessLookupError):
        os.killpg(started.pid, signal.SIGKILL)
    started.wait()
