"""Correcting an imported campaign: contents of the page, what is written down beside its files, what is refused."""

import base64
from pathlib import Path
from typing import Any

import pytest
from nicegui import ui

from skisnow import analyse, read_campaign
from skisnow._support.errors import StoreError
from skisnow.campaign.store import JournalEntry, Journals, NewEntry, export_corrected
from skisnow.web.edit_session import CorrectionSession
from skisnow.web.words import result_words
from tests.coded import raises

from ...support.user_files.test_workbook import packed
from .desk import Desk, Sheet, values
from .enter.conftest import CANCEL, undo_button

TOML = """name = "From a drawer"
observers = ["Ada", "Bo"]
tool = [{name = "ski piece", shape = "ski", length_mm = 200, width_mm = 62}]
plate = [{name = "plate", length_mm = 100}]
"""
PENETRATION = """experiment;site;spot;tool;edge_angle_deg;load_N;depth_mm;remark;time;status;colour
1;A;;ski piece;30;20;1,5;warm;;;red
1;A;;ski piece;30;40;2,1;;;;
1;A;;ski piece;30;60;2,6;;;;
2;A;;ski piece;30;20;1,4;;;too wet;
3;B;;ski piece;30;20;1,9;;;;
"""
SHEAR = "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n1,A,plate,90,6,250,30\n"
FILES = {"campaign.toml": TOML, "penetration.csv": PENETRATION, "shear.csv": SHEAR}


def kept(desk: Desk, folder: Path, files: dict[str, str] = FILES) -> str:
    return desk.kept(folder, files)


@pytest.fixture
def id_(desk: Desk, tmp_path: Path) -> str:
    return kept(desk, tmp_path / "drawer")


def opened(desk: Desk, id_: str, test: str = "1", table: str = "penetration.csv") -> Sheet:
    return desk.open(f"/correct/{id_}?table={table}&test={test}")


def history(desk: Desk, id_: str) -> list[JournalEntry]:
    return list(Journals(desk.lab.store).corrections(id_))


def asking_form(page: Sheet, name: str) -> Any:
    """The form that a field is in, which Enter sends."""
    above = page.field(name).parent_slot.parent
    while not any(each.type == "keydown.enter" for each in above._event_listeners.values()):
        above = above.parent_slot.parent
    return above


def test_the_tests_of_a_table_are_listed_by_their_sites(desk: Desk, id_: str) -> None:
    page = desk.open(f"/correct/{id_}")
    links = [each.props["href"] for each in page.of(ui.link) if "small" in each.classes]
    assert links == [f"/correct/{id_}?table=penetration.csv&test={name}" for name in "123"]
    assert {"A: 2", "B: 1"} <= set(page.outline())
    assert ["open" in each.props for each in page.tagged("details")] == [False, False]
    assert [each.text for each in page.tagged("nicegui-link") if "aria-current" in each.props] == [
        "Campaigns",
        "Penetration",
    ]
    assert "data-keeps" in page.html
    assert "data-ahead" not in page.html


def correct(desk: Desk, id_: str, test: str, cells: dict[str, str]) -> JournalEntry:
    session = CorrectionSession(desk.lab, id_)
    seen = session.test("penetration.csv", test).last
    entry = NewEntry(action="correct", file="penetration.csv", test=test, cells=cells, who="Bo", why="slip", about=0)
    return session.write_down(entry, seen=seen)


# A test


def test_a_test_is_listed_cell_by_cell(desk: Desk, id_: str, tmp_path: Path) -> None:
    """A value of the whole test is shown once; the hardness is that of an analysis."""
    page = opened(desk, id_)
    row = analyse(read_campaign(tmp_path / "drawer")).results["penetration"]["experiments"][0]
    page.shows(f"[value] {result_words(row)}")
    assert (
        values(page.between("h1 From a drawer", f"[value] {result_words(row)}")).items()
        >= {
            "Operator": "Ada",
            "Site": "A",
            "Tool": "ski piece",
            "Edge angle (°)": "30",
            "Measurement point": "",
            "Load (N), row 2": "20",
            "Depth (mm), row 2": "1,5",
            "Load (N), row 3": "40",
            "Depth (mm), row 3": "2,1",
            "Load (N), row 4": "60",
            "Depth (mm), row 4": "2,6",
        }.items()
    )
    assert page.link("Another test") == f"/correct/{id_}?table=penetration.csv"
    assert len([each for each in page.tagged("div") if each.classes == ["fields", "row"]]) == 3
    assert len([each for each in page.tagged("div") if each.classes == ["fields"]]) == 1
    assert page.field("Tool").options == {"ski piece": "ski piece"}


