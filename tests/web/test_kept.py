"""A campaign that was imported is corrected: with reasons, undo and history; its files stay, its export says all."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import pytest

from skisnow.campaign.store import Store
from skisnow.cli import main

from .conftest import Served, downloaded_results, follow, has_text, killed_and_started_again, ready

if TYPE_CHECKING:
    from playwright.sync_api import Page

Printed: TypeAlias = pytest.CaptureFixture[str]
FILES = {
    "campaign.toml": """name = "From <a> drawer"
observers = ["Ada", "Bo"]
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[plate]]
name = "plate"
length_mm = 100
""",
    "penetration.csv": """experiment;site;tool;edge_angle_deg;load_N;depth_mm
1;A;ski piece;30;20;1,5
1;A;ski piece;30;40;22,5
1;A;ski piece;30;60;2,6
2;A;ski piece;30;20;1,4
2;A;ski piece;30;40;2,0
2;A;ski piece;30;60;2,5
3;B;ski piece;30;20;1,9
3;B;ski piece;30;40;2,7
3;B;ski piece;30;60;3,3
""",
    "shear.csv": "experiment,site,plate,edge_angle_deg,depth_mm,lever_arm_mm,moment_Nm\n1,A,plate,90,6,250,30\n",
}


def imported(page: Page, served: Served) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in FILES.items():
            archive.writestr(f"drawer/{name}", text)
    page.goto(served.address)
    page.get_by_label("Files or zip").set_input_files(
        {"name": "drawer.zip", "mimeType": "application/zip", "buffer": packed.getvalue()}
    )
    ready(page)
    page.get_by_role("button", name="Import files or zip").press("Enter")
    page.get_by_text("The campaign is imported, byte for byte.").wait_for()


def exported(page: Page, served: Served, place: Path) -> Path:
    page.goto(served.address)
    with page.expect_download() as download:
        follow(page, "Export")
    with zipfile.ZipFile(download.value.path()) as packed:
        packed.extractall(place)
    return place / "campaign"


def exported_by_command(served: Served, place: Path) -> Path:
    with Store.open(served.store) as store:
        (stored,) = store.list()
    assert main(["store", "export", stored.id, "--out", str(place), "--store", str(served.store)]) == 0
    return place


def contents(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def analysed(folder: Path, printed: Printed) -> dict[str, Any]:
    """Output of the command."""
    printed.readouterr()
    assert main(["analyse", str(folder), "--json"]) == 0
    answer: dict[str, Any] = json.loads(printed.readouterr().out)
    return answer


def correct(page: Page, field: str, text: str, why: str) -> None:
    page.get_by_label(field, exact=True).fill(text)
    page.keyboard.press("Enter")
    page.get_by_label("Why", exact=True).and_(page.locator(":focus")).wait_for()
    ready(page)
    page.keyboard.type(f"{why}\n")
    page.get_by_text("Corrected; the first reading is kept.").wait_for()


@pytest.mark.slow
def test_an_imported_campaign_is_corrected(page: Page, served: Served, tmp_path: Path, capsys: Printed) -> None:
    imported(page, served)
    follow(page, "Analysis")
    page.get_by_text("3 penetration experiments, 2 used; 1 shear experiment, 1 used.").wait_for()  # 1 is marked
    page.goto(served.address)
    follow(page, "Correct")
    page.get_by_role("link", name="Penetration").wait_for()
    page.get_by_text("A: 2").click()
    follow(page, "1", exact=True)
    page.get_by_role("heading", name="Test 1").wait_for()
    page.get_by_text("below the one before it").wait_for()
    correct(page, "Depth (mm), row 3", "2,15", "the point")
    page.get_by_text("below the one before it").wait_for(state="detached")
    has_text(page.get_by_label("Depth (mm), row 3"), "2.15")
    correct(page, "Depth (mm), row 4", "2.7", "misheard")
    page.get_by_role("button", name="Undo: corrected Depth (mm) in row 4 to 2.7 (misheard)").press("Enter")
    page.get_by_text("Undone.").wait_for()
    has_text(page.get_by_label("Depth (mm), row 4"), "2,6")
    page.get_by_label("Depth (mm), row 4").fill("two")
    page.keyboard.press("Enter")
    page.locator(".refusals li", has_text="“two”").wait_for()

    killed_and_started_again(page, served)  # all that was shown as stored is stored
    page.get_by_text("History of 1", exact=True).click()
    page.get_by_text("· Ada · corrected Depth (mm) in row 3 to 2.15 (the point)").wait_for()
    page.get_by_text("corrected Depth (mm) in row 4 to 2.7 (misheard) (undone)").wait_for()
    follow(page, "Another test")
    page.get_by_text("B: 1").click()
    follow(page, "3", exact=True)
    page.get_by_role("heading", name="Test 3").wait_for()
    ready(page)
    page.get_by_role("button", name="Cancel this test").press("Enter")
    page.get_by_label("Why", exact=True).and_(page.locator(":focus")).wait_for()
    page.keyboard.type("the tool slipped\n")
    page.get_by_text("Cancelled: the tool slipped").wait_for()

    folder = exported(page, served, tmp_path / "export")
    assert contents(folder) == contents(exported_by_command(served, tmp_path / "back"))
    for name, text in FILES.items():
        assert (folder / name).read_bytes() == text.encode(), name
    results = analysed(folder, capsys)
    rows = {row["experiment"]: row for row in results["penetration"]["experiments"]}
    assert [rows[name]["used"] for name in "123"] == [True, True, False]
    # by hand, Eqn 2 of a wedge: V = L e² / (2 tan ϑ) at e = 2.6 mm, ϑ = 30°: H_V = 60 N / V
    assert abs(rows["1"]["H_V_N_per_mm3"] * 200.0 * 2.6**2 / (2.0 * 3.0**-0.5) / 60.0 - 1.0) < 1e-9
    assert [(each["row"], each["column"], each["new"]) for each in results["campaign"]["corrections"]] == [
        (3, "depth_mm", "2.15"),
        (8, "status", "the tool slipped"),
    ]
    follow(page, "Analysis")
    page.get_by_text("3 penetration experiments, 2 used; 1 shear experiment, 1 used.").wait_for()  # 3 is cancelled
    by_lab = downloaded_results(page)
    for each in (by_lab, results):
        each["provenance"].pop("time")
    assert by_lab == results


@pytest.mark.parametrize("has_icons", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_the_pages_fit_a_phone(page: Page, served: Served, has_icons: bool) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    if not has_icons:  # the icons' font comes late, or never: an icon is then its name, which is longer
        page.route("**/*.woff*", lambda route: route.abort())
    imported(page, served)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    follow(page, "Correct")
    page.get_by_text("A: 2").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    follow(page, "1", exact=True)
    page.get_by_text("below the one before it").wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
