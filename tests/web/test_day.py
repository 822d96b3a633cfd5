"""A campaign's day as a person does it, with the keyboard, and then the same numbers from the command line."""

from __future__ import annotations

import json
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

from skisnow.field.store import Journals, Store, grown

from .conftest import Served, fill

if TYPE_CHECKING:
    from playwright.sync_api import Page

SERIES = {
    "1": ("30", ("1.5", "22.5", "2.6", "3.0")),  # the second one is a typing error for 2.15
    "2": ("30", ("1,4", "2,0", "2.5", "2.9")),
    "3": ("45", ("1.9", "2.7", "3.3", "3.8")),
}
LOADS = ("20", "40", "60", "80")


def create(page: Page, served: Served) -> None:
    page.goto(served.address)
    page.get_by_role("link", name="New campaign").press("Enter")
    page.get_by_role("heading", name="New campaign").wait_for()
    fill(
        page,
        {
            "Name of the campaign": 'The day <b>"of" & tests</b>',
            "Place": "a slope",
            "Observers, with commas between": "Ada, Bo",
            "Loads of the disc set (N), with blanks between": " ".join(LOADS),
            "Step of the depth gauge (mm)": "0.01",
            "Uncertainty of the moment (N m)": "0,5",
            "Name of tool 1": "ski piece",
            "Length (mm) of tool 1": "200",
            "Width (mm) of tool 1": "62",
            "Name of plate 1": "plate",
            "Length (mm) of plate 1": "100",
        },
    )
    page.get_by_role("button", name="Store and enter tests").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()


def enter_series(page: Page, name: str) -> None:
    """From the form of a new series on, by keyboard alone."""
    angle, depths = SERIES[name]
    fill(page, {"Name of the test": name, "Site": "A", "Edge angle (°)": angle})
    page.keyboard.press("Enter")
    page.get_by_role("heading", name=f"Series {name}").wait_for()
    page.locator("input:focus").wait_for()
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    for depth, load in zip(depths, LOADS, strict=True):
        page.keyboard.type(depth)
        page.keyboard.press("Enter")
        page.get_by_text(f"Stored: {depth.replace(',', '.')} mm under {load} N.").wait_for()


def correct_the_typing_error(page: Page) -> None:
    page.get_by_label("Depth under 40 N (mm)").fill("2.15")
    page.keyboard.press("Enter")
    page.get_by_label("Why", exact=True).and_(page.locator(":focus")).wait_for()
    page.keyboard.press("Enter")
    page.get_by_text("Corrected; the first reading is kept.").wait_for()
    page.get_by_text("corrected from 22.5").wait_for()


def cancel(page: Page) -> None:
    page.get_by_role("button", name="Cancel this test").press("Enter")
    page.get_by_label("Why", exact=True).and_(page.locator(":focus")).wait_for()
    page.keyboard.type("the tool slipped")
    page.keyboard.press("Enter")
    page.get_by_text("Cancelled: the tool slipped").wait_for()


def enter_shear(page: Page) -> None:
    page.get_by_role("link", name="Shear").press("Enter")
    page.get_by_role("heading", name="New test").wait_for()
    page.locator("input:focus").wait_for()  # the server sets it once the page is connected
    fill(page, {"Site": "A", "Edge angle (°)": "90", "Depth (mm)": "6", "Lever arm (mm)": "250", "Moment (N m)": "30"})
    page.get_by_label("Moment (N m)").press("Enter")
    page.get_by_text("Stored: test 1.").wait_for()
    page.get_by_text("S_f = 0.200 N/mm²").wait_for()  # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    page.get_by_label("Depth (mm)", exact=True).and_(page.locator(":focus")).wait_for()
    page.keyboard.type("8")
    page.keyboard.press("Enter")
    page.get_by_label("Moment (N m)").and_(page.locator(":focus")).wait_for()  # the server moves it
    page.keyboard.type("36")
    page.keyboard.press("Enter")
    page.get_by_text("Stored: test 2.").wait_for()