def test_a_photo_is_added_to_an_imported_test(desk: Desk, id_: str) -> None:
    page = opened(desk, id_)
    field = next(each for each in page.tagged("input") if "file" in str(each.props.get("type")))
    page.fire(field, "change", {"photo": base64.b64encode(b"\xff\xd8\xff").decode()})
    (entry,) = history(desk, id_)
    assert (entry.action, entry.file, entry.cells["test"]) == ("add", "attachments.csv", "1")
    page.shows("Photo, 0 kB")
    correct(desk, id_, "1", {"2/depth_mm": "1,6"})
    assert CorrectionSession(desk.lab, id_).whole_campaign().penetration is not None


def test_a_test_that_its_file_cancels_says_so(desk: Desk, id_: str) -> None:
    page = opened(desk, id_, "2")
    assert "too wet" in page.between("h2 Test 2")[1]
    assert f"button {CANCEL}" not in page.outline()


@pytest.mark.parametrize("table", ["density.csv", "campaign.toml"])
def test_an_address_of_another_table_is_rejected(desk: Desk, id_: str, table: str) -> None:
    answer = desk.get(f"/correct/{id_}?table={table}")
    assert (answer.status_code, desk.code) == (404, "no_table")
    desk.failures.clear()


# Corrections


def test_a_cell_is_corrected_with_a_reason(desk: Desk, id_: str, tmp_path: Path) -> None:
    page = opened(desk, id_)
    page.fill("Depth (mm), row 3", "2,15")
    page.fire(asking_form(page, "Depth (mm), row 3"), "keydown.enter", {"number": 1, "once": "a"})
    assert page.scripts[-1] == "lab.answered(1, true)"
    page.shows("2,1 becomes 2.15")
    assert page.focused() is page.field("Why")
    page.fill("Why", " ")
    assert not page.sends("Correct it", 2)
    assert page.outcome() == "bad"
    page.fill("Why", "misheard")
    assert page.sends("Correct it", 3)
    assert page.outcome() == "good"
    first, entry = history(desk, id_)
    assert (first.action, first.cells["3/depth_mm"]) == ("add", "2,1")
    assert (entry.action, entry.about, entry.why, entry.who) == ("correct", first.sequence, "misheard", "Ada")
    assert entry.cells == {"3/depth_mm": "2.15"}
    assert page.field("Depth (mm), row 3").value == "2.15"
    assert page.field("Depth (mm), row 2").value == "1,5"
    assert "misheard" in undo_button(page)
    export_corrected(desk.lab.store, id_, tmp_path / "out")
    row = analyse(read_campaign(tmp_path / "out")).results["penetration"]["experiments"][0]
    page.shows(f"[value] {result_words(row)}")
    page.press(undo_button(page))
    assert page.outcome() == "good"
    assert page.field("Depth (mm), row 3").value == "2,1"


def test_what_a_test_has_once_is_corrected_in_every_row(desk: Desk, id_: str) -> None:
    page = opened(desk, id_)
    page.fill("Site", "B")
    page.fill("Measurement point", "q")
    page.fill("Depth (mm), row 4", "2.7")
    assert page.sends("Correct", 1)
    for words in ("A becomes B", "nothing becomes q", "2,6 becomes 2.7"):
        page.shows(words)
    page.press("Correct it")
    entry = history(desk, id_)[-1]
    assert entry.cells == {
        **{f"{line}/site": "B" for line in (2, 3, 4)},
        **{f"{line}/spot": "q" for line in (2, 3, 4)},
        "4/depth_mm": "2.7",
    }
    page.fill("Measurement point", "")
    page.press("Correct")
    page.shows("q becomes nothing")
    page.press("Correct it")
    assert page.field("Measurement point").value == ""


def test_a_correction_after_another_persons_is_rejected(desk: Desk, id_: str) -> None:
    page = opened(desk, id_)
    page.fill("Depth (mm), row 3", "2.15")
    page.press("Correct")
    correct(desk, id_, "1", {"2/depth_mm": "1.6"})
    assert not page.sends("Correct it", 1)
    assert page.outcome() == "bad"
    assert len(history(desk, id_)) == 2


# A kept campaign as a page sees it


def test_a_session_hears_what_others_corrected(desk: Desk, id_: str) -> None:
    session, other = CorrectionSession(desk.lab, id_), CorrectionSession(desk.lab, id_)
    written = correct(desk, id_, "1", {"3/depth_mm": "2.15"})
    assert written == history(desk, id_)[-1]
    assert session.test("penetration.csv", "1").history == []
    before = session.quick_results("A").experiments["penetration.csv", "1"]
    for _ in range(2):
        session.refresh()
        assert len(session.test("penetration.csv", "1").history) == 2
    assert session.test("penetration.csv", "1").rows[0].cells["3/depth_mm"] == "2.15"
    assert session.quick_results("A").experiments["penetration.csv", "1"] != before
    assert other.quick_results("A").experiments["penetration.csv", "1"] == before
    entry = NewEntry(action="undo", file="penetration.csv", test="1", about=written.sequence)
    session.write_down(entry, seen=written.sequence)
    assert session.test("penetration.csv", "1").rows[0].corrections == []
    assert session.quick_results("A").experiments["penetration.csv", "1"] == before


