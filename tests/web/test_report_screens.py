"""Reports on a telephone and on paper: nothing is cut, nothing scrolls sideways."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from skisnow.campaign.reference import reference_campaign
from skisnow.estimation import analyse
from skisnow.report import write_report
from skisnow.report.run.folder import write_run

from ..report.runs import circle_run

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

WIDER_THAN_THEIR_BOX = """() =>
    [...document.querySelectorAll("table, td, tbody th, caption, figure, img, dd, .key li, p")]
    .filter((each) => !each.closest(".scroll"))
    .filter((each) => each.getBoundingClientRect().width > 0)
    .filter((each) => each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).display !== "inline"
        || each.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
    .map((each) => `${each.tagName} ${each.textContent.slice(0, 60)}`)"""
NAMES_THAT_RUN_OVER_THEIR_NUMBERS = """() =>
    [...document.querySelectorAll("td[data-name]")]
    .filter((each) => getComputedStyle(each, "::before").whiteSpace !== "normal")
    .map((each) => each.dataset.name)"""
A4_PX = 680
"""180 mm of text at 96 pixels an inch."""


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("reports")
    analysis = analyse(reference_campaign(1).campaign(), n_resamples=100)
    return write_report(analysis, folder / "campaign"), write_run(circle_run(), folder / "run")


@pytest.fixture
def page(chromium: Browser) -> Iterator[Page]:
    """A page of a file, not of a server."""
    made = chromium.new_page()
    yield made
    made.close()


@pytest.mark.slow
@pytest.mark.parametrize("which", [0, 1], ids=["campaign", "run"])
def test_a_telephone_shows_figures_and_tables_whole(page: Page, reports: tuple[Path, Path], which: int) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(reports[which].as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    assert page.evaluate(WIDER_THAN_THEIR_BOX) == []
    assert page.evaluate(NAMES_THAT_RUN_OVER_THEIR_NUMBERS) == []
    wide = page.locator("figure.wide img").first
    drawn = wide.evaluate("(each) => [each.naturalWidth, each.clientWidth]")
    assert drawn[1] > 0.9 * drawn[0]  # the words of the figure have their own size, within a tenth
    box = page.locator(".scroll").first
    assert box.evaluate("(each) => { each.scrollTo(1000, 0); return each.scrollLeft + each.clientWidth }") == drawn[1]


@pytest.mark.slow
def test_a_shadow_says_that_rows_of_a_long_table_follow(page: Page, reports: tuple[Path, Path]) -> None:
    """At the lower edge of its box, until the last row is in sight."""
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(reports[0].as_uri())
    table = page.locator(".table").filter(has_text="The nine candidate models").first
    table.scroll_into_view_if_needed()

    def lower_edge() -> int:
        """Grey value beside the words, a pixel above the edge."""
        picture = Image.open(io.BytesIO(table.screenshot())).convert("L")
        return int(picture.getpixel((picture.width // 2, picture.height - 2)))  # type: ignore[arg-type]

    table.evaluate(
        "(each) => { for (const row of each.querySelectorAll('table > *')) row.style.color = 'transparent' }"
    )
    assert lower_edge() < 240
    table.evaluate("(each) => each.scrollTo(0, each.scrollHeight)")
    assert lower_edge() == 255


@pytest.mark.slow
@pytest.mark.parametrize("which", [0, 1], ids=["campaign", "run"])
def test_a_report_prints_as_one_pdf(page: Page, reports: tuple[Path, Path], which: int, tmp_path: Path) -> None:
    """A PDF by Print, Save as PDF: pages of A4, no table wider than the paper."""
    page.set_viewport_size({"width": A4_PX, "height": 1000})
    page.emulate_media(media="print")
    page.goto(reports[which].as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= A4_PX
    wide = page.evaluate(
        """() => [...document.querySelectorAll("table")].filter((each) => each.getBoundingClientRect().right > 682)
            .map((each) => each.textContent.slice(0, 60))"""
    )
    assert wide == []
    content = page.pdf(path=tmp_path / "report.pdf", prefer_css_page_size=True)
    assert content.startswith(b"%PDF")
    assert 2 <= content.count(b"/Type /Page\n") + content.count(b"/Type /Page ") + content.count(b"/Type /Page/") < 60
