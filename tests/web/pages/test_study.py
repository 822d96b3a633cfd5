"""*Study*: what is asked for, what is refused, how long it takes, and what a study has found."""

from __future__ import annotations

import io
import json
import tomllib
import zipfile
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from skisnow.errors import ParameterError
from skisnow.estimate import analyse, results_dict
from skisnow.estimate.results_text import results_json
from skisnow.field import read_campaign
from skisnow.inputs import Quantity
from skisnow.report.number_formatting import significant
from skisnow.scenario import scenario_names
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.ski import read_ski, ski_names
from skisnow.study import read_study
from skisnow.web import studies as queue
from skisnow.web.lab_skis import LabSkis
from skisnow.web.pages import study as study_page
from skisnow.web.studies import Studies, StudyJob
from skisnow.web.study_asked import CARVE, Range, StudyAsked, most_points_refused, study_keys
from skisnow.web.study_axis import begins

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from .desk import Desk, Sheet

OF, FIRST, SECOND = "What is studied", "First input", "Second input"
FROM, TO, VALUES, LOG = (f"{FIRST}: {each}" for each in ("from", "to", "number of values", "even in the logarithm"))
FROM_2, TO_2, VALUES_2 = (f"{SECOND}: {each}" for each in ("from", "to", "number of values"))
ANGLE, LOAD, RATIO = "Edge angle ϑ (°)", "Load (N)", "Unloading ratio k_u/H_V"
HARDNESS, STRESS = "Snow hardness H_V (N/mm³)", "Failure shear stress S_f (N/mm²)"
ENDS, WAY, SPEED = "Ends after (s)", "Ends after a way of (m)", "Speed at the start v (m/s)"
BUTTON = "button[main] Start the study"
OF_CARVES = {
    "turn_radius_boot_m": "Carved radius (m)",
    "side_force_N": "Side force (N)",
    "side_force_limit_N": "Shear capacity of the snow (N)",
    "contact_length_m": "Contact length (m)",
    "greatest_edge_depth_mm": "Greatest depth of the edge (mm)",
}
OF_RUNS = {
    "run_length_m": "Length of the run (m)",
    "simulated_s": "Simulated time (s)",
    "end_speed_m_per_s": "Speed at the end (m/s)",
    "turn_radius_median_m": "Median turn radius (m)",
    "greatest_edge_depth_mm": "Greatest depth of the edge (mm)",
    "lost_friction_J": "Energy lost to friction (J)",
}
TURN = {"ski": "carver", "load_N": 800.0, "H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5, "unloading_ratio": 10.0}
CAMPAIGN = """name = "Desk"
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[plate]]
name = "blade"
length_mm = 100
"""
PENETRATION = "experiment,site,tool,edge_angle_deg,load_N,depth_mm\n" + "".join(
    f"{name},{site},ski piece,30,{load},{depth}\n"
    for name, site, depths in (("1", "A", (1.5, 2.1, 2.6)), ("2", "B", (1.0, 1.4, 1.7)))
    for load, depth in zip((20, 40, 60), depths, strict=True)
)


@pytest.fixture(autouse=True)
def _three_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of which compute."""
    monkeypatch.setattr(queue, "available_cores", lambda: 3)


def jobs(desk: Desk) -> list[dict[str, Any]]:
    """What the queue holds, the newest first."""
    found = [json.loads(place.read_text(encoding="utf-8")) for place in desk.lab.runs.glob("studies/*/job.json")]
    return sorted(found, key=lambda job: str(job["asked_at"]), reverse=True)


def asked(desk: Desk, page: Sheet) -> tuple[dict[str, Any], dict[str, Any]]:
    """Press the button; the job and the file of the study."""
    before = len(jobs(desk))
    page.press("Start the study")
    page.until(lambda: len(jobs(desk)) > before)
    job = jobs(desk)[0]
    page.shows(f"[status] {job['name']} is in the queue.")
    return job, tomllib.loads((desk.lab.runs / "studies" / job["name"] / "study.toml").read_text(encoding="utf-8"))


def refused(desk: Desk, page: Sheet) -> str:
    """Press the button; why nothing was begun."""
    page.press("Start the study")
    told = page.shows("[status bad] Not begun: ")
    assert jobs(desk) == []
    return told.removeprefix("[status bad] Not begun: ")


def estimate(page: Sheet) -> str:
    """What stands behind the button; nothing where nothing does."""
    lines = page.outline()
    line = lines[lines.index(BUTTON) + 1]
    return line.removeprefix("[quiet] ") if line.startswith("[quiet] ") else ""


def scenario(desk: Desk, name: str = "carved-46m") -> Sheet:
    page = desk.open("/study")
    page.fill(OF, name)
    return page


def campaign(desk: Desk, folder: Path) -> str:
    """The id of a kept campaign with two sites and no shear test."""
    folder.mkdir()
    (folder / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (folder / "penetration.csv").write_text(PENETRATION, encoding="utf-8")
    return desk.lab.store.add(folder).id


def finished(desk: Desk, what: StudyAsked, rows: Sequence[Mapping[str, object]], **job: object) -> str:
    """The name of a study that is done, with this table."""
    made = Studies(desk.lab.runs).ask_for(what)
    folder = desk.lab.runs / "studies" / made.name
    results = OF_CARVES if what.of == CARVE else OF_RUNS
    columns = [*what.varied, *results, "outcome", "reason", "study"]
    lines = [",".join(str(row.get(name, "")) for name in columns) for row in rows]
    (folder / "table.csv").write_text("\n".join([",".join(columns), *lines, ""]), encoding="utf-8")
    kept = json.loads((folder / "job.json").read_text(encoding="utf-8")) | {"state": "done"} | job
    (folder / "job.json").write_text(json.dumps(kept), encoding="utf-8")
    return made.name


def test_a_study_of_carved_turns_is_asked_about_a_turn(desk: Desk) -> None:
    page = desk.open("/study")
    assert page.outline() == [
        "h1 Study",
        "field What is studied = 'carved-turn'",
        "field Ski = 'carver'",
        "field Snow = 'the numbers below'",
        "h2 What varies",
        "field First input = 'edge_angle_deg'",
        "[quiet range] Allowed: from 0 to 85.",
        f"field {FROM} = '10' numeric",
        f"field {TO} = '70' numeric",
        f"field {VALUES} = '13' numeric",
        f"field {LOG} = False",
        "field Second input = 'nothing'",
        "h2 What is fixed",
        f"field {LOAD} = '800' numeric",
        "[quiet range] Allowed: above 0.",
        f"field {HARDNESS} = '0.2' numeric",
        "[quiet range] Allowed: above 0.",
        f"field {STRESS} = '0.5' numeric",
        "[quiet range] Allowed: above 0.",
        f"field {RATIO} = '10' numeric",
        "[quiet range] Allowed: 1 or more.",
        BUTTON,
        "[quiet] 13 points. Will take about 10 s.",
        "h2 Queue and history",
        "[quiet] Nothing was studied yet.",
    ]
    assert "<title>Study · skisnow</title>" in page.html
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Study"]
    assert [each.props["label"] for each in page.of() if each.props.get("aria-label") in (FROM, TO, VALUES)] == [
        "From", "To", "Number of values",
    ]  # fmt: skip


def test_a_study_of_runs_is_asked_about_its_scenario(desk: Desk) -> None:
    lines = scenario(desk).outline()
    assert lines[:13] == [
        "h1 Study",
        "field What is studied = 'carved-46m'",
        "field Ski = 'as in the scenario'",
        "field Snow = 'the numbers below'",
        "h2 What varies",
        "field First input = 'start.speed_m_per_s'",
        "[quiet range] Allowed: from 0 to 100.",
        f"field {FROM} = '6' numeric",
        f"field {TO} = '12' numeric",
        f"field {VALUES} = '7' numeric",
        f"field {LOG} = False",
        "field Second input = 'nothing'",
        "h2 What is fixed",
    ]
    begin = lines.index("Expert inputs")
    assert [line for line in lines[13:begin] if line.startswith("field ")] == [
        f"field {name} = {value!r} numeric"
        for name, value in {
            HARDNESS: "0.2", STRESS: "0.5", RATIO: "10", "Slope angle α (°)": "10", ANGLE: "30",
            "Mass of the sledge m (kg)": "80", "Heading at the start (°)": "-30", "Friction μ_0": "0.01",
            "Drag area C_d A (m²)": "0.42", ENDS: "5", WAY: "",
        }.items()
    ]  # fmt: skip
    assert [line for line in lines if line.startswith("h3 ")] == [
        f"h3 {words}"
        for words in (
            "Slope", "Snow", "Friction", "Air drag", "Sledge", "Ski", "Course", "Start", "End and output", "Shear",
            "Solver",
        )
    ]  # fmt: skip
    assert lines[-4:] == [
        BUTTON,
        "[quiet] 7 points. Will take about 25 s.",  # 5 s each, two at a time, and 8 s
        "h2 Queue and history",
        "[quiet] Nothing was studied yet.",
    ]
    at = lines.index("h3 Air drag")
    assert lines[at + 1] == "field Density of the air ρ (kg/m³) = '1.2' numeric"


def test_the_menus_name_what_there_is(desk: Desk) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", LabSkis(desk.lab.runs).texts("slalom")[0], "")
    page = desk.open("/study")
    assert page.field(OF).options == {CARVE: "carved turns", **{name: name for name in scenario_names()}}
    assert list(page.field("Ski").options) == [*ski_names(), "mine"]
    of_turns = {
        "edge_angle_deg": ANGLE,
        "load_N": LOAD,
        "H_V_N_per_mm3": HARDNESS,
        "S_f_N_per_mm2": STRESS,
        "unloading_ratio": RATIO,
        "moment_Nm": "Boot moment (N m)",
        "clamp_length_m": "Clamp length (m)",
        "footprint_stiffness_N_per_mm2": "Footprint stiffness (N/mm²)",
        "elements": "Elements",
    }
    assert page.field(FIRST).options == of_turns
    assert page.field(SECOND).options == {"nothing": "nothing", **of_turns}
    page.fill(OF, "carved-46m")
    assert list(page.field("Ski").options) == ["as in the scenario", *ski_names(), "mine"]
    shown = {line[6:].partition(" = ")[0] for line in page.outline() if line.endswith(" numeric")}
    assert set(page.field(FIRST).options.values()) == {each for each in shown if "input: " not in each} | {SPEED}
    assert page.field(SECOND).options == {"nothing": "nothing", **page.field(FIRST).options}
    page.fill(OF, "skier-10deg")
    assert "skier.turns" in page.field(FIRST).options
    page.fill(OF, CARVE)
    assert page.field("Ski").value == "carver"
    assert page.field(FIRST).options == of_turns


def test_nothing_typed_asks_for_turns_over_the_edge_angle(desk: Desk) -> None:
    job, text = asked(desk, desk.open("/study"))
    assert text == {
        "out": "table.csv",
        "fixed": TURN,
        "grid": {"edge_angle_deg": {"from": 10.0, "to": 70.0, "n": 13}},
    }
    assert {key: job[key] for key in job if key not in ("name", "asked_at")} == {
        "scenario": CARVE, "state": "waiting", "said": "", "took_s": 0.0, "language": "en", "points": 13, "workers": 2,
        "changes": {"load_N": "800", "H_V_N_per_mm3": "0.2", "S_f_N_per_mm2": "0.5", "unloading_ratio": "10"},
        "given": f"{ANGLE}: 10 to 70, 13 values; ski: carver", "method": "", "unit_s": 0.03,
    }  # fmt: skip


def test_the_map_is_in_the_language_of_the_page(desk: Desk) -> None:
    page = desk.open("/study", "de")
    page.press("Studie starten")
    page.until(lambda: jobs(desk))
    assert jobs(desk)[0]["language"] == "de"


def test_what_is_typed_is_asked_for(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(FROM, "10,5")
    page.fill(VALUES, "3")
    page.fill(SECOND, "H_V_N_per_mm3")
    page.fill(f"{SECOND}: even in the logarithm", True)
    page.fill(VALUES_2, "4")
    page.fill(LOAD, "600,5")
    page.fill(RATIO, "inf")
    assert not [line for line in page.outline() if line.startswith(f"field {HARDNESS}")]
    assert estimate(page) == "12 points. Will take about 10 s."
    job, text = asked(desk, page)
    assert text["grid"] == {
        "edge_angle_deg": {"from": 10.5, "to": 70.0, "n": 3},
        "H_V_N_per_mm3": {"from": 0.1, "to": 10.0, "n": 4, "log": True},
    }
    infinite = {"ski": "carver", "load_N": 600.5, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")}
    assert text["fixed"] == infinite
    assert job["given"] == f"{ANGLE}: 10.5 to 70, 3 values; {HARDNESS}: 0.1 to 10, 4 values, logarithmic; ski: carver"
    assert job["points"] == 12


def test_another_input_begins_anew(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(FROM, "20")
    page.fill(FIRST, "load_N")
    lines = page.outline()
    assert lines[5:10] == [
        "field First input = 'load_N'", "[quiet range] Allowed: above 0.", f"field {FROM} = '400' numeric",
        f"field {TO} = '1200' numeric", f"field {VALUES} = '13' numeric",
    ]  # fmt: skip
    assert f"field {ANGLE} = '45' numeric" in lines
    assert not [line for line in lines if line.startswith(f"field {LOAD}")]
    page.fill(FIRST, "footprint_stiffness_N_per_mm2")
    assert [f"field {name} = '' numeric" in page.outline() for name in (FROM, TO)] == [True, True]
    page.fill(SECOND, "load_N")
    at = page.outline().index("field Second input = 'load_N'")
    assert page.outline()[at + 1 : at + 6] == [
        "[quiet range] Allowed: above 0.", f"field {FROM_2} = '400' numeric", f"field {TO_2} = '1200' numeric",
        f"field {VALUES_2} = '10' numeric", "field Second input: even in the logarithm = False",
    ]  # fmt: skip
    page.fill(SECOND, "nothing")
    lines = page.outline()
    assert lines[lines.index("field Second input = 'nothing'") + 1] == "h2 What is fixed"


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        ({FROM: ""}, f"{ANGLE}: type both ends of what it goes through"),
        ({TO: " "}, f"{ANGLE}: type both ends of what it goes through"),
        ({FROM: "a"}, f"{ANGLE}, the lower end: 'a' is no number. Correct it"),
        ({TO: "inf"}, f"{ANGLE}, the upper end: 'inf' is no number. Correct it"),
        ({TO: "88"}, f"{ANGLE} is 88.0; allowed is from 0 to 85 °"),
        ({FROM: "-1"}, f"{ANGLE} is -1.0; allowed is from 0 to 85 °"),
        ({FROM: "70"}, f"{ANGLE}: it goes from 70 to 70; the first end must be the smaller one"),
        ({FROM: "0", LOG: True}, f"{ANGLE}: even in the logarithm, it must begin above 0; it begins at 0"),
        ({VALUES: "1"}, f"{ANGLE}: the number of values is '1'; it must be from 2 to 10000"),
        ({VALUES: "2,5"}, f"{ANGLE}: the number of values is '2.5'; it must be from 2 to 10000"),
        ({VALUES: ""}, f"{ANGLE}: the number of values is ''; it must be from 2 to 10000"),
        ({SECOND: "edge_angle_deg"}, "the first and the second input are the same; choose another one"),
        ({LOAD: ""}, f"{LOAD} is empty; a turn usually has 800"),
        ({LOAD: "x"}, f"{LOAD}: 'x' is no number. Correct it"),
        ({LOAD: "0"}, f"{LOAD} is 0.0; allowed is above 0 N"),
        ({VALUES: "10001"}, f"{ANGLE}: the number of values is '10001'; it must be from 2 to 10000"),
        ({VALUES: "1" * 5000}, f"{ANGLE}: the number of values is '1111"),
        (
            {VALUES: "1001", SECOND: "load_N"},
            "the study has 10010 points; the lab takes at most 10000. Take fewer values, or the command skisnow study, "
            "which takes a million",
        ),
        (
            {FIRST: "H_V_N_per_mm3", "Snow": "published-glacier"},
            f"{HARDNESS} varies and the chosen snow gives it; choose the numbers below as the snow",
        ),
        ({FIRST: "elements", FROM: "4.5", TO: "10"}, "Elements is 4.5; it must be a whole number"),
    ],
)
def test_what_cannot_be_studied_is_refused(desk: Desk, typed: dict[str, Any], told: str) -> None:
    page = desk.open("/study")
    for name, value in typed.items():
        page.fill(name, value)
    assert refused(desk, page).startswith(told)


def test_a_refusal_is_gone_when_the_study_is_in_the_queue(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(LOAD, "0")
    refused(desk, page)
    assert page.shows(f"field {LOAD}").endswith(f"numeric ! {LOAD} is 0.0; allowed is above 0 N")
    page.fill(LOAD, "800")
    asked(desk, page)
    assert not [line for line in page.outline() if "bad" in line or " ! " in line]


def test_as_many_points_as_the_lab_takes_are_taken(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(VALUES, "2")
    page.fill(SECOND, "load_N")
    page.fill(VALUES_2, "5000")
    assert asked(desk, page)[0]["points"] == 10_000
    most_points_refused(10_000)
    with pytest.raises(ParameterError, match="has 10001 points"):
        most_points_refused(10_001)


def test_a_whole_number_varies_as_one(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(FIRST, "elements")
    assert page.outline()[6:9] == [
        "[quiet range] Allowed: whole numbers from 4 to 4000.",
        f"field {FROM} = '80' numeric",
        f"field {TO} = '320' numeric",
    ]
    page.fill(FROM, "40")
    page.fill(VALUES, "2")
    job, _ = asked(desk, page)
    points = read_study(desk.lab.runs / "studies" / job["name"] / "study.toml").points
    assert [point["elements"] for point in points] == [40, 320]
    page.fill(FROM, "3")
    page.press("Start the study")
    page.shows("[status bad] Not begun: Elements is 3; ")


@pytest.mark.parametrize(
    ("key", "ends"),
    [
        (Quantity("a.mass_kg", ""), (60.0, 120.0)),
        (Quantity("w", "", default=2.0), (1.0, 4.0)),
        (Quantity("w", "", default=2.0, lowest=1.5, highest=3.0), (1.5, 3.0)),
        (Quantity("w", "", default=0.0, usual=(1.0, 2.0)), (1.0, 2.0)),
        (Quantity("w", "", default=1.0, usual=(1.0, 3.0)), (0.5, 2.0)),
        (Quantity("w", "", usual=(1.0, 2.0)), (1.0, 2.0)),
        (Quantity("w", "", default=True, kind="switch"), None),
        (Quantity("n", "", default=5, kind="whole number"), (3.0, 10.0)),
        (Quantity("n", "", default=5, highest=7.5, kind="whole number"), (3.0, 7.0)),
        (Quantity("n", "", default=1, lowest=1.0, highest=1.0), None),
        (Quantity("w", "", default=1e308), None),
    ],
)
def test_an_input_begins_around_what_it_usually_is(key: Quantity, ends: tuple[float, float] | None) -> None:
    assert begins(key) == ends


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("edge_angle_deg", ("10", "70")),
        ("load_N", ("400", "1200")),
        ("H_V_N_per_mm3", ("0.1", "10")),
        ("S_f_N_per_mm2", ("0.05", "0.5")),
        ("unloading_ratio", ("1", "50")),
        ("moment_Nm", ("-50", "50")),
    ],
)
def test_what_varies_of_a_turn_has_ends_to_begin_with(desk: Desk, name: str, ends: tuple[str, str]) -> None:
    page = desk.open("/study")
    page.fill(SECOND, name)
    assert (page.field(FROM_2).value, page.field(TO_2).value) == ends
    assert begins(study_keys(CARVE)[name]) == tuple(map(float, ends))


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("start.speed_m_per_s", (6.0, 12.0)),
        ("slope.angle_deg", (5.0, 20.0)),
        ("friction.mu_0", (0.02, 0.1)),
        ("drag.drag_area_m2", (0.3, 0.8)),
        ("sledge.mass_kg", (60.0, 120.0)),
    ],
)
def test_what_varies_of_a_run_has_ends_to_begin_with(name: str, ends: tuple[float, float]) -> None:
    assert begins(SCENARIO_KEYS[name]) == ends


@pytest.mark.parametrize(
    ("typed", "told"),
    [
        ({VALUES: "14"}, "14 points. Will take about 45 s."),  # 43 s
        ({WAY: "18"}, "7 points. Will take about 15 s."),  # 2 s at 9 m/s, the middle
        ({WAY: "18", ENDS: ""}, "7 points. Will take about 15 s."),
        ({WAY: "90"}, "7 points. Will take about 25 s."),
        ({TO: "30", WAY: "18"}, "7 points. Will take about 10 s."),  # 1 s
        ({FIRST: "sledge.mass_kg", WAY: "14"}, "7 points. Will take about 15 s."),  # 2 s at 7 m/s
        ({FIRST: "run.duration_s", FROM: "10", TO: "30"}, "7 points. Will take about 80 s."),
        ({SECOND: "run.duration_s", FROM_2: "10", TO_2: "30"}, "70 points. Will take about 12 min."),
        ({ENDS: "1,5"}, "7 points. Will take about 15 s."),
        ({ENDS: "x"}, "7 points."),
        ({ENDS: ""}, "7 points."),
        ({ENDS: "inf"}, "7 points."),
        ({ENDS: "nan"}, "7 points."),
        ({FROM: ""}, "7 points."),
        ({VALUES: "x"}, ""),
        ({VALUES: "1" * 400}, ""),
    ],
)
def test_how_long_it_takes_follows_what_is_typed(desk: Desk, typed: dict[str, Any], told: str) -> None:
    page = scenario(desk)
    for name, value in typed.items():
        page.fill(name, value)
    assert estimate(page) == told


def test_how_long_it_takes_is_learned_from_studies_with_the_method(desk: Desk) -> None:
    """4 points of 5 s on two cores in 28 s, 8 of them around: 2 s for each second."""
    page = scenario(desk)
    page.fill("Method", "fast")
    page.fill(VALUES, "4")
    asked(desk, page)
    place = next(desk.lab.runs.glob("studies/*/job.json"))
    job = json.loads(place.read_text(encoding="utf-8"))
    assert (job["method"], job["unit_s"]) == ("fast", 5.0)
    place.write_text(json.dumps(job | {"state": "done", "took_s": 28.0}), encoding="utf-8")
    page.fill(VALUES, "10")
    assert estimate(page) == "10 points. Will take about 60 s."  # 58 s
    page.fill("Method", "default")
    assert estimate(page) == "10 points. Will take about 35 s."  # 33 s


def test_how_long_it_takes_is_learned_from_runs_where_no_study_tells_it(desk: Desk) -> None:
    place = desk.lab.runs / "before"
    place.mkdir()
    job = {"name": "before", "scenario": "a", "changes": {}, "asked_at": "2026", "state": "done", "took_s": 6.0}
    (place / "job.json").write_text(json.dumps(job), encoding="utf-8")
    summary = {"wall_s": 6.0, "simulated_s": 2.0, "scenario": {"solver": {"method": "default"}}}
    (place / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    assert estimate(scenario(desk)) == "7 points. Will take about 60 s."  # 7 * 5 * 3 / 2 + 8


def test_workers_elsewhere_are_told(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Studies, "elsewhere", "tcp://host:1")
    page = scenario(desk)
    lines = page.outline()
    assert lines[lines.index(BUTTON) + 1 :][:2] == [
        "[quiet] 7 points, about 35 s of one core, shared by the workers of tcp://host:1.",
        "[quiet] The workers of tcp://host:1 compute.",
    ]


def test_of_a_scenario_only_what_is_changed_is_fixed(desk: Desk) -> None:
    page = scenario(desk)
    job, text = asked(desk, page)
    assert text == {
        "out": "table.csv",
        "scenario": "carved-46m",
        "fixed": {},
        "grid": {"start.speed_m_per_s": {"from": 6.0, "to": 12.0, "n": 7}},
    }
    assert [job[key] for key in ("changes", "given", "method", "unit_s", "points")] == [
        {}, f"{SPEED}: 6 to 12, 7 values", "default", 5.0, 7,
    ]  # fmt: skip
    page.fill("Mass of the sledge m (kg)", "90,5")
    page.fill("Moments of inertia I (kg m²)", "[6, 8, 11]")
    page.fill("Fixed time step", True)
    page.fill("Law of shear", "by-angle")
    job, text = asked(desk, page)
    assert text["fixed"] == {
        "sledge.mass_kg": 90.5, "sledge.inertia_kg_m2": [6.0, 8.0, 11.0], "shear.law": "by-angle", "solver.fixed": True,
    }  # fmt: skip
    assert job["changes"] == {"sledge.mass_kg": "90.5"}


@pytest.mark.parametrize(
    ("typed", "fixed"),
    [
        ({HARDNESS: "0.3"}, {"snow.H_V_N_per_mm3": 0.3, "snow.S_f_N_per_mm2": 0.5}),
        ({STRESS: "0.3"}, {"snow.H_V_N_per_mm3": 0.2, "snow.S_f_N_per_mm2": 0.3}),
        ({FIRST: "snow.H_V_N_per_mm3"}, {"snow.S_f_N_per_mm2": 0.5}),
        ({SECOND: "snow.S_f_N_per_mm2"}, {"snow.H_V_N_per_mm3": 0.2}),
        ({RATIO: "11"}, {"snow.unloading_ratio": 11.0}),
    ],
)
def test_of_the_two_numbers_of_the_snow_both_or_none_are_given(
    desk: Desk, typed: dict[str, str], fixed: dict[str, float]
) -> None:
    page = scenario(desk)
    for name, value in typed.items():
        page.fill(name, value)
    assert asked(desk, page)[1]["fixed"] == fixed


def test_a_value_that_a_scenario_cannot_have_is_refused(desk: Desk) -> None:
    page = scenario(desk)
    page.fill("Stance width (m)", "-5")
    told = "Stance width (m) is -5; allowed is above 0 to 3 m"
    assert refused(desk, page) == told
    assert page.shows("field Stance width (m)").endswith(f" ! {told}")


def test_a_ski_goes_with_the_study(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_texts("mine", skis.texts("slalom")[0], "")
    page = desk.open("/study")
    page.fill("Ski", "mine")
    job, text = asked(desk, page)
    folder = desk.lab.runs / "studies" / job["name"]
    assert text["fixed"]["ski"] == "ski/ski.toml"
    assert (folder / "ski" / "ski.toml").read_text(encoding="utf-8") == skis.texts("mine")[0]
    assert [place.name for place in (folder / "ski").iterdir()] == ["ski.toml"]
    assert job["given"].endswith("; ski: mine")
    assert "ski" not in job["changes"]
    page.fill(OF, "carved-46m")
    page.fill("Ski", "mine")
    assert asked(desk, page)[1]["fixed"] == {"ski.file": "ski/ski.toml"}
    page.fill("Ski", "slalom")
    job, text = asked(desk, page)
    assert (text["fixed"], job["changes"]) == ({"ski.name": "slalom"}, {})
    assert job["given"] == f"{SPEED}: 6 to 12, 7 values; ski: slalom"


def test_the_table_of_a_ski_goes_with_the_study(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_texts("mine", skis.texts("slalom")[0], "")
    ski = read_ski(skis.word("mine"))
    skis.save_ski("tabled", replace(ski, name="tabled"))
    page = desk.open("/study")
    page.fill("Ski", "tabled")
    job, _ = asked(desk, page)
    folder = desk.lab.runs / "studies" / job["name"] / "ski"
    assert (folder / "ski.csv").read_text(encoding="utf-8") == skis.texts("tabled")[1] != ""


def test_a_published_snow_takes_the_place_of_both_numbers(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill("Snow", "published-glacier")
    page.until(lambda: not [line for line in page.outline() if line.startswith((f"field {HARDNESS}", "field Fail"))])
    job, text = asked(desk, page)
    assert text["fixed"] == {"ski": "carver", "load_N": 800.0, "unloading_ratio": 10.0, "published": "glacier"}
    assert job["given"].endswith("; ski: carver; snow: glacier")
    page = scenario(desk)
    page.fill("Snow", "published-glacier")
    page.until(lambda: not [line for line in page.outline() if line.startswith((f"field {HARDNESS}", "field Fail"))])
    assert asked(desk, page)[1]["fixed"] == {"snow.published": "glacier"}


@pytest.mark.parametrize(("of", "lead"), [(CARVE, ""), ("carved-46m", "snow.")])
def test_the_snow_of_a_campaign_goes_with_the_study(desk: Desk, tmp_path: Path, of: str, lead: str) -> None:
    id_ = campaign(desk, tmp_path / "kept")
    page = scenario(desk, of)
    page.fill(STRESS, "0.4")
    page.fill("Snow", f"kept-{id_}")
    page.shows("[snow] Snow: H_V = ")
    page.until(lambda: not [line for line in page.outline() if line.startswith(f"field {HARDNESS}")])
    assert [line for line in page.outline() if line.startswith(f"field {STRESS}")]
    job, text = asked(desk, page)
    snow = {name: value for name, value in text["fixed"].items() if "S_f" in name or "results" in name}
    assert snow == {f"{lead}S_f_N_per_mm2": 0.4, f"{lead}results": "results.json"}
    assert job["given"].endswith(f"; snow: Desk ({id_})")
    kept = desk.lab.runs / "studies" / job["name"] / "results.json"
    library = json.loads(results_json(results_dict(analyse(read_campaign(tmp_path / "kept")))))
    assert json.loads(kept.read_text(encoding="utf-8"))["penetration"] == library["penetration"]
    page.fill("Site", "B")
    page.shows("[snow] Snow: H_V = 0.1")
    job, text = asked(desk, page)
    assert text["fixed"][f"{lead}site"] == "B"
    assert job["given"].endswith(f"; snow: Desk ({id_}), B")


@pytest.mark.parametrize(
    ("state", "further", "lines"),
    [
        ("waiting", {}, ["button Cancel"]),
        ("running", {}, ["[quiet progress] 3 of 13 points", "button Cancel"]),
        ("cancelled", {}, ["button Go on"]),
        ("failed", {"said": "so"}, ["button Go on"]),
        ("done", {"said": "13 points: equilibrium 13."}, ["link[main] Table and figure -> /study/a%20study"]),
        ("done", {"scenario": "carved-46m"}, ["link[main] Table and figure -> /study/a%20study"]),
    ],
)
def test_a_card_shows_how_its_study_stands(desk: Desk, state: Any, further: Any, lines: list[str]) -> None:
    page, studies, pressed = desk.open("/replay"), Studies(desk.lab.runs), list[object]()
    told = {"name": "a study", "scenario": CARVE, "changes": {}, "asked_at": "2026", "given": f"{LOAD}: 4 to 5"}
    job = StudyJob(**told | {"state": state} | further)
    before = len(page.outline())

    def shown() -> None:
        with page.content:
            study_page._Card(studies, job, lambda *what: pressed.append(what)).show(job)

    studies.progress = "3 of 13 points"
    desk.do(shown, page.client)
    words = [further.get("scenario", "carved turns"), f"{LOAD}: 4 to 5", state, *([job.said] if job.said else [])]
    assert page.outline()[before:] == ["h3 a study", f"[quiet] {' · '.join(words)}", *lines]
    if lines[-1] == "button Cancel":
        page.press("Cancel a study")
        assert pressed == [(studies.cancel, "a study")]
    elif lines[-1] == "button Go on":
        page.press("Go on with a study")
        assert pressed == [(studies.go_on, "a study")]
    else:
        assert any(each.props.get("aria-label") == "Table and figure of a study" for each in page.of())


def test_a_study_that_says_nothing_yet_has_no_line_of_progress(desk: Desk) -> None:
    page, studies = desk.open("/replay"), Studies(desk.lab.runs)
    job = StudyJob("a", CARVE, {}, "2026", "running")

    def shown() -> None:
        with page.content:
            study_page._Card(studies, job, lambda *_: None).show(job)

    desk.do(shown, page.client)
    assert page.outline()[-2:] == ["[quiet] carved turns · running", "button Cancel"]


def test_a_study_that_waits_is_cancelled_and_goes_on(desk: Desk) -> None:
    page = desk.open("/study")
    name = asked(desk, page)[0]["name"]
    page = desk.open("/study")
    given = f"{ANGLE}: 10 to 70, 13 values; ski: carver"
    assert page.outline()[-4:] == [
        "h2 Queue and history", f"h3 {name}", f"[quiet] carved turns · {given} · waiting", "button Cancel",
    ]  # fmt: skip
    page.press(f"Cancel {name}")
    assert page.outline()[-2:] == [
        f"[quiet] carved turns · {given} · cancelled · It had not begun.", "button Go on",
    ]  # fmt: skip
    page.press(f"Go on with {name}")
    assert page.outline()[-2:] == [f"[quiet] carved turns · {given} · waiting", "button Cancel"]


def test_the_queue_begins_and_ends_with_the_server(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, ends, made = list[Any](), list[Any](), list[Any]()
    monkeypatch.setattr(f"{study_page.__name__}.app.on_startup", begun.append)
    monkeypatch.setattr(f"{study_page.__name__}.app.on_shutdown", ends.append)
    monkeypatch.setattr(f"{study_page.__name__}.ui.page", lambda path: lambda shown: made.append((path, shown)))
    monkeypatch.setattr(f"{study_page.__name__}.background_tasks.create", lambda work, name: made.append((work, name)))
    study_page.add_page(desk.lab)
    ((path, _),) = made
    assert path == "/study"
    begun[0]()
    work, name = made[1]
    assert (work.__name__, name) == ("work", "studies")
    work.close()
    assert ends[0].__name__ == "end"
    assert isinstance(ends[0].__self__, Studies)


def test_a_table_of_turns_over_one_input(desk: Desk) -> None:
    what = StudyAsked(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 3)}, TURN, named=("ski: carver",))
    rows = [
        {"edge_angle_deg": 70.0, "turn_radius_boot_m": 5.0474, "side_force_N": 2197.98, "outcome": "slips"},
        {"edge_angle_deg": 10.0, "turn_radius_boot_m": 13.0018, "side_force_N": 141.06, "outcome": "equilibrium"},
        {"edge_angle_deg": 40.0, "outcome": "error", "reason": "the ski is none"},
        {"edge_angle_deg": 50.0, "outcome": "not_converged", "reason": "so"},
    ]
    name = finished(desk, what, rows)
    page = desk.open(f"/study/{name}")
    heads = [ANGLE, *OF_CARVES.values(), "Outcome"]
    assert page.outline() == [
        "h1 Study",
        f"[quiet] {ANGLE}: 10 to 70, 3 values; ski: carver",
        f"[quiet] {LOAD}: 800; {HARDNESS}: 0.2; {STRESS}: 0.5; {RATIO}: 10",
        f"link[main] Download everything -> /study/files/{name}/study.zip",
        f"link Download the table -> /study/files/{name}/table.csv",
        "field Result = 'turn_radius_boot_m'",
        f"chart Chart of Carved radius (m) over {ANGLE}: 5.05 to 13.0",
        "h2 Table",
        *heads,
        *("70.0", "5.05", "2198", "–", "–", "–", "slips"),
        *("10.0", "13.0", "141", "–", "–", "–", "equilibrium"),
        *("40.0", "–", "–", "–", "–", "–", "error: the ski is none"),
        *("50.0", "–", "–", "–", "–", "–", "not converged"),
    ]
    chart = page.charts()["Carved radius (m)"]
    assert chart["x"] == ANGLE
    (line,) = chart["lines"]
    assert (line["x"], line["y"]) == ([10.0, 40.0, 50.0, 70.0], [13.002, None, None, 5.047])
    assert (line["style"], line["name"], line["points"]) == (0, "", False)
    assert page.field("Result").options == OF_CARVES
    page.fill("Result", "side_force_N")
    assert list(page.charts()) == ["Side force (N)"]
    assert page.charts()["Side force (N)"]["lines"][0]["y"] == [141.1, None, None, 2198.0]
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Study"]
    place = next(each for each in page.of() if "table" in each.classes)
    assert {key: place.props[key] for key in ("tabindex", "role", "aria-label")} == {
        "tabindex": "0", "role": "region", "aria-label": "Table",
    }  # fmt: skip
    assert [each.props["scope"] for each in page.tagged("th")] == ["col"] * 7
    assert ["n" in each.classes for each in page.tagged("td")] == [*[True] * 6, False] * 4


def test_of_two_inputs_the_one_with_more_values_is_along_the_axis(desk: Desk) -> None:
    """Of five loads the first, the middle and the last are named, over the others."""
    varied = {"load_N": Range(400.0, 800.0, 5), "edge_angle_deg": Range(10.0, 60.0, 6)}
    fixed = {name: value for name, value in TURN.items() if name != "load_N"}
    rows = [
        {"load_N": load, "edge_angle_deg": angle, "turn_radius_boot_m": load / angle, "outcome": "equilibrium"}
        for load in (400.0, 500.0, 600.0, 700.0, 800.123)
        for angle in (60.0, 50.0, 40.0, 30.0, 20.0, 10.0)
    ]
    page = desk.open(f"/study/{finished(desk, StudyAsked(CARVE, varied, fixed), rows)}")
    lines = page.charts()["Carved radius (m)"]["lines"]
    assert page.charts()["Carved radius (m)"]["x"] == ANGLE
    assert [(line["style"], line["name"]) for line in lines] == [
        (3, ""), (3, ""), (0, f"{LOAD}: 400"), (1, f"{LOAD}: 600"), (2, f"{LOAD}: 800.1"),
    ]  # fmt: skip
    angles = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    for line, load in zip(lines, (500.0, 700.0, 400.0, 600.0, 800.123), strict=True):
        assert line["x"] == angles
        assert line["y"] == pytest.approx([load / angle for angle in angles], abs=0.01)
    assert page.tagged("th")[0].slots["default"].children[0].text == LOAD


@pytest.mark.parametrize("first", ["load_N", "elements"])
def test_of_two_inputs_with_as_many_values_the_first_is_along_the_axis(desk: Desk, first: str) -> None:
    both = {"load_N": Range(400.0, 800.0, 2), "elements": Range(40.0, 80.0, 2)}
    varied = {name: both[name] for name in (first, *both)}
    fixed = {name: value for name, value in TURN.items() if name != "load_N"} | {"edge_angle_deg": 45.0}
    rows = [
        {"load_N": load, "elements": elements, "turn_radius_boot_m": 3.0, "outcome": "equilibrium"}
        for load in (400.0, 800.0)
        for elements in (40, 80)
    ]
    page = desk.open(f"/study/{finished(desk, StudyAsked(CARVE, varied, fixed), rows)}")
    chart = page.charts()["Carved radius (m)"]
    assert chart["x"] == {"load_N": LOAD, "elements": "Elements"}[first]
    other = {"load_N": ["Elements: 40", "Elements: 80"], "elements": [f"{LOAD}: 400", f"{LOAD}: 800"]}[first]
    assert [(line["style"], line["name"]) for line in chart["lines"]] == list(enumerate(other))


def test_a_table_of_runs(desk: Desk) -> None:
    what = StudyAsked("carved-46m", {"start.speed_m_per_s": Range(6.0, 9.0, 2)}, {"sledge.mass_kg": 90.0})
    result = {"run_length_m": 30.0, "simulated_s": 5.0, "end_speed_m_per_s": 6.5, "turn_radius_median_m": 12.0}
    rows = [{"start.speed_m_per_s": speed, **result, "outcome": "left_course"} for speed in (6.0, 9.0)]
    page = desk.open(f"/study/{finished(desk, what, rows)}")
    lines = page.outline()
    assert lines[1:3] == [f"[quiet] {SPEED}: 6 to 9, 2 values", "[quiet] Mass of the sledge m (kg): 90"]
    assert lines[5:8] == [
        "field Result = 'run_length_m'", f"chart Chart of Length of the run (m) over {SPEED}: 30.0 to 30.0", "h2 Table",
    ]  # fmt: skip
    assert lines[8:16] == [SPEED, *OF_RUNS.values(), "Outcome"]
    assert lines[16:24] == ["6.00", "30.0", "5.00", "6.50", "12.0", "–", "–", "left course"]
    assert page.field("Result").options == OF_RUNS


@pytest.mark.parametrize("count", [200, 201])
def test_a_long_table_is_shown_in_part(desk: Desk, count: int) -> None:
    rows = [{"edge_angle_deg": 10.0 + n, "outcome": "equilibrium"} for n in range(count)]
    what = StudyAsked(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    page = desk.open(f"/study/{finished(desk, what, rows)}")
    assert len(page.tagged("tr")) == 201
    more = ["[note] The first 200 of 201 rows; the file has all of them and all columns."]
    assert [line for line in page.outline() if line.startswith("[note]")] == (more if count == 201 else [])
    assert (page.outline()[-8:-1] if count == 201 else page.outline()[-7:])[0] == significant(209.0)


@pytest.mark.parametrize(
    ("language", "of_map", "said"),
    [
        ("en", "en", []),
        ("de", "de", []),
        ("en", "de", []),
        ("de", "en", ["[quiet] Figures and the report are in English."]),
    ],
)
def test_the_map_stands_above_the_table(desk: Desk, language: str, of_map: str, said: list[str]) -> None:
    what = StudyAsked(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    name = finished(desk, what, [{"edge_angle_deg": 10.0, "outcome": "equilibrium"}], language=of_map)
    assert desk.open(f"/study/{name}").tagged("img") == []
    (desk.lab.runs / "studies" / name / "map.svg").write_text("<svg/>", encoding="utf-8")
    page = desk.open(f"/study/{name}", language)
    (image,) = page.tagged("img")
    assert image.props["src"] == f"/study/files/{name}/map.svg"
    if language == "en":
        assert image.props["alt"] == "Turn radius over the inputs that vary, as skisnow study draws it"
        (figure,) = page.tagged("figure")
        assert dict(figure.props) == {"tabindex": "0", "role": "region", "aria-label": "Map"}
    assert [line for line in page.outline() if "English" in line] == said


def test_the_files_of_a_study(desk: Desk) -> None:
    what = StudyAsked(CARVE, {"edge_angle_deg": Range(10.0, 70.0, 2)}, TURN)
    name = finished(desk, what, [{"edge_angle_deg": 10.0, "outcome": "equilibrium"}])
    folder = desk.lab.runs / "studies" / name
    (folder / "map.svg").write_text("<svg/>", encoding="utf-8")
    for file, kind in {"study.toml": "application/toml", "table.csv": "text/csv", "map.svg": "image/svg+xml"}.items():
        answer = desk.get(f"/study/files/{name}/{file}")
        assert (answer.status_code, answer.content) == (200, (folder / file).read_bytes())
        assert answer.headers["content-type"].partition(";")[0] == kind
        assert answer.headers["content-security-policy"] == "default-src 'none'; style-src 'unsafe-inline'; sandbox"
    answer = desk.get(f"/study/files/{name}/study.zip")
    assert answer.headers["content-disposition"] == 'attachment; filename="study.zip"'
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as packed:
        assert {each: packed.read(each) for each in packed.namelist()} == {
            f"study/{file}": (folder / file).read_bytes() for file in ("study.toml", "table.csv", "map.svg")
        }


@pytest.mark.parametrize("file", ["job.json", "study.zip", "map.svg"])
def test_a_file_that_is_not_there_is_told(desk: Desk, file: str) -> None:
    name = Studies(desk.lab.runs).ask_for(StudyAsked(CARVE, {"edge_angle_deg": Range(1.0, 7.0, 2)}, TURN)).name
    answer = desk.get(f"/study/files/{name}/{file}")
    assert answer.status_code == 404
    missing = "table.csv" if file == "study.zip" else file
    assert "<h1>This cannot be shown</h1>" in answer.text
    assert f"there is no &#x27;{missing}&#x27; of a study &#x27;{name}&#x27; here. Choose one" in answer.text


def test_a_study_without_a_table_has_no_page_yet(desk: Desk) -> None:
    name = Studies(desk.lab.runs).ask_for(StudyAsked(CARVE, {"edge_angle_deg": Range(1.0, 7.0, 2)}, TURN)).name
    told = f"there is no 'table.csv' of a study '{name}' here. Choose one from the list"
    assert desk.get(f"/study/{name}").status_code == 404
    assert [str(error) for error in desk.failures] == [told]
    desk.failures.clear()


def test_values_stand_in_the_file_as_the_command_reads_them() -> None:
    fixed = {"shear.law": 'a "b" ü', "solver.fixed": True, "sledge.inertia_kg_m2": (6.0, 8.0), "ski.name": "x"}
    what = StudyAsked("carved-46m", {"friction.mu_0": Range(0.1, 1.0, 3, log=True)}, fixed)
    assert what.text() == (
        'out = "table.csv"\nscenario = "carved-46m"\n\n[fixed]\n"shear.law" = "a \\"b\\" ü"\n"solver.fixed" = true\n'
        '"sledge.inertia_kg_m2" = [6.0, 8.0]\n"ski.name" = "x"\n\n[grid]\n'
        '"friction.mu_0" = { from = 0.1, to = 1.0, n = 3, log = true }\n'
    )
    assert what.fixed_words() == {}
    assert what.varied_words() == "Friction μ_0: 0.1 to 1, 3 values, logarithmic"
    assert Range(2.0, 5.0, 3).middle == 3.5
    assert (what.method, what.unit_s, what.named, what.beside) == ("", 0.0, (), {})
    assert what.files() == {"study.toml": what.text().encode()}
