"""What a runner does between two poses that turn: it goes along an arc."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.contact import SnowContact, SnowField

from .conftest import straight

FloatArray = npt.NDArray[np.float64]

RADIUS, SPEED = 12.0, 10.0
ANGLE, DEPTH = math.radians(30.0), 8e-3
WAY = 2.4
"""(m) more than the length of the runner, so that no line knows of the start."""


def pose(s: float) -> tuple[FloatArray, FloatArray]:
    """After a way along a circle, left edge down, the ski along its tangent."""
    turn = s / RADIUS
    ahead = np.array([math.cos(turn), math.sin(turn), 0.0])
    left = np.array([-math.sin(turn), math.cos(turn), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    across = math.cos(ANGLE) * left - math.sin(ANGLE) * up
    height = 0.03 * math.sin(ANGLE) - DEPTH
    place = np.array([RADIUS * math.sin(turn), RADIUS * (1.0 - math.cos(turn)), height])
    return place[None], np.column_stack([ahead, across, np.cross(ahead, across)])[None]


def wrench(step: float) -> FloatArray:
    """In the ski's axes at the end of the way, gone in steps of a length (m)."""
    snow = SnowField(2e8, 3e5, 10.0, shear_displacement=2e-5, part_along=2e-3)
    contact = SnowContact(snow, [straight()])
    places = np.linspace(0.0, WAY, round(WAY / step) + 1)
    for place in places[:-1]:
        contact.update(*pose(float(place)), step / SPEED)
    position, rotation = pose(float(places[-1]))
    found = contact.force(position, rotation, np.zeros((1, 6)), step / SPEED).wrench[0]
    return np.concatenate([rotation[0].T @ found[:3], rotation[0].T @ found[3:]])


@pytest.mark.parametrize("step", [0.06, 0.03])
def test_long_steps_leave_what_short_ones_do(step: float) -> None:
    """A chord of 6 cm lies 37 µm beside the circle: more than the edge's displacement to full strength."""

    fine = wrench(2e-3)
    assert wrench(step) == pytest.approx(fine, abs=0.02 * float(np.abs(fine).max()))
