"""The tests of a package on a copy of the tree in which one error is planted."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import pytest

from .mutants import Mutant
from .reach import PLACE, function_at, nearest

OWN = Path(__file__).parent
CAUGHT = "caught"
OUT_OF_TIME = "out of time"
SURVIVED = "survived"


@contextmanager
def copied_tree(root: Path) -> Iterator[Path]:
    """A folder with what git has of the tree, as it stands, and all that is compiled; gone at the end."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=root, capture_output=True, text=True, check=True).stdout.split("\0")
    names += [str(path.relative_to(root)) for path in root.glob("src/skisnow/compiled/*.*")]  # with what is built here
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
    reach: Path | None = None  # which functions each test calls, as `tests.mutation.reach` writes it

    def verdict(self, path: Path, mutant: Mutant) -> str:
        """Whether the tests catch the error in this file (given from the tree's top); the file is itself again.

        The tests that call the changed function run before all others, the quick ones before the slow ones. What
        stands outside all functions, such as a constant, may be read by any test.
        """
        file = self.tree / path
        source = file.read_bytes()
        text = source.decode()
        first = nearest(self.reach, path, function_at(text, mutant.start)) if self.reach else []
        try:
            file.write_text(mutant.planted(text), encoding="utf-8", newline="")
            status = self.status(first) if first else 0
            status = self.status() if status == 0 else status
        finally:
            file.write_bytes(source)
        return OUT_OF_TIME if status is None else CAUGHT if status else SURVIVED

    def look(self) -> int | None:
        """Exit status of all tests; what they reach is written down."""
        paths = os.pathsep.join(map(str, (self.tree / "src", OWN)))
        return self.status(more=("-p", "reach"), PYTHONPATH=paths, **{PLACE: str(self.reach)})

    def status(self, tests: Collection[str] = (), *, more: Collection[str] = (), **environment: str) -> int | None:
        """Exit status of these tests or all, 0 if there are none; None where time ran out."""
        words = [sys.executable, "-m", "pytest", "-x", "-q", "--hypothesis-profile=ci", "--doctest-modules"]
        words += [word for name in ("cacheprovider", "xdist", "randomly") for word in ("-p", f"no:{name}")]
        words += [*more, *(tests or self.tests)]
        own = {"PYTHONPATH": str(self.tree / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
        outer = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
        status = _status(words, self.tree, {**outer, **own, **environment}, self.limit)
        return 0 if status == pytest.ExitCode.NO_TESTS_COLLECTED else status


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
