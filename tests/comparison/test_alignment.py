"""Fits find the offset that was put in, and nothing that was not there."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import FitError, ParameterError
from skisnow.comparison import Comparison, compare_tracks
from skisnow.comparison.alignment import HEADINGS, Motion, _iterate, fit_motion, start_motions
from skisnow.comparison.distances import Polyline, polyline
from skisnow.comparison.nearest_place import Path
from skisnow.comparison.result import fit_time
from skisnow.track.slope_frame import in_slope_frame, inclination, lay_on_slope
from skisnow.track.track import Track
from tests.coded import raises
from tests.present import present

from .made_tracks import build_track, slalom, turned

ALONG = np.linspace(0.0, 60.0, 500)


@pytest.fixture(autouse=True)
def fewer_places(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    """Sums over a quarter of the places, in a third of the time."""
    if request.node.get_closest_marker("slow") is None:
        monkeypatch.setattr("skisnow.comparison.alignment.PLACES", 512)


def line_of(place: FloatArray, *, duration: float = 6.0) -> Polyline:
    return polyline(place, np.linspace(0.0, duration, len(place)))


@pytest.mark.parametrize(("angle", "dimensions"), [(0.4, 2), (-2.6, 2), (-2.6, 3)])
def test_a_moved_copy_is_found_whatever_way_it_was_turned(angle: float, dimensions: int) -> None:
    move = (40.0, -7.0, 2.5)
    simulated = line_of(slalom(ALONG)[:, :dimensions])
    measured = line_of(turned(slalom(ALONG), angle, move)[:, :dimensions])
    motion = fit_motion(simulated, measured, start=True, heading=True)
    assert motion.turned == pytest.approx(angle, abs=1e-8)
    assert motion.moved == pytest.approx(move[:dimensions], abs=1e-6)
    assert motion.applied(simulated).place == pytest.approx(measured.place, abs=1e-6)
    assert motion.undetermined == 0


def test_only_what_is_asked_is_moved() -> None:
    simulated = line_of(slalom(ALONG))
    measured = line_of(turned(slalom(ALONG), 0.05, (1.0, 2.0, 0.0)))
    shifted = fit_motion(simulated, measured, start=True, heading=False)
    assert shifted.turned == 0.0
    swung = fit_motion(simulated, measured, start=False, heading=True)
    assert swung.moved == pytest.approx(np.zeros(3), abs=0.0)
    assert swung.applied(simulated).place[0] == pytest.approx(simulated.place[0], abs=1e-12)
    assert swung.turned != 0.0


def test_the_answer_is_a_least_square() -> None:
    """With noise no small step in any direction makes the mean square over the same places smaller."""
    random = np.random.default_rng(5)
    simulated = line_of(slalom(ALONG)[:, :2])
    measured = line_of(turned(slalom(ALONG), 0.1, (0.5, 0.3, 0.0))[:, :2] + 0.3 * np.sin(ALONG / 3.0)[:, None])
    measured = line_of(measured.place + 0.01 * random.normal(size=measured.place.shape))
    motion = fit_motion(simulated, measured, start=True, heading=True)
    places = measured.at_arc_length(np.linspace(0.0, measured.length, 2049))

    shown = Path(motion.applied(simulated).place).nearest(places)
    inside = ~shown.beyond
    assert inside.mean() > 0.98

    def mean_square(moved: FloatArray, turn: float) -> float:
        cosine, sine = math.cos(turn), math.sin(turn)
        place = (simulated.place - simulated.place[0]) @ np.array([[cosine, sine], [-sine, cosine]])
        found = Path(place + simulated.place[0] + moved).nearest(places)
        return float(np.mean(found.distance[inside] ** 2))

    best = mean_square(motion.moved, motion.turned)
    assert best == pytest.approx(float(np.mean(shown.distance[inside] ** 2)))
    for step in (1e-2 * np.eye(3)).tolist():
        for sign in (-1.0, 1.0):
            moved = motion.moved + sign * np.array(step[:2])
            assert mean_square(moved, motion.turned + sign * step[2] / 10.0) > best


def test_straight_lines_do_not_tell_how_far_along() -> None:
    """Across by 0.8 m, along by nothing: the 3 m along the lines cannot be known and stay."""
    measured = line_of(np.array([[0.0, 0.0], [50.0, 0.0]]))
    simulated = line_of(np.array([[3.0, 0.8], [53.0, 0.8]]))
    motion = fit_motion(simulated, measured, start=True, heading=True)
    assert motion.moved == pytest.approx([0.0, -0.8], abs=1e-8)
    assert motion.turned == pytest.approx(0.0, abs=1e-9)
    assert motion.undetermined == 1
    longer = line_of(np.array([[-30.0, 0.8], [80.0, 0.8]]))
    assert fit_motion(longer, measured, start=True, heading=True).moved == pytest.approx([0.0, -0.8], abs=1e-8)


def test_a_fit_neither_scales_nor_mirrors() -> None:
    simulated = line_of(slalom(ALONG)[:, :2])
    for other in (slalom(ALONG)[:, :2] * [1.0, -1.0], slalom(ALONG)[:, :2] * 1.05):
        measured = line_of(other)
        moved = fit_motion(simulated, measured, start=True, heading=True).applied(simulated)
        assert moved.length == pytest.approx(simulated.length, rel=1e-12)
        assert Path(moved.place).nearest(measured.place).distance.max() > 0.2


def test_a_short_track_cannot_be_slid_out_of_sight() -> None:
    measured, simulated = line_of(slalom(ALONG)), line_of(slalom(ALONG)[:100] + 0.5)
    with raises(FitError, "no_alignment", share=50.0):
        fit_motion(simulated, measured, start=True, heading=True)


def two_thirds_turned(angle: float) -> tuple[Polyline, Polyline]:
    """A track and its second two thirds, turned and with noise: nothing of the same arc length lies together."""
    noise = 0.01 * np.random.default_rng(3).normal(size=(len(ALONG), 2))
    measured = turned(slalom(ALONG), angle, (30.0, 12.0, 0.0))[:, :2] + noise
    return line_of(slalom(ALONG)[:, :2]), line_of(measured[len(ALONG) // 3 :])


def test_a_heading_is_found_where_the_measured_track_begins_later() -> None:
    simulated, measured = two_thirds_turned(3.0)
    motion = fit_motion(simulated, measured, start=True, heading=True)
    assert motion.turned == pytest.approx(3.0, abs=0.01)
    assert motion.rms < 0.01
    assert motion.rival is None


def test_the_next_turn_of_a_slalom_is_a_rival_where_both_have_the_whole_track_beside_them() -> None:
    """Three equal turns, of which the second was measured: the first and the third are as near."""
    along = np.linspace(0.0, 36.0 * math.pi, 900)
    wave = np.column_stack([along, 5.0 * np.sin(along / 6.0)])
    noise = 0.05 * np.random.default_rng(4).normal(size=(300, 2))
    motion = fit_motion(line_of(wave), line_of(wave[300:600] + noise), start=True, heading=True)
    apart = np.linalg.norm(present(motion.rival).moved - motion.moved) / (12.0 * math.pi)
    assert apart == pytest.approx(round(apart), abs=0.05)
    assert round(apart) in (1, 2)


@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_an_alignment_with_less_overlap_is_not_preferred(scale: float) -> None:
    """The next turn fits 55 % of the track about as well; the place with all of it beside counts, at any scale."""
    simulated, measured = two_thirds_turned(0.9)
    noise = 0.06 * np.random.default_rng(4).normal(size=measured.place.shape)
    tracks = (line_of(scale * place) for place in (simulated.place, measured.place + noise))
    motion = fit_motion(*tracks, start=True, heading=True)
    assert motion.turned == pytest.approx(0.9, abs=0.02)
    assert motion.share > 0.95
    assert motion.rival is None


def test_the_interval_of_a_heading_grows_with_noise_and_holds_the_truth() -> None:
    """Of 6 intervals with a coverage of 95 % at least 5 contain the truth in 967 of 1000 cases."""
    inside, errors = [], []
    for seed in range(3):
        for size in (0.01, 0.1):
            noise = size * np.random.default_rng(seed).normal(size=(100, 2))
            measured = turned(slalom(ALONG[::5]), 0.4, (40.0, -7.0, 0.0))[:, :2] + noise
            motion = fit_motion(line_of(slalom(ALONG)[:, :2]), line_of(measured), start=True, heading=True)
            inside.append(abs(motion.turned - 0.4) < present(motion.turned_error))
            errors.append(present(motion.turned_error))
    assert sum(inside) >= 5
    assert np.mean(errors[1::2]) == pytest.approx(10.0 * np.mean(errors[::2]), rel=0.3)


def test_noise_that_lengthens_a_track_does_not_slide_it() -> None:
    """Points every 2.6 cm with noise of 5 cm: the measured track is three times as long as its way."""
    along = np.linspace(0.0, 300.0, 6000)
    curve = np.column_stack([along, 5.0 * np.sin(along / 6.0) + 3.0 * np.cos(along / 11.0), 0.0 * along])
    noise = 0.05 * np.random.default_rng(1).normal(size=curve.shape)
    measured = line_of(turned(curve + noise, 2.0, (100.0, 50.0, 3.0))[400:5600])
    assert measured.length > 2.0 * 260.0
    motion = fit_motion(line_of(curve), measured, start=True, heading=True)
    assert motion.turned == pytest.approx(2.0, abs=0.01)
    assert motion.rms < 0.1


def test_a_line_that_is_the_same_turned_by_half_a_turn_keeps_its_direction() -> None:
    """A sine about its middle: only the way the tracks run tells the two answers apart."""
    wave = np.column_stack([ALONG, 4.0 * np.sin(ALONG / 60.0 * 4.0 * math.pi)])
    noise = 0.05 * np.random.default_rng(8).normal(size=wave.shape)
    motion = fit_motion(line_of(wave), line_of(wave + noise), start=True, heading=True)
    assert motion.turned == pytest.approx(0.0, abs=0.01)
    assert motion.rival is None


def test_a_track_is_not_laid_on_a_piece_that_runs_the_other_way() -> None:
    """Out along a low wave, back along eight high ones: the latter fit exactly, at more places than are refined."""

    def leg(first: float, last: float, height: float, side: float) -> FloatArray:
        along = np.arange(first, last, math.copysign(0.1, last - first))
        return np.column_stack([along, side + height * (np.sin(along / 3.0) + 0.4 * np.cos(along / 1.5))])

    simulated = line_of(np.vstack([leg(0.0, 24.0, 0.3, 0.0), leg(24.0, -136.0, 1.0, 20.0)]))
    motion = fit_motion(simulated, line_of(leg(3.0, 22.0, 1.0, 0.0)), start=True, heading=False)
    assert motion.moved == pytest.approx([0.0, 0.0], abs=0.1)
    assert motion.rms > 0.3


def test_arcs_of_one_circle_have_a_rival() -> None:
    """A longer arc with a little noise lies on the shorter one in many ways."""
    angle = np.linspace(0.0, 2.0, 400)
    simulated = line_of(10.0 * np.column_stack([np.cos(angle), np.sin(angle)]))
    noise = 0.05 * np.random.default_rng(2).normal(size=(300, 2))
    measured = line_of(10.0 * np.column_stack([np.cos(angle[:300] * 0.8), np.sin(angle[:300] * 0.8)]) + noise)
    motion = fit_motion(simulated, measured, start=True, heading=True)
    assert abs(math.remainder(present(motion.rival).turned - motion.turned, math.tau)) > math.radians(5.0)
    assert 0.99 * motion.rms < present(motion.rival).rms < 2.0 * motion.rms
    assert motion.turned_error is None


def test_a_search_begins_in_all_directions_and_all_along_the_track() -> None:
    """Headings within one step of each other, and a piece of 20 % within its tenth of the whole wherever it belongs."""
    place = slalom(ALONG)[:, :2]
    whole = line_of(place)
    headings = np.sort([each.turned % math.tau for each in start_motions(whole, whole, start=True, heading=True)])
    assert np.diff(headings, append=headings[0] + math.tau).max() < 1.01 * math.tau / HEADINGS
    for first in (0, 150, 300, 400):
        begins = start_motions(whole, line_of(place[first : first + 100] - place[first]), start=True, heading=False)
        assert {each.turned for each in begins} == {0.0}
        away = min(float(np.linalg.norm(each.moved + place[first])) for each in begins)
        assert away < 0.1 * whole.length
    assert len(start_motions(whole, whole, start=False, heading=False)) == 2


def test_an_answer_among_few_places_is_none_among_all_that_lie_beyond() -> None:
    path, places = Path(np.array([[0.0, 0.0], [1.0, 0.0]])), np.column_stack([np.linspace(0.0, 10.0, 21), np.zeros(21)])
    among_few = Motion(np.zeros(2), 0.0, rms=0.1)
    assert _iterate(path, places, among_few, start=True, heading=False).rms == math.inf


@pytest.mark.parametrize("later", [-40.0, -0.37, 0.0, 2.2])
def test_start_time(later: float) -> None:
    place = slalom(ALONG)
    simulated, measured = line_of(place), polyline(place, np.linspace(0.0, 6.0, 500) - later)
    assert fit_time(simulated, measured) == pytest.approx(later, abs=1e-6)


def test_start_time_of_a_track_that_begins_later() -> None:
    """The measured track lacks the first third: its clock starts anew, the fit finds the 2 s."""
    place = slalom(ALONG)
    time = np.linspace(0.0, 6.0, 500)
    late = time >= 2.0
    assert fit_time(line_of(place), polyline(place[late], time[late] - 2.0)) == pytest.approx(2.0, abs=1e-6)
    with raises(FitError, "no_duration"):
        fit_time(line_of(place), polyline(place[:2], np.zeros(2)))


# Tracks in a slope's axes laid on a map, and fits that need it


ALONG_X = np.linspace(0.0, 50.0, 251)


def run_of(side: float) -> Track:
    """A turn whose radius falls from 20 to 8 m, down the slope, to the left (1) or right (-1)."""
    angle = -0.6 + 0.05 * ALONG_X + 0.0004 * ALONG_X**2
    steps = 0.2 * np.column_stack([np.cos(angle), side * np.sin(angle)])
    place = np.cumsum(steps, axis=0)
    return replace(build_track(np.column_stack([place, np.full(len(ALONG_X), 0.01)]), ALONG_X / 8.0), axes="slope")


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
    return math.degrees(present(present(found.fitted).azimuth))


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
    found = present(inclination(on_map(run_of(1.0), 250.0, slope, noise=0.02)))
    assert math.degrees(found.angle) == pytest.approx(slope, abs=0.3)
    assert found.error < math.radians(0.1)


@pytest.mark.parametrize(
    ("source", "azimuth", "slope", "side", "noise"),
    [
        ("given", 15.0, 8.0, 1.0, 0.0),
        ("given", 290.0, 35.0, 1.0, 0.02),
        ("run", 135.0, 20.0, -1.0, 0.02),
        ("heights", 15.0, 8.0, 1.0, 0.0),
        ("heights", 135.0, 20.0, -1.0, 0.02),
    ],
)
def test_the_heading_of_a_run_on_a_slope(source: str, azimuth: float, slope: float, side: float, noise: float) -> None:
    run, measured = run_of(side), on_map(run_of(side), azimuth, slope, noise)
    if source == "run":
        run = replace(run, slope_angle=math.radians(slope))
    found = fitted(run, measured, slope if source == "given" else None)
    assert azimuth_of(found) == pytest.approx(azimuth, abs=0.01 if source != "heights" and not noise else 0.5)
    assert found.dimensions == 3
    assert present(found.nearest.numbers).rms < 2.0 * noise + 0.01
    assert present(found.nearest.numbers).compared > 0.99 * found.measured.length


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
        assert present(found.fitted).slope_angle == (slope and pytest.approx(math.radians(slope)))
        assert present(found.fitted).turned == pytest.approx(0.0, abs=1e-4)
        assert present(found.nearest.numbers).max < 1e-3


def test_a_slope_beyond_75_degrees_is_rejected() -> None:
    with pytest.raises(ParameterError, match="slope_angle"):
        fitted(run_of(1.0), on_map(run_of(1.0), 0.0, 10.0), 80.0)
