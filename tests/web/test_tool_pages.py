"""The pages of an analysis, of skis and of carves in a browser."""

from __future__ import annotations

import io
import re
import urllib.request
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import pandas
import pytest
from PIL import Image

from skisnow.campaign import read_campaign, write_reference
from skisnow.campaign.store import Journals, NewEntry, Store
from skisnow.carving.answer import answer_dict, answered
from skisnow.carving.question import CARVE_KEYS, carve_question
from skisnow.estimation import analyse, results_dict
from skisnow.report.formatting import significant
from skisnow.web.campaign_analysis import choosable_flags
from skisnow.web.carved_turn import PANELS, RATIOS, SLIDERS
from skisnow.web.widgets import STYLES

from .conftest import DRAWING_MS, Served, downloaded_results, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page, WebSocketRoute

SEED = 3
DESCRIPTION = """name = "growing"
load_steps_N = [20, 40, 60]
gauge_resolution_mm = 0.01
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
"""


def kept_campaign(served: Served, folder: Path) -> str:
    write_reference(folder, seed=SEED)
    with Store.open(served.store) as store:
        return store.add(folder).id


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


@pytest.mark.slow
def test_one_experiment_less_by_choice(page: Page, served: Served, tmp_path: Path) -> None:
    id_ = kept_campaign(served, tmp_path / "reference")
    campaign = read_campaign(tmp_path / "reference")
    results = results_dict(analyse(campaign))
    pressed, sheared = used(results)
    of_pressed, of_sheared = (len(results[kind]["experiments"]) for kind in ("penetration", "shear"))

    def told(n: int) -> str:
        return f"{of_pressed} penetration experiments, {n} used; {of_sheared} shear experiments, {sheared} used."

    page.goto(f"{served.address}analysis/kept/{id_}")
    assert used(downloaded_results(page)) == (pressed, sheared)  # asked for before there was anything
    page.get_by_text(told(pressed), exact=True).wait_for(timeout=DRAWING_MS)
    drawn = page.locator("figure img").count()
    assert drawn >= 8
    page.set_viewport_size({"width": 390, "height": 844})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.locator(".scroll").first.evaluate("(box) => box.scrollWidth > box.clientWidth && box.clientWidth > 0")
    page.set_viewport_size({"width": 1280, "height": 720})
    page.locator("summary", has_text="Included experiments").press("Enter")
    first = next(row for row in results["penetration"]["experiments"] if row["used"])
    words = f"Penetration {first['experiment']}, {first['site']}, {first['edge_angle_deg']:g}°"
    page.get_by_role("checkbox", name=words, exact=True).press("Space")
    given = downloaded_results(page)  # of the new choice, while the old one is still shown
    page.get_by_text(told(pressed - 1), exact=True).wait_for(timeout=DRAWING_MS)
    assert page.locator("figure img").count() == drawn
    row = next(row for row in given["penetration"]["experiments"] if row["experiment"] == first["experiment"])
    assert not row["used"] and "cancelled" in row["flags"]
    page.locator("summary", has_text="Exclude experiments with these quality flags").press("Enter")
    box = page.get_by_role("checkbox", name=choosable_flags()["layered"], exact=True)
    assert box.is_checked() == ("layered" in campaign.excluding)
    box.press("Space")
    excluding = campaign.excluding ^ {"layered"}
    more = used(results_dict(analyse(replace(campaign, excluding=excluding))))[0]
    assert more != pressed
    page.get_by_text(told(more - ("layered" not in first["flags"])), exact=True).wait_for(timeout=DRAWING_MS)
    page.locator("summary", has_text="Every penetration experiment").press("Enter")
    page.locator("details[open] table").get_by_text(str(first["experiment"]), exact=True).wait_for()
    page.set_viewport_size({"width": 390, "height": 844})
    wide = page.locator(".table", has=page.locator("caption", has_text="Table 2")).first
    wide.evaluate("(each) => each.scrollTo(each.scrollWidth, 0)")
    assert wide.evaluate("(each) => each.scrollLeft") > 100
    for stays in (wide.locator("caption"), wide.locator("tbody th").first):  # what the numbers are of
        seen = stays.bounding_box()
        assert seen is not None
        assert seen["x"] >= 0 and seen["x"] + seen["width"] <= 390


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
    page.get_by_text("1 penetration experiment, 1 used; 0 shear experiments, 0 used.").first.wait_for()
    assert "1 penetration experiment, 1 used" in html(served, path)
    assert f"/enter/{id_}" in html(served, path)  # the way back
    drawn = page.locator("figure img").first
    drawn.wait_for()
    assert len(drawn.get_attribute("src") or "") > 5000 and drawn.evaluate("each => each.decode().then(() => true)")
    with Store.open(served.store) as store:
        cancelled = NewEntry(action="cancel", file="penetration.csv", test="1", why="the tool slipped")
        Journals(store).append(id_, cancelled, seen=last)
    assert "1 penetration experiment" not in html(served, path)
    page.reload()
    page.get_by_text("1 penetration experiment, 0 used").first.wait_for()


def test_the_report_is_of_what_was_chosen_just_before(page: Page, served: Served, tmp_path: Path) -> None:
    id_ = kept_campaign(served, tmp_path / "reference")
    said: list[tuple[WebSocketRoute, str | bytes]] = []
    is_slow = False

    def pass_on(socket: WebSocketRoute) -> None:
        lab = socket.connect_to_server()
        socket.on_message(lambda message: said.append((lab, message)) if is_slow else lab.send(message))

    page.route_web_socket("**/*", pass_on)
    page.goto(f"{served.address}analysis/kept/{id_}")
    page.locator(".status", has_text="used.").wait_for()
    ready(page)
    page.locator("summary", has_text="Included experiments").press("Enter")
    first = page.get_by_role("checkbox", name=re.compile("^Penetration P001,"))
    first.wait_for()
    is_slow = True
    first.press("Space")
    with page.expect_popup() as opened:
        page.get_by_role("link", name="Open the report").press("Enter")
        is_slow = False
        for lab, message in said:
            lab.send(message)
    report = opened.value
    report.wait_for_load_state()
    assert "cancelled" in report.content()


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
        ("Sidecut, tip and tail (mm)", re.compile(r"tip and tail \(mm\): -6\.?5?$")),
        ("Waist (mm)", re.compile(r"Waist \(mm\): -0\.5$")),
        ("Tip (mm)", re.compile(r"^Tip \(mm\): -0\.5$")),
        ("Tail (mm)", re.compile(r"^Tail \(mm\): -0\.5$")),
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


def test_the_curves_of_a_carve_are_saved(page: Page, served: Served) -> None:
    page.goto(f"{served.address}carve?ski=slalom&other=carver")
    page.get_by_role("region", name="Carved radius").get_by_text("slalom: carved radius").wait_for()
    ready(page)
    check_curves(page, "carve", [carve_answer(45.0, ski=ski) for ski in ("slalom", "carver")])
