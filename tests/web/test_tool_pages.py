"""The pages of an analysis, of skis and of carves in a browser."""

from __future__ import annotations

import io
import re
import urllib.request
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import pandas
import pytest
from PIL import Image

from skisnow.campaign.store import Journals, NewEntry, Store
from skisnow.carving.answer import answer_dict, answered
from skisnow.carving.question import CARVE_KEYS, carve_question
from skisnow.report.formatting import significant
from skisnow.web.carved_turn import PANELS, RATIOS, SLIDERS
from skisnow.web.widgets import STYLES

from .conftest import Served, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page

DESCRIPTION = """name = "growing"
load_steps_N = [20, 40, 60]
gauge_resolution_mm = 0.01
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
"""


def used(results: dict[str, object]) -> tuple[int, int]:
    counts = []
    for kind in ("penetration", "shear"):
        part = results[kind]
        assert isinstance(part, dict)
        counts.append(sum(row["used"] for row in part["experiments"]))
    return counts[0], counts[1]


def html(served: Served, path: str) -> str:
    """The server's first answer to a browser."""
    with urllib.request.urlopen(served.address.rstrip("/") + path) as answer:
        return str(answer.read().decode())


def test_the_numbers_are_there_with_the_page_until_something_is_entered(
    page: Page, served_with_figures: Served
) -> None:
    served = served_with_figures
    with Store.open(served.store) as store:
        journals = Journals(store)
        id_ = journals.begin(DESCRIPTION)
        last = 0
        for position, (load, depth) in enumerate((("20", "1.5"), ("40", "2.15"), ("60", "2.6"))):
            cells = {"experiment": "1", "site": "A", "spot": "", "tool": "ski piece", "edge_angle_deg": "30"}
            row = NewEntry(
                action="add", file="penetration.csv", test="1", position=position,
                cells={**cells, "load_N": load, "depth_mm": depth},
            )  # fmt: skip
            last = journals.append(id_, row, seen=last).sequence
    path = f"/analysis/entry/{id_}"
    assert "Computing" in html(served, path)
    page.goto(served.address.rstrip("/") + path)
    page.get_by_text("1 penetration experiment (1 used)").first.wait_for()
    assert "1 penetration experiment (1 used)" in html(served, path)
    assert f"/enter/{id_}" in html(served, path)  # the way back
    drawn = page.locator("figure img").first
    drawn.wait_for()
    assert len(drawn.get_attribute("src") or "") > 5000 and drawn.evaluate("each => each.decode().then(() => true)")
    with Store.open(served.store) as store:
        cancelled = NewEntry(action="cancel", file="penetration.csv", test="1", why="the tool slipped")
        Journals(store).append(id_, cancelled, seen=last)
    assert "1 penetration experiment" not in html(served, path)
    page.reload()
    page.get_by_text("1 penetration experiment (0 used)").first.wait_for()


PARTS = ("forebody", "afterbody")
SNOW = {"H_V_N_per_mm3": 0.2, "S_f_N_per_mm2": 0.5}
"""That of the first sliders."""


def carve_answer(edge_angle_deg: float, snow: Mapping[str, object] = SNOW, *, ski: str = "carver") -> dict[str, Any]:
    """The library's answer."""
    asked = {"ski": ski, "edge_angle_deg": edge_angle_deg, "load_N": 800.0, "unloading_ratio": 10.0}
    return answer_dict(answered(carve_question({**asked, **snow})))


def radius(edge_angle_deg: float, snow: Mapping[str, object] = SNOW) -> str:
    answer = carve_answer(edge_angle_deg, snow)
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
    headline.get_by_text(radius(48.0, {"published": "race-piste"}), exact=True).wait_for()
    assert page.get_by_role("slider", name="Snow hardness H_V (N/mm³)").is_hidden()


def saved(page: Page, button: str) -> tuple[str, bytes]:
    """Name and contents of the file that a button saves."""
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    return download.value.suggested_filename, download.value.path().read_bytes()


def check_curves(page: Page, name: str, answers: list[dict[str, Any]]) -> None:
    """The saved table has the answers' values, and both pictures have the lines of all charts."""
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
