"""Answers of the entry page: results, requests of the browser, and readings that come again."""

import json
import threading
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest

from skisnow._support.errors import StoreError
from skisnow._support.messages import translated
from skisnow.campaign.store import NewEntry
from skisnow.report.charts import SeriesCurve
from skisnow.web import page_requests as answering
from skisnow.web.edit_session import QuickResults
from skisnow.web.entry.table_view import LiveResults
from skisnow.web.page_requests import PageRequest
from skisnow.web.widgets import BEHIND

from ..desk import Desk, Sheet
from .conftest import (
    DENSITY,
    DROP_CONE,
    PENETRATION,
    READ_AGAIN,
    SERIES,
    SHEAR,
    STORE_WAITED,
    Entered,
    after_waiting,
    found,
    is_open,
    reading_row,
    undo_button,
)


def curve(name: str, *, law: bool = True) -> SeriesCurve:
    at = float(len(name))
    return SeriesCurve(name, (at, at + 1), (10 * at, 10 * at + 1), (0.0, at) if law else (), (0.0, at) if law else ())


def beside(page: Sheet, answer: Callable[[str], QuickResults]) -> LiveResults:
    """A separate page with the results of the readings."""
    session = SimpleNamespace(quick_results=answer, quick_verdicts=lambda _file: [])
    view: Any = SimpleNamespace(file=PENETRATION, session=session, entry_list=None)

    def made() -> LiveResults:
        with page.content:
            return LiveResults(view)

    return page.desk.do(made, page.client)


def test_a_series_stands_before_all_others_of_its_site(desk: Desk) -> None:
    page = desk.open("/")
    made = beside(page, lambda _: found(a=curve("a"), bb=curve("bb"), ccc=curve("ccc", law=False)))
    desk.do(lambda: made.follow("a", "A"), page.client)
    assert "0.250" in page.shows("H_V = ")
    lines = [{key: line[key] for key in ("x", "y", "style", "points")} for line in page.charts()["Load (N)"]["lines"]]
    assert lines == [
        {"x": [2, 3, 3, 4], "y": [20, 21, 30, 31], "style": BEHIND, "points": True},
        {"x": [0, 2, None, None], "y": [0, 2, None, None], "style": BEHIND, "points": False},
        {"x": [1, 2], "y": [10, 11], "style": 0, "points": True},
        {"x": [0, 1, None], "y": [0, 1, None], "style": 0, "points": False},
    ]
    assert {"few", "odd Depth (mm)"} <= set(page.outline())
    assert [each.tag for each in page.of() if getattr(each, "text", "") == "few"] == ["div"]
    desk.do(lambda: made.follow("a", "A", in_progress=True), page.client)
    page.until(lambda: "few" not in page.outline())
    assert "odd Depth (mm)" in page.outline()
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
        assert goes_on.wait(300)
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


def test_what_cannot_be_computed_is_reported_and_the_next_one_is_shown(desk: Desk) -> None:
    page = desk.open("/")

    def answer(site: str) -> QuickResults:
        if site == "lost":
            raise StoreError("away")
        return found(a=curve("a"))

    made = beside(page, answer)
    desk.do(lambda: made.follow("a", "lost"), page.client)
    page.shows("[value] away")
    desk.do(lambda: made.follow("a", "A"), page.client)
    page.shows("[quiet] Test a")


def answered(desk: Desk, act: Callable[[], bool | None], *said: object) -> tuple[list[str], list[PageRequest]]:
    """The page's commands to the browser after each of these, and the open question after it."""
    page = desk.open("/")
    page.scripts.clear()
    after = []

    def done() -> None:
        handler = answering.event_handler(act)
        for each in said:
            handler(SimpleNamespace(args=each))  # type: ignore[arg-type]
            after.append(answering.current_request())

    desk.do(done, page.client)
    return page.scripts, after


@pytest.mark.parametrize(("result", "word"), [(None, "true"), (True, "true"), (False, "false")])
def test_a_question_is_done_once_and_answered_each_time(desk: Desk, result: bool | None, word: str) -> None:
    done: list[PageRequest] = []

    def act() -> bool | None:
        done.append(answering.current_request())
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
def test_unexpected_answers_of_a_browser_are_left(
    desk: Desk, said: object, taken: PageRequest, told: list[str]
) -> None:
    done: list[PageRequest] = []
    assert answered(desk, lambda: done.append(answering.current_request()), said)[0] == told
    assert done == [taken]


def test_an_act_that_fails_is_answered_with_no(desk: Desk) -> None:
    page = desk.open("/")

    def act() -> None:
        raise ZeroDivisionError

    def done() -> None:
        answering.event_handler(act)(SimpleNamespace(args={"number": 3}))  # type: ignore[arg-type]

    page.scripts.clear()
    with pytest.raises(ZeroDivisionError):
        desk.do(done, page.client)
    desk.do(done, page.client)  # is answered, and not done again
    assert page.scripts == ["lab.answered(3, false)"] * 2


