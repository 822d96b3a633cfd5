"""Studies of simulated runs. The simulator itself is replaced by a straight run in closed form."""

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from skisnow import Run, Scenario
from skisnow._support.errors import ParameterError
from skisnow.scenario import scenario_text
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.studies import read_study, read_table, run_study
from skisnow.studies.subjects import RUN_RESULTS
from tests.coded import raises
from tests.key_names import GREATEST_EDGE_DEPTH

from ..simulation.straight_run import straight_run

TEXT = """
scenario = "carved-46m"
out = "runs.csv"
[fixed]
run.duration_s = 2
start = { speed_m_per_s = 5, heading_deg = 0 }
drag_area_m2 = 0
sledge.inertia_kg_m2 = [5, 6, 7]
[grid]
slope.angle_deg = [0, 10]
"friction.mu_0" = { from = 0, to = 0.1, n = 3 }
"""


@pytest.fixture(autouse=True)
def replaced(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[..., Run]], None]:
    def put(simulate: Callable[..., Run]) -> None:
        module = ModuleType("skisnow.simulation.simulated_run")
        vars(module)["simulate"] = simulate
        monkeypatch.setitem(sys.modules, "skisnow.simulation.simulated_run", module)

    put(straight_run)
    return put


def study_file(folder: Path, text: str = TEXT) -> Path:
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_rows_are_the_runs_in_the_order_of_the_grid(tmp_path: Path) -> None:
    study = read_study(study_file(tmp_path))
    assert study.varied == ("slope.angle_deg", "friction.mu_0")
    table = run_study(study, workers=1)
    varied = [(row["slope.angle_deg"], row["friction.mu_0"]) for row in table.rows]
    assert varied == [(angle, mu) for angle in (0.0, 10.0) for mu in (0.0, 0.05, 0.1)]
    row = table.rows[4]
    speed = 5.0 + 2.0 * 9.81 * (0.17364817766693033 - 0.05 * 0.984807753012208)
    assert row["end_speed_m_per_s"] == row["greatest_speed_m_per_s"] == pytest.approx(speed, rel=1e-12)
    assert row["run_length_m"] == row["end_x_m"] == pytest.approx(speed + 5.0, rel=1e-12)  # mean speed over 2 s
    assert (row["outcome"], row["simulated_s"], row["least_turn_radius_m"]) == ("finished", 2.0, None)
    assert row[GREATEST_EDGE_DEPTH] == pytest.approx(8.0, rel=1e-12)
    assert row["energy_balance_error"] < 1e-12
    assert row["sledge.inertia_kg_m2"] == [5.0, 6.0, 7.0]
    assert row["snow.H_V_N_per_mm3"] == 0.2  # of the scenario


def test_table_has_every_key_and_comes_back_as_it_was(tmp_path: Path) -> None:
    study = read_study(study_file(tmp_path))
    table = run_study(study, workers=1)
    back = read_table(study.out, study.subject.keys, varied=study.varied)
    assert back.columns == table.columns == (*SCENARIO_KEYS, *RUN_RESULTS, "study")
    assert back.rows == table.rows


