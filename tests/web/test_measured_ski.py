"""A measured ski comes into the lab, is changed by five per cent, and both are carved side by side."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow._support.errors import ParameterError
from skisnow.ski import read_ski
from skisnow.web.lab_skis import LabSkis
from skisnow.web.settings import Limits
from tests.coded import raises

from .conftest import Served, fill

pytest.importorskip("nicegui", reason="the web lab is not installed")

from skisnow.web.lab_skis import add_ski, measured_text, ski_of_uploads

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


def test_three_widths_are_a_ski_file(tmp_path: Path) -> None:
    (tmp_path / "ski.toml").write_text(measured_text("mine", TYPED), encoding="utf-8")
    ski = read_ski(tmp_path / "ski.toml")
    assert ski.name == "mine"
    assert ski.mass == pytest.approx(2.231)
    middle = abs(ski.station).argmin()
    assert ski.width[middle] == pytest.approx(0.068, abs=1e-6)
    assert ski.bending_stiffness[middle] == pytest.approx(440.0, rel=1e-4)
    with raises(ParameterError, "not_a_number", field="Width at the tip (mm)", value="wide"):
        measured_text("mine", {**TYPED, "tip_width_mm": "wide"})
    with raises(ParameterError, "not_a_number"):
        measured_text("mine", {**TYPED, "EI_N_m2": ""})


def test_a_file_with_its_table_is_taken_as_it_is_read(tmp_path: Path) -> None:
    uploads = [("Skis\\mine.toml", io.BytesIO(WITH_TABLE.encode())), ("rows.csv", io.BytesIO(TABLE.encode()))]
    texts = ski_of_uploads(uploads, {}, Limits())
    skis = LabSkis(tmp_path)
    assert add_ski(skis, "", texts) == "my slalom"
    (tmp_path / "mine.toml").write_text(WITH_TABLE, encoding="utf-8")
    (tmp_path / "rows.csv").write_text(TABLE, encoding="utf-8")
    ours, theirs = read_ski(skis.word("my slalom")), read_ski(tmp_path / "mine.toml")
    assert ours.width == pytest.approx(theirs.width, abs=1e-12)
    with raises(ParameterError, "already_there", name="my slalom"):
        add_ski(skis, "", texts)
    assert add_ski(skis, " another  name ", texts) == "another name"


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


@pytest.mark.slow
def test_a_ski_maker_sees_what_five_per_cent_do(page: Page, served: Served) -> None:
    """Sidecut and stiffness of a ski that was measured: the carved radii of both are beside each other."""
    page.goto(f"{served.address}carve")
    page.get_by_role("link", name="Add or change a ski").click()
    page.locator("summary", has_text="Add a measured ski").click()
    labels = dict(zip(TYPED, ("Length (mm)", "Running length (mm)", "Sidecut length (mm)", "Width at the tip (mm)",
        "Width at the waist (mm)", "Width at the tail (mm)", "Mass of one ski (kg)", "Camber (mm)",
        "EI (N m²) from tip to tail", "GJ (N m²) from tip to tail"), strict=True))  # fmt: skip
    form = page.locator(".adding > .fields")
    fill(page, {"Name of the ski": "mine"})
    for key, label in labels.items():
        form.get_by_label(label, exact=True).fill(TYPED[key])
    page.get_by_role("button", name="Add this ski").click()
    page.get_by_text("The ski mine is added.").wait_for()
    page.get_by_role("columnheader", name="mine").wait_for()
    for factor in ("Sidecut depth ×", "EI ×", "GJ ×"):
        page.get_by_label(factor, exact=True).fill("1,05")
        page.keyboard.press("Tab")
    page.get_by_role("columnheader", name="mine, edited").wait_for()
    fill(page, {"New name": "mine plus 5"})
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_role("link", name="Carve both side by side").click()
    radii = page.get_by_role("region", name="Carved radius").locator(".value")
    radii.nth(1).wait_for()
    first, second = (float(re.findall(r"([\d.]+) m", each)[0]) for each in radii.all_inner_texts())
    assert second == pytest.approx(first / 1.05, rel=0.02)  # about as the sidecut radius
