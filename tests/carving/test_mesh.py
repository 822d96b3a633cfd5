"""What the mesh does to the answer: elements 40 … 640, and a ski without a shovel."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from skisnow.carving.equilibrium import ELEMENTS, carve
from skisnow.ski import read_ski

from .synthetic import circular_sidecut, plain_ski, shovel, snow

MESHES = (40, 80, 160, 320, 640)


@cache  # both tests ask for 160 and 640 elements
def results(hardness: float, ratio: float, elements: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Radius at the boot, over the chord, greatest depth, contact length."""
    found = carve(
        read_ski("slalom"),
        snow(hardness),
        edge_angle=math.radians(45.0),
        load=800.0,
        unloading_ratio=ratio,
        elements=elements,
    )
    assert found.edge_depth is not None
    return np.array(
        [found.turn_radius_boot, found.turn_radius_chord, found.edge_depth.max(), found.contact_length], dtype=float
    )


@pytest.mark.parametrize("hardness", [0.04, 0.2, 1.0, 90.0])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_default_elements_are_enough(hardness: float, ratio: float) -> None:
    """Against 640: radius at the boot 0.01 %, over the chord 0.1 %, greatest depth 0.1 %, contact length 0.2 %.

    The contact ends on the shovel, between two stations 5 mm apart: 2 mm of 1.4 m are 0.15 %.
    """
    assert ELEMENTS == 160
    error = np.abs(results(hardness, ratio, ELEMENTS) / results(hardness, ratio, 640) - 1.0)
    assert np.all(error < [1e-4, 1e-3, 1e-3, 2e-3])


@pytest.mark.parametrize("hardness", [0.04, 0.2, 1.0, 90.0])
@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_the_answer_converges(hardness: float, ratio: float) -> None:
    """From 40 to 320 elements the distance to 640 falls by more than a factor of eight: order 1 or better."""
    rows = np.array([results(hardness, ratio, n) for n in MESHES])
    distance = np.linalg.norm(rows[:-1] / rows[-1] - 1.0, axis=1)
    assert distance[0] > 8.0 * distance[-1]
    assert distance[0] < 0.015


def tip_depths(*, with_shovel: bool) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Greatest edge depth before the boot of a rigid ski with a sidecut, on rigid-plastic snow (m)."""
    base = shovel(1.4, 0.08, 1.6) if with_shovel else None
    ski = plain_ski(width=circular_sidecut(13.0), bending=1e10, torsional=1e10, base_height=base)
    depths = []
    for elements in MESHES:
        found = carve(
            ski,
            snow(0.2),
            edge_angle=math.radians(45.0),
            load=800.0,
            unloading_ratio=math.inf,
            clamp_length=0.0,
            elements=elements,
        )
        assert found.edge_depth is not None
        depths.append(float(found.edge_depth[found.station > 0.0].max()))
    return np.array(depths)


def test_a_tip_in_the_snow_has_no_limit() -> None:
    """First and last station share the load, F/2 = H_V e² Δs/(2 tan ϑ), whatever Δs is: e ~ Δs^(-1/2)."""
    spacing = 1.6 / (2.0 * np.array(MESHES))
    expected = np.sqrt(800.0 * math.tan(math.pi / 4.0) / (0.2e9 * spacing))
    assert tip_depths(with_shovel=False) == pytest.approx(expected, rel=1e-5)


def test_a_shovel_gives_it_one() -> None:
    """The same ski with a shovel: 8 % from 40 to 640 elements instead of a factor of four, and at rest in the end."""
    depths = tip_depths(with_shovel=True)
    assert depths[-1] / depths[0] < 1.1
    assert abs(depths[-2] / depths[-1] - 1.0) < 0.005