def test_a_day(page: Page, served: Served, tmp_path: Path) -> None:
    create(page, served)
    enter_series(page, "1")
    page.get_by_text("below the one before it").wait_for()  # the mark in words, while the error stands
    correct_the_typing_error(page)
    page.get_by_text("below the one before it").wait_for(state="detached")
    page.get_by_role("button", name="Next series").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()
    enter_series(page, "2")
    served.again()  # killed and started again, with the page open
    page.reload()
    page.get_by_role("heading", name="Series 2").wait_for()
    assert page.get_by_label("Depth under 80 N (mm)").input_value() == "2.9"
    page.get_by_role("button", name="Next series").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()
    enter_series(page, "3")
    cancel(page)
    enter_shear(page)
    assert page.get_by_role("heading", level=1).inner_text() == 'The day <b>"of" & tests</b>'

    page.get_by_role("link", name="Analysis").press("Enter")
    page.get_by_text("3 penetration experiments, 2 used; 2 shear experiments, 2 used.").wait_for()
    with page.expect_download() as download:
        page.get_by_role("link", name="Download everything").press("Enter")
    with zipfile.ZipFile(download.value.path()) as packed:
        packed.extractall(tmp_path / "everything")
    page.goto(served.address)
    with page.expect_download() as download:
        page.get_by_role("link", name="Export").press("Enter")
    with zipfile.ZipFile(download.value.path()) as packed:
        packed.extractall(tmp_path / "export")

    folder = tmp_path / "export" / "campaign"
    command = [sys.executable, "-m", "skisnow", "analyse", str(folder), "--json"]
    by_command = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    by_lab = json.loads((tmp_path / "everything" / "analysis" / "results.json").read_text(encoding="utf-8"))
    for results in (by_command, by_lab):
        results["provenance"].pop("time")
    assert by_command == by_lab
    rows = {row["experiment"]: row for row in by_command["penetration"]["experiments"]}
    assert [rows[name]["used"] for name in "123"] == [True, True, False]
    # by hand, Eqn 2 of a wedge: V = L e² / (2 tan ϑ) at e = 3 mm, ϑ = 30°: H_V = 80 N / V
    volume = 200.0 * 3.0**2 / (2.0 * 3.0**-0.5)
    assert abs(rows["1"]["H_V_N_per_mm3"] / (80.0 / volume) - 1.0) < 1e-9
    corrections = by_command["campaign"]["corrections"]
    assert [(each["column"], each["old"], each["new"]) for each in corrections] == [
        ("depth_mm", "22.5", "2.15"),
        ("status", "", "the tool slipped"),
    ]


def test_undo_and_a_second_look(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    page.get_by_role("button", name="Undo: entered 3.0 mm under 80 N").press("Enter")
    page.get_by_text("Undone.").wait_for()
    assert page.get_by_label("Depth under 80 N (mm)").input_value() == ""
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        test = grown(Journals(store).entries(head.id)).test("penetration.csv", "1")
    assert [row.cells["depth_mm"] for row in test.rows] == ["1.5", "22.5", "2.6"]
    assert [entry.action for entry in test.history] == ["add"] * 4 + ["undo"]


def test_what_is_no_number_is_not_stored(page: Page, served: Served) -> None:
    create(page, served)
    fill(page, {"Site": "A", "Edge angle (°)": "95"})
    page.keyboard.press("Enter")
    page.get_by_text("Not begun: edge_angle_deg is a number of at least 0 and below 90").wait_for()
    fill(page, {"Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    page.keyboard.type("1.5.2")
    page.keyboard.press("Enter")
    page.get_by_text("Not stored: depth_mm is a number of at least 0").wait_for()
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        assert head.n_entries == 1


def test_two_browsers_on_one_series(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    other = page.context.new_page()
    other.goto(page.url)
    other.get_by_role("heading", name="Series 1").wait_for()
    correct_the_typing_error(page)
    other.get_by_label("Depth under 60 N (mm)").fill("9.9")
    other.keyboard.press("Enter")
    other.get_by_label("Why", exact=True).wait_for()
    other.get_by_role("button", name="Correct it").click()
    other.get_by_text("Nothing was stored: Ada wrote about penetration.csv, 1 meanwhile").wait_for()
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        rows = grown(Journals(store).entries(head.id)).test("penetration.csv", "1").rows
    assert [row.cells["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6", "3.0"]


def test_a_phone_and_the_names_of_all_fields(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    page.set_viewport_size({"width": 390, "height": 844})
    here = page.url
    places = [served.address, f"{served.address}describe", here, here.split("?")[0] + "?table=shear.csv"]
    places += [here.split("?")[0] + f"?table={file}" for file in ("density.csv", "drop_cone.csv")]
    for place in (*places, here.split("?")[0].replace("/enter/", "/analysis/entry/")):
        page.goto(place)
        page.get_by_role("heading", level=1).wait_for()
        page.locator(".status, h2").first.wait_for()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, place
        fields = page.locator("input:visible, select:visible, button:visible")
        nameless = [each for each in fields.all() if not each.evaluate(NAME_OF)]
        assert nameless == [], place


NAME_OF = """element => element.getAttribute('aria-label') || element.innerText?.trim()
  || [...(element.labels || [])].map(label => label.innerText.trim()).join(' ')"""
