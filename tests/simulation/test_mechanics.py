"""Parts of a run's mechanics: groove pieces, inertia, frames of the sledge, standing skis."""

import math
from functools import partial
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from skisnow.scenario import Plane, Profile, RigidSledge
from skisnow.simulation.run_setup import Setup, laid_out, weight_meets_base
from skisnow.simulation.simulated_run import _groove
from skisnow.simulation.sledge_body import SledgeInertia, base_lateral, base_normal, rotation, sledge_inertia
from skisnow.ski.beam import ClampedSki, clamped
from tests.carving.synthetic import plain_ski, shovel
from tests.ski.beam.dense import beam_at, dense

from .runs.sledges import rigid_ski, scenario

FloatArray = npt.NDArray[np.float64]
EDGE = 0.5
SLEDGE = RigidSledge(80.0, (6.0, 8.0, 10.0), (0.1, 0.2), 0.5, EDGE)


def ski() -> ClampedSki:
    """Uneven in width and base; mass per length constant, the mesh's own sums are then exact but for the width."""
    made = plain_ski(width=lambda s: 0.07 + 0.02 * s**2, base_height=shovel(1.2, 0.1, 1.6), running_length=1.2)
    return clamped(made, 0.3, 16)


def whole(found: SledgeInertia, of: ClampedSki) -> FloatArray:
    """Dense matrix (6 + 2 n)."""
    n = of.size
    matrix = np.zeros((6 + 2 * n, 6 + 2 * n))
    matrix[:6, :6] = found.rigid
    for k in range(2):
        part = slice(6 + k * n, 6 + (k + 1) * n)
        matrix[part, part] = dense(of.mass)
        matrix[part, :6], matrix[:6, part] = found.coupling[k], found.coupling[k].T
    return matrix


def kinetic_of_points(of: ClampedSki, speeds: FloatArray, *, slices: int = 20000) -> float:
    """½∫ v² dm over the sledge and two skis cut into slices, each slice a thin strip across."""
    v, omega = speeds[:3], speeds[3:6]
    centre = np.array([0.1, 0.0, 0.2])
    at_centre = v + np.cross(omega, centre)
    energy = 0.5 * 80.0 * float(at_centre @ at_centre) + 0.5 * float(omega**2 @ np.array([6.0, 8.0, 10.0]))
    lateral = np.array([0.0, math.cos(EDGE), -math.sin(EDGE)])
    normal = np.array([0.0, math.sin(EDGE), math.cos(EDGE)])
    station = 0.8 - 1.6 * (np.arange(slices) + 0.5) / slices
    at = of.ski.at(station)
    mass = at.mass_per_length * 1.6 / slices
    for k, side in enumerate((0.25, -0.25)):
        rate = speeds[6 + k * of.size : 6 + (k + 1) * of.size]
        lifting, twisting = beam_at(of, rate, station)
        place = np.outer(station, np.eye(3)[0]) + side * np.eye(3)[1] + at.base_height[:, None] * normal
        moving = v + np.cross(omega, place) + lifting[:, None] * normal
        # φ̇ > 0 takes the left edge down: the strip turns about the ski's axis by ω_x - φ̇
        spread = mass * at.width**2 / 12.0
        energy += 0.5 * float(mass @ np.sum(moving**2, axis=1))
        energy += 0.5 * float(spread @ (omega[0] - twisting) ** 2)
        assert abs(float(lateral @ normal)) < 1e-15
    return energy


def test_kinetic_energy_is_that_of_the_points() -> None:
    of = ski()
    matrix = whole(sledge_inertia(SLEDGE, of), of)
    assert np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-12)
    rng = np.random.default_rng(1)
    for _ in range(5):
        speeds = rng.normal(size=len(matrix))
        # slices of 0.08 mm, and four Gauss points on tables that are straight between points: 1e-5 each
        assert 0.5 * speeds @ matrix @ speeds == pytest.approx(kinetic_of_points(of, speeds), rel=3e-5)


def test_twist_lowers_the_left_edge() -> None:
    """Rolling to the right lifts the left edge: a twist at the same rate leaves the strip in space unturned."""
    of = ski()
    coupling = sledge_inertia(SLEDGE, of).coupling
    assert coupling[0, 2::3, 3].max() < 0.0
    assert np.array_equal(coupling[0, 2::3], coupling[1, 2::3])


