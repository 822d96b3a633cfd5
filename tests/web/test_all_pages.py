"""Rules for every page that is not for entering: a phone's width, names of all fields, dark on light."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from skisnow.web.lab_skis import LabSkis
from skisnow.web.pages import PAGES

from .conftest import Served, settled
from .replay.test_lab_page import kept
from .test_contrast import COLOURS, LEAST, contrast
from .test_entering import NAMELESS

if TYPE_CHECKING:
    from playwright.sync_api import Page

READY = {"skis": "td", "carve": "td", "simulate": "summary", "study": ".range", "replay": ".card"}


def test_every_page_of_the_navigation_is_looked_at() -> None:
    """The list of campaigns is, with what is entered there (`test_contrast`, `test_day`)."""
    assert {*READY, "campaigns"} == set(PAGES)


def opened(page: Page, served: Served, name: str) -> None:
    """A page with something on it, everything that can be opened open."""
    lab = served.lab
    LabSkis(lab).save_texts("a ski with quite a long name of its own", LabSkis(lab).texts("carver")[0], "")
    for run in ("2026-02-01-100000-a-run-with-quite-a-long-name", "other"):
        kept(lab, run)
    page.goto(f"{served.address}{name}")
    page.locator(READY[name]).first.wait_for()
    page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    settled(page)


@pytest.mark.parametrize("name", READY)
def test_it_fits_every_field_has_a_name_and_all_text_stands_out(page: Page, served: Served, name: str) -> None:
    opened(page, served, name)
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        settled(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        fields = page.locator("input:visible, select:visible, button:visible, textarea:visible")
        assert fields.count() > 1
        assert fields.evaluate_all(NAMELESS) == []
        assert page.locator("svg[role=img]:not([aria-label]), svg[role=img][aria-label='']").count() == 0
        found = page.evaluate(COLOURS)
        assert len(found) > 5
        assert [row for row in found if contrast(row[1], row[2]) < LEAST] == []
