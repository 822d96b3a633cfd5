"""Fixtures of this room."""

import pytest

from ..desk import in_this_process


@pytest.fixture(autouse=True)
def confined_words(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """Read files here instead of in a separate process; gives limits, work and its arguments."""
    return in_this_process(monkeypatch, "pages.skis", "ski_editor", "lab_skis")
