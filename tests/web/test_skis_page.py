"""A ski is edited with the drawing beside it, saved under a new name, and carved and simulated with."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow.ski import read_ski, ski_named
from skisnow.web.lab_skis import LabSkis

from .conftest import Served, has_text

if TYPE_CHECKING:
    from playwright.sync_api import Page


CARVER = ski_named("carver")
TEXT = LabSkis(Path("nowhere")).texts("carver")[0]


def boot_stiffness(page: Page, number: int) -> str:
    """EI at the boot as the table of facts has it, of the first or second ski."""
    return page.get_by_role("row", name="EI at the boot").get_by_role("cell").nth(number).inner_text()


def curve(page: Page) -> list[str]:
    """The lines of the chart of bending stiffness."""
    paths: list[str] = (
        page.get_by_role("img", name="EI (N m²) along the ski")
        .locator("path.line")
        .evaluate_all("lines => lines.map(line => line.getAttribute('d'))")
    )
    return paths


def type_into(page: Page, label: str, text: str) -> None:
    page.get_by_label(label, exact=True).fill(text)
    page.keyboard.press("Tab")


@pytest.mark.slow
def test_factors_and_values_at_stations_are_drawn_and_saved(page: Page, served: Served) -> None:
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    assert len(curve(page)) == 1
    type_into(page, "EI ×", "1,5")
    page.get_by_role("columnheader", name="carver, edited").wait_for()
    page.get_by_role("cell", name="690 N m²").wait_for()  # 1.5 times 460, by hand
    assert boot_stiffness(page, 0) == "460 N m²"
    assert len(curve(page)) == 2 and curve(page)[0] != curve(page)[1]
    has_text(page.get_by_label("EI (N m²) at 0.000 m", exact=True), "690")
    type_into(page, "EI (N m²) at 0.000 m", "500")
    page.get_by_role("cell", name="500 N m²").wait_for()
    type_into(page, "Width (mm) at 0.000 m", "70")
    page.get_by_role("cell", name="127 – 70.0 – 111 mm").wait_for()

    page.get_by_label("New name", exact=True).fill("carver")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Not saved: there is a ski carver already").wait_for()
    page.get_by_label("New name", exact=True).fill("soft waist")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Saved: soft waist.").wait_for()
    saved = read_ski(served.store.parent / "lab" / "skis" / "soft waist" / "ski.toml")
    middle = abs(saved.station).argmin()
    assert saved.name == "soft waist" and "EI × 1,5" in saved.source
    assert saved.bending_stiffness[middle] == pytest.approx(500.0, rel=1e-9)
    assert saved.width[middle] == pytest.approx(0.070, rel=1e-9)
    assert saved.bending_stiffness[0] == pytest.approx(1.5 * CARVER.bending_stiffness[0], rel=1e-9)
    assert saved.torsional_stiffness == pytest.approx(CARVER.torsional_stiffness, rel=1e-9)
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Not saved: there is a ski soft waist already").wait_for()

    page.goto(f"{served.address}carve")
    page.get_by_label("Compared with").click()
    page.get_by_role("option", name="soft waist").click()
    page.get_by_role("columnheader", name="soft waist").wait_for()
    told = page.get_by_role("region", name="Carved radius").locator(".value")
    told.nth(1).wait_for()
    assert len({words.split("carved radius")[1] for words in told.all_inner_texts()}) == 2


pytest.importorskip("nicegui", reason="the web lab is not installed")


if TYPE_CHECKING:
    from playwright.sync_api import Page

TYPED = {
    "length_mm": "1593", "running_length_mm": "1396", "sidecut_length_mm": "1458", "tip_width_mm": "116",
    "waist_width_mm": "68", "tail_width_mm": "101", "mass_kg": "2,231", "camber_mm": "7",
    "EI_N_m2": "100 250; 440, 260,5 100", "GJ_N_m2": "60 140 175 140 60",
}  # fmt: skip
DESIGN = {
    "board": {
        "name": "Board", "nose length": "15 cm", "effective edge length": "130 cm", "tail length": "10 cm",
        "sidecut radius": "13 m", "waist width": "9.3 cm", "taper": "0 cm", "stance setback": "0 cm",
        "nose width": "12 cm",
        "edge shape": {"type": "Basic Arc"},
    }
}  # fmt: skip
TABLE = "station_m;width_mm;EI_N_m2\n0,845;25;100\n0,729;116;100\n0;68;440\n-0,729;101;100\n-0,749;101;100\n"
WITH_TABLE = """name = "my slalom"
running_length_mm = 1396
sidecut_length_mm = 1458
mass_kg = 2.231
GJ_N_m2 = [60, 140, 175, 140, 60]
table = "rows.csv"
"""


def test_a_chart_has_the_numbers_of_the_language_and_its_words_side_by_side(page: Page, served: Served) -> None:
    """On a phone the name of the axis stands above the words at its ends, where one row is too short for all."""
    page.set_viewport_size({"width": 390, "height": 844})
    page.set_extra_http_headers({"Accept-Language": "de"})
    page.goto(f"{served.address}skis")
    chart = page.locator("svg[role=img]").first
    chart.get_by_text("−0,5", exact=True).wait_for()
    assert chart.get_by_text("0.5").count() == 0
    boxes = [chart.get_by_text(words).bounding_box() for words in ("◂ Ende", "Stelle (m), Schuh = 0", "Schaufel ▸")]
    tail, name, tip = (box for box in boxes if box is not None)
    assert name["y"] + name["height"] <= tail["y"] + 2 and tail["x"] + tail["width"] < tip["x"]
    field = page.get_by_label("Breite (mm) bei 0,268 m", exact=True)
    assert "," in field.input_value() and "." not in field.input_value()
