"""A study that is asked for in the lab is one of the command: its file, its queue, what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.coded import raises

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.studies import read_study
from skisnow.web.runs import duration_words
from skisnow.web.studies import CARVE_S, Studies, StudyJob, estimate_words, measured_slowness, unit_s
from skisnow.web.study_fields import CARVE, MOST_POINTS, Range, StudyQuestion, study_keys

TURNS = StudyQuestion(
    CARVE,
    {"edge_angle_deg": Range(10.0, 70.0, 3), "H_V_N_per_mm3": Range(0.1, 10.0, 3, log=True)},
    {"ski": "slalom", "load_N": 800.0, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")},
    unit_s=CARVE_S,
)
RUNS = StudyQuestion(
    "carved-46m",
    {"start.speed_m_per_s": Range(6.0, 9.0, 2)},
    {"run.duration_s": 0.1, "ski.name": "slalom", "sledge.inertia_kg_m2": (6.0, 8.0, 10.0)},
    method="accurate",
    unit_s=0.1,
)


def test_its_file_asks_for_the_same_points(tmp_path: Path) -> None:
    for asked in (TURNS, RUNS):
        (tmp_path / "study.toml").write_bytes(asked.files()["study.toml"])
        study = read_study(tmp_path / "study.toml")
        assert study.varied == tuple(asked.varied)
        assert {name: study.points[0][name] for name in asked.fixed} == dict(asked.fixed)
    (tmp_path / "study.toml").write_text(TURNS.text(), encoding="utf-8")
    points = read_study(tmp_path / "study.toml").points
    assert [(each["edge_angle_deg"], round(each["H_V_N_per_mm3"], 9)) for each in points] == [
        (angle, hardness) for angle in (10.0, 40.0, 70.0) for hardness in (0.1, 1.0, 10.0)
    ]


def test_studies_wait_in_their_order_and_go_on_after_they_were_cancelled(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    first, second = studies.ask_for(TURNS), studies.ask_for(RUNS)
    assert [(job.name, job.points) for job in Studies(tmp_path).study_jobs()] == [(second.name, 2), (first.name, 9)]
    with raises(ParameterError, "not_stopped"):
        studies.go_on(first.name)
    studies.cancel(first.name)
    assert [job.state for job in studies.jobs()] == ["waiting", "cancelled"]
    studies.go_on(first.name)
    assert [job.state for job in studies.jobs()] == ["waiting", "waiting"]
    assert "Edge angle ϑ (°): 10 to 70, 3 values; Snow hardness H_V (N/mm³): 0.1 to 10" in first.given
    with raises(ParameterError, "unknown_file"):
        studies.file(first.name, "table.csv")
    for stranger in ("../skis", first.name):
        with raises(ParameterError, "unknown_file"):
            studies.file(stranger, "job.json")


def test_what_cannot_be_a_study_is_refused_and_leaves_nothing(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    large = Range(10.0, 70.0, MOST_POINTS + 1)
    for asked, said in (
        (StudyQuestion(CARVE, {"load_N": Range(1.0, 2.0, 2)}, {"ski": "no-such"}), "edge_angle_deg is missing|no ski"),
        (StudyQuestion(CARVE, {"edge_angle_deg": large}, dict(TURNS.fixed) | {"H_V_N_per_mm3": 0.2}), "at most 10000"),
        (StudyQuestion("carved-46m", RUNS.varied, {"run.duration_s": -1.0}), "fixed.run.duration_s is -1"),
    ):
        with pytest.raises(ParameterError, match=said) as refused:
            studies.ask_for(asked)
        assert str(tmp_path) not in str(refused.value)
    assert list((tmp_path / "studies").iterdir()) == []


def test_a_scheduler_computes_in_place_of_processes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    here, there = Studies(tmp_path), Studies(tmp_path, "tcp://host:8786")
    job = here.ask_for(TURNS)
    assert "--workers" in here._command(job)
    assert here._command(here.ask_for(TURNS, "de"))[-4:-1] == ["--language", "de", "--figure"]
    assert here.workers >= 1
    assert there._command(job)[2:4] == ["--scheduler", "tcp://host:8786"]
    assert "--workers" not in there._command(job)
    assert there.workers == 0
    words = [
        estimate_words(each, tmp_path, [], points=100_000, method="", unit=unit_s(CARVE, {})) for each in (here, there)
    ]
    assert words[0].startswith("100000 points. Will take about ")
    assert (
        words[1]
        == f"100000 points, about {duration_words(1e5 * CARVE_S)} of one core, shared by the workers of tcp://host:8786."
    )
    assert main(["serve", "--scheduler", "nowhere", "--store", str(tmp_path / "store.sqlite3")]) == 1
    assert "'nowhere'" in capsys.readouterr().err


def test_the_time_of_a_study_is_learned_from_those_before() -> None:
    def done(points: int, took_s: float, workers: int = 2) -> StudyJob:
        return StudyJob("a", CARVE, {}, "2026", state="done", took_s=took_s, points=points, workers=workers, unit_s=0.5)

    assert measured_slowness([], "") is None
    assert (
        measured_slowness([done(10, 1.0), done(10, 100.0, workers=0)], "") is None
    )  # a start is no measure, nor another machine
    assert measured_slowness([done(100, 108.0), done(100, 58.0)], "") == pytest.approx((100.0 + 50.0) * 2 / 100.0)
    assert measured_slowness([done(100, 108.0)], "fast") is None


def test_every_number_of_a_carved_turn_and_of_a_scenario_can_vary() -> None:
    assert {"edge_angle_deg", "load_N", "H_V_N_per_mm3", "S_f_N_per_mm2", "unloading_ratio"} <= set(study_keys(CARVE))
    assert {"slope.angle_deg", "friction.mu_0"} <= set(study_keys("carved-46m"))
    assert all(key.label for key in study_keys(CARVE).values())


def test_the_job_is_kept_as_it_was_asked(tmp_path: Path) -> None:
    studies = Studies(tmp_path)
    job = studies.ask_for(RUNS)
    kept = json.loads((tmp_path / "studies" / job.name / "job.json").read_text(encoding="utf-8"))
    assert kept["scenario"] == "carved-46m"
    assert kept["points"] == 2
    assert kept["changes"] == {"run.duration_s": "0.1"}
