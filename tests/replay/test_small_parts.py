"""Small parts of a replay by hand: triangles of a strip, pieces of groove of a single moment, kinds of arrays."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow.replay.binary import ARRAY_TYPES
from skisnow.replay.meshes import _strips
from skisnow.replay.replay import groove_times, quaternions


def test_a_strip_between_two_sections_is_two_triangles_that_face_the_same_way() -> None:
    """Corners 0 and 1 of the first section, 2 and 3 of the second: each triangle goes round in the same sense."""
    triangles = _strips(2, 2, [(0, 1)])
    assert triangles.tolist() == [[0, 2, 1], [1, 2, 3]]
    place = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]])
    a, b, c = (place[triangles[:, i]] for i in range(3))
    along, aside = b - a, c - a
    twice_area = along[:, 0] * aside[:, 1] - along[:, 1] * aside[:, 0]
    assert twice_area.tolist() == [1.0, 1.0]


def test_pieces_of_groove_of_a_single_moment_have_its_time() -> None:
    track = np.array([[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]])
    when, ski = groove_times(np.array([[0.5, -0.9, 0.0], [0.0, 3.0, 0.0]]), np.array([7.0]), track)
    assert (when.tolist(), ski.tolist()) == ([7.0, 7.0], [1, 0])


def test_every_array_has_a_kind_and_a_unit_that_readers_know() -> None:
    assert {each.type for each in ARRAY_TYPES.values()} == {"float32", "uint16"}
    assert {each.unit for each in ARRAY_TYPES.values()} == {"1", "m", "m/s", "1/m", "rad", "s", "N/m", "N"}


def test_quaternions_go_on_over_more_than_a_turn() -> None:
    """About z by 0 to 900 degrees in steps of 30: each is (cos, 0, 0, sin) of half the angle, and 30 from the last."""
    angle = np.radians(np.arange(0.0, 901.0, 30.0))
    sine, cosine, none = np.sin(angle), np.cos(angle), np.zeros_like(angle)
    matrices = np.stack([cosine, -sine, none, sine, cosine, none, none, none, none + 1.0], axis=1).reshape(-1, 3, 3)
    found = quaternions(matrices)
    assert found == pytest.approx(np.stack([np.cos(angle / 2.0), none, none, np.sin(angle / 2.0)], axis=1), abs=1e-12)


def test_no_matrices_are_no_quaternions() -> None:
    assert quaternions(np.zeros((0, 3, 3))).shape == (0, 4)
