"""*Skis*: contents of the page, and two skis compared."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from nicegui import ui

from skisnow.ski import ski_names
from skisnow.web.lab_skis import LabSkis

from .shared import CARVER, FILE, SLALOM, TABLE_FIELD, TEXT, cells_of, opened, source_words

if TYPE_CHECKING:
    from ..desk import Desk

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


def test_the_page_shows_facts_charts_and_the_editor_of_a_ski(desk: Desk) -> None:
    page = opened(desk)
    lines = page.outline()
    facts = lines[lines.index("carver") + 1 :]
    assert facts[: len(CARVER_FACTS)] == CARVER_FACTS
    assert facts[len(CARVER_FACTS)].endswith(source_words(CARVER))
    for extent in ("−63.5 to 63.5", "−6.00 to 44.0", "100 to 460", "65.0 to 195"):
        page.shows(f": {extent} (carver)")
    cells = cells_of(CARVER)
    begin = lines.index(cells[0])
    assert lines[begin : begin + len(cells)] == cells
    factors = ("Sidecut depth", "Width", "Base height", "EI", "GJ", "Mass")
    assert [page.field(f"{name} ×").value for name in factors] == ["1"] * 6
    assert (page.field(FILE).value, page.field(TABLE_FIELD).value) == (TEXT, "")
    assert page.field("Ski").options == {name: name for name in ski_names()}
    assert list(page.field("Compared with").options) == ["nothing", "the edited ski", *ski_names()]


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
    page.shows("Begun from slalom")
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
    announced = [each for each in page.of(ui.label) if "good" in each.classes and "mine" in each.text]
    assert [each.props["role"] for each in announced] == (["status"] if added else [])
    page.shows("Begun from mine")
