"""German and English: no text of the lab without its German one, and a page that is driven in German."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from .conftest import MISSING, PATIENCE_MS, Served, Watched, fill, has_text, ready

if "nicegui" in MISSING:
    pytest.skip("the web lab is not installed", allow_module_level=True)

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow._support.language import Catalogue, catalogue, languages
from skisnow._support.language.catalogues import DECIMAL, FOLDER, read_catalogue
from skisnow.campaign import QUALITY_FLAGS, Problem, campaign_of_files
from skisnow.campaign.problems import lines_of
from skisnow.campaign.store import Journals, Store
from skisnow.campaign.store.replayed import Description, description_text
from skisnow.carving.result import REMEDIES
from skisnow.report.charts import ski_drawing
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.ski import read_ski
from skisnow.web.pages.simulate import basic, expert
from skisnow.web.scenario_fields import called, range_words
from skisnow.web.study_fields import CARVE, study_keys

from .shown_texts import MADE_OF_KINDS, shown_texts
from .test_day import PLATE, TOOL, VALUES
from .test_entering import CUT

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SKIER = {"skier.steers": "turns"}
"""Values of a scenario that has one: its form has every key."""
GERMAN = Catalogue(read_catalogue(FOLDER / "de.po"))


def untranslated(texts: list[str]) -> list[str]:
    """Those that the catalogue leaves as they are, as lines of a PO file; a few are the same in both languages."""
    same = {"EI", "GJ", "EI ×", "GJ ×", "EI (N m²)", "GJ (N m²)", "{} · skisnow", "Start", "Ski", "1 (elastic)"}
    left = [text for text in texts if text not in same and GERMAN.translated(text) == text]
    return [text for text in left if text not in read_catalogue(FOLDER / "de.po")]


def test_every_text_of_the_lab_has_its_german_one() -> None:
    known, shown = read_catalogue(FOLDER / "de.po"), shown_texts()
    assert len(shown) > 300
    assert [f"{file}: {text}" for text, file in shown.items() if text not in known and text not in MADE_OF_KINDS] == []


def test_what_the_library_says_on_a_page_has_its_german_text() -> None:
    keys = [SCENARIO_KEYS[name] for name in (*basic(SKIER), *expert(SKIER))]
    keys += [SCENARIO_KEYS[name] for name in basic({}) if name not in basic(SKIER)]
    assert [key.name for key in keys if not key.label] == []
    texts = [called(key) for key in keys] + [range_words(key) for key in keys]
    texts += [word for key in keys for word in key.choices]
    studied = study_keys(CARVE).values()
    texts += [called(key) for key in studied] + [range_words(key) for key in studied]
    texts += [flag.sentence for flag in QUALITY_FLAGS.values()]
    texts += [f"carver: {outcome.replace('_', ' ')}, {remedy}." for outcome, remedy in REMEDIES.items() if remedy]
    texts += list(ski_drawing(read_ski("carver")).facts)
    texts += [f"{first} of {kind} 2" for kind, first in (("tool", "Name"), ("plate", "Name"), ("tool", "Shape"))]
    texts += ["Another tool", "Another plate", "Import folder", "Import files or zip"]
    texts += ["3 penetration experiments, 2 used; 1 shear experiment, 1 used."]
    assert untranslated(texts) == []


DESCRIBED = """load_steps_N = [20, 40]
tool = [{ name = "ski", shape = "ski", length_mm = 200, width_mm = 62 }]
plate = [{ name = "plate", length_mm = "100" }]
plaze = 1
"""
HEAD = "experiment,site,tool,edge_angle_deg,load_N,depth_mm"


def test_what_is_wrong_in_files_is_said_with_their_own_names() -> None:
    table = f"{HEAD}\n1,A,ski,30,20,1\n".encode()
    with pytest.raises(FieldDataError) as caught:
        campaign_of_files({"campaign.toml": DESCRIBED.encode(), "penetration.csv": table})
    wrong = (each for each in caught.value.problems if isinstance(each, Problem))
    german = "\n".join(line.text("de") for line in lines_of(wrong))
    assert "Spalte plaze: gefunden 'plaze'; erlaubt: der Schlüssel plate." in german


def test_a_further_language_is_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "it.po").write_text('msgid "English"\nmsgstr "Italiano"\n', encoding="utf-8")
    monkeypatch.setattr("skisnow._support.language.catalogues.FOLDER", tmp_path)
    for each in (languages, catalogue):
        each.cache_clear()
    assert languages() == {"en": "English", "it": "Italiano"}
    languages.cache_clear()
    catalogue.cache_clear()
    (tmp_path / "no.po").write_text('msgid "{} of {}"\nmsgstr "{0}"\n', encoding="utf-8")
    with pytest.raises(ParameterError, match="other places"):
        read_catalogue(tmp_path / "no.po")


def test_a_series_is_entered_in_german(chromium: Browser, served: Served, watched: Watched) -> None:
    with Store.open(served.store) as store:
        id_ = Journals(store).begin(description_text(Description(VALUES | {"name": "Tag"}, [TOOL], [PLATE])))
    context = chromium.new_context(locale="de-DE", viewport={"width": 390, "height": 844})
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    watched.of(page)
    page.goto(f"{served.address}enter/{id_}")
    page.get_by_role("heading", name="Neue Reihe").wait_for()
    assert page.locator("html").get_attribute("lang") == "de"
    fill(page, {"Messort": "A", "Kantwinkel (°)": "95"})
    page.keyboard.press("Enter")
    page.get_by_text("Nicht begonnen:", exact=True).wait_for()
    fault = "Kantwinkel (°): „95“ ist nicht erlaubt. Eine Zahl von 0 bis unter 90 eingeben."
    assert page.locator(".refusals li").all_inner_texts() == [fault]
    ready(page)
    fill(page, {"Kantwinkel (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Tiefe unter 20 N (mm)").and_(page.locator(":focus")).wait_for()
    page.keyboard.type("1,5\n2,o\n")
    page.locator(".reading.refused").get_by_text("„2,o“ ist nicht erlaubt. Eine Zahl ab 0 eingeben.").wait_for()
    page.get_by_text("gespeichert", exact=True).wait_for()
    page.get_by_role("button", name="Rückgängig: eingegeben: 1,5 mm unter 20 N").wait_for()
    english = {text for text in read_catalogue(FOLDER / "de.po") if GERMAN.translated(text) != text and text != DECIMAL}
    assert english.intersection(map(str.strip, page.locator("body").inner_text().splitlines())) == set()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.evaluate(CUT) == []
    depth = page.get_by_label("Tiefe unter 20 N (mm)")
    has_text(depth, "1,5")
    page.reload()
    has_text(depth, "1,5")
    ready(page)
    depth.press("Enter")  # as it is there: no correction
    depth.fill("1,7")
    depth.press("Enter")
    page.get_by_text("20 N: aus 1,5 mm werden 1,7 mm.").wait_for()
    page.get_by_role("link", name="English").click()
    page.get_by_label("Depth under 20 N (mm)").wait_for()  # the same series, with the typed text
    context.close()
    assert watched.errors == []


def test_all_links_of_the_head_stand_in_one_row_of_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.set_extra_http_headers({"Accept-Language": "de"})
    page.goto(served.address)
    page.get_by_role("link", name="Simulieren").wait_for()
    links = page.locator(".lab-head nav")
    assert links.evaluate("each => each.scrollWidth - each.clientWidth") == 0
    assert links.locator("a").last.evaluate("each => each.getBoundingClientRect().right") <= 390
