"""What the mesh does to the answer: elements 40 … 640, and a ski without a shovel."""

import math
from functools import cache

import numpy as np
import pytest

from skisnow.carving.edge_line import BOOT_REACH, EdgeLine
from skisnow.carving.equilibrium import ELEMENTS, _conditions, carve, rest
from skisnow.carving.solve import solved
from skisnow.ski import read_ski
from skisnow.ski.beam import clamped
from tests.present import present

from .synthetic import boot_pose, circular_sidecut, plain_ski, shovel, snow

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
def test_default_elements_are_enough_and_the_answer_converges(hardness: float, ratio: float) -> None:
    """Against 640: radius at the boot 0.01 %, over the chord 0.1 %, greatest depth 0.1 %, contact length 0.2 %.

    The contact ends on the shovel, between two stations 5 mm apart: 2 mm of 1.4 m are 0.15 %.
    """
    assert ELEMENTS == 160
    error = np.abs(results(hardness, ratio, ELEMENTS) / results(hardness, ratio, 640) - 1.0)
    assert np.all(error < [1e-4, 1e-3, 1e-3, 2e-3])
    # From 40 to 320 elements the distance to 640 falls by more than a factor of eight: order 1 or better.
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
        depths.append(float(present(found.edge_depth)[found.station > 0.0].max()))
    return np.array(depths)


def test_a_tip_in_the_snow_has_no_limit_and_a_shovel_gives_it_one() -> None:
    """First and last station share the load, F/2 = H_V e² Δs/(2 tan ϑ), whatever Δs is: e ~ Δs^(-1/2)."""
    spacing = 1.6 / (2.0 * np.array(MESHES))
    expected = np.sqrt(800.0 * math.tan(math.pi / 4.0) / (0.2e9 * spacing))
    assert tip_depths(with_shovel=False) == pytest.approx(expected, rel=1e-5)
    # The same ski with a shovel: 8 % from 40 to 640 elements instead of a factor of four, and at rest in the end.
    depths = tip_depths(with_shovel=True)
    assert depths[-1] / depths[0] < 1.1
    assert abs(depths[-2] / depths[-1] - 1.0) < 0.005


@cache
def carved() -> EdgeLine:
    """At 45 degrees."""
    ski, angle = plain_ski(width=circular_sidecut(13.0)), math.radians(45.0)
    conditions = _conditions(ski, snow(2.0), angle, 300.0, 5.0, 1.0)
    model = clamped(ski, 0.3, 40)
    return EdgeLine(model, angle, solved(model, conditions))


def test_the_circle_meets_the_edge_at_the_boot_and_before_and_behind_it() -> None:
    line = carved()
    radius = present(line.radius_at_boot())
    offset = np.interp([0.0, BOOT_REACH, -BOOT_REACH], line.station[::-1], line.offset_from_circle()[::-1])
    # straight between stations 2 cm apart: a chord of (2 cm)²/8 R
    assert offset == pytest.approx(np.zeros(3), abs=0.02**2 / 8.0 / radius)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_lies_inside_of_the_circle_is_counted_positive(side: float) -> None:
    """Points on a circle of 9 m about (0.3, ±8.995), and one 2 mm nearer to its centre."""
    line = carved()
    centre = (0.3, side * math.sqrt(81.0 - 0.09))
    drawn = EdgeLine.__new__(EdgeLine)
    drawn.__dict__.update(line.__dict__)
    drawn.at = lambda station: centre[1] - side * np.sqrt(81.0 - (np.atleast_1d(station) - centre[0]) ** 2)  # type: ignore[method-assign]
    drawn.position = drawn.at(line.station)
    away = np.array([centre[0] - line.station[9], centre[1] - drawn.position[9]])
    drawn.station, drawn.position = line.station.copy(), drawn.position.copy()
    drawn.station[9] += 2e-3 * away[0] / 9.0
    drawn.position[9] += 2e-3 * away[1] / 9.0
    assert drawn.radius_at_boot() == pytest.approx(side * 9.0, rel=1e-9)
    expected = np.zeros(len(line.station))
    expected[9] = side * 2e-3
    assert drawn.offset_from_circle() == pytest.approx(expected, abs=1e-9)


