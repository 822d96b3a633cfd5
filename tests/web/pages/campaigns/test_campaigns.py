"""The list of campaigns: what stands on it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from skisnow.campaign import write_reference
from skisnow.campaign.store import Journals, NewEntry
from skisnow.web.elements import FIRST
from skisnow.web.language import minute_words

from .shared import TOML, add_shear, begun, handlers

if TYPE_CHECKING:
    from ..desk import Desk

IMPORT = [
    "h2 Import",
    "[quiet] A campaign's folder, its files, a workbook (.xlsx), or a zip. It is stored byte for byte; corrections "
    "stand beside it. At most 200 files.",
    "Folder",
    "Import folder",
    "Files or zip",
    "Import files or zip",
]


def kept(desk: Desk, folder: Path, text: str = TOML) -> str:
    return desk.kept(folder, {"campaign.toml": text, "density.csv": "sample,site,snow_density_kg_per_m3\n1,A,350\n"})


def last_at(desk: Desk, id_: str) -> str:
    (head,) = (each for each in Journals(desk.lab.store).list() if each.id == id_)
    return minute_words(head.last_at)


def test_an_empty_lab_says_what_it_is_for_and_offers_a_sample(desk: Desk) -> None:
    page = desk.open("/")
    assert page.outline() == [
        "h1 Campaigns",
        "Here what was measured on a slope becomes snow hardness and shear stress, and these become turns of a ski: "
        "enter tests, analyse them, carve and simulate.",
        "link[main] New campaign -> /describe",
        "button Look at a sample campaign",
        "h2 Drafts",
        "[quiet] None. Begin one with New campaign.",
        "h2 Imported",
        "[quiet] None. Import one below.",
        *IMPORT,
    ]
    assert handlers(page, "Look at a sample campaign") == [FIRST]


def test_the_sample_is_the_synthetic_campaign_and_its_analysis_is_shown(desk: Desk, tmp_path: Path) -> None:
    page = desk.open("/")
    page.press("Look at a sample campaign")
    page.told("open ")
    (stored,) = desk.lab.store.list()
    assert [each for each in page.scripts if each.startswith("open ")] == [
        f"open {{'path': '/analysis/kept/{stored.id}', 'new_tab': False}}"
    ]
    write_reference(tmp_path / "sample", seed=1)
    assert desk.lab.store.add(tmp_path / "sample").already_stored


def test_a_draft_stands_with_its_place_its_tests_and_its_last_entry(desk: Desk) -> None:
    id_ = begun(desk)
    for name in "123":
        add_shear(desk, id_, name)
    (entry,) = (each for each in Journals(desk.lab.store).entries(id_) if each.test == "2")
    undo = NewEntry(action="undo", file="shear.csv", test="2", about=entry.sequence)
    Journals(desk.lab.store).append(id_, undo, seen=entry.sequence)
    assert desk.open("/").outline() == [
        "h1 Campaigns",
        "link[main] New campaign -> /describe",
        "h2 Drafts",
        "h3 Slope",
        f"[quiet] a hill · 2 tests · last entry {last_at(desk, id_)}",
        f"link[main] Enter tests -> /enter/{id_}",
        f"link Analysis -> /analysis/entry/{id_}",
        f"link Export -> /export/entry/{id_}.zip",
        "h2 Imported",
        "[quiet] None. Import one below.",
        *IMPORT,
    ]


def test_a_draft_without_name_and_place_is_there_too(desk: Desk) -> None:
    id_ = begun(desk, 'observers = ["Ada"]\n')
    outline = desk.open("/").outline()
    assert outline[outline.index("h2 Drafts") + 1 :][:2] == [
        "h3 (no name)",
        f"[quiet] 0 tests · last entry {last_at(desk, id_)}",
    ]


def test_a_damaged_draft_is_named_beside_the_others(desk: Desk) -> None:
    broken = begun(desk, 'name = "broken"\n')
    sound = begun(desk)
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE journal_entry SET cells = replace(cells, 'broken', 'bsoken')")
    page = desk.open("/")
    at = page.outline().index(f"h3 {broken}")
    line = page.outline()[at + 1]
    assert line.startswith("[bad] The entry ") and f"of the campaign in entry {broken} is damaged" in line
    assert f"link[main] Enter tests -> /enter/{sound}" in page.outline()
    assert f"link[main] Enter tests -> /enter/{broken}" not in page.outline()
    assert len([each for each in page.tagged("section") if "card" in each.classes]) == 2


def test_an_imported_campaign_stands_with_what_its_check_found(desk: Desk, tmp_path: Path) -> None:
    id_ = kept(desk, tmp_path / "one")
    stored = desk.lab.store.show(id_)
    with desk.lab.store.engine.begin() as connection:
        connection.exec_driver_sql("UPDATE campaign SET n_errors = 1, n_warnings = 3")
    page = desk.open("/?added=1")
    assert page.outline() == [
        "h1 Campaigns",
        "[good] The campaign is imported, byte for byte.",
        "link[main] New campaign -> /describe",
        "h2 Drafts",
        "[quiet] None. Begin one with New campaign.",
        "h2 Imported",
        "h3 Slope",
        f"[quiet] {id_} · added {minute_words(stored.added_at)} · 1 error, 3 warnings",
        f"link Correct -> /correct/{id_}",
        f"link Analysis -> /analysis/kept/{id_}",
        f"link Export -> /export/kept/{id_}.zip",
        *IMPORT,
    ]
    (said,) = (each for each in page.of() if getattr(each, "text", "") == "The campaign is imported, byte for byte.")
    assert said.props["role"] == "status"
    assert not any("imported, byte" in line for line in desk.open("/").outline())


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
