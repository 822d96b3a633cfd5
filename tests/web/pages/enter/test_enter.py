"""Entering tests: the page and its frame, the head of a series, its address, its readings."""

import json
from urllib.parse import urlencode

import numpy as np
import pytest
from nicegui import ui

from skisnow.geometry import SkiPiece
from skisnow.report.formatting import significant
from skisnow.web.entry.series import ON_BLUR, ON_ENTER

from ..desk import Desk, Sheet, values
from .conftest import (
    DISCS_OFF,
    NAME,
    OTHER_LOAD,
    PENETRATION,
    READ_AGAIN,
    SERIES,
    Entered,
    after_waiting,
    back,
    begun,
    enter,
    is_open,
    leave,
    reading_row,
    selected,
    undo_button,
)

CHART = "chart Load against depth of this series and the others of its site, load in N: "


def test_a_page_of_a_campaign_asks_for_its_first_series(entered: Entered) -> None:
    page = entered.open()
    assert page.field("Tool").value == "disc"
    assert page.focused() is page.field("Site")
    assert selected(page) == [page.field("Site")]
    assert any(
        f'replaceState({{}}, "", "/enter/{entered.id_}?table=penetration.csv")' in each for each in page.at_first
    )
    assert page.at_first.count("lab.answered(0, true)") == 1
    assert [each.text for each in page.tagged("nicegui-link") if "aria-current" in each.props] == [
        "Campaigns",
        "Penetration",
    ]
    assert page.field("Operator").options == {"Ada": "Ada", "Bo": "Bo", "Cy": "Cy"}


def test_without_observers_anybody_may_say_a_name(desk: Desk) -> None:
    entered = begun(desk, 'place = "x"\n')
    page = entered.open("?table=density.csv")
    assert page.outline()[0] == "h1 Campaign"
    assert "field Operator = ''" in page.outline()
    page.fill("Operator", "Di")
    page.fill("Site", "A")
    page.fill("Density (kg/m³)", "300")
    page.press("Store")
    assert [entry.who for entry in entered.history()] == ["Di"]


def test_an_address_with_another_table_is_rejected(desk: Desk, entered: Entered) -> None:
    assert desk.get(f"/enter/{entered.id_}?table=campaign.toml").status_code == 404
    assert desk.code == "no_table"
    desk.failures.clear()


def test_a_series_begins_with_its_head_and_asks_for_a_depth_under_each_load(entered: Entered) -> None:
    page = entered.open()
    page.fill("Site", " A ")
    page.fill("Tool", "ski piece")
    page.fill("Edge angle (°)", "30,5")
    page.fill("Measurement point, if sheared there", "p")
    page.press("Begin the series")
    assert page.outcome() == "good"
    assert page.focused() is page.field("Depth under 20 N (mm)")
    address = f"/enter/{entered.id_}?table=penetration.csv&test=1&site=A&spot=p&tool=ski%20piece&edge_angle_deg=30.5"
    assert any(f'"{address}"' in each for each in page.scripts)
    assert entered.history() == []
    rows = [each.props for each in page.tagged("div") if "reading" in each.classes and "data-load" in each.props]
    assert [(each["data-load"], each["data-branch"]) for each in rows] == [
        ("20", ""),
        ("40.5", ""),
        ("60", ""),
        ("40.5", "unloading"),
        ("20", "unloading"),
    ]
    heads = [json.loads(each.props["data-head"]) for each in page.tagged("div") if "data-head" in each.props]
    assert heads == [{"experiment": "1", "site": "A", "spot": "p", "tool": "ski piece", "edge_angle_deg": "30.5"}] * 2
    assert not any("open" in each.props for each in page.tagged("details"))
    first = page.field("Depth under 20 N (mm)")._event_listeners.values()
    assert {each.type: each.js_handler for each in first if each.js_handler in (ON_ENTER, ON_BLUR)} == {
        "keydown.enter": ON_ENTER,
        "blur": ON_BLUR,
    }


def test_what_no_series_can_begin_with_is_reported_at_its_fields(entered: Entered) -> None:
    page = entered.open()
    page.fill("Edge angle (°)", "95")
    assert not page.sends("Begin the series", 1)
    assert page.outcome() == "bad"
    assert page.refusals() == page.faults("Site", "Edge angle (°)")
    assert "“95”" in page.refusals()[1]
    page.fill("Site", "A")
    page.fill("Edge angle (°)", "45")
    page.press("Begin the series")
    assert page.outcome() == "good"
    assert page.refusals() == []


