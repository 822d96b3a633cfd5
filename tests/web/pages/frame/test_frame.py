"""The frame of a page, its fields and its charts."""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from datetime import UTC, datetime, timedelta, timezone
from typing import Any

import pytest
from nicegui import ui
from starlette.requests import Request

from skisnow._support.messages import Message
from skisnow.web.elements import FIRST, button, field
from skisnow.web.page_requests import plain_stem
from skisnow.web.widgets import STYLES, ChartLine, LineChart
from skisnow.web.words import (
    LABELS,
    TABLES,
    estimate_words,
    in_words,
    label,
    language_asked,
    language_of_request,
    minute_words,
    result_words,
)

from ..desk import Desk


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_head_leads_to_every_page_and_to_the_other_language(desk: Desk, language: str) -> None:
    page = desk.open("/skis?ski=slalom&added=", language)
    links = {each.props["href"]: each for each in page.of(ui.link)}
    places = ["/", "/skis", "/carve", "/design", "/simulate", "/study", "/replay"]
    assert [href for href in links if href in places] == places
    assert [href for href, each in links.items() if each.props.get("aria-current") == "page"] == ["/skis"]
    other = {"en": "de", "de": "en"}[language]
    switch = links[f"/language/{other}?back=%2Fskis%3Fski%3Dslalom%26added%3D"]
    assert (switch.props["hreflang"], switch.props["lang"]) == (other, other)
    assert "#content" in [each.props["href"] for each in page.tagged("a")]
    assert [each.props["aria-label"] for each in page.tagged("nav")] == [{"en": "Pages", "de": "Seiten"}[language]]
    (connecting,) = (each for each in page.of(ui.label) if "connection" in each.classes)
    assert connecting.props["role"] == "status"


def test_the_content_is_closed_until_the_browser_is_connected(desk: Desk) -> None:
    page = desk.open("/skis")
    (fields,) = page.tagged("fieldset")
    assert fields.classes == ["lab"]
    assert fields.props["disabled"] is True and fields.props["role"] == "none"
    assert fields.parent_slot.parent is page.content
    assert page.outline()[0] == "h1 Skis"
    assert page.at_first[0] == "lab.connected()"  # before all else
    page.told("lab.connected()")  # and whenever a connection is made
    assert "lab.answered(0, true)" not in page.at_first


def test_a_field_has_its_name_above_it_in_the_language_of_the_page(desk: Desk) -> None:
    plain = made(desk, lambda: field(Message("Width (mm)"), "7"), "de")
    assert isinstance(plain, ui.input)
    assert (plain.value, plain.props["label"], plain.classes) == ("7", "Breite (mm)", ["field"])
    assert "stack-label" in plain.props and plain.props["autocomplete"] == "off"
    assert "inputmode" not in plain.props and "data-optional" not in plain.props
    every = made(desk, lambda: field("Width (mm)", numeric=True, wide=True, optional=True))
    assert (every.value, every.props["label"], every.classes) == ("", "Width (mm)", ["field", "wide"])
    assert every.props["inputmode"] == "decimal" and "data-optional" in every.props


def test_a_field_shows_its_error_as_it_is_set(desk: Desk) -> None:
    typed = made(desk, lambda: field("Width (mm)"), "de")
    desk.do(lambda: setattr(typed, "error", "leer"))
    assert (typed.error, typed.props["error"], typed.props["error-message"]) == ("leer", True, "leer")
    desk.do(lambda: setattr(typed, "error", None))
    assert (typed.error, typed.props["error"], typed.props["error-message"]) == (None, None, None)


def test_a_button_that_acts_once_tells_presses_apart(desk: Desk) -> None:
    pressed: list[str] = []

    def listeners(element: Any) -> list[tuple[str, str | None]]:
        return [(each.type, each.js_handler) for each in element._event_listeners.values()]

    page = desk.open("/carve", "de")
    often = desk.do(lambda: button(Message("Add this ski"), lambda: pressed.append("often")), page.client)
    once = desk.do(lambda: button("Once", lambda: pressed.append("once"), "main", once=True), page.client)
    assert (often.text, often.classes, once.classes) == ("Diesen Ski hinzufügen", ["act"], ["act", "main"])
    assert "no-caps" in often.props and "color" not in often.props
    assert listeners(often) == [("click", None)]
    assert listeners(once) == [("click", FIRST)]
    page.fire(often, "click", {})
    page.fire(once, "click", {})
    assert pressed == ["often", "once"]


