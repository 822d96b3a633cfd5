"""Ends of the contact, slope and circle of an edge line, on lines that were drawn by hand."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from skisnow.carving.edge_line import BOOT_REACH, EdgeLine
from skisnow.carving.equilibrium import _conditions
from skisnow.carving.solve import solved
from skisnow.ski.beam import clamped

from .synthetic import circular_sidecut, plain_ski, snow


@cache
def carved() -> EdgeLine:
    """At 45 degrees."""
    ski, angle = plain_ski(width=circular_sidecut(13.0)), math.radians(45.0)
    conditions = _conditions(ski, snow(2.0), angle, 300.0, 5.0, 1.0, True, True)
    model = clamped(ski, 0.3, 40)
    return EdgeLine(model, angle, solved(model, conditions))


def test_the_circle_meets_the_edge_at_the_boot_and_before_and_behind_it() -> None:
    line = carved()
    radius = line.radius_at_boot()
    assert radius is not None
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
    line = EdgeLine(model, angle, solved(model, _conditions(ski, snow(0.2), angle, 300.0, 5.0, 1.0, True, True)))
    assert line.at(line.station) == pytest.approx(line.position, abs=1e-12)
    at = ski.at(line.station)
    across = at.width / 2.0 * np.cos(angle + line.twist) + (at.base_height + line.deflection) * math.sin(angle)
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
    line = EdgeLine(model, 0.0, solved(model, _conditions(ski, snow(0.2), 0.0, 400.0, 0.0, 1.0, False, False)))
    line.deflection = direction * 0.2 * line.station
    assert line.greatest_slope() == pytest.approx(0.2, rel=1e-9)
    front, rear = ski.contact_points
    assert (front, rear) == pytest.approx((0.6, -0.6))
    line.deflection = np.where(np.abs(line.station) > 0.6, 3.0, direction * 0.2) * line.station
    assert line.greatest_slope() == pytest.approx(0.2, rel=1e-9)
