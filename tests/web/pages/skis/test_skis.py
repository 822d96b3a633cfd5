"""Skis: the list and edited files."""

import tomllib
from ast import literal_eval
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from nicegui import ui

from skisnow.ski import read_ski, ski_names
from skisnow.web.lab_skis import LabSkis, check_ski_texts, texts_of_ski
from skisnow.web.page_requests import address
from skisnow.web.uploads import SKI_BOUNDS

from ..desk import Desk, Sheet
from .shared import (
    BOTH,
    CARVER,
    FILE,
    HEAVY,
    SAVE,
    SLALOM,
    TABLE_FIELD,
    TEXT,
    opened,
    saved_place,
    source_words,
)

CARVER_FACTS = [
    "Length", "1.755 m",
    "Running length", "1.540 m",
    "Sidecut, tip – waist – tail", "127 – 74.0 – 111 mm",
    "Sidecut radius", "14.4 m",  # 805²/(2 (119 - 74)/2), in mm
    "EI at the boot", "460 N m²",
    "GJ at the boot", "195 N m²",
    "Mass", "2.25 kg",
]  # fmt: skip


def test_the_page_shows_facts_charts_and_the_editor_of_a_ski(desk: Desk) -> None:
    page = opened(desk)
    lines = page.outline()
    facts = lines[lines.index("carver") + 1 :]
    assert facts[: len(CARVER_FACTS)] == CARVER_FACTS
    page.shows(source_words(CARVER))
    for extent in ("−63.5 to 63.5", "−6.00 to 44.0", "100 to 460", "65.0 to 195"):
        page.shows(f": {extent} (carver)")
    factors = ("Sidecut depth", "Width", "Base height", "EI", "GJ", "Mass")
    assert [page.field(f"{name} ×").value for name in factors] == ["1"] * 6
    assert (page.field(FILE).value, page.field(TABLE_FIELD).value) == (TEXT, "")
    assert page.field("Ski").options == {name: name for name in ski_names()}
    assert list(page.field("Compared with").options) == ["nothing", "the edited ski", *ski_names()]


def sent(values: Any) -> Any:
    """As near as a chart needs it."""
    return pytest.approx(list(values), rel=2e-4, abs=1e-3)


def test_curves_of_the_ski_charts(desk: Desk) -> None:
    page = opened(desk)
    page.fill("Compared with", "slalom")
    page.shows("100 to 460 (carver, slalom)")
    charts = page.charts()
    titles = {"Edge (mm)": "width", "Base (mm)": "base_height", "EI (N m²)": "bending_stiffness"}
    titles |= {"GJ (N m²)": "torsional_stiffness"}
    assert list(charts) == list(titles)
    for title, attribute in titles.items():
        panel = charts[title]
        assert (panel["x"], panel["ends"], panel["range"]) == ("Position (m), boot = 0", ["tail", "tip"], None)
        assert panel["from_zero"] == ("y" if title[:2] in ("EI", "GJ") else "")
        signs = (1, -1) if title == "Edge (mm)" else (1,)
        factor = {"width": 500.0, "base_height": 1000.0}.get(attribute, 1.0)
        wanted = [(ski, style, sign) for style, ski in enumerate((CARVER, SLALOM)) for sign in signs]
        assert len(panel["lines"]) == len(wanted)
        for line, (ski, style, sign) in zip(panel["lines"], wanted, strict=True):
            table = sign * factor * getattr(ski, attribute)
            assert line["style"] == style
            assert line["name"] == (ski.name if sign > 0 else "")
            assert not line["points"]
            assert line["x"] == sent([*ski.station[:-1:2], ski.station[-1]])
            assert line["y"] == sent([*table[:-1:2], table[-1]])


def test_a_ski_that_there_is_not_opens_the_first_one(desk: Desk) -> None:
    page = opened(desk, "/skis?ski=none&added=1")
    assert page.field("Ski").value == "carver"
    assert not any("is added" in line for line in page.outline())


@pytest.mark.parametrize("added", ["", "&added=1"])
def test_a_ski_that_came_in_is_reported(desk: Desk, added: str) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", TEXT, "")
    page = opened(desk, f"/skis?ski=mine{added}", "mine")
    announced = [each for each in page.of(ui.label) if "good" in each.classes and "mine" in each.text]
    assert [each.props["role"] for each in announced] == (["status"] if added else [])
    page.shows("Begun from mine")


