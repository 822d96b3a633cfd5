"""Helpers that the tests of this folder share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..desk import Desk


def made(desk: Desk, make: Callable[[], Any], language: str = "en") -> Any:
    """An element on a page."""
    page = desk.open("/carve", language)
    return desk.do(make, page.client)
