"""The figures of runs show what the numbers say: the right way round, left where left is, in the units of the axis."""

import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.figure import Figure

from skisnow._support.arrays import FloatArray
from skisnow.comparison.distances import arc_lengths
from skisnow.comparison.nearest_place import distance_from_path
from skisnow.report.figures.style import BLUE, VERMILLION, journal_style
from skisnow.report.run.time_figures import (
    drawn_radius,
    grip_utilisation,
    gross_grip_utilisation,
    run_along_ski,
    run_energies,
    run_grip,
    run_motion,
    slip_of_a_place,
    stacked_energies,
)
from skisnow.report.run.track_figure import beside_track, groove_corners, run_track
from skisnow.report.turn.figures import TimedTrack, band_of, draw_runs, loaded_skis, offsets, track_band
from skisnow.simulation.run import LOST, STORED, Run

from ..runs import RADIUS, SPEED, STANCE, circle_run


@pytest.fixture(scope="module")
def run() -> Run:
    return circle_run()


def axes_of(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def timed(run: Run) -> TimedTrack:
    return TimedTrack(run.time, run.place[:, 0], run.place[:, 1])


def test_track_is_drawn_down_the_fall_line_with_the_left_ski_on_the_left(run: Run) -> None:
    with journal_style():
        figure = run_track(run)
    plan = axes_of(figure)[0]
    assert plan.get_aspect() == 1.0  # equal scales
    assert plan.get_xlim()[0] < plan.get_xlim()[1]  # down the fall line is to the right,
    assert plan.get_ylim()[0] < plan.get_ylim()[1]  # left is up: seen from above, not from below
    left = next(line for line in plan.lines if line.get_color() == BLUE)
    right = next(line for line in plan.lines if line.get_color() == VERMILLION)
    middle = len(run.time) // 2
    assert np.asarray(left.get_ydata())[middle] - np.asarray(right.get_ydata())[middle] == pytest.approx(STANCE)
    for ski, line in enumerate((left, right)):
        assert np.array_equal(np.asarray(line.get_xydata()), run.skis.track[:, ski, :2])
    long, wide = np.ptp(run.skis.track[..., :2].reshape(-1, 2), axis=0) + 1.2  # 0.6 m around
    # 158 mm of 180 for the plan, 38 mm below for the grooves, 38 mm for the surroundings
    assert figure.get_size_inches() * 25.4 == pytest.approx([180.0, 158.0 * wide / long + 76.0])
    marks = next(line for line in plan.lines if line.get_marker() == "o")
    assert len(np.asarray(marks.get_xdata())) == 5  # 0 to 4 s


def test_groove_lies_where_it_was_left() -> None:
    """A track along y: left of it is -x. And on a circle to the left, the middle is on the left, by R less R'."""
    track = np.stack([np.full(11, 2.0), np.linspace(0.0, 5.0, 11), np.zeros(11)], axis=1)
    way, aside = beside_track(np.array([[1.7, 3.1, 0.0], [2.4, 1.0, 0.0]]), track, track[4])
    assert way == pytest.approx([1.1, -1.0])
    assert aside == pytest.approx([0.3, -0.4])
    angle = np.linspace(0.0, 1.0, 2001)
    circle = np.stack([12.0 * np.sin(angle), 12.0 * (1.0 - np.cos(angle)), 0.0 * angle], axis=1)
    inside = np.array([[11.9 * np.sin(0.5), 12.0 - 11.9 * np.cos(0.5), 0.0]])
    way, aside = beside_track(inside, circle, circle[0])
    assert way == pytest.approx([6.0], abs=1e-4)
    assert aside == pytest.approx([0.1], abs=1e-5)


def test_groove_is_drawn_in_its_width_and_depth(run: Run) -> None:
    (corners,) = groove_corners(np.array([1.0]), np.array([0.01]), np.array([0.004]), 0.02)
    assert corners.min(axis=0) == pytest.approx([0.99, 8.0])  # m along, mm across
    assert corners.max(axis=0) == pytest.approx([1.01, 12.0])
    with journal_style():
        figure = run_track(run)
    for ski, axes in enumerate(axes_of(figure)[1:]):
        pieces = next(drawn for drawn in axes.collections if isinstance(drawn, PolyCollection))
        assert len(pieces.get_paths()) > 3
        expected = run.skis.depth[len(run.time) // 2, ski] * 0.9 * 1e3
        assert np.median(np.asarray(pieces.get_array())) == pytest.approx(expected, rel=0.1)  # mm
        assert ("left", "right")[ski] in axes.get_title(loc="left")


def test_maps_along_the_ski_have_time_across_and_the_tip_up(run: Run) -> None:
    with journal_style():
        figure = run_along_ski(run)
    panels = axes_of(figure)
    assert [axes.get_title(loc="left") for axes in panels[:2]] == ["left ski", "right ski"]
    mesh = next(drawn for drawn in panels[1].collections if isinstance(drawn, QuadMesh))
    values: FloatArray = np.ma.filled(
        np.ma.asarray(mesh.get_array()).reshape(len(run.skis.station), len(run.time)), np.nan
    )
    expected = run.skis.edge_depth[:, 1].T * 1e3
    assert np.array_equal(np.isfinite(values), expected > 0.0)
    assert values[expected > 0.0] == pytest.approx(expected[expected > 0.0])  # mm
    assert panels[1].get_ylim()[0] < 0.0 < panels[1].get_ylim()[1]
    assert panels[1].get_xlim() == pytest.approx((0.0, run.simulated_s), abs=0.02)


def test_motion_is_in_metres_a_second_degrees_and_metres(run: Run) -> None:
    with journal_style():
        figure = run_motion(run)
    speed, heading, radius = axes_of(figure)
    assert np.asarray(speed.lines[0].get_ydata()) == pytest.approx(np.full(len(run.time), SPEED))
    turned = np.ptp(np.asarray(heading.lines[0].get_ydata()))
    assert turned == pytest.approx(math.degrees(SPEED / RADIUS * run.simulated_s))
    assert np.asarray(radius.lines[0].get_ydata()) == pytest.approx(np.full(len(run.time), RADIUS))


def test_nearly_straight_parts_have_no_radius() -> None:
    radius = drawn_radius(np.array([-10.0, 10.0, 12.0, np.inf, 500.0, -29.0]))
    assert np.array_equal(np.isnan(radius), [False, False, False, True, True, False])
    assert radius[0] == -10.0
    assert np.isnan(drawn_radius(np.full(3, np.inf))).all()
    ripples = np.array([499.0, -900.0, 700.0, 2000.0, -1500.0])  # all but the first within three medians
    assert np.array_equal(np.isnan(drawn_radius(ripples)), [False, True, True, True, True])


def test_energies_stack_to_a_level_rim(run: Run) -> None:
    total = np.sum(list(stacked_energies(run).values()), axis=0)
    assert total == pytest.approx(np.full(len(run.time), total[0]), rel=1e-12)
    assert min(values.min() for values in stacked_energies(run).values()) >= 0.0
    with journal_style():
        figure = run_energies(run)
    every, losses = axes_of(figure)
    assert len(every.collections) == len(STORED) + len(LOST)
    assert len(losses.collections) == len(LOST)
    (level,) = every.lines
    assert np.asarray(level.get_ydata()) == pytest.approx(np.full(2, total[0]))
    assert losses.dataLim.y1 == pytest.approx(-run.energies["potential"][-1])
    # a tenth of the friction gone: the title names what is missing
    less = run.energies | {"friction": 0.9 * run.energies["friction"]}
    with journal_style():
        figure = run_energies(replace(run, energies=less))
    missing = 0.1 * run.energies["friction"][-1]
    over = run.energies["kinetic"][0] - 2.0 * run.energies["potential"][-1] - missing
    assert f"residual {100.0 * missing / over:.2f} %" in axes_of(figure)[0].get_title(loc="left")


def test_share_of_the_shear_strength(run: Run) -> None:
    assert grip_utilisation(run) == pytest.approx(np.full((len(run.time), 2), 0.4))
    to_the_right = replace(run.skis, shear_per_length=-run.skis.shear_per_length)
    assert grip_utilisation(replace(run, skis=to_the_right)) == pytest.approx(np.full((len(run.time), 2), 0.4))


def test_opposite_pulls_count_in_the_gross_share_and_slip(run: Run) -> None:
    """The rear quarter pulls against the rest: twice its share is taken off the net one, and the gross one stays."""
    station = run.skis.station
    sense = np.where(station < station[-1] + 0.25 * (station[0] - station[-1]), -1.0, 1.0)
    against = replace(run, skis=replace(run.skis, shear_per_length=sense * run.skis.shear_per_length))
    assert gross_grip_utilisation(against) == pytest.approx(gross_grip_utilisation(run))
    shear = run.skis.shear_per_length
    rear = shear[..., sense < 0.0].sum(axis=2) / shear.sum(axis=2)
    assert grip_utilisation(against) == pytest.approx((1.0 - 2.0 * rear) * grip_utilisation(run), rel=0.05)
    # W = u S_f e for each metre of way and ski
    strength, depth = run.scenario.contact.snow.failure_shear_stress, run.skis.edge_depth
    assert strength is not None
    per_length = strength * float(depth[depth > 0.0].mean())
    work = np.linspace(0.0, 2.0 * run.run_length * per_length * 1.8e-3, len(run.time))
    assert slip_of_a_place(replace(run, energies=run.energies | {"shear": work})) == pytest.approx(1.8e-3)


def test_grip_is_drawn_for_each_ski_not_for_each_section(run: Run) -> None:
    """Sections slip one by one at 1 while the ski holds: a map of them would say the contrary of the ski's number."""
    with journal_style():
        (axes,) = run_grip(run).axes
    left, gross_left, right, gross_right, limit = (np.asarray(line.get_ydata()) for line in axes.lines)
    assert not axes.collections
    assert np.stack([left, right], axis=1) == pytest.approx(grip_utilisation(run))
    assert np.stack([gross_left, gross_right], axis=1) == pytest.approx(gross_grip_utilisation(run))
    assert np.all(limit == 1.0)
    assert max(gross_left.max(), gross_right.max()) <= axes.get_ylim()[1]


def test_the_legend_of_the_grip_names_every_line_and_none_is_clipped(run: Run) -> None:
    strong = replace(run, skis=replace(run.skis, shear_per_length=3.0 * run.skis.shear_per_length))
    with journal_style():
        figure = run_grip(strong)
    (axes,), (legend,) = figure.axes, figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "left ski", "right ski", "net", "gross", "capacity of the snow"
    ]  # fmt: skip
    assert 1.12 < float(np.nanmax(gross_grip_utilisation(strong))) < axes.get_ylim()[1]


def test_distance_between_circles_of_one_centre() -> None:
    """Circles of 12 and 12.5 m about one centre are 0.5 m apart everywhere but before and behind the ends."""
    angle = np.linspace(0.0, 1.0, 2001)
    inner, outer = (
        np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle], axis=1) for radius in (12.0, 12.5)
    )
    assert distance_from_path(outer, inner) == pytest.approx(np.full(2001, 0.5), abs=1e-6)
    assert arc_lengths(inner)[-1] == pytest.approx(12.0, rel=1e-6)


