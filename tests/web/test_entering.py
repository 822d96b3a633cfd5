"""Entering tests: undo, what is refused, two people at once, a phone, and the keyboard alone."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pytest

from skisnow import read_campaign
from skisnow.campaign.store import Journals, Store, replayed
from skisnow.campaign.store.replayed import campaign_files, write_campaign
from skisnow.web.edit_session import EditSession
from skisnow.web.settings import Lab
from skisnow.web.words import hardness_words

from .conftest import Served, fill, has_text, ready
from .test_day import correct_the_typing_error, create, enter_series, next_series

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page


def hardness_beside(page: Page, served: Served) -> str:
    """H_V beside the series: that of all its readings by the library, not that of fewer of a moment ago."""
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        row = EditSession(Lab(store, served.lab), head.id).quick_results("A").experiments["penetration.csv", "1"]
    words = f"H_V = {hardness_words(row)}"
    page.locator(".beside .value", has_text=words).wait_for()
    return words


@pytest.mark.slow
def test_undo_and_a_second_look(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    ready(page)
    page.get_by_role("button", name="Undo: entered 3.0 mm under 80 N").press("Enter")
    page.get_by_text("Undone.").wait_for()
    has_text(page.get_by_label("Depth under 80 N (mm)"), "")
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        test = replayed(Journals(store).entries(head.id)).test("penetration.csv", "1")
    assert [row.cells["depth_mm"] for row in test.rows] == ["1.5", "22.5", "2.6"]
    assert [entry.action for entry in test.history] == ["add"] * 4 + ["undo"]


def test_the_curve_follows_the_readings(page: Page, served: Served) -> None:
    """Load over depth; under the mouse the reading in numbers and, behind it, what the law says there."""
    create(page, served)
    enter_series(page, "1")
    points = page.locator(".beside path.points")
    drawn = "document.querySelectorAll('.beside path.points')[{}]?.getAttribute('d').split('M').length === 5"
    page.wait_for_function(drawn.format(0))
    assert points.count() == 1
    x, y = (points.get_attribute("d") or "").split("M")[-1].removesuffix("h0").split()
    page.locator(".beside svg[role=img]").hover(position={"x": float(x), "y": float(y)})
    assert (page.locator(".beside svg g text").text_content() or "").startswith("3.000: 80.0 · ")
    next_series(page)
    enter_series(page, "3")
    page.wait_for_function(drawn.format(1))
    behind, own = (each.get_attribute("d") or "" for each in points.all())
    assert (behind.count("M"), own.count("M")) == (4, 4)
    left, top = zip(*(map(float, each.removesuffix("h0").split()) for each in own.split("M")[1:]), strict=True)
    assert sorted(left) == list(left)  # deeper and deeper
    assert sorted(top, reverse=True) == list(top)  # under more and more load, which counts upwards


@pytest.mark.slow
def test_discs_that_are_taken_off_have_fields_of_their_own(page: Page, served: Served) -> None:
    """They come behind the loading, are told from it everywhere, and give k_u/H_V beside the same H_V."""
    create(page, served)
    enter_series(page, "1")
    correct_the_typing_error(page)
    before = hardness_beside(page, served)
    hardness = page.locator(".beside .value")
    assert hardness.inner_text() == before
    page.locator("summary", has_text="Discs taken off one by one").press("Enter")
    ready(page)
    page.get_by_label("Depth back under 60 N (mm)").focus()
    page.keyboard.type("2.95\n2.89\n2,8\n")
    page.get_by_text("Stored: 2.8 mm under 20 N on the way back.").wait_for()
    page.wait_for_function("document.querySelector('.beside .value').innerText.includes('k_u/H_V = ')")
    assert hardness.inner_text().startswith(before)
    page.reload()
    has_text(page.get_by_label("Depth back under 20 N (mm)"), "2.8")
    has_text(page.get_by_label("Depth under 20 N (mm)"), "1.5")
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        campaign = replayed(Journals(store).entries(head.id))
    rows = [row.split(",") for row in campaign_files(campaign)["penetration.csv"].splitlines()]
    load, depth, branch = (rows[0].index(name) for name in ("load_N", "depth_mm", "branch"))
    assert [(row[load], row[depth], row[branch]) for row in rows[-3:]] == [
        ("60", "2.95", "unloading"),
        ("40", "2.89", "unloading"),
        ("20", "2.8", "unloading"),
    ]
    assert [row[branch] for row in rows[1:-3]] == [""] * 4


@pytest.mark.slow
def test_a_depth_that_is_read_once_more_after_waiting_stands_beside_the_first_one(page: Page, served: Served) -> None:
    """At the width of a phone: with its reading in the file's column, flagged where the snow creeps, corrected with a
    reason; the first depths, and with them H_V, stay.

    The gauge steps by 0.01 mm: 0.1 mm more than 2.6 mm is creep.
    """
    page.set_viewport_size({"width": 390, "height": 844})
    create(page, served)
    enter_series(page, "1")
    correct_the_typing_error(page)
    before = hardness_beside(page, served)
    ready(page)
    page.locator("summary", has_text="Depths read once more after waiting").press("Enter")
    fits(page)
    assert page.locator("input:visible, button:visible").evaluate_all(NAMELESS) == []
    page.get_by_label("Depth after waiting under 40 N (mm)").fill("2.1.6")
    page.keyboard.press("Enter")
    page.locator(".refusals li", has_text="“2.1.6”").wait_for()
    press(page, "button", "Next series")
    page.get_by_text("Not stored yet: 40 N after waiting.").wait_for()
    ready(page)
    page.get_by_label("Depth after waiting under 40 N (mm)").fill("2,16")
    page.get_by_label("Depth after waiting under 60 N (mm)").fill("2.8")
    page.keyboard.press("Enter")
    page.get_by_text("Stored after waiting: 2.16 mm under 40 N, 2.8 mm under 60 N.").wait_for()
    page.locator(".beside .marks", has_text="Under one load the depth grew").wait_for()
    ready(page)
    page.get_by_label("Depth after waiting under 60 N (mm)").fill("2.7")
    page.keyboard.press("Enter")
    page.get_by_text("After waiting under 60 N: 2.8 mm becomes 2.7 mm.").wait_for()
    ready(page)
    page.get_by_role("button", name="Correct it").press("Enter")
    page.get_by_text("Corrected; the first reading is kept.").wait_for()
    page.reload()
    has_text(page.get_by_label("Depth after waiting under 60 N (mm)"), "2.7")
    has_text(page.get_by_label("Depth under 60 N (mm)"), "2.6")
    fits(page)
    page.locator(".beside .value", has_text=before).wait_for()
    assert page.locator(".beside .value").inner_text() == before
    assert page.get_by_text("corrected from").all_inner_texts() == ["corrected from 22.5"]
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        campaign = replayed(Journals(store).entries(head.id))
    rows = campaign.test("penetration.csv", "1").rows
    assert [row.cells.get("depth_after_mm", "") for row in rows] == ["", "2.16", "2.7", ""]
    folder = Path(tempfile.mkdtemp(dir=served.store.parent))
    write_campaign(campaign, folder)
    tests = read_campaign(folder).penetration
    assert tests is not None
    assert tests.depth_after is not None
    assert tests.depth_after * 1e3 == pytest.approx([np.nan, 2.16, 2.7, np.nan], nan_ok=True)


def test_a_moment_for_each_turning_angle(page: Page, served: Served) -> None:
    """Rows of one shear test: the next angle is asked for by itself, what a test has once stays, S_f is the largest's.

    30 N m/0.25 m/(100 mm × 6 mm) = 0.2 N/mm²; 20 N m take 2°, so u_y = 30/20 × 2° × 250 mm = 13.1 mm.
    """
    create(page, served)
    page.get_by_role("link", name="Shear").press("Enter")
    page.get_by_role("heading", name="New test").wait_for()
    fill(page, {"Site": "A", "Turning angle (°)": "0", "Edge angle (°)": "90", "Depth (mm)": "6"})
    fill(page, {"Lever arm (mm)": "250", "Moment (N m)": "5"})
    page.keyboard.press("Enter")
    page.get_by_text("Stored: test 1.").wait_for()
    page.get_by_label("Turning angle (°)").and_(page.locator(":focus")).wait_for()
    has_text(page.get_by_label("Depth (mm)"), "6")
    page.keyboard.type("1\n15\n")
    page.locator(".so-far li").nth(1).wait_for()
    page.keyboard.type("2\n25\n")
    page.locator(".so-far li").nth(2).wait_for()
    page.keyboard.type("3\n30\n")
    page.get_by_text("S_f = 0.200 N/mm²").wait_for()
    page.get_by_text("u_y = 13.1 mm").wait_for()
    ready(page)
    fill(page, {"Depth (mm)": "7", "Turning angle (°)": "4", "Moment (N m)": "30"})
    page.keyboard.press("Enter")
    page.locator(".refusals li", has_text="the rows of test 1 have one Depth (mm)").wait_for()


@pytest.mark.slow
def test_what_is_no_number_is_not_stored(page: Page, served: Served) -> None:
    create(page, served)
    fill(page, {"Site": "A", "Edge angle (°)": "95"})
    page.keyboard.press("Enter")
    page.locator(".refusals li", has_text="“95”").wait_for()
    ready(page)
    fill(page, {"Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    page.keyboard.type("1.5.2")
    page.keyboard.press("Enter")
    page.locator(".refusals li", has_text="“1.5.2”").wait_for()
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        assert head.n_entries == 1


def test_a_series_on_a_phone_from_its_first_reading_to_the_last(page: Page, served: Served) -> None:
    """High on the page; no word of too few loads before it is left; a refused last reading is typed over at once."""
    page.set_viewport_size({"width": 390, "height": 844})
    create(page, served)
    fill(page, {"Name of the test": "1", "Site": "A", "Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    first = page.get_by_label("Depth under 20 N (mm)")
    first.and_(page.locator(":focus")).wait_for()
    box, head = first.bounding_box(), page.locator(".lab-head").bounding_box()
    assert box is not None and box["y"] < 300
    assert head is not None and head["height"] < 60  # one row of links as high as a glove needs
    page.keyboard.type("1.5\n2.15\n")
    page.locator(".beside .value", has_text="H_V = ").wait_for()
    marks = page.locator(".beside .marks")
    assert marks.inner_text() == ""
    page.get_by_label("Depth under 80 N (mm)").fill("3,o")
    page.keyboard.press("Enter")
    page.locator(".reading.refused").wait_for()
    marked = "document.activeElement.value?.slice(document.activeElement.selectionStart) === '3,o'"
    page.wait_for_function(marked)
    assert page.locator(":focus").get_attribute("aria-label") == "Depth under 80 N (mm)"
    ready(page)
    page.get_by_label("Depth under 80 N (mm)").fill("")
    press(page, "button", "Next series")
    page.get_by_role("heading", name="New series").wait_for()
    marks.get_by_text("The series has fewer than 3 load steps.").wait_for()


def test_a_refused_last_reading_that_is_put_right_is_no_correction(page: Page, served: Served) -> None:
    """What is stored is the number that was typed, though it stands there with a comma: nobody is asked why."""
    page.set_viewport_size({"width": 390, "height": 844})
    create(page, served)
    fill(page, {"Name of the test": "1", "Site": "A", "Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    page.get_by_label("Depth under 80 N (mm)").fill("3,o")
    page.keyboard.press("Enter")
    page.locator(".reading.refused").wait_for()
    page.wait_for_function("document.activeElement.value?.slice(document.activeElement.selectionStart) === '3,o'")
    ready(page)
    page.keyboard.type("3,1\n")
    page.locator(".reading[data-load='80'] .stored", has_text="stored").wait_for()
    page.get_by_label("Depth under 20 N (mm)").focus()
    ready(page)
    page.get_by_label("Depth under 20 N (mm)").fill("1,2")
    page.keyboard.press("Enter")
    page.locator(".reading[data-load='20'] .stored", has_text="stored").wait_for()
    assert page.get_by_label("Why", exact=True).count() == 0


def test_a_campaign_without_a_plate_says_where_to_name_one(page: Page, served: Served) -> None:
    with Store.open(served.store) as store:
        id_ = Journals(store).begin('name = "Bare"\n')
    page.goto(f"{served.address}enter/{id_}?table=shear.csv")
    page.locator(".bad", has_text="no plate").wait_for()
    assert page.locator(".bad").count() == 1


@pytest.mark.slow
def test_two_browsers_on_one_series(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    other = page.context.new_page()
    other.goto(page.url)
    other.get_by_role("heading", name="Series 1").wait_for()
    correct_the_typing_error(page)
    other.get_by_label("Depth under 60 N (mm)").fill("9.9")
    other.keyboard.press("Enter")
    other.get_by_label("Why", exact=True).wait_for()
    other.get_by_role("button", name="Correct it").click()
    other.get_by_text("Nothing was stored: Ada wrote about Penetration, 1 meanwhile").wait_for()
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        rows = replayed(Journals(store).entries(head.id)).test("penetration.csv", "1").rows
    assert [row.cells["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6", "3.0"]


def test_a_phone_and_the_names_of_all_fields(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    page.set_viewport_size({"width": 390, "height": 844})
    here = page.url
    places = [served.address, f"{served.address}describe", here, here.split("?")[0] + "?table=shear.csv"]
    places += [here.split("?")[0] + f"?table={file}" for file in ("density.csv", "drop_cone.csv")]
    for place in (*places, here.split("?")[0].replace("/enter/", "/analysis/entry/")):
        page.goto(place)
        page.get_by_role("heading", level=1).wait_for()
        page.locator("h2").first.wait_for()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, place
        assert page.locator("input:visible, select:visible, button:visible").evaluate_all(NAMELESS) == [], place
        assert page.evaluate(CUT) == [], place


CUT = """[...document.querySelectorAll(".q-field__label")]
    .filter((each) => each.clientWidth && each.checkVisibility() && each.scrollWidth > each.clientWidth + 1)
    .map((each) => each.textContent)"""
"""The labels of fields that are longer than their fields."""
NAMELESS = """elements => elements.filter((element) => !(element.getAttribute('aria-label') || element.innerText?.trim()
  || [...(element.labels || [])].map(label => label.innerText.trim()).join(' '))).map((element) => element.outerHTML)"""
"""Those of elements that a screen reader has no name for."""


def tab_to(page: Page, place: Locator) -> None:
    """Go there by the tabulator; it is further than any page is long where it cannot be reached."""
    element = place.element_handle()
    for _ in range(150):
        if element.evaluate("element => element === document.activeElement"):
            return
        if not element.evaluate("element => element.isConnected"):  # drawn anew
            element = place.element_handle()
        page.keyboard.press("Tab")
    raise AssertionError(f"{place} is not reached by the tabulator")


def press(page: Page, role: Literal["link", "button"], name: str, *, key: str = "Enter") -> None:
    ready(page)
    tab_to(page, page.get_by_role(role, name=name, exact=True))
    page.keyboard.press(key)


def fits(page: Page) -> None:
    ready(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390, page.url


def test_the_keyboard_alone_on_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(served.address)
    fits(page)
    press(page, "link", "New campaign")
    page.get_by_label("Name of the campaign").and_(page.locator(":focus")).wait_for()
    fits(page)
    page.keyboard.type("By keys\na slope\nAda\n20 40 60\n0.01")
    for name, text in (
        ("Name of tool 1", "ski piece"),
        ("Length (mm) of tool 1", "200"),
        ("Width (mm) of tool 1", "62"),
    ):
        tab_to(page, page.get_by_label(name))
        page.keyboard.type(text)
    tab_to(page, page.get_by_label("Name of plate 1"))
    page.keyboard.type("plate\n100")
    press(page, "button", "Store and enter tests", key="Space")
    page.get_by_role("heading", name="New series").wait_for()
    page.keyboard.type("A\n30\n1.5\n22.5\n2.6\n")
    page.get_by_text("Stored: 2.6 mm under 60 N.").wait_for()
    fits(page)
    page.keyboard.press("Shift+Tab")  # from Next series back to the last reading, and to the one before it
    page.keyboard.press("Shift+Tab")
    has_text(page.get_by_label("Depth under 40 N (mm)").and_(page.locator(":focus")), "22.5")
    page.keyboard.type("2.15\n\n")  # the tabulator marked what stood there; the usual reason is taken
    page.get_by_text("corrected from 22.5").wait_for()
    press(page, "button", "Cancel this test", key="Space")
    press(page, "button", "Leave it as it was")
    page.get_by_role("button", name="Cancel this test").and_(page.locator(":focus")).wait_for()
    press(page, "button", "Cancel this test", key="Space")
    page.keyboard.type("the tool slipped\n")
    page.get_by_text("Cancelled: the tool slipped").wait_for()
    press(page, "button", "Undo: cancelled (the tool slipped)")
    page.get_by_text("Undone.").wait_for()
    press(page, "link", "Shear")
    page.get_by_role("heading", name="New test").wait_for()
    page.keyboard.type("A\n90\n6\n250\n30\n")
    page.get_by_text("S_f = 0.200 N/mm²").wait_for()  # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    fits(page)
    press(page, "link", "Analysis")
    page.get_by_text("1 penetration experiment, 1 used; 1 shear experiment, 1 used.").wait_for()
    with Store.open(served.store) as store:
        (found,) = Journals(store).list()
        rows = replayed(Journals(store).entries(found.id)).test("penetration.csv", "1").rows
    assert [row.cells["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6"]
