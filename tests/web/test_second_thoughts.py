"""Unusual ways of using pages: describe again what is in use, press twice, type before a page is ready."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from skisnow.campaign.store import Journals, Store, replay_journal

from .conftest import Served, fill, has_text, ready
from .test_day import create, enter_series

if TYPE_CHECKING:
    from playwright.sync_api import Page


def described(page: Page, served: Served) -> str:
    """Go to the description of the one campaign; its id."""
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
    page.goto(f"{served.address}describe?entry={head.id}")
    return head.id


def send(page: Page) -> None:
    ready(page)
    page.get_by_role("button", name="Store and enter tests").press("Enter")


@pytest.mark.slow
def test_readings_stay_under_their_loads_when_the_discs_change(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "2")
    id_ = described(page, served)
    fill(page, {"Disc loads (N), with blanks between": "10 20 30 40 60 80"})
    send(page)
    page.get_by_role("heading", name="New series").wait_for()
    page.goto(f"{page.url.split('?')[0]}?table=penetration.csv&test=2")
    shown = [("10", ""), ("20", "1.4"), ("30", ""), ("40", "2.0"), ("60", "2.5"), ("80", "2.9")]
    page.get_by_role("heading", name="Series 2").wait_for()
    for load, depth in shown:
        has_text(page.get_by_label(f"Depth under {load} N (mm)"), depth)
    fill(page, {"Depth under 30 N (mm)": "1,7"})
    page.keyboard.press("Enter")
    page.get_by_text("Stored: 1.7 mm under 30 N.").wait_for()
    page.locator("summary", has_text="A load that is not in the disc set").press("Enter")
    fill(page, {"Further load (N)": "60", "Its depth (mm)": "2.6"})
    page.get_by_role("button", name="Store it").press("Enter")
    page.locator(".refusals li", has_text="there is a reading under 60 N already").wait_for()
    fill(page, {"Further load (N)": "50", "Its depth (mm)": "2.2"})
    page.get_by_role("button", name="Store it").press("Enter")
    page.get_by_text("Stored: 2.2 mm under 50 N.").wait_for()
    with Store.open(served.store) as store:
        rows = replay_journal(Journals(store).entries(id_)).test("penetration.csv", "2").rows
    found = [(row.cells["load_N"], row.cells["depth_mm"]) for row in rows]
    assert found == [("20", "1.4"), ("30", "1.7"), ("40", "2.0"), ("50", "2.2"), ("60", "2.5"), ("80", "2.9")]


@pytest.mark.slow
def test_pressed_twice_is_done_once(page: Page, served: Served) -> None:
    page.goto(f"{served.address}describe")
    fill(page, {"Name of the campaign": "one", "Name of plate 1": "plate", "Length (mm) of plate 1": "100"})
    page.get_by_role("button", name="Store and enter tests").dblclick()
    page.get_by_role("heading", name="New series").wait_for()
    with Store.open(served.store) as store:
        assert len(Journals(store).list()) == 1
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    fill(page, {"New name": "mine"})
    page.get_by_role("button", name="Save in the lab").dblclick()
    page.get_by_role("columnheader", name="mine").wait_for()
    page.get_by_text("Saved: mine.").wait_for()
    page.goto(f"{served.address}simulate")
    ready(page)
    page.get_by_role("button", name="Simulate").dblclick()
    page.get_by_text("is in the queue.").wait_for()
    page.get_by_role("button", name="Cancel").click()
    page.locator(".card", has_text="cancelled").wait_for()
    assert page.locator(".card").count() == 1


def test_a_value_that_is_being_typed_is_not_drawn_over(page: Page, served: Served) -> None:
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    page.get_by_role("row", name="EI at the boot").wait_for()  # the last of the page's own first drawing
    ready(page)
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).fill("500")
    page.get_by_label("GJ (N m²) at 0.000 m", exact=True).select_text()  # leaves the other, which is drawn now
    page.keyboard.type("18")
    page.get_by_role("cell", name="500 N m²").wait_for()
    page.keyboard.type("0")
    page.keyboard.press("Tab")
    page.get_by_role("cell", name="180 N m²").wait_for()
    has_text(page.get_by_label("GJ (N m²) at 0.000 m", exact=True), "180")


def test_what_is_typed_for_a_run_is_neither_lost_nor_passed_over(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    duration = page.get_by_label("Ends after (s)", exact=True)
    duration.fill("500")
    page.get_by_text("Will take about 8 min.").wait_for()  # no run has told how long it takes: as long as it simulates
    duration.fill("")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("Not begun: Ends after (s) is empty; the scenario has 5").wait_for()
    duration.fill("0,05")
    page.get_by_label("Scenario", exact=True).click()
    page.get_by_role("option").nth(1).click()
    page.wait_for_function("document.querySelector('[aria-label=\"Ends after (s)\"]')?.value === '0.05'")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("Ends after (s): 0.05").wait_for()
    assert page.locator(".card").count() == 1  # the refused one was not begun
    page.get_by_role("button", name="Cancel").click()
