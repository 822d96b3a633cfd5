"""The solver before the compiled core is a judge, no part of a run: its tests are slow ones, but for the inertia."""

from __future__ import annotations

from pathlib import Path

import pytest

HERE = Path(__file__).parent
STILL_USED = ("test_inertia.py",)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.parent == HERE and item.path.name not in STILL_USED:
            item.add_marker(pytest.mark.slow)
