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
