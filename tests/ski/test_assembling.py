from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.ski import BaseShape, Ski, arc_ski, layout_of_lengths


def slalom(*, boot_position: float = 0.0, base: BaseShape | None = None, stations: list[float] | None = None) -> Ski:
    return arc_ski(
        layout_of_lengths(length=1.593, running_length=1.396, sidecut_length=1.458, boot_position=boot_position),
        name="slalom",
        source="test",
        tip_width=0.116,
        waist_width=0.068,
        tail_width=0.101,
        mass=2.231,
        bending_stiffness=[100, 250, 440, 260, 100],
        torsional_stiffness=[60, 140, 175, 140, 60],
        stiffness_station=stations,
        base=base,
    )


def test_stiffness_is_spread_over_the_running_length_tip_first() -> None:
    ski = slalom()
    at = ski.at([0.698, 0.349, 0.0, -0.349, -0.698])
    # the quarter points are no stations of the grid: linear interpolation over 2.5 mm of a curve of 2 kN
    assert at.bending_stiffness == pytest.approx([100, 250, 440, 260, 100], abs=0.01)
    assert at.torsional_stiffness == pytest.approx([60, 140, 175, 140, 60], abs=0.01)


def test_end_stiffness_is_held_out_to_tip_and_tail() -> None:
    ski = slalom()
    assert ski.bending_stiffness[ski.station > 0.698] == pytest.approx(100.0, rel=1e-12)
    assert ski.torsional_stiffness[ski.station < -0.698] == pytest.approx(60.0, rel=1e-12)


def test_stiffness_at_stations_of_its_own() -> None:
    ski = slalom(stations=[0.6, 0.3, 0.1, -0.3, -0.5])
    assert ski.at([0.7, 0.3, 0.1]).bending_stiffness == pytest.approx([100, 250, 440], abs=0.01)


def test_mass_goes_with_the_width() -> None:
    ski = slalom()
    assert ski.mass == pytest.approx(2.231, rel=1e-12)
    assert np.ptp(ski.mass_per_length / ski.width) < 1e-12


def test_stations_are_dense_and_meet_every_point_that_matters() -> None:
    ski = slalom(boot_position=0.0213)
    steps = -np.diff(ski.station)
    assert steps.max() <= 2.5e-3 + 1e-12
    for place in (ski.station[0], *ski.sidecut_ends, *ski.contact_points, ski.sidecut_middle, 0.0):
        assert np.min(np.abs(ski.station - place)) < 1e-9


def test_boot_position_is_the_only_thing_that_moves() -> None:
    ahead, middle = slalom(boot_position=0.05), slalom()
    assert ahead.sidecut_middle == -0.05
    assert ahead.sidecut_widths == pytest.approx(middle.sidecut_widths, abs=1e-12)
    assert ahead.at(-0.05 + 0.3).width == pytest.approx(float(middle.at(0.3).width), abs=1e-7)
    assert ahead.at(-0.05 + 0.3).bending_stiffness == pytest.approx(float(middle.at(0.3).bending_stiffness), abs=0.01)


def test_camber_of_the_ski() -> None:
    ski = slalom(boot_position=-0.03, base=BaseShape(camber=0.007))
    heights = ski.at([ski.sidecut_middle, *ski.contact_points]).base_height
    assert heights[0] - heights[1:] == pytest.approx([0.007, 0.007], abs=1e-12)
    assert float(ski.at(0.0).base_height) == 0.0


def test_parts_that_do_not_fit() -> None:
    with raises(ParameterError, "wrong_shape", size=5, size_2=4):
        slalom(stations=[0.6, 0.3, 0.1, -0.3])


@settings(max_examples=40, deadline=None)
@given(
    waist=st.floats(0.05, 0.12),
    tip=st.floats(0.0, 0.06),
    tail=st.floats(0.0, 0.06),
    sidecut=st.floats(0.8, 1.7),
    running=st.floats(0.6, 0.97),
    boot=st.floats(-0.15, 0.15),
    stiffness=st.lists(st.floats(10.0, 2000.0), min_size=1, max_size=8),
)
def test_any_sensible_ski_is_a_ski(
    waist: float, tip: float, tail: float, sidecut: float, running: float, boot: float, stiffness: list[float]
) -> None:
    ski = arc_ski(
        layout_of_lengths(
            length=sidecut + 0.14, running_length=running * sidecut, sidecut_length=sidecut, boot_position=boot
        ),
        name="any",
        source="test",
        tip_width=waist + tip,
        waist_width=waist,
        tail_width=waist + tail,
        mass=2.0,
        bending_stiffness=stiffness,
        torsional_stiffness=stiffness,
        base=BaseShape(camber=0.005),
    )
    assert ski.sidecut_depth == pytest.approx((tip + tail) / 4.0, abs=1e-12)
    assert ski.mass == pytest.approx(2.0, rel=1e-12)
    assert (ski.tip_width, ski.tail_width) == pytest.approx((waist + tip, waist + tail), abs=1e-12)
    low, high = min(stiffness), max(stiffness)
    assert low * (1 - 1e-9) <= ski.bending_stiffness.min() <= ski.bending_stiffness.max() <= high * (1 + 1e-9)
    if tip + tail > 0.004:
        three, circle = ski.sidecut_radius_of_three_widths, ski.sidecut_radius_of_edge_line
        # parabola and circle part by the square of the edge's steepest slope, (4 δ + taper/2)/L
        slope = (tip + tail + abs(tip - tail) / 2.0) / sidecut
        assert math.isclose(three, circle, rel_tol=1.5 * slope**2 + 1e-4)
