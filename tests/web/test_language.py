"""German and English: no text of the lab without its German one, and a page that is driven in German."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

from .conftest import MISSING, PATIENCE_MS, Served, Watched, fill, has_text, ready

if "nicegui" in MISSING:
    pytest.skip("the web lab is not installed", allow_module_level=True)

from skisnow._support.errors import FieldDataError
from skisnow.campaign import Problem, campaign_of_files
from skisnow.campaign.problems import lines_of
from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.replayed import Description, description_text

from .shown_texts import shown_texts
from .test_day import PLATE, TOOL, VALUES
from .test_entering import CUT

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page


DATA: Final = {
    "read once more after waiting", "measured, entered in the lab", "the edited ski", "as in the scenario",
    "the sliders", "the numbers below",
    "{}, edited", "{} {} at {} m", "edited in the lab ({}) from: {}", "{} · skisnow",
}  # fmt: skip
"""Texts that are stored, and values of menus."""


def test_every_text_of_the_lab_is_a_message() -> None:
    assert {text: file for text, file in shown_texts().items() if text not in DATA} == {}


DESCRIBED = """load_steps_N = [20, 40]
tool = [{ name = "ski", shape = "ski", length_mm = 200, width_mm = 62 }]
plate = [{ name = "plate", length_mm = "100" }]
plaze = 1
"""
HEAD = "experiment,site,tool,edge_angle_deg,load_N,depth_mm"


def test_what_is_wrong_in_files_is_said_with_their_own_names() -> None:
    table = f"{HEAD}\n1,A,ski,30,20,1\n".encode()
    with pytest.raises(FieldDataError) as caught:
        campaign_of_files({"campaign.toml": DESCRIBED.encode(), "penetration.csv": table})
    wrong = (each for each in caught.value.problems if isinstance(each, Problem))
    german = "\n".join(line.text("de") for line in lines_of(wrong))
    assert "Spalte plaze: gefunden 'plaze'; erlaubt: der Schlüssel plate." in german


def test_a_series_is_entered_in_german(chromium: Browser, served: Served, watched: Watched) -> None:
    with Store.open(served.store) as store:
        id_ = Journals(store).begin(description_text(Description(VALUES | {"name": "Tag"}, [TOOL], [PLATE])))
    context = chromium.new_context(locale="de-DE", viewport={"width": 390, "height": 844})
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    watched.of(page)
    page.goto(f"{served.address}enter/{id_}")
    page.get_by_role("heading", name="Neue Reihe").wait_for()
    assert page.locator("html").get_attribute("lang") == "de"
    fill(page, {"Messort": "A", "Kantwinkel (°)": "95"})
    page.keyboard.press("Enter")
    page.get_by_text("Nicht begonnen:", exact=True).wait_for()
    fault = "Kantwinkel (°): „95“ ist nicht erlaubt. Eine Zahl von 0 bis unter 90 eingeben."
    assert page.locator(".refusals li").all_inner_texts() == [fault]
    ready(page)
    fill(page, {"Kantwinkel (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Tiefe unter 20 N (mm)").and_(page.locator(":focus")).wait_for()
    page.keyboard.type("1,5\n2,o\n")
    page.locator(".reading.refused").get_by_text("„2,o“ ist nicht erlaubt. Eine Zahl ab 0 eingeben.").wait_for()
    page.get_by_text("gespeichert", exact=True).wait_for()
    page.get_by_role("button", name="Rückgängig: eingegeben: 1,5 mm unter 20 N").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.evaluate(CUT) == []
    depth = page.get_by_label("Tiefe unter 20 N (mm)")
    has_text(depth, "1,5")
    page.reload()
    has_text(depth, "1,5")
    ready(page)
    depth.press("Enter")  # as it is there: no correction
    depth.fill("1,7")
    depth.press("Enter")
    page.get_by_text("20 N: aus 1,5 mm werden 1,7 mm.").wait_for()
    page.get_by_role("link", name="English").click()
    page.get_by_label("Depth under 20 N (mm)").wait_for()  # the same series, with the typed text
    context.close()
    assert watched.errors == []


def test_all_links_of_the_head_stand_in_one_row_of_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.set_extra_http_headers({"Accept-Language": "de"})
    page.goto(served.address)
    page.get_by_role("link", name="Simulieren").wait_for()
    links = page.locator(".lab-head nav")
    assert links.evaluate("each => each.scrollWidth - each.clientWidth") == 0
    assert links.locator("a").last.evaluate("each => each.getBoundingClientRect().right") <= 390
