"""Air drag as a vector, against the exact answer of a run on a plane slope."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.coded import raises, warns

from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.forces.drag import AirDrag
from skisnow.forces.friction import ConstantFriction

DRAG = AirDrag(drag_area=0.42, air_density=1.2)
COMPONENT = st.floats(-50.0, 50.0)


@given(st.floats(0.0, 2 * math.pi), COMPONENT, COMPONENT, COMPONENT, COMPONENT)
def test_rotation_of_the_frame(turn: float, along: float, across: float, tail: float, side: float) -> None:
    """Drag taken component by component would fail this: √2 too little at 45°."""
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    velocity, wind = np.array([along, across]), np.array([tail, side])
    turned = DRAG.force(rotation @ velocity, wind=rotation @ wind)
    np.testing.assert_allclose(turned, rotation @ DRAG.force(velocity, wind=wind), atol=1e-9)


@given(COMPONENT, COMPONENT, COMPONENT)
def test_size_and_direction(x: float, y: float, z: float) -> None:
    velocity = np.array([x, y, z])
    force = DRAG.force(velocity)
    speed = math.hypot(x, y, z)
    # a square that underflows is nobody's wind
    assert float(np.linalg.norm(force)) == pytest.approx(0.5 * 1.2 * 0.42 * speed**2, rel=1e-9, abs=1e-140)
    assert float(force @ velocity) <= 0.0


def test_wind() -> None:
    """With the wind at its own speed a body feels nothing; against 10 m/s it feels 20."""
    assert DRAG.force([10.0, 0.0], wind=[10.0, 0.0]).tolist() == [0.0, 0.0]
    assert DRAG.force([10.0, 0.0], wind=[-10.0, 0.0]) == pytest.approx(4 * DRAG.force([10.0, 0.0]))
    assert DRAG.force([0.0, 0.0], wind=[0.0, 5.0])[1] == pytest.approx(0.5 * 1.2 * 0.42 * 25)


def test_scaling_and_arrays() -> None:
    velocity = np.array([[[3.0, 4.0], [0.0, 0.0]], [[-6.0, 8.0], [1.0, 1.0]]])
    table = DRAG.force(velocity)
    assert table.shape == velocity.shape
    for place in np.ndindex(2, 2):
        assert table[place].tolist() == DRAG.force(velocity[place]).tolist()
    assert AirDrag(0.63, 1.2).force([3.0, 4.0]) == pytest.approx(1.5 * DRAG.force([3.0, 4.0]))
    assert AirDrag(0.42, 0.6).force([3.0, 4.0]) == pytest.approx(0.5 * DRAG.force([3.0, 4.0]))


def test_speed_over_the_path_on_a_plane_slope() -> None:
    """v²(s) = v∞² + (v₀² - v∞²) exp(-s/ℓ), ℓ = m/(ρ C_dA): friction and drag together, by Runge-Kutta over s."""
    mass, gravity, slope, start = 80.0, 9.81, math.radians(15.0), 5.0
    friction = ConstantFriction(0.05)

    def gain(v2: float) -> float:
        v = [math.sqrt(v2), 0.0]
        normal = mass * gravity * math.cos(slope)
        force = mass * gravity * math.sin(slope) + friction.friction_force(normal, v)[0] + DRAG.force(v)[0]
        return 2.0 * float(force) / mass

    v2, step = start**2, 0.5
    for _ in range(400):
        k1 = gain(v2)
        k2 = gain(v2 + step / 2 * k1)
        k3 = gain(v2 + step / 2 * k2)
        v2 += step / 6 * (k1 + 2 * k2 + 2 * k3 + gain(v2 + step * k3))
    length = mass / (1.2 * 0.42)
    final = 2 * mass * gravity * (math.sin(slope) - 0.05 * math.cos(slope)) / (1.2 * 0.42)
    # the step is 1/300 of the length: fourth order leaves some 10⁻¹²
    assert v2 == pytest.approx(final + (start**2 - final) * math.exp(-200.0 / length), rel=1e-9)


@pytest.mark.parametrize("drag_area", [0.1, 0.9])
def test_a_warning_outside_the_measured_range(drag_area: float) -> None:
    with warns(RangeWarning, "outside_measured", unit="m²", lowest=0.23, highest=0.66) as caught:
        AirDrag(drag_area, 1.2)
    assert caught[0].filename == __file__


def test_no_drag_is_not_warned_of() -> None:
    assert not np.any(AirDrag(0.0, 1.2).force([30.0, 0.0]))


@pytest.mark.parametrize(("drag_area", "air_density"), [(-0.1, 1.2), (0.4, 0.0), (math.nan, 1.2), (0.4, math.inf)])
def test_impossible_parameters_are_refused(drag_area: float, air_density: float) -> None:
    with raises(ParameterError, "out_of_range", kind="AirDrag"):
        AirDrag(drag_area, air_density)