def test_a_factor_makes_an_edited_ski(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    page.fill("EI ×", "1,5")
    page.shows("100 to 690 (carver, carver, edited)")
    assert page.field("Compared with").value == "the edited ski"
    lines = page.outline()
    place = lines.index("EI at the boot")
    assert lines[place + 1 : place + 3] == ["460 N m²", "690 N m²"]
    page.shows(f"(EI × 1,5) from: {source_words(CARVER)}")
    page.fill("Mass ×", "2")
    page.shows("4.49 kg")
    page.shows("edited in the lab (EI × 1,5; Mass × 2) from: Atomic")
    page.fill("EI ×", "1")
    page.shows("100 to 460 (carver, carver, edited)")
    page.shows("edited in the lab (Mass × 2) from: Atomic")
    page.fill("Mass ×", "1")
    page.shows("100 to 460 (carver, carver)")
    assert confined_words == []  # earlier texts are not read again


@pytest.mark.parametrize(
    ("field", "text", "code"),
    [
        ("GJ ×", "1x", "not_a_number"),
        ("GJ ×", "-3", "out_of_range"),
        ("EI ×", "", "not_a_number"),
        ("Width ×", "1000", "out_of_range"),
    ],
)
def test_an_invalid_edit_is_neither_saved_nor_downloaded(desk: Desk, field: str, text: str, code: str) -> None:
    page = opened(desk)
    page.fill(field, text)
    why = page.shows("[status bad] ").removeprefix("[status bad] ")
    assert desk.code == code
    page.fill("New name", "never")
    page.press(SAVE)
    page.until(lambda: sum(line.startswith("[status bad] ") and why in line for line in page.outline()) == 2)
    page.press("Download the file")
    page.until(lambda: sum(f"[status bad] {why}" in line for line in page.outline()) == 2)
    assert LabSkis(desk.lab.runs).saved() == []
    assert not any(each.startswith("download") for each in page.scripts)
    page.fill(field, "1")
    page.until(lambda: sum(why in line for line in page.outline()) == 1)
    status = [each for each in page.of(ui.label) if "status" in each.classes]
    assert [("bad" in each.classes, bool(each.text)) for each in status] == [(False, False)] * 2 + [(True, True)]
    page.until(lambda: "carver, carver" in page.charts()["GJ (N m²)"]["label"])


def test_what_a_reader_warns_of_is_shown(desk: Desk) -> None:
    LabSkis(desk.lab.runs).save_texts("heavy", HEAVY, "")
    page = opened(desk, "/skis?ski=heavy", "heavy")
    assert page.shows("mass_kg is 20").startswith("[status good]")
    assert page.shows("mass_kg is 20").count("mass_kg is 20") == 1
    page.fill("Compared with", "the edited ski")
    page.until(lambda: any(line.count("mass_kg is 20") == 2 for line in page.outline()))
    page.fill("Ski", "carver")
    page.fill("Compared with", "nothing")
    page.until(lambda: not any("mass_kg is 20;" in line for line in page.outline() if line.startswith("[status")))


def test_an_edited_ski_is_saved_and_compared(desk: Desk) -> None:
    page = opened(desk)
    page.fill("EI ×", "1.5")
    page.shows("(carver, carver, edited)")
    page.fill("New name", "  my   own ")
    page.press(SAVE)
    page.shows("[status good] Saved: my own. Carve and Simulate have it too.")
    page.shows("100 to 690 (carver, my own)")
    assert page.link(BOTH) == address("/carve", ski="carver", other="my own")
    assert page.field("Compared with").value == "my own"
    names = [*ski_names(), "my own"]
    assert list(page.field("Ski").options) == names
    assert list(page.field("Compared with").options) == ["nothing", "the edited ski", *names]
    ski = read_ski(saved_place(desk, "my own"))
    assert ski.name == "my own"
    assert ski.bending_stiffness == pytest.approx(1.5 * CARVER.bending_stiffness)
    assert saved_place(desk, "my own").with_name("ski.csv").is_file()
    page.press(SAVE)
    page.until(lambda: desk.code == "already_there")
    page.shows("[status bad] ")
    page.fill("New name", "second")
    page.press(SAVE)
    page.shows("[status good] Saved: second.")
    page.until(lambda: page.link(BOTH) == address("/carve", ski="carver", other="second"))


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("", "name_not_allowed"),
        ("carver", "already_there"),
        ("nothing", "name_not_allowed"),
        ("The edited ski", "name_not_allowed"),
    ],
)
def test_a_name_that_cannot_be_is_rejected_with_the_reason(desk: Desk, name: str, code: str) -> None:
    page = opened(desk)
    page.fill("New name", name)
    page.press(SAVE)
    why = page.shows("[status bad] ")
    assert desk.code == code
    page.fill("Name of the ski", name)
    page.press("Add this ski")
    page.until(lambda: page.outline().count(why) == 2)
    assert LabSkis(desk.lab.runs).saved() == []


