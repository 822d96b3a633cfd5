"""Fixtures of this room."""

from __future__ import annotations

import pytest

from ..desk import in_this_process


@pytest.fixture(autouse=True)
def confined_words(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """What would be read in a process of its own is read here; gives limits, work and what it is given."""
    return in_this_process(monkeypatch, "pages.skis", "ski_uploads", "lab_skis")
