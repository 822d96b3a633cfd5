"""Entering tests: undo, what is refused, two people at once, a phone, and only the keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from skisnow.campaign.store import Journals, Store, replay_journal

from .conftest import Served, has_text, ready
from .test_day import create, enter_series, next_series

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page


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
        if not element.evaluate("element => element.isConnected"):  # drawn again
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
    page.keyboard.type("2.15\n\n")  # the tabulator marked the old text; the usual reason is taken
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
        rows = replay_journal(Journals(store).entries(found.id)).test("penetration.csv", "1").rows
    assert [row.cells["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6"]
