"""What only a browser does: a camera's picture is made small, a position needs consent, a wide preview is not cut."""

import io
from pathlib import Path

import numpy as np
from PIL import Image

from skisnow import samples
from skisnow.campaign.store import ReplayedTest, attachments_of
from skisnow.campaign.store.export import photo_of

from .browser_types import Page
from .conftest import Served, entered, ready
from .test_day import create, enter_series

TABLE = "penetration.csv"


def attached(served: Served) -> list[ReplayedTest]:
    """Photos and positions of the only campaign's first test."""
    return list(attachments_of(entered(served), TABLE, "1"))


def camera_picture() -> bytes:
    """A JPEG of 2400 × 1800 px with grain and a position, as a telephone's camera writes it."""
    grain = np.random.default_rng(1).integers(0, 255, (300, 400, 3), dtype=np.uint8)
    picture, exif = Image.fromarray(grain).resize((2400, 1800)), Image.Exif()
    exif[0x010E] = "taken at 47.25 N 11.5 E"
    content = io.BytesIO()
    picture.save(content, "JPEG", quality=92, exif=exif)
    return content.getvalue()


def test_photo_and_position_of_a_series_on_a_phone(page: Page, served: Served) -> None:
    """The hardness stays in view; a position needs consent; a photo becomes small and loses what the camera added."""
    page.set_viewport_size({"width": 390, "height": 600})
    page.context.set_geolocation({"latitude": 47.25, "longitude": 11.5, "accuracy": 6.0})
    create(page, served)
    enter_series(page, "1")
    ready(page)
    value = page.get_by_text("H_V =")
    value.wait_for()
    for depth in page.get_by_label("Depth under").all():
        depth.evaluate("each => { each.focus(); each.scrollIntoView({ block: 'end' }); }")
        boxes = [each.bounding_box() for each in (value, depth)]
        assert all(box is not None and box["y"] >= 0 and box["y"] + box["height"] <= 600 for box in boxes)
    page.get_by_text("Photo and position").click()
    page.get_by_role("button", name="Store my position with this test").click()
    page.get_by_text("did not allow it").wait_for()
    assert attached(served) == []
    page.context.grant_permissions(["geolocation"])
    page.get_by_role("button", name="Store my position with this test").click()
    page.get_by_text("47.25000°").wait_for()
    cells = [each.rows[0].cells for each in attached(served)]
    assert [(each["latitude_deg"], each["longitude_deg"]) for each in cells] == [("47.25", "11.5")]
    page.locator(".attachments input[type=file]").set_input_files(
        {"name": "slope.jpg", "mimeType": "image/jpeg", "buffer": camera_picture()}
    )
    page.get_by_text("Photo, ").wait_for()
    (photo,) = filter(None, map(photo_of, attached(served)))
    with Image.open(io.BytesIO(photo)) as stored:
        assert (stored.size, stored.format) == ((1600, 1200), "JPEG")
        assert not dict(stored.getexif())


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
