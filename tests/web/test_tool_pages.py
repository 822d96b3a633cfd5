"""The page that designs a ski, in a browser."""

import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from skisnow.carving.answer import answer_dict, answer_question
from skisnow.carving.question import CARVE_KEYS, carve_question
from skisnow.report.formatting import significant
from skisnow.web.pages.carve import PANELS, RATIOS, SLIDERS
from skisnow.web.widgets import STYLES

from .browser_types import Page
from .conftest import Served, ready

SNOW = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
"""That of the first sliders."""


def carve_answer(edge_angle_deg: float, snow: Mapping[str, object] = SNOW, *, ski: str = "carver") -> dict[str, Any]:
    """The library's answer."""
    asked = {"ski": ski, "edge_angle_deg": edge_angle_deg, "load_N": 800.0, "unloading_ratio": 10.0}
    return answer_dict(answer_question(carve_question({**asked, **snow})))


def test_the_sliders_are_inputs_of_a_carved_turn() -> None:
    for name, (label, stops, start) in SLIDERS.items():
        assert label.endswith(f"({CARVE_KEYS[name].unit})")
        assert start in stops
        assert [float(stop) for stop in stops] == sorted({float(stop) for stop in stops})
        assert all(CARVE_KEYS[name].in_range(float(stop)) == float(stop) for stop in stops)
    assert all(CARVE_KEYS["unloading_ratio"].in_range(float(ratio)) for ratio in RATIOS)


def saved(page: Page, button: str) -> tuple[str, bytes]:
    """Name and contents of the file that a button saves."""
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    return download.value.suggested_filename, download.value.path().read_bytes()


def check_curves(page: Page, name: str, answers: list[dict[str, Any]]) -> None:
    """The saved table has the answers' values, and both pictures have the lines of all charts."""
    import pandas

    file, content = saved(page, "Curves as CSV")
    assert file == f"{name}.csv"
    table = pandas.read_csv(io.BytesIO(content))
    skis = [each["ski"]["name"] for each in answers]
    for ski, answer in zip(skis, answers, strict=True):
        of_ski = table[table["ski"] == ski]
        for key in ("station_m", *PANELS):
            assert of_ski[key].tolist() == pytest.approx(answer[key], rel=1e-6, abs=1e-8), key
    file, content = saved(page, "Curves as SVG")
    assert file == f"{name}.svg"
    root = ElementTree.fromstring(content)
    charts, shown = root.findall("{*}svg"), page.locator("[data-drawn] > svg")
    assert len(charts) == shown.count()
    for number, chart in enumerate(charts):
        lines = [each.get("d") for each in chart.iter() if each.get("class") == "line"]
        assert lines == shown.nth(number).locator("path.line").evaluate_all("all => all.map(e => e.getAttribute('d'))")
        assert [each.text for each in chart.iter() if each.get("class") == "name"] == skis
    file, content = saved(page, "Curves as PNG")
    assert file == f"{name}.png"
    with Image.open(io.BytesIO(content)) as picture:
        assert picture.size == (2 * int(root.get("width", 0)), 2 * int(root.get("height", 0)))
        colours = set(map(tuple, np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0).tolist()))
    assert {tuple(bytes.fromhex(str(style["colour"])[1:])) for style in STYLES[: len(skis)]} <= colours


def fits(page: Page) -> bool:
    return bool(page.evaluate("document.documentElement.scrollWidth") <= 390)


@pytest.mark.slow
def test_a_ski_is_designed_on_a_telephone(page: Page, served: Served, tmp_path: Path) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(f"{served.address}design?ski=slalom&other=carver")
    headline = page.get_by_role("region", name="Carved radius")
    headline.get_by_text("slalom, designed: carved radius 10.3 m").wait_for()
    ready(page)
    page.get_by_label("Wanted radius (m)").fill("12")
    page.get_by_role("button", name="Find the design").click()
    headline.get_by_text("slalom, designed: carved radius 12.0 m").wait_for()
    assert fits(page)
    for slider, shown in (
        ("Sidecut, tip and tail (mm)", re.compile(r"tip and tail \(mm\): −6\.?5?$")),
        ("Waist (mm)", re.compile(r"Waist \(mm\): −0\.5$")),
        ("Tip (mm)", re.compile(r"^Tip \(mm\): −0\.5$")),
        ("Tail (mm)", re.compile(r"^Tail \(mm\): −0\.5$")),
        ("EI before the middle ×", re.compile(r"before the middle ×: 0\.95$")),
        ("Edge angle (°)", re.compile(r"angle \(°\): 44$")),
    ):
        page.get_by_role("slider", name=slider, exact=True).press("ArrowLeft")
        page.get_by_text(shown).wait_for()
    file, content = saved(page, "Download the file")
    assert file == "ski.toml"
    (tmp_path / file).write_bytes(content)
    answers = [carve_answer(44.0, ski=ski) for ski in (str(tmp_path / file), "carver")]
    for answer in answers:
        radius_now = significant(answer["turn_radius_boot_m"])
        headline.get_by_text(f"{answer['ski']['name']}: carved radius {radius_now} m", exact=True).wait_for()
    check_curves(page, "design", answers)
    assert fits(page)