def test_compared_runs_are_held_against_the_first(run: Run) -> None:
    wider = circle_run(radius=1.1 * RADIUS, deep=0.01)
    with journal_style():
        figure = draw_runs({"first": run, "wide": wider})
    plan, distance, depth = axes_of(figure)
    assert len([line for line in plan.lines if len(np.asarray(line.get_xdata())) > 1]) == 2
    (curve,) = distance.lines
    assert np.asarray(curve.get_xdata())[-1] == pytest.approx(wider.run_length, rel=1e-3)
    assert "first" in distance.get_ylabel()
    now = np.asarray(depth.lines[0].get_ydata()), np.asarray(depth.lines[1].get_ydata())
    shown = int(np.argmin(abs(run.time - 0.9 * min(run.simulated_s, wider.simulated_s))))
    assert now[0] == pytest.approx(run.skis.edge_depth[shown, 1] * 1e3)
    assert now[1] == pytest.approx(now[0] / 2.0)
    assert depth.get_ylim()[0] > 0.0 > depth.get_ylim()[1]  # depth grows downwards
    assert "right ski" in depth.get_ylabel()
    assert set(loaded_skis(run)) == {1}


def test_offset_to_the_left_is_positive_and_ahead_is_ahead() -> None:
    time = np.linspace(0.0, 2.0, 41)
    nominal = TimedTrack(time, 5.0 * time, np.zeros(41))
    faster = TimedTrack(time, 6.0 * time, 0.5 * time)
    short = TimedTrack(time[:21], 5.0 * time[:21], -0.2 * np.ones(21))
    aside, ahead = offsets(nominal, [faster, short])
    assert aside[0] == pytest.approx(0.5 * time)
    assert ahead[0] == pytest.approx(time, abs=1e-12)
    assert aside[1, :21] == pytest.approx(np.full(21, -0.2))
    assert np.isnan(aside[1, 21:]).all()
    # heading along y: left is -x
    across = TimedTrack(time, np.zeros(41), 5.0 * time)
    aside, _ = offsets(across, [TimedTrack(time, -0.3 * np.ones(41), 5.0 * time)])
    assert aside[0] == pytest.approx(np.full(41, 0.3))


