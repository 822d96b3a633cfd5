"""The frame of a page, its fields and its charts."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from html import unescape
from typing import TYPE_CHECKING, Any

import pytest
from nicegui import ui

from skisnow.web.elements import FIRST, TypedField, Words, button, choice, field, link, named, option_texts
from skisnow.web.layout import SAID_BY_SCRIPT, heading, sentence
from skisnow.web.line_chart import STYLES, ChartLine, LineChart

from .shared import made

if TYPE_CHECKING:
    from ..desk import Desk, Sheet


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_head_leads_to_every_page_and_to_the_other_language(desk: Desk, language: str) -> None:
    page = desk.open("/skis?ski=slalom&added=", language)
    links = {each.props["href"]: each for each in page.of(ui.link)}
    places = ["/", "/skis", "/carve", "/simulate", "/study", "/replay"]
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


def scripts(page: Sheet) -> list[str]:
    """The lab's own lines in the head of a page."""
    return [line for line in page.html.splitlines() if re.search(r'="/(lab|kept)\.', line)]


@pytest.mark.parametrize(("path", "ahead"), [("/describe", True), ("/skis", False)])
def test_scripts_know_what_the_page_keeps(desk: Desk, path: str, *, ahead: bool) -> None:
    page = desk.open(path)
    style, kept, script = scripts(page)
    assert 'href="/lab.css"' in style
    assert ("data-keeps" in kept) is ahead
    assert 'data-language="en"' in script
    assert script.endswith(f'"{" data-ahead" if ahead else ""}></script>')
    assert ("lab.answered(0, true)" in page.at_first) is ahead
    words = unescape(script.split('data-words="')[1].split('"')[0])
    assert all(f'"{key}": "{text}"' in words for key, text in SAID_BY_SCRIPT.items())


def test_the_title_of_the_window_and_the_scripts_speak_the_language_of_the_page(desk: Desk) -> None:
    assert "<title>Skis" in desk.open("/skis").html
    page = desk.open("/skis", "de")
    assert "<title>Ski " in page.html
    assert 'data-language="de"' in page.html
    assert '"refused": "nicht gespeichert"' in unescape(page.html)


def test_headings_and_sentences(desk: Desk) -> None:
    page = desk.open("/carve")

    def write() -> None:
        with page.content:
            heading("First")
            heading("Second", 4)
            sentence("Third", "bad")
            sentence("Fourth")

    desk.do(write, page.client)
    assert page.outline()[-4:] == ["h2 First", "h4 Second", "[bad] Third", "Fourth"]
    plain = made(desk, lambda: sentence("Skis", "quiet"), "de")
    assert (plain.text, plain._text, plain.classes) == ("Skis", "Ski", ["sentence", "quiet"])


def test_a_field_has_its_name_above_it_in_the_language_of_the_page(desk: Desk) -> None:
    plain = made(desk, lambda: field("Width (mm)", "7"), "de")
    assert isinstance(plain, TypedField)
    assert (plain.value, plain.props["label"], plain.classes) == ("7", "Breite (mm)", ["field"])
    assert "stack-label" in plain.props and plain.props["autocomplete"] == "off"
    assert "inputmode" not in plain.props and "data-optional" not in plain.props
    every = made(desk, lambda: field("Width (mm)", numeric=True, wide=True, optional=True))
    assert (every.value, every.props["label"], every.classes) == ("", "Width (mm)", ["field", "wide"])
    assert every.props["inputmode"] == "decimal" and "data-optional" in every.props
    assert "label" not in made(desk, TypedField).props


def test_a_field_shows_its_error_as_it_is_set(desk: Desk) -> None:
    typed = made(desk, lambda: field("Width (mm)"), "de")
    desk.do(lambda: setattr(typed, "error", "leer"))
    assert (typed.error, typed.props["error"], typed.props["error-message"]) == ("leer", True, "leer")
    desk.do(lambda: setattr(typed, "error", None))
    assert (typed.error, typed.props["error"], typed.props["error-message"]) == (None, None, None)


def test_a_choice_shows_words_for_values(desk: Desk) -> None:
    one = made(desk, lambda: choice("Compared with", ["nothing", "mine"], "mine"), "de")
    assert (one.value, one.props["label"], one.classes) == ("mine", "Verglichen mit", ["field"])
    assert one.options == {"nothing": "nichts", "mine": "mine"}
    assert made(desk, lambda: choice("Ski", {"a": "nothing"}, None), "de").options == {"a": "nichts"}
    assert option_texts({"a": "b"}) == {"a": "b"}


def test_a_button_that_acts_once_tells_presses_apart(desk: Desk) -> None:
    pressed: list[str] = []

    def listeners(element: Any) -> list[tuple[str, str | None]]:
        return [(each.type, each.js_handler) for each in element._event_listeners.values()]

    page = desk.open("/carve", "de")
    often = desk.do(lambda: button("Add this ski", lambda: pressed.append("often")), page.client)
    once = desk.do(lambda: button("Once", lambda: pressed.append("once"), "main", once=True), page.client)
    assert (often.text, often.classes, once.classes) == ("Diesen Ski hinzufügen", ["act"], ["act", "main"])
    assert "no-caps" in often.props and "color" not in often.props
    assert listeners(often) == [("click", None)]
    assert listeners(once) == [("click", FIRST)]
    page.fire(often, "click", {})
    page.fire(once, "click", {})
    assert pressed == ["often", "once"]


def test_a_link_is_as_large_as_a_button(desk: Desk) -> None:
    plain = made(desk, lambda: link("Carve both side by side", "/carve", "main"), "de")
    assert plain.text == "Beide nebeneinander carven"
    assert plain.props["href"] == "/carve"
    assert plain.classes == ["nicegui-link", "act", "main"]
    assert made(desk, lambda: link("x", "/carve")).classes == ["nicegui-link", "act"]


def test_words_stay_as_they_were_said_and_are_shown_in_german(desk: Desk) -> None:
    words = made(desk, lambda: Words("Skis"), "de")
    assert (words.text, words._text) == ("Skis", "Ski")
    desk.do(lambda: words.set_text("Depth (mm)"))
    assert (words.text, words._text) == ("Depth (mm)", "Tiefe (mm)")
    called = made(desk, lambda: named(ui.element("nav"), "Pages"), "de")
    assert called.props["aria-label"] == "Seiten"


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

    monkeypatch.setattr("skisnow.web.line_chart._short", short)
    desk.do(lambda: chart.show(own))
    again = chart.props["panel"]["lines"]
    assert shortened == [[0.0], [0.0]]  # earlier values are not rounded again
    assert [each["y"] for each in again] == [[7.1235], [None], [3.0, None, -1.25], [0.0]]
    assert (chart.props["panel"]["range"], chart.props["panel"]["from_zero"]) == (None, "")


def test_a_chart_in_german(desk: Desk) -> None:
    chart = made(desk, lambda: LineChart("Depth (mm)", "Load (N)", "EI (N m²) along the ski"), "de")
    panel = chart.props["panel"]
    assert (panel["x"], panel["y"], panel["mark"], panel["ends"]) == ("Tiefe (mm)", "Last (N)", ",", ["", ""])
    desk.do(lambda: chart.show([ChartLine([0.0, 1.0], [0.5, 2.25], name="nothing")]))
    panel = chart.props["panel"]
    assert panel["label"].endswith(": 0,500 bis 2,25 (nichts)")
    assert panel["lines"][0]["name"] == "nichts"
    assert [each["read"] for each in STYLES] == [True, True, True, False]
