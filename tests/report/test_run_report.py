"""The report of a run: complete, self-contained, and its numbers are those of the run."""

import re
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.text import Text

from skisnow._support.units import DEGREE
from skisnow.report.figures.drawing import FORMS
from skisnow.report.run.page import FIGURES, write_run
from skisnow.report.run.tables import energies_table, scenario_table
from skisnow.scenario.keys import SCENARIO_KEYS, in_sections, scenario_values
from skisnow.simulation.run import LOST, STORED, Run, SkiHistory
from tests.key_names import EDGE_ANGLE

from ..conftest import without_figures
from .runs import circle_run

pytestmark = pytest.mark.usefixtures("svg_alone")
CHECKED = {"solver.elements": {"was": 40.0, "now": 80.0, "end_moves_cm": 0.125, "outcome": "finished"}}


def summary_of(run: Run) -> dict[str, Any]:
    """The parts of summary.json that the report reads."""
    energies = {f"{name}_J": float(run.energies[name][-1]) for name in STORED}
    energies |= {f"{name}_start_J": float(run.energies[name][0]) for name in STORED}
    energies |= {f"lost_{name}_J": float(run.energies[name][-1]) for name in LOST}
    return {
        "energies": energies,
        "energy_balance_error": run.energy_balance_error,
        "scenario": in_sections(scenario_values(run.scenario)),
        "provenance": {"versions": {"skisnow": "0", "numpy": "2"}, "time": "2013-01-01T00:00:00+00:00"},
    }


def first_rows(run: Run, count: int) -> Run:
    """A run that ended after so many rows."""
    cut = {name: getattr(run, name)[:count] for name in ("time", "place", "attitude", "velocity", "heading")}
    skis = SkiHistory(
        station=run.skis.station,
        **{name: getattr(run.skis, name)[:count] for name in SkiHistory.__slots__ if name != "station"},
    )
    energies = {name: values[:count] for name, values in run.energies.items()}
    boots = run.boots
    if boots is not None:
        boots = replace(boots, **{each.name: getattr(boots, each.name)[:count] for each in fields(boots)})
    return replace(run, **cut, turn_radius=run.turn_radius[:count], skis=skis, energies=energies, boots=boots)


@pytest.fixture(scope="module")
def run() -> Run:
    return circle_run()


