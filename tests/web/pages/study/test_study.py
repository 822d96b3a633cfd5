"""*Study*: what is asked about, and what is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import scenario_names
from skisnow.ski import ski_names
from skisnow.studies import read_study
from skisnow.web.lab_skis import LabSkis
from skisnow.web.study_fields import CARVE, require_few_points
from tests.coded import raises

from .shared import (
    ANGLE,
    BUTTON,
    ENDS,
    FIRST,
    FROM,
    FROM_2,
    HARDNESS,
    LOAD,
    LOG,
    OF,
    RATIO,
    SECOND,
    SPEED,
    STRESS,
    TO,
    TO_2,
    TURN,
    VALUES,
    VALUES_2,
    WAY,
    asked,
    estimate,
    jobs,
    refused,
    scenario,
)

if TYPE_CHECKING:
    from ..desk import Desk


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
        ({FROM: ""}, f"{ANGLE}: type both ends of its range"),
        ({TO: " "}, f"{ANGLE}: type both ends of its range"),
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
    require_few_points(10_000)
    with raises(ParameterError, "too_many_points", points=10001):
        require_few_points(10_001)


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
