"""A ski is edited with the drawing beside it, saved under a name of its own, and carved and simulated with."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow._support.errors import OutputError, ParameterError
from skisnow.report.formatting import significant
from skisnow.ski import read_ski, ski_named
from skisnow.web.lab_skis import LabSkis, ski_of_texts
from tests.coded import raises

from .conftest import Served, has_text

if TYPE_CHECKING:
    from playwright.sync_api import Page

CARVER = ski_named("carver")
TEXT = LabSkis(Path("nowhere")).texts("carver")[0]


def boot_stiffness(page: Page, number: int) -> str:
    """EI at the boot as the table of facts has it, of the first or second ski."""
    return page.get_by_role("row", name="EI at the boot").get_by_role("cell").nth(number).inner_text()


def curve(page: Page) -> list[str]:
    """The lines of the chart of bending stiffness."""
    paths: list[str] = (
        page.get_by_role("img", name="EI (N m²) along the ski")
        .locator("path.line")
        .evaluate_all("lines => lines.map(line => line.getAttribute('d'))")
    )
    return paths


def type_into(page: Page, label: str, text: str) -> None:
    page.get_by_label(label, exact=True).fill(text)
    page.keyboard.press("Tab")


@pytest.mark.slow
def test_factors_and_values_at_stations_are_drawn_and_saved(page: Page, served: Served) -> None:
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    assert len(curve(page)) == 1
    type_into(page, "EI ×", "1,5")
    page.get_by_role("columnheader", name="carver, edited").wait_for()
    page.get_by_role("cell", name="690 N m²").wait_for()  # 1.5 times 460, by hand
    assert boot_stiffness(page, 0) == "460 N m²"
    assert len(curve(page)) == 2 and curve(page)[0] != curve(page)[1]
    has_text(page.get_by_label("EI (N m²) at 0.000 m", exact=True), "690")
    type_into(page, "EI (N m²) at 0.000 m", "500")
    page.get_by_role("cell", name="500 N m²").wait_for()
    type_into(page, "Width (mm) at 0.000 m", "70")
    page.get_by_role("cell", name="127 – 70.0 – 111 mm").wait_for()

    page.get_by_label("New name", exact=True).fill("carver")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Not saved: there is a ski carver already").wait_for()
    page.get_by_label("New name", exact=True).fill("soft waist")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Saved: soft waist.").wait_for()
    saved = read_ski(served.store.parent / "lab" / "skis" / "soft waist" / "ski.toml")
    middle = abs(saved.station).argmin()
    assert saved.name == "soft waist" and "EI × 1,5" in saved.source
    assert saved.bending_stiffness[middle] == pytest.approx(500.0, rel=1e-9)
    assert saved.width[middle] == pytest.approx(0.070, rel=1e-9)
    assert saved.bending_stiffness[0] == pytest.approx(1.5 * CARVER.bending_stiffness[0], rel=1e-9)
    assert saved.torsional_stiffness == pytest.approx(CARVER.torsional_stiffness, rel=1e-9)
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Not saved: there is a ski soft waist already").wait_for()

    page.goto(f"{served.address}carve")
    page.get_by_label("Compared with").click()
    page.get_by_role("option", name="soft waist").click()
    page.get_by_role("columnheader", name="soft waist").wait_for()
    told = page.get_by_role("region", name="Carved radius").locator(".value")
    told.nth(1).wait_for()
    assert len({words.split("carved radius")[1] for words in told.all_inner_texts()}) == 2


@pytest.mark.slow
def test_what_cannot_be_is_said_and_nothing_is_saved(page: Page, served: Served) -> None:
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    type_into(page, "GJ (N m²) at 0.000 m", "1x")
    page.get_by_text("GJ (N m²) at 0.000 m: '1x' is no number").wait_for()
    type_into(page, "GJ (N m²) at 0.000 m", "-3")
    page.get_by_text("station 0.000 m: GJ_N_m2 is -3.0; allowed is").wait_for()
    page.get_by_label("New name", exact=True).fill("never")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Not saved: station").wait_for()
    assert LabSkis(served.store.parent / "lab").saved() == []
    type_into(page, "GJ (N m²) at 0.000 m", "")  # emptied: as it was
    page.get_by_role("columnheader", name="carver").nth(1).wait_for()
    given = significant(float(CARVER.torsional_stiffness[abs(CARVER.station).argmin()]))
    has_text(page.get_by_label("GJ (N m²) at 0.000 m", exact=True), given)


@pytest.mark.slow
def test_the_text_is_drawn_and_its_faults_are_said(page: Page, served: Served) -> None:
    page.goto(f"{served.address}skis")
    page.get_by_role("row", name="Mass").wait_for()
    page.locator("summary", has_text="The file of the ski").press("Enter")
    text = page.get_by_label("File of the edited ski")
    given = text.input_value()
    text.fill(given.replace("length_mm = 1755", "length_mm = 1800").replace('name = "carver"', 'name = "longer"'))
    page.get_by_role("button", name="Draw the file").click()
    page.get_by_role("columnheader", name="longer").wait_for()
    page.get_by_role("cell", name="1.800 m").wait_for()
    page.get_by_label("New name", exact=True).fill("longer one")
    page.get_by_role("button", name="Save in the lab").click()
    page.get_by_text("Saved: longer one.").wait_for()
    kept = tomllib.loads((served.store.parent / "lab" / "skis" / "longer one" / "ski.toml").read_text(encoding="utf-8"))
    assert (kept["name"], kept["length_mm"], kept["EI_N_m2"][2]) == ("longer one", 1800, 460)
    text.fill(given.replace("mass_kg = 2.246", "mass_kg = -1"))
    page.get_by_role("button", name="Draw the file").click()
    page.get_by_text("ski.toml: mass_kg is -1").wait_for()


def test_the_editor_on_a_phone(page: Page, served: Served) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(f"{served.address}skis")
    page.get_by_label("EI (N m²) at 0.000 m", exact=True).wait_for()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.parametrize("name", ["", "..", "a/b", "a\\b", ".hidden", "CON", "x" * 41, "Carver", "a ", "a\nb"])
def test_names_that_are_no_folder_everywhere(tmp_path: Path, name: str) -> None:
    with pytest.raises(ParameterError, match="another"):
        LabSkis(tmp_path).save_ski(name, CARVER)
    assert LabSkis(tmp_path).saved() == []
    assert list(tmp_path.rglob("*.toml")) == []


def test_a_ski_is_saved_with_its_table_and_read_by_its_word(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    assert (skis.word("carver"), skis.saved()) == ("carver", [])
    skis.save_ski("Mine 2", replace(CARVER, name="Mine 2"))
    assert skis.saved() == ["Mine 2"]
    assert skis.names()[-1] == "Mine 2"
    back = read_ski(skis.word("Mine 2"))
    assert back.name == "Mine 2"
    assert back.width == pytest.approx(CARVER.width)
    text, table = skis.texts("Mine 2")
    assert 'name = "Mine 2"' in text
    assert table.count("\n") == len(CARVER.station) + 1
    with raises(ParameterError, "already_there", name="MINE 2"):
        skis.save_ski("MINE 2", CARVER)
    with raises(ParameterError, "unknown_ski", name="other"):
        skis.word("other")
    assert [place.name for place in (tmp_path / "skis").iterdir()] == ["Mine 2"]


def test_a_text_names_no_file_of_the_machine(tmp_path: Path) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text("word\n", encoding="utf-8")
    for line in (f'table = "{secret.as_posix()}"', 'table = "../secret.csv"', 'shape = "x.json"'):
        with pytest.raises(ParameterError) as refused:
            ski_of_texts(f"{TEXT}\n{line}\n", "")
        assert "word" not in str(refused.value)


def test_a_saved_name_stands_in_the_file_however_it_is_written(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("first", TEXT, "")
    skis.save_texts("second", TEXT.replace('name = "carver"\n', ""), "")
    assert [read_ski(Path(skis.word(name))).name for name in skis.saved()] == ["first", "second"]
    lines = TEXT.replace('name = "carver"\n', "").replace('source = """', 'source = """\\\nname = inside\n')
    with raises(ParameterError, "no_place_for_name"):
        skis.save_texts("third", f'{lines}name = "carver"\n', "")


def test_no_folder_is_overwritten_by_who_is_slower(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("one", TEXT, "")
    monkeypatch.setattr(LabSkis, "require_new", lambda *_: None)  # both looked before either saved
    with raises(OutputError, "cannot_write"):
        skis.save_texts("one", TEXT.replace("1755", "1760"), "")
    assert "length_mm = 1755" in skis.texts("one")[0]
    assert [place.name for place in (tmp_path / "skis").iterdir()] == ["one"]
