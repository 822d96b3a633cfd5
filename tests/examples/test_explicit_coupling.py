"""How long a step may be where snow and body take turns."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_forces_that_are_late_feed_a_swing() -> None:
    """Flat skis at 0.5 ms: taken in turn they rest on the snow, taken a step late they leap."""
    swing = runpy.run_path(str(ROOT / "examples" / "explicit_coupling.py"))["swing"]
    assert swing(0.2, 5e-4, edge_angle=0.0, late=False) < 0.1
    assert swing(0.2, 5e-4, edge_angle=0.0, late=True) > 1.0
    assert swing(0.2, 1e-3, edge_angle=math.radians(45.0), late=False) < 0.1


@pytest.mark.slow
def test_the_page_has_the_table() -> None:
    table = runpy.run_path(str(ROOT / "examples" / "explicit_coupling.py"))["table"]()
    assert table in (ROOT / "docs" / "how-to" / "other-programs.md").read_text(encoding="utf-8")
