"""Take the screenshots of the web lab: python docs/figures_of_web_lab.py (needs Chromium and Playwright)."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from playwright.sync_api import sync_playwright

if TYPE_CHECKING:
    from playwright.sync_api import Page

FOLDER = Path(__file__).parent / "_static" / "web"
DESCRIPTION = {
    "Name of the campaign": "A morning on the race slope",
    "Place": "upper part, north side",
    "Observers, with commas between": "Ada, Bo",
    "Disc loads (N), with blanks between": "12 92 172 252 332 412 492",
    "Step of the depth gauge (mm)": "0.01",
    "Uncertainty of the load (N)": "0.5",
    "Uncertainty of the moment (N m)": "0.5",
    "Uncertainty of the lever arm (mm)": "2",
    "Name of tool 1": "ski piece",
    "Length (mm) of tool 1": "200",
    "Width (mm) of tool 1": "62",
    "Name of plate 1": "plate 100",
    "Length (mm) of plate 1": "100",
}
SERIES = {
    "1": ("30", "0.62 1.71 2.30 2.84 3.21 3.65 3.94"),
    "2": ("30", "0.58 1.62 2.24 2.66 3.07 3.41 3.79"),
    "3": ("45", "0.84 2.21 3.10 3.66 4.28 4.70 5.21"),
}
SHEAR = (("90", "6", "31"), ("90", "8", "42.5"), ("60", "6", "30"), ("45", "7", "33"))
PHONE = {"width": 390, "height": 844}
DESK = {"width": 1280, "height": 900}


def fill(page: Page, values: dict[str, str]) -> None:
    """Fill fields by their names."""
    for label, value in values.items():
        page.get_by_label(label, exact=True).fill(value)


def enter(page: Page) -> None:
    """A small campaign, by keyboard."""
    fill(page, DESCRIPTION)
    page.get_by_role("button", name="Store and enter tests").click()
    for name, (angle, depths) in SERIES.items():
        page.get_by_role("heading", name="New series").wait_for()
        fill(page, {"Name of the test": name, "Site": "gate 4", "Edge angle (°)": angle})
        page.keyboard.press("Enter")
        page.keyboard.type("".join(f"{depth}\n" for depth in depths.split()))
        page.get_by_text(f"Stored: {depths.split()[-1]} mm under 492 N.").wait_for()
        if name != "3":
            page.get_by_role("button", name="Next series").click()


def enter_shear(page: Page) -> None:
    """Shear tests of the same campaign."""
    page.get_by_role("link", name="Shear").click()
    for number, (angle, depth, moment) in enumerate(SHEAR, start=1):
        page.get_by_label("Name of the test", exact=True).and_(page.locator(f"[value='{number}']")).wait_for()
        fill(page, {"Site": "gate 4", "Edge angle (°)": angle, "Depth (mm)": depth, "Lever arm (mm)": "250"})
        fill(page, {"Moment (N m)": moment})
        page.keyboard.press("Enter")
        page.get_by_text(f"Stored: test {number}.").wait_for()


def correct(page: Page, address: str) -> None:
    """The same campaign exported, imported, and a reading of it corrected."""
    page.goto(address)
    with page.expect_download() as download:
        page.get_by_role("link", name="Export").click()
    content = {"name": "campaign.zip", "mimeType": "application/zip", "buffer": download.value.path().read_bytes()}
    page.get_by_label("Files or zip").set_input_files(content)  # type: ignore[arg-type]
    page.get_by_role("button", name="Import files or zip").click()
    page.get_by_role("link", name="Correct").click()
    page.get_by_role("link", name="2", exact=True).click()
    page.get_by_text("H_V =").wait_for()
    page.get_by_label("Depth (mm), row 11").fill("2.56")
    page.keyboard.press("Enter")
    page.get_by_label("Why").and_(page.locator(":focus")).wait_for()
    page.set_viewport_size({"width": 1280, "height": 1440})
    picture(page, "correct")
    page.set_viewport_size(DESK)  # type: ignore[arg-type]


def edit(page: Page) -> None:
    """A carver made stiffer, and narrower, beside the one of the catalogue."""
    for label, text in (("EI ×", "1.3"), ("Width ×", "0.95")):
        page.get_by_label(label, exact=True).fill(text)
        page.keyboard.press("Tab")
        page.wait_for_timeout(800)
    page.set_viewport_size({"width": 1280, "height": 1040})
    picture(page, "skis")
    page.set_viewport_size(DESK)  # type: ignore[arg-type]


def picture(page: Page, name: str, *, whole: bool = False) -> None:
    """A screenshot, after what is drawn has settled."""
    page.evaluate("scrollTo(0, 0)")
    page.wait_for_timeout(800)
    page.screenshot(path=FOLDER / f"{name}.png", full_page=whole)


def both_sizes(page: Page, name: str) -> None:
    """On a laptop and on a phone."""
    picture(page, name)
    page.set_viewport_size(PHONE)  # type: ignore[arg-type]
    picture(page, f"{name}-phone", whole=True)
    page.set_viewport_size(DESK)  # type: ignore[arg-type]


def take(page: Page, address: str) -> None:
    """Every page of the lab."""
    page.goto(f"{address}describe")
    enter(page)
    page.get_by_text("H_V =").wait_for()
    both_sizes(page, "enter")
    enter_shear(page)
    picture(page, "shear")
    correct(page, address)
    page.goto(address)
    page.get_by_role("heading", name="A morning").first.wait_for()
    both_sizes(page, "campaigns")
    page.get_by_role("link", name="Analysis").first.click()
    page.get_by_role("heading", name="Figures").wait_for(timeout=120_000)
    page.get_by_text("Drawing the figures").wait_for(state="hidden", timeout=120_000)
    picture(page, "analysis")
    page.goto(f"{address}skis")
    page.get_by_text("Running length", exact=True).wait_for()
    edit(page)
    page.goto(f"{address}carve")
    page.get_by_text("equilibrium").first.wait_for(timeout=180_000)
    both_sizes(page, "carve")
    page.goto(f"{address}design?ski=slalom&other=carver")
    page.get_by_role("button", name="Find the design").click(timeout=180_000)
    page.get_by_text("makes this radius").wait_for(timeout=180_000)
    picture(page, "design")
    page.goto(f"{address}simulate")
    page.get_by_label("Snow", exact=True).click()
    page.get_by_role("option", name="A morning").first.click()
    page.get_by_text("Snow: H_V").wait_for(timeout=60_000)
    picture(page, "simulate")


def main() -> None:
    """Serve a lab on an empty store and take the pictures."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        command = [sys.executable, "-m", "skisnow", "serve", "--port", "0", "--store", f"{folder}/store.sqlite3"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
            assert server.stdout is not None
            try:
                address = server.stdout.readline().strip()
                place = shutil.which("chromium-headless-shell") or shutil.which("chromium")
                browser = playwright.chromium.launch(executable_path=place, args=["--no-sandbox"])
                take(browser.new_page(viewport=DESK), address)  # type: ignore[arg-type]
                browser.close()
            finally:
                server.kill()


if __name__ == "__main__":
    main()
