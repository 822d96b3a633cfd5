"""Machining after Eqn 10 and its thrust."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skisnow.forces.cutting import cutting_stress, cutting_thrust

ANGLES_DEG = (30.0, 45.0, 60.0, 75.0, 90.0)


@pytest.mark.parametrize(("angle_deg", "depth_mm"), list(zip(ANGLES_DEG, (1.25, 2.01, 2.85, 3.82, 4.99), strict=True)))
def test_worked_example(angle_deg: float, depth_mm: float) -> None:
    """900 N on 1.7 m of edge, S = 0.05 N/mm², μ_t = 0.06: the depth that balances."""
    stress = float(cutting_stress(0.05e6, math.radians(angle_deg), transverse_friction=0.06))
    assert 900.0 / (1.7 * stress) * 1e3 == pytest.approx(depth_mm, abs=0.005)


def test_a_vertical_blade_without_friction_cuts_at_twice_the_shear_strength() -> None:
    assert float(cutting_stress(1.0, math.pi / 2, transverse_friction=0.0)) == pytest.approx(2.0)
    # Eqn 13 at 90° is 0.0344 N/mm² as printed, so S = 0.0172
    assert float(cutting_stress(0.0172e6, math.pi / 2, transverse_friction=0.0)) == pytest.approx(0.0344e6)


@given(st.floats(0.2, math.pi / 2), st.floats(0.0, 0.15))
def test_stress_and_thrust_are_the_two_components_of_one_force(edge_angle: float, friction: float) -> None:
    """Merchant's force circle with φ = (ϑ - β)/2: thrust/cut = (cot²φ - 1)/(2 cot φ) = cot 2φ = cot(ϑ - β)."""
    beta = math.atan(friction)
    cut = float(cutting_stress(1.0, edge_angle, transverse_friction=friction))
    thrust = float(cutting_thrust(1.0, edge_angle, transverse_friction=friction))
    assert thrust / cut == pytest.approx(1.0 / math.tan(edge_angle - beta), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("angle_deg", ANGLES_DEG)
def test_shear_stress_on_the_shear_plane_is_the_strength(angle_deg: float) -> None:
    """Equilibrium of the chip: force along the plane over its area L e/sin φ equals S."""
    friction = 0.2
    phi = (math.radians(angle_deg) - math.atan(friction)) / 2
    cut = float(cutting_stress(3.0, math.radians(angle_deg), transverse_friction=friction))
    thrust = float(cutting_thrust(3.0, math.radians(angle_deg), transverse_friction=friction))
    assert (cut * math.cos(phi) - thrust * math.sin(phi)) * math.sin(phi) == pytest.approx(3.0)


def test_at_and_below_the_friction_angle_there_is_no_shear_plane() -> None:
    angles = np.array([math.atan(0.2), 0.1, 0.3])
    assert np.isnan(cutting_stress(1.0, angles, transverse_friction=0.2)).tolist() == [True, True, False]
