"""The table of gates as a file, the doubt of its times in words, and a track as the point that moves through it."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.track.course import MovingPoint, passages
from skisnow.track.course.gates_table import COLUMNS, gates_csv, gates_dict, time_warnings
from skisnow.track.course.passages import track_point
from skisnow.track.track import Axes, Track
from tests.coded import raises

from .test_passages import WIDE, along_x, course


def track(axes: Axes = "file") -> Track:
    time = np.array([0.0, 1.0, 1.0, 0.5, 2.0, 3.0])
    place = np.column_stack([10.0 * time, 0.0 * time, 0.0 * time])
    place[4] = np.nan
    return Track("t", time, place, np.full(6, np.nan), "local", "metres", axes=axes)


def test_the_file_has_its_columns_and_all_gates() -> None:
    """From x = -5 at 10 m/s past gates at 10, 20 and 30: 1.5, 2.5, 3.5 s, each a second after the one before."""
    result = passages(WIDE, along_x(), {})
    rows = list(csv.DictReader(io.StringIO(gates_csv(result))))
    assert list(rows[0]) == list(COLUMNS)
    assert [float(row["time_s"]) for row in rows] == pytest.approx([1.5, 2.5, 3.5])
    assert [float(row["split_s"]) for row in rows] == pytest.approx([1.5, 1.0, 1.0])
    assert gates_dict(result)["gate_times_s"] == pytest.approx([1.5, 2.5, 3.5])


def test_times_that_hang_on_the_way_between_points_are_told_beside_a_gate_without_any() -> None:
    time = np.arange(0.0, 3.0, 0.5)
    bent = MovingPoint(time, np.column_stack([9.0 * time + 2.0 * np.sin(3.0 * time), 0.0 * time]))
    result = passages(WIDE, bent, {})
    assert [each.outcome for each in result.passages] == ["passed", "passed", "not_reached"]
    assert result.passages[2].doubt is None
    (warning,) = time_warnings(result)
    assert "0." in warning
    assert time_warnings(passages(WIDE, along_x(), {})) == ()


def test_beyond_a_narrow_gate_is_beyond_its_outer_pole() -> None:
    """Poles at y = 0 and 0.4, gone through at 0.9."""
    narrow = course(((10.0, 0.0), "left", (10.0, 0.4)), ((20.0, -3.0), "left", (20.0, 3.0)))
    first = passages(narrow, along_x(y=0.9), {}).passages[0]
    assert "0.50 m" in first.words and "outer" in first.words
    assert first.clearance == pytest.approx(-0.5)


def test_a_track_is_the_point_at_its_usable_places_and_rising_times() -> None:
    point = track_point(track(), WIDE)
    np.testing.assert_array_equal(point.time, [0.0, 1.0, 3.0])
    with raises(ParameterError, "different_units", name="t"):
        track_point(track("east_north_up"), WIDE)
