"""A rigid straight ski: depth, tilt and grip in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow.carving.equilibrium import carve, rest
from skisnow.carving.result import Equilibrium

from .synthetic import boot_pose, rigid_ski, snow

LENGTH, WIDTH = 1.6, 0.065
EXACT = (
    5e-8  # Newton's method leaves 1e-8 N of force and 1e-8 N m of moment per N of load: 1e-8 (1 + 6 m/l) at the ends
)


@pytest.mark.parametrize("hardness", [0.02, 0.2, 2.0, 90.0])
@pytest.mark.parametrize("clamp", [0.0, 0.3])
def test_flat(hardness: float, clamp: float) -> None:
    """F/(H_V · area)."""
    found = rest(rigid_ski(), snow(hardness), edge_angle=0.0, load=800.0, clamp_length=clamp)
    expected = 800.0 / (hardness * 1e9 * LENGTH * WIDTH)
    assert found.outcome == "equilibrium"
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT)
    assert found.force_per_length == pytest.approx(np.full(320, 800.0 / LENGTH), rel=EXACT)
    assert found.turn_radius_boot is None
    assert (found.side_force, found.holds) == (0.0, True)


@pytest.mark.parametrize("moment", [-60.0, 20.0])
def test_flat_with_a_moment(moment: float) -> None:
    """ε = F/(H_V w l) + 12 M s/(H_V w l³): a moment that presses the tip down deepens it."""
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=800.0, moment=moment)
    stiffness = 0.2e9 * WIDTH
    expected = 800.0 / (stiffness * LENGTH) + 12.0 * moment / (stiffness * LENGTH**3) * found.station
    assert found.edge_depth == pytest.approx(expected, rel=EXACT)


def test_flat_lifting_off() -> None:
    """M > F l/6: a triangle of pressure whose centre is under the load; length 3 (l/2 - M/F), depth 2F/(k length)."""
    load, moment = 800.0, 320.0  # 0.4 m before the boot
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=load, moment=moment, elements=320)
    bearing = 3.0 * (LENGTH / 2.0 - moment / load)
    deepest = 2.0 * load / (0.2e9 * WIDTH * bearing)
    depth, slope = boot_pose(found, rigid_ski(), 0.0)
    # two points per element do not see where within an element the pressure ends: (h/l)² ~ 1e-5
    assert depth + slope * LENGTH / 2.0 == pytest.approx(deepest, rel=5e-5)
    assert found.contact_length == pytest.approx(bearing, abs=LENGTH / 320)
    assert found.outcome == "equilibrium"
    forward = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=load, moment=-moment, elements=320)
    assert forward.edge_depth is not None
    assert found.edge_depth == pytest.approx(forward.edge_depth[::-1], rel=1e-6, abs=1e-12)


def test_a_load_far_ahead_misses_the_boot() -> None:
    """M/F = 0.6 m: the triangle of 3 (0.8 - 0.6) m ends 0.2 m before the boot."""
    found = rest(rigid_ski(), snow(0.2), edge_angle=0.0, load=800.0, moment=480.0)
    assert found.outcome == "bridges"
    assert found.turn_radius_chord is None
    assert found.contact_length == pytest.approx(0.6, abs=0.01)  # an element


@pytest.mark.parametrize("angle_deg", [1.0, 5.0, 15.0, 30.0, 45.0, 60.0, 80.0])
@pytest.mark.parametrize("ratio", [1.0, 10.0, math.inf])
def test_wedge(angle_deg: float, ratio: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)); an even groove under an even edge is not felt, whatever it remembers."""
    angle = math.radians(angle_deg)
    found = carve(rigid_ski(), snow(0.2), edge_angle=angle, load=800.0, unloading_ratio=ratio)
    expected = math.sqrt(2.0 * 800.0 * math.tan(angle) / (0.2e9 * LENGTH))
    assert expected < WIDTH * math.sin(angle)
    # with memory an edge that tilts by rounding already carries on its deeper end: e to 1e-6, its tilt no better
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT if ratio == 1.0 else 1e-6)


@pytest.mark.parametrize(("angle_deg", "load"), [(0.5, 800.0), (1.0, 3000.0), (2.0, 9000.0)])
def test_beyond_the_wedge(angle_deg: float, load: float) -> None:
    """e > W sin ϑ: F = H_V L W cos ϑ (e - W sin ϑ/2)."""
    angle = math.radians(angle_deg)
    found = rest(rigid_ski(), snow(0.02), edge_angle=angle, load=load)
    expected = load / (0.02e9 * LENGTH * WIDTH * math.cos(angle)) + WIDTH * math.sin(angle) / 2.0
    assert expected > WIDTH * math.sin(angle)
    assert found.edge_depth == pytest.approx(np.full(320, expected), rel=EXACT)


def test_wedge_and_trapezoid_meet() -> None:
    """At e = W sin ϑ both give F = H_V L W² sin ϑ cos ϑ/2; a millionth more or less of it moves e by as little."""
    angle = math.radians(2.0)
    load = 0.02e9 * LENGTH * WIDTH**2 * math.sin(angle) * math.cos(angle) / 2.0
    for factor in (1.0 - 1e-6, 1.0, 1.0 + 1e-6):
        found = rest(rigid_ski(), snow(0.02), edge_angle=angle, load=load * factor)
        assert found.edge_depth == pytest.approx(np.full(320, WIDTH * math.sin(angle)), rel=2e-6)


@pytest.mark.parametrize("slope", [-1.0e-3, 0.5e-3])
def test_tilted_wedge(slope: float) -> None:
    """e = a + b s: F = H_V/(2 tan ϑ) (a² l + b² l³/12), M = H_V/(2 tan ϑ) a b l³/6."""
    angle, depth = math.radians(40.0), 3e-3
    factor = 0.2e9 / (2.0 * math.tan(angle))
    load = factor * (depth**2 * LENGTH + slope**2 * LENGTH**3 / 12.0)
    moment = factor * depth * slope * LENGTH**3 / 6.0
    found = rest(rigid_ski(), snow(0.2), edge_angle=angle, load=load, moment=moment)
    assert found.edge_depth == pytest.approx(depth + slope * found.station, rel=1e-7)


def grip(load: float) -> Equilibrium:
    return carve(rigid_ski(), snow(0.2, 0.3), edge_angle=math.radians(50.0), load=load, unloading_ratio=1.0)


def test_grip_ends_at_a_depth() -> None:
    """Demand H_V e² L/2 = F tan ϑ against S_f e L: holds up to e = 2 S_f/H_V, the side force there is 2 S_f² L/H_V."""
    greatest = 2.0 * (0.3e6) ** 2 * LENGTH / 0.2e9
    load = greatest / math.tan(math.radians(50.0))
    below, above = grip(load * (1.0 - 1e-6)), grip(load * (1.0 + 1e-6))
    assert (below.outcome, below.holds) == ("equilibrium", True)
    assert (above.outcome, above.holds) == ("slips", False)
    assert above.side_force == pytest.approx(greatest, rel=2e-6)
    assert above.side_force_limit == pytest.approx(greatest, rel=2e-6)
    assert above.edge_depth == pytest.approx(np.full(320, 2.0 * 0.3 / 0.2 * 1e-3), rel=2e-6)
