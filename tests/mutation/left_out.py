"""A pytest plugin that leaves out tests that have run already: their names, one a line, are in a file."""

import os
from pathlib import Path
from typing import Final

import pytest

NAMES: Final = "SKISNOW_TESTS_LEFT_OUT"
"""Variable of the environment with the path of that file."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """An option of pytest's own would leave out each whose name begins so."""
    names = set(Path(os.environ[NAMES]).read_text(encoding="utf-8").splitlines())
    gone = [each for each in items if each.nodeid in names]
    config.hook.pytest_deselected(items=gone)
    items[:] = [each for each in items if each.nodeid not in names]
