"""Campaigns: the list and the form that describes one."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
from nicegui import ui

from skisnow import samples
from skisnow.campaign import write_reference
from skisnow.campaign.importing.answers import TEMPLATES
from skisnow.campaign.importing.folder import RECORD
from skisnow.campaign.store import Journals, NewEntry
from skisnow.web.edit_session import EditSession

from ..desk import Desk, Sheet, in_this_process, values

TOML = """name = "Slope"
place = "a hill"
observers = ["Ada", "Bo"]
load_steps_N = [20.0, 40.5]
gauge_resolution_mm = 0.01
moment_uncertainty_Nm = 0.5

[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200.0
width_mm = 62.0

[[tool]]
name = "round"
shape = "disc"
diameter_mm = 40.0

[[plate]]
name = "blade"
length_mm = 100.0
"""


def begun(desk: Desk, text: str = TOML) -> str:
    return Journals(desk.lab.store).begin(text)


def add_shear(desk: Desk, id_: str, name: str = "1") -> None:
    """A shear test."""
    cells = {"experiment": name, "site": "A", "plate": "blade", "edge_angle_deg": "90", "depth_mm": "6"}
    cells |= {"lever_arm_mm": "250", "moment_Nm": "30"}
    entry = NewEntry(action="add", file="shear.csv", test=name, cells=cells, position=0)
    Journals(desk.lab.store).append(id_, entry, seen=0)


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
    page = desk.open(f"/?added={id_}")
    page.shows(" · 1 error, 3 warnings")
    links = [page.link(text) for text in ("Correct", "Analysis", "Export")]
    assert links == [f"/correct/{id_}", f"/analysis/kept/{id_}", f"/export/kept/{id_}.zip"]
    (announced,) = (each for each in page.of(ui.label) if "good" in each.classes)
    assert announced.props["role"] == "status"
    assert page.link("Analysis of this campaign") == f"/analysis/kept/{id_}"
    assert "Analysis of this campaign" not in "".join(desk.open("/?added=1").outline())
    assert not any("good" in each.classes for each in desk.open("/").of(ui.label))


def test_cards_lead_to_the_three_ways_to_begin(desk: Desk) -> None:
    page = desk.open("/")
    ways = [each.props["href"] for each in page.tagged("a") if "way" in each.classes]
    assert ways == ["/describe", "/carve", "/simulate"]
    assert all(desk.get(way).status_code == 200 for way in ways)


WORKBOOK = (Path(samples.__file__).parent / "files" / "two-sites.xlsx").read_bytes()


def test_workbook_is_proposed_stored_and_taken_back(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    in_this_process(monkeypatch, "transfer", "pages.import_file")
    answer = desk.post("/import", files={"files": ("two-sites.xlsx", WORKBOOK)})
    assert answer.status_code == 303
    page = desk.open(answer.headers["location"])
    page.shows("1.163")
    page.fill("Unit of Last", "N")  # the file states kg
    page.shows("other_unit")
    page.fill("Unit of Last", "kg")
    page.shows("1.163")
    page.fill("Name of the template", "glacier")
    page.press("Save the answers as a template")
    page.shows("glacier")
    assert (desk.lab.runs.parent / TEMPLATES / "glacier.toml").is_file()
    again = desk.post("/import", files={"files": ("two-sites.xlsx", WORKBOOK)})
    assert "saved:glacier" in desk.open(again.headers["location"]).field("Template").options
    page.press("Store the campaign")
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


def add_reading(desk: Desk, id_: str, tool: str) -> None:
    cells = {"experiment": "9", "site": "A", "tool": tool, "edge_angle_deg": "0", "load_N": "20", "depth_mm": "2"}
    entry = NewEntry(action="add", file="penetration.csv", test="9", cells=cells, position=0)
    Journals(desk.lab.store).append(id_, entry, seen=0)


def stored_description(desk: Desk) -> dict[str, Any]:
    """The description of the only draft."""
    (head,) = Journals(desk.lab.store).list()
    return tomllib.loads(EditSession(desk.lab, head.id).campaign.description)


CAMPAIGN_NAME = "Name of the campaign"
LOADS = "Disc loads (N), with blanks between"
STORE = "Store and enter tests"


def test_a_new_campaign_is_stored_as_it_is_typed(desk: Desk) -> None:
    page = desk.open("/describe")
    page.fill(CAMPAIGN_NAME, " Slope ")
    page.fill("Place", " a hill ")
    page.fill("Observers, with commas between", "Ada, ,Bo ")
    page.fill("Disc loads (N), with blanks between", "20; 40,5")
    page.fill("Step of the depth gauge (mm)", "0,01")
    page.fill("Uncertainty of the moment (N m)", "0.5")
    page.press("Another tool")
    page.fill("Name of tool 2", " round ")
    page.fill("Shape of tool 2", "disc")
    page.fill("Diameter (mm) of tool 2", "40")
    page.fill("Name of plate 1", "blade")
    page.press("Another plate")  # stays empty, and is left out
    page.press("Store and enter tests")
    (head,) = Journals(desk.lab.store).list()
    assert EditSession(desk.lab, head.id).campaign.description == TOML
    page.told(f'lab.leave("/enter/{head.id}")')


def test_a_campaign_that_is_sent_twice_is_begun_once(desk: Desk) -> None:
    page = desk.open("/describe")
    page.fill(CAMPAIGN_NAME, "Slope")
    (button,) = (each for each in page.tagged("q-btn") if each.text == "Store and enter tests")
    page.fire(button, "click", {"number": 1, "once": "a"})
    page.fire(button, "click", {"number": 2, "once": "a"})
    assert len(Journals(desk.lab.store).list()) == 1
    assert [each for each in page.scripts if "answered" in each] == ["lab.answered(1, true)", "lab.answered(2, true)"]


@pytest.mark.parametrize(
    ("typed", "code"),
    [
        ({}, "no_name"),
        ({CAMPAIGN_NAME: "  "}, "no_name"),
        ({CAMPAIGN_NAME: "S", LOADS: "20 x"}, "not_a_number"),
        ({CAMPAIGN_NAME: "S", "Uncertainty of the load (N)": "much"}, "not_a_number"),
        ({CAMPAIGN_NAME: "S", "Width (mm) of tool 1": "wide"}, "not_a_number"),
        ({CAMPAIGN_NAME: "S", "Name of tool 1": ""}, "no_name"),
        ({CAMPAIGN_NAME: "S", "Name of plate 1": " "}, "no_name"),
    ],
)
def test_a_description_that_cannot_be_stored_stays_on_the_page(desk: Desk, typed: dict[str, str], code: str) -> None:
    page = desk.open("/describe")
    for name, text in typed.items():
        page.fill(name, text)
    (button,) = (each for each in page.tagged("q-btn") if each.text == STORE)
    page.fire(button, "click", {"number": 1})
    assert page.outcome() == "bad"
    assert desk.code == code
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert any('"scrollIntoView"' in each for each in page.scripts)
    assert not any("lab.leave" in each for each in page.scripts)
    assert Journals(desk.lab.store).list() == ()
    assert {name: page.field(name).value for name in typed} == typed


def rows(page: Sheet, kind: str) -> int:
    return sum(line.startswith(f"field Name of {kind} ") for line in page.outline())


def test_rows_and_shapes_that_the_browser_kept_come_back(desk: Desk) -> None:
    page = desk.open("/describe")
    kept_rows = {"rows": {"tool": 3, "plate": 2}, "choices": {"Shape of tool 2": "disc", "Shape of tool 3": "square"}}
    page.fire(page.client.layout, "grow", kept_rows)
    assert (rows(page, "tool"), rows(page, "plate")) == (3, 2)
    assert [page.field(f"Shape of tool {number}").value for number in (1, 2, 3)] == ["ski", "disc", "ski"]
    assert page.scripts[-1] == "lab.grown()"


@pytest.mark.parametrize(
    ("said", "n_tools"),
    [
        (None, 1),
        ({"rows": [3], "choices": None}, 1),
        ({"rows": {"tool": "3"}}, 1),
        ({"rows": {"tool": 0}, "choices": {"Shape of tool 1": 7}}, 1),
        ({"rows": {"tool": 201}}, 200),
    ],
)
def test_invalid_row_counts_from_a_browser_are_ignored(desk: Desk, said: object, n_tools: int) -> None:
    page = desk.open("/describe")
    page.fire(page.client.layout, "grow", said)
    assert (rows(page, "tool"), rows(page, "plate")) == (n_tools, 1)
    assert page.field("Shape of tool 1").value == "ski"
    assert page.scripts[-1] == "lab.grown()"


def test_the_description_of_a_draft_is_shown_as_it_is(desk: Desk) -> None:
    page = desk.open(f"/describe?entry={begun(desk)}")
    assert list(values(page.outline()).values()) == [
        *("Slope", "a hill", "Ada, Bo", "20 40.5", "0.01", "", "0.5", ""),
        *("ski piece", "ski", "200", "62"),
        *("round", "disc", "40"),
        *("blade", "100"),
    ]
    assert page.focused() is None


def test_a_description_that_is_changed_is_written_down_and_one_that_is_not_is_not(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/describe?entry={id_}")
    page.press("Store and enter tests")
    page.told(f'lab.leave("/enter/{id_}")')
    assert len(Journals(desk.lab.store).entries(id_)) == 1
    page.fill("Place", "another hill")
    page.press("Store and enter tests")
    assert [each.action for each in Journals(desk.lab.store).entries(id_)] == ["describe", "describe"]
    assert stored_description(desk) == tomllib.loads(TOML) | {"place": "another hill"}


def test_the_description_that_another_person_wrote_meanwhile_is_not_written_over(desk: Desk) -> None:
    id_ = begun(desk)
    mine, theirs = desk.open(f"/describe?entry={id_}"), desk.open(f"/describe?entry={id_}")
    theirs.fill("Place", "theirs")
    theirs.press("Store and enter tests")
    mine.fill("Place", "mine")
    mine.press("Store and enter tests")
    assert "campaign.toml" in mine.shows("[status bad]")
    assert stored_description(desk)["place"] == "theirs"


def test_what_the_form_does_not_know_stays(desk: Desk) -> None:
    id_ = begun(desk, TOML + '\n[screening]\nexclude = ["poor_fit"]\n')
    page = desk.open(f"/describe?entry={id_}")
    page.fill("Place", "")
    page.press("Store and enter tests")
    page.told("lab.leave")
    assert "place" not in stored_description(desk)
    assert stored_description(desk)["screening"] == {"exclude": ["poor_fit"]}


@pytest.mark.parametrize(
    ("kind", "name", "test"), [("plate", "blade", "1"), ("tool", "round", "9"), ("tool", "ski piece", "9")]
)
def test_a_name_that_tests_were_made_with_stays(desk: Desk, kind: str, name: str, test: str) -> None:
    id_ = begun(desk)
    if kind == "plate":
        add_shear(desk, id_)
    else:
        add_reading(desk, id_, name)
    page = desk.open(f"/describe?entry={id_}")
    place = f"Name of {kind} {2 if name == 'round' else 1}"
    page.fill(place, "renamed")
    page.press("Store and enter tests")
    assert page.outcome() == "bad"
    assert (desk.code, desk.fields["test"], desk.fields["name"]) == ("name_in_use", test, name)
    page.fill(place, name)
    page.fill("Place", "elsewhere")
    page.press("Store and enter tests")
    page.told("lab.leave")
    assert stored_description(desk)["place"] == "elsewhere"


@pytest.mark.parametrize("address", ["/describe?entry=none", "/enter/none", "/correct/none"])
def test_an_address_of_no_campaign_is_not_found(desk: Desk, address: str) -> None:
    assert desk.get(address).status_code == 404
    assert desk.code == "no_campaign"
    desk.failures.clear()
