"""The sliders give the numbers of the library."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

from skisnow.carving.answer import answer_dict, answered
from skisnow.carving.question import CARVE_KEYS, carve_question
from skisnow.report.formatting import significant
from skisnow.web.carved_turn import RATIOS, SLIDERS

from .conftest import Served, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page

PARTS = ("forebody", "afterbody")


def radius(edge_angle_deg: float, **snow: object) -> str:
    asked = {"ski": "carver", "edge_angle_deg": edge_angle_deg, "load_N": 800.0, "unloading_ratio": 10.0}
    numbers = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
    answer = answer_dict(answered(carve_question({**asked, **(snow or numbers)})))
    return f"carver: carved radius {significant(answer['turn_radius_boot_m'])} m"


def test_the_sliders_are_inputs_of_a_carved_turn() -> None:
    for name, (label, stops, start) in SLIDERS.items():
        assert label.endswith(f"({CARVE_KEYS[name].unit})")
        assert start in stops
        assert [float(stop) for stop in stops] == sorted({float(stop) for stop in stops})
        assert all(CARVE_KEYS[name].in_range(float(stop)) == float(stop) for stop in stops)
    assert all(CARVE_KEYS["unloading_ratio"].in_range(float(ratio)) for ratio in RATIOS)


def test_the_radius_follows_the_slider(page: Page, served: Served) -> None:
    page.goto(f"{served.address}carve")
    headline = page.get_by_role("region", name="Carved radius")
    headline.get_by_text("carved radius").wait_for()
    assert headline.inner_text() == radius(45.0)
    ready(page)
    slider = page.get_by_role("slider", name="Edge angle (°)")
    slider.focus()
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    page.get_by_text("Edge angle (°): 48").wait_for()
    headline.get_by_text(radius(48.0), exact=True).wait_for()
    assert slider.get_attribute("aria-valuetext") == "48"
    assert radius(48.0) != radius(45.0)
    loads = [page.get_by_role("row", name=f"Load on the {part}").get_by_role("cell").inner_text() for part in PARTS]
    assert sum(float(load.removesuffix(" N")) for load in loads) == pytest.approx(800.0, abs=2.0)  # three digits each
    assert page.locator("svg .name").all_text_contents() == ["carver"] * 4
    assert page.locator("svg .end").all_text_contents() == ["◂ tail", "tip ▸"] * 4
    page.get_by_label("Snow", exact=True).click()
    page.get_by_role("option", name="published: race-piste").click()
    page.get_by_text("Snow: H_V = 0.207 N/mm³").wait_for()
    headline.get_by_text(radius(48.0, published="race-piste"), exact=True).wait_for()
    assert page.get_by_role("slider", name="Snow hardness H_V (N/mm³)").is_hidden()


def test_the_designed_ski_follows_and_the_charts_are_saved(page: Page, served: Served) -> None:
    page.goto(f"{served.address}design?ski=slalom")
    headline = page.get_by_role("region", name="Carved radius")
    headline.get_by_text("slalom, designed: carved radius 10.3 m").wait_for()
    ready(page)
    page.get_by_label("Wanted radius (m)").fill("12")
    page.get_by_role("button", name="Find the design").click()
    headline.get_by_text("slalom, designed: carved radius 12.0 m").wait_for()
    slider = page.get_by_role("slider", name="Sidecut, tip and tail (mm)")
    assert float(slider.input_value()) < 30  # narrower: it has moved from the middle
    slider.press("ArrowLeft")
    page.get_by_text(re.compile(r"tip and tail \(mm\): -6\.?5?$")).wait_for()
    for kind, begin in (("SVG", b"<svg"), ("PNG", b"\x89PNG")):
        with page.expect_download() as download:
            page.get_by_role("button", name=f"Curves as {kind}").click()
        content = download.value.path().read_bytes()
        assert download.value.suggested_filename == f"design.{kind.lower()}"
        assert content.startswith(begin)
        assert len(content) > 10_000
        if kind == "SVG":
            root = ElementTree.fromstring(content)
            assert len(root.findall("{*}svg")) == 2  # both charts
            assert [each.text for each in root.iter() if each.get("class") == "name"] == [
                "slalom, designed",
                "slalom",
            ] * 2
