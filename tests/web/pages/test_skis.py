"""*Skis*: what stands on it, what its editor makes of a ski, and by which ways a ski comes into the lab."""

from __future__ import annotations

import asyncio
import io
import json
import threading
import tomllib
import warnings
from ast import literal_eval
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from nicegui import ui

from skisnow.errors import OutputError, ParameterError, RangeWarning, SkisnowError
from skisnow.ski import read_ski, ski_named, ski_names
from skisnow.ski.editing import SkiEdit, edit_stations, edited_ski
from skisnow.web import measured_ski
from skisnow.web.confined import OF_A_SKI
from skisnow.web.fields import FIRST
from skisnow.web.lab_skis import LabSkis, _without, check_ski_texts, ski_of_texts, texts_of_ski
from skisnow.web.measured_ski import SkiTexts, add_ski, measured_text, read_ski_files, ski_of_uploads
from skisnow.web.pages import skis as skis_page
from skisnow.web.settings import Limits
from skisnow.web.ski_asked import CELLS, FACTORS, SkiAsked, ski_found

if TYPE_CHECKING:
    from skisnow.ski import Ski

    from .desk import Desk, Sheet

CARVER, SLALOM = ski_named("carver"), ski_named("slalom")
TEXT = LabSkis(Path("nowhere")).texts("carver")[0]
COLUMNS = {
    "width_mm": ("width", 1e-3),
    "base_height_mm": ("base_height", 1e-3),
    "EI_N_m2": ("bending_stiffness", 1.0),
    "GJ_N_m2": ("torsional_stiffness", 1.0),
}
CALLED = ("Width (mm)", "Base height (mm)", "EI (N m²)", "GJ (N m²)")
TYPED = {
    "length_mm": "1593", "running_length_mm": "1396", "sidecut_length_mm": "1458", "tip_width_mm": "116",
    "waist_width_mm": "68", "tail_width_mm": "101", "mass_kg": "2,231", "camber_mm": "7",
    "EI_N_m2": "100 250; 440, 260,5 100", "GJ_N_m2": "60 140 175 140 60",
}  # fmt: skip
TABLE = "station_m;width_mm;EI_N_m2\n0,845;25;100\n0,729;116;100\n0;68;440\n-0,729;101;100\n-0,749;101;100\n"
WITH_TABLE = """name = "my slalom"
running_length_mm = 1396
sidecut_length_mm = 1458
mass_kg = 2.231
GJ_N_m2 = [60, 140, 175, 140, 60]
table = "rows.csv"
"""
DESIGN = {
    "board": {
        "name": "Board", "nose length": "15 cm", "effective edge length": "130 cm", "tail length": "10 cm",
        "sidecut radius": "13 m", "waist width": "9.3 cm", "taper": "0 cm", "stance setback": "0 cm",
        "nose width": "12 cm",
        "edge shape": {"type": "Basic Arc"},
    }
}  # fmt: skip
HEAVY = TEXT.replace("mass_kg = 2.246", "mass_kg = 20")
"""Beyond what is usual: it is warned of."""


