"""What only a browser does."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from skisnow import samples

from .conftest import Served, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page


def test_the_preview_of_a_workbook_is_as_wide_as_the_page(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(served.address)
    ready(page)
    workbook = Path(samples.__file__).parent / "files" / "two-sites.xlsx"
    page.get_by_label("Files or zip").set_input_files(workbook)
    page.get_by_role("button", name="Import files or zip").press("Enter")
    tables = page.locator(".importing .table")
    tables.first.wait_for()
    cut = tables.evaluate_all("all => all.map(each => each.scrollWidth - each.clientWidth)")
    assert len(cut) > 2 and max(cut) == 0
