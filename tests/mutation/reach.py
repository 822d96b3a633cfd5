"""A pytest plugin that writes down which functions of the program each test calls, and how long it takes.

Calls of a fixture of a module or session count for all tests that use it; those of other processes are not seen.
"""

import ast
import json
import os
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any, Final, TypeAlias

import pytest

Function: TypeAlias = tuple[str, int]
"""File from the tree's top, and first line."""
PLACE: Final = "SKISNOW_TESTS_REACH"
"""Variable of the environment with the path of the output."""


class Reach:
    """Called functions, by test and by fixture."""

    def __init__(self, root: Path) -> None:
        self.source = f"{root / 'src'}{os.sep}"
        self.root = root
        self.calls: defaultdict[str, set[Function]] = defaultdict(set)
        self.seconds: dict[str, float] = {}
        self.now: set[Function] = set()

    def seen(self, frame: FrameType, _event: str, _told: object) -> None:
        """Of each call; None: its lines are not traced."""
        code = frame.f_code
        if code.co_filename.startswith(self.source):
            self.now.add((str(Path(code.co_filename).relative_to(self.root)), code.co_firstlineno))

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self.now, start = self.calls[item.nodeid], time.monotonic()
        sys.settrace(self.seen)
        threading.settrace(self.seen)
        yield
        sys.settrace(None)
        self.seconds[item.nodeid] = time.monotonic() - start
        for fixture in getattr(item, "fixturenames", ()):
            self.calls[item.nodeid] |= self.calls.get(f"fixture {fixture}", set())

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[Any]) -> Iterator[None]:
        before = self.now
        if fixturedef.scope != "function":
            self.now = self.calls[f"fixture {fixturedef.argname}"]
        yield
        self.now = before

    def pytest_sessionfinish(self) -> None:
        found = {name: [seconds, sorted(self.calls[name])] for name, seconds in self.seconds.items()}
        Path(os.environ[PLACE]).write_text(json.dumps(found), encoding="utf-8")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Reach(config.rootpath))


def function_at(source: str, start: int) -> int | None:
    """First line of the innermost function with a name around a character; None outside all."""
    line = source.count("\n", 0, start) + 1
    around = [
        min([node.lineno, *(each.lineno for each in node.decorator_list)])
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and node.body[0].lineno <= line <= (node.body[-1].end_lineno or 0)
    ]
    return max(around, default=None)


def nearest(reach: Path, file: Path, line: int | None) -> list[str]:
    """Tests that call the function of this file, or any where `line` is None, the quick ones first."""
    found: dict[str, tuple[float, list[tuple[str, int]]]] = json.loads(reach.read_text(encoding="utf-8"))
    calling = [
        (seconds, name)
        for name, (seconds, calls) in found.items()
        if any(place == str(file) and (line is None or first == line) for place, first in calls)
    ]
    return [name for _, name in sorted(calling)]


def whole_time(reach: Path) -> float:
    """Seconds that all tests took."""
    return float(sum(seconds for seconds, _ in json.loads(reach.read_text(encoding="utf-8")).values()))