def test_bands_hold_half_and_ninety_per_cent() -> None:
    values = np.linspace(-1.0, 1.0, 201)[:, None] * np.array([1.0, 2.0])
    band = band_of(values)
    assert band[:, 0] == pytest.approx([-0.9, -0.5, 0.0, 0.5, 0.9])
    assert band[:, 1] == pytest.approx([-1.8, -1.0, 0.0, 1.0, 1.8])
    few = np.array([[0.0, np.nan], [1.0, np.nan], [2.0, 5.0]])
    assert np.isnan(band_of(few)[:, 1]).all()


def test_band_is_drawn_around_the_nominal_track(run: Run) -> None:
    generator = np.random.default_rng(1)
    tracks = [timed(circle_run(radius=RADIUS * math.exp(0.03 * generator.standard_normal()))) for _ in range(12)]
    with journal_style():
        figure = track_band(timed(run), tracks)
    plan = axes_of(figure)[0]
    ends = [np.asarray(line.get_xydata(), dtype=float) for line in plan.lines if line.get_marker() == "."]
    assert np.concatenate(ends) == pytest.approx(np.array([[track.x[-1], track.y[-1]] for track in tracks]))
    nominal = next(line for line in plan.lines if line.get_color() == VERMILLION)
    assert np.asarray(nominal.get_xdata()) == pytest.approx(run.place[:, 0])
    assert np.asarray(nominal.get_ydata()) == pytest.approx(run.place[:, 1])
    wide, narrow = (np.asarray(patch.get_path().vertices) for patch in plan.patches[:2])
    whole = np.isfinite(band_of(offsets(timed(run), tracks)[0])[0]).sum()
    assert len(wide) == len(narrow) == 2 * whole + 1  # both rims, at every time, and back to the first corner
    assert np.ptp(wide[:, 0]) > np.ptp(narrow[:, 0])