def listed(page: Sheet) -> list[str]:
    """Names of the series below the form."""
    return [line.rpartition("=")[2] for line in page.outline() if line.startswith("link[small]")]


def test_a_series_has_a_name_of_its_own(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    page = entered.open()
    page.fill(NAME, "1")
    page.press("Begin the series")
    assert len(page.refusals()) == 1
    assert page.refusals() == page.faults(NAME)


def test_the_next_series_has_what_it_shares_with_the_last_one(entered: Entered) -> None:
    entered.add_series("7", ("20", "1.5"))
    entered.add_series("a", ("20", "1.5"), site="B", edge_angle_deg="45")
    page = entered.open()
    assert list(values(page.between("h2 New series", CHART)).values()) == ["8", "B", "ski piece", "45", ""]
    assert page.focused() is page.field("Edge angle (°)")
    assert selected(page) == [page.field("Edge angle (°)")]
    assert listed(page) == ["a", "7"]


def test_the_list_grows_with_each_series_of_a_page(entered: Entered) -> None:
    page = entered.open()
    page.fill("Site", "A")
    page.fill("Edge angle (°)", "0")
    names: list[str] = []
    for name in map(str, range(1, 9)):
        page.press("Begin the series")
        enter(page, "Depth under 20 N (mm)", f"1.{name}")
        names.insert(0, name)
        assert listed(page) == names
        page.press("Next series")
        assert listed(page) == names


@pytest.mark.parametrize(
    "head",
    [
        {"site": "A", "tool": "ski piece", "edge_angle_deg": "95"},
        {"site": "A", "tool": "lost", "edge_angle_deg": "30"},
        {"site": " A", "tool": "disc", "edge_angle_deg": "0"},
        {"tool": "disc", "edge_angle_deg": "0"},
    ],
)
def test_an_address_without_a_valid_head_of_a_series_asks_for_one(entered: Entered, head: dict[str, str]) -> None:
    query = urlencode({"table": PENETRATION, "test": "1", **head})
    assert "h2 New series" in entered.open(f"?{query}").outline()


def test_a_series_is_there_again_by_its_address(entered: Entered) -> None:
    page = entered.begun_series()
    assert page.between("h2 Series 1")[:3] == ["h2 Series 1", "[quiet] A · ski piece · 30°", "[load] 20 N"]
    assert page.focused() is page.field("Depth under 20 N (mm)")
    entered.add_series("1", ("20", "1.5"))
    page = entered.begun_series()
    assert page.field("Depth under 20 N (mm)").value == "1.5"
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    address = f"/enter/{entered.id_}?table=penetration.csv&test=1"
    assert [each for each in page.at_first if "replaceState" in each] == [
        f'history.replaceState({{}}, "", "{address}");'
    ]
    (link,) = (each for each in page.tagged("nicegui-link") if each.text.split(" ·")[0] == "1")
    assert link.props["aria-current"] == "page"


def test_the_list_of_a_site_has_angle_result_writer_and_flags(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "2.1"))
    page = entered.open()
    row = page.shows("H_V")
    # from the wedge of the ski piece at 30 degrees: F/V of the largest load
    volume = float(SkiPiece(0.2, 0.062).displaced_volume(2.1e-3, np.radians(30.0))) * 1e9
    assert f"H_V {significant(40.5 / volume)} · " in row
    lines = page.between("h3 Series so far")
    assert lines[1] == "h4 A"
    assert any("too few loads" in line for line in lines)


def test_a_reading_is_stored_as_it_is_typed(entered: Entered) -> None:
    page = entered.begun_series()
    enter(page, "Depth under 40.5 N (mm)", " 2,15 ")
    assert page.outcome() == "good"
    assert page.scripts[-1].startswith("lab.told(")
    (entry,) = entered.history()
    assert (entry.action, entry.file, entry.test, entry.position) == ("add", PENETRATION, "1", 0)
    assert (entry.who, entry.once) == ("Ada", "Depth under 40.5 N (mm)  2,15 ")
    assert entry.cells == {"experiment": "1", **SERIES, "load_N": "40.5", "depth_mm": "2.15"}
    page.shows("[stored] stored")
    assert reading_row(page, "Depth under 40.5 N (mm)").props["data-stored"] == "2.15"
    assert "2.15 mm" in undo_button(page)
    leave(page, "Depth under 20 N (mm)", "1.5")
    assert entered.depths() == [("20", "1.5"), ("40.5", "2.15")]
    assert [each.position for each in entered.history()] == [0, 1]


