"""*Study*: its questions, and refusals."""

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
    refused,
    scenario,
)

if TYPE_CHECKING:
    from ..desk import Desk


def test_a_study_of_carved_turns_is_asked_about_a_turn(desk: Desk) -> None:
    page = desk.open("/study")
    choices = [page.field(name).value for name in (OF, "Ski", FIRST, SECOND)]
    assert choices == ["carved-turn", "carver", "edge_angle_deg", "nothing"]
    assert [page.field(name).value for name in (FROM, TO, VALUES, LOG)] == ["10", "70", "13", False]
    assert [page.field(name).value for name in (LOAD, HARDNESS, STRESS, RATIO)] == ["800", "0.2", "0.5", "10"]
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Study"]


def test_a_study_of_runs_is_asked_about_its_scenario(desk: Desk) -> None:
    page = scenario(desk)
    assert [page.field(name).value for name in (OF, FIRST, SECOND)] == ["carved-46m", "start.speed_m_per_s", "nothing"]
    assert [page.field(name).value for name in (FROM, TO, VALUES, LOG)] == ["6", "12", "7", False]
    assert [page.field(name).value for name in (HARDNESS, ANGLE, ENDS, WAY)] == ["0.2", "30", "5", ""]
    lines = page.outline()
    assert sum(line.startswith("h3 ") for line in lines) == 11
    assert lines[lines.index("h3 Air drag") + 1].endswith(" = '1.2' numeric")


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
        "sidecut_factor": "Factor of the ski's width beyond that of the waist",
        "width_factor": "Factor of the ski's width",
        "EI_factor": "Factor of the ski's bending stiffness EI",
        "GJ_factor": "Factor of the ski's torsional stiffness GJ",
    }
    assert page.field(FIRST).options == of_turns
    assert page.field(SECOND).options == {"nothing": "nothing", **of_turns}
    page.fill(OF, "carved-46m")
    assert list(page.field("Ski").options)[1:] == [*ski_names(), "mine"]
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
    assert text == {"out": "table.csv", "fixed": TURN, "grid": {"edge_angle_deg": {"from": 10.0, "to": 70.0, "n": 13}}}
    kept = {key: job[key] for key in ("scenario", "state", "language", "points", "workers", "method", "unit_s")}
    assert list(kept.values()) == [CARVE, "waiting", "en", 13, 2, "", 0.03]
    assert job["changes"] == {
        "load_N": "800", "H_V_N_per_mm3": "0.2", "S_f_N_per_mm2": "0.5", "unloading_ratio": "10",
    }  # fmt: skip


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
    assert estimate(page).startswith("12 ")
    job, text = asked(desk, page)
    assert text["grid"] == {
        "edge_angle_deg": {"from": 10.5, "to": 70.0, "n": 3},
        "H_V_N_per_mm3": {"from": 0.1, "to": 10.0, "n": 4, "log": True},
    }
    infinite = {"ski": "carver", "load_N": 600.5, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")}
    assert text["fixed"] == infinite
    assert job["points"] == 12


def test_another_input_begins_anew(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(FROM, "20")
    page.fill(FIRST, "load_N")
    assert [page.field(name).value for name in (FROM, TO, VALUES, ANGLE)] == ["400", "1200", "13", "45"]
    lines = page.outline()
    assert not [line for line in lines if line.startswith(f"field {LOAD}")]
    page.fill(FIRST, "footprint_stiffness_N_per_mm2")
    assert [page.field(name).value for name in (FROM, TO)] == ["", ""]
    page.fill(SECOND, "load_N")
    assert [page.field(name).value for name in (FROM_2, TO_2, VALUES_2)] == ["400", "1200", "10"]
    page.fill(SECOND, "nothing")
    assert not any(line.startswith(f"field {FROM_2}") for line in page.outline())


@pytest.mark.parametrize(
    ("typed", "code"),
    [
        ({FROM: ""}, "missing"),
        ({TO: " "}, "missing"),
        ({FROM: "a"}, "not_a_number"),
        ({TO: "inf"}, "not_a_number"),
        ({TO: "88"}, "out_of_range"),
        ({FROM: "-1"}, "out_of_range"),
        ({FROM: "70"}, "not_rising"),
        ({FROM: "0", LOG: True}, "not_positive"),
        ({VALUES: "1"}, "out_of_range"),
        ({VALUES: "2,5"}, "out_of_range"),
        ({VALUES: ""}, "out_of_range"),
        ({SECOND: "edge_angle_deg"}, "same_input"),
        ({LOAD: ""}, "empty"),
        ({LOAD: "x"}, "not_a_number"),
        ({LOAD: "0"}, "out_of_range"),
        ({VALUES: "10001"}, "out_of_range"),
        ({VALUES: "1" * 5000}, "out_of_range"),
        ({VALUES: "1001", SECOND: "load_N"}, "too_many_points"),
        ({FIRST: "H_V_N_per_mm3", "Snow": "published-glacier"}, "given_by_snow"),
        ({FIRST: "elements", FROM: "4.5", TO: "10"}, "wrong_kind"),
    ],
)
def test_what_cannot_be_studied_is_refused(desk: Desk, typed: dict[str, Any], code: str) -> None:
    page = desk.open("/study")
    for name, value in typed.items():
        page.fill(name, value)
    assert refused(desk, page) == code


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
    assert [page.field(name).value for name in (FROM, TO)] == ["80", "320"]
    page.fill(FROM, "40")
    page.fill(VALUES, "2")
    job, _ = asked(desk, page)
    points = read_study(desk.lab.runs / "studies" / job["name"] / "study.toml").points
    assert [point["elements"] for point in points] == [40, 320]
    page.fill(FROM, "3")
    page.press("Start the study")
    page.shows("[status bad] ")
