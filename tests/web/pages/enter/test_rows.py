"""Tests of one row: contents of their page, what is stored, corrected and refused."""

from pathlib import Path

import pytest

from skisnow.campaign import read_campaign
from skisnow.web.transfer import write_campaign

from ..desk import Desk, Sheet, values
from .conftest import CANCEL, DENSITY, DROP_CONE, KG_PER_M3, NAME, SHEAR, SHEARED, Entered, begun, undo_button


def store(page: Sheet, **typed: str) -> None:
    for name, text in typed.items():
        page.fill(NAMES[name], text)
    page.press("Store")


NAMES = {
    "name": NAME,
    "site": "Site",
    "angle": "Edge angle (°)",
    "turning": "Turning angle (°)",
    "depth": "Depth (mm)",
    "arm": "Lever arm (mm)",
    "moment": "Moment (N m)",
    "density": "Density (kg/m³)",
    "sample": "Depth of the sample's middle (mm)",
    "cone": "Drop-cone depth (mm)",
    "repeat": "Repeat",
    "spot": "Measurement point",
    "plate": "Plate",
}


def test_a_shear_test_is_requested_and_stored(entered: Entered) -> None:
    page = entered.open("?table=shear.csv")
    assert page.field("Plate").value == "blade"
    assert page.focused() is page.field("Site")
    assert [each.text for each in page.tagged("nicegui-link") if "aria-current" in each.props][1:] == ["Shear"]
    store(page, site="A", plate="plate", angle="90", depth="6", arm="250", moment="30,0")
    assert page.outcome() == "good"
    (entry,) = entered.history()
    assert (entry.file, entry.test, entry.position, entry.who) == (SHEAR, "1", 0, "Ada")
    assert entry.cells == {"experiment": "1", **SHEARED, "moment_Nm": "30.0"}
    # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    assert page.shows("S_f = ").startswith("[value] S_f = 0.200 N/mm²")
    assert "[quiet] Test 1" in page.outline()
    assert page.charts() == {}
    shown = list(values(page.between("h2 New test", "[quiet] Test 1")).values())
    assert shown == ["2", "A", "plate", "", "", "90", "", "250", ""]
    assert page.focused() is page.field("Depth (mm)")
    row = page.shows("S_f 0.200 · ")
    assert "Moment (N m) 30.0 · Ada · " in row
    assert page.between("h3 So far")[1:3] == ["h4 A", "button[small] 1 · 90°"]


def test_a_sample_does_not_show_the_result_of_the_shear_test_with_its_number(entered: Entered) -> None:
    entered.add_shear("1")
    entered.add(DENSITY, "1", sample="1", site="A", snow_density_kg_per_m3="350")
    entered.add(DROP_CONE, "1", test="1", site="A", repeat="1", drop_cone_depth_mm="20")
    entered.open("?table=shear.csv&test=1").shows("S_f = ")
    for table in (DENSITY, DROP_CONE):
        assert not any("S_f = " in line for line in entered.open(f"?table={table}&test=1").outline())


def test_the_depth_of_a_density_sample_reaches_the_campaign(desk: Desk, entered: Entered, tmp_path: Path) -> None:
    page = entered.open("?table=density.csv")
    store(page, site="A", density="350", sample="12,5")
    assert page.outcome() == "good"
    write_campaign(desk.lab, "entry", entered.id_, tmp_path / "export")
    samples = read_campaign(tmp_path / "export").density
    assert samples is not None
    assert samples.sample_depth.tolist() == [0.0125]


def test_a_test_that_was_sent_before_is_stored_once_and_answered_as_then(entered: Entered) -> None:
    for _ in range(2):
        page = entered.open("?table=density.csv")
        page.fill("Name of the sample", "s")
        page.fill("Site", "A")
        page.fill("Density (kg/m³)", "350")
        assert page.sends("Store", 1, once="a")
        assert page.outcome() == "good"
    assert len(entered.history()) == 1


def test_a_name_that_is_taken_is_rejected(entered: Entered) -> None:
    entered.add_shear("1")
    page = entered.open("?table=shear.csv")
    page.fill(NAME, "1")
    page.fill("Depth (mm)", "6")
    page.fill("Moment (N m)", "20")
    assert not page.sends("Store", 1, once="a")
    assert len(page.refusals()) == 1
    assert page.refusals() == page.faults(NAME)
    assert len(entered.history()) == 1


def test_a_test_that_another_person_entered_meanwhile_is_not_stored(entered: Entered) -> None:
    page = entered.open("?table=shear.csv")
    entered.add_shear("1")
    for name, text in (("site", "A"), ("angle", "90"), ("depth", "6"), ("arm", "250"), ("moment", "30")):
        page.fill(NAMES[name], text)
    assert not page.sends("Store", 1, once="a")
    assert page.outcome() == "bad"
    assert page.field("Moment (N m)").value == "30"


