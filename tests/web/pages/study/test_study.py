"""Studies: their form and their cards."""

import json
from pathlib import Path
from typing import Any

import pytest

from skisnow.campaign import read_campaign
from skisnow.estimation import analyse, results_dict
from skisnow.estimation.results import results_json
from skisnow.parameters import Quantity
from skisnow.web.lab_skis import LabSkis
from skisnow.web.study_fields import CARVE, first_range

from ...campaign_texts import HARD, SHEARED, SOFT, pressed
from ..desk import Desk
from .shared import (
    ANGLE,
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
    asked,
    number_of_points,
    refused,
    scenario,
)


def campaign(desk: Desk, folder: Path) -> str:
    """The id of a kept campaign with two sites and no shear test."""
    rows = pressed({"1": ("A", SOFT), "2": ("B", HARD)})
    return desk.kept(folder, {"campaign.toml": SHEARED, "penetration.csv": rows})


@pytest.mark.parametrize(
    ("key", "ends"),
    [
        (Quantity("a.mass_kg", ""), (60.0, 120.0)),
        (Quantity("w", "", default=2.0, lowest=1.5, highest=3.0), (1.5, 3.0)),
        (Quantity("w", "", default=0.0, usual=(1.0, 2.0)), (1.0, 2.0)),
        (Quantity("w", "", default=1.0, usual=(1.0, 3.0)), (0.5, 2.0)),
        (Quantity("w", "", default=True, kind="switch"), None),
        (Quantity("n", "", default=5, highest=7.5, kind="whole number"), (3.0, 7.0)),
        (Quantity("n", "", default=1, lowest=1.0, highest=1.0), None),
        (Quantity("w", "", default=1e308), None),
    ],
)
def test_an_input_begins_around_what_it_usually_is(key: Quantity, ends: tuple[float, float] | None) -> None:
    assert first_range(key) == ends


@pytest.mark.parametrize(
    "steps",
    [
        [({VALUES: "14"}, "14 points."), ({VALUES: "x"}, ""), ({VALUES: "1" * 400}, "")],
        [({SECOND: "run.duration_s"}, "70 points.")],
    ],
)
def test_the_number_of_points_follows_what_is_typed(desk: Desk, steps: list[tuple[dict[str, Any], str]]) -> None:
    page = scenario(desk)
    for typed, told in steps:
        for name, value in typed.items():
            page.fill(name, value)
        assert number_of_points(page) == told, typed


def test_of_a_scenario_only_what_is_changed_is_fixed(desk: Desk) -> None:
    page = scenario(desk)
    job, text = asked(desk, page)
    assert text == {
        "out": "table.csv",
        "scenario": "carved-46m",
        "fixed": {},
        "grid": {"start.speed_m_per_s": {"from": 6.0, "to": 12.0, "n": 7}},
    }
    assert [job[key] for key in ("changes", "given", "points")] == [
        {}, f"{SPEED}: 6 to 12, 7 values", 7,
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
        ({FIRST: "snow.H_V_N_per_mm3"}, {"snow.S_f_N_per_mm2": 0.5}),
        ({RATIO: "11"}, {"snow.unloading_ratio": 11.0}),
    ],
)
def test_both_numbers_of_the_snow_or_none_are_given(desk: Desk, typed: dict[str, str], fixed: dict[str, float]) -> None:
    page = scenario(desk)
    for name, value in typed.items():
        page.fill(name, value)
    assert asked(desk, page)[1]["fixed"] == fixed


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
    assert job["given"].endswith("; ski: slalom")


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


def test_a_study_of_carved_turns_is_asked_about_a_turn(desk: Desk) -> None:
    page = desk.open("/study")
    choices = [page.field(name).value for name in (OF, "Ski", FIRST, SECOND)]
    assert choices == ["carved-turn", "carver", "edge_angle_deg", "nothing"]
    assert [page.field(name).value for name in (FROM, TO, VALUES, LOG)] == ["10", "70", "13", False]
    assert [page.field(name).value for name in (LOAD, HARDNESS, STRESS, RATIO)] == ["800", "0.2", "0.5", "10"]
    assert [each.text for each in page.of() if each.props.get("aria-current") == "page"] == ["Study"]


def test_a_study_without_typed_values_varies_the_edge_angle(desk: Desk) -> None:
    job, text = asked(desk, desk.open("/study"))
    assert text == {"out": "table.csv", "fixed": TURN, "grid": {"edge_angle_deg": {"from": 10.0, "to": 70.0, "n": 13}}}
    kept = {key: job[key] for key in ("scenario", "state", "language", "points")}
    assert list(kept.values()) == [CARVE, "waiting", "en", 13]
    assert job["changes"] == {
        "load_N": "800", "H_V_N_per_mm3": "0.2", "S_f_N_per_mm2": "0.5", "unloading_ratio": "10",
    }  # fmt: skip


def test_what_is_typed_is_requested(desk: Desk) -> None:
    page = desk.open("/study")
    page.fill(FROM, "10,5")
    page.fill(VALUES, "3")
    page.fill(SECOND, "H_V_N_per_mm3")
    page.fill(f"{SECOND}: even in the logarithm", True)
    page.fill(VALUES_2, "4")
    page.fill(LOAD, "600,5")
    page.fill(RATIO, "inf")
    assert not [line for line in page.outline() if line.startswith(f"field {HARDNESS}")]
    assert number_of_points(page).startswith("12 ")
    job, text = asked(desk, page)
    assert text["grid"] == {
        "edge_angle_deg": {"from": 10.5, "to": 70.0, "n": 3},
        "H_V_N_per_mm3": {"from": 0.1, "to": 10.0, "n": 4, "log": True},
    }
    infinite = {"ski": "carver", "load_N": 600.5, "S_f_N_per_mm2": 0.5, "unloading_ratio": float("inf")}
    assert text["fixed"] == infinite
    assert job["points"] == 12


def test_another_input_begins_again(desk: Desk) -> None:
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
def test_input_that_cannot_be_studied_is_rejected(desk: Desk, typed: dict[str, Any], code: str) -> None:
    page = desk.open("/study")
    for name, value in typed.items():
        page.fill(name, value)
    assert refused(desk, page) == code
