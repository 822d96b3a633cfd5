"""The description of a campaign: its form, stored values, and refusals."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING, Any

import pytest

from skisnow.campaign.store import Journals, NewEntry
from skisnow.web.edit_session import EditSession
from skisnow.web.elements import StatusLine
from skisnow.web.page_requests import ASK, ASK_FOR_ROW, ONWARD

from ..desk import values
from .shared import TOML, add_shear, begun, handlers

if TYPE_CHECKING:
    from ..desk import Desk, Sheet


def add_reading(desk: Desk, id_: str, tool: str) -> None:
    cells = {"experiment": "9", "site": "A", "tool": tool, "edge_angle_deg": "0", "load_N": "20", "depth_mm": "2"}
    entry = NewEntry(action="add", file="penetration.csv", test="9", cells=cells, position=0)
    Journals(desk.lab.store).append(id_, entry, seen=0)


def stored_description(desk: Desk) -> dict[str, Any]:
    """The description of the only draft."""
    (head,) = Journals(desk.lab.store).list()
    return tomllib.loads(EditSession(desk.lab, head.id).campaign.description)


LOADS = "Disc loads (N), with blanks between"
STORE = "Store and enter tests"


def test_the_form_of_a_new_campaign_has_the_published_discs_and_tool(desk: Desk) -> None:
    page = desk.open("/describe")
    assert page.field(LOADS).value == "12 92 172 252 332 412 492"
    tool = [page.field(f"{name} of tool 1").value for name in ("Name", "Shape", "Length (mm)", "Width (mm)")]
    assert tool == ["ski piece", "ski", "200", "62"]
    assert [page.field(f"{name} of plate 1").value for name in ("Name", "Length (mm)")] == ["plate", "100"]
    assert page.focused() is page.field("Name of the campaign")
    assert list(page.field("Shape of tool 1").options) == ["ski", "disc", "cylinder"]
    assert page.at_first.count("lab.answered(0, true)") == 1
    (status,) = page.of(StatusLine)
    assert status.props["role"] == "status"
    assert handlers(page, STORE) == [ASK]
    assert handlers(page, "Another tool") == handlers(page, "Another plate") == [ASK_FOR_ROW]
    at_enter = [each.js_handler for form in page.tagged("div") for each in form._event_listeners.values()]
    assert at_enter == [ONWARD]
    assert [each.props["data-rows"] for each in page.tagged("div") if "data-rows" in each.props] == ["tool", "plate"]


def test_a_new_campaign_is_stored_as_it_is_typed(desk: Desk) -> None:
    page = desk.open("/describe")
    page.fill("Name of the campaign", " Slope ")
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
    page.fill("Name of the campaign", "Slope")
    (button,) = (each for each in page.tagged("q-btn") if each.text == "Store and enter tests")
    page.fire(button, "click", {"number": 1, "once": "a"})
    page.fire(button, "click", {"number": 2, "once": "a"})
    assert len(Journals(desk.lab.store).list()) == 1
    assert [each for each in page.scripts if "answered" in each] == ["lab.answered(1, true)", "lab.answered(2, true)"]


@pytest.mark.parametrize(
    ("typed", "code"),
    [
        ({}, "no_name"),
        ({"Name of the campaign": "  "}, "no_name"),
        ({"Name of the campaign": "S", LOADS: "20 x"}, "not_a_number"),
        ({"Name of the campaign": "S", "Uncertainty of the load (N)": "much"}, "not_a_number"),
        ({"Name of the campaign": "S", "Width (mm) of tool 1": "wide"}, "not_a_number"),
        ({"Name of the campaign": "S", "Name of tool 1": ""}, "no_name"),
        ({"Name of the campaign": "S", "Name of plate 1": " "}, "no_name"),
    ],
)
def test_a_description_that_cannot_be_stored_is_rejected_and_stays(
    desk: Desk, typed: dict[str, str], code: str
) -> None:
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


def test_each_shape_asks_for_its_own_lengths(desk: Desk) -> None:
    page = desk.open("/describe")
    asked = {"ski": ["Length (mm)", "Width (mm)"], "disc": ["Diameter (mm)"], "cylinder": ["Width (mm)", "Radius (mm)"]}
    for shape in ("disc", "cylinder", "ski"):
        page.fill("Shape of tool 1", shape)
        lengths = [line.split(" of ")[0] for line in page.outline() if line.endswith("numeric") and "of tool 1" in line]
        assert lengths == [f"field {each}" for each in asked[shape]]


def test_another_row_is_empty_and_has_the_focus(desk: Desk) -> None:
    page = desk.open("/describe")
    page.press("Another tool")
    names = ("Name", "Shape", "Length (mm)", "Width (mm)")
    assert [page.field(f"{name} of tool 2").value for name in names] == ["", "ski", "", ""]
    assert page.focused() is page.field("Name of tool 2")
    page.press("Another tool")
    assert page.focused() is page.field("Name of tool 3")
    page.press("Another plate")
    assert page.focused() is page.field("Name of plate 2")
    assert [page.field(f"{name} of plate 2").value for name in ("Name", "Length (mm)")] == ["", ""]


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
def test_what_no_form_has_kept_counts_as_not_said(desk: Desk, said: object, n_tools: int) -> None:
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


def test_the_description_that_somebody_else_wrote_meanwhile_is_not_written_over(desk: Desk) -> None:
    id_ = begun(desk)
    mine, theirs = desk.open(f"/describe?entry={id_}"), desk.open(f"/describe?entry={id_}")
    theirs.fill("Place", "theirs")
    theirs.press("Store and enter tests")
    mine.fill("Place", "mine")
    mine.press("Store and enter tests")
    mine.shows("[status bad] Nothing was stored: somebody wrote about campaign.toml meanwhile")
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