def test_a_chart_tells_its_extent_and_its_names(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    chart = made(desk, lambda: LineChart("Depth (mm)", "Load (N)", "Load over depth", height=77, ends=("tail", "tip")))
    empty = dict(chart.props["panel"])
    assert (empty["x"], empty["y"], empty["ends"], empty["mark"]) == ("Depth (mm)", "Load (N)", ["tail", "tip"], ".")
    assert (empty["range"], empty["from_zero"], empty["lines"]) == (None, "", [])
    assert (chart.props["height"], chart.props["styles"]) == (77, STYLES)
    lines = [
        ChartLine([0.0, 1.0, 2.0], [3.0, None, -1.25], 1, name="a"),
        ChartLine([5.0], [math.inf], 3, points=True),
        ChartLine([5.0], [7.123456789], name="b"),
    ]
    desk.do(lambda: chart.show(lines, range_=(0.0, 9.0), from_zero="xy"))
    panel = chart.props["panel"]
    assert panel["label"].endswith(": −1.25 to 7.12 (a, b)")
    assert (panel["range"], panel["from_zero"]) == ((0.0, 9.0), "xy")
    assert panel["lines"] == [
        {"x": [0.0, 1.0, 2.0], "y": [3.0, None, -1.25], "style": 1, "points": False, "name": "a"},
        {"x": [5.0], "y": [None], "style": 3, "points": True, "name": ""},
        {"x": [5.0], "y": [7.1235], "style": 0, "points": False, "name": "b"},
    ]
    shortened: list[object] = []
    own = [*lines[::-1], ChartLine([0.0], [0.0])]

    def short(values: Sequence[float | None]) -> list[float | None]:
        if any(values is known for line in own for known in (line.x, line.y)):  # a page before may still be drawn
            shortened.append(values)
        return list(values)

    monkeypatch.setattr("skisnow.web.widgets._round_to_pixels", short)
    desk.do(lambda: chart.show(own))
    again = chart.props["panel"]["lines"]
    assert shortened == [[0.0], [0.0]]  # earlier values are not rounded again
    assert [each["y"] for each in again] == [[7.1235], [None], [3.0, None, -1.25], [0.0]]
    assert (chart.props["panel"]["range"], chart.props["panel"]["from_zero"]) == (None, "")


@pytest.mark.parametrize(("name", "words"), [*LABELS.items(), *TABLES.items()])
def test_columns_and_tables_are_called_as_on_the_pages(name: str, words: str) -> None:
    if "_" in name or "." in name:
        assert in_words(f"{name} is {name}, {name}s and x.{name}") == f"{words} is {words}, {name}s and x.{name}"
    else:
        assert in_words(f"a {name} here") == f"a {name} here"
    assert label(name) == LABELS.get(name, name)


SERIES = {
    "H_V_N_per_mm3": 0.2, "H_V_interval_N_per_mm3": [0.15, 0.25],
    "n_unloading": 3, "unloading_ratio": 12.0, "unloading_ratio_interval": None,
}  # fmt: skip
SHEARED = {
    "S_f_N_per_mm2": 0.034412, "S_f_interval_N_per_mm2": [0.03, 0.04],
    "shear_displacement_mm": 1.5, "shear_displacement_interval_mm": [1.0, 2.0],
}  # fmt: skip


def test_results_in_words() -> None:
    hardness, stress = "H_V = 0.200 N/mm³, [0.150, 0.250]", "S_f = 0.0344 N/mm², [0.0300, 0.0400]"
    assert result_words(SERIES) == f"{hardness}; k_u/H_V = 12.0, interval not known"
    assert result_words(SHEARED) == f"{stress}; u_y = 1.50 mm, [1.00, 2.00]"
    assert result_words(SERIES | {"n_unloading": 0}) == hardness
    assert result_words(SHEARED | {"shear_displacement_mm": None}) == stress
    assert estimate_words(None, [1.0, 2.0], "mm") == "not defined"


@pytest.mark.parametrize(
    ("chosen", "accepted", "code"),
    [
        (None, "", "en"),
        (None, "DE-at;q=0.9", "de"),
        (None, "fr-CH, de-AT;q=0.9", "de"),
        (None, "en-US,de", "en"),
        ("de", "en", "de"),
        ("en", "de", "en"),
        ("fr", " de ;q=1", "de"),
    ],
)
def test_a_chosen_language_comes_before_those_of_the_browser(chosen: str | None, accepted: str, code: str) -> None:
    assert language_asked(chosen, accepted) == code


def request(**headers: str) -> Request:
    given = [(name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()]
    return Request({"type": "http", "headers": given})


def test_a_request_asks_by_its_cookie_or_its_header() -> None:
    assert language_of_request(request()) == "en"
    assert language_of_request(request(accept_language="de")) == "de"
    assert language_of_request(request(accept_language="de", cookie="skisnow-language=en")) == "en"


@pytest.fixture
def in_vienna(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The clock of the lab is that of Vienna."""
    with monkeypatch.context() as there:
        there.setenv("TZ", "Europe/Vienna")
        time.tzset()
        yield
    time.tzset()


@pytest.mark.parametrize(
    ("at", "words"),
    [
        ("2026-03-05T09:07:59", "5 Mar 2026, 10:07"),
        ("2026-12-31T23:30:00+00:00", "1 Jan 2027, 00:30"),
        (datetime(2026, 12, 5, 9, 7, tzinfo=timezone(timedelta(hours=5))), "5 Dec 2026, 05:07"),
        (datetime(2026, 7, 5, 9, 7, tzinfo=UTC), "5 Jul 2026, 11:07"),
    ],
)
@pytest.mark.usefixtures("in_vienna")
def test_times_as_the_clock_of_the_lab_shows_them(desk: Desk, at: str | datetime, words: str) -> None:
    assert made(desk, lambda: minute_words(at)) == words


@pytest.mark.parametrize(
    ("called", "stem"),
    [
        ("a.b.c.csv", "a-b-c"),
        ("folder/x.csv", "x"),
        ("a..csv", "a"),
        (".csv", "course"),
        ("x", "x"),
        ("雪.csv", "course"),
    ],
)
def test_the_stem_of_a_file(called: str, stem: str) -> None:
    assert plain_stem(called, "course") == stem


def made(desk: Desk, make: Callable[[], Any], language: str = "en") -> Any:
    """An element on a page."""
    page = desk.open("/carve", language)
    return desk.do(make, page.client)