def downloads(page: Sheet) -> dict[str, str]:
    """Files for the browser, by name."""
    return {each["filename"]: each["src"].decode() for each in page_downloads(page)}


def page_downloads(page: Sheet) -> list[dict[str, Any]]:
    return [literal_eval(each.removeprefix("download ")) for each in page.scripts if each.startswith("download ")]


def test_an_edited_ski_is_downloaded_with_its_table(desk: Desk, tmp_path: Path) -> None:
    page = opened(desk)
    page.fill("GJ ×", "2")
    page.shows("(carver, carver, edited)")
    page.press("Download the file")
    page.until(lambda: len(downloads(page)) == 2)
    for name, text in downloads(page).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    ski = read_ski(tmp_path / "ski.toml")
    assert ski.name == "carver, edited"
    assert ski.torsional_stiffness == pytest.approx(2 * CARVER.torsional_stiffness)
    assert ski.width == pytest.approx(CARVER.width)


def test_a_text_is_drawn_when_it_is_requested(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    page.fill("EI ×", "2")
    page.shows("100 to 920 (carver, carver, edited)")
    longer = TEXT.replace("length_mm = 1755", "length_mm = 1800").replace('name = "carver"', 'name = "longer"')
    page.fill(FILE, longer)
    why = "the file below was changed since it was drawn; press Draw the file first"
    page.fill("New name", "early")
    page.press(SAVE)
    page.shows(f"[status bad] Not saved: {why}")
    page.press("Download the file")
    page.shows(f"[status bad] {why}")
    assert LabSkis(desk.lab.runs).saved() == []
    assert downloads(page) == {}
    page.press("Draw the file")
    page.shows("100 to 460 (carver, longer)")
    assert confined_words == [(SKI_BOUNDS, check_ski_texts, longer, "")]
    lines = page.outline()
    assert lines[lines.index("Length") : lines.index("Running length")] == ["Length", "1.755 m", "1.800 m"]
    assert "field EI × = '1' numeric" in lines
    page.press("Download the file")
    page.told("download")
    assert downloads(page) == {"ski.toml": longer}
    page.press(SAVE)
    page.shows("[status good] Saved: early.")
    kept = tomllib.loads(saved_place(desk, "early").read_text(encoding="utf-8"))
    assert (kept["name"], kept["length_mm"]) == ("early", 1800)
    page.fill(FILE, longer.replace("mass_kg = 2.246", "mass_kg = -1"))
    page.press("Draw the file")
    page.shows("[status bad] ski.toml: mass_kg is -1")
    assert len(confined_words) == 2


def test_a_table_that_was_changed_is_drawn_too(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_texts("mine", *texts_of_ski(replace(CARVER, name="mine")))
    page = opened(desk, "/skis?ski=mine", "mine")
    _, table = skis.texts("mine")
    assert page.field(TABLE_FIELD).value == table
    page.fill(TABLE_FIELD, "station_m\n")
    page.press("Download the file")
    page.shows("[status bad] the file below was changed since it was drawn")
    page.press("Draw the file")
    page.shows("[status bad] ski.csv")
    page.fill(TABLE_FIELD, table)
    page.press("Draw the file")
    page.shows("(mine, mine)")
    page.press("Download the file")
    page.until(lambda: len(downloads(page)) == 2)
    assert downloads(page) == {"ski.toml": skis.texts("mine")[0], "ski.csv": table}
    page.fill("New name", "again")
    page.press(SAVE)
    page.shows("Saved: again.")
    assert skis.texts("again")[1] == table


def test_the_editor_speaks_the_language_of_the_page(desk: Desk) -> None:
    page = desk.open("/skis", "de")
    page.shows("65,0 bis 195 (carver)")
    page.fill("EI ×", "1,5")
    page.shows("100 bis 690 (carver, carver, edited)")
    page.fill("Neuer Name", "meiner")
    page.press("Im Labor speichern")
    page.shows("Saved: meiner.")
    assert list(page.field("Verglichen mit").options.values())[:2] == ["nichts", "der bearbeitete Ski"]
