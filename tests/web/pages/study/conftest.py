"""Fixtures of this room."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from skisnow.web import studies as queue

if TYPE_CHECKING:
    pass


@pytest.fixture(autouse=True)
def _three_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of which compute."""
    monkeypatch.setattr(queue, "available_cores", lambda: 3)
