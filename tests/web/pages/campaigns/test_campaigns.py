"""Contents of the list of campaigns."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from nicegui import ui

from skisnow.campaign import write_reference
from skisnow.campaign.store import Journals, NewEntry
from skisnow.web.elements import FIRST

from .shared import TOML, add_shear, begun, handlers

if TYPE_CHECKING:
    from ..desk import Desk

SAMPLE = "Look at a sample campaign"


def kept(desk: Desk, folder: Path, text: str = TOML) -> str:
    return desk.kept(folder, {"campaign.toml": text, "density.csv": "sample,site,snow_density_kg_per_m3\n1,A,350\n"})


def test_an_empty_lab_offers_a_new_campaign_and_a_sample(desk: Desk) -> None:
    page = desk.open("/")
    assert page.link("New campaign") == "/describe"
    assert handlers(page, SAMPLE) == [FIRST]


def test_the_sample_is_the_synthetic_campaign_and_its_analysis_is_shown(desk: Desk, tmp_path: Path) -> None:
    page = desk.open("/")
    page.press(SAMPLE)
    page.told("open ")
    (stored,) = desk.lab.store.list()
    page.told(f"/analysis/kept/{stored.id}'")
    write_reference(tmp_path / "sample", seed=1)
    assert desk.lab.store.add(tmp_path / "sample").already_stored


def test_a_draft_leads_to_its_entry_analysis_and_export(desk: Desk) -> None:
    id_ = begun(desk)
    for name in "123":
        add_shear(desk, id_, name)
    (entry,) = (each for each in Journals(desk.lab.store).entries(id_) if each.test == "2")
    undo = NewEntry(action="undo", file="shear.csv", test="2", about=entry.sequence)
    Journals(desk.lab.store).append(id_, undo, seen=entry.sequence)
    page = desk.open("/")
    page.shows(" · 2 tests · ")
    links = [page.link(text) for text in ("Enter tests", "Analysis", "Export")]
    assert links == [f"/enter/{id_}", f"/analysis/entry/{id_}", f"/export/entry/{id_}.zip"]


def test_a_draft_without_a_name_is_listed(desk: Desk) -> None:
    begun(desk, 'observers = ["Ada"]\n')
    assert "h3 (no name)" in desk.open("/").outline()


def test_a_damaged_draft_is_listed_without_its_cells_or_a_link(desk: Desk) -> None:
    broken, sound = begun(desk, 'name = "broken"\n'), begun(desk)
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE journal_entry SET cells = replace(cells, 'broken', 'bsoken')")
    page = desk.open("/")
    assert page.outline()[page.outline().index(f"h3 {broken}") + 1].startswith("[bad] ")
    assert [each.props["href"] for each in page.of(ui.link) if each.text == "Enter tests"] == [f"/enter/{sound}"]
    assert len([each for each in page.tagged("section") if "card" in each.classes]) == 2
    answer = desk.get(f"/enter/{broken}")
    assert (answer.status_code, desk.code) == (404, "damaged")
    assert "bsoken" not in answer.text + page.html
    desk.failures.clear()


def test_an_imported_campaign_leads_to_its_pages_and_announces_its_import(desk: Desk, tmp_path: Path) -> None:
    id_ = kept(desk, tmp_path / "one")
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE campaign SET n_errors = 1, n_warnings = 3")
    page = desk.open("/?added=1")
    page.shows(" · 1 error, 3 warnings")
    links = [page.link(text) for text in ("Correct", "Analysis", "Export")]
    assert links == [f"/correct/{id_}", f"/analysis/kept/{id_}", f"/export/kept/{id_}.zip"]
    (announced,) = (each for each in page.of(ui.label) if "good" in each.classes)
    assert announced.props["role"] == "status"
    assert not any("good" in each.classes for each in desk.open("/").of(ui.label))


def test_a_campaign_whose_check_failed_is_not_checked(desk: Desk, tmp_path: Path) -> None:
    id_ = kept(desk, tmp_path / "one")
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE campaign SET n_errors = NULL, n_warnings = NULL")
    assert desk.open("/").shows(f"[quiet] {id_} · ").endswith(" · not checked")


def test_the_last_imported_stands_first(desk: Desk, tmp_path: Path) -> None:
    for name in ("first", "second"):
        kept(desk, tmp_path / name, f'name = "{name}"\n')
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE campaign SET added_at = '2001' || substr(added_at, 5) WHERE name = 'first'")
    outline = desk.open("/").outline()
    assert outline.index("h3 second") < outline.index("h3 first")


def test_a_folder_or_files_are_sent_by_plain_forms(desk: Desk) -> None:
    page = desk.open("/")
    forms = [each for each in page.of() if each.tag == "form"]
    for form in forms:
        assert (form.props["method"], form.props["action"]) == ("post", "/import")
        assert form.props["enctype"] == "multipart/form-data"
    inputs = [each.props for each in page.of() if each.tag == "input"]
    assert [(each["type"], each["name"], each["id"]) for each in inputs] == [
        ("file", "files", "import-folder"),
        ("file", "files", "import-files"),
    ]
    assert all("multiple" in each and "required" in each for each in inputs)
    assert ["webkitdirectory" in each for each in inputs] == [True, False]
    assert [each.props["for"] for each in page.tagged("label")] == ["import-folder", "import-files"]
    assert [each.props["type"] for each in page.tagged("button")] == ["submit", "submit"]
