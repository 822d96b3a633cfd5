"""The pages' Python examples are doctests; each page runs in an empty folder of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

LONG = {"docs/tutorials/campaign.md", "docs/how-to/in-python.md"}
"""Pages that draw whole reports, or simulate for long."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the long pages, which run with the slow tests."""
    for item in items:
        if item.nodeid.partition("::")[0] in LONG:
            item.add_marker(pytest.mark.slow)


@pytest.fixture(autouse=True)
def _empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