def test_the_next_turning_angle_is_requested(entered: Entered) -> None:
    """30 N m/0.25 m/(100 mm × 6 mm) = 0.2 N/mm²."""
    page = entered.open("?table=shear.csv")
    store(page, site="A", plate="plate", turning="0", angle="90", depth="6", arm="250", moment="5")
    shown = list(values(page.between("h2 New test", "button[main] Store")).values())
    assert shown == ["1", "A", "plate", "", "", "90", "6", "250", ""]
    assert page.focused() is page.field("Turning angle (°)")
    for angle, moment in (("1", "15"), ("2", "25"), ("3", "30")):
        store(page, turning=angle, moment=moment)
    line = page.shows("u_y = 13.1 mm")  # 30/20 × 2° × 250 mm: 20 N m take 2°
    assert line.startswith("[value] S_f = 0.200 N/mm²") and "; u_y = " in line
    assert [row["turning_angle_deg"] for row in entered.stored(SHEAR, "1")] == ["0", "1", "2", "3"]
    store(page, turning="4", depth="7", moment="30")
    assert len(page.refusals()) == 1
    assert len(entered.history()) == 4


def test_a_campaign_without_a_plate_says_where_to_name_one(desk: Desk, entered: Entered) -> None:
    for campaign, is_bad in ((begun(desk, 'name = "Bare"\n'), True), (entered, False)):
        page = campaign.open("?table=shear.csv")
        assert any(line.startswith("[bad]") for line in page.outline()) is is_bad


def test_a_test_of_one_row_is_corrected_with_a_reason(entered: Entered) -> None:
    entered.add_shear("1")
    page = entered.open("?table=shear.csv&test=1")
    shown = list(values(page.between("h2 Correct a test", "button New test")).values())
    assert shown == ["1", "A", "plate", "", "", "90", "6", "250", "30"]
    page.shows("S_f = 0.200 N/mm²")
    entry = entered.history()[0]
    page.press("Correct")
    assert page.outcome() == "good"
    page.fill("Moment (N m)", "x")
    form = page.field("Site").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, false)"
    page.fill("Moment (N m)", "36")
    page.fill("Measurement point", "p")
    page.press("Correct")
    first, second = "Measurement point: nothing becomes p.", "Moment (N m): 30 becomes 36."
    assert {first, second} <= set(page.outline())
    assert page.field("Why").value == "typing error"
    page.press("Leave it as it was")
    assert (page.field("Moment (N m)").value, page.field("Measurement point").value) == ("30", "")
    page.fill("Moment (N m)", "36")
    page.fill("Measurement point", "p")
    form = page.field("Site").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 2})
    assert page.scripts[-1] == "lab.answered(2, true)"
    page.fill("Why", "")
    assert not page.sends("Correct it", 9)
    assert page.outcome() == "bad"
    page.fill("Why", "misread")
    assert page.sends("Correct it", 3)
    correction = entered.history()[-1]
    assert (correction.about, correction.why) == (entry.sequence, "misread")
    assert correction.cells == {"spot": "p", "moment_Nm": "36"}
    page.shows("S_f = 0.240 N/mm²")
    assert "field Moment (N m) = '36' numeric" in page.outline()
    assert "h2 Correct a test" in page.outline()


def test_a_new_test_that_was_begun_is_there_again_after_another_one_was_looked_at(entered: Entered) -> None:
    entered.add_shear("1")
    entered.add_shear("2", depth_mm="8", moment_Nm="36")
    page = entered.open("?table=shear.csv")
    page.fill("Depth (mm)", "7")
    page.press("1 · 90°")
    assert "readonly" in page.field(NAME).props
    page.shows("[quiet] Test 1")
    page.press("2 · 90°")
    page.press("New test")
    assert page.field("Depth (mm)").value == "7"
    assert page.field(NAME).value == "3"
    assert "readonly" not in page.field(NAME).props
    assert not any("button Undo" in line for line in page.outline())
    store(page, moment="20")
    assert page.field("Depth (mm)").value == ""
    page.press("3 · 90°")
    page.press("New test")
    assert page.field(NAME).value == "4"


@pytest.mark.parametrize("act", ["New test", "2", CANCEL, "Undo"])
def test_an_unconfirmed_correction_of_a_row_is_not_lost(entered: Entered, act: str) -> None:
    for name in ("1", "2"):
        entered.add(DENSITY, name, sample=name, site="A", snow_density_kg_per_m3="350")
    page = entered.open(f"?table={DENSITY}&test=1")
    page.fill("Density (kg/m³)", "360")
    page.press("Correct")
    assert "good" not in page.status()
    page.press(undo_button(page) if act == "Undo" else act)
    assert page.field("Density (kg/m³)").value == "360"
    assert page.focused() is page.field("Why")
    assert len(entered.history()) == 2
    page.press("Correct it")
    assert entered.stored(DENSITY, "1")[0][KG_PER_M3] == "360"
    page.press("New test")
    assert "h2 New test" in page.outline()


def test_each_row_of_a_test_has_an_address(desk: Desk, entered: Entered) -> None:
    for repeat, depth in (("1", "20"), ("2", "30")):
        entered.add(DROP_CONE, "1", test="1", repeat=repeat, site="A", drop_cone_depth_mm=depth)
    numbers = [entry.sequence for entry in entered.history() if entry.action == "add"]
    address = f"/enter/{entered.id_}?table={DROP_CONE}"
    for number, depth in zip(numbers, ("20", "30"), strict=True):
        page = desk.open(f"{address}&test=1&row={number}")
        assert page.field(NAMES["cone"]).value == depth
        assert [each for each in page.at_first if "replaceState" in each] == [
            f'history.replaceState({{}}, "", "{address}&test=1&row={number}");'
        ]
    page.press("New test")
    assert f'history.replaceState({{}}, "", "{address}");' in page.scripts
    assert desk.open(f"{address}&test=1&row=x").field(NAMES["cone"]).value == "20"
