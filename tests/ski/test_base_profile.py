from __future__ import annotations

import numpy as np
import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.ski.layout import BaseShape, layout_of_lengths

LAYOUT = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458)
FRONT, REAR = LAYOUT.contact_points


def heights(shape: BaseShape, *stations: float) -> list[float]:
    return [float(h) for h in shape.height_at(np.array(stations), LAYOUT)]


def test_camber_shovel_and_tail_heights() -> None:
    shape = BaseShape(camber=0.007, shovel_height=0.060, tail_height=0.010)
    boot, front, rear, tip, tail = heights(shape, 0.0, FRONT, REAR, LAYOUT.tip, LAYOUT.tail)
    assert boot == 0.0
    assert (front, rear) == pytest.approx((-0.007, -0.007), abs=1e-15)
    assert (tip - front, tail - rear) == pytest.approx((0.060, 0.010), abs=1e-15)


def test_camber_half_way_to_the_contact_point() -> None:
    """Of one curvature k = 2 c/(0.598 · 0.698) up to 0.1 m before the contact point, so k 0.349²/2 down."""
    assert heights(BaseShape(camber=0.016), FRONT / 2.0) == pytest.approx(
        [-0.016 * 0.349**2 / (0.598 * 0.698)], abs=1e-15
    )


def test_heights_left_out_are_the_stated_defaults() -> None:
    tip, tail = heights(BaseShape(), LAYOUT.tip, LAYOUT.tail)
    assert (tip, tail) == pytest.approx((0.050, 0.008), abs=1e-15)


def test_base_has_no_kink_also_with_rocker() -> None:
    shape = BaseShape(
        camber=0.005,
        tip_rocker_length=0.25,
        tip_rocker_height=0.008,
        tail_rocker_length=0.1,
        tail_rocker_height=0.002,
    )
    station = np.linspace(LAYOUT.tip, LAYOUT.tail, 100001)
    slope = np.diff(shape.height_at(station, LAYOUT)) / np.diff(station)
    # the largest curvature is that of the shovel, below 10 per metre: in steps of 0.016 mm the slope changes by 2e-4
    assert np.max(np.abs(np.diff(slope))) < 2e-4


def test_rocker_draws_the_contact_points_in() -> None:
    shape = BaseShape(camber=0.004, tip_rocker_length=0.2, tip_rocker_height=0.010)
    lowest, end = heights(shape, FRONT - 0.2, FRONT)
    assert end - lowest == pytest.approx(0.010, abs=1e-15)
    middle = (FRONT - 0.2 + REAR) / 2.0
    assert heights(shape, middle)[0] - lowest == pytest.approx(0.004, abs=1e-15)


def test_boot_away_from_the_middle_is_still_at_zero() -> None:
    layout = layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=-0.1)
    shape = BaseShape(camber=0.007)
    at_boot, at_middle = shape.height_at(np.array([0.0, layout.middle]), layout)
    assert at_boot == 0.0
    assert at_middle == pytest.approx(0.007 * 0.1**2 / (0.598 * 0.698), abs=1e-15)


@pytest.mark.parametrize(
    ("shape", "named"),
    [
        (BaseShape(tip_rocker_length=0.9, tail_rocker_length=0.6), coded("contradiction", running_length=1396.0)),
        (BaseShape(tip_rocker_length=0.9, tail_rocker_length=0.4959), coded("contradiction", running_length=1396.0)),
        (BaseShape(tip_rocker_height=0.01), coded("contradiction", name="shovel", rocker_height=10.0)),
        (BaseShape(tip_rocker_length=0.1, tip_rocker_height=0.03, shovel_height=0.05), "contradiction"),
    ],
)
def test_impossible_bases_are_refused(shape: BaseShape, named: str | Coded) -> None:
    with raises(ParameterError, named):
        shape.height_at(np.zeros(1), LAYOUT)


def test_shovel_height_without_a_shovel_is_refused() -> None:
    piece = layout_of_lengths(length=0.2, running_length=0.2, sidecut_length=0.2, tail_overhang=0.0)
    assert np.all(BaseShape().height_at(np.linspace(0.1, -0.1, 5), piece) == 0.0)
    with raises(ParameterError, "contradiction", name="shovel", given_height=50.0):
        BaseShape(shovel_height=0.05).height_at(np.zeros(1), piece)


@pytest.mark.parametrize("rounding", [0.05, 0.2])
def test_the_arch_levels_out_over_the_rounding(rounding: float) -> None:
    """Of one curvature as far as the rounding leaves it; there it has this slope, which falls evenly to 0."""
    shape = BaseShape(camber=0.016, camber_rounding=rounding)
    plain, half = 0.698 - rounding, 0.698
    curvature = 2.0 * 0.016 / (plain * half)
    at_middle, at_start, between, at_end = heights(shape, 0.0, plain, plain + rounding / 2.0, half)
    assert at_start - at_middle == pytest.approx(-curvature * plain**2 / 2.0, abs=1e-15)
    assert at_end == pytest.approx(-0.016, abs=1e-15)
    # of the drop over the rounding three quarters are in its first half
    assert (between - at_start) / (at_end - at_start) == pytest.approx(0.75, rel=1e-12)


def test_the_rounding_takes_at_most_a_quarter_of_the_length_in_contact() -> None:
    long, longest = (BaseShape(camber=0.016, camber_rounding=each) for each in (0.5, 0.349))
    assert heights(long, 0.3, 0.5) == heights(longest, 0.3, 0.5)
