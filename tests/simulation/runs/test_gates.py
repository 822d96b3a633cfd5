"""Runs over a course: times from the run's own closed form, outcomes, and files."""

import csv
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import Course, Gate, Run, read_course, time_gates
from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.report.figures.course import edge_angles
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import _through_gates, simulate
from skisnow.track.course import course_names
from tests.coded import coded, raises
from tests.present import present

STRAIGHT = {
    "start.heading_deg": 0.0, "sledge.edge_angle_deg": 0.0, "friction.mu_0": 0.0, "drag.drag_area_m2": 0.0,
    "snow.compaction_resistance": False, "run.duration_s": 2.0, "start.speed_m_per_s": 5.0,
}  # fmt: skip


def gates(*places: tuple[float, float], side: str = "left") -> Course:
    made = (Gate(name=str(i), turning=place, side=side) for i, place in enumerate(places, 1))  # type: ignore[arg-type]
    return Course(gates=tuple(made))


@pytest.fixture(scope="module")
def straight() -> Run:
    """Down the fall line of 10 degrees without friction or drag: x = 5 t + g sin(10°) t²/2."""
    course = gates((4.0, -1.0), (8.0, -1.0), (12.0, -1.0))
    return simulate(load_scenario("carved-46m", changes=STRAIGHT).with_(course=course))


def test_times_of_a_straight_run_are_those_of_free_sliding(straight: Run) -> None:
    """The groove costs a little: the times lie within a hundredth of a second, and of the run's own x far closer."""
    result = time_gates(straight.scenario.course, straight)  # type: ignore[arg-type]
    assert [each.outcome for each in result.passages] == ["passed"] * 3
    pull = 9.81 * math.sin(math.radians(10.0))
    exact = [(math.sqrt(25.0 + 2.0 * pull * x) - 5.0) / pull for x in (4.0, 8.0, 12.0)]
    assert result.times == pytest.approx(exact, abs=0.01)
    times = [each for each in result.times if each is not None]
    np.testing.assert_allclose(np.interp(times, straight.time, straight.place[:, 0]), [4.0, 8.0, 12.0], atol=1e-4)
    # feet at ±0.25 m beside the middle, the pole a metre from it
    assert [each.clearance for each in result.passages] == pytest.approx([0.75] * 3, abs=1e-3)


def test_run_ends_a_metre_behind_the_last_gate(straight: Run) -> None:
    assert straight.outcome == "finished"
    assert 13.0 < straight.place[-1, 0] < 13.2  # rows are 10 ms apart
    assert straight.simulated_s < 2.0


@pytest.mark.parametrize(
    ("y", "side", "outcome", "said"),
    [(0.2, "left", "straddled", "2"), (0.5, "left", "missed_gate", "0.25 m"), (0.5, "right", "finished", "")],
)
def test_outcome_is_that_of_the_first_missed_gate(straight: Run, y: float, side: str, outcome: str, said: str) -> None:
    """A gate of the other side would bend the course; here all poles are in line, one where the feet go."""
    middle = Gate(name="2", turning=(8.0, y), side=side)  # type: ignore[arg-type]
    before, after = (Gate(name=str(i), turning=(x, -1.0), side="left") for i, x in ((1, 4.0), (3, 12.0)))
    run = replace(straight, scenario=straight.scenario.with_(course=Course(gates=(before, middle, after))))
    found = _through_gates(run)
    assert found.outcome == outcome
    assert said in found.remedy


def test_edge_angle_of_the_figure_is_that_of_the_sledge() -> None:
    run = simulate(load_scenario("carved-46m", changes={"run.duration_s": 0.3, "solver.method": "fast"}))
    np.testing.assert_allclose(np.degrees(edge_angles(run)), 30.0, atol=1.5)  # it rolls by a degree in its grooves
    with pytest.raises(ParameterError, match="no course"):
        run.plot("course")


@pytest.mark.usefixtures("undrawn")
def test_folder_of_a_run_has_its_gates(straight: Run, tmp_path: Path) -> None:
    page = straight.report(tmp_path).read_text(encoding="utf-8")
    assert "3 of 3 gates passed" in page
    assert (tmp_path / "figures" / "course.png").is_file()
    rows = list(csv.DictReader((tmp_path / "gates.csv").read_text(encoding="utf-8").splitlines()))
    summary: dict[str, Any] = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert (summary["gates_passed"], summary["gates_missed"]) == (3, [])
    assert summary["gate_times_s"] == [float(row["time_s"]) for row in rows]
    assert float(rows[1]["split_s"]) == pytest.approx(float(rows[1]["time_s"]) - float(rows[0]["time_s"]))
    assert [row["outcome"] for row in rows] == ["passed"] * 3
    through = summary["gate_times_s"][-1] - summary["gate_times_s"][0]
    assert f"<strong>{through:.2f} s</strong> between" in page


def test_a_course_of_the_catalogue_or_of_a_file_is_read_with_the_scenario(tmp_path: Path) -> None:
    for name in course_names():
        course = present(load_scenario("carved-46m", changes={"course.name": name}).course)
        assert len(course.gates) == 20
        assert [gate.turning for gate in course.gates] == [gate.turning for gate in read_course(name).gates]
    (tmp_path / "c.csv").write_text("gate,x_m,y_m,side\n1,4,1,left\n2,9,-1,right\n", encoding="utf-8")
    found = present(load_scenario("carved-46m", changes={"course.file": str(tmp_path / "c.csv")}).course)
    assert [gate.turning for gate in found.gates] == [(4.0, 1.0), (9.0, -1.0)]
    with raises(ParameterError, "contradiction", place="carved-46m"):
        load_scenario("carved-46m", changes={"course.name": name, "course.file": str(tmp_path / "c.csv")})


def test_refusals_of_a_course() -> None:
    for changes, expected in (
        ({"course.name": "slalom-21"}, coded("unknown_name", name="slalom-21", similar="slalom-20-gates")),
        ({"course.file": "none.csv"}, coded("cannot_read", path=Path("none.csv"))),
    ):
        with raises(ParameterError, expected):
            load_scenario("carved-46m", changes=changes)


@pytest.mark.usefixtures("undrawn")
def test_track_with_a_course_on_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A track at 10 m/s and 10 points a second through two gates, and past a third on the wrong side."""
    monkeypatch.setattr("skisnow.track.curvature.estimate_path", lambda *_: None)  # seconds, and only for the speed
    time = np.arange(0.0, 4.0, 0.1)
    rows = "".join(f"{t:.1f},{10.0 * t:.3f},{0.3 * math.sin(t):.4f}\n" for t in time)
    (tmp_path / "track.csv").write_text("time_s,x_m,y_m\n" + rows, encoding="utf-8")
    course = "gate,x_m,y_m,side,outer_x_m,outer_y_m\n1,8,-2,left,8,3\n2,17,2,right,17,-3\n3,25,2,left,25,7\n"
    (tmp_path / "course.csv").write_text(course, encoding="utf-8")
    words = ["track", str(tmp_path / "track.csv"), "--course", str(tmp_path / "course.csv")]
    assert main([*words, "--out", str(tmp_path / "o"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["gates_passed"], told["gates_missed"]) == (2, ["3"])
    assert told["gate_times_s"] == pytest.approx([0.8, 1.7, 2.5], abs=1e-6)
    assert (tmp_path / "o" / "figures" / "course.png").is_file()
    table = (tmp_path / "o" / "gates.csv").read_text(encoding="utf-8")
    assert table.startswith("gate,side,outcome,time_s,")
