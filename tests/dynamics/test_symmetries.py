"""What must not matter: which side is left, where the start lies, where a level slope's axes point, the last bit."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import pytest

from skisnow.dynamics import Dynamics

from .sledges import advanced, fixed, given

DURATION: Final = 0.5
SKIDS: Final = {"snow__S_f_N_per_mm2": 0.1}
LEVEL: Final = {"slope__angle_deg": 0.0}
MIRROR: Final = np.diag([1.0, -1.0, 1.0])


def run(**changes: float) -> Dynamics:
    """Every step half a millisecond: the choice of steps is not what is looked at."""
    return advanced(given(**changes), DURATION, fixed(0.5e-3))


@pytest.mark.parametrize("changes", [{}, SKIDS], ids=["carves", "skids"])
@pytest.mark.parametrize("edge_angle", [30.0, 45.0])
def test_mirror(changes: dict[str, float], edge_angle: float) -> None:
    """The other edges, heading and side of the slope: left and right change places, twists their sign."""
    one, other = (
        run(sledge__edge_angle_deg=sign * edge_angle, start__heading_deg=-sign * 30.0, start__y_m=sign * 1.5, **changes)
        for sign in (1.0, -1.0)
    )
    assert other.position == pytest.approx(MIRROR @ one.position, abs=1e-9)
    assert other.rotation == pytest.approx(MIRROR @ one.rotation @ MIRROR, abs=1e-9)
    assert other.velocity == pytest.approx(one.velocity * [1.0, -1.0, 1.0, -1.0, 1.0, -1.0], abs=1e-7)
    untwisted = np.where(np.arange(one.beam_dofs.shape[1]) % 3 == 2, -1.0, 1.0)
    assert other.beam_dofs == pytest.approx(one.beam_dofs[::-1] * untwisted, abs=1e-9)
    assert abs(one.position[1] - 1.5) > 1.0  # it goes somewhere


def test_straight_down_stays_straight() -> None:
    dynamics = run(sledge__edge_angle_deg=0.0, start__heading_deg=0.0, snow__H_V_N_per_mm3=0.03)
    assert abs(dynamics.position[1]) < 1e-12
    assert dynamics.position[0] > 3.0


def test_start_elsewhere() -> None:
    """A plane is the same everywhere."""
    one, other = run(), run(start__x_m=13.7, start__y_m=-8.2)
    assert other.position == pytest.approx(one.position + np.array([13.7, -8.2, 0.0]), abs=1e-9)
    assert other.rotation == pytest.approx(one.rotation, abs=1e-9)


@pytest.mark.parametrize("changes", [{}, SKIDS], ids=["carves", "skids"])
def test_a_level_slope_knows_no_direction(changes: dict[str, float]) -> None:
    """Turned by 70° at the start, the whole run is turned by 70°."""
    one, other = (run(start__heading_deg=heading, **LEVEL, **changes) for heading in (0.0, 70.0))
    c, s = math.cos(math.radians(70.0)), math.sin(math.radians(70.0))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    assert other.position == pytest.approx(turn @ one.position, abs=1e-9)
    assert other.rotation == pytest.approx(turn @ one.rotation, abs=1e-9)
    assert one.position[1] > 0.1  # it does turn
