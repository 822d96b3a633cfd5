"""The local projection against published numbers and the textbook's lengths of a degree."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.track.projection import (
    GeodeticPoint,
    earth_centred,
    east_north_up,
    geodetic,
    place_from_origin,
    rotate_to_origin,
)
from skisnow.track.slope_frame import in_slope_frame, slope_axes
from skisnow.track.track import Track
from tests.coded import raises
from tests.present import present

from . import metres_per_degree


def degrees(whole: int, minutes: int, seconds: float) -> float:
    return whole + minutes / 60 + seconds / 3600


def test_places_from_another_origin_are_those_of_the_points() -> None:
    points = np.array([[46.9, 11.2, 2100.0], [47.01, 11.15, 1500.0], [47.0, 11.0, np.nan]])
    first, last = GeodeticPoint(47.0, 11.0, height=1800.0), GeodeticPoint(46.95, 11.1, height=700.0)
    moved = place_from_origin(east_north_up(points, origin=first), first, last)
    points[2, 2] = 1800.0  # a place without height is in the first origin's plane
    expected = east_north_up(points, origin=last)
    np.testing.assert_allclose(moved[:2], expected[:2], atol=1e-6)
    np.testing.assert_allclose(moved[2, :2], expected[2, :2], atol=1e-6)
    assert np.isnan(moved[2, 2])


def test_matterhorn_from_zermatt() -> None:
    """The example of MATLAB's geodetic2enu, printed to 0.1 m: -7134.8, -4556.3, 2852.4."""
    zermatt = GeodeticPoint(46.017, 7.750, height=1673.0)
    place = east_north_up(np.array([[45.976, 7.658, 4531.0]]), origin=zermatt)
    np.testing.assert_allclose(place, [[-7134.8, -4556.3, 2852.4]], atol=0.05)


def test_flinders_peak_to_buninyong() -> None:
    """The worked example of Vincenty's formulae in the GDA94 technical manual: 54,972.271 m at 306°52'05.37".

    Its ellipsoid GRS80 differs from WGS84 by 0.1 mm. The chord of an arc s is s (1 - s²/24R²); R off by 0.4 % moves it
    by 1.5 mm. A geodesic and the plane through the normal differ by less than 0.1" on 55 km.
    """
    flinders = GeodeticPoint(-degrees(37, 57, 3.72030), degrees(144, 25, 29.52440))
    buninyong = np.array([[-degrees(37, 39, 10.15610), degrees(143, 55, 35.38390), 0.0]])
    east, north, up = east_north_up(buninyong, origin=flinders)[0]
    arc = 54972.271
    assert math.sqrt(east**2 + north**2 + up**2) == pytest.approx(arc * (1 - (arc / 6.371e6) ** 2 / 24), abs=2e-3)
    assert math.degrees(math.atan2(east, north)) % 360 == pytest.approx(degrees(306, 52, 5.37), abs=0.1 / 3600)
    assert up == pytest.approx(-(arc**2) / (2 * 6.38e6), rel=5e-3)


@pytest.mark.parametrize("latitude", [-70.0, -33.0, 0.0, 46.0, 68.0])
def test_a_short_way_is_as_long_as_its_degrees(latitude: float) -> None:
    """A thousandth of a degree each way; at 0.1 km the plane and the ellipsoid differ by less than 1 mm."""
    origin = GeodeticPoint(latitude, 11.0)
    step = 1e-3
    points = np.array([[latitude + step, 11.0, 0.0], [latitude, 11.0 + step, 0.0], [latitude, 11.0, 7.0]])
    place = east_north_up(points, origin=origin)
    np.testing.assert_allclose(place[0, :2], [0.0, step * metres_per_degree.north(latitude)], atol=1e-3)
    assert place[1, 0] == pytest.approx(step * metres_per_degree.east(latitude), abs=1e-3)
    np.testing.assert_allclose(place[2], [0.0, 0.0, 7.0], atol=1e-8)


def test_back_from_earth_centred() -> None:
    latitude, longitude, height = np.meshgrid(
        [-90.0, -45.0, 0.0, 1e-7, 30.0, 89.999], [-180.0, -60.0, 0.0, 120.0], [-400.0, 0.0, 9000.0], indexing="ij"
    )
    back = geodetic(earth_centred(latitude, longitude, height))
    np.testing.assert_allclose(back[..., 0], latitude, atol=1e-13 * 180)
    np.testing.assert_allclose(back[..., 2], height, atol=1e-8)
    off_pole = np.abs(latitude) < 90.0
    np.testing.assert_allclose(np.cos(np.radians((back[..., 1] - longitude)[off_pole])), 1.0, atol=1e-14)


def test_missing_height_spoils_the_height_alone() -> None:
    origin = GeodeticPoint(47.0, 11.0, height=2000.0)
    known = east_north_up(np.array([[47.001, 11.001, 2000.0]]), origin=origin)
    unknown = east_north_up(np.array([[47.001, 11.001, np.nan]]), origin=origin)
    np.testing.assert_array_equal(known[:, :2], unknown[:, :2])
    assert np.isnan(unknown[0, 2])


def test_north_far_to_the_east_is_not_quite_north_here() -> None:
    """Meridians converge by Δλ sin φ: 1° of longitude at 30° north turns north by 0.5°."""
    origin = GeodeticPoint(30.0, 10.0)
    turned = rotate_to_origin(np.array([[0.0, 1.0, 0.0]]), np.array([[30.0, 11.0, 0.0]]), origin=origin)
    assert math.degrees(math.atan2(-turned[0, 0], turned[0, 1])) == pytest.approx(0.5, abs=1e-3)
    course = rotate_to_origin(np.array([[0.0, 1.0, np.nan]]), np.array([[30.0, 11.0, 0.0]]), origin=origin)
    np.testing.assert_array_equal(course[:, :2], turned[:, :2])
    assert np.isnan(course[0, 2])


@pytest.mark.parametrize(("latitude", "longitude"), [(400.0, 0.0), (0.0, 200.0), (math.nan, 0.0)])
def test_origins_are_on_earth(latitude: float, longitude: float) -> None:
    with pytest.raises(ParameterError, match="must be from"):
        GeodeticPoint(latitude, longitude)


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


def test_profile_keeps_height_and_horizontal_distance_and_origin_is_where_x_begins() -> None:
    turned = in_slope_frame(track([[3.0, 4.0, -2.0]]), fall_line_azimuth=0.0, slope_angle=None)
    np.testing.assert_allclose(turned.place, [[4.0, -3.0, -2.0]], atol=1e-15)
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
    np.testing.assert_allclose(present(turned.velocity), [[1.0, 0.0, 0.0]], atol=1e-15)
    along = math.hypot(0.02 * math.cos(ANGLE), 0.05 * math.sin(ANGLE))
    np.testing.assert_allclose(present(turned.place_sd)[0, :2], [along, 0.01], rtol=1e-12)
    assert (present(turned.place_sd) ** 2).sum() == pytest.approx(0.01**2 + 0.02**2 + 0.05**2)


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
