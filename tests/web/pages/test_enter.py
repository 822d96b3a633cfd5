"""Entering tests: what stands on the pages, what is stored of what is typed, and what is refused."""

from __future__ import annotations

import json
import math
import threading
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from nicegui import ui

from skisnow.errors import StoreError
from skisnow.field.store import Journals, NewEntry, ReplayedTest
from skisnow.report.curves import SeriesCurve
from skisnow.report.number_formatting import significant
from skisnow.web import answering
from skisnow.web.answering import PageRequest
from skisnow.web.edit_session import EditSession, QuickResults
from skisnow.web.entry.beside import Beside
from skisnow.web.entry.series import LEFT, TOLD
from skisnow.web.entry.table_view import TableView
from skisnow.web.line_chart import BEHIND
from skisnow.web.local_time import minute_words
from skisnow.web.words import hardness_words

if TYPE_CHECKING:
    from collections.abc import Callable

    from skisnow.field.store import JournalEntry

    from .desk import Desk, Sheet

TOML = """name = "Desk"
observers = ["Ada", "Bo", "Cy"]
load_steps_N = [20, 40.5, 60]
gauge_resolution_mm = 0.01
[[tool]]
name = "ski piece"
shape = "ski"
length_mm = 200
width_mm = 62
[[tool]]
name = "disc"
shape = "disc"
diameter_mm = 40
[[plate]]
name = "plate"
length_mm = 100
[[plate]]
name = "blade"
length_mm = 50
"""
PENETRATION, SHEAR, DENSITY, DROP_CONE = "penetration.csv", "shear.csv", "density.csv", "drop_cone.csv"
SERIES = {"site": "A", "spot": "", "tool": "ski piece", "edge_angle_deg": "30"}
SHEARED = {"site": "A", "plate": "plate", "spot": "", "turning_angle_deg": "", "edge_angle_deg": "90"}
SHEARED |= {"depth_mm": "6", "lever_arm_mm": "250", "moment_Nm": "30"}
CHART = "chart Load against depth of this series and the others of its site, load in N: "


def begun(desk: Desk, text: str = TOML) -> str:
    return Journals(desk.lab.store).begin(text)


def write(desk: Desk, id_: str, entry: NewEntry) -> JournalEntry:
    journals = Journals(desk.lab.store)
    return journals.append(id_, entry, seen=journals.entries(id_)[-1].sequence)


def add(desk: Desk, id_: str, file: str, name: str, **cells: str) -> JournalEntry:
    """A row that somebody entered."""
    position = len(EditSession(desk.lab, id_).test(file, name).history)
    who = cells.pop("who", "Ada")
    return write(desk, id_, NewEntry(action="add", file=file, test=name, cells=cells, position=position, who=who))


def add_series(desk: Desk, id_: str, name: str, *readings: tuple[str, str], **further: str) -> None:
    for load, depth in readings:
        cells = {"experiment": name, **SERIES, "load_N": load, "depth_mm": depth} | further
        add(desk, id_, PENETRATION, name, **cells)


def add_shear(desk: Desk, id_: str, name: str, **further: str) -> None:
    add(desk, id_, SHEAR, name, **({"experiment": name} | SHEARED | further))


def stored(desk: Desk, id_: str, file: str, name: str) -> list[dict[str, str]]:
    """The rows of a test as they are now."""
    return [row.cells for row in EditSession(desk.lab, id_).test(file, name).rows]


def depths(desk: Desk, id_: str, name: str = "1") -> list[tuple[str, str]]:
    return [(row["load_N"], row["depth_mm"]) for row in stored(desk, id_, PENETRATION, name)]


def history(desk: Desk, id_: str) -> list[JournalEntry]:
    return list(Journals(desk.lab.store).entries(id_))[1:]


def series_page(desk: Desk, id_: str, name: str = "1", language: str = "en") -> Sheet:
    return desk.open(f"/enter/{id_}?table=penetration.csv&test={name}", language)


def begun_series(desk: Desk, id_: str) -> Sheet:
    """A page on a series that has no reading yet."""
    return desk.open(f"/enter/{id_}?table=penetration.csv&test=1&site=A&tool=ski%20piece&edge_angle_deg=30")


def enter(page: Sheet, name: str, text: str, number: int | None = None) -> None:
    """Type into a field and press Enter."""
    made = page.field(name)
    page.desk.do(lambda: made.set_value(text), page.client)
    args: dict[str, object] = {"once": f"{name} {text}", "text": text.strip()}
    page.fire(made, "keydown.enter", args if number is None else {"number": number, "once": f"question {number}"})


def leave(page: Sheet, name: str, text: str | None = None) -> None:
    """Leave a field, in which a text may have been typed."""
    made = page.field(name)
    if text is not None:
        page.desk.do(lambda: made.set_value(text), page.client)
    page.fire(made, "blur", None)


def status(page: Sheet) -> str:
    return next((line for line in page.outline() if line.startswith("[status")), "")


def between(page: Sheet, first: str, last: str = "") -> list[str]:
    """Lines from the one to before the other, or one that begins so, or to the end."""
    outline = page.outline()
    rest = outline[outline.index(first) :]
    return rest[: next(at for at, line in enumerate(rest) if line.startswith(last))] if last else rest


def reading_row(page: Sheet, name: str) -> Any:
    """What holds a field of a reading and the word beside it."""
    return page.field(name).parent_slot.parent


def details(page: Sheet, words: str) -> Any:
    return next(
        each
        for each in page.tagged("details")
        if any(isinstance(label, ui.label) and label.text == words for label in each.descendants())
    )


def is_open(page: Sheet, words: str) -> bool:
    return "open" in details(page, words).props


def asks(page: Sheet) -> list[str]:
    """The question for a reason."""
    return between(page, next(line for line in page.outline() if "field Why" in line))


def selected(page: Sheet) -> list[Any]:
    """Fields whose text was marked, so that it is typed over."""
    told = [each for each in [*page.at_first, *page.scripts] if '"select"' in each]
    return [page.client.elements.get(int(each.split("(")[1].split(",")[0])) for each in told]


HEAD = [
    "h1 Desk",
    "link Penetration -> /enter/{id}?table=penetration.csv",
    "link Shear -> /enter/{id}?table=shear.csv",
    "link Density -> /enter/{id}?table=density.csv",
    "link Drop cone -> /enter/{id}?table=drop_cone.csv",
    "link Analysis -> /analysis/entry/{id}",
    "link Campaign -> /describe?entry={id}",
    "field Operator = 'Ada'",
]


def head(id_: str) -> list[str]:
    return [line.format(id=id_) for line in HEAD]


# A page and its frame