def test_a_series_in_german_has_commas(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"))
    page = entered.series_page(language="de")
    fields = [each for each in page.of(ui.input) if each.props.get("inputmode") == "decimal"]
    assert fields[0].value == "1,5"
    assert reading_row(page, fields[0].props["aria-label"]).props["data-stored"] == "1.5"
    enter(page, fields[1].props["aria-label"], "2.15")
    assert fields[1].value == "2,15"
    assert entered.depths() == [("20", "1.5"), ("40.5", "2.15")]
    leave(page, fields[1].props["aria-label"])  # is not a correction
    assert len(entered.history()) == 2
    assert not any(each.props.get("label") == "Warum" for each in page.of(ui.input))
    loads = [each for each in page.of(ui.label) if "data-kg" in each.props][:2]
    assert [(each.text, each.props["data-kg"]) for each in loads] == [("20 N", "2,04 kg"), ("40,5 N", "4,13 kg")]


def test_what_is_no_depth_is_rejected_at_its_field_and_said_once(entered: Entered) -> None:
    page = entered.begun_series()
    name = "Depth under 20 N (mm)"
    enter(page, name, "1.5.2")
    assert page.outcome() == "bad"
    (fault,) = page.refusals()
    assert "“1.5.2”" in fault
    assert page.faults(name) == [fault]
    assert "refused" in reading_row(page, name).classes
    assert f"lab.refusedLast({page.field(name).id})" in page.scripts
    enter(page, "Depth under 60 N (mm)", "3")
    leave(page, name)  # it was shown at Enter
    assert page.outcome() == "good"
    assert page.refusals() == []
    enter(page, name, "1.5.2")  # at another Enter it is shown again
    assert page.refusals() == [fault]
    leave(page, name, "x")
    assert "“x”" in page.refusals()[0]
    leave(page, name, "")
    assert "refused" not in reading_row(page, name).classes
    leave(page, name, "x")  # another time
    assert "refused" in reading_row(page, name).classes
    enter(page, name, "1.5")
    assert "refused" not in reading_row(page, name).classes
    assert entered.depths() == [("20", "1.5"), ("60", "3")]
    assert all(each.error is None for each in page.of(ui.input))


def test_a_text_that_was_lost_on_its_way_is_taken_from_what_is_sent_again(entered: Entered) -> None:
    page = entered.begun_series()
    made = page.field("Depth under 20 N (mm)")
    page.fire(made, "blur", {"once": "a", "text": "1.5"})
    page.fire(made, "blur", {"once": "a", "text": "1.5"})
    assert entered.depths() == [("20", "1.5")]
    assert made.value == "1.5"
    assert page.scripts.count('lab.told("a")') == 2


def test_another_person_on_the_same_series_is_reported_and_shown(entered: Entered) -> None:
    page = entered.begun_series()
    page.fill("Depth under 60 N (mm)", "3")  # typed, and not stored
    page.fill(back("20"), "2.9")
    page.fill(after_waiting("20"), "1.7")
    entered.add_series("1", ("20", "1.4"), who="Bo")
    enter(page, "Depth under 40.5 N (mm)", "2.1")
    assert len(entered.history()) == 1
    assert page.outcome() == "bad"
    shown = {"Depth under 20 N (mm)": "1.4", "Depth under 40.5 N (mm)": "2.1", "Depth under 60 N (mm)": "3"}
    shown |= {back("20"): "2.9", after_waiting("20"): "1.7"}
    assert {name: page.field(name).value for name in shown} == shown
    assert is_open(page, DISCS_OFF)
    assert is_open(page, READ_AGAIN)
    assert not is_open(page, OTHER_LOAD)
    leave(page, "Depth under 40.5 N (mm)")
    assert entered.depths() == [("20", "1.4"), ("40.5", "2.1")]


def test_a_load_beyond_the_discs_stands_where_it_belongs(entered: Entered) -> None:
    page = entered.begun_series()
    enter(page, "Depth under 20 N (mm)", "1.5")
    page.fill("Further load (N)", "50,0")
    page.fill("Its depth (mm)", "2.4")
    page.fill("Depth under 60 N (mm)", "3")
    page.press("Store it")
    assert page.outcome() == "good"
    assert entered.depths() == [("20", "1.5"), ("50.0", "2.4")]
    depths_shown = [page.field(f"Depth under {load} N (mm)").value for load in ("20", "40.5", "50.0", "60")]
    assert depths_shown == ["1.5", "", "2.4", "3"]
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    assert page.field("Further load (N)").value == ""


def test_a_load_that_has_a_reading_is_rejected_as_a_further_one(entered: Entered) -> None:
    page = entered.begun_series()
    enter(page, "Depth under 20 N (mm)", "1.5")
    page.fill("Further load (N)", "20.0")
    page.fill("Its depth (mm)", "2.4")
    form = page.field("Its depth (mm)").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 4, "once": "b"})
    assert page.refusals() == page.faults("Further load (N)")
    assert len(page.refusals()) == 1
    assert page.scripts[-1] == "lab.answered(4, false)"
    page.fill("Further load (N)", "")
    page.press("Store it")
    assert page.refusals() == page.faults("Further load (N)")
    page.fill("Further load (N)", "80")
    page.fill("Its depth (mm)", "-1")
    page.press("Store it")
    assert page.refusals() == page.faults("Its depth (mm)")
    assert len(entered.history()) == 1


