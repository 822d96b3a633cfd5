"""A ski is edited with the drawing beside it, saved under a new name, and carved and simulated with."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from skisnow._support.errors import ParameterError
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