def test_a_workbook_that_corrects_itself_is_corrected_there(desk: Desk, tmp_path: Path) -> None:
    columns = ["file", "experiment", "row", "column", "old", "new", "who", "when", "why"]
    content = packed(
        campaign=[["key", "value"], ["name", "Desk"]],
        density=[["sample", "site", "snow_density_kg_per_m3"], ["1", "A", "350"]],
        corrections=[columns],
    )
    (tmp_path / "book").mkdir()
    (tmp_path / "book" / "Hang.xlsx").write_bytes(content)
    id_ = desk.lab.store.add(tmp_path / "book").id
    session = CorrectionSession(desk.lab, id_)
    entry = NewEntry(action="cancel", file="density.csv", test="1", why="slip")
    with raises(StoreError, "in_a_workbook"):
        session.write_down(entry, seen=0)


@pytest.mark.parametrize("act", [CANCEL, "Undo"])
def test_an_unconfirmed_correction_is_not_lost(desk: Desk, id_: str, act: str) -> None:
    page = opened(desk, id_)
    page.fill("Depth (mm), row 2", "1.6")
    page.press("Correct")
    page.press("Correct it")
    before = history(desk, id_)
    page.fill("Site", "B")
    page.press(undo_button(page) if act == "Undo" else act)
    assert page.field("Site").value == "B"
    assert page.focused() is page.field("Why")
    assert "good" not in page.status()
    assert history(desk, id_) == before
    page.press("Leave it as it was")
    assert page.field("Site").value == "A"


IN_KG = """Versuch,Ort,Werkzeug,Kantwinkel,Last [KG],Tiefe
,,,°,,cm
1,A,ski piece,30,10,"0,05"
1,A,ski piece,30,50,"0,141"
"""
COLUMNS_OF_KG = 'columns = {Versuch = "experiment", Ort = "site", Werkzeug = "tool", Kantwinkel = "edge_angle_deg", '
MAPPED = COLUMNS_OF_KG + '"Last [KG]" = "load_N", Tiefe = "depth_mm"}\n'


def test_cells_in_another_unit_have_it_in_their_labels(desk: Desk, tmp_path: Path) -> None:
    """50 kg are 490.3 N, and 0.141 cm are 1.41 mm: H_V = 1.424 N/mm³ at 30° on 200 mm of ski."""
    id_ = kept(desk, tmp_path / "kg", {"campaign.toml": MAPPED + TOML, "penetration.csv": IN_KG})
    page = opened(desk, id_)
    shown = values(page.between("h2 Test 1", "button[main] Correct"))
    cells = {
        "Load (kg), row 3": "10",
        "Depth (cm), row 3": "0,05",
        "Load (kg), row 4": "50",
        "Depth (cm), row 4": "0,141",
    }
    assert shown.items() >= cells.items()
    entry = correct(desk, id_, "1", {"4/load_N": "25"})
    assert entry.cells == {"4/load_N": "25"}
    session = CorrectionSession(desk.lab, id_)
    row = session.quick_results("A").experiments["penetration.csv", "1"]
    assert row["H_V_N_per_mm3"] == pytest.approx(1.424 / 2.0, rel=1e-3)
    assert " row 4 to 25" in undo_button(opened(desk, id_))


@pytest.mark.parametrize(("typed", "taken"), [("0,35", True), ("0,917", True), ("0,95", False), ("350", False)])
def test_limits_are_those_of_the_unit_of_the_cells(desk: Desk, tmp_path: Path, typed: str, taken: bool) -> None:
    """No snow is denser than ice, 917 kg/m³."""
    rows = "sample,site,Dichte [g/cm3]\n1,A,0.3\n2,A,0.4\n"
    toml = 'columns."Dichte [g/cm3]" = "snow_density_kg_per_m3"\n' + TOML
    id_ = kept(desk, tmp_path / "dense", {"campaign.toml": toml, "density.csv": rows})
    page = opened(desk, id_, table="density.csv")
    page.fill("Density (g/cm³)", typed)
    page.press("Correct")
    error = page.field("Density (g/cm³)").error
    assert (error is None) is taken
    assert taken or "0.917" in error