def test_discs_that_are_taken_off_come_after_the_loading(entered: Entered) -> None:
    page = entered.begun_series()
    name = back("40.5")
    enter(page, name, "2.5")
    assert page.refusals() == page.faults(name)
    assert len(page.refusals()) == 1
    enter(page, name, "")
    for load, depth in (("20", "1.5"), ("40.5", "2.15"), ("60", "2.6")):
        enter(page, f"Depth under {load} N (mm)", depth)
    enter(page, name, "2.5")
    assert page.outcome() == "good"
    assert "2.5 mm" in undo_button(page)
    assert entered.history()[-1].cells["branch"] == "unloading"
    assert "branch" not in entered.history()[0].cells
    page = entered.series_page()
    assert is_open(page, DISCS_OFF)
    assert page.field(name).value == "2.5"
    assert page.field("Depth under 40.5 N (mm)").value == "2.15"
    assert page.focused() is page.field(back("20"))
    page.shows("k_u/H_V = ")
    enter(page, name, "2.4")
    page.shows("2.5 becomes 2.4")


def test_two_rejected_fields_are_listed_in_german_each_by_its_own_sentences(entered: Entered) -> None:
    """Typed words that other messages contain are shown as they were typed."""
    page = entered.open("?table=shear.csv", "de")
    typed = {"Messort": "A", "Kantwinkel (°)": "90.5", "Hebelarm (mm)": "250", "Moment (N m)": "Density; it is blank"}
    for name, text in typed.items():
        page.fill(name, text)
    page.press("Speichern")
    assert page.refusals() == [
        "Kantwinkel (°): „90.5“ ist nicht erlaubt. Erlaubt: eine Zahl über 0 bis 90.",
        "Tiefe (mm) ist leer. Erlaubt: eine Zahl ab 0.",
        "Moment (N m): „Density; it is blank“ ist nicht erlaubt. Erlaubt: eine Zahl ab 0.",
    ]
    assert page.refusals() == page.faults("Kantwinkel (°)", "Tiefe (mm)", "Moment (N m)")
    assert entered.history() == []


def test_after_a_series_the_sites_are_compared(entered: Entered) -> None:
    """B is harder by 2.1 mm against 1.05 mm under the same load: by the square of 2 for an edge."""
    for site, factor in (("A", 1.0), ("B", 0.5)):
        for number in (1.0, 1.02):
            readings = [
                (load, f"{depth * factor * number:.2f}") for load, depth in (("20", 1.5), ("40.5", 2.1), ("60", 2.6))
            ]
            entered.add_series(f"{site}{number}", *readings, site=site)
    page = entered.open("?test=B1.0")
    ratio = float(page.shows("times as hard as A").removeprefix("B is ").partition(" ")[0])
    assert ratio == pytest.approx(4.0, rel=0.02)
