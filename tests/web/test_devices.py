"""What only a browser does: the hardness stays in view, a wide preview is not cut."""

from pathlib import Path

from skisnow import samples

from .browser_types import Page
from .conftest import Served, ready
from .test_day import create, enter_series

TABLE = "penetration.csv"


def test_the_hardness_of_a_series_stays_in_view_on_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 600})
    create(page, served)
    enter_series(page, "1")
    ready(page)
    value = page.get_by_text("H_V =")
    value.wait_for()
    for depth in page.get_by_label("Depth under").all():
        depth.evaluate("each => { each.focus(); each.scrollIntoView({ block: 'end' }); }")
        boxes = [each.bounding_box() for each in (value, depth)]
        assert all(box is not None and box["y"] >= 0 and box["y"] + box["height"] <= 600 for box in boxes)


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


def test_the_editor_of_a_ski_and_its_drawing_are_side_by_side_on_a_laptop(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(f"{served.address}skis")
    page.get_by_text("Running length", exact=True).wait_for()
    ready(page)
    factor = page.get_by_label("EI ×").bounding_box()
    results = [
        each.bounding_box() for each in (page.get_by_text("Running length", exact=True), page.locator("svg").nth(0))
    ]
    assert factor is not None and factor["y"] + factor["height"] <= 800
    for box in results:
        assert box is not None and box["y"] + box["height"] <= 800 and box["x"] > factor["x"] + factor["width"]
