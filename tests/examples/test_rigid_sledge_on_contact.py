"""Somebody else's rigid body on the contact."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "rigid_sledge_on_contact.py"


def test_a_straight_glide_gains_what_friction_leaves() -> None:
    """v² = v₀² + 2 g (sin α - μ cos α) s; the shovels take a thousandth of it, since they press a groove."""
    sledge = runpy.run_path(str(EXAMPLE))
    rows = sledge["glide"](0.5)
    way, speed, energy, work = rows[-1]
    slope = math.radians(10.0)
    assert speed**2 == pytest.approx(1.0 + 2.0 * 9.81 * (math.sin(slope) - 0.05 * math.cos(slope)) * way, rel=1.5e-3)
    lost = rows[0][2] - energy, work - rows[0][3]
    assert lost[0] == pytest.approx(lost[1], rel=5e-3)
    assert lost[0] > lost[1]