def test_between_stations_the_edge_is_that_of_the_stations() -> None:
    """Of a ski that is wider and higher at its tip than at its tail: W/2 cos(ϑ + φ) + (h + w) sin ϑ."""
    angle = 0.6
    ski = plain_ski(width=lambda s: 0.065 + 0.02 * s**2 * (1.0 + s), base_height=lambda s: 0.01 * s**2 * (1.0 + s))
    model = clamped(ski, 0.3, 20)
    line = EdgeLine(model, angle, solved(model, _conditions(ski, snow(0.2), angle, 300.0, 5.0, 1.0)))
    assert line.at(line.station) == pytest.approx(line.position, abs=1e-12)
    at = ski.at(line.station)
    across = at.width / 2.0 * np.cos(angle + line.bend[1]) + (at.base_height + line.bend[0]) * math.sin(angle)
    assert line.position == pytest.approx(across, abs=1e-12)


def test_a_circle_is_looked_for_on_the_ski_alone() -> None:
    """Up to the very tip and tail, 0.8 m from the boot, which must be between."""
    line = carved()
    assert line.radius_over(0.8, -0.8) is not None
    for front, rear in ((0.801, -0.8), (0.8, -0.801), (0.0, -0.8), (0.8, 0.0)):
        assert line.radius_over(front, rear) is None


def test_the_contact_ends_where_the_depth_passes_zero_or_the_ski_ends() -> None:
    line = carved()
    s = line.station
    assert line.contact_ends(0.3 - s) == pytest.approx((0.3, -0.8), abs=1e-12)
    assert line.contact_ends(s + 0.25) == pytest.approx((0.8, -0.25), abs=1e-12)
    # two pieces: the outermost ends
    assert line.contact_ends(np.minimum(np.abs(s) - 0.1, 0.6 - np.abs(s))) == pytest.approx((0.6, -0.6), abs=1e-12)
    assert line.contact_ends(np.ones(len(s))) == (0.8, -0.8)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_greatest_slope_is_that_of_the_running_length(direction: float) -> None:
    """0.2 on it; what bends more beyond does not count."""
    ski = plain_ski(running_length=1.2)
    model = clamped(ski, 0.3, 40)
    line = EdgeLine(model, 0.0, solved(model, _conditions(ski, snow(0.2), 0.0, 400.0, 0.0, 1.0, twist=False)))
    line.bend = direction * 0.2 * line.station, line.bend[1]
    assert line.greatest_slope() == pytest.approx(0.2, rel=1e-9)
    front, rear = ski.contact_points
    assert (front, rear) == pytest.approx((0.6, -0.6))
    line.bend = np.where(np.abs(line.station) > 0.6, 3.0, direction * 0.2) * line.station, line.bend[1]
    assert line.greatest_slope() == pytest.approx(0.2, rel=1e-9)


EI, WIDTH, LOAD = 300.0, 0.065, 800.0


def deviation(hardness: float, elements: int) -> tuple[float, float]:
    """Relative deviation of the depth under the load and of the contact length from the one-sided answer."""
    ski = plain_ski(bending=EI, width=WIDTH)
    found = rest(ski, snow(hardness), edge_angle=0.0, load=LOAD, clamp_length=0.0, elements=elements)
    foundation = hardness * 1e9 * WIDTH
    rate = (foundation / (4.0 * EI)) ** 0.25
    depth = boot_pose(found, ski, 0.0)[0]
    expected = LOAD * rate / (2.0 * foundation) / math.tanh(math.pi / 2.0)
    return depth / expected - 1.0, present(found.contact_length) / (math.pi / rate) - 1.0


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
    assert np.all(present(found.edge_depth) > 0.0)


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
    assert present(found.edge_depth)[inside] == pytest.approx(expected[inside], abs=2e-4 * float(expected.max()))
    beyond = x > 1.02 * math.pi / 2.0
    assert np.ptp(np.diff(present(found.edge_depth)[beyond & (found.station > 0)][::2])) < 1e-9