@pytest.mark.slow
def test_two_workers_write_the_bytes_of_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the simulator itself: workers are separate processes."""
    monkeypatch.delitem(sys.modules, "skisnow.simulation.simulated_run")
    tables = []
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        folder.mkdir()
        path = study_file(folder, TEXT.replace("duration_s = 2", "duration_s = 0.03").replace("[0, 10]", "[10]"))
        run_study(read_study(path), workers=workers)
        tables.append((folder / "runs.csv").read_bytes())
    assert tables[0] == tables[1]
    assert tables[0].count(b"finished") == 3


def test_study_without_one_good_point_is_rejected_before_the_work(tmp_path: Path) -> None:
    text = TEXT.replace("[0, 10]", "[80, 81]")
    with raises(ParameterError, "out_of_range", name="slope.angle_deg"):
        read_study(study_file(tmp_path, text))


def test_bad_points_have_their_reason_and_stop_nothing(tmp_path: Path) -> None:
    table = run_study(read_study(study_file(tmp_path, TEXT.replace("[0, 10]", "[80, 10]"))), workers=1)
    assert [row["outcome"] for row in table.rows] == ["error"] * 3 + ["finished"] * 3
    assert "from 0 to 75" in table.rows[0]["reason"]
    assert table.rows[0]["sledge.mass_kg"] == 80.0


def test_interruption_ends_the_whole_study(tmp_path: Path, replaced: Callable[[Callable[..., Run]], None]) -> None:
    study = read_study(study_file(tmp_path))
    asked: list[Scenario] = []

    def third(scenario: Scenario) -> Run:
        asked.append(scenario)
        return straight_run(scenario, outcome="interrupted" if len(asked) == 3 else "finished")

    replaced(third)
    with pytest.raises(KeyboardInterrupt):
        run_study(study, workers=1)
    assert study.partial.is_file()
    replaced(lambda scenario: asked.append(scenario) or straight_run(scenario))  # type: ignore[func-returns-value, redundant-expr]
    table = run_study(study, workers=1)
    assert len(asked) == 3 + 4  # two were kept
    assert [row["outcome"] for row in table.rows] == ["finished"] * 6


def test_points_that_name_another_snow_replace_the_scenarios(tmp_path: Path) -> None:
    text = TEXT.replace("slope.angle_deg = [0, 10]", 'snow.published = ["race-piste", "spring-snow"]')
    rows = run_study(read_study(study_file(tmp_path, text)), workers=1).rows
    assert {row["snow.published"]: round(row["snow.H_V_N_per_mm3"], 4) for row in rows} == {
        "race-piste": 0.2067,
        "spring-snow": 0.0219,
    }


def test_three_numbers_vary_as_a_list_of_lists(tmp_path: Path) -> None:
    text = TEXT.replace("slope.angle_deg = [0, 10]", "inertia_kg_m2 = [[5, 6, 7], [6, 7, 8]]").replace(
        "sledge.inertia_kg_m2 = [5, 6, 7]\n", ""
    )
    rows = run_study(read_study(study_file(tmp_path, text)), workers=1).rows
    assert [row["sledge.inertia_kg_m2"] for row in rows[::3]] == [[5.0, 6.0, 7.0], [6.0, 7.0, 8.0]]


def test_scenario_of_a_file_and_files_of_points_count_in_the_fingerprint(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(scenario_text("carved-46m"), encoding="utf-8")
    (tmp_path / "down.csv").write_text("x,y\n" + "".join(f"{x},{-x}\n" for x in range(8)), encoding="utf-8")
    text = TEXT.replace('"carved-46m"', '"mine.toml"').replace(
        "slope.angle_deg = [0, 10]", 'slope.profile = ["down.csv"]'
    )
    path = study_file(tmp_path, text.replace("drag_area_m2 = 0", 'drag_area_m2 = 0\nslope.kind = "profile"'))
    study = read_study(path)
    assert study.subject.files(study.points) == [tmp_path / "mine.toml", tmp_path / "down.csv"]
    before = study.fingerprint()
    assert read_study(path).fingerprint() == before
    (tmp_path / "mine.toml").write_text(scenario_text("carved-46m").replace("80.0", "81.0"), encoding="utf-8")
    assert read_study(path).fingerprint() != before


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"carved-46m"', '"carved-46"', "carved-46"),
        ('"carved-46m"', "3", "scenario is 3"),
        ("drag_area_m2", "drag_aria_m2", "drag.drag_area_m2?"),
        ("drag_area_m2 = 0", "drag_area_m2 = 0\ndrag = { drag_area_m2 = 1 }", "given twice"),
        ("drag_area_m2 = 0", "drag_area_m2 = -1", "drag_area_m2 is -1"),
        ("drag_area_m2 = 0", "drag_area_m2 = 0\nski.name = 'slalon'", "slalom?"),
        ("slope.angle_deg", "duration_s", "in [grid] and in [fixed]"),
        ("[5, 6, 7]", "[[5, 6, 7], [6, 7, 8]]", "[a, b, c]"),
    ],
)
def test_mistakes_are_reported(tmp_path: Path, old: str, new: str, told: str) -> None:
    with pytest.raises(ParameterError) as error:
        read_study(study_file(tmp_path, TEXT.replace(old, new)))
    assert told in str(error.value)


def test_maps_are_of_carved_turns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from skisnow.cli import main

    assert main(["study", str(study_file(tmp_path)), "--figure", str(tmp_path / "map.png")]) == 1
    assert "--figure" in capsys.readouterr().err
