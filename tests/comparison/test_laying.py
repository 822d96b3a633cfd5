"""Tracks in a slope's axes laid on a map, and fits that need it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.comparison import Comparison, compare_tracks
from skisnow.track.slope_frame import in_slope_frame, inclination, lay_on_slope
from skisnow.track.track import Track

from .made_tracks import FloatArray, build_track

ALONG = np.linspace(0.0, 50.0, 251)


def run_of(side: float) -> Track:
    """A turn whose radius falls from 20 to 8 m, down the slope, to the left (1) or right (-1)."""
    angle = -0.6 + 0.05 * ALONG + 0.0004 * ALONG**2
    steps = 0.2 * np.column_stack([np.cos(angle), side * np.sin(angle)])
    place = np.cumsum(steps, axis=0)
    return replace(build_track(np.column_stack([place, np.full(len(ALONG), 0.01)]), ALONG / 8.0), axes="slope")


def on_map(run: Track, azimuth: float, slope: float, noise: float = 0.0) -> Track:
    """The same run in east, north and up (azimuth and slope in degrees), by the axes of the slope in space."""
    rise, fall = math.sin(math.radians(slope)), math.cos(math.radians(slope))
    east, north = math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))
    axes = np.array([[fall * east, fall * north, -rise], [-north, east, 0.0], [rise * east, rise * north, fall]])
    place = run.place @ axes + noise * np.random.default_rng(3).normal(size=run.place.shape)
    return replace(run, name="measured", place=place, axes="east_north_up")


def fitted(run: Track, measured: Track, slope: float | None = None) -> Comparison:
    angle = None if slope is None else math.radians(slope)
    return compare_tracks(run, measured, fit=("start", "heading"), slope_angle=angle)


def azimuth_of(found: Comparison) -> float:
    assert found.fitted is not None
    assert found.fitted.azimuth is not None
    return math.degrees(found.fitted.azimuth)


def test_a_laid_track_is_that_of_the_slopes_axes() -> None:
    """x to the north and y to the west, on a map whose axes are east and north."""
    run = run_of(1.0)
    laid = lay_on_slope(run, math.radians(20.0))
    place: FloatArray = on_map(run, 0.0, 20.0).place
    assert laid.place == pytest.approx(np.column_stack([place[:, 1], -place[:, 0], place[:, 2]]), abs=1e-12)
    back = in_slope_frame(on_map(run, 70.0, 20.0), fall_line_azimuth=math.radians(70.0), slope_angle=math.radians(20.0))
    assert back.place == pytest.approx(run.place, abs=1e-12)
    assert back.slope_angle == pytest.approx(math.radians(20.0))


@pytest.mark.parametrize("slope", [0.0, 8.0, 35.0])
def test_inclination_of_a_track(slope: float) -> None:
    found = inclination(on_map(run_of(1.0), 250.0, slope, noise=0.02))
    assert found is not None
    assert math.degrees(found.angle) == pytest.approx(slope, abs=0.3)
    assert found.error < math.radians(0.1)


@pytest.mark.parametrize(
    ("azimuth", "slope", "side", "noise"), [(15.0, 8.0, 1.0, 0.0), (135.0, 20.0, -1.0, 0.02), (290.0, 35.0, 1.0, 0.02)]
)
@pytest.mark.parametrize("source", ["given", "run", "heights"])
def test_the_heading_of_a_run_on_a_slope(azimuth: float, slope: float, side: float, noise: float, source: str) -> None:
    run, measured = run_of(side), on_map(run_of(side), azimuth, slope, noise)
    if source == "run":
        run = replace(run, slope_angle=math.radians(slope))
    found = fitted(run, measured, slope if source == "given" else None)
    assert azimuth_of(found) == pytest.approx(azimuth, abs=0.01 if source != "heights" and not noise else 0.5)
    assert found.dimensions == 3
    assert found.nearest.numbers is not None
    assert found.nearest.numbers.rms < 2.0 * noise + 0.01
    assert found.nearest.numbers.compared > 0.99 * found.measured.length


def test_a_measured_track_may_be_the_one_on_the_slope() -> None:
    run = run_of(1.0)
    found = fitted(replace(on_map(run, 140.0, 25.0), name="map"), run, 25.0)
    assert azimuth_of(found) == pytest.approx(140.0, abs=0.01)


def test_metres_of_a_site_are_a_map_if_their_heights_fall() -> None:
    """A track in metres of its own file, once in the axes of the slope and once on the map."""
    run = replace(run_of(1.0), slope_angle=math.radians(25.0))
    site = replace(on_map(run, 90.0, 25.0), axes="file")
    for measured, slope in ((site, 25.0), (replace(run, axes="file", slope_angle=None), None)):
        found = fitted(run, measured)
        assert found.fitted is not None
        assert found.fitted.slope_angle == (slope and pytest.approx(math.radians(slope)))
        assert found.fitted.turned == pytest.approx(0.0, abs=1e-4)
        assert found.nearest.numbers is not None
        assert found.nearest.numbers.max < 1e-3


def test_an_arc_of_one_radius_has_an_uncertain_heading() -> None:
    angle = np.linspace(0.0, 0.8, 100)
    arc = build_track(20.0 * np.column_stack([np.cos(angle), np.sin(angle)]), angle)
    noise = 0.05 * np.random.default_rng(1).normal(size=(100, 2))
    measured = build_track(arc.place[:, :2] + noise, angle)
    found = compare_tracks(arc, measured, fit=("start", "heading"))
    assert found.fitted is not None
    assert found.fitted.turned_error is not None
    assert found.fitted.turned_error > math.radians(2.0)
    assert any("uncertain" in each for each in found.warnings)


def test_a_slope_beyond_75_degrees_is_rejected() -> None:
    with pytest.raises(ParameterError, match="slope_angle"):
        fitted(run_of(1.0), on_map(run_of(1.0), 0.0, 10.0), 80.0)
