"""Names of fields for screen readers, contrast, and pages that fit a telephone."""

import importlib
import importlib.util
import json
import re
import shutil
import subprocess
import sys
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from skisnow.cli import main
from skisnow.studies import run_study
from skisnow.web.lab_skis import LabSkis
from skisnow.web.pages import PAGES

from ..report.runs import circle_run
from .browser_types import Page
from .conftest import Served, follow, ready, settled
from .replay.test_lab_page import kept
from .test_confined import TURNS
from .test_day import create, enter_series
from .test_kept import imported
from .test_typing import NAMELESS

if importlib.util.find_spec("axe_playwright_python") is None:
    pytest.skip("axe-core is not installed: pip install axe-playwright-python", allow_module_level=True)


DOCS = Path(__file__).parents[2] / "docs"
WIDTHS = (1280, 390)


def barred(page: Page) -> list[str]:
    """Serious or critical findings of axe-core, with the first element that has it."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response["violations"]
    return [f"{each['id']}: {each['nodes'][0]['html']}" for each in found if each["impact"] in ("serious", "critical")]


def barred_in(page: Page, files: list[Path]) -> dict[tuple[str, int], list[str]]:
    """The same of files, on a desk and on a telephone; the page is not wider than either."""
    found = {}
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 844})
        for file in files:
            page.goto(file.as_uri())
            found[f"{file.parent.name}/{file.name}", width] = barred(page)
            assert page.evaluate("document.documentElement.scrollWidth") <= width, (file, width)
    return {name: each for name, each in found.items() if each}


def test_the_checker_finds_known_barriers(file_page: Page) -> None:
    faults = '<img src="data:,"><input><p style="color: #999">grey text</p>'
    file_page.set_content(f'<html lang="en"><title>t</title><main><h1>t</h1>{faults}</main></html>')
    assert {each.split(":")[0] for each in barred(file_page)} == {"image-alt", "label", "color-contrast"}


def test_the_page_for_the_token_has_no_barriers(file_page: Page) -> None:
    token_page = pytest.importorskip("skisnow.web.guard", reason="the web lab is not installed")
    file_page.set_content(token_page.token_page({"type": "http", "headers": []}, 403).body.decode("utf-8"))
    assert barred(file_page) == []


def studied(lab: Path, folder: Path) -> str:
    """Put a study that is done into the lab; its name."""
    studies = importlib.import_module("skisnow.web.studies").Studies(folder)
    job = studies.ask_for(TURNS)
    place = studies.folder / job.name
    run_study(place / "study.toml", workers=1)
    (place / "map.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>', encoding="utf-8")
    (place / "job.json").write_text(json.dumps(asdict(replace(job, state="done"))), encoding="utf-8")
    shutil.copytree(studies.folder, lab / "studies")
    return str(job.name)


@pytest.mark.slow
def test_pages_of_the_lab_have_no_barriers(page: Page, served: Served, tmp_path: Path) -> None:
    imported(page, served)
    follow(page, "Correct")
    page.get_by_role("heading", name="Tests").wait_for()
    correcting = page.url
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
        correcting: "summary",
        f"{correcting}?table=penetration.csv&test=1": ".beside path.points",
        f"{served.address}skis": "td",
        f"{served.address}carve": "td",
        f"{served.address}simulate": "summary",
        f"{served.address}study": ".range",
        f"{served.address}study/{studied(served.lab, tmp_path)}": "tbody td",
        f"{served.address}replay": ".card",
        f"{served.address}replay/show?run=a-run": "canvas",
        f"{served.address}nowhere": "h1",
    }
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 844})
        for place, shown in places.items():
            page.goto(place)
            page.locator(shown).first.wait_for()
            page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
            if not place.endswith(("nowhere", "run=a-run")):
                ready(page)
            settled(page)
            assert barred(page) == [], (place, width)


@pytest.mark.usefixtures("undrawn")
def test_the_report_of_a_run_has_no_barriers(file_page: Page, tmp_path: Path) -> None:
    circle_run().report(tmp_path)
    assert barred_in(file_page, [tmp_path / "report.html"]) == {}


@pytest.mark.slow
def test_reports_of_each_kind_have_no_barriers(file_page: Page, tmp_path: Path) -> None:
    """One of each kind that has a page: campaign, run with its replay, turn, identification."""
    campaign, run, short = str(tmp_path / "campaign"), str(tmp_path / "run"), ["--set", "run.duration_s=0.2"]
    turn = ["--set", "slope.angle_deg=5", "--set", "start.speed_m_per_s=4.5", "--set", "sledge.edge_angle_deg=40"]
    for words in (
        ["reference", campaign, "--seed", "1"],
        ["analyse", campaign, "--out", str(tmp_path / "analysis")],
        ["simulate", "carved-46m", *short, "--out", run, "--replay"],
        ["turn", campaign, "--site", "C", *turn, *short, "--runs", "4", "--out", str(tmp_path / "turn")],
        ["identify", "carved-46m", f"{run}/track.csv", "--free", "mu_0", *short, "--out", str(tmp_path / "identified")],
    ):
        assert main(words) == 0, words
    reports = sorted(tmp_path.glob("*/*.html"))
    assert len(reports) == 5
    assert barred_in(file_page, reports) == {}


def built(folder: Path, html: Path) -> None:
    build = [sys.executable, "-m", "sphinx", "-q", "-b", "html", str(folder), str(html)]
    subprocess.run(build, check=True, capture_output=True)


@pytest.mark.slow
def test_the_documentation_has_no_barriers(file_page: Page, tmp_path: Path) -> None:
    built(DOCS, tmp_path / "html")
    pages = [each for each in sorted((tmp_path / "html").rglob("*.html")) if "_static" not in each.parts]
    assert len(pages) >= len([path for path in DOCS.rglob("*.md") if not {"_build", "_generated"} & set(path.parts)])
    assert barred_in(file_page, pages) == {}


LEAST = 4.5

COLOURS = """() => [...document.querySelectorAll('main *, header *')].filter(element =>
  [...element.childNodes].some(node => node.nodeType === 3 && node.textContent.trim()) && element.offsetParent
  && !element.closest('svg') && !element.closest('.q-icon')).map(element => {
    let behind = element, colour = 'rgba(0, 0, 0, 0)';
    while (behind && /, 0\\)$|transparent/.test(colour)) {
      colour = getComputedStyle(behind).backgroundColor; behind = behind.parentElement; }
    return [element.textContent.trim().slice(0, 40), getComputedStyle(element).color, colour]; })"""


def luminance(colour: str) -> float:
    """Relative luminance of an opaque colour (WCAG 2.2)."""
    red, green, blue = (int(part) / 255 for part in re.findall(r"\d+", colour)[:3])
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (red, green, blue)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(ink: str, paper: str) -> float:
    light, dark = sorted((luminance(ink), luminance(paper)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def test_black_on_white_by_definition() -> None:
    assert contrast("rgb(0, 0, 0)", "rgb(255, 255, 255)") == 21.0


def test_lines_are_reported_apart_by_colour_and_dashes_alone() -> None:
    """Three to one against the page's white is what graphics need (WCAG 2.2, 1.4.11)."""
    chart = pytest.importorskip("skisnow.web.widgets", reason="the web lab is not installed")
    read = [style for style in chart.STYLES if style["read"]]
    assert read == list(chart.STYLES[: chart.BEHIND])
    for name in ("colour", "dash"):
        assert len({style[name] for style in read}) == len(read)
    assert len({(style["width"], style["point"]) for style in read}) == 1
    for style in read:
        red, green, blue = bytes.fromhex(style["colour"].removeprefix("#"))
        assert contrast(f"rgb({red}, {green}, {blue})", "rgb(255, 255, 255)") >= 3.0


