"""Contents of the list of campaigns."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from nicegui import ui

from skisnow import samples
from skisnow.campaign import write_reference
from skisnow.campaign.importing import RECORD, TEMPLATES
from skisnow.campaign.store import Journals, NewEntry
from skisnow.replay.page import MODULES
from skisnow.web.replay_addresses import FILES, FIRST, FIRST_FILE

from ..desk import Desk, in_this_process
from .shared import TOML, add_shear, begun

if TYPE_CHECKING:
    from ..desk import Desk


SAMPLE = "Look at a sample campaign"


def kept(desk: Desk, folder: Path, text: str = TOML) -> str:
    return desk.kept(folder, {"campaign.toml": text, "density.csv": "sample,site,snow_density_kg_per_m3\n1,A,350\n"})


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


@pytest.mark.parametrize("language", ["en", "de"])
def test_cards_lead_to_the_three_ways_to_begin(desk: Desk, language: str) -> None:
    page = desk.open("/", language)
    ways = [each.props["href"] for each in page.tagged("a") if "way" in each.classes]
    assert ways == ["/describe", "/carve", "/simulate"]
    assert all(desk.get(way).status_code == 200 for way in ways)


def test_the_replay_is_small_and_is_a_run_of_several_seconds_with_its_gates(desk: Desk) -> None:
    assert FIRST_FILE.stat().st_size <= 500_000
    answer = desk.get(FIRST)
    assert answer.headers["content-encoding"] == "gzip"
    content = answer.content  # unpacked by the client
    assert content[:4] == b"SKRP"
    header = json.loads(content[8 : 8 + int.from_bytes(content[4:8], "little")])
    assert header["arrays"]["time"]["shape"][0] * 0.04 > 5.0
    assert header["arrays"]["gate_place"]["shape"][0] >= 4
    assert all(desk.get(f"{FILES}/{name}").status_code == 200 for name in MODULES)


WORKBOOK = (Path(samples.__file__).parent / "files" / "two-sites.xlsx").read_bytes()


@pytest.mark.parametrize(
    ("language", "name", "save", "template", "store"),
    [
        ("en", "Name of the template", "Save the answers as a template", "Template", "Store the campaign"),
        ("de", "Name der Vorlage", "Antworten als Vorlage speichern", "Vorlage", "Kampagne speichern"),
    ],
)
def test_workbook_is_proposed_stored_and_taken_back(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, language: str, name: str, save: str, template: str, store: str
) -> None:
    in_this_process(monkeypatch, "transfer", "pages.import_file")
    answer = desk.post("/import", language, files={"files": ("two-sites.xlsx", WORKBOOK)})
    assert answer.status_code == 303
    page = desk.open(answer.headers["location"], language)
    page.shows("1.163")
    page.fill(name, "glacier")
    page.press(save)
    page.shows("glacier")
    assert (desk.lab.runs.parent / TEMPLATES / "glacier.toml").is_file()
    again = desk.post("/import", language, files={"files": ("two-sites.xlsx", WORKBOOK)})
    assert "saved:glacier" in desk.open(again.headers["location"], language).field(template).options
    page.press(store)
    page.told("open ")
    (stored,) = desk.lab.store.list()
    assert {file.path for file in stored.files} == {
        "campaign.toml", "penetration.csv", "shear.csv", "original/two-sites.xlsx", RECORD,
    }  # fmt: skip
    assert desk.lab.store.contents(stored.id, {"original/two-sites.xlsx"})[1].popitem()[1] == WORKBOOK
    assert stored.n_errors == 0
    desk.do(lambda: desk.lab.store.remove(stored.id))
    assert desk.lab.store.list() == ()
    assert desk.lab.store.verify() == ()
