"""Fixtures of this room."""

import pytest

from skisnow.web import studies as queue


@pytest.fixture(autouse=True)
def _three_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of which compute."""
    monkeypatch.setattr(queue, "available_cores", lambda: 3)
