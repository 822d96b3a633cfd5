"""Circles through the edge line and ends of the contact, in closed form."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.carving.edge_line import EdgeLine, circle_radius
from skisnow.carving.outputs import output_growth
from skisnow.carving.solve import Solution
from skisnow.ski.beam import clamped

from .synthetic import circular_sidecut, plain_ski


def edge_line(radius: float, angle: float = 0.0, **ski: Any) -> EdgeLine:
    """A ski that is not bent, with edges on circles about the middle."""
    model = clamped(plain_ski(width=circular_sidecut(radius), **ski), 0.3, 32)
    nothing = np.zeros(len(model.stations.station))
    return EdgeLine(model, angle, Solution(True, 0, np.zeros(model.size), 0.0, 0.0, 0.0, nothing, nothing))


def length_of_contact(depth: FloatArray, station: FloatArray) -> Any:
    at: Any = SimpleNamespace(
        solution=SimpleNamespace(edge_depth=depth),
        model=SimpleNamespace(stations=SimpleNamespace(station=station)),
    )
    return output_growth("contact_length_m", at)


@pytest.mark.parametrize(("depths", "front"), [([-1.0, 3.0, 1.0, -1.0], 0.5), ([0.0, 3.0, 1.0, -1.0], 0.6)])
def test_contact_ends_where_the_depth_passes_zero(depths: list[float], front: float) -> None:
    """Stations 0.6, 0.2, -0.2 and -0.6 m: between the last two the depth passes 0 at -0.4 m."""
    line, depth, station = edge_line(12.0), np.array(depths), np.array([0.6, 0.2, -0.2, -0.6])
    line.station = station
    assert line.contact_ends(depth) == pytest.approx((front, -0.4))
    growth = length_of_contact(depth, station)
    assert growth.value == pytest.approx(front + 0.4)
    for derivatives, (by_depth, by_station) in ((growth.depth, (1e-6, 0.0)), (growth.place, (0.0, 1e-6))):
        steps = [
            length_of_contact(depth + by_depth * one, station + by_station * one).value
            - length_of_contact(depth - by_depth * one, station - by_station * one).value
            for one in np.eye(4)[1:]  # the first depth may be 0
        ]
        assert derivatives[1:] == pytest.approx(np.array(steps) / 2e-6, abs=1e-8)


@pytest.mark.parametrize(
    ("depths", "ends"),
    [
        ([1.0, 3.0, 1.0, -1.0], (0.8, -0.4)),
        ([-1.0, 3.0, 1.0, 1.0], (0.5, -0.8)),
        ([1.0, 3.0, 1.0, 1.0], (0.8, -0.8)),
    ],
)
def test_contact_up_to_an_end_of_the_ski(depths: list[float], ends: tuple[float, float]) -> None:
    line, station = edge_line(12.0), np.array([0.6, 0.2, -0.2, -0.6])
    line.station = station
    assert line.contact_ends(np.array(depths)) == pytest.approx(ends)
    assert length_of_contact(np.array(depths), station) is None


def test_circles_of_a_circular_edge_have_its_radius() -> None:
    line = edge_line(12.0)
    for front, rear in ((0.4, -0.4), (0.8, -0.8), (0.1, -0.6)):
        assert line.radius_over(front, rear) == pytest.approx(12.0, rel=1e-4)
    assert line.radius_at_boot() == line.radius_over(0.4, -0.4)
    assert line.radius_median(0.6, -0.5) == pytest.approx(12.0, rel=1e-3)
    for front, rear in ((0.81, -0.4), (0.4, -0.81), (0.0, -0.4), (0.4, 0.0)):
        assert line.radius_over(front, rear) is None
    assert line.radius_median(0.1, -0.1) is None
    assert np.abs(line.offset_from_circle()).max() < 1e-6


def test_edge_beside_the_circle_of_the_boot() -> None:
    """A bump of 1 mm at 0.2 m towards the inside is 1 mm off the circle."""
    line = edge_line(12.0)
    bump = 1e-3 * np.exp(-(((line.station - 0.2) / 0.05) ** 2))
    line.position = line.position + bump
    assert line.offset_from_circle() == pytest.approx(bump, abs=2e-6)
    straight = edge_line(1e12)
    assert straight.radius_at_boot() is None
    with pytest.raises(ValueError, match="straight"):
        straight.offset_from_circle()


def test_greatest_slope_is_that_between_the_contact_points() -> None:
    line = edge_line(12.0, running_length=1.0)
    inside = np.abs(line.station) <= 0.5
    line.bend = (np.where(inside, -0.02 * line.station, 3.0 * line.station), 0.0 * line.station)
    assert line.greatest_slope() == pytest.approx(0.02)


def test_circle_through_three_points() -> None:
    assert circle_radius((3.0, -1.0), (0.0, 0.0), (-3.0, -1.0)) == pytest.approx(-5.0)
    assert circle_radius((4.0, 0.0), (0.0, 0.0), (0.0, 3.0)) == pytest.approx(2.5)
    assert circle_radius((1.0, 2e-9), (0.0, 0.0), (-1.0, 2e-9)) is not None
    assert circle_radius((1.0, 0.4e-9), (0.0, 0.0), (-1.0, 0.4e-9)) is None
