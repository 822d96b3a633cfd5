"""The figures and the words of a measured track."""

import math
import re
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.report.figures.style import journal_style
from skisnow.report.track.figures import named_radii, switch_times, track_along, track_map
from skisnow.report.track.report import write_track_report
from skisnow.report.track.summary import track_gpx, track_text, track_verdict, turn_rows
from skisnow.track.projection import GeodeticPoint
from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, summary_dict, track_summary
from skisnow.track.track import Track

from ..conftest import only_drawn
from ..track.paths import NOISE, along, circle, track


def slalom() -> TrackSummary:
    way = 0.01 * np.arange(6001)
    return track_summary(track(along(np.sin(np.pi * way / 15.0) / 12.0, 0.01)[::100], noise=NOISE))


def test_map_has_equal_scales_and_its_turns() -> None:
    summary = slalom()
    with journal_style():
        axes = track_map(summary).axes[0]
    assert axes.get_aspect() == 1.0
    assert switch_times(summary) == pytest.approx([1.5, 3.0, 4.5], abs=0.06)
    dots = [line for line in axes.lines if line.get_marker() == "o"]
    assert len(np.asarray(dots[0].get_xdata())) == 3


def test_radius_axis_is_even_in_curvature() -> None:
    """At its tick of 15 m the axis is at 1/15; the drawn curve is the curvature."""
    summary = slalom()
    with journal_style():
        axes = track_along(summary).axes[-1]
    ticks = dict(zip(axes.get_yticks(), (label.get_text() for label in axes.get_yticklabels()), strict=True))
    assert ticks[0.0] == "straight"
    for place, text in ticks.items():
        assert text == "straight" or abs(place) == pytest.approx(1.0 / float(text))
    drawn = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    assert np.nanmax(drawn) == pytest.approx(1.0 / 12.0, rel=0.15)


@pytest.mark.parametrize("reach", [0.5, 0.1, 0.03, 0.001])
def test_named_radii_lie_inside_and_apart(reach: float) -> None:
    radii = named_radii(reach)
    places = np.array([1.0 / radius / reach for radius in radii])
    assert 1 <= len(radii) <= 3
    assert places.max() <= 1.0
    assert np.all(np.diff(places) < -0.17)


def test_gap_is_a_hole_in_the_line() -> None:
    made = track(circle(15.0, 8.0))
    made.time[40:] += 20.0
    with journal_style():
        axes = track_map(track_summary(made)).axes[0]
    assert np.isnan(np.asarray(axes.lines[0].get_xdata(), dtype=float)).sum() == 1


def test_files_are_written_and_the_same_each_time(tmp_path: Path) -> None:
    summary = slalom()
    with only_drawn("png", "svg"):
        written = write_track_report(summary, tmp_path / "one")
        write_track_report(summary, tmp_path / "two")
    assert written == tmp_path / "one" / "track.json"
    names = sorted(path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*.*"))
    assert {name.name for name in names if name.parent == Path()} == {"track.json", "turns.csv", "points.csv"}
    assert len(names) == 19
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_text_counts_and_defines() -> None:
    values = summary_dict(slalom())
    values["marked"] = {"repeated_time": 2}
    text = track_text(values, flag_sentences={"repeated_time": "Twice the same."})
    assert re.search(r"repeated time: 2\.", text) and "Twice the same." in text
    assert re.search(r"\n4 turns\n", text)
    assert len(re.findall(r"^ +\d+\.\d +\d+\.\d +(left|right)", text, flags=re.MULTILINE)) == 4
    assert "carrier phase" not in text
    mixed = track_text(values | {"solutions": {"fixed": 90, "float": 8, "code": 2}})
    assert re.search(r"\ncarrier phase +90 .*8 .*2 ", mixed)
    dated = values | {"start": "2026-01-12T10:00:07.25+00:00", "time_scale": "UTC"}
    assert re.search(r"\nstart +12 January 2026, 10:00:07 UTC\n", track_text(dated))
    assert re.search(
        r"\nstart +12 January 2026, 10:00:07\n",
        track_text(dated | {"start": "2026-01-12T10:00:07", "time_scale": "local"}),
    )
    many = values | {"turns": values["turns"] * 20}
    assert "and 40 more" in track_text(many)


def test_turn_table_of_a_circle_has_its_radius_speed_and_lean_of_balance() -> None:
    row = turn_rows(track_summary(track(circle(15.0, 8.0))))[0]
    lean = math.degrees(math.atan(8.0**2 / (9.81 * 15.0)))  # by hand: tan of the lean is v²/(g r)
    assert row["minimum_radius_m"] == pytest.approx(15.0, rel=0.02)
    assert (row["speed_in_m_per_s"], row["speed_out_m_per_s"]) == pytest.approx((8.0, 8.0), rel=0.02)
    assert row["lean_deg"] == pytest.approx(lean, rel=0.03)
    assert row["lean_low_deg"] <= row["lean_deg"] <= row["lean_high_deg"]


def test_gpx_of_a_track_is_the_same_track(tmp_path: Path) -> None:
    origin, time = GeodeticPoint(47.0, 11.0, 2000.0), np.arange(0.0, 20.0, 0.5)
    place = np.column_stack([8.0 * time, 3.0 * np.sin(time), -2.0 * time])
    start = datetime(2026, 2, 14, 9, 30, tzinfo=UTC)
    made = Track(
        "a", time, place, np.full(40, np.nan), "UTC", "local", axes="east_north_up", origin=origin, start=start
    )
    (tmp_path / "a.gpx").write_text(track_gpx(track_summary(made)) or "", encoding="utf-8")
    again = read_track(tmp_path / "a.gpx", origin=origin)
    assert np.abs(again.place - place).max() < 0.01
    assert again.start == start
    assert track_gpx(slalom()) is None


@pytest.mark.parametrize(
    ("rms", "known_to", "ending"),
    [
        (1.2, 0.0, "apart (root mean square, nearest place)."),
        (1.2, 3.0, "not certain, as a place is known to 3 m only."),
        (8.4, 3.0, "not certain, as a place is known to 3 m only."),  # twice √2 of 3 m are 8.49 m
        (8.6, 3.0, "certain, as a place is known to 3 m."),
    ],
)
def test_two_tracks_differ_for_certain_beyond_the_accuracy_of_both(rms: float, known_to: float, ending: str) -> None:
    found = track_verdict({"nearest": {"rms_m": rms}, "known_to_m": known_to})
    assert found.endswith(ending)
    assert ("not certain" in found) == ("not certain" in ending)
