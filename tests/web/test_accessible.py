"""What bars people from a page, as axe-core finds it: nothing serious or critical in lab, reports and docs."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow.cli import main

from .conftest import Served, ready, settled
from .replay.test_lab_page import kept
from .test_carve_page import ANSWERED_MS
from .test_day import create, enter_series

if importlib.util.find_spec("axe_playwright_python") is None:
    pytest.skip("axe-core is not installed: pip install axe-playwright-python", allow_module_level=True)

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

DOCS = Path(__file__).parents[2] / "docs"
PAGES_OF_DOCS = (
    "index.html",
    "how-to/web-lab.html",
    "files/scenario.html",
    "validation/coverage.html",
    "gallery/index.html",
)
"""One of each kind: a list, words with pictures, wide tables, equations with numbers, figures."""


def barred(page: Page) -> list[str]:
    """What axe-core finds serious or critical, with the first element that has it."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response["violations"]
    return [f"{each['id']}: {each['nodes'][0]['html']}" for each in found if each["impact"] in ("serious", "critical")]


def test_it_finds_what_bars_people(page: Page) -> None:
    page.set_content('<html lang="en"><title>t</title><main><h1>t</h1><img src="data:,"><input></main></html>')
    assert {each.split(":")[0] for each in barred(page)} == {"image-alt", "label"}


def test_nobody_is_barred_from_a_page_of_the_lab(page: Page, served: Served) -> None:
    create(page, served)
    enter_series(page, "1")
    kept(served.lab, "a-run")
    entry = page.url
    id_ = entry.split("/enter/")[1].split("?")[0]
    places = {
        entry: ".beside path.points",
        f"{entry.split('?')[0]}?table=shear.csv": "h2",
        served.address: ".card",
        f"{served.address}describe": "h2",
        f"{served.address}analysis/entry/{id_}": ".results",
        f"{served.address}skis": "td",
        f"{served.address}carve": "td",
        f"{served.address}simulate": "summary",
        f"{served.address}replay": ".card",
        f"{served.address}nowhere": "h1",
    }
    for place, shown in places.items():
        page.goto(place)
        page.locator(shown).first.wait_for(timeout=ANSWERED_MS)
        page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
        if not place.endswith("nowhere"):
            ready(page)
        settled(page)
        assert barred(page) == [], place


@pytest.mark.slow
def test_nobody_is_barred_from_a_report(chromium: Browser, tmp_path: Path) -> None:
    page = chromium.new_page()
    assert main(["reference", str(tmp_path / "campaign"), "--seed", "1"]) == 0
    assert main(["analyse", str(tmp_path / "campaign"), "--out", str(tmp_path / "analysis")]) == 0
    assert main(["simulate", "carved-46m", "--set", "run.duration_s=0.2", "--out", str(tmp_path / "run")]) == 0
    reports = sorted(tmp_path.glob("*/report.html"))
    assert len(reports) == 2
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        for report in reports:
            page.goto(report.as_uri())
            assert barred(page) == [], (report.parent.name, width)
    page.close()


@pytest.mark.slow
def test_nobody_is_barred_from_the_documentation(chromium: Browser, tmp_path: Path) -> None:
    page = chromium.new_page()
    build = [sys.executable, "-m", "sphinx", "-q", "-b", "html", str(DOCS), str(tmp_path / "html")]
    subprocess.run(build, check=True, capture_output=True)
    found = {}
    for name in PAGES_OF_DOCS:
        page.goto((tmp_path / "html" / name).as_uri())
        found[name] = barred(page)
    assert {name: each for name, each in found.items() if each} == {}
    page.close()
