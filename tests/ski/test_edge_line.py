from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.ski.outline import radius_of_least_squares_circle

FloatArray = npt.NDArray[np.float64]


@pytest.mark.parametrize("radius", [8.0, 13.0, 100.0, 1000.0])
def test_points_of_a_circle_return_its_radius(radius: float) -> None:
    x = np.linspace(-0.7, 0.9, 301)  # not symmetric about the arc's lowest point
    y = radius - np.sqrt(radius**2 - (x - 0.1) ** 2)
    # a sagitta of 0.3 mm is known to 1e-16 m: 11 digits are left at the largest radius
    assert radius_of_least_squares_circle(x, y) == pytest.approx(radius, rel=1e-9)


def test_radius_does_not_change_when_the_edge_is_turned_moved_or_mirrored() -> None:
    turn = np.linspace(-0.06, 0.05, 101)
    x, y = 13.0 * np.sin(turn), 13.0 * (1.0 - np.cos(turn))
    c, s = math.cos(0.3), math.sin(0.3)
    assert radius_of_least_squares_circle(c * x - s * y + 2.0, -(s * x + c * y) - 1.0) == pytest.approx(13.0, rel=1e-9)


def test_a_straight_edge_has_no_radius() -> None:
    x = np.linspace(-0.7, 0.7, 101)
    assert radius_of_least_squares_circle(x, 0.03 + 0.01 * x) == math.inf


def test_least_squares_where_points_scatter() -> None:
    """Against the minimum of the summed squared distances, searched for directly."""
    from scipy.optimize import least_squares

    x = np.linspace(-0.7, 0.7, 201)
    y = x**2 / 26.0 + 1e-4 * np.sin(40.0 * x + 0.4)

    def distances(circle: FloatArray) -> FloatArray:
        return np.hypot(x - circle[0], y - circle[1]) - circle[2]

    direct = least_squares(distances, [0.0, 13.0, 13.0], xtol=1e-15, ftol=1e-15, gtol=1e-15)
    # scatter over radius is 1e-5, which is what the two definitions may differ by
    assert radius_of_least_squares_circle(x, y) == pytest.approx(direct.x[2], rel=1e-5)