@pytest.fixture(autouse=True)
def confined_words(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """What would be read in a process of its own is read here; gives with what it was called."""
    heard: list[tuple[object, ...]] = []

    def here(bounds: object, work: Callable[..., object], *args: object) -> object:
        assert bounds is OF_A_SKI
        heard.append((work, *args))
        return work(*args)

    for name in ("pages.skis", "ski_adding", "measured_ski"):
        monkeypatch.setattr(f"skisnow.web.{name}.confined", here)
    return heard


def saved_place(desk: Desk, name: str) -> Path:
    return desk.lab.runs / "skis" / name / "ski.toml"


def opened(desk: Desk, path: str = "/skis", name: str = "carver") -> Sheet:
    """The page, when the ski is drawn."""
    page = desk.open(path)
    page.shows(f" ({name})")
    return page


def between(lines: list[str], first: str, last: str) -> list[str]:
    """Lines from the one that begins so to the one that begins so."""
    start = next(i for i, line in enumerate(lines) if line.startswith(first))
    stop = next(i for i, line in enumerate(lines[start:], start) if line.startswith(last))
    return lines[start : stop + 1]


def cells_of(ski: Ski) -> list[str]:
    """What the editor's table shows of a ski, line by line."""
    lines = ["Position (m)", *CALLED]
    for station in edit_stations(ski):
        lines.append(f"{station:.3f}".replace("-", "−"))
        for words, (attribute, factor) in zip(CALLED, COLUMNS.values(), strict=True):
            value = float(np.interp(-station, -ski.station, getattr(ski, attribute))) / factor
            text = f"{round(value, 6):.4g}".replace("-0", "-0" if round(value, 6) else "0")
            lines.append(f"field {words} at {station:.3f} m = {text!r} numeric")
    return lines


def source_words(ski: Ski) -> str:
    return " ".join(ski.source.split())


CARVER_FACTS = [
    "Length", "1.755 m",
    "Running length", "1.540 m",
    "Sidecut, tip – waist – tail", "127 – 74.0 – 111 mm",
    "Sidecut radius", "14.4 m",  # 805²/(2 (119 - 74)/2), in mm
    "EI at the boot", "460 N m²",
    "GJ at the boot", "195 N m²",
    "Mass", "2.25 kg",
]  # fmt: skip
SLALOM_FACTS = ["1.593 m", "1.396 m", "116 – 68.0 – 101 mm", "13.1 m", "440 N m²", "175 N m²", "2.23 kg"]


def test_what_stands_on_the_page(desk: Desk) -> None:
    page = opened(desk)
    lines = page.outline()
    assert lines[: lines.index("carver")] == [
        "h1 Skis",
        "Add a measured ski",
        "h3 From its files",
        "[quiet] The .toml file of a ski and the table that it names; or the ski-def.json of MonkeyCAM, which knows "
        "neither mass nor stiffness: type those beside it.",
        "Files of the ski",
        "Another name for it",
        "With a file of MonkeyCAM",
        "Mass of one ski (kg)",
        "Camber (mm)",
        "EI (N m²) from tip to tail",
        "GJ (N m²) from tip to tail",
        "Add the files",
        "h3 From three widths",
        "[quiet] Widths at the widest places in front and behind and at the waist between them; stiffnesses evenly "
        "spaced over the running length, with blanks between, or one for all of it.",
        "field Name of the ski = ''",
        "field Length (mm) = '' numeric",
        "field Running length (mm) = '' numeric",
        "field Sidecut length (mm) = '' numeric",
        "field Width at the tip (mm) = '' numeric",
        "field Width at the waist (mm) = '' numeric",
        "field Width at the tail (mm) = '' numeric",
        "field Mass of one ski (kg) = '' numeric",
        "field Camber (mm) = '' numeric optional",
        "field EI (N m²) from tip to tail = ''",
        "field GJ (N m²) from tip to tail = ''",
        "button[main] Add this ski",
        "field Ski = 'carver'",
        "field Compared with = 'nothing'",
    ]
    assert lines[lines.index("carver") :] == [
        "carver",
        *CARVER_FACTS,
        f"[quiet] carver: {source_words(CARVER)}",
        "chart Edge (mm) along the ski: −63.5 to 63.5 (carver)",
        "chart Base (mm) along the ski: −6.00 to 44.0 (carver)",
        "chart EI (N m²) along the ski: 100 to 460 (carver)",
        "chart GJ (N m²) along the ski: 65.0 to 195 (carver)",
        "h2 Edit a ski",
        "[quiet] Begun from carver. Nothing is saved until you give it a name of its own.",
        "h3 Whole curves",
        "field Sidecut depth × = '1' numeric",
        "field Width × = '1' numeric",
        "field Base height × = '1' numeric",
        "field EI × = '1' numeric",
        "field GJ × = '1' numeric",
        "field Mass × = '1' numeric",
        "h3 At positions along the ski",
        "[quiet] What is typed here holds; between its neighbours the curve goes through it smoothly.",
        *cells_of(CARVER),
        "The file of the ski",
        "[quiet] With units in its keys. Draw the file takes it as it is written here; factors and values at positions "
        "start again from it.",
        f"field File of the edited ski = {TEXT!r}",
        "Its table, where it has one",
        "field Table of the edited ski = ''",
        "button[main] Draw the file",
        "button Begin again from the ski above",
        "h3 Save it",
        "field New name = ''",
        "button[main] Save in the lab",
        "button Download the file",
    ]
    assert page.field("Ski").options == {name: name for name in ski_names()}
    assert list(page.field("Compared with").options) == ["nothing", "the edited ski", *ski_names()]


def test_what_a_browser_gets_of_the_form_of_files(desk: Desk) -> None:
    page = opened(desk)
    (form,) = (each for each in page.of() if each.tag == "form")
    assert form.props["method"] == "post"
    assert form.props["action"] == "/skis/add"
    assert form.props["enctype"] == "multipart/form-data"
    inputs = {each.props["name"]: each for each in page.of() if each.tag == "input"}
    labels = [each.props["for"] for each in page.of() if each.tag == "label"]
    assert list(inputs) == ["files", "name", "mass_kg", "camber_mm", "EI_N_m2", "GJ_N_m2"]
    assert [each.props["id"] for each in inputs.values()] == labels == [f"ski-{name}" for name in inputs]
    files = inputs.pop("files")
    assert files.props["type"] == "file" and files.props["accept"] == ".toml,.csv,.json"
    assert files.props["multiple"] and files.props["required"]
    assert files.classes == []
    assert all(each.classes == ["act", "plain"] for each in inputs.values())
    numeric = [name for name, each in inputs.items() if each.props.get("inputmode") == "decimal"]
    assert numeric == ["mass_kg", "camber_mm"]
    (button,) = (each for each in page.of() if each.tag == "button")
    assert button.props["type"] == "submit" and button.classes == ["act"]


def test_parts_of_the_page_have_names_and_roles(desk: Desk) -> None:
    page = opened(desk)
    sections = [each.props["aria-label"] for each in page.of() if each.tag == "section"]
    assert sections == ["Drawing", "Editor"]
    heads = [each.props["scope"] for each in page.of() if each.tag == "th"]
    assert heads == ["col"] + ["row"] * 7 + ["col"] * 5 + ["row"] * 9
    status = [each for each in page.of(ui.label) if "status" in each.classes]
    assert [each.props["role"] for each in status] == ["status"] * 3
    folded = [each for each in page.of() if each.tag == "details"]
    assert len(folded) == len([each for each in page.of() if each.tag == "summary"]) == 4


def test_what_saves_does_it_once_where_it_is_pressed_twice(desk: Desk) -> None:
    page = opened(desk)
    handlers = {
        each.text: [one.js_handler for one in each._event_listeners.values() if one.type == "click"]
        for each in page.of(ui.button)
    }
    assert handlers == {
        "Add this ski": [FIRST],
        "Draw the file": [None],
        "Begin again from the ski above": [None],
        "Save in the lab": [FIRST],
        "Download the file": [None],
    }


def sent(values: Any) -> Any:
    """As near as a chart needs it."""
    return pytest.approx(list(values), rel=2e-4, abs=1e-3)


def test_what_the_charts_show(desk: Desk) -> None:
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


def test_two_skis_stand_beside_each_other(desk: Desk) -> None:
    page = opened(desk, "/skis?ski=slalom", "slalom")
    assert page.field("Ski").value == "slalom"
    assert "[quiet] Begun from slalom. Nothing is saved until you give it a name of its own." in page.outline()
    page.fill("Compared with", "carver")
    page.shows("(slalom, carver)")
    lines = page.outline()
    facts = lines[lines.index("slalom") : next(i for i, line in enumerate(lines) if line.startswith("chart"))]
    rows = zip(CARVER_FACTS[::2], SLALOM_FACTS, CARVER_FACTS[1::2], strict=True)
    sources = [f"[quiet] {ski.name}: {source_words(ski)}" for ski in (SLALOM, CARVER)]
    assert facts == ["slalom", "carver", *(each for row in rows for each in row), *sources]
    colours = [each.style["color"] for each in page.of() if each.tag in ("td", "th") and "color" in each.style]
    assert colours == ["#0b4f8a", "#b3450b"] * 8
    page.fill("Compared with", "nothing")
    page.shows("100 to 440 (slalom)")
    assert "carver" not in page.outline()
    page.fill("Ski", "carver")
    page.shows("100 to 460 (carver)")


def test_a_ski_that_there_is_not_opens_the_first_one(desk: Desk) -> None:
    page = opened(desk, "/skis?ski=none&added=1")
    assert page.field("Ski").value == "carver"
    assert not any("is added" in line for line in page.outline())


@pytest.mark.parametrize("added", ["", "&added=1"])
def test_a_ski_that_came_in_is_told(desk: Desk, added: str) -> None:
    LabSkis(desk.lab.runs).save_texts("mine", TEXT, "")
    page = opened(desk, f"/skis?ski=mine{added}", "mine")
    told = "[good] The ski mine is added. Carve and Simulate have it too; below it can be changed."
    assert (told in page.outline()) is bool(added)
    assert "Begun from mine." in page.shows("Begun from")
    if added:
        (said,) = (each for each in page.of(ui.label) if "is added" in each.text)
        assert said.props["role"] == "status"
        assert page.outline().index(told) == page.outline().index("field Ski = 'mine'") - 1


def test_a_ski_of_the_catalogue_was_not_added(desk: Desk) -> None:
    page = opened(desk, "/skis?ski=slalom&added=1", "slalom")
    assert not any("is added" in line for line in page.outline())


def test_a_factor_makes_an_edited_ski(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    page.fill("EI ×", "1,5")
    page.shows("100 to 690 (carver, carver, edited)")
    assert page.field("Compared with").value == "the edited ski"
    lines = page.outline()
    place = lines.index("EI at the boot")
    assert lines[place : place + 3] == ["EI at the boot", "460 N m²", "690 N m²"]
    told = f"[quiet] carver, edited: edited in the lab (EI × 1,5) from: {source_words(CARVER)}"
    assert told in lines
    edited = edited_ski(CARVER, SkiEdit(edit_stations(CARVER), {"EI_N_m2": 1.5}), name="carver", source="x")
    assert between(lines, "Position (m)", "field GJ (N m²) at -0.825") == cells_of(edited)
    page.fill("Mass ×", "2")
    page.shows("4.49 kg")
    page.shows("edited in the lab (EI × 1,5; Mass × 2) from: Atomic")
    page.fill("EI ×", "1")
    page.shows("100 to 460 (carver, carver, edited)")
    page.shows("edited in the lab (Mass × 2) from: Atomic")
    page.fill("Mass ×", "1")
    page.shows("100 to 460 (carver, carver)")
    assert confined_words == []  # what was read before is not read again apart


def test_values_at_positions_are_drawn_and_taken_back(desk: Desk) -> None:
    page = opened(desk)
    page.fill("Width (mm) at 0.000 m", " 70 ")
    page.shows("127 – 70.0 – 111 mm")
    assert page.field("Width (mm) at 0.000 m").value == "70"
    page.shows("edited in the lab (Width (mm) 70 at 0.000 m) from: Atomic")
    page.fill("GJ (N m²) at -0.268 m", "200")
    page.shows("(Width (mm) 70 at 0.000 m; GJ (N m²) 200 at -0.268 m) from")
    lines = page.outline()
    assert "field GJ (N m²) at -0.268 m = '200' numeric" in lines
    assert "field GJ (N m²) at 0.000 m = '195' numeric" in lines  # a neighbour stays
    page.fill("Width (mm) at 0.000 m", " ")
    page.shows("(GJ (N m²) 200 at -0.268 m) from")
    page.shows("field Width (mm) at 0.000 m = '74' numeric")
    page.fill("GJ (N m²) at -0.268 m", "")
    page.shows("65.0 to 195 (carver, carver)")


def test_an_emptied_cell_shows_what_it_was(desk: Desk) -> None:
    page = opened(desk)
    page.fill("EI (N m²) at 0.000 m", "500")
    page.shows("100 to 500 (carver, carver, edited)")
    page.fill("EI (N m²) at 0.000 m", "")
    page.shows("field EI (N m²) at 0.000 m = '460' numeric")
    page.shows("100 to 460 (carver, carver)")


def test_what_is_just_being_typed_stays(desk: Desk) -> None:
    page = opened(desk)
    half = page.field("EI (N m²) at 0.000 m")
    desk.do(lambda: half.set_value("50"), page.client)  # its end was not typed yet
    page.fill("EI ×", "2")
    page.shows("100 to 920 (carver, carver, edited)")
    assert "field EI (N m²) at 0.000 m = '50' numeric" in page.outline()
    assert "field EI (N m²) at -0.825 m = '200' numeric" in page.outline()


@pytest.mark.parametrize(
    ("field", "text", "why"),
    [
        ("GJ (N m²) at 0.000 m", "1x", "GJ (N m²) at 0.000 m: '1x' is no number. Correct it"),
        ("GJ (N m²) at -0.268 m", "-3", "station -0.268 m: GJ_N_m2 is -3.0; allowed is"),
        ("EI ×", "", "the factor of EI: '' is no number. Correct it"),
        ("Width ×", "1000", "the factor of width_mm is 1000; allowed is 0.01 to 100. Correct it"),
    ],
)
def test_what_cannot_be_is_said_and_neither_saved_nor_given(desk: Desk, field: str, text: str, why: str) -> None:
    page = opened(desk)
    page.fill(field, text)
    assert page.shows(f"[status bad] {why}")
    page.fill("New name", "never")
    page.press("Save in the lab")
    page.shows(f"[status bad] Not saved: {why}")
    page.press("Download the file")
    page.until(lambda: sum(f"[status bad] {why}" in line for line in page.outline()) == 2)
    assert LabSkis(desk.lab.runs).saved() == []
    assert not any(each.startswith("download") for each in page.scripts)
    page.fill(field, "1" if "×" in field else "195")
    page.until(lambda: sum(why in line for line in page.outline()) == 1)
    status = [each for each in page.of(ui.label) if "status" in each.classes]
    assert [("bad" in each.classes, bool(each.text)) for each in status] == [(False, False)] * 2 + [(True, True)]
    page.until(lambda: "carver, carver" in page.charts()["GJ (N m²)"]["label"])


def test_what_a_reader_warns_of_is_shown(desk: Desk) -> None:
    LabSkis(desk.lab.runs).save_texts("heavy", HEAVY, "")
    page = opened(desk, "/skis?ski=heavy", "heavy")
    assert page.shows("mass_kg is 20").startswith("[status good] ski.toml: mass_kg is 20")
    assert page.shows("mass_kg is 20").count("mass_kg is 20") == 1
    page.fill("Compared with", "the edited ski")
    page.until(lambda: any(line.count("mass_kg is 20") == 2 for line in page.outline()))
    page.fill("Ski", "carver")
    page.fill("Compared with", "nothing")
    page.until(lambda: not any("mass_kg is 20;" in line for line in page.outline() if line.startswith("[status")))


def skis_of(page: Sheet) -> Any:
    """What draws a page."""
    return next(each.__self__ for each in page.field("Ski")._change_handlers if hasattr(each, "__self__"))


@pytest.mark.parametrize("fails", [False, True])
def test_an_answer_to_an_older_question_is_dropped(desk: Desk, monkeypatch: pytest.MonkeyPatch, *, fails: bool) -> None:
    page = opened(desk)
    asked, answered = threading.Event(), threading.Event()
    drawn = skis_of(page)
    find = drawn._found

    def held(words: list[str], what: SkiAsked) -> object:
        if words == ["carver"]:
            asked.set()
            assert answered.wait(60)
            if fails:
                raise ParameterError("too late")
        return find(words, what)

    monkeypatch.setattr(drawn, "_found", held)

    async def begun() -> asyncio.Task[None]:
        with page.client:
            return asyncio.create_task(drawn.draw())

    async def ended(task: asyncio.Task[None]) -> None:
        await task

    older = desk.wait(begun())
    assert asked.wait(60)
    page.fill("Ski", "slalom")
    page.shows("60.0 to 175 (slalom)")
    answered.set()
    desk.wait(ended(older))
    lines = page.outline()
    assert "chart GJ (N m²) along the ski: 60.0 to 175 (slalom)" in lines
    assert "carver" not in lines
    assert not any("too late" in line for line in lines)


def test_an_edited_ski_is_saved_and_compared(desk: Desk) -> None:
    page = opened(desk)
    page.fill("EI ×", "1.5")
    page.shows("(carver, carver, edited)")
    page.fill("New name", "  my   own ")
    page.press("Save in the lab")
    page.shows("[status good] Saved: my own. Carve and Simulate have it too.")
    page.shows("100 to 690 (carver, my own)")
    assert page.outline()[-1] == "link[main] Carve both side by side -> /carve?ski=carver&other=my%20own"
    assert page.field("Compared with").value == "my own"
    names = [*ski_names(), "my own"]
    assert list(page.field("Ski").options) == names
    assert list(page.field("Compared with").options) == ["nothing", "the edited ski", *names]
    ski = read_ski(saved_place(desk, "my own"))
    assert ski.name == "my own"
    assert ski.bending_stiffness == pytest.approx(1.5 * CARVER.bending_stiffness)
    assert saved_place(desk, "my own").with_name("ski.csv").is_file()
    page.press("Save in the lab")
    page.shows("[status bad] Not saved: there is a ski my own already, and none is overwritten; give this one another")
    page.fill("New name", "second")
    page.press("Save in the lab")
    page.shows("[status good] Saved: second.")
    page.until(lambda: page.outline()[-1] == "link[main] Carve both side by side -> /carve?ski=carver&other=second")
    assert sum("Carve both" in line for line in page.outline()) == 1


def test_a_ski_without_changes_is_saved_as_its_file_is_written(desk: Desk) -> None:
    page = opened(desk)
    page.fill("New name", "same")
    page.press("Save in the lab")
    page.shows("[status good] Saved: same.")
    assert saved_place(desk, "same").read_text(encoding="utf-8") == TEXT.replace('name = "carver"', 'name = "same"')
    assert not saved_place(desk, "same").with_name("ski.csv").exists()


@pytest.mark.parametrize("name", ["", "carver", "nothing", "The edited ski"])
def test_a_name_that_cannot_be_is_refused_with_the_reason(desk: Desk, name: str) -> None:
    why = {
        "": "a ski's name has 1 to 40 letters, digits, blanks, - and _; give it another one",
        "carver": "there is a ski carver already, and none is overwritten; give this one another name",
    }.get(name, f"{name} stands for something else in the lists of skis; give this one another name")
    page = opened(desk)
    page.fill("New name", name)
    page.press("Save in the lab")
    page.shows(f"[status bad] Not saved: {why}")
    page.fill("Name of the ski", name)
    page.press("Add this ski")
    page.until(lambda: page.outline().count(f"[status bad] Not saved: {why}") == 2)
    assert LabSkis(desk.lab.runs).saved() == []


def downloads(page: Sheet) -> dict[str, str]:
    """What the page gave the browser, by the name of the file."""
    return {each["filename"]: each["src"].decode() for each in page_downloads(page)}


def page_downloads(page: Sheet) -> list[dict[str, Any]]:
    return [literal_eval(each.removeprefix("download ")) for each in page.scripts if each.startswith("download ")]


def test_the_file_is_downloaded_as_it_is_written(desk: Desk) -> None:
    page = opened(desk)
    page.press("Download the file")
    page.told("download")
    assert downloads(page) == {"ski.toml": TEXT}


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


def test_a_text_is_drawn_when_it_is_asked_for(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    page.fill("EI ×", "2")
    page.fill("Width (mm) at 0.000 m", "80")
    page.shows("127 – 80.0 – 111 mm")
    longer = TEXT.replace("length_mm = 1755", "length_mm = 1800").replace('name = "carver"', 'name = "longer"')
    page.fill("File of the edited ski", longer)
    why = "the file below was changed since it was drawn; press Draw the file first"
    page.fill("New name", "early")
    page.press("Save in the lab")
    page.shows(f"[status bad] Not saved: {why}")
    page.press("Download the file")
    page.shows(f"[status bad] {why}")
    assert LabSkis(desk.lab.runs).saved() == []
    assert downloads(page) == {}
    page.press("Draw the file")
    page.shows("100 to 460 (carver, longer)")
    assert confined_words == [(check_ski_texts, longer, "")]
    lines = page.outline()
    assert lines[lines.index("Length") : lines.index("Running length")] == ["Length", "1.755 m", "1.800 m"]
    assert "field EI × = '1' numeric" in lines
    ski, _ = ski_of_texts(longer, "")
    assert between(lines, "Position (m)", "field GJ (N m²) at -0.8") == between(
        cells_of(ski), "Position (m)", "field GJ (N m²) at -0.8"
    )
    page.press("Download the file")
    page.told("download")
    assert downloads(page) == {"ski.toml": longer}
    page.press("Save in the lab")
    page.shows("[status good] Saved: early.")
    kept = tomllib.loads(saved_place(desk, "early").read_text(encoding="utf-8"))
    assert (kept["name"], kept["length_mm"]) == ("early", 1800)
    page.fill("File of the edited ski", longer.replace("mass_kg = 2.246", "mass_kg = -1"))
    page.press("Draw the file")
    page.shows("[status bad] ski.toml: mass_kg is -1")
    assert len(confined_words) == 2


def test_a_table_that_was_changed_is_drawn_too(desk: Desk) -> None:
    skis = LabSkis(desk.lab.runs)
    skis.save_ski("mine", replace(CARVER, name="mine"))
    page = opened(desk, "/skis?ski=mine", "mine")
    _, table = skis.texts("mine")
    assert page.field("Table of the edited ski").value == table
    page.fill("Table of the edited ski", "station_m\n")
    page.press("Download the file")
    page.shows("[status bad] the file below was changed since it was drawn")
    page.press("Draw the file")
    page.shows("[status bad] ski.csv")
    page.fill("Table of the edited ski", table)
    page.press("Draw the file")
    page.shows("(mine, mine)")
    page.press("Download the file")
    page.until(lambda: len(downloads(page)) == 2)
    assert downloads(page) == {"ski.toml": skis.texts("mine")[0], "ski.csv": table}
    page.fill("New name", "again")
    page.press("Save in the lab")
    page.shows("Saved: again.")
    assert skis.texts("again")[1] == table


def test_it_is_begun_again_from_the_ski_above(desk: Desk) -> None:
    page = opened(desk)
    page.fill("EI ×", "2")
    page.fill("Width (mm) at 0.000 m", "80")
    page.shows("127 – 80.0 – 111 mm")
    page.fill("Ski", "slalom")
    page.shows("(slalom, carver, edited)")
    page.press("Begin again from the ski above")
    page.shows("(slalom, slalom)")
    page.shows("field Width (mm) at 0.000 m = '68' numeric")
    lines = page.outline()
    assert "[quiet] Begun from slalom. Nothing is saved until you give it a name of its own." in lines
    assert "field EI × = '1' numeric" in lines
    assert between(lines, "Position (m)", "field GJ (N m²) at -0.749") == cells_of(SLALOM)
    assert page.field("File of the edited ski").value == LabSkis(desk.lab.runs).texts("slalom")[0]
    page.press("Download the file")
    page.told("download")


def test_it_is_begun_again_without_a_table_left_over(desk: Desk) -> None:
    LabSkis(desk.lab.runs).save_ski("mine", replace(CARVER, name="mine"))
    page = opened(desk, "/skis?ski=mine", "mine")
    page.fill("Ski", "carver")
    page.press("Begin again from the ski above")
    page.shows("(carver, carver)")
    assert page.field("Table of the edited ski").value == ""


def test_cells_are_written_as_in_the_language_of_the_page(desk: Desk) -> None:
    page = desk.open("/skis", "de")
    page.shows("65,0 bis 195 (carver)")
    assert page.field("Breite (mm) bei 0,537 m").value == "99,33"
    page.fill("EI ×", "1,5")
    page.shows("100 bis 690 (carver, carver, bearbeitet)")
    page.shows("field EI (N m²) bei 0,268 m = '529,7' numeric")
    page.fill("Neuer Name", "meiner")
    page.press("Im Labor speichern")
    page.shows("Saved: meiner.")
    assert list(page.field("Verglichen mit").options.values())[:2] == ["nichts", "der bearbeitete Ski"]


# A measured ski


def type_ski(page: Sheet, name: str, typed: Mapping[str, str]) -> None:
    page.fill("Name of the ski", name)
    for key, text in typed.items():
        page.fill(measured_ski.MEASURED[key], text)


def test_three_widths_become_a_ski_of_the_lab(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    page = opened(desk)
    type_ski(page, "  my  ski ", {**TYPED, "camber_mm": ""})
    page.press("Add this ski")
    page.told("/skis?ski=my%20ski&added=1")
    text = saved_place(desk, "my ski").read_text(encoding="utf-8")
    assert text.splitlines() == [
        'name = "my ski"',
        'source = "measured, entered in the lab"',
        "length_mm = 1593.0",
        "running_length_mm = 1396.0",
        "sidecut_length_mm = 1458.0",
        "tip_width_mm = 116.0",
        "waist_width_mm = 68.0",
        "tail_width_mm = 101.0",
        "mass_kg = 2.231",
        "EI_N_m2 = [100.0, 250.0, 440.0, 260.5, 100.0]",
        "GJ_N_m2 = [60.0, 140.0, 175.0, 140.0, 60.0]",
    ]
    assert confined_words == [(check_ski_texts, text, "")]
    assert not any("Not saved" in line for line in page.outline())


def test_a_field_that_is_missing_is_marked_until_it_is_typed(desk: Desk) -> None:
    page = opened(desk)
    type_ski(page, "mine", {**TYPED, "mass_kg": ""})
    page.press("Add this ski")
    page.shows("[status bad] Not saved: Mass of one ski (kg)")
    assert "field Mass of one ski (kg) = '' numeric ! a number is needed here" in page.outline()
    assert sum("!" in line for line in page.outline() if line.startswith("field") and "File" not in line) == 1
    page.told(f'runMethod({page.field("Mass of one ski (kg)").id}, "select"')
    page.fill("Mass of one ski (kg)", "2")
    page.fill("Width at the tip (mm)", "1x")
    page.press("Add this ski")
    page.shows("field Width at the tip (mm) = '1x' numeric ! a number is needed here")
    page.shows("[status bad] Not saved: Width at the tip (mm)")
    assert "field Mass of one ski (kg) = '2' numeric" in page.outline()
    page.fill("Width at the tip (mm)", "40")
    page.press("Add this ski")
    page.shows("[status bad] Not saved: ski.toml: waist_width_mm")
    assert not any("needed here" in line for line in page.outline())
    page.fill("Width at the tip (mm)", "116")
    page.press("Add this ski")
    page.told("/skis?ski=mine&added=1")
    assert not any("Not saved" in line for line in page.outline())


def test_an_empty_list_is_no_number_and_an_empty_camber_is_none() -> None:
    with pytest.raises(ParameterError, match=r"^GJ \(N m²\) from tip to tail: '' is no number"):
        measured_text("mine", {**TYPED, "GJ_N_m2": " "})
    with pytest.raises(ParameterError, match=r"^Mass of one ski \(kg\): '' is no number"):
        measured_text("mine", {**TYPED, "mass_kg": " "})
    assert "camber" not in measured_text("mine", {**TYPED, "camber_mm": " "})
    assert "camber_mm = 7.0\n" in measured_text('Mö"', TYPED)
    assert measured_text('Mö"', TYPED).startswith('name = "Mö\\""\n')


def files(**texts: str) -> list[tuple[str, tuple[str, bytes]]]:
    return [("files", (name.replace("_", "."), text.encode())) for name, text in texts.items()]


def test_files_are_taken_in_from_the_form(desk: Desk, confined_words: list[tuple[object, ...]]) -> None:
    answer = desk.post("/skis/add", files=files(mine_toml=WITH_TABLE, rows_csv=TABLE), data={"name": ""})
    assert (answer.status_code, answer.headers["location"]) == (303, "/skis?ski=my%20slalom&added=1")
    ((work, _, names, further),) = confined_words
    assert (work, names) == (read_ski_files, ["mine.toml", "rows.csv"])
    assert further == dict.fromkeys(("mass_kg", "camber_mm", "EI_N_m2", "GJ_N_m2"), "")
    assert read_ski(saved_place(desk, "my slalom")).name == "my slalom"
    answer = desk.post("/skis/add", files=files(mine_toml=TEXT), data={"name": " Ski  A/1 "})
    assert answer.status_code == 400
    answer = desk.post("/skis/add", files=files(mine_toml=TEXT), data={"name": " Ski  Ä "})
    assert answer.headers["location"] == "/skis?ski=Ski%20%C3%84&added=1"
    assert LabSkis(desk.lab.runs).saved() == ["my slalom", "Ski Ä"]


def test_a_design_is_taken_in_with_what_was_typed_beside_it(desk: Desk) -> None:
    typed = {key: TYPED[key] for key in ("mass_kg", "camber_mm", "EI_N_m2", "GJ_N_m2")}
    answer = desk.post("/skis/add", files=files(design_JSON=json.dumps(DESIGN)), data={**typed, "name": "board 1"})
    assert answer.headers["location"] == "/skis?ski=board%201&added=1"
    ski = read_ski(saved_place(desk, "board 1"))
    assert ski.mass == pytest.approx(2.231)
    assert float(ski.bending_stiffness.max()) == pytest.approx(440.0, rel=1e-3)
    assert float(ski.torsional_stiffness.max()) == pytest.approx(175.0, rel=1e-3)
    middle = abs(ski.station).argmin()
    assert float(ski.width[middle]) == pytest.approx(0.093, abs=1e-6)


@pytest.mark.parametrize(
    ("form", "why"),
    [
        (
            {"files": [("files", ("", b"")), ("other", ("a.toml", b"x"))]},
            "no file was chosen; choose the .toml file of a ski, or a design of MonkeyCAM",
        ),
        ({"data": {"files": "text"}}, "no file was chosen; choose the .toml file of a ski, or a design of MonkeyCAM"),
        ({"files": files(a_toml="a", b_csv="b", c_csv="c", d_csv="d")}, "at most 3 files at once are taken in."),
        (
            {"files": files(ski_toml=TEXT)},
            "there is a ski carver already, and none is overwritten; give this one another name",
        ),
        ({"files": files(ski_txt="x")}, "choose one ski"),
    ],
)
def test_what_cannot_be_taken_in_is_said_on_a_page(desk: Desk, form: dict[str, Any], why: str) -> None:
    answer = desk.post("/skis/add", **form)
    assert answer.status_code == 400
    assert "<h1>This was not taken in</h1>" in answer.text
    if why != "choose one ski":
        assert f"<p>Nothing was stored: {why}</p>" in answer.text
    assert LabSkis(desk.lab.runs).saved() == []


def test_three_files_are_not_too_many(desk: Desk) -> None:
    answer = desk.post("/skis/add", files=files(mine_toml=WITH_TABLE, rows_csv=TABLE, other_csv=TABLE))
    assert answer.status_code == 303


def test_a_refusal_is_said_in_the_language_of_the_request(desk: Desk) -> None:
    assert '<html lang="de">' in desk.post("/skis/add", "de").text
    too_many = desk.post("/skis/add", "de", files=files(a_toml="a", b_csv="b", c_csv="c", d_csv="d"))
    assert '<html lang="de">' in too_many.text


def folder_of(folder: Path, texts: Mapping[str, str]) -> list[str]:
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return sorted(texts)


def test_a_file_alone_stays_as_it_is_written(tmp_path: Path) -> None:
    names = folder_of(tmp_path, {"mine.TOML": "\ufeff" + TEXT})
    assert read_ski_files(str(tmp_path), names, {}) == SkiTexts("carver", TEXT, "", "")


def test_a_file_with_its_table_is_written_anew(tmp_path: Path) -> None:
    names = folder_of(tmp_path, {"mine.toml": WITH_TABLE, "rows.csv": TABLE})
    found = read_ski_files(str(tmp_path), names, {})
    assert found.table.startswith("station_m,")
    assert tomllib.loads(found.text)["table"] == "ski.csv"
    assert texts_of_ski(read_ski(tmp_path / "mine.toml")) == (found.text, found.table)


def test_what_is_warned_of_an_upload_is_kept(tmp_path: Path) -> None:
    names = folder_of(tmp_path, {"mine.toml": HEAVY})
    found = read_ski_files(str(tmp_path), names, {})
    assert found.warned.startswith("mine.toml: mass_kg is 20")


@pytest.mark.parametrize(
    ("texts", "why"),
    [
        ({}, "choose one ski: its .toml file with the table that it names, or the ski-def.json of MonkeyCAM"),
        ({"a.json": "{}", "b.json": "{}"}, "choose one ski: "),
        ({"a.toml": TEXT, "b.toml": TEXT}, "choose one ski: "),
        ({"a.toml": TEXT, "b.toml": TEXT, "c.json": "{}"}, "choose one ski: "),
        ({"b.csv": TABLE, "a.csv": TABLE}, "a table alone tells neither length nor mass of a ski; "),
        ({"a.toml": 'shape = "b.json"'}, "a.toml: shape is 'b.json'; choose that file, too, and name it without a fol"),
        (
            {"a.toml": 'table = "b.csv"'},
            "a.toml: table is 'b.csv'; choose that file, too, and name it without a folder",
        ),
        ({"a.toml": TEXT.replace("mass_kg = 2.246", "mass_kg = -1")}, "a.toml: mass_kg is -1"),
        ({"a.json": json.dumps(DESIGN)}, "Mass of one ski (kg): '' is no number. Correct it"),
    ],
)
def test_what_is_no_ski_is_refused(tmp_path: Path, texts: dict[str, str], why: str) -> None:
    with pytest.raises(ParameterError) as refused:
        read_ski_files(str(tmp_path), folder_of(tmp_path, texts), {})
    assert str(refused.value).startswith(why)
    if "b.csv" in texts:
        assert "(table = 'a.csv')" in str(refused.value)


def test_a_design_beside_a_file_that_names_it(tmp_path: Path) -> None:
    text = 'name = "b"\nshape = "a.json"\nmass_kg = 3\nEI_N_m2 = [400]\nGJ_N_m2 = [200]\n'
    names = folder_of(tmp_path, {"a.json": json.dumps(DESIGN), "a.toml": text})
    assert read_ski_files(str(tmp_path), names, {}).name == "b"


def test_uploads_are_named_without_their_folders(confined_words: list[tuple[object, ...]]) -> None:
    uploads = [("Skis\\of mine/mine.toml", io.BytesIO(WITH_TABLE.encode())), ("rows.csv", io.BytesIO(TABLE.encode()))]
    found = ski_of_uploads(uploads, {"mass_kg": "1"}, Limits())
    assert found.name == "my slalom"
    ((_, folder, names, further),) = confined_words
    assert (names, further) == (["mine.toml", "rows.csv"], {"mass_kg": "1"})
    assert not Path(str(folder)).exists()
    with pytest.raises(ParameterError, match="more than 1 files at once"):
        ski_of_uploads(uploads, {}, Limits(files=1))


def test_a_ski_is_added_under_a_name_or_its_own(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    texts = SkiTexts("its own", TEXT, "", "")
    assert add_ski(skis, "", texts) == "its own"
    assert add_ski(skis, " an  other ", texts) == "an other"
    assert skis.saved() == ["an other", "its own"]


# Skis of the lab


def test_skis_are_listed_without_regard_to_capitals_after_the_catalogue(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    for name in ("b", "A", "c"):
        skis.save_texts(name, TEXT, "")
    (tmp_path / "skis" / "empty").mkdir()
    (tmp_path / "skis" / "carver").mkdir()
    (tmp_path / "skis" / "carver" / "ski.toml").write_text(TEXT, encoding="utf-8")
    assert skis.saved() == ["A", "b", "c", "carver"]
    assert skis.names() == [*ski_names(), "A", "b", "c"]
    assert skis.word("A") == str(tmp_path.absolute() / "skis" / "A" / "ski.toml")
    with pytest.raises(ParameterError, match=r"^the lab has no ski named 'd'\. Choose one from the list$"):
        skis.texts("d")


@pytest.mark.parametrize("name", ["a", "Ä", "9", "a b-c_d", "x" * 40, "con1", "com", "nothing else", "kž"])
def test_names_that_a_ski_may_have(tmp_path: Path, name: str) -> None:
    LabSkis(tmp_path).require_new(name)


@pytest.mark.parametrize("name", ["_a", "a-", "x" * 41, "con", "LPT9", "a.b", "雪"])
def test_names_that_a_ski_may_not_have(tmp_path: Path, name: str) -> None:
    with pytest.raises(ParameterError, match=r"^a ski's name has 1 to 40 letters"):
        LabSkis(tmp_path).require_new(name)


def test_a_ski_that_was_saved_may_be_read_by_others_of_the_machine(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path / "deep" / "runs")
    skis.save_ski("mine", replace(CARVER, name="mine"))
    folder = tmp_path / "deep" / "runs" / "skis"
    assert (folder / "mine").stat().st_mode & 0o777 == 0o755
    assert sorted(each.name for each in (folder / "mine").iterdir()) == ["ski.csv", "ski.toml"]
    assert [each.name for each in folder.iterdir()] == ["mine"]


def test_what_cannot_be_written_is_an_error_of_ours(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="file"):
        LabSkis(tmp_path / "file").save_texts("mine", TEXT, "")


def test_who_is_slower_is_told_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("one", TEXT, "")
    monkeypatch.setattr(LabSkis, "require_new", lambda *_: None)
    with pytest.raises(OutputError, match=r"^the ski one cannot be saved: .+\. Try another name$"):
        skis.save_texts("one", TEXT, "")
    assert [each.name for each in (tmp_path / "skis").iterdir()] == ["one"]


def test_a_text_is_saved_under_its_new_name(tmp_path: Path) -> None:
    skis = LabSkis(tmp_path)
    skis.save_texts("Ä 1", TEXT, "")
    assert skis.texts("Ä 1") == (TEXT.replace('name = "carver"', 'name = "Ä 1"'), "")
    bare = TEXT.replace('name = "carver"\n', "")
    skis.save_texts("two", bare, "")
    assert skis.texts("two")[0] == f'name = "two"\n{bare}'
    twice = "x = 1\nname = \\1\n"
    with pytest.raises(SkisnowError):
        skis.save_texts("four", twice, "")
    within = TEXT.replace('source = """', 'source = """\\\nname = inside\n')
    skis.save_texts("three", within, "")
    assert skis.texts("three")[0] == within.replace('name = "carver"', 'name = "three"')
    inside = TEXT.replace('name = "carver"\n', "").replace('source = """', 'source = """\\\nname = inside\n')
    with pytest.raises(ParameterError, match=r'of its own: name = "four"$'):
        skis.save_texts("four", f'{inside}name = "carver"\n', "")
    assert skis.saved() == ["three", "two", "Ä 1"]


def test_a_text_is_read_with_its_table_and_its_warnings() -> None:
    named = WITH_TABLE.replace("rows.csv", "ski.csv")
    ski, warned = ski_of_texts(named, TABLE)
    assert (ski.name, warned) == ("my slalom", "")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # whatever the process does with them
        _, warned = ski_of_texts(HEAVY, "")
    assert warned.startswith("ski.toml: mass_kg is 20")
    twice = HEAVY.replace("camber_mm = 6", "camber_mm = 40")
    words = ski_of_texts(twice, "")[1]
    assert " ski.toml: " in words and words.count("ski.toml: ") == 2
    with pytest.raises(ParameterError, match=r"^ski\.toml: length_mm is 'x'"):
        ski_of_texts(TEXT.replace("length_mm = 1755", 'length_mm = "x"'), "")
    with pytest.raises(ParameterError, match=r"^ski\.toml is no TOML"):
        ski_of_texts("[", "")
    with pytest.raises(ParameterError, match=r"^ski\.csv"):
        ski_of_texts(named, "x\n")


def test_two_texts_at_once_are_warned_of_each_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    """Warnings are a setting of the whole process: a thread that came second would take it away from the first."""
    begun, entered = threading.Event(), threading.Event()
    found: list[str] = []
    read = read_ski

    def held(place: Path) -> Ski:
        if begun.is_set():
            entered.set()
        begun.set()
        if not found:
            entered.wait(0.1)  # for nothing where one waits for the other
        return read(place)

    monkeypatch.setattr("skisnow.web.lab_skis.read_ski", held)
    threads = [threading.Thread(target=lambda: found.append(ski_of_texts(HEAVY, "")[1])) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert [words.count("mass_kg is 20") for words in found] == [1, 1]


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (
            'shape = "ski.csv"',
            "ski.toml: a shape of another program cannot be read here. Use read_ski or the command line",
        ),
        (
            'table = "other.csv"',
            'ski.toml: the table of a ski of the lab is in the field below it: write table = "ski.csv"',
        ),
    ],
)
def test_a_text_that_names_another_file_is_refused(line: str, why: str) -> None:
    with pytest.raises(ParameterError) as refused:
        ski_of_texts(f"{TEXT}\n{line}\n", "")
    assert str(refused.value) == why


def test_a_folder_that_is_gone_is_not_named(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    told = f"{tmp_path}/link/ski.toml and {tmp_path}/real/ski.csv in {tmp_path}"
    assert _without(f"{tmp_path}/link", told) == f"ski.toml and ski.csv in {tmp_path}"


def test_a_ski_that_was_read_is_checked_alone() -> None:
    check_ski_texts(TEXT, "")
    with pytest.raises(ParameterError, match="mass_kg"):
        check_ski_texts(TEXT.replace("2.246", "-1"), "")


# What is asked of the editor

ONES = dict.fromkeys(FACTORS, "1")


@pytest.mark.parametrize(
    ("factors", "cells", "is_file"),
    [
        ({}, {}, True),
        (ONES, {}, True),
        (ONES | {"width_mm": "1,0"}, {}, True),
        (ONES | {"width_mm": "1.1"}, {}, False),
        (ONES, {("width_mm", 4): "70"}, False),
    ],
)
def test_whether_only_the_file_says_what_the_ski_is(
    factors: dict[str, str], cells: dict[tuple[str, int], str], *, is_file: bool
) -> None:
    asked = SkiAsked(TEXT, factors=factors, cells=cells)
    assert asked.is_file is is_file
    found = ski_found(asked)
    assert found.ski.name == ("carver" if is_file else "carver, edited")
    assert (found.ski.source == CARVER.source) is is_file
    assert ski_found(asked, name="mine").ski.name == "mine"


def test_an_edit_is_what_the_library_makes_of_it() -> None:
    stations = edit_stations(CARVER)
    factors = {key: str(1.0 + 0.1 * i) for i, key in enumerate(FACTORS)}
    cells = {("width_mm", 3): "85,5", ("base_height_mm", 2): "−2", ("EI_N_m2", 4): "500", ("GJ_N_m2", 8): "70"}
    found = ski_found(SkiAsked(HEAVY, "", factors, cells))
    assert found.warned.startswith("ski.toml: mass_kg is 20")
    assert found.station == tuple(stations)
    values = {column: np.full(9, np.nan) for column in CELLS}
    values["width_mm"][3], values["base_height_mm"][2] = 0.0855, -0.002
    values["EI_N_m2"][4], values["GJ_N_m2"][8] = 500.0, 70.0
    edit = SkiEdit(stations, {key: float(text) for key, text in factors.items()}, values)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        heavy, _ = ski_of_texts(HEAVY, "")
    edited = edited_ski(heavy, edit, name="x", source="x")
    for attribute in ("width", "base_height", "bending_stiffness", "torsional_stiffness", "mass_per_length"):
        assert getattr(found.ski, attribute) == pytest.approx(getattr(edited, attribute))
    said = (
        "Width × 1.1; Base height × 1.2; EI × 1.3; GJ × 1.4; Mass × 1.5; Width (mm) 85,5 at 0.268 m; "
        "Base height (mm) −2 at 0.537 m; EI (N m²) 500 at 0.000 m; GJ (N m²) 70 at -0.825 m"
    )
    assert found.ski.source == f"edited in the lab ({said}) from: {heavy.source}"
    assert {place: found.cells[place] for place in cells} == cells  # as typed
    shown = {(column, i) for column in CELLS for i in range(9)}
    assert set(found.cells) == shown
    assert found.cells["width_mm", 4] == f"{float(np.interp(0.0, -edited.station, edited.width)) * 1000:.4g}"


def test_the_page_reads_a_text_in_its_own_process_before_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[tuple[object, ...]] = []
    monkeypatch.setattr(skis_page, "confined", lambda *words: heard.append(words))
    skis_page._checked_apart("text", "table")
    assert heard == [(OF_A_SKI, check_ski_texts, "text", "table")]
