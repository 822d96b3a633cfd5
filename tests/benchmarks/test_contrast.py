"""Pairs of runs on elastic and hypoplastic snow: the design, what a pair tells, and what the pairs tell together."""

import importlib
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.contrast import pairs as pairs_of_runs
from benchmarks.contrast.__main__ import part
from benchmarks.contrast.found import both_published, demand_and_strength, found, likelihood, numbers, regime, tables
from benchmarks.contrast.pairs import SCENARIOS, Pairs, distance_from, pair, turn, varied_ski
from benchmarks.contrast.unknowns import POINTS, UNKNOWNS, design

from skisnow import Run
from skisnow.scenario import Scenario
from skisnow.ski import read_ski
from skisnow.studies import run_study

from ..report.runs import RADIUS, circle_run

DOCS = Path(__file__).resolve().parents[2] / "docs"
POINT = {each.name: math.sqrt(each.low * each.high) if each.log else (each.low + each.high) / 2 for each in UNKNOWNS}


def test_the_design_covers_every_range_evenly() -> None:
    """Of the first 64 points of a Sobol sequence one lies in each of 64 slices, in any one direction."""
    points = design()
    assert len(points) == POINTS
    for each in UNKNOWNS:
        values = np.array([point[each.name] for point in points[:64]])
        share = np.log(values / each.low) / np.log(each.high / each.low) if each.log else None
        share = (values - each.low) / (each.high - each.low) if share is None else share
        assert sorted((share * 64).astype(int).tolist()) == list(range(64))


def test_a_point_becomes_a_turn_with_all_its_unknowns() -> None:
    made = turn({"scenario": "carver-42m", **POINT}, fast=True)
    carver = read_ski("carver")
    assert made.stop.length == 42.0
    assert made.solver.method == "fast"
    assert made.contact.unloading_ratio == pytest.approx(10.0)
    assert made.sledge.inertia == pytest.approx((6.0, 8.0, 10.0))
    assert made.start.heading == pytest.approx(math.radians(-45.0))
    assert made.ski.sidecut_depth == pytest.approx(carver.sidecut_depth)
    other = varied_ski(carver, stiffness=2.0, sidecut=1.2)
    assert other.sidecut_depth == pytest.approx(1.2 * carver.sidecut_depth)
    assert other.waist_width == pytest.approx(carver.waist_width)
    assert other.bending_stiffness == pytest.approx(2.0 * carver.bending_stiffness)
    assert other.torsional_stiffness == pytest.approx(2.0 * carver.torsional_stiffness)


def with_length(run: Run, length: float) -> Run:
    return replace(run, scenario=replace(run.scenario, stop=replace(run.scenario.stop, length=length)))


def test_a_pair_tells_how_far_its_tracks_part_and_to_which_side() -> None:
    """Circles to the left from one place, in the same direction: the wider one ends outside, at the right."""
    plastic = with_length(replace(circle_run(), outcome="distance_reached"), 32.0)
    wide = replace(circle_run(radius=1.3 * RADIUS), outcome="distance_reached")
    turned = wide.place @ rotation(plastic.heading[0] - wide.heading[0]).T
    wide = replace(wide, place=turned - turned[0] + plastic.place[0])
    row = pair(wide, plastic)
    assert row["outcome"] == "complete"
    assert row["apart_m"] == pytest.approx(np.nanmax(distance_from(wide, plastic)))
    assert row["apart_m"] > 1.0
    assert row["outside_m"] > 0.0
    assert 0.0 < row["parted_m"] < 32.0
    assert pair(plastic, plastic)["apart_m"] == pytest.approx(0.0, abs=1e-9)
    assert pair(plastic, plastic)["parted_m"] is None
    assert pair(replace(wide, outcome="tipped_over"), plastic)["outcome"] == "tipped_over"


def rotation(angle: float) -> Any:
    return np.array([
        [math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]
    ])  # fmt: skip


def test_a_run_that_does_not_cover_the_length_makes_no_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []

    def slow(scenario: Scenario) -> Run:
        asked.append(scenario.contact.unloading_ratio)
        return circle_run()

    monkeypatch.setattr(pairs_of_runs, "simulate", slow)
    row = Pairs()({"scenario": "carver-42m", **POINT})
    assert (row["outcome"], row["reason"], row["apart_m"]) == ("finished", "hypoplastic", None)
    assert asked == [pytest.approx(10.0)]


