"""Turning a track into a slope's frame, against slopes whose answer is seen without algebra."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.track.slope_frame import in_slope_frame, slope_axes
from skisnow.track.track import Track
from tests.coded import raises

ANGLE = math.radians(20.0)


def track(place: list[list[float]]) -> Track:
    n = len(place)
    return Track(
        "a run", np.arange(float(n)), np.array(place), np.full(n, 7.0), "UTC", "east, north, up", axes="east_north_up"
    )


def test_straight_down_a_slope_that_falls_to_the_east() -> None:
    """10 m along the surface are 10 cos 20° east and 10 sin 20° down."""
    down = track([[0.0, 0.0, 0.0], [10.0 * math.cos(ANGLE), 0.0, -10.0 * math.sin(ANGLE)]])
    turned = in_slope_frame(down, fall_line_azimuth=math.pi / 2, slope_angle=ANGLE)
    np.testing.assert_allclose(turned.place, [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]], atol=1e-14)
    assert turned.axes == "slope"
    np.testing.assert_array_equal(turned.speed, down.speed)


@pytest.mark.parametrize(
    ("azimuth_deg", "ahead", "left"),
    [(0.0, [0, 1], [-1, 0]), (90.0, [1, 0], [0, 1]), (180.0, [0, -1], [1, 0]), (270.0, [-1, 0], [0, -1])],
)
def test_ahead_and_left(azimuth_deg: float, ahead: list[float], left: list[float]) -> None:
    """Facing north, left is west; facing east, north; and so on round the compass."""
    axes = slope_axes(math.radians(azimuth_deg), 0.0)
    np.testing.assert_allclose(axes[0], [*ahead, 0.0], atol=1e-15)
    np.testing.assert_allclose(axes[1], [*left, 0.0], atol=1e-15)


def test_out_of_the_snow_leans_down_the_fall_line() -> None:
    axes = slope_axes(0.0, ANGLE)
    np.testing.assert_allclose(axes[2], [0.0, math.sin(ANGLE), math.cos(ANGLE)], atol=1e-15)
    np.testing.assert_allclose(np.cross(axes[0], axes[1]), axes[2], atol=1e-15)


def test_profile_keeps_height_and_horizontal_distance() -> None:
    turned = in_slope_frame(track([[3.0, 4.0, -2.0]]), fall_line_azimuth=0.0, slope_angle=None)
    np.testing.assert_allclose(turned.place, [[4.0, -3.0, -2.0]], atol=1e-15)


def test_origin_is_where_x_begins() -> None:
    turned = in_slope_frame(
        track([[13.0, 4.0, -2.0]]), fall_line_azimuth=math.pi / 2, slope_angle=None, origin=(10.0, 5.0, 1.0)
    )
    np.testing.assert_allclose(turned.place, [[3.0, -1.0, -3.0]], atol=1e-15)
    assert "(10, 5, 1) m" in turned.frame


def test_without_height_on_the_slope() -> None:
    """On the surface: x = horizontal distance / cos, z = 0; y does not care."""
    flat = track([[2.0, 9.0, math.nan]])
    known = in_slope_frame(flat, fall_line_azimuth=0.0, slope_angle=ANGLE, missing_height="on_slope")
    np.testing.assert_allclose(known.place, [[9.0 / math.cos(ANGLE), -2.0, 0.0]], atol=1e-14)
    unknown = in_slope_frame(flat, fall_line_azimuth=0.0, slope_angle=ANGLE)
    assert np.isnan(unknown.place[0]).tolist() == [True, False, True]
    assert unknown.place[0, 1] == pytest.approx(-2.0)


def test_velocity_and_deviations_turn_too() -> None:
    given = replace(
        track([[0.0, 0.0, 0.0]]),
        velocity=np.array([[0.0, math.cos(ANGLE), -math.sin(ANGLE)]]),
        place_sd=np.array([[0.01, 0.02, 0.05]]),
    )
    turned = in_slope_frame(given, fall_line_azimuth=0.0, slope_angle=ANGLE)
    assert turned.velocity is not None
    assert turned.place_sd is not None
    np.testing.assert_allclose(turned.velocity, [[1.0, 0.0, 0.0]], atol=1e-15)
    along = math.hypot(0.02 * math.cos(ANGLE), 0.05 * math.sin(ANGLE))
    np.testing.assert_allclose(turned.place_sd[0, :2], [along, 0.01], rtol=1e-12)
    assert (turned.place_sd**2).sum() == pytest.approx(0.01**2 + 0.02**2 + 0.05**2)


def test_refused() -> None:
    turned = in_slope_frame(track([[0.0, 0.0, 0.0]]), fall_line_azimuth=0.0, slope_angle=ANGLE)
    with raises(ParameterError, "already_on_slope"):
        in_slope_frame(turned, fall_line_azimuth=0.0, slope_angle=ANGLE)
    with raises(ParameterError, "out_of_range"):
        in_slope_frame(track([[0.0] * 3]), fall_line_azimuth=90.0, slope_angle=ANGLE)
    with raises(ParameterError, "out_of_range", slope_angle=20.0):
        in_slope_frame(track([[0.0] * 3]), fall_line_azimuth=0.0, slope_angle=20.0)
    with raises(ParameterError, "not_a_number"):
        in_slope_frame(track([[0.0] * 3]), fall_line_azimuth=0.0, slope_angle=ANGLE, origin=(0.0, math.nan, 0.0))


@pytest.mark.parametrize(("azimuth_deg", "slope_deg"), [(30.0, 20.0), (200.0, 35.0), (333.0, 5.0)])
def test_axes_of_a_slope_that_falls_between_the_compass_points(azimuth_deg: float, slope_deg: float) -> None:
    """x by its compass direction and its fall; y level; z square to both: sin α ahead on the level, cos α up."""
    azimuth, slope = math.radians(azimuth_deg), math.radians(slope_deg)
    x, y, z = axes = slope_axes(azimuth, slope)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert math.atan2(x[0], x[1]) % math.tau == pytest.approx(azimuth)
    assert math.asin(-x[2]) == pytest.approx(slope)
    assert (y[2], z[2]) == pytest.approx((0.0, math.cos(slope)))
    np.testing.assert_allclose(z[:2], math.sin(slope) * np.array([math.sin(azimuth), math.cos(azimuth)]), atol=1e-15)
    np.testing.assert_allclose(np.cross(x, y), z, atol=1e-15)