READY = {"skis": "td", "carve": "td", "design": "td", "simulate": "summary", "study": ".range", "replay": ".card"}


def test_every_page_of_the_navigation_is_looked_at() -> None:
    """`test_pages_of_the_lab_have_no_barriers` looks at the list of campaigns and its entry pages."""
    assert {*READY, "campaigns"} == set(PAGES)


def opened(page: Page, served: Served, name: str) -> None:
    """A page with something on it, everything that can be opened open."""
    lab = served.lab
    LabSkis(lab).save_texts("a ski with quite a long name of its own", LabSkis(lab).texts("carver")[0], "")
    for run in ("2026-02-01-100000-a-run-with-quite-a-long-name", "other"):
        kept(lab, run)
    page.goto(f"{served.address}{name}")
    page.locator(READY[name]).first.wait_for()
    page.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    settled(page)


@pytest.mark.parametrize("name", READY)
def test_it_fits_every_field_has_a_name_and_all_text_stands_out(page: Page, served: Served, name: str) -> None:
    opened(page, served, name)
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        settled(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        fields = page.locator("input:visible, select:visible, button:visible, textarea:visible")
        assert fields.count() > 1
        assert fields.evaluate_all(NAMELESS) == []
        assert page.locator("svg[role=img]:not([aria-label]), svg[role=img][aria-label='']").count() == 0
        found = page.evaluate(COLOURS)
        assert len(found) > 5
        assert [row for row in found if contrast(row[1], row[2]) < LEAST] == []