def test_a_page_of_a_campaign_asks_for_its_first_series(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    assert page.outline() == [
        *head(id_),
        "h2 New series",
        "field Name of the test = '1'",
        "field Site = ''",
        "field Tool = 'disc'",
        "field Edge angle (°) = '' numeric",
        "field Measurement point, if sheared there = '' optional",
        "button[main] Begin the series",
        CHART + "nothing yet",
    ]
    assert page.focused() is page.field("Site")
    assert selected(page) == [page.field("Site")]
    assert any(f'replaceState({{}}, "", "/enter/{id_}?table=penetration.csv")' in each for each in page.at_first)
    assert page.at_first.count("lab.answered(0, true)") == 1
    assert [each.text for each in page.tagged("nicegui-link") if "aria-current" in each.props] == [
        "Campaigns",
        "Penetration",
    ]
    assert [each.props.get("aria-label") for each in page.content.descendants() if "aria-label" in each.props] == [
        "Kind of test",
        "Entry",
        "Results of the readings",
        "Changes, and what was entered",
    ]
    assert page.field("Operator").options == {"Ada": "Ada", "Bo": "Bo", "Cy": "Cy"}


def test_who_writes_is_told_to_the_browser(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    place = next(each for each in page.tagged("div") if "who" in each.classes)
    assert place.props["data-who"] == "Ada"
    page.fill("Operator", "Bo")
    assert place.props["data-who"] == "Bo"
    (said,) = (each for each in page.of(ui.label) if "status" in each.classes)
    assert (said.props["role"], said.props["aria-live"]) == ("status", "polite")


def test_without_observers_anybody_may_say_a_name(desk: Desk) -> None:
    id_ = begun(desk, 'place = "x"\n')
    page = desk.open(f"/enter/{id_}?table=density.csv")
    assert page.outline()[0] == "h1 Campaign"
    assert "field Operator = ''" in page.outline()
    page.fill("Operator", "Di")
    page.fill("Site", "A")
    page.fill("Density (kg/m³)", "300")
    page.press("Store")
    assert [entry.who for entry in history(desk, id_)] == ["Di"]


def test_an_address_with_another_table_is_refused(desk: Desk) -> None:
    answer = desk.get(f"/enter/{begun(desk)}?table=campaign.toml")
    assert answer.status_code == 404
    assert "this address names no table of a campaign" in answer.text
    desk.failures.clear()


# A series: its head


def test_a_series_begins_with_its_head_and_asks_for_a_depth_under_each_load(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    page.fill("Site", " A ")
    page.fill("Tool", "ski piece")
    page.fill("Edge angle (°)", "30,5")
    page.fill("Measurement point, if sheared there", "p")
    page.press("Begin the series")
    assert page.outline() == [
        *head(id_),
        "[status good] Series 1: enter the depth under each load.",
        "h2 Series 1",
        "[quiet] A · ski piece · 30.5°",
        "[load] 20 N",
        "field Depth under 20 N (mm) = '' numeric",
        "[load] 40.5 N",
        "field Depth under 40.5 N (mm) = '' numeric",
        "[load] 60 N",
        "field Depth under 60 N (mm) = '' numeric",
        "button[main then] Next series",
        "Discs taken off one by one",
        "[load] 40.5 N",
        "field Depth back under 40.5 N (mm) = '' numeric",
        "[load] 20 N",
        "field Depth back under 20 N (mm) = '' numeric",
        "Depths read once more after waiting",
        "[load] 20 N",
        "field Depth after waiting under 20 N (mm) = '' numeric optional",
        "[load] 40.5 N",
        "field Depth after waiting under 40.5 N (mm) = '' numeric optional",
        "[load] 60 N",
        "field Depth after waiting under 60 N (mm) = '' numeric optional",
        "button Store what was read after waiting",
        CHART + "nothing yet",
        "A load that is not in the disc set",
        "field Further load (N) = '' numeric",
        "field Its depth (mm) = '' numeric",
        "button Store it",
    ]
    assert page.focused() is page.field("Depth under 20 N (mm)")
    address = f"/enter/{id_}?table=penetration.csv&test=1&site=A&spot=p&tool=ski%20piece&edge_angle_deg=30.5"
    assert any(f'"{address}"' in each for each in page.scripts)
    assert history(desk, id_) == []
    rows = [each.props for each in page.tagged("div") if "reading" in each.classes and "data-load" in each.props]
    assert [(each["data-load"], each["data-branch"]) for each in rows] == [
        ("20", ""),
        ("40.5", ""),
        ("60", ""),
        ("40.5", "unloading"),
        ("20", "unloading"),
    ]
    heads = [json.loads(each.props["data-head"]) for each in page.tagged("div") if "data-head" in each.props]
    assert heads == [{"experiment": "1", "site": "A", "spot": "p", "tool": "ski piece", "edge_angle_deg": "30.5"}] * 2
    assert not any("open" in each.props for each in page.tagged("details"))
    first = page.field("Depth under 20 N (mm)")._event_listeners.values()
    assert {each.type: each.js_handler for each in first if each.js_handler in (TOLD, LEFT)} == {
        "keydown.enter": TOLD,
        "blur": LEFT,
    }


def test_enter_in_the_head_begins_the_series_too(desk: Desk) -> None:
    page = desk.open(f"/enter/{begun(desk)}")
    page.fill("Site", "A")
    page.fill("Edge angle (°)", "30")
    form = page.field("Site").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1, "once": "a"})
    page.shows("h2 Series 1")
    assert page.scripts[-1] == "lab.answered(1, true)"


def test_what_no_series_can_begin_with_is_said_at_its_fields(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    page.fill("Edge angle (°)", "95")
    button = next(each for each in page.of(ui.button) if each.text == "Begin the series")
    page.fire(button, "click", {"number": 1})
    faults = ["site is blank; give it a name", "Edge angle (°) is a number from 0 to below 90; '95' stands there"]
    assert status(page) == f"[status bad] Not begun: {'; '.join(faults)}."
    assert between(page, "field Site = '' ! " + faults[0])[2] == f"field Edge angle (°) = '95' numeric ! {faults[1]}"
    assert page.scripts[-1] == "lab.answered(1, false)"
    page.fill("Site", "A")
    page.fill("Edge angle (°)", "45")
    page.press("Begin the series")
    assert status(page) == "[status good] Series 1: enter the depth under each load."


def test_a_series_has_a_name_of_its_own(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = desk.open(f"/enter/{id_}")
    page.fill("Name of the test", "1")
    page.press("Begin the series")
    fault = "there is a test 1 already; give this one another name"
    assert status(page) == f"[status bad] Not begun: {fault}."
    assert f"field Name of the test = '1' ! {fault}" in page.outline()


def test_the_next_series_has_what_it_shares_with_the_last_one(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "7", ("20", "1.5"))
    add_series(desk, id_, "a", ("20", "1.5"), site="B", edge_angle_deg="45")
    page = desk.open(f"/enter/{id_}")
    assert between(page, "h2 New series", CHART) == [
        "h2 New series",
        "field Name of the test = '8'",
        "field Site = 'B'",
        "field Tool = 'ski piece'",
        "field Edge angle (°) = '45' numeric",
        "field Measurement point, if sheared there = '' optional",
        "button[main] Begin the series",
    ]
    assert page.focused() is page.field("Edge angle (°)")
    assert selected(page) == [page.field("Edge angle (°)")]
    assert between(page, "h3 Series so far") == [
        "h3 Series so far",
        f"link[small] a -> /enter/{id_}?table=penetration.csv&test=a",
        f"link[small] 7 -> /enter/{id_}?table=penetration.csv&test=7",
    ]


def test_a_tool_that_the_campaign_has_no_more_is_not_proposed(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), tool="lost")
    assert desk.open(f"/enter/{id_}").field("Tool").value == "disc"
    other = begun(desk, 'name = "Bare"')
    bare = desk.open(f"/enter/{other}")
    assert (bare.field("Tool").value, bare.field("Tool").options) == (None, {})


# A series: its address


@pytest.mark.parametrize(
    "further",
    [
        "site=A&tool=ski%20piece&edge_angle_deg=95",
        "site=A&tool=lost&edge_angle_deg=30",
        "site=%20A&tool=disc&edge_angle_deg=0",
        "tool=disc&edge_angle_deg=0",
    ],
)
def test_an_address_that_tells_of_no_head_of_a_series_asks_for_one(desk: Desk, further: str) -> None:
    page = desk.open(f"/enter/{begun(desk)}?table=penetration.csv&test=1&{further}")
    assert "h2 New series" in page.outline()


def test_a_series_is_there_again_by_its_address(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    assert between(page, "h2 Series 1")[:3] == ["h2 Series 1", "[quiet] A · ski piece · 30°", "[load] 20 N"]
    assert page.focused() is page.field("Depth under 20 N (mm)")
    add_series(desk, id_, "1", ("20", "1.5"))
    page = begun_series(desk, id_)
    assert "field Depth under 20 N (mm) = '1.5' numeric" in page.outline()
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    address = f"/enter/{id_}?table=penetration.csv&test=1"
    assert [each for each in page.at_first if "replaceState" in each] == [
        f'history.replaceState({{}}, "", "{address}");'
    ]
    (link,) = (each for each in page.tagged("nicegui-link") if each.text == "1")
    assert link.props["aria-current"] == "page"


def test_an_address_with_a_test_of_another_table_begins_a_test(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = desk.open(f"/enter/{id_}?table=shear.csv&test=1&site=A&tool=disc&edge_angle_deg=0")
    assert "h2 New test" in page.outline()
    assert "h3 Series so far" not in page.outline()
    assert "h2 New series" in series_page(desk, id_, "2").outline()


def test_the_last_forty_series_have_links(desk: Desk) -> None:
    id_ = begun(desk)
    for number in range(41):
        add_series(desk, id_, f"n{number}", ("20", "1.5"))
    write(desk, id_, NewEntry(action="cancel", file=PENETRATION, test="n40", why="slip"))
    lines = between(desk.open(f"/enter/{id_}"), "h3 Series so far")
    assert len(lines) == 41
    assert lines[1].startswith("link[small] n40 (cancelled) -> ")
    assert lines[-1].startswith("link[small] n1 -> ")


# A series: its readings


def test_a_reading_is_stored_as_it_is_typed(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 40.5 N (mm)", " 2,15 ")
    assert status(page) == "[status good] Stored: 2.15 mm under 40.5 N."
    assert page.scripts[-1] == 'lab.told("Depth under 40.5 N (mm)  2,15 ")'
    (entry,) = history(desk, id_)
    assert (entry.action, entry.file, entry.test, entry.position) == ("add", PENETRATION, "1", 0)
    assert (entry.who, entry.once) == ("Ada", "Depth under 40.5 N (mm)  2,15 ")
    assert entry.cells == {"experiment": "1", **SERIES, "load_N": "40.5", "depth_mm": "2.15"}
    assert between(page, "field Depth under 40.5 N (mm) = '2.15' numeric")[1] == "[stored] stored"
    assert reading_row(page, "Depth under 40.5 N (mm)").props["data-stored"] == "2.15"
    assert between(page, "button Undo: entered 2.15 mm under 40.5 N", "A load that is not in the disc set") == [
        "button Undo: entered 2.15 mm under 40.5 N",
        "button Cancel this test",
        "History of 1",
        f"{minute_words(entry.at)} · Ada · entered 2.15 mm under 40.5 N",
    ]
    leave(page, "Depth under 20 N (mm)", "1.5")
    assert depths(desk, id_) == [("20", "1.5"), ("40.5", "2.15")]
    assert [each.position for each in history(desk, id_)] == [0, 1]


def test_a_series_in_german_has_commas(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_, language="de")
    fields = [each for each in page.of(ui.input) if each.props.get("inputmode") == "decimal"]
    assert fields[0].value == "1,5"
    assert reading_row(page, fields[0].props["aria-label"]).props["data-stored"] == "1.5"
    enter(page, fields[1].props["aria-label"], "2.15")
    assert fields[1].value == "2,15"
    assert depths(desk, id_) == [("20", "1.5"), ("40.5", "2.15")]
    leave(page, fields[1].props["aria-label"])  # is no correction
    assert len(history(desk, id_)) == 2
    assert not any(each.props.get("label") == "Warum" for each in page.of(ui.input))


def test_what_is_no_depth_is_refused_at_its_field_and_said_once(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    name = "Depth under 20 N (mm)"
    enter(page, name, "1.5.2")
    fault = "Depth (mm) is a number of 0 or more; '1.5.2' stands there"
    assert status(page) == f"[status bad] Not stored: {fault}."
    assert f"field {name} = '1.5.2' numeric ! {fault}" in page.outline()
    assert "refused" in reading_row(page, name).classes
    assert f"lab.refusedLast({page.field(name).id})" in page.scripts
    enter(page, "Depth under 60 N (mm)", "3")
    leave(page, name)  # it was said at Enter
    assert status(page) == "[status good] Stored: 3 mm under 60 N."
    enter(page, name, "1.5.2")  # at another Enter it is said again
    assert status(page) == f"[status bad] Not stored: {fault}."
    leave(page, name, "x")
    assert status(page) == "[status bad] Not stored: Depth (mm) is a number of 0 or more; 'x' stands there."
    leave(page, name, "")
    assert "refused" not in reading_row(page, name).classes
    leave(page, name, "x")  # another time
    assert "refused" in reading_row(page, name).classes
    enter(page, name, "1.5")
    assert "refused" not in reading_row(page, name).classes
    assert depths(desk, id_) == [("20", "1.5"), ("60", "3")]
    assert all(each.error is None for each in page.of(ui.input))


def test_what_is_refused_stays_as_it_was_typed(desk: Desk) -> None:
    page = begun_series(desk, begun(desk))
    enter(page, "Depth under 20 N (mm)", " x ")
    assert page.field("Depth under 20 N (mm)").value == " x "


def test_a_refusal_is_answered_where_the_browser_waits(desk: Desk) -> None:
    page = begun_series(desk, begun(desk))
    enter(page, "Depth under 20 N (mm)", "x", number=1)
    assert page.scripts[-1] == "lab.answered(1, false)"
    enter(page, "Depth under 20 N (mm)", "1", number=2)
    assert page.scripts[-1] == "lab.answered(2, true)"
    enter(page, "Depth under 20 N (mm)", "1", number=3)
    assert page.scripts[-1] == "lab.answered(3, true)"


def test_a_text_that_was_lost_on_its_way_is_taken_from_what_is_sent_again(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    made = page.field("Depth under 20 N (mm)")
    page.fire(made, "blur", {"once": "a", "text": "1.5"})
    page.fire(made, "blur", {"once": "a", "text": "1.5"})
    assert depths(desk, id_) == [("20", "1.5")]
    assert made.value == "1.5"
    assert page.scripts.count('lab.told("a")') == 2


def test_a_reading_that_was_sent_before_is_stored_once(desk: Desk) -> None:
    """The page was loaded anew meanwhile, and the first answer did not come."""
    id_ = begun(desk)
    for _ in range(2):
        page = begun_series(desk, id_)
        page.fire(page.field("Depth under 20 N (mm)"), "blur", {"once": "a", "text": "1.5"})
    assert len(history(desk, id_)) == 1


def test_somebody_else_on_the_same_series_is_told_and_shown(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    page.fill("Depth under 60 N (mm)", "3")  # typed, and not stored
    page.fill("Depth back under 20 N (mm)", "2.9")
    page.fill("Depth after waiting under 20 N (mm)", "1.7")
    add_series(desk, id_, "1", ("20", "1.4"), who="Bo")
    enter(page, "Depth under 40.5 N (mm)", "2.1")
    (entry,) = history(desk, id_)
    assert status(page) == (
        f"[status bad] Nothing was stored: Bo wrote about Penetration, 1 meanwhile ({entry.at}). "
        "Look at it as it is now, then enter again what is still missing."
    )
    shown = {line.split(" = ")[0]: line.split(" = ")[1] for line in page.outline() if line.startswith("field Depth")}
    assert shown["field Depth under 20 N (mm)"] == "'1.4' numeric"
    assert shown["field Depth under 40.5 N (mm)"] == "'2.1' numeric"
    assert shown["field Depth under 60 N (mm)"] == "'3' numeric"
    assert shown["field Depth back under 20 N (mm)"] == "'2.9' numeric"
    assert shown["field Depth after waiting under 20 N (mm)"] == "'1.7' numeric optional"
    assert is_open(page, "Discs taken off one by one")
    assert is_open(page, "Depths read once more after waiting")
    assert not is_open(page, "A load that is not in the disc set")
    leave(page, "Depth under 40.5 N (mm)")
    assert depths(desk, id_) == [("20", "1.4"), ("40.5", "2.1")]


def test_somebody_elses_reading_under_the_same_load_stays(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    add_series(desk, id_, "1", ("20", "1.4"), who="Bo")
    enter(page, "Depth under 20 N (mm)", "1.5")
    assert status(page).startswith("[status bad] Nothing was stored: Bo wrote about Penetration, 1 meanwhile")
    assert page.field("Depth under 20 N (mm)").value == "1.4"
    assert depths(desk, id_) == [("20", "1.4")]
    enter(page, "Depth under 20 N (mm)", "1.5")
    assert "20 N: 1.4 mm becomes 1.5 mm." in page.outline()


def test_a_load_beyond_the_discs_stands_where_it_belongs(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 20 N (mm)", "1.5")
    page.fill("Further load (N)", "50,0")
    page.fill("Its depth (mm)", "2.4")
    page.fill("Depth under 60 N (mm)", "3")
    page.press("Store it")
    assert status(page) == "[status good] Stored: 2.4 mm under 50.0 N."
    assert depths(desk, id_) == [("20", "1.5"), ("50.0", "2.4")]
    assert [line for line in page.outline() if line.startswith("field Depth under")] == [
        "field Depth under 20 N (mm) = '1.5' numeric",
        "field Depth under 40.5 N (mm) = '' numeric",
        "field Depth under 50.0 N (mm) = '2.4' numeric",
        "field Depth under 60 N (mm) = '3' numeric",
    ]
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    assert "field Further load (N) = '' numeric" in page.outline()


def test_a_load_that_has_a_reading_is_refused_as_a_further_one(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 20 N (mm)", "1.5")
    page.fill("Further load (N)", "20.0")
    page.fill("Its depth (mm)", "2.4")
    form = page.field("Its depth (mm)").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 4, "once": "b"})
    fault = "there is a reading under 20.0 N already; correct it in its own field"
    assert status(page) == f"[status bad] Not stored: {fault}."
    assert f"field Further load (N) = '20.0' numeric ! {fault}" in page.outline()
    assert page.scripts[-1] == "lab.answered(4, false)"
    page.fill("Further load (N)", "")
    page.press("Store it")
    assert status(page) == "[status bad] Not stored: Load (N) is a number above 0; it is blank."
    page.fill("Further load (N)", "80")
    page.fill("Its depth (mm)", "-1")
    page.press("Store it")
    assert status(page) == "[status bad] Not stored: Depth (mm) is a number of 0 or more; '-1' stands there."
    assert len(history(desk, id_)) == 1


def test_discs_that_are_taken_off_come_after_the_loading(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    name = "Depth back under 40.5 N (mm)"
    enter(page, name, "2.5")
    fault = "the depths under rising loads come first"
    assert status(page) == f"[status bad] Not stored: {fault}."
    assert f"field {name} = '2.5' numeric ! {fault}" in page.outline()
    enter(page, name, "")
    for load, depth in (("20", "1.5"), ("40.5", "2.15"), ("60", "2.6")):
        enter(page, f"Depth under {load} N (mm)", depth)
    enter(page, name, "2.5")
    assert status(page) == "[status good] Stored: 2.5 mm under 40.5 N on the way back."
    assert "button Undo: entered 2.5 mm under 40.5 N on the way back" in page.outline()
    assert history(desk, id_)[-1].cells["branch"] == "unloading"
    assert "branch" not in history(desk, id_)[0].cells
    page = series_page(desk, id_)
    assert is_open(page, "Discs taken off one by one")
    assert f"field {name} = '2.5' numeric" in page.outline()
    assert "field Depth under 40.5 N (mm) = '2.15' numeric" in page.outline()
    assert page.focused() is page.field("Depth back under 20 N (mm)")
    page.shows("k_u/H_V = ")
    enter(page, name, "2.4")
    assert "40.5 N on the way back: 2.5 mm becomes 2.4 mm." in page.outline()


def test_a_whole_loading_puts_the_focus_on_the_next_series(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    page = series_page(desk, id_)
    assert page.focused().text == "Next series"
    assert not is_open(page, "Discs taken off one by one")


def test_a_campaign_with_one_load_has_no_way_back(desk: Desk) -> None:
    id_ = begun(desk, TOML.replace("[20, 40.5, 60]", "[20]"))
    page = begun_series(desk, id_)
    assert "Discs taken off one by one" not in page.outline()


# A series: what the readings say


def test_the_hardness_follows_the_readings(desk: Desk) -> None:
    """A wedge at ϑ = 30°: V = 200 mm · e²/(2 tan ϑ), and H_V = F/V where all readings give the same."""
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 20 N (mm)", str(2.6 * math.sqrt(20 / 60)))
    enter(page, "Depth under 40.5 N (mm)", str(2.6 * math.sqrt(40.5 / 60)))
    enter(page, "Depth under 60 N (mm)", "2.6")
    by_hand = 60.0 / (200.0 * 2.6**2 / (2.0 * math.tan(math.radians(30.0))))
    row = EditSession(desk.lab, id_).quick_results("A").penetration["1"]
    assert hardness_words(row).startswith(f"{significant(by_hand)} N/mm³, [")
    page.shows(f"[value] H_V = {hardness_words(row)}")
    assert "[quiet] Test 1" in page.outline()
    (value,) = (each for each in page.of(ui.label) if "value" in each.classes)
    assert value.props["role"] == "status"
    panel = page.charts()["Load (N)"]
    assert (panel["x"], panel["from_zero"]) == ("Depth (mm)", "xy")
    assert [(line["style"], line["points"]) for line in panel["lines"]] == [(0, True), (0, False)]
    assert panel["lines"][0]["y"] == [20, 40.5, 60]


def test_too_few_loads_are_said_when_the_series_is_left(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 20 N (mm)", "1.5")
    enter(page, "Depth under 40.5 N (mm)", "2.15")
    page.shows("H_V = ")
    few = "The series has fewer than 3 load steps."
    assert not any(few in line for line in page.outline())
    page.press("Next series")
    page.shows(few)
    assert "h2 New series" in page.outline()
    assert page.focused() is page.field("Edge angle (°)")
    add_series(desk, id_, "2", ("20", "1.5"))
    page = series_page(desk, id_)  # another one was begun since
    page.shows(few)
    enter(page, "Depth under 60 N (mm)", "2.6")
    page.until(lambda: not any(few in line for line in page.outline()))


def test_a_reading_of_the_series_that_is_not_the_last_one_is_followed_to_its_end(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    add_series(desk, id_, "2", ("20", "1.5"))
    page = series_page(desk, id_)
    enter(page, "Depth under 40.5 N (mm)", "2.15")
    page.shows("H_V = ")
    page.shows("The series has fewer than 3 load steps.")


# A series: corrections


def asked_to_correct(desk: Desk, id_: str) -> Sheet:
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "22.5"))
    page = series_page(desk, id_)
    enter(page, "Depth under 40.5 N (mm)", "2,25", number=1)
    return page


def test_another_depth_asks_for_a_reason(desk: Desk) -> None:
    id_ = begun(desk)
    page = asked_to_correct(desk, id_)
    assert between(page, "40.5 N: 22.5 mm becomes 2.25 mm.", "button[main then] Next series") == [
        "40.5 N: 22.5 mm becomes 2.25 mm.",
        "field Why = 'typing error'",
        "button[main] Correct it",
        "button Leave it as it was",
    ]
    why = page.field("Why")
    assert page.focused() is why
    assert selected(page)[-1] is why
    assert "wide" in why.classes
    assert page.scripts[-1] == "lab.answered(1, true)"
    page.fill("Why", "misread")
    leave(page, "Depth under 40.5 N (mm)")  # one question is enough
    assert page.field("Why") is why
    page.press("Correct it")
    assert status(page) == "[status good] Corrected; the first reading is kept."
    assert depths(desk, id_) == [("20", "1.5"), ("40.5", "2.25")]
    entry = history(desk, id_)[-1]
    assert (entry.action, entry.about, entry.why, entry.who) == (
        "correct",
        history(desk, id_)[1].sequence,
        "misread",
        "Ada",
    )
    assert entry.cells == {"depth_mm": "2.25"}
    assert between(page, "field Depth under 40.5 N (mm) = '2.25' numeric")[1] == "[stored] corrected from 22.5"
    assert page.field("Depth under 20 N (mm)").value == "1.5"
    assert not any("field Why" in line for line in page.outline())
    assert "button Undo: corrected Depth (mm) 2.25 (misread)" in page.outline()


def test_a_correction_without_a_reason_is_refused(desk: Desk) -> None:
    id_ = begun(desk)
    page = asked_to_correct(desk, id_)
    page.fill("Why", "  ")
    form = page.field("Why").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 2, "once": "b"})
    assert status(page) == "[status bad] A correction needs a reason."
    assert page.scripts[-1] == "lab.answered(2, false)"
    assert "field Why = '  '" in page.outline()
    assert len(history(desk, id_)) == 2
    page.fill("Why", " slip ")
    page.fire(form, "keydown.enter", {"number": 3, "once": "c"})
    assert page.scripts[-1] == "lab.answered(3, true)"
    assert history(desk, id_)[-1].why == "slip"


@pytest.mark.parametrize("by_key", [True, False])
def test_a_depth_is_left_as_it_was(desk: Desk, by_key: bool) -> None:
    id_ = begun(desk)
    page = asked_to_correct(desk, id_)
    if by_key:
        page.fire(page.field("Why"), "keydown.esc", {})
    else:
        page.press("Leave it as it was")
    assert "field Depth under 40.5 N (mm) = '22.5' numeric" in page.outline()
    assert not any("field Why" in line for line in page.outline())
    assert page.focused() is page.field("Depth under 60 N (mm)")
    enter(page, "Depth under 40.5 N (mm)", "2,25")  # is asked again
    assert "field Why = 'typing error'" in page.outline()


def test_a_depth_that_is_left_with_another_number_asks_without_taking_the_focus(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "22.5"))
    page = series_page(desk, id_)
    leave(page, "Depth under 40.5 N (mm)", "2.25")
    assert "field Why = 'typing error'" in page.outline()
    assert page.focused() is page.field("Depth under 60 N (mm)")
    assert selected(page) == []
    why = page.field("Why")
    leave(page, "Depth under 40.5 N (mm)", "2.26")  # another number is another question
    assert "40.5 N: 22.5 mm becomes 2.26 mm." in page.outline()
    assert page.field("Why") is not why
    leave(page, "Depth under 20 N (mm)", "2.26")
    assert "20 N: 1.5 mm becomes 2.26 mm." in page.outline()


def test_what_is_no_depth_is_no_correction(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    name = "Depth under 20 N (mm)"
    enter(page, name, "", number=1)
    fault = "Depth (mm) is a number of 0 or more; it is blank"
    assert status(page) == f"[status bad] Not corrected: {fault}."
    assert f"field {name} = '' numeric ! {fault}" in page.outline()
    assert page.scripts[-1] == "lab.answered(1, false)"
    page.fill("Operator", "Bo")
    enter(page, "Depth under 60 N (mm)", "3")
    leave(page, name)
    assert status(page) == "[status good] Stored: 3 mm under 60 N."
    assert history(desk, id_)[-1].who == "Bo"


def test_a_correction_after_somebody_elses_is_refused(desk: Desk) -> None:
    id_ = begun(desk)
    page = asked_to_correct(desk, id_)
    first = history(desk, id_)[0].sequence
    cells = {"depth_mm": "1.6"}
    write(desk, id_, NewEntry(action="correct", file=PENETRATION, test="1", about=first, cells=cells, why="slip"))
    page.press("Correct it")
    assert status(page).startswith("[status bad] Nothing was stored: somebody wrote about Penetration, 1 meanwhile")
    assert depths(desk, id_) == [("20", "1.6"), ("40.5", "22.5")]
    assert "field Why = 'typing error'" in page.outline()
    page.press("Leave it as it was")
    assert "field Depth under 20 N (mm) = '1.6' numeric" in page.outline()
    enter(page, "Depth under 40.5 N (mm)", "2.25")
    page.press("Correct it")
    assert depths(desk, id_) == [("20", "1.6"), ("40.5", "2.25")]


# A series: undo, cancel, history


def test_a_series_is_cancelled_with_a_reason(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    page.press("Cancel this test")
    assert between(page, "Cancel 1? Its readings are kept but not included.", "button[main then] Next series") == [
        "Cancel 1? Its readings are kept but not included.",
        "field Why = ''",
        "button[main] Cancel the test",
        "button Leave it as it was",
    ]
    assert page.focused() is page.field("Why")
    assert selected(page) == []
    page.press("Leave it as it was")
    assert page.focused().text == "Cancel this test"
    assert not any("field Why" in line for line in page.outline())
    page.press("Cancel this test")
    page.press("Cancel the test")
    assert status(page) == "[status bad] A test is cancelled with a reason."
    page.fill("Why", " the tool  slipped ")
    button = next(each for each in page.of(ui.button) if each.text == "Cancel the test")
    page.fire(button, "click", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, true)"
    assert status(page) == "[status good] 1 is cancelled; its readings are kept."
    entry = history(desk, id_)[-1]
    assert (entry.action, entry.why, entry.who, entry.test) == ("cancel", "the tool slipped", "Ada", "1")
    page.shows("[quiet] Test 1")
    assert between(page, "h2 Series 1", "[quiet] Test 1") == [
        "h2 Series 1",
        "[quiet] A · ski piece · 30°",
        "[bad] Cancelled: the tool slipped",
        "[load] 20 N",
        "field Depth under 20 N (mm) = '1.5' numeric readonly",
        "[stored] stored",
        "[load] 40.5 N",
        "field Depth under 40.5 N (mm) = '' numeric readonly",
        "[load] 60 N",
        "field Depth under 60 N (mm) = '' numeric readonly",
        "button[main then] Next series",
        "Discs taken off one by one",
        "[load] 40.5 N",
        "field Depth back under 40.5 N (mm) = '' numeric readonly",
        "[load] 20 N",
        "field Depth back under 20 N (mm) = '' numeric readonly",
        "Depths read once more after waiting",
        "[load] 20 N",
        "field Depth after waiting under 20 N (mm) = '' numeric optional readonly",
        "[load] 40.5 N",
        "field Depth after waiting under 40.5 N (mm) = '' numeric optional readonly",
        "[load] 60 N",
        "field Depth after waiting under 60 N (mm) = '' numeric optional readonly",
    ]
    assert page.focused().text == "Next series"
    assert "A load that is not in the disc set" not in page.outline()
    assert between(page, "button Undo: cancelled (the tool slipped)", "h3 Series so far") == [
        "button Undo: cancelled (the tool slipped)",
        "History of 1",
        f"{minute_words(history(desk, id_)[0].at)} · Ada · entered 1.5 mm under 20 N",
        f"{minute_words(entry.at)} · Ada · cancelled (the tool slipped)",
    ]


def test_a_test_that_somebody_wrote_about_is_not_cancelled(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    page.press("Cancel this test")
    add_series(desk, id_, "1", ("60", "3"))
    page.fill("Why", "slip")
    button = next(each for each in page.of(ui.button) if each.text == "Cancel the test")
    page.fire(button, "click", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert status(page).startswith("[status bad] Nothing was stored")
    assert EditSession(desk.lab, id_).test(PENETRATION, "1").cancelled == ""


def test_the_last_entry_is_undone_and_stays_in_the_history(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    add_series(desk, id_, "1", ("60", "3"), who="")
    page = series_page(desk, id_)
    page.press("Undo: entered 3 mm under 60 N")
    assert status(page) == "[status good] Undone."
    first, second, undo = history(desk, id_)
    assert (undo.action, undo.about, undo.who) == ("undo", second.sequence, "Ada")
    assert "field Depth under 60 N (mm) = '' numeric" in page.outline()
    assert between(page, "button Undo: entered 1.5 mm under 20 N", "A load that is not in the disc set") == [
        "button Undo: entered 1.5 mm under 20 N",
        "button Cancel this test",
        "History of 1",
        f"{minute_words(first.at)} · Ada · entered 1.5 mm under 20 N",
        f"{minute_words(second.at)} · entered 3 mm under 60 N (undone)",
        f"{minute_words(undo.at)} · Ada · undid the entry before",
    ]
    assert page.focused() is page.field("Depth under 40.5 N (mm)")
    page.press("Undo: entered 1.5 mm under 20 N")
    assert depths(desk, id_) == []
    assert between(page, "h2 Series 1")[1] == "[quiet] A · ski piece · 30°"
    assert "button Cancel this test" not in page.outline()
    assert not any("button Undo" in line for line in page.outline())
    assert any("&site=A" in each for each in page.scripts)


def test_nothing_is_undone_where_nothing_was_entered(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    label = next(each for each in page.of(ui.label) if "status" in each.classes)
    view = TableView(EditSession(desk.lab, id_), PENETRATION, page.field("Operator"), label)
    assert not desk.do(lambda: view.undo(ReplayedTest(PENETRATION, "1")), page.client)
    assert status(page) == "[status bad] There is nothing to undo."
    assert history(desk, id_) == []


def test_what_somebody_else_undid_is_not_undone_again(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    sequence = history(desk, id_)[0].sequence
    write(desk, id_, NewEntry(action="undo", file=PENETRATION, test="1", about=sequence))
    button = next(each for each in page.of(ui.button) if each.text.startswith("Undo"))
    page.fire(button, "click", {})
    assert status(page).startswith("[status bad] Nothing was stored")
    page.press("Next series")
    assert "h2 New series" in page.outline()


# A series: the next one


def test_a_series_is_left_when_all_that_was_typed_is_stored(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    page.fill("Depth under 20 N (mm)", "x")
    page.fill("Depth back under 40.5 N (mm)", "2.5")
    button = next(each for each in page.of(ui.button) if each.text == "Next series")
    page.fire(button, "click", {"number": 1})
    assert status(page) == (
        "[status bad] Not stored yet: 20 N, 40.5 N on the way back. Put it right or empty the field, then go on."
    )
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert page.focused() is page.field("Depth under 20 N (mm)")
    assert selected(page) == [page.field("Depth under 20 N (mm)")]
    page.fill("Depth under 20 N (mm)", "")
    page.fill("Depth back under 40.5 N (mm)", "")
    page.fill("Depth after waiting under 40.5 N (mm)", "2.2")
    page.fill("Depth after waiting under 60 N (mm)", "2.7")
    page.fire(button, "click", {"number": 2})
    assert status(page) == (
        "[status bad] Not stored yet: 40.5 N after waiting, 60 N after waiting. Store it or empty the field, then go"
        " on."
    )
    assert page.scripts[-1] == "lab.answered(2, false)"
    assert page.focused() is page.field("Depth after waiting under 40.5 N (mm)")
    page.fill("Depth after waiting under 40.5 N (mm)", "")
    page.fill("Depth after waiting under 60 N (mm)", " ")
    page.fire(button, "click", {"number": 3})
    assert page.scripts[-1] == "lab.answered(3, true)"
    assert "field Name of the test = '1'" in page.outline()


def test_what_was_typed_in_one_series_does_not_go_into_the_next(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    enter(page, "Depth under 20 N (mm)", "1.5")
    page.press("Next series")
    page.press("Begin the series")
    assert between(page, "h2 Series 2")[1] == "[quiet] A · ski piece · 30°"
    assert page.field("Depth under 20 N (mm)").value == ""


# A series: read once more


def waited(page: Sheet, load: str, text: str) -> None:
    page.fill(f"Depth after waiting under {load} N (mm)", text)


def test_depths_after_waiting_are_stored_beside_the_first_ones(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    page = series_page(desk, id_)
    assert not is_open(page, "Depths read once more after waiting")
    waited(page, "40.5", "2,2")
    waited(page, "60", "2.7")
    page.press("Store what was read after waiting")
    assert status(page) == "[status good] Stored after waiting: 2.2 mm under 40.5 N, 2.7 mm under 60 N."
    rows = stored(desk, id_, PENETRATION, "1")
    assert [row.get("depth_after_mm", "") for row in rows] == ["", "2.2", "2.7"]
    assert [row["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6"]
    assert is_open(page, "Depths read once more after waiting")
    assert between(
        page, "field Depth after waiting under 40.5 N (mm) = '2.2' numeric optional", "button Store what was read after"
        " waiting"
    ) == [
        "field Depth after waiting under 40.5 N (mm) = '2.2' numeric optional",
        "[stored] stored",
        "[load] 60 N",
        "field Depth after waiting under 60 N (mm) = '2.7' numeric optional",
        "[stored] stored",
    ]  # fmt: skip
    assert reading_row(page, "Depth after waiting under 40.5 N (mm)").props["data-stored"] == "2.2"
    assert "data-stored" not in reading_row(page, "Depth after waiting under 20 N (mm)").props
    assert "button Undo: read once more after waiting: 2.7 mm" in page.outline()
    page.shows("Under one load the depth grew")
    page.press("Store what was read after waiting")
    assert status(page) == "[status good] Nothing is different."
    page.press("Next series")
    assert "h2 New series" in page.outline()


def test_a_second_depth_that_becomes_another_one_asks_for_a_reason(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(
        desk,
        id_,
        "1",
        (
            "20",
            "1.5",
        ),
        ("60", "2.6"),
        depth_after_mm="2.7",
    )
    page = series_page(desk, id_)
    waited(page, "20", "2.8")
    waited(page, "60", "")
    form = page.field("Depth after waiting under 20 N (mm)").parent_slot.parent.parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1, "once": "a"})
    assert page.scripts[-1] == "lab.answered(1, true)"
    words = "after waiting under 20 N: 2.7 mm becomes 2.8 mm; after waiting under 60 N: 2.7 mm becomes nothing."
    assert between(page, words, "button[main then] Next series") == [
        words,
        "field Why = 'typing error'",
        "button[main] Correct it",
        "button Leave it as it was",
    ]
    page.fill("Why", "")
    page.press("Correct it")
    assert status(page) == "[status bad] A correction needs a reason."
    page.fill("Why", "slip")
    button = next(each for each in page.of(ui.button) if each.text == "Correct it")
    page.fire(button, "click", {"number": 2})
    assert page.scripts[-1] == "lab.answered(2, true)"
    assert status(page) == "[status good] Corrected; the first reading is kept."
    assert [row["depth_after_mm"] for row in stored(desk, id_, PENETRATION, "1")] == ["2.8", ""]
    assert [entry.why for entry in history(desk, id_)[2:]] == ["slip", "slip"]
    assert not any("field Why" in line for line in page.outline())


def test_a_second_depth_is_left_as_it_was(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), depth_after_mm="1.7")
    page = series_page(desk, id_)
    waited(page, "20", "1.8")
    page.press("Store what was read after waiting")
    page.press("Leave it as it was")
    assert "field Why" not in " ".join(page.outline())
    assert "field Depth after waiting under 20 N (mm) = '1.8' numeric optional" in page.outline()
    assert len(history(desk, id_)) == 1


def test_new_and_other_second_depths_at_once(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), depth_after_mm="1.7")
    add_series(desk, id_, "1", ("60", "2.6"))
    page = series_page(desk, id_)
    waited(page, "20", "1.8")
    waited(page, "60", "2.9")
    page.press("Store what was read after waiting")
    assert status(page) == "[status good] Stored after waiting: 2.9 mm under 60 N."
    assert "after waiting under 20 N: 1.7 mm becomes 1.8 mm." in page.outline()
    assert [row.get("depth_after_mm", "") for row in stored(desk, id_, PENETRATION, "1")] == ["1.7", "2.9"]


def test_a_second_depth_without_a_first_one_and_what_is_no_depth_are_refused(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"))
    page = series_page(desk, id_)
    waited(page, "20", "1.7")
    waited(page, "40.5", "x")
    waited(page, "60", "2.7")
    button = next(each for each in page.of(ui.button) if each.text == "Store what was read after waiting")
    page.fire(button, "click", {"number": 1})
    faults = [
        "Depth after waiting (mm) is a number of 0 or more; 'x' stands there",
        "the first depth under 60 N comes before it",
    ]
    assert status(page) == f"[status bad] Not stored: {'; '.join(faults)}."
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert f"field Depth after waiting under 60 N (mm) = '2.7' numeric optional ! {faults[1]}" in page.outline()
    assert "field Depth after waiting under 20 N (mm) = '1.7' numeric optional" in page.outline()
    assert len(history(desk, id_)) == 2


def test_a_second_depth_after_somebody_elses_entry_is_not_stored(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    waited(page, "20", "1.7")
    add_series(desk, id_, "1", ("60", "2.6"))
    button = next(each for each in page.of(ui.button) if each.text == "Store what was read after waiting")
    page.fire(button, "click", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert status(page).startswith("[status bad] Nothing was stored")
    assert "depth_after_mm" not in stored(desk, id_, PENETRATION, "1")[0]


# Readings that the browser kept


def record(**further: object) -> dict[str, object]:
    cells = {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1,5", "branch": ""}
    return {"once": "a", "who": "Bo", "cells": cells} | further


def resent(page: Sheet, records: object) -> list[list[str]]:
    """What the browser is answered."""
    page.fire(page.client.layout, "resent", records)
    (told,) = (each for each in page.scripts if each.startswith("lab.resent("))
    page.scripts.remove(told)
    answers: list[list[str]] = json.loads(told.removeprefix("lab.resent(").removesuffix(")"))
    return answers


def test_readings_that_the_browser_kept_are_stored_once(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    assert resent(page, [record()]) == [["a", ""]]
    assert resent(page, [record()]) == [["a", ""]]
    (entry,) = history(desk, id_)
    assert (entry.who, entry.once, entry.position, entry.test) == ("Bo", "a", 0, "1")
    assert entry.cells == {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1.5"}
    assert "field Depth under 20 N (mm) = '1.5' numeric" in page.outline()
    back = record(once="b", who="x" * 201)
    back["cells"] = {**record()["cells"], "branch": "unloading"}  # type: ignore[dict-item]
    assert resent(page, [back]) == [["b", ""]]
    entry = history(desk, id_)[-1]
    assert (entry.cells["branch"], len(entry.who), entry.position) == ("unloading", 200, 1)


def test_a_kept_reading_of_another_series_changes_nothing_that_is_shown(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}")
    page.fill("Site", "typed")
    assert resent(page, [record()]) == [["a", ""]]
    assert page.field("Site").value == "typed"
    shear = desk.open(f"/enter/{id_}?table=shear.csv")
    again = record(once="b", cells={**record()["cells"], "load_N": "60", "depth_mm": "3"})  # type: ignore[dict-item]
    assert resent(shear, [again]) == [["b", ""]]
    assert depths(desk, id_) == [("20", "1.5"), ("60", "3")]


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"tool": "lost"}, "the campaign has no tool 'lost'"),
        ({"load_N": "60.0"}, "a reading of 2.6 mm is there already"),
        ({"site": "B"}, "that series is at the site A"),
        ({"depth_mm": "x"}, "depth_mm is a number of 0 or more; 'x' stands there"),
    ],
)
def test_a_kept_reading_that_cannot_be_stored_is_said_in_full(desk: Desk, changed: dict[str, str], why: str) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("60", "2.6"))
    cells = {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1.5"} | changed
    found = resent(series_page(desk, id_), [record(cells=cells)])
    words = f"{cells['depth_mm']} mm under {cells['load_N']} N in series 1"
    assert found == [["a", f"Not stored: {words}: {why}."]]
    assert len(history(desk, id_)) == 1


@pytest.mark.parametrize(
    ("said", "once", "words"),
    [
        ("nothing", "", "a reading"),
        ({"once": "a"}, "a", "a reading"),
        ({"once": "a", "cells": []}, "a", "a reading"),
        (record(once=""), "", "1,5 mm under 20 N in series 1"),
        (record(once=7), "", "1,5 mm under 20 N in series 1"),
        (record(once="x" * 201), "", "1,5 mm under 20 N in series 1"),
    ],
)
def test_what_is_no_kept_reading_is_refused(desk: Desk, said: object, once: str, words: str) -> None:
    id_ = begun(desk)
    assert resent(begun_series(desk, id_), [said]) == [[once, f"Not stored: {words}: this is no reading."]]
    assert history(desk, id_) == []


def test_what_is_no_list_of_readings_is_answered_with_nothing(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    assert resent(page, {"once": "a"}) == []
    assert resent(page, [record(once="x" * 200)]) == [["x" * 200, ""]]


def test_only_so_many_readings_are_taken_at_once(desk: Desk) -> None:
    page = begun_series(desk, begun(desk))
    assert len(resent(page, [0] * 10_001)) == 10_000


# Tests of one row


def store(page: Sheet, **typed: str) -> None:
    for name, text in typed.items():
        page.fill(NAMES[name], text)
    page.press("Store")


NAMES = {
    "name": "Name of the test",
    "site": "Site",
    "angle": "Edge angle (°)",
    "turning": "Turning angle (°)",
    "depth": "Depth (mm)",
    "arm": "Lever arm (mm)",
    "moment": "Moment (N m)",
    "density": "Density (kg/m³)",
    "cone": "Drop-cone depth (mm)",
    "repeat": "Repeat",
    "spot": "Measurement point",
    "plate": "Plate",
}


def test_a_shear_test_is_asked_for_and_stored(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    assert page.outline() == [
        *head(id_),
        "h2 New test",
        "field Name of the test = '1'",
        "field Site = ''",
        "field Plate = 'blade'",
        "field Measurement point = '' optional",
        "field Turning angle (°) = '' numeric optional",
        "field Edge angle (°) = '' numeric",
        "field Depth (mm) = '' numeric",
        "field Lever arm (mm) = '' numeric",
        "field Moment (N m) = '' numeric",
        "button[main] Store",
    ]
    assert page.focused() is page.field("Site")
    assert [each.text for each in page.tagged("nicegui-link") if "aria-current" in each.props][1:] == ["Shear"]
    store(page, site="A", plate="plate", angle="90", depth="6", arm="250", moment="30,0")
    assert status(page) == "[status good] Stored: test 1."
    (entry,) = history(desk, id_)
    assert (entry.file, entry.test, entry.position, entry.who) == (SHEAR, "1", 0, "Ada")
    assert entry.cells == {"experiment": "1", **SHEARED, "moment_Nm": "30.0"}
    # 30 N m / 0.25 m / (100 mm × 6 mm), by hand
    assert page.shows("S_f = ").startswith("[value] S_f = 0.200 N/mm²")
    assert "[quiet] Test 1" in page.outline()
    assert page.charts() == {}
    assert between(page, "h2 New test", "[quiet] Test 1") == [
        "h2 New test",
        "field Name of the test = '2'",
        "field Site = 'A'",
        "field Plate = 'plate'",
        "field Measurement point = '' optional",
        "field Turning angle (°) = '' numeric optional",
        "field Edge angle (°) = '90' numeric",
        "field Depth (mm) = '' numeric",
        "field Lever arm (mm) = '250' numeric",
        "field Moment (N m) = '' numeric",
        "button[main] Store",
    ]
    assert page.focused() is page.field("Depth (mm)")
    assert between(page, "h3 So far") == [
        "h3 So far",
        "Name of the test 1 · Site A · Plate plate · Edge angle (°) 90 · Depth (mm) 6 · Lever arm (mm) 250 · "
        "Moment (N m) 30.0",
        "button[small] Correct",
    ]
    (button,) = (each for each in page.of(ui.button) if each.text == "Correct")
    assert button.props["aria-label"] == "Correct 1"


def test_enter_stores_a_test_of_one_row_too(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}?table=density.csv")
    page.fill("Site", "A")
    form = page.field("Site").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1, "once": "a"})
    assert status(page).startswith("[status bad] Not stored: Density (kg/m³) is a number above 0")
    assert status(page).endswith("; it is blank.")
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert page.shows("field Density").startswith(
        "field Density (kg/m³) = '' numeric ! Density (kg/m³) is a number above 0"
    )
    page.fill("Density (kg/m³)", "350")
    page.fire(form, "keydown.enter", {"number": 2, "once": "b"})
    assert page.scripts[-1] == "lab.answered(2, true)"
    assert stored(desk, id_, DENSITY, "1") == [{"sample": "1", "site": "A", "snow_density_kg_per_m3": "350"}]
    assert between(page, "h3 So far")[1] == "Name of the sample 1 · Site A · Density (kg/m³) 350"


def test_a_test_that_was_sent_before_is_stored_once_and_answered_as_then(desk: Desk) -> None:
    id_ = begun(desk)
    for _ in range(2):
        page = desk.open(f"/enter/{id_}?table=density.csv")
        page.fill("Name of the sample", "s")
        page.fill("Site", "A")
        page.fill("Density (kg/m³)", "350")
        button = next(each for each in page.of(ui.button) if each.text == "Store")
        page.fire(button, "click", {"number": 1, "once": "a"})
        assert page.scripts[-1] == "lab.answered(1, true)"
        assert status(page) == "[status good] Stored: test s."
    assert len(history(desk, id_)) == 1


def test_a_name_that_is_taken_is_refused(desk: Desk) -> None:
    id_ = begun(desk)
    add_shear(desk, id_, "1")
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    page.fill("Name of the test", "1")
    page.fill("Depth (mm)", "6")
    page.fill("Moment (N m)", "20")
    button = next(each for each in page.of(ui.button) if each.text == "Store")
    page.fire(button, "click", {"number": 1, "once": "a"})
    fault = "there is a test 1 already; give this one another name"
    assert status(page) == f"[status bad] Not stored: {fault}."
    assert f"field Name of the test = '1' ! {fault}" in page.outline()
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert len(history(desk, id_)) == 1


def test_a_test_that_somebody_else_entered_meanwhile_is_not_stored(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    add_shear(desk, id_, "1")
    for name, text in (("site", "A"), ("angle", "90"), ("depth", "6"), ("arm", "250"), ("moment", "30")):
        page.fill(NAMES[name], text)
    button = next(each for each in page.of(ui.button) if each.text == "Store")
    page.fire(button, "click", {"number": 1, "once": "a"})
    assert status(page).startswith("[status bad] Nothing was stored: Ada wrote about Shear, 1 meanwhile")
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert page.field("Moment (N m)").value == "30"


def test_the_next_repeat_of_a_cone_is_asked_for(desk: Desk) -> None:
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}?table=drop_cone.csv")
    store(page, name="c", site="A", cone="12")
    assert stored(desk, id_, DROP_CONE, "c") == [{"test": "c", "site": "A", "repeat": "1", "drop_cone_depth_mm": "12"}]
    assert between(page, "h2 New test", "button[main] Store") == [
        "h2 New test",
        "field Name of the test = 'c'",
        "field Site = 'A'",
        "field Repeat = '2'",
        "field Drop-cone depth (mm) = '' numeric",
    ]
    store(page, cone="13")
    assert [entry.position for entry in history(desk, id_)] == [0, 1]
    assert between(page, "h3 So far")[1::2] == [
        "Name of the test c · Site A · Repeat 2 · Drop-cone depth (mm) 13",
        "Name of the test c · Site A · Repeat 1 · Drop-cone depth (mm) 12",
    ]
    store(page, repeat="2", cone="14")
    assert status(page) == "[status bad] Not stored: test c has a repeat 2 already."


def test_the_next_turning_angle_is_asked_for(desk: Desk) -> None:
    """30 N m/0.25 m/(100 mm × 6 mm) = 0.2 N/mm²."""
    id_ = begun(desk)
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    store(page, site="A", plate="plate", turning="0", angle="90", depth="6", arm="250", moment="5")
    assert between(page, "h2 New test", "button[main] Store") == [
        "h2 New test",
        "field Name of the test = '1'",
        "field Site = 'A'",
        "field Plate = 'plate'",
        "field Measurement point = '' optional",
        "field Turning angle (°) = '' numeric optional",
        "field Edge angle (°) = '90' numeric",
        "field Depth (mm) = '6' numeric",
        "field Lever arm (mm) = '250' numeric",
        "field Moment (N m) = '' numeric",
    ]
    assert page.focused() is page.field("Turning angle (°)")
    for angle, moment in (("1", "15"), ("2", "25"), ("3", "30")):
        store(page, turning=angle, moment=moment)
    line = page.shows("u_y = 13.1 mm")  # 30/20 × 2° × 250 mm: 20 N m take 2°
    assert line.startswith("[value] S_f = 0.200 N/mm²") and "; u_y = " in line
    assert [row["turning_angle_deg"] for row in stored(desk, id_, SHEAR, "1")] == ["0", "1", "2", "3"]
    store(page, turning="4", depth="7", moment="30")
    assert status(page) == "[status bad] Not stored: the rows of test 1 have one Depth (mm)."


def test_a_campaign_without_a_plate_says_where_to_name_one(desk: Desk) -> None:
    id_ = begun(desk, 'name = "Bare"\n')
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    assert between(page, "field Site = ''")[1:3] == [
        "[bad] This campaign has no plate yet: name one under Campaign.",
        "field Plate = None",
    ]
    assert "no plate yet" not in " ".join(desk.open(f"/enter/{begun(desk)}?table=shear.csv").outline())


def test_a_test_of_one_row_is_corrected_with_a_reason(desk: Desk) -> None:
    id_ = begun(desk)
    add_shear(desk, id_, "1")
    page = desk.open(f"/enter/{id_}?table=shear.csv&test=1")
    assert between(page, "h2 Correct a test", "button New test") == [
        "h2 Correct a test",
        "field Name of the test = '1' readonly",
        "field Site = 'A'",
        "field Plate = 'plate'",
        "field Measurement point = '' optional",
        "field Turning angle (°) = '' numeric optional",
        "field Edge angle (°) = '90' numeric",
        "field Depth (mm) = '6' numeric",
        "field Lever arm (mm) = '250' numeric",
        "field Moment (N m) = '30' numeric",
        "button[main] Correct",
    ]
    page.shows("S_f = 0.200 N/mm²")
    entry = history(desk, id_)[0]
    assert between(page, "button Undo: entered Edge angle (°) 90, Depth (mm) 6, Lever arm (mm) 250, Moment (N m) 30")[
        :5
    ] == [
        "button Undo: entered Edge angle (°) 90, Depth (mm) 6, Lever arm (mm) 250, Moment (N m) 30",
        "button Cancel this test",
        "History of 1",
        f"{minute_words(entry.at)} · Ada · entered Edge angle (°) 90, Depth (mm) 6, Lever arm (mm) 250, "
        "Moment (N m) 30",
        "h3 So far",
    ]
    page.press("Correct")
    assert status(page) == "[status good] Nothing is different."
    page.fill("Moment (N m)", "x")
    form = page.field("Site").parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, false)"
    page.fill("Moment (N m)", "36")
    page.fill("Measurement point", "p")
    page.press("Correct")
    words = "Measurement point: nothing becomes p; Moment (N m): 30 becomes 36."
    assert between(page, words, "button New test") == [
        words,
        "field Why = 'typing error'",
        "button[main] Correct it",
        "button Leave it as it was",
        "button[main] Correct",
    ]
    page.press("Leave it as it was")
    assert page.field("Moment (N m)").value == "36"
    page.fire(form, "keydown.enter", {"number": 2})
    assert page.scripts[-1] == "lab.answered(2, true)"
    page.fill("Why", "")
    button = next(each for each in page.of(ui.button) if each.text == "Correct it")
    page.fire(button, "click", {"number": 9})
    assert page.scripts[-1] == "lab.answered(9, false)"
    assert status(page) == "[status bad] A correction needs a reason."
    page.fill("Why", "misread")
    page.fire(button, "click", {"number": 3})
    assert page.scripts[-1] == "lab.answered(3, true)"
    correction = history(desk, id_)[-1]
    assert (correction.about, correction.why) == (entry.sequence, "misread")
    assert correction.cells == {"spot": "p", "moment_Nm": "36"}
    page.shows("S_f = 0.240 N/mm²")
    assert "field Moment (N m) = '36' numeric" in page.outline()
    assert "h2 Correct a test" in page.outline()


def test_a_new_test_that_was_begun_is_there_again_after_another_one_was_looked_at(desk: Desk) -> None:
    id_ = begun(desk)
    add_shear(desk, id_, "1")
    add_shear(desk, id_, "2", depth_mm="8", moment_Nm="36")
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    page.fill("Depth (mm)", "7")
    page.press("Correct 1")
    assert between(page, "h2 Correct a test")[1] == "field Name of the test = '1' readonly"
    page.shows("[quiet] Test 1")
    page.press("Correct 2")
    page.press("New test")
    assert page.field("Depth (mm)").value == "7"
    assert page.field("Name of the test").value == "3"
    assert "readonly" not in page.field("Name of the test").props
    assert not any("button Undo" in line for line in page.outline())
    store(page, moment="20")
    assert page.field("Depth (mm)").value == ""
    page.press("Correct 3")
    page.press("New test")
    assert page.field("Name of the test").value == "4"


def test_a_form_without_anything_typed_is_filled_in_anew(desk: Desk) -> None:
    id_ = begun(desk)
    add_shear(desk, id_, "1")
    page = desk.open(f"/enter/{id_}?table=shear.csv")
    page.press("Correct 1")
    add_shear(desk, id_, "2", site="B")
    page.fill("Site", "C")
    page.press("Correct")
    page.press("Correct it")
    page.press("New test")
    assert (page.field("Name of the test").value, page.field("Site").value) == ("3", "B")


def test_a_cancelled_test_of_one_row_says_so(desk: Desk) -> None:
    id_ = begun(desk)
    add_shear(desk, id_, "1")
    page = desk.open(f"/enter/{id_}?table=shear.csv&test=1")
    page.press("Cancel this test")
    page.fill("Why", "slip")
    page.press("Cancel the test")
    assert between(page, "h2 Correct a test")[1] == "[bad] Cancelled: slip"
    assert page.shows("Name of the test 1 · ").endswith("Moment (N m) 30 · cancelled: slip")
    page.press("Undo: cancelled (slip)")
    page.press("Undo: entered Edge angle (°) 90, Depth (mm) 6, Lever arm (mm) 250, Moment (N m) 30")
    assert "h2 New test" in page.outline()
    assert "h3 So far" not in page.outline()


def test_the_last_thirty_tests_stand_so_far(desk: Desk) -> None:
    id_ = begun(desk)
    for number in range(31):
        add(desk, id_, DENSITY, f"n{number}", sample=f"n{number}", site="A", snow_density_kg_per_m3="350")
    lines = between(desk.open(f"/enter/{id_}?table=density.csv"), "h3 So far")[1::2]
    assert [lines[0], lines[-1], len(lines)] == [
        "Name of the sample n30 · Site A · Density (kg/m³) 350",
        "Name of the sample n1 · Site A · Density (kg/m³) 350",
        30,
    ]


# What the readings say, beside the form


def curve(name: str, *, law: bool = True) -> SeriesCurve:
    at = float(len(name))
    return SeriesCurve(name, (at, at + 1), (10 * at, 10 * at + 1), (0.0, at) if law else (), (0.0, at) if law else ())


def found(**curves: SeriesCurve) -> QuickResults:
    row = {"H_V_N_per_mm3": 0.25, "H_V_interval_N_per_mm3": None, "n_unloading": 0}
    flags = {"penetration.csv/a": {"too_few_loads": "few", "poor_fit": "the depth_mm is odd"}}
    return QuickResults(penetration=dict.fromkeys(curves, row), shear={}, curves=curves, flags=flags)


def beside(page: Sheet, answer: Callable[[str], QuickResults]) -> Beside:
    """What follows the readings, on a page of its own."""
    view: Any = SimpleNamespace(file=PENETRATION, session=SimpleNamespace(quick_results=answer))

    def made() -> Beside:
        with page.content:
            return Beside(view)

    return page.desk.do(made, page.client)


def test_a_series_stands_before_all_others_of_its_site(desk: Desk) -> None:
    page = desk.open("/")
    made = beside(page, lambda _: found(a=curve("a"), bb=curve("bb"), ccc=curve("ccc", law=False)))
    desk.do(lambda: made.follow("a", "A"), page.client)
    assert page.shows("H_V = ") == "[value] H_V = 0.250 N/mm³, interval not known"
    lines = [{key: line[key] for key in ("x", "y", "style", "points")} for line in page.charts()["Load (N)"]["lines"]]
    assert lines == [
        {"x": [2, 3, 3, 4], "y": [20, 21, 30, 31], "style": BEHIND, "points": True},
        {"x": [0, 2, None, None], "y": [0, 2, None, None], "style": BEHIND, "points": False},
        {"x": [1, 2], "y": [10, 11], "style": 0, "points": True},
        {"x": [0, 1, None], "y": [0, 1, None], "style": 0, "points": False},
    ]
    assert between(page, "[quiet] Test a")[:4] == [
        "[quiet] Test a",
        "[value] H_V = 0.250 N/mm³, interval not known",
        "few",
        "the Depth (mm) is odd",
    ]
    assert [each.tag for each in page.of() if getattr(each, "text", "") == "few"] == ["div"]
    desk.do(lambda: made.follow("a", "A", in_progress=True), page.client)
    page.until(lambda: "few" not in page.outline())
    assert "the Depth (mm) is odd" in page.outline()
    desk.do(lambda: made.follow("z", "A"), page.client)  # has no row and no curve
    page.until(lambda: "[quiet] Test a" not in page.outline())
    assert not any("H_V" in line for line in page.outline())
    assert [line["style"] for line in page.charts()["Load (N)"]["lines"]] == [BEHIND, BEHIND]


def test_only_the_last_of_several_tests_is_shown(desk: Desk) -> None:
    page = desk.open("/")
    asked: list[str] = []
    shown: list[str] = []
    goes_on = threading.Event()

    def answer(site: str) -> QuickResults:
        asked.append(site)
        assert goes_on.wait(60)
        shown.extend(line for line in page.outline() if line.startswith("[quiet] Test "))
        return found(**{site: curve(site)})

    made = beside(page, answer)
    for site in ("a", "bb", "ccc"):
        desk.do(partial(made.follow, site, site), page.client)
        page.until(lambda: asked)
    goes_on.set()
    page.shows("[quiet] Test ccc")
    assert asked == ["a", "ccc"]
    assert shown == []
    desk.do(lambda: made.follow("a", "a"), page.client)
    page.shows("[quiet] Test a")


def test_nothing_is_shown_when_the_lab_is_being_closed(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    page = desk.open("/")
    asked: list[str] = []

    async def nothing(_act: object, site: str) -> None:
        asked.append(site)

    monkeypatch.setattr("skisnow.web.entry.beside.run.io_bound", nothing)
    made = beside(page, lambda _: found())
    desk.do(lambda: made.follow("a", "A"), page.client)
    page.until(lambda: asked and not made._working)
    assert not any("Test" in line or "H_V" in line for line in page.outline())


def test_what_follows_a_series_stands_beside_it_and_of_other_tests_above(desk: Desk) -> None:
    id_ = begun(desk)
    for table, classes in ((PENETRATION, ["beside"]), (SHEAR, ["beside", "above"])):
        page = desk.open(f"/enter/{id_}?table={table}")
        (section,) = (each for each in page.tagged("section") if "beside" in each.classes)
        assert section.classes == classes


def test_what_cannot_be_computed_is_said_and_the_next_one_is_shown(desk: Desk) -> None:
    page = desk.open("/")

    def answer(site: str) -> QuickResults:
        if site == "lost":
            raise StoreError("The store is away.")
        return found(a=curve("a"))

    made = beside(page, answer)
    desk.do(lambda: made.follow("a", "lost"), page.client)
    assert page.shows("The store") == "[value] The store is away."
    desk.do(lambda: made.follow("a", "A"), page.client)
    page.shows("[quiet] Test a")


# What the browser is answered


def answered(desk: Desk, act: Callable[[], bool | None], *said: object) -> tuple[list[str], list[PageRequest]]:
    """What a page tells the browser after each of these, and what stands as asked after it."""
    page = desk.open("/")
    page.scripts.clear()
    after = []

    def done() -> None:
        handler = answering.answering(act)
        for each in said:
            handler(SimpleNamespace(args=each))  # type: ignore[arg-type]
            after.append(answering.asked())

    desk.do(done, page.client)
    return page.scripts, after


@pytest.mark.parametrize(("result", "word"), [(None, "true"), (True, "true"), (False, "false")])
def test_a_question_is_done_once_and_answered_each_time(desk: Desk, result: bool | None, word: str) -> None:
    done: list[PageRequest] = []

    def act() -> bool | None:
        done.append(answering.asked())
        return result

    asked = {"number": 3, "once": "a", "text": "1.5"}
    scripts, after = answered(desk, act, asked, asked, asked | {"number": 4})
    assert scripts == [f"lab.answered(3, {word})"] * 2 + [f"lab.answered(4, {word})"]
    assert done == [PageRequest(3, "a", "1.5"), PageRequest(4, "a", "1.5")]
    assert after == [PageRequest()] * 3


@pytest.mark.parametrize(
    ("said", "taken", "told"),
    [
        (None, PageRequest(), []),
        ([3], PageRequest(), []),
        ({"number": "3", "once": 7, "text": 1.5}, PageRequest(), []),
        ({"once": 'a"b'}, PageRequest(once='a"b'), ['lab.told("a\\"b")']),
        ({"once": "x" * 200}, PageRequest(once="x" * 200), [f'lab.told("{"x" * 200}")']),
        ({"once": "x" * 201, "text": ""}, PageRequest(text=""), []),
        ({"number": 0}, PageRequest(number=0), ["lab.answered(0, true)"]),
    ],
)
def test_what_the_browser_says_is_taken_as_far_as_it_is_expected(
    desk: Desk, said: object, taken: PageRequest, told: list[str]
) -> None:
    done: list[PageRequest] = []
    assert answered(desk, lambda: done.append(answering.asked()), said)[0] == told
    assert done == [taken]


def test_an_act_that_fails_is_answered_with_no(desk: Desk) -> None:
    page = desk.open("/")

    def act() -> None:
        raise ZeroDivisionError

    def done() -> None:
        answering.answering(act)(SimpleNamespace(args={"number": 3}))  # type: ignore[arg-type]

    page.scripts.clear()
    with pytest.raises(ZeroDivisionError):
        desk.do(done, page.client)
    desk.do(done, page.client)  # is answered, and not done again
    assert page.scripts == ["lab.answered(3, false)"] * 2


def test_buttons_and_forms_ask_in_the_browser(desk: Desk) -> None:
    page = desk.open("/")

    def made() -> list[Any]:
        with page.content:
            plain, sending = answering.form(), answering.form("a b", sends=lambda: None)
            menu = ui.select(["a", "b"], value="a")
            return [plain, sending, answering.row_button("Row", lambda: None), menu, answering.redrawn_by(menu)]

    plain, sending, row, menu, group = desk.do(made, page.client)
    by_event = [
        {each.type: each.js_handler for each in one._event_listeners.values() if each.js_handler}
        for one in (plain, sending, row, menu)
    ]
    assert by_event[:3] == [
        {"keydown.enter": answering.ONWARD},
        {"keydown.enter": answering.ENTER},
        {"click": answering.ASK_FOR_ROW},
    ]
    assert answering.DRAW_ANEW in by_event[3].values()
    assert (plain.classes, sending.classes) == (["fields"], ["a", "b"])
    assert (row.classes, row.text) == (["act", "adds"], "Row")
    assert (group.tag, group.classes) == ("fieldset", ["redrawn"])
    page.fire(menu, "update:modelValue", {"value": 1, "label": "b"})
    assert page.scripts[-1] == "lab.drawn()"
    desk.do(lambda: answering.go_on('/a"b'), page.client)
    assert page.scripts[-1] == 'lab.leave("/a\\"b")'


# A campaign as a page sees it


def test_a_session_hears_what_others_wrote_when_it_looks_again(desk: Desk) -> None:
    id_ = begun(desk)
    session = EditSession(desk.lab, id_)
    add_series(desk, id_, "1", ("20", "1.5"), ("60", "2.6"))
    assert session.campaign.tests == {}
    for _ in range(2):
        session.refresh()
        assert [entry.cells["load_N"] for entry in session.test(PENETRATION, "1").history] == ["20", "60"]
    add_series(desk, id_, "1", ("40.5", "2.1"))
    session.refresh()
    assert len(session.test(PENETRATION, "1").history) == 3
    entry = NewEntry(action="undo", file=PENETRATION, test="1", about=history(desk, id_)[2].sequence)
    written = session.write_down(entry, seen=history(desk, id_)[2].sequence)
    assert written == history(desk, id_)[3]
    assert len(session.test(PENETRATION, "1").rows) == 2


def test_a_session_computes_a_site_by_itself(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    add_series(desk, id_, "2", ("20", "1.5"), site="B")
    add_shear(desk, id_, "s")
    add(desk, id_, DENSITY, "d", sample="d", site="A", snow_density_kg_per_m3="350")
    gone = add(desk, id_, DENSITY, "e", sample="e", site="A", snow_density_kg_per_m3="350")
    write(desk, id_, NewEntry(action="undo", file=DENSITY, test="e", about=gone.sequence))
    session = EditSession(desk.lab, id_)
    assert [test.name for test in session.tests_of_site("A")] == ["1", "s", "d"]
    results = session.quick_results("A")
    assert (list(results.penetration), list(results.shear), list(results.curves)) == (["1"], ["s"], ["1"])
    assert list(session.quick_results("B").curves) == ["2"]
    assert "too_few_loads" in session.quick_results("B").flags["penetration.csv/2"]
    for repeat, site in (("1", "A"), ("2", "B")):
        add(desk, id_, DROP_CONE, "c", test="c", site=site, repeat=repeat, drop_cone_depth_mm="12")
    session.refresh()
    assert [test.name for test in session.tests_of_site("B")] == ["2"]  # a test is where its first row is