def test_a_session_hears_what_others_wrote_when_it_looks_again(entered: Entered) -> None:
    session = entered.session()
    entered.add_series("1", ("20", "1.5"), ("60", "2.6"))
    assert session.campaign.tests == {}
    for _ in range(2):
        session.refresh()
        assert [entry.cells["load_N"] for entry in session.test(PENETRATION, "1").history] == ["20", "60"]
    entered.add_series("1", ("40.5", "2.1"))
    session.refresh()
    assert len(session.test(PENETRATION, "1").history) == 3
    entry = NewEntry(action="undo", file=PENETRATION, test="1", about=entered.history()[2].sequence)
    written = session.write_down(entry, seen=entered.history()[2].sequence)
    assert written == entered.history()[3]
    assert len(session.test(PENETRATION, "1").rows) == 2


def test_a_session_computes_a_site_by_itself(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    entered.add_series("2", ("20", "1.5"), site="B")
    entered.add_shear("s")
    entered.add(DENSITY, "d", sample="d", site="A", snow_density_kg_per_m3="350")
    gone = entered.add(DENSITY, "e", sample="e", site="A", snow_density_kg_per_m3="350")
    entered.write(NewEntry(action="undo", file=DENSITY, test="e", about=gone.sequence))
    session = entered.session()
    assert [test.name for test in session.tests_of_site("A")] == ["1", "s", "d"]
    results = session.quick_results("A")
    assert list(results.experiments) == [(PENETRATION, "1"), (SHEAR, "s")]
    assert list(results.curves) == [(PENETRATION, "1")]
    assert list(session.quick_results("B").curves) == [(PENETRATION, "2")]
    assert "too_few_loads" in session.quick_results("B").flags[PENETRATION, "2"]
    for repeat, site in (("1", "A"), ("2", "B")):
        entered.add(DROP_CONE, "c", test="c", site=site, repeat=repeat, drop_cone_depth_mm="12")
    session.refresh()
    assert [test.name for test in session.tests_of_site("B")] == ["2"]  # a test is where its first row is


def test_a_flag_has_the_numbers_of_the_language(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "2.84"), ("60", "2.6"))
    flag = entered.session().quick_results("A").flags[PENETRATION, "1"]["depth_shrinks"]
    assert "Gefunden: 2,6;" in translated(flag, "de") and "2,84 mm" in translated(flag, "de")
    assert "Found: 2.6;" in flag


def waited(page: Sheet, load: str, text: str) -> None:
    page.fill(after_waiting(load), text)


def test_depths_after_waiting_are_stored_beside_the_first_ones(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "2.15"), ("60", "2.6"))
    page = entered.series_page()
    assert not is_open(page, READ_AGAIN)
    waited(page, "40.5", "2,2")
    waited(page, "60", "2.7")
    page.press(STORE_WAITED)
    assert page.outcome() == "good"
    rows = entered.stored(PENETRATION, "1")
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


def test_a_second_depth_without_a_first_one_and_what_is_no_depth_are_rejected(entered: Entered) -> None:
    entered.add_series("1", ("20", "1.5"), ("40.5", "2.15"))
    page = entered.series_page()
    waited(page, "20", "1.7")
    waited(page, "40.5", "x")
    waited(page, "60", "2.7")
    assert not page.sends(STORE_WAITED, 1)
    faults = page.faults(after_waiting("40.5"), after_waiting("60"))
    assert page.outcome() == "bad"
    assert page.refusals() == faults
    assert page.field(after_waiting("20")).value == "1.7"
    assert len(entered.history()) == 2


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


def test_readings_that_the_browser_kept_are_stored_once(entered: Entered) -> None:
    page = entered.begun_series()
    assert resent(page, [record()]) == [["a", ""]]
    assert resent(page, [record()]) == [["a", ""]]
    (entry,) = entered.history()
    assert (entry.who, entry.once, entry.position, entry.test) == ("Bo", "a", 0, "1")
    assert entry.cells == {"experiment": "1", **SERIES, "load_N": "20", "depth_mm": "1.5"}
    assert page.field("Depth under 20 N (mm)").value == "1.5"
    back = record(once="b", who="x" * 201)
    back["cells"] = {**record()["cells"], "branch": "unloading"}  # type: ignore[dict-item]
    assert resent(page, [back]) == [["b", ""]]
    entry = entered.history()[-1]
    assert (entry.cells["branch"], len(entry.who), entry.position) == ("unloading", 200, 1)


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
def test_an_invalid_kept_reading_is_rejected(entered: Entered, said: object, once: str) -> None:
    ((answered, reason),) = resent(entered.begun_series(), [said])
    assert (answered, bool(reason)) == (once, True)
    assert entered.history() == []
