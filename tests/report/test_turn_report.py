"""Reports of a turn and of tracks."""

import math
import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.report.figures.style import journal_style
from skisnow.report.track.figures import coloured_map, named_radii, switch_times, track_along, track_map
from skisnow.report.track.report import write_track_report
from skisnow.report.track.summary import track_gpx, track_text, track_verdict, turn_rows
from skisnow.report.turn.chain import (
    EnsembleRun,
    TurnChain,
    afterbody_depth_ratio,
    band_shares,
    band_width,
    maximum_distance,
    middle_track,
    used_grip,
)
from skisnow.report.turn.figures import TimedTrack, loaded_skis
from skisnow.report.turn.page import FIGURES, contacts_table, parameters_table, shares_table, write_turn_report
from skisnow.report.turn.sentences import best_measurement, contrast, key_sentences
from skisnow.scenario.identify_section import Prior, measured_of
from skisnow.simulation.run import Run
from skisnow.snow import SnowProperties
from skisnow.track.projection import GeodeticPoint
from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, summary_dict, track_summary
from skisnow.track.track import Track
from tests.coded import raises

from ..conftest import without_figures
from ..track.paths import NOISE, along, circle, track
from .runs import RADIUS, circle_run

SNOW = SnowProperties(
    0.2 * N_PER_MM3,
    0.5 * N_PER_MM2,
    source="somewhere",
    snow_hardness_interval=(0.18 * N_PER_MM3, 0.23 * N_PER_MM3),
    failure_shear_stress_interval=(0.4 * N_PER_MM2, 0.6 * N_PER_MM2),
)


def with_afterbody(run: Run, share: float) -> Run:
    """All contact before the boot 20 mm deep, all behind it that times the share."""
    station = run.skis.station
    along = np.where(station > 0.0, 0.02, 0.02 * share) * (abs(station) < 0.7) - 0.001 * (abs(station) >= 0.7)
    return replace(run, skis=replace(run.skis, edge_depth=np.broadcast_to(along, run.skis.edge_depth.shape)))


def ensemble() -> list[EnsembleRun]:
    generator = np.random.default_rng(3)
    radii = RADIUS * np.exp(0.02 * generator.standard_normal(9))
    runs = [circle_run(radius=float(radius)) for radius in radii]
    return [
        EnsembleRun(SNOW, "tipped_over" if number == 4 else "finished", middle_track(run))
        for number, run in enumerate(runs)
    ]


@pytest.fixture(scope="module")
def chain() -> TurnChain:
    runs = {"hypoplastic, k_u / H_V = 10": circle_run(), "elastic": circle_run(radius=1.2 * RADIUS)}
    return TurnChain(
        campaign="A <b> campaign", site="site C", synthetic=True, snow=SNOW, runs=runs, ensemble=ensemble(), seed=1,
        ensemble_error=0.0431,
    )  # fmt: skip


