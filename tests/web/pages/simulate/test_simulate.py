"""*Simulate*: its inputs, what they ask for, what is refused."""

import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.web.scenario_fields import ScenarioField, field_label
from tests.coded import raises

from ..desk import Desk, Sheet, values
from .shared import ENDS, HARDNESS, MASS, SPEED, STANCE, STEERS, STRESS, WAY, asked, jobs, refused

INERTIA = "Moments of inertia I (kg m²)"


def names_by_heading(page: Sheet) -> dict[str, list[str]]:
    """Labels of the fields below each small heading."""
    found: dict[str, list[str]] = {}
    for line in page.outline():
        if line.startswith("h3 "):
            found[line[3:]] = []
        elif line.startswith("field ") and found:
            found[list(found)[-1]].append(line[6:].partition(" = ")[0])
    return found


def test_a_field_that_is_checked_says_itself_what_is_wrong(desk: Desk) -> None:
    page, key = desk.open("/replay"), SCENARIO_KEYS["sledge.mass_kg"]

    def made() -> ScenarioField:
        with page.content:
            return ScenarioField(key, 80.0, "-5")

    field = desk.do(made, page.client)
    with raises(ParameterError, "out_of_range"):
        desk.do(field.check, page.client)
    page.until(lambda: page.field(MASS).error)
    page.fill(MASS, "90,5")
    assert desk.do(field.check, page.client) == 90.5
    assert page.field(MASS).error is None
    assert (field.before, field.is_changed, field.text) == ("80", True, "90.5")


def test_a_skier_sets_the_edge_angle_itself_and_has_inputs_of_its_own(desk: Desk) -> None:
    page = desk.open("/simulate")
    page.fill("Scenario", "slalom-20-gates")
    page.shows(STEERS)
    shown = values(page.between("h1 Simulate", "button[main] Simulate"))
    assert list(shown.values())[4:8] == ["gates", "2", "4.5", "0.85"]
    assert {HARDNESS, STRESS, "Mass of the skier m (kg)", SPEED, ENDS, WAY} <= set(shown)
    assert not any("Edge angle" in name for name in shown)
    found = names_by_heading(page)
    of_skier = found.pop("Skier")
    first = [field_label(SCENARIO_KEYS[f"skier.{name}"]) for name in ("first_turn_s", "turn_angle_deg")]
    every = sum(name.startswith("skier.") for name in SCENARIO_KEYS)
    assert (of_skier[:2], len(of_skier)) == (first, every - 4)


def test_a_request_without_typed_values_is_the_unchanged_scenario(desk: Desk) -> None:
    page = desk.open("/simulate", "de")
    page.press("Simulieren")
    page.until(lambda: jobs(desk))
    (job,) = jobs(desk)
    told = [job[key] for key in ("scenario", "changes", "given", "state", "language")]
    assert told == ["carved-46m", {}, "", "waiting", "de"]


def test_typed_decimal_commas_become_points_in_the_request(desk: Desk) -> None:
    page = desk.open("/simulate")
    page.fill(MASS, " 80,5 ")
    page.fill("Fixed time step", True)
    page.fill("Pushing the groove brakes", False)
    page.fill("Law of shear", "by-angle")
    page.fill(INERTIA, "[6, 8, 11]")
    assert asked(desk, page)["changes"] == {
        "sledge.mass_kg": "80.5",
        "snow.compaction_resistance": "false",
        "sledge.inertia_kg_m2": "[6, 8, 11]",
        "shear.law": "by-angle",
        "solver.fixed": "true",
    }


@pytest.mark.parametrize(
    ("name", "typed"), [(HARDNESS, {"snow.H_V_N_per_mm3": "0.3"}), (STRESS, {"snow.S_f_N_per_mm2": "0.3"})]
)
def test_a_number_of_the_snow_goes_with_the_other_one_beside_it(desk: Desk, name: str, typed: dict[str, str]) -> None:
    page = desk.open("/simulate")
    page.fill(name, "0.3")
    assert asked(desk, page)["changes"] == {"snow.H_V_N_per_mm3": "0.2", "snow.S_f_N_per_mm2": "0.5"} | typed


@pytest.mark.parametrize(
    ("name", "typed", "code"),
    [
        (STANCE, "-5", "out_of_range"),
        (MASS, "abc", "wrong_kind"),
        (SPEED, "", "empty"),
        (INERTIA, "[1,2]", "wrong_kind"),
    ],
)
def test_invalid_input_is_rejected_at_the_button_and_its_field(desk: Desk, name: str, typed: str, code: str) -> None:
    page = desk.open("/simulate")
    at_first = page.field(name).value
    page.fill(name, typed)
    assert refused(desk, page) == code
    page.until(lambda: page.field(name).error)
    assert page.scripts[-1] == f"lab.goTo({page.field(name).id})"
    assert jobs(desk) == []
    page.fill(name, at_first)
    asked(desk, page)
    assert "!" not in page.shows(f"field {name} = ")
    assert not [line for line in page.outline() if line.startswith("[status bad]")]


def test_what_only_the_whole_scenario_tells_is_rejected_at_its_field(desk: Desk) -> None:
    """A menu, whose sentence below it says so until it is chosen again; the other field that is named has no fault."""
    page = desk.open("/simulate")
    page.fill("Law of shear", "by-density")
    assert refused(desk, page) == "missing"
    marked = [line for line in page.outline() if " ! " in line or line.startswith("[quiet range bad]")]
    assert [line[:17] for line in marked] == ["[quiet range bad]"]
    assert page.scripts[-1] == f"lab.goTo({page.field('Law of shear').id})"
    page.fill("Law of shear", "constant")
    asked(desk, page)
    assert not any(line.startswith("[quiet range bad]") for line in page.outline())


def test_what_no_field_has_is_rejected_at_the_button(desk: Desk) -> None:
    """A ski is wider than a stance of 1 cm."""
    page = desk.open("/simulate")
    page.fill(STANCE, "0.01")
    assert refused(desk, page) == "contradiction"
    assert " ! " not in "".join(page.outline())
    assert not any("goTo" in each for each in page.scripts)


def test_another_scenario_keeps_what_was_typed_and_only_that(desk: Desk) -> None:
    page = desk.open("/simulate")
    assert "open" not in page.tagged("details")[0].props
    page.fill(MASS, "90")
    page.fill("Scenario", "giant-slalom-67m")
    page.shows(f"field {MASS} = '90'")
    assert "open" not in page.tagged("details")[0].props
    job = asked(desk, page)
    assert (job["scenario"], job["changes"]) == ("giant-slalom-67m", {"sledge.mass_kg": "90"})
    page.fill(STANCE, "0.6")
    page.fill("Scenario", "carver-42m")
    page.shows(f"field {STANCE} = '0.6'")
    assert "open" in page.tagged("details")[0].props
    assert asked(desk, page)["changes"] == {"sledge.mass_kg": "90", "sledge.stance_width_m": "0.6"}
