"""Single stages of the contact: derivatives against differences, and the ground of one line."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.compiled import core
from skisnow.contact import SnowContact, SnowField

from .conftest import edged, straight

FloatArray = npt.NDArray[np.float64]
H, S = 2e8, 5e5
DT = 5e-4
DEPTH = 2e-3
"""Of the edge (m)."""


def in_snow(set_of_instructions: str | None, *, angle: float, sunk: float) -> tuple[SnowContact, FloatArray]:
    """A ski that has gone 3 cm ahead, lies a little deeper, and is displaced across by a tenth of u_y; its pose."""
    contact = SnowContact(SnowField(H, S, 10.0), [straight()], instruction_set=set_of_instructions)
    rotation, height = edged(angle), 0.03 * abs(np.sin(angle)) - DEPTH
    for step in range(7):
        contact.update([[0.005 * step, 0.0, height]], rotation[None], DT)
    place = np.array([0.03, 2e-6, height - sunk])
    return contact, np.concatenate([place, rotation.ravel()])


@pytest.mark.parametrize("angle", [0.5, -0.5, 1.0, 0.2])
@pytest.mark.parametrize("sunk", [2e-5, -3e-6])
def test_tangent_against_differences(angle: float, sunk: float) -> None:
    """Closed form and the public central differences, brought to the ski's moving axes.

    -d(Rᵀ f) = -Rᵀ df + φ × Rᵀ f. The tangent takes one step of h = 1e-8 m, so its error is below h over the depth. It
    leaves out the force along the ski by rotations, and a way ahead, which takes tip and tail over the lines. A
    rotation moves the edge, at r = half the width, ahead by r: tip and tail then exchange r of the load per length.
    """
    contact, pose = in_snow(None, angle=angle, sunk=sunk)
    at = pose[None, :3], pose[3:].reshape(1, 3, 3), np.zeros((1, 6)), 0.0
    tangent, wrench = core.runner_tangent(contact.compiled, *at, 1.0, 0.0)
    stiffness, _ = contact.tangent(*at)
    axes = np.kron(np.eye(2), at[1][0])
    expected = axes.T @ stiffness[0] @ axes
    for c in range(3):
        expected[:3, 3 + c] += np.cross(np.eye(3)[c], wrench[:3])
        expected[3:, 3 + c] += np.cross(np.eye(3)[c], wrench[3:])
    size = np.sqrt(np.abs(np.diag(expected)) + 1.0)
    assert np.linalg.norm(wrench[:3]) > 100.0
    (runner,) = contact.runners
    length, load = float(np.ptp(runner.position)), float(np.linalg.norm(wrench[:3]))
    ends = load / length * runner.half_width[0] * np.outer([1.0] * 3 + [length] * 3, [0.0] * 3 + [1.0] * 3)
    bound = 1e-8 / DEPTH * np.outer(size, size) + ends
    assert (np.abs(tangent - expected)[1:, 1:] <= bound[1:, 1:]).all()


@pytest.mark.parametrize("width", core.instruction_sets())
def test_tangent_has_the_same_bits_in_all_lane_widths(width: str) -> None:
    found = []
    for chosen in (core.instruction_sets()[0], width):
        contact, pose = in_snow(chosen, angle=0.5, sunk=2e-5)
        args = pose[None, :3], pose[3:].reshape(1, 3, 3), np.array([[8.0, 0.1, 0.0, 0.0, 0.2, 0.0]])
        found.append(core.runner_tangent(contact.compiled, *args, DT, 1.0, 0.3))
    assert np.array_equal(found[0][0], found[1][0])
    assert np.array_equal(found[0][1], found[1][1])


def depths(knots: FloatArray, at: FloatArray) -> FloatArray:
    """Depth of a ground between its knots, zero beyond."""
    return np.interp(at, knots[:, 0], knots[:, 1], left=0.0, right=0.0) if len(knots) else 0.0 * at


def random_polyline(random: np.random.Generator, knots: int) -> FloatArray:
    place = np.sort(random.uniform(-0.03, 0.03, knots))
    return np.column_stack([place, random.uniform(1e-3, 5e-3, knots)])


@pytest.mark.parametrize("seed", range(200))
def test_the_deeper_of_both_is_kept(seed: int) -> None:
    """At places between all knots; the mirror image has the same depths."""
    random = np.random.default_rng(seed)
    ground, pressed = random_polyline(random, int(random.integers(2, 9))), random_polyline(random, 3)
    if seed % 3 == 0:
        pressed[:, 1] += 5e-3  # deeper everywhere
    if seed % 3 == 1:
        pressed[:, 1] *= 0.1  # mostly less deep
    found, changed = core.pressed_ground(ground, pressed)
    at = np.linspace(-0.031, 0.031, 4001)
    at = at[np.abs(at[:, None] - np.append(ground[:, 0], pressed[:, 0])).min(axis=1) > 1e-6]
    expected = np.maximum(depths(ground, at), depths(pressed, at))
    assert depths(found, at) == pytest.approx(expected, abs=1e-12)
    assert changed == bool((depths(pressed, at) > depths(ground, at) + 1e-12).any())
    mirror = np.array([-1.0, 1.0])
    other, _ = core.pressed_ground((ground * mirror)[::-1].copy(), (pressed * mirror)[::-1].copy())
    assert np.array_equal(other, (found * mirror)[::-1])


def test_ground_of_nothing() -> None:
    """Virgin snow takes what is pressed; two grooves that lie apart have no depth between them."""
    none, wedge = np.empty((0, 2)), np.array([[0.0, 1e-3], [0.01, 3e-3]])
    found, changed = core.pressed_ground(none, wedge)
    assert changed
    assert np.array_equal(found, wedge)
    both, _ = core.pressed_ground(wedge, wedge + np.array([0.02, 0.0]))
    assert depths(both, np.array([0.005, 0.015, 0.025])) == pytest.approx([2e-3, 0.0, 2e-3])
    again, changed = core.pressed_ground(wedge, wedge)
    assert not changed
    assert np.array_equal(again, wedge)
