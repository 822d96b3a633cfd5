"""Dark on light: text against what is behind it, as the guidelines for accessible pages count it (WCAG 2.2, 1.4.3)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from skisnow.web.lab_skis import LabSkis
from skisnow.web.pages import PAGES

from .conftest import Served, settled
from .replay.test_lab_page import kept
from .test_day import create, enter_series
from .test_entering import NAMELESS

if TYPE_CHECKING:
    from playwright.sync_api import Page


LEAST = 4.5

COLOURS = """() => [...document.querySelectorAll('main *, header *')].filter(element =>
  [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim()) && element.offsetParent
  && !element.closest('svg') && !element.closest('.q-icon')).map(element => {
    let behind = element, colour = 'rgba(0, 0, 0, 0)';
    while (behind && /, 0\\)$|transparent/.test(colour)) {
      colour = getComputedStyle(behind).backgroundColor; behind = behind.parentElement; }
    return [element.textContent.trim().slice(0, 40), getComputedStyle(element).color, colour]; })"""


def luminance(colour: str) -> float:
    """Relative luminance of an opaque colour (WCAG 2.2)."""
    red, green, blue = (int(part) / 255 for part in re.findall(r"\d+", colour)[:3])
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (red, green, blue)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(ink: str, paper: str) -> float:
    light, dark = sorted((luminance(ink), luminance(paper)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def test_black_on_white_by_definition() -> None:
    assert contrast("rgb(0, 0, 0)", "rgb(255, 255, 255)") == 21.0


def test_lines_are_told_apart_by_colour_and_dashes_alone() -> None:
    """Three to one against the page's white is what graphics need (WCAG 2.2, 1.4.11)."""
    chart = pytest.importorskip("skisnow.web.widgets", reason="the web lab is not installed")
    read = [style for style in chart.STYLES if style["read"]]
    assert read == list(chart.STYLES[: chart.BEHIND])
    for name in ("colour", "dash"):
        assert len({style[name] for style in read}) == len(read)
    assert len({(style["width"], style["point"]) for style in read}) == 1
    for style in read:
        red, green, blue = bytes.fromhex(style["colour"].removeprefix("#"))
        assert contrast(f"rgb({red}, {green}, {blue})", "rgb(255, 255, 255)") >= 3.0


@pytest.mark.slow
def test_all_text_stands_out(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    page.get_by_text("below the one before it").wait_for()
    entry = page.url.split("?")[0]
    for place in (page.url, served.address, f"{entry}?table=shear.csv", f"{served.address}skis"):
        page.goto(place)
        page.locator("h1").wait_for()
        page.locator("h2").first.wait_for()
        settled(page)
        found = page.evaluate(COLOURS)
        assert len(found) > 5
        assert [row for row in found if contrast(row[1], row[2]) < LEAST] == [], place


READY = {"skis": "td", "carve": "td", "design": "td", "simulate": "summary", "study": ".range", "replay": ".card"}


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
