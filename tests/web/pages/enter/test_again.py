"""Readings that come once more: after waiting, and from a browser that kept them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from nicegui import ui

from .shared import (
    PENETRATION,
    READ_AGAIN,
    SERIES,
    STORE_WAITED,
    add_series,
    after_waiting,
    begun,
    begun_series,
    depths,
    history,
    is_open,
    reading_row,
    series_page,
    stored,
    undo_button,
)

if TYPE_CHECKING:
    from ..desk import Desk, Sheet


def waited(page: Sheet, load: str, text: str) -> None:
    page.fill(after_waiting(load), text)


def test_depths_after_waiting_are_stored_beside_the_first_ones(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    page = series_page(desk, id_)
    assert not is_open(page, READ_AGAIN)
    waited(page, "40.5", "2,2")
    waited(page, "60", "2.7")
    page.press(STORE_WAITED)
    assert page.outcome() == "good"
    rows = stored(desk, id_, PENETRATION, "1")
    assert [row.get("depth_after_mm", "") for row in rows] == ["", "2.2", "2.7"]
    assert [row["depth_mm"] for row in rows] == ["1.5", "2.15", "2.6"]
    assert is_open(page, READ_AGAIN)
    assert [page.field(after_waiting(load)).value for load in ("40.5", "60")] == ["2.2", "2.7"]
    assert reading_row(page, after_waiting("40.5")).props["data-stored"] == "2.2"
    assert "data-stored" not in reading_row(page, after_waiting("20")).props
    assert "2.7 mm" in undo_button(page)
    page.shows("Under one load the depth grew")
    page.press(STORE_WAITED)
    assert page.outcome() == "good"
    page.press("Next series")
    assert "h2 New series" in page.outline()


def test_a_depth_after_waiting_stands_with_the_decimal_mark_of_the_page(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_, language="de")
    name = "Tiefe nach dem Warten unter 20 N (mm)"
    page.fill(name, "1,75")
    page.press("Nach dem Warten Abgelesenes speichern")
    page.shows("Stored after waiting: ")
    assert page.field(name).value == "1,75"
    page.press("Nach dem Warten Abgelesenes speichern")
    page.shows("Nothing is different.")


def test_a_second_depth_that_becomes_another_one_asks_for_a_reason(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("60", "2.6"), depth_after_mm="2.7")
    page = series_page(desk, id_)
    waited(page, "20", "2.8")
    waited(page, "60", "")
    form = page.field(after_waiting("20")).parent_slot.parent.parent_slot.parent
    page.fire(form, "keydown.enter", {"number": 1, "once": "a"})
    assert page.scripts[-1] == "lab.answered(1, true)"
    first, second = (
        "After waiting under 20 N: 2.7 mm becomes 2.8 mm.",
        "After waiting under 60 N: 2.7 mm becomes nothing.",
    )
    assert {first, second} <= set(page.outline())
    assert page.field("Why").value == "typing error"
    page.fill("Why", "")
    page.press("Correct it")
    assert page.outcome() == "bad"
    page.fill("Why", "slip")
    button = next(each for each in page.of(ui.button) if each.text == "Correct it")
    page.fire(button, "click", {"number": 2})
    assert page.scripts[-1] == "lab.answered(2, true)"
    assert page.outcome() == "good"
    assert [row["depth_after_mm"] for row in stored(desk, id_, PENETRATION, "1")] == ["2.8", ""]
    assert [entry.why for entry in history(desk, id_)[2:]] == ["slip", "slip"]
    assert not any("field Why" in line for line in page.outline())


def test_a_second_depth_is_left_as_it_was(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), depth_after_mm="1.7")
    page = series_page(desk, id_)
    waited(page, "20", "1.8")
    page.press(STORE_WAITED)
    page.press("Leave it as it was")
    assert "field Why" not in " ".join(page.outline())
    assert page.field(after_waiting("20")).value == "1.7"
    assert len(history(desk, id_)) == 1


def test_new_and_other_second_depths_at_once(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), depth_after_mm="1.7")
    add_series(desk, id_, "1", ("60", "2.6"))
    page = series_page(desk, id_)
    waited(page, "20", "1.8")
    waited(page, "60", "2.9")
    page.press(STORE_WAITED)
    assert page.outcome() == "good"
    assert page.field("Why").value == "typing error"
    assert [row.get("depth_after_mm", "") for row in stored(desk, id_, PENETRATION, "1")] == ["1.7", "2.9"]


def test_a_second_depth_without_a_first_one_and_what_is_no_depth_are_refused(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"), ("40.5", "2.15"))
    page = series_page(desk, id_)
    waited(page, "20", "1.7")
    waited(page, "40.5", "x")
    waited(page, "60", "2.7")
    button = next(each for each in page.of(ui.button) if each.text == STORE_WAITED)
    page.fire(button, "click", {"number": 1})
    faults = page.faults(after_waiting("40.5"), after_waiting("60"))
    assert page.outcome() == "bad"
    assert page.refusals() == faults
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert page.field(after_waiting("20")).value == "1.7"
    assert len(history(desk, id_)) == 2


def test_a_second_depth_after_somebody_elses_entry_is_not_stored(desk: Desk) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("20", "1.5"))
    page = series_page(desk, id_)
    waited(page, "20", "1.7")
    add_series(desk, id_, "1", ("60", "2.6"))
    button = next(each for each in page.of(ui.button) if each.text == STORE_WAITED)
    page.fire(button, "click", {"number": 1})
    assert page.scripts[-1] == "lab.answered(1, false)"
    assert page.outcome() == "bad"
    assert "depth_after_mm" not in stored(desk, id_, PENETRATION, "1")[0]


def record(**further: object) -> dict[str, object]:
    cells = {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1,5", "branch": ""}
    return {"once": "a", "who": "Bo", "cells": cells} | further


def resent(page: Sheet, records: object) -> list[list[str]]:
    """The answer to the browser."""
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
    assert page.field("Depth under 20 N (mm)").value == "1.5"
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
    ("changed", "code"),
    [
        ({"tool": "lost"}, "unknown_name"),
        ({"load_N": "60.0"}, "already_there"),
        ({"site": "B"}, "other_site"),
        ({"depth_mm": "x"}, "not_allowed"),
    ],
)
def test_a_kept_reading_that_cannot_be_stored_is_answered_with_the_reason(
    desk: Desk, changed: dict[str, str], code: str
) -> None:
    id_ = begun(desk)
    add_series(desk, id_, "1", ("60", "2.6"))
    cells = {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1.5"} | changed
    ((once, reason),) = resent(series_page(desk, id_), [record(cells=cells)])
    assert (once, bool(reason)) == ("a", True)
    assert desk.code == code
    assert len(history(desk, id_)) == 1


@pytest.mark.parametrize(
    ("said", "once"),
    [
        ("nothing", ""),
        ({"once": "a"}, "a"),
        ({"once": "a", "cells": []}, "a"),
        (record(once=""), ""),
        (record(once=7), ""),
        (record(once="x" * 201), ""),
    ],
)
def test_what_is_no_kept_reading_is_refused(desk: Desk, said: object, once: str) -> None:
    id_ = begun(desk)
    ((answered, reason),) = resent(begun_series(desk, id_), [said])
    assert (answered, bool(reason)) == (once, True)
    assert history(desk, id_) == []


def test_what_is_no_list_of_readings_is_answered_with_nothing(desk: Desk) -> None:
    id_ = begun(desk)
    page = begun_series(desk, id_)
    assert resent(page, {"once": "a"}) == []
    assert resent(page, [record(once="x" * 200)]) == [["x" * 200, ""]]


def test_only_so_many_readings_are_taken_at_once(desk: Desk) -> None:
    page = begun_series(desk, begun(desk))
    assert len(resent(page, [0] * 10_001)) == 10_000