def test_rigid_limit() -> None:
    """Masses add up; the moments of straight flat skis are those of thin rods beside the middle (parallel axes)."""
    straight = clamped(plain_ski(), 0.3, 16)
    sledge = RigidSledge(80.0, (6.0, 8.0, 10.0), (0.1, 0.2), 0.5, 0.0)
    found = sledge_inertia(sledge, straight)
    of_skis = 2.0 * 1.4 * 1.6
    assert found.mass == pytest.approx(80.0 + of_skis, rel=1e-12)
    assert found.first_moment == pytest.approx([8.0, 0.0, 16.0], abs=1e-12)
    strip = of_skis * 0.065**2 / 12.0
    rod = of_skis * 1.6**2 / 12.0
    assert found.rigid[3, 3] == pytest.approx(6.0 + 80.0 * 0.04 + of_skis * 0.0625 + strip, rel=1e-9)
    assert found.rigid[4, 4] == pytest.approx(8.0 + 80.0 * 0.05 + rod, rel=1e-9)
    assert found.rigid[5, 5] == pytest.approx(10.0 + 80.0 * 0.01 + of_skis * 0.0625 + rod, rel=1e-9)
    assert found.rigid[3, 5] == pytest.approx(-80.0 * 0.1 * 0.2, rel=1e-9)
    assert found.rigid[0, 4] == pytest.approx(16.0, rel=1e-12)
    assert found.rigid[2, 4] == pytest.approx(-8.0, rel=1e-12)


ROWS = np.array([
    # ski, line, x, y, z, depth
    [0, 0, 1.0, 2.0, 0.0, 0.01],
    [0, 0, 1.0, 2.4, 0.0, 0.02],
    [0, 0, 1.0, 2.6, 0.0, 0.015],
    [0, 1, 1.5, 2.0, 0.0, 0.03],
    [1, 1, 3.0, 0.0, 0.0, 0.04],
    [1, 1, 3.3, 0.4, 0.0, 0.005],
])  # fmt: skip


def groove(rows: np.ndarray) -> Any:
    contact = SimpleNamespace(tracks=lambda: rows)
    scenario = SimpleNamespace(contact=SimpleNamespace(unloading_ratio=5.0))
    setup = cast(
        "Any",
        SimpleNamespace(
            dynamics=SimpleNamespace(contact=contact), scenario=scenario, snow=SimpleNamespace(penetration=None)
        ),
    )
    setup.residual_depth = partial(Setup.residual_depth, setup)
    return _groove(setup)


def test_each_line_is_a_piece_as_deep_as_its_deepest_knot() -> None:
    """Of one knot alone there is no width; four fifths of the depth stay where the snow unloads five times as hard."""
    found = groove(ROWS)
    assert found.middle == pytest.approx(np.array([[1.0, 2.3, 0.0], [3.15, 0.2, 0.0]]))
    assert found.left == pytest.approx(np.array([[0.0, 1.0, 0.0], [0.6, 0.8, 0.0]]))
    assert found.width == pytest.approx([0.6, 0.5])
    assert found.depth == pytest.approx([0.02, 0.04])
    assert found.residual_depth == pytest.approx([0.016, 0.032])


def test_without_contact_there_is_none() -> None:
    found = groove(np.zeros((0, 6)))
    assert found.middle.shape == found.left.shape == (0, 3)
    assert len(found.width) == len(found.depth) == len(found.residual_depth) == 0


def test_any_turn_is_that_of_another_program() -> None:
    for w, x, y, z in Rotation.random(20, random_state=1).as_quat()[:, [3, 0, 1, 2]]:
        assert rotation((w, x, y, z)) == pytest.approx(Rotation.from_quat([x, y, z, w]).as_matrix(), abs=1e-14)


def test_an_edged_base_goes_down_on_the_left() -> None:
    angle = math.radians(30.0)
    assert base_normal(angle) == pytest.approx([0.0, 0.5, math.sqrt(0.75)])
    assert base_lateral(angle) == pytest.approx([0.0, math.sqrt(0.75), -0.5])


TAN_20 = math.tan(math.radians(20.0))


@pytest.mark.parametrize(
    "slope",
    [Plane(math.radians(20.0)), Profile(np.arange(-5.0, 6.0), -TAN_20 * np.arange(-5.0, 6.0))],
    ids=["plane", "profile"],
)
@pytest.mark.parametrize("heading_deg", [0.0, 30.0, -90.0])
def test_gravity_passes_through_the_centre_of_mass(slope: Plane | Profile, heading_deg: float) -> None:
    """From a height h over a slope of angle α: h tan α down the fall line, from which the sledge heads to the left."""
    given = scenario(ski=rigid_ski(), slope=slope, centre_height=0.4, heading_deg=heading_deg)
    setup, heading = laid_out(given), math.radians(heading_deg)
    forward, left, height = setup.dynamics.body.first_moment / setup.dynamics.body.mass
    assert height == pytest.approx(0.4 * 80.0 / (80.0 + 2.0 * given.ski.mass), rel=1e-2)  # the skis lie at the base
    down = height * TAN_20
    expected = (forward + down * math.cos(heading), left - down * math.sin(heading))
    assert weight_meets_base(setup) == pytest.approx(expected, abs=1e-12)