def test_a_part_is_a_study_that_continues(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    calls: list[str] = []

    def row(self: Pairs, point: dict[str, Any]) -> dict[str, Any]:
        calls.append(point["scenario"])
        if len(calls) == 5:
            raise KeyboardInterrupt
        return {**point, **dict.fromkeys(self.results), "outcome": "complete", "reason": ""}

    monkeypatch.setattr(Pairs, "__call__", row)
    with pytest.raises(KeyboardInterrupt):
        run_study(part(0, tmp_path), workers=1)
    table = run_study(part(0, tmp_path), workers=1)
    assert len(calls) == 33  # 32 and the one that was interrupted
    assert [each["scenario"] for each in table.rows[:4]] == [*SCENARIOS, *SCENARIOS]
    assert part(0, tmp_path).points[2]["start.heading_deg"] != part(1, tmp_path).points[2]["start.heading_deg"]


def rows_with(carver: list[float | None], giant: list[float | None]) -> list[dict[str, Any]]:
    """One point after the other with both skis; None: the elastic run tipped over."""
    rows = []
    for number, both in enumerate(zip(carver, giant, strict=True)):
        for scenario, apart in zip(SCENARIOS, both, strict=True):
            rows.append({
                "scenario": scenario, **POINT, "sledge.mass_kg": 60.0 + number, "snow.H_V_N_per_mm3": 0.1 * 1.5**number,
                "outcome": "tipped_over" if apart is None else "complete", "apart_m": apart or 0.0,
                "outside_m": 1.0 if number % 2 else -1.0, "elastic_slips": 0.5, "plastic_slips": 0.0,
            })  # fmt: skip
    return rows


def test_how_likely_the_published_pair_is() -> None:
    """7.36 m or more on the carver and 1.04 m or less on the giant slalom: of five points, one is incomplete."""
    rows = rows_with([7.4, 8.0, 7.3, 9.0, None], [0.6, 1.1, 0.6, 1.0, 0.5])
    assert both_published(found(rows)) == (2, 4)
    assert found(rows)["carver-42m"].share == pytest.approx(np.array([7.4, 8.0, 7.3, 9.0]) / 42.0)
    assert likelihood(0, 10) == "0 of 10, 0.0 % (0.0 to 30.8 %)"  # 1 - 0.025^(1/10)
    assert regime(rows[0]) == "the elastic run"


def test_strength_by_hand() -> None:
    """4 S_f² L/H_V, L = 1.54 m of the carver; m (v²/R + g sin α)."""
    row = {"scenario": "carver-42m", **POINT, "snow.S_f_N_per_mm2": 0.1, "snow.H_V_N_per_mm3": 0.2}
    needed, drawn = demand_and_strength(row)
    assert drawn == pytest.approx(4.0 * 1e10 * 1.54 / 2e8)
    mass = 90.0 + 2.0 * 2.246
    radius = read_ski("carver").sidecut_radius_of_edge_line * math.cos(math.radians(20.0))
    assert needed == pytest.approx(mass * (49.0 / radius + 9.81 * math.sin(math.radians(11.0))), rel=1e-4)


def test_the_page_says_what_the_kept_pairs_say() -> None:
    write_numbers: Any = importlib.import_module("write_numbers")
    page = "validation/measured.md"
    computed = write_numbers.anew(page)
    assert len(computed) == 6  # with its tables
    assert computed == {path: path.read_text(encoding="utf-8") for path in computed}


def test_every_number_of_the_page_has_a_name() -> None:
    generator = np.random.default_rng(1)
    rows = rows_with([None, *generator.uniform(0.1, 9.0, 39)], [*generator.uniform(0.1, 3.0, 40)])
    for row in rows:
        row |= {each.name: float(each.at(generator.random(1))[0]) for each in UNKNOWNS if each.name != "sledge.mass_kg"}
    told = numbers(found(rows))
    assert told["pairs"] == "80"
    assert told["carver failed"].startswith("1 of 40")
    assert tables(found(rows))["shares"].count("\n| ") == 2 + len(UNKNOWNS)  # rule, what is left over