@pytest.fixture(scope="module")
def folder(chain: TurnChain, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("turn")
    with without_figures():
        write_turn_report(chain, folder)
    return folder


def test_page_stands_alone_with_all_its_figures(folder: Path) -> None:
    html = (folder / "report.html").read_text(encoding="utf-8")
    assert not re.findall(r'(?:src|href)="(?!data:|#)', html)
    assert {path.stem for path in (folder / "figures").iterdir()} == set(FIGURES)
    assert "Synthetic data." in html
    assert re.search(r'"headline">.*12\.0 m', html)
    assert re.search(r"of 9 runs", html)
    assert "A &lt;b&gt; campaign" in html
    assert "0.043 m" in html and "8 of 9 runs" in html
    assert "H<sub>V</sub> 0.200 N/mm³ [0.180, 0.230]" in html.replace("<i>", "").replace("</i>", "")
    assert "S<sub>f</sub> 0.500 N/mm² [0.400, 0.600]" in html.replace("<i>", "").replace("</i>", "")


def test_parameters_are_in_the_units_of_the_field() -> None:
    hardness, stress = parameters_table(SNOW).rows
    assert hardness[2] == pytest.approx(0.2)
    assert hardness[3] == pytest.approx((0.18, 0.23))
    assert stress[2] == pytest.approx(0.5)
    assert stress[3] == pytest.approx((0.4, 0.6))


def test_what_was_measured_beside_them_is_in_the_table_and_is_narrowed_by_further_readings(chain: TurnChain) -> None:
    snow = replace(
        SNOW,
        unloading_ratio=9.0,
        unloading_ratio_interval=(6.0, 16.0),
        shear_displacement=2.5e-4,
        shear_displacement_interval=(2.0e-4, 3.0e-4),
    )
    table = parameters_table(snow)
    assert [(row[0], row[1]) for row in table.rows[2:]] == [("k_u / H_V", ""), ("shear displacement u_y", "mm")]
    assert [(row[2], *row[3]) for row in table.rows[2:]] == [pytest.approx((9, 6, 16)), pytest.approx((0.25, 0.2, 0.3))]
    drawn = np.exp(np.random.default_rng(4).uniform(-1.0, 1.0, (50, 1)))
    runs = drawn_over(("snow.shear_displacement_mm",), np.log(drawn[:, 0]), drawn)
    known = replace(chain, snow=snow, ensemble=runs, measured=measured_of(snow))
    said = " ".join(str(each.striptags()) for each in (*key_sentences(known), *best_measurement(known)))
    assert "9.00 [6.00, 16.0]" in said and "0.250 mm [0.200, 0.300]" in said
    assert said != " ".join(str(each.striptags()) for each in best_measurement(replace(chain, ensemble=runs)))


def test_contacts_stand_with_their_own_numbers(chain: TurnChain) -> None:
    table = contacts_table(chain.runs)
    keys = [column.key for column in table.columns]
    first, second = (dict(zip(keys, row, strict=True)) for row in table.rows)
    assert second["turn_radius_m"] == pytest.approx(1.2 * first["turn_radius_m"])
    assert first["turned_deg"] == pytest.approx(math.degrees(8.0 / RADIUS * 4.0))  # to the left: positive
    assert first["depth_mm"] == pytest.approx(24.0, rel=0.01)  # 20 mm times 1.2
    assert (first["grip"], first["slides"]) == (pytest.approx(0.4), 0.0)


def test_afterbody_over_forebody() -> None:
    run = circle_run()
    assert afterbody_depth_ratio(with_afterbody(run, 0.8)) == pytest.approx(0.8)
    assert afterbody_depth_ratio(with_afterbody(run, 0.3)) == pytest.approx(0.3)
    assert afterbody_depth_ratio(with_afterbody(run, -0.1)) is None  # it hovers
    assert set(loaded_skis(run)) == {1}


def test_skis_that_yield_use_all_their_grip() -> None:
    run = circle_run()
    full = 0.5e6 * np.maximum(run.skis.edge_depth, 0.0)
    full[: len(run.time) // 4] *= 0.5
    grip, slides = used_grip(replace(run, skis=replace(run.skis, shear_per_length=-full)))
    assert grip == pytest.approx(1.0)
    assert slides == pytest.approx(0.75, abs=0.01)


def words_of(first: Run, other: Run) -> str:
    chain = TurnChain(
        campaign="", site="", synthetic=False, snow=SNOW, runs={"first": first, "other": other}, ensemble=[], seed=1
    )
    return " ".join(str(sentence.striptags()) for sentence in contrast(chain))


def with_grip(run: Run, share: float) -> Run:
    """All of both skis draws that share of what the snow can hold."""
    return replace(run, skis=replace(run.skis, shear_per_length=-share * 0.5e6 * np.maximum(run.skis.edge_depth, 0.0)))


@pytest.mark.parametrize(
    ("ratio", "numbers"), [(1.2, ["20 %", "14.4", "wider"]), (0.75, ["25 %", "9.00", "narrower"]), (1.001, ["as wide"])]
)
def test_the_wider_turn_is_called_the_wider(ratio: float, numbers: list[str]) -> None:
    words = words_of(circle_run(), circle_run(radius=ratio * RADIUS))
    assert [number for number in numbers if number not in words] == []


@pytest.mark.parametrize(
    ("first", "other", "compared", "sliding"),
    [
        (0.3, 0.6, "higher: 0.600", "both"),
        (0.6, 0.3, "lower: 0.300", "both"),
        (0.6, 1.0, "higher: 1.00", "“other” side-slips"),
        (1.0, 0.6, "lower: 0.600", "“first” side-slips"),
        (1.0, 1.0, "same: 1.00", "Both side-slip"),
    ],
)
def test_who_draws_more_on_the_snow_and_who_slides(first: float, other: float, compared: str, sliding: str) -> None:
    words = words_of(with_grip(circle_run(), first), with_grip(circle_run(), other))
    assert compared in words and sliding in words


def test_distance_of_paths_and_width_of_a_band() -> None:
    run = circle_run()
    aside = replace(run, place=run.place + np.array([0.0, 0.0, 0.7]))
    assert maximum_distance(aside, run) == pytest.approx(0.7)
    time = np.linspace(0.0, 2.0, 41)
    nominal = TimedTrack(time, 5.0 * time, np.zeros(41))
    tracks = [TimedTrack(time, (5.0 + 0.1 * k) * time, 0.05 * k * time) for k in np.linspace(-1.0, 1.0, 201)]
    assert band_width(nominal, tracks) == pytest.approx((0.05 * 1.8 * 2.0, 0.1 * 1.8 * 2.0))
    ended = [TimedTrack(track.time[:21], track.x[:21], track.y[:21]) for track in tracks]
    assert band_width(nominal, ended) == pytest.approx((0.09, 0.18))  # at 1 s, where they ended


def drawn_over(keys: tuple[str, ...], aside: np.ndarray, inputs: np.ndarray) -> list[EnsembleRun]:
    """Straight runs that end so far to the left (m), with values of inputs (runs, keys)."""
    time = np.linspace(0.0, 2.0, 11)
    return [
        EnsembleRun(SNOW, "finished", TimedTrack(time, 5.0 * time, end * time / 2.0), dict(zip(keys, row, strict=True)))
        for end, row in zip(aside.tolist(), inputs.tolist(), strict=True)
    ]


def test_shares_of_the_band_are_those_of_what_was_drawn(chain: TurnChain) -> None:
    """Offset = 2 ln u_y + ln S_f, both even in their logarithm over the same range: 4/5 and 1/5."""
    logs = np.random.default_rng(4).uniform(-1.0, 1.0, (200, 2))
    inputs = np.column_stack([np.full(200, 0.3), np.exp(logs)])
    keys = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.shear_displacement_mm")
    runs = drawn_over(keys, logs @ [1.0, 2.0], inputs)
    time = np.linspace(0.0, 2.0, 11)
    found = band_shares(TimedTrack(time, 5.0 * time, 0.0 * time), runs)
    assert found is not None
    assert found.keys == keys[1:]  # what does not vary has no share
    assert found.aside.share == pytest.approx([0.2, 0.8], abs=0.05)
    assert found.ahead.share == pytest.approx([0.0, 0.0])
    prior = Prior(key=keys[2], low=0.02, high=0.5, origin="not measured")
    measured = measured_of(SNOW)
    table = shares_table(replace(chain, ensemble=runs, measured=measured, priors=(prior,)))
    assert [row[0] for row in table.rows] == [*keys, "left over"]
    assert table.rows[0][3] == (None, None)
    assert table.rows[2][1] == (0.02, 0.5)
    assert table.rows[2][3][0] == pytest.approx(80.0, abs=5.0)
    assert [row[2].split(":")[0] for row in table.rows] == ["measured", "measured", "prior", ""]
    assert all("log-normal" in row[2] and row[2].endswith("of site C") for row in table.rows[:2])
    assert table.rows[2][2].endswith("; not measured")
    said = " ".join(str(each.striptags()) for each in key_sentences(replace(chain, ensemble=runs, warnings=("near",))))
    assert "shear displacement uy: 8" in said
    assert "Warning: near." in said


def test_few_runs_tell_no_shares(chain: TurnChain) -> None:
    logs = np.random.default_rng(5).uniform(-1.0, 1.0, (4, 2))
    keys = ("snow.S_f_N_per_mm2", "snow.shear_displacement_mm")
    assert band_shares(middle_track(chain.nominal), drawn_over(keys, logs[:, 0], np.exp(logs))) is None
    assert band_shares(middle_track(chain.nominal), chain.ensemble) is None  # the draws are unknown


def test_too_little_to_compare_is_rejected(chain: TurnChain, tmp_path: Path) -> None:
    with raises(ParameterError, "too_few_runs", contacts=2, runs=2):
        write_turn_report(replace(chain, ensemble=chain.ensemble[:2]), tmp_path)
    assert not list(tmp_path.iterdir())


def slalom() -> TrackSummary:
    way = 0.01 * np.arange(6001)
    return track_summary(track(along(np.sin(np.pi * way / 15.0) / 12.0, 0.01)[::100], noise=NOISE))


def test_map_has_equal_scales_and_its_turns_and_radius_axis_is_even_in_curvature() -> None:
    summary = slalom()
    with journal_style():
        axes = track_map(summary).axes[0]
    assert axes.get_aspect() == 1.0
    assert switch_times(summary) == pytest.approx([1.5, 3.0, 4.5], abs=0.06)
    dots = [line for line in axes.lines if line.get_marker() == "o"]
    assert len(np.asarray(dots[0].get_xdata())) == 3
    # At its tick of 15 m the axis is at 1/15; the drawn curve is the curvature.
    with journal_style():
        axes = track_along(summary).axes[-1]
    ticks = dict(zip(axes.get_yticks(), (label.get_text() for label in axes.get_yticklabels()), strict=True))
    assert ticks[0.0] == "straight"
    for place, text in ticks.items():
        assert text == "straight" or abs(place) == pytest.approx(1.0 / float(text))
    drawn = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    assert np.nanmax(drawn) == pytest.approx(1.0 / 12.0, rel=0.15)


def test_a_constant_speed_has_one_colour_and_a_changing_speed_all() -> None:
    angle = np.linspace(0.0, math.pi, 81) ** 1.5
    changing = np.stack([16.0 * np.sin(angle), 16.0 * (1.0 - np.cos(angle))], axis=1)
    with journal_style():
        spread = [
            np.ptp(line.to_rgba(np.asarray(line.get_array()))[:, 1])
            for place in (circle(16.0, 12.0), changing)
            for line in coloured_map(track_summary(track(place)), "speed").axes[0].collections
        ]
    assert spread == pytest.approx([0.0, 0.9], abs=0.05)


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
    with without_figures():
        written = write_track_report(summary, tmp_path / "one")
        write_track_report(summary, tmp_path / "two")
    assert written == tmp_path / "one" / "track.json"
    names = sorted(path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*.*"))
    assert {name.name for name in names if name.parent == Path()} == {"track.json", "turns.csv", "points.csv"}
    assert len(names) == 19  # four figures in four forms, and three files
    for name in ("track.json", "turns.csv", "points.csv"):
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
    assert re.search(r"\nstart +2026-01-12 10:00:07 UTC\n", track_text(dated))
    assert re.search(
        r"\nstart +2026-01-12 10:00:07\n",
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
