"""*Carve*: what stands on it, and what its fields ask for."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .desk import Desk


def test_a_turn_is_there_with_the_page(desk: Desk) -> None:
    page = desk.open("/carve")
    page.shows("carver: equilibrium.")
    page.fill("Compared with", "slalom")
    page.shows("slalom: carved radius")
    page.fill("Ski", "slalom")
