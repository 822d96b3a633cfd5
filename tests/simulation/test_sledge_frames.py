"""Frames of a sledge, against turns that everybody knows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow.simulation.sledge_body import base_lateral, base_normal, cross_matrix, rotation

HALF = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("quaternion", "images"),
    [
        ((1.0, 0.0, 0.0, 0.0), "x y z"),
        ((HALF, 0.0, 0.0, HALF), "y -x z"),  # a quarter turn to the left, from above
        ((HALF, HALF, 0.0, 0.0), "x z -y"),
        ((HALF, 0.0, HALF, 0.0), "-z y x"),
        ((0.5, 0.5, 0.5, 0.5), "y z x"),  # a third of a turn about the diagonal
    ],
)
def test_quarter_turns_lead_axes_to_axes(quaternion: tuple[float, ...], images: str) -> None:
    axes = dict(zip("xyz", np.eye(3), strict=True))
    expected = [(-1.0 if name[0] == "-" else 1.0) * axes[name[-1]] for name in images.split()]
    assert pytest.approx(np.array(expected), abs=1e-15) == rotation(quaternion).T


def test_any_turn_is_that_of_another_program() -> None:
    for w, x, y, z in Rotation.random(20, random_state=1).as_quat()[:, [3, 0, 1, 2]]:
        assert rotation((w, x, y, z)) == pytest.approx(Rotation.from_quat([x, y, z, w]).as_matrix(), abs=1e-14)


def test_cross_products() -> None:
    a, b = np.array([[1.0, -2.0, 3.0], [0.5, 4.0, -1.0]]), np.array([2.0, 5.0, -7.0])
    assert cross_matrix(a) @ b == pytest.approx(np.cross(a, b))


def test_an_edged_base_goes_down_on_the_left() -> None:
    angle = math.radians(30.0)
    assert base_normal(angle) == pytest.approx([0.0, 0.5, math.sqrt(0.75)])
    assert base_lateral(angle) == pytest.approx([0.0, math.sqrt(0.75), -0.5])
