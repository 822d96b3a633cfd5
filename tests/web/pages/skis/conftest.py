"""Fixtures of this room."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest

from skisnow.web.confined import OF_A_SKI

if TYPE_CHECKING:
    pass


@pytest.fixture(autouse=True)
def confined_words(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """What would be read in a process of its own is read here; gives with what it was called."""
    heard: list[tuple[object, ...]] = []

    def here(bounds: object, work: Callable[..., object], *args: object) -> object:
        assert bounds is OF_A_SKI
        heard.append((work, *args))
        return work(*args)

    for name in ("pages.skis", "ski_adding", "measured_ski"):
        monkeypatch.setattr(f"skisnow.web.{name}.confined", here)
    return heard
