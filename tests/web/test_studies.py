"""A study that is requested in the lab is one of the command: its file, its queue, what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow._support.errors import ParameterError
from skisnow.studies import read_study
from skisnow.web.studies import CARVE_S, Studies
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


def test_every_number_of_a_carved_turn_and_of_a_scenario_can_vary() -> None:
    assert {"edge_angle_deg", "load_N", "H_V_N_per_mm3", "S_f_N_per_mm2", "unloading_ratio"} <= set(study_keys(CARVE))
    assert {"slope.angle_deg", "friction.mu_0"} <= set(study_keys("carved-46m"))
    assert all(key.label for key in study_keys(CARVE).values())
