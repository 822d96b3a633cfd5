"""A uniform flat ski under a point load, on snow that does not pull."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow.carving.equilibrium import rest

from .synthetic import boot_pose, plain_ski, snow

EI, WIDTH, LOAD = 300.0, 0.065, 800.0


def deviation(hardness: float, elements: int) -> tuple[float, float]:
    """Relative deviation of the depth under the load and of the contact length from the one-sided answer."""
    ski = plain_ski(bending=EI, width=WIDTH)
    found = rest(ski, snow(hardness), edge_angle=0.0, load=LOAD, clamp_length=0.0, elements=elements)
    foundation = hardness * 1e9 * WIDTH
    rate = (foundation / (4.0 * EI)) ** 0.25
    depth = boot_pose(found, ski, 0.0)[0]
    assert found.contact_length is not None
    expected = LOAD * rate / (2.0 * foundation) / math.tanh(math.pi / 2.0)
    return depth / expected - 1.0, found.contact_length / (math.pi / rate) - 1.0


@pytest.mark.parametrize(
    ("hardness", "depth_error", "length_error"),
    [(0.02, 1e-5, 5e-4), (0.2, 2e-5, 5e-4), (1.0, 1e-4, 1e-3), (10.0, 5e-4, 2e-3), (90.0, 2e-3, 5e-3)],
)
def test_contact_ends_at_a_half_wave(hardness: float, depth_error: float, length_error: float) -> None:
    """Ends at ± π/(2λ), depth (P λ/2k) coth(π/2) under the load; the elements of 1 cm stand against 1/λ = 17 … 2 cm."""
    depth, length = deviation(hardness, 160)
    assert abs(depth) < depth_error
    assert abs(length) < length_error


def test_order_in_the_mesh() -> None:
    """Order 2 or better over four doublings: the contact ends anywhere within an element."""
    meshes = np.array([40, 80, 160, 320, 640])
    error = np.abs([deviation(90.0, int(n))[0] for n in meshes])
    order = -np.polyfit(np.log(meshes), np.log(error), 1)[0]
    assert order > 1.9


@pytest.mark.parametrize("reach", [1.0, 2.0, 3.0])
def test_short_or_soft_enough_to_press_everywhere(reach: float) -> None:
    """λl < π: Hetényi's free beam, (P λ/2k) (2 + cosh λl + cos λl)/(sinh λl + sin λl)."""
    length, hardness = 0.5, 0.2
    foundation = hardness * 1e9 * WIDTH
    bending = foundation * (length / reach) ** 4 / 4.0
    ski = plain_ski(length=length, width=WIDTH, bending=bending)
    found = rest(ski, snow(hardness), edge_angle=0.0, load=LOAD, clamp_length=0.0)
    rate = reach / length
    shape = (2.0 + math.cosh(reach) + math.cos(reach)) / (math.sinh(reach) + math.sin(reach))
    # the load vector of two points per element is of order 4 in a smooth load
    assert boot_pose(found, ski, 0.0)[0] == pytest.approx(LOAD * rate / (2.0 * foundation) * shape, rel=1e-7)
    assert found.edge_depth is not None
    assert np.all(found.edge_depth > 0.0)


def test_deflection_along_the_contact() -> None:
    """ε(s) of the one-sided beam: the free beam of length π/λ, straight beyond.

    With x the distance from the load and the ends at a = π/(2λ), 2k ε/(P λ) is Hetényi's (1946) free beam at λl = π:
    (cosh λx cos λ(2a - x) + cos λx cosh λ(2a - x) + sinh λx sin λ(2a - x) - sin λx sinh λ(2a - x) + 2 cosh λx cos λx)
    / sinh π, beyond a linear.
    """
    hardness = 0.2
    ski = plain_ski(bending=EI, width=WIDTH)
    found = rest(ski, snow(hardness), edge_angle=0.0, load=LOAD, clamp_length=0.0, elements=320)
    foundation = hardness * 1e9 * WIDTH
    rate = (foundation / (4.0 * EI)) ** 0.25
    x = rate * np.abs(found.station)
    y = math.pi - x
    inside = x < 0.98 * math.pi / 2.0
    shape = np.cosh(x) * np.cos(y) + np.cos(x) * np.cosh(y) - np.sinh(x) * np.sin(y) + np.sin(x) * np.sinh(y)
    shape = (shape + 2.0 * np.cosh(x) * np.cos(x)) / math.sinh(math.pi)
    expected = LOAD * rate / (2.0 * foundation) * shape
    assert found.edge_depth is not None
    assert found.edge_depth[inside] == pytest.approx(expected[inside], abs=2e-4 * float(expected.max()))
    beyond = x > 1.02 * math.pi / 2.0
    assert np.ptp(np.diff(found.edge_depth[beyond & (found.station > 0)][::2])) < 1e-9