@pytest.fixture(scope="module")
def folder(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    with without_figures():
        write_run(run, folder, summary=summary_of(run))
    return folder


@pytest.fixture(scope="module")
def html(folder: Path) -> str:
    return (folder / "report.html").read_text(encoding="utf-8")


def test_everything_is_written(folder: Path) -> None:
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    figures = {f"figures/{name}.{kind}" for name in FIGURES for kind in FORMS}
    assert names == {"run.nc", "report.html", "summary.json", "track.csv"} | figures


def test_page_needs_nothing_else(html: str) -> None:
    assert not re.findall(r'(?:src|href)="(?!data:|#)', html)
    assert html.count("data:image/svg") == len(FIGURES)
    assert "None" not in re.sub(r"base64,[^\"]*", "", html)
    assert "nan" not in re.findall(r">([^<]*)<", html)


def test_every_key_of_the_scenario_is_in_its_table(run: Run, html: str) -> None:
    rows = {row[0]: row for row in scenario_table(summary_of(run)["scenario"]).rows}
    assert set(rows) == set(SCENARIO_KEYS)
    assert rows[EDGE_ANGLE][1:3] == ("30", "°")
    assert rows["snow.S_f_N_per_mm2"][1:3] == ("0.5", "N/mm²")
    assert rows["sledge.inertia_kg_m2"][1] == "[4, 4, 4]"
    assert rows["snow.compaction_resistance"][1] == "true"
    assert all(f">{name}<" in html for name in SCENARIO_KEYS)


def test_outcome_and_numbers_are_those_of_the_run(html: str) -> None:
    assert "finished" in html
    assert "32.0 m in 4.00 s, from 8.00 to 8.00 m/s" in html
    assert "median turn radius 12.0 m" in html
    # a right angle less than a half turn: 8/12 × 4 s = 152.8°, half of it to each side
    assert "Heading from −76.4° to 76.4°" in html
    assert "elements 40, line_spacing_m 0.02." in html


@pytest.mark.usefixtures("undrawn")
def test_the_headline_of_a_straight_run_is_its_speed(run: Run, tmp_path: Path) -> None:
    ahead = np.array([1.0, 0.0, 0.0])
    velocity = np.linspace(4.0, 8.0, len(run.time))[:, None] * ahead
    straight = replace(run, velocity=velocity, turn_radius=np.full(len(run.time), np.inf))
    page = write_run(straight, tmp_path, summary=summary_of(run)).read_text(encoding="utf-8")
    (headline,) = re.findall(r'<p class="headline">(.*?)</p>', page)
    assert [number in headline for number in ("6.00", "4.20", "7.80")] == [True] * 3


def test_boots_that_are_moved_have_their_angles_and_forces(run: Run, html: str, tmp_path: Path) -> None:
    """The left ski goes from flat to 30 degrees, the right one stays; they are not edged at the scenario's angle."""
    assert run.boots is not None
    angle = np.stack([np.linspace(0.0, 30.0, len(run.time)), np.zeros(len(run.time))], axis=1) * DEGREE
    across = np.stack([0.0 * angle, np.cos(angle), -np.sin(angle)], axis=2)
    off = np.stack([0.0 * angle, np.sin(angle), np.cos(angle)], axis=2)
    axes = np.stack([np.broadcast_to([1.0, 0.0, 0.0], across.shape), across, off], axis=2)
    moved = replace(run, boots=replace(run.boots, axes=axes), boots_by="moved by edges.csv")
    with without_figures():
        page = write_run(moved, tmp_path, summary=summary_of(run)).read_text(encoding="utf-8")
    assert "0° to 30°" in page
    assert "edge angle 30.0°" in html
    assert "edge angle 30.0°" not in page
    drawn = " ".join(text.get_text() for text in moved.plot("boots").findobj(Text) if isinstance(text, Text))
    assert all(word in drawn for word in ("edge angle (°)", "edging moment", "left ski"))
    assert "Dotted: the radius" in html
    assert "Dotted: the radius" not in page
    assert not (tmp_path / "figures" / "balance.svg").exists()


def test_energies_add_up(run: Run) -> None:
    table = energies_table(summary_of(run))
    assert sum(row[3] for row in table.rows) == pytest.approx(0.0, abs=1e-9)
    (kinetic,) = (row for row in table.rows if row[0] == "kinetic")
    assert kinetic[1:] == pytest.approx((2720.0, 2720.0, 0.0))


@pytest.mark.usefixtures("undrawn")
def test_verification_is_reported_where_it_was_asked(run: Run, html: str, tmp_path: Path) -> None:
    assert "Computed again" not in html
    write_run(run, tmp_path, summary=summary_of(run) | {"verification": CHECKED})
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Computed again" in page
    assert "0.125" in page


@pytest.mark.usefixtures("undrawn")
def test_run_without_a_step_says_so_and_leaves_no_figure_of_another(run: Run, tmp_path: Path) -> None:
    write_run(run, tmp_path, summary=summary_of(run))
    at_once = replace(first_rows(run, 1), outcome="airborne", remedy="Start on the snow.")
    write_run(at_once, tmp_path, summary=summary_of(at_once))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Start on the" in page
    assert page.count("<img") == 0
    assert not list((tmp_path / "figures").iterdir())


@pytest.mark.usefixtures("svg_alone")
def test_run_that_did_not_stay_finite_is_drawn_up_to_there(run: Run, tmp_path: Path) -> None:
    place, velocity = run.place.copy(), run.velocity.copy()
    place[-1], velocity[-1] = np.nan, np.nan
    energies = {name: np.append(values[:-1], np.nan) for name, values in run.energies.items()}
    broken = replace(run, place=place, velocity=velocity, energies=energies, outcome="not_finite")
    summary = summary_of(broken) | {
        "energies": dict.fromkeys(summary_of(run)["energies"]),
        "energy_balance_error": None,
    }
    page = write_run(broken, tmp_path, summary=summary).read_text(encoding="utf-8")
    words = re.sub(r"base64,[^\"]*", "", page)
    assert "not finite" in words
    assert not re.search(r"\bnan\b", words)
