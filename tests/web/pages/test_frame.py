"""What every page of the lab has: its frame, its fields and their words, in English and German; and who is let in."""

from __future__ import annotations

import asyncio
import logging
import math
import re
import time
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import asynccontextmanager
from datetime import UTC, datetime, timedelta, timezone
from html import unescape
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
import uvicorn
from nicegui import app as pages_app
from nicegui import core, ui
from starlette.requests import Request
from uvicorn.server import ServerState

import skisnow.web
from skisnow.language import languages
from skisnow.web import language as web_language
from skisnow.web.application import _chosen
from skisnow.web.fields import FIRST, button, choice, field, link, said_options
from skisnow.web.language import (
    language_asked,
    language_of,
    language_of_request,
    said,
    said_as_written,
    said_list,
)
from skisnow.web.layout import SAID_BY_SCRIPT, heading, sentence
from skisnow.web.line_chart import STYLES, ChartLine, LineChart
from skisnow.web.local_time import minute_words
from skisnow.web.names import plain_stem
from skisnow.web.patience import RECONNECT_S, use_heartbeat
from skisnow.web.slow_requests import PatientToAPoint
from skisnow.web.token_page import Tries, answer_to_token, token_page, too_many_tries
from skisnow.web.worded import TypedField, Words, html_words, named
from skisnow.web.words import (
    LABELS,
    TABLES,
    displacement_words,
    estimate_words,
    hardness_words,
    in_words,
    label,
    stress_words,
    unloading_words,
)

from ..finished import finished

if TYPE_CHECKING:
    from nicegui import Client
    from starlette.responses import Response
    from starlette.types import Message, Receive, Scope, Send

    from .desk import Desk, Sheet

CONNECTING = "Connecting to the lab. The fields open as soon as it answers."
HERE = Path(skisnow.web.__file__).parent


# The frame of a page


def around(page: Sheet) -> list[str]:
    """What stands before and behind the content."""
    elements = list(page.of())
    within = {each.id for each in page.content.descendants(include_self=True)}
    lines = []
    for each in elements:
        if each.id not in within and getattr(each, "text", "") is not None:
            kept = {key: each.props[key] for key in ("href", "aria-current", "aria-label", "role") if key in each.props}
            text = getattr(each, "_text", "") or ""
            if kept or text:
                lines.append(f"{each.tag} {text} {kept}".replace("nicegui-link", "link"))
    return lines


def pages(*names: str, here: str) -> list[str]:
    """The links to pages in the head."""
    places = ("/", "/skis", "/carve", "/simulate", "/study", "/replay")
    current = {here: ", 'aria-current': 'page'"}
    return [f"link {name} {{'href': '{to}'{current.get(to, '')}}}" for name, to in zip(names, places, strict=True)]


def test_the_head_leads_to_every_page_and_to_the_other_language(desk: Desk) -> None:
    page = desk.open("/skis?ski=slalom&added=")
    assert around(page) == [
        "a  {'href': '#content'}",
        "div Skip to the content {}",
        "div skisnow {}",
        "nav  {'aria-label': 'Pages'}",
        *pages("Campaigns", "Skis", "Carve", "Simulate", "Study", "Replay", here="/skis"),
        "link DE {'href': '/language/de?back=%2Fskis%3Fski%3Dslalom%26added%3D', 'aria-label': 'Deutsch'}",
        f"div {CONNECTING} {{'role': 'status'}}",
        "div  {'role': 'status'}",
    ]
    (other,) = (each for each in page.of(ui.link) if each.text == "DE")
    assert (other.props["hreflang"], other.props["lang"], other.props["title"]) == ("de", "de", "Deutsch")
    classes = {each.text: each.classes for each in page.of(ui.label)}
    assert (classes["skisnow"], classes[CONNECTING], classes[""]) == (["lab-name"], ["connection"], ["unused"])


def test_the_head_in_german(desk: Desk) -> None:
    page = desk.open("/carve", "de")
    found = around(page)
    assert found[1:4] == ["div Zum Inhalt {}", "div skisnow {}", "nav  {'aria-label': 'Seiten'}"]
    assert found[4:10] == pages("Kampagnen", "Ski", "Carven", "Simulieren", "Studie", "Replay", here="/carve")
    assert found[10] == "link EN {'href': '/language/en?back=%2Fcarve', 'aria-label': 'English'}"


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
    assert style.strip() == '<link rel="stylesheet" href="/lab.css">'
    assert kept == f'<script src="/kept.js"{" data-keeps" if ahead else ""}></script>'
    assert script.startswith('<script src="/lab.js" data-language="en" data-words="')
    assert script.endswith(f'"{" data-ahead" if ahead else ""}></script>')
    assert ("lab.answered(0, true)" in page.at_first) is ahead
    words = unescape(script.split('data-words="')[1].split('"')[0])
    assert all(f'"{key}": "{text}"' in words for key, text in SAID_BY_SCRIPT.items())


def test_the_title_of_the_window_and_the_scripts_speak_the_language_of_the_page(desk: Desk) -> None:
    assert "<title>Skis · skisnow</title>" in desk.open("/skis").html
    page = desk.open("/skis", "de")
    assert "<title>Ski · skisnow</title>" in page.html
    assert 'data-language="de"' in page.html
    assert '"refused": "nicht gespeichert"' in unescape(page.html)


def made(desk: Desk, make: Callable[[], Any], language: str = "en") -> Any:
    """An element on a page."""
    page = desk.open("/carve", language)
    return desk.do(make, page.client)


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


# Fields


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


def test_what_is_wrong_with_a_field_is_said_in_the_language_of_the_page(desk: Desk) -> None:
    typed = made(desk, lambda: field("Width (mm)"), "de")
    desk.do(lambda: setattr(typed, "error", "a number is needed here"))
    assert typed.error == "a number is needed here"
    assert (typed.props["error"], typed.props["error-message"]) == (True, "hier fehlt eine Zahl")
    desk.do(lambda: setattr(typed, "error", None))
    assert (typed.error, typed.props["error"], typed.props["error-message"]) == (None, None, None)


def test_a_choice_shows_words_for_values(desk: Desk) -> None:
    one = made(desk, lambda: choice("Compared with", ["nothing", "mine"], "mine"), "de")
    assert (one.value, one.props["label"], one.classes) == ("mine", "Verglichen mit", ["field"])
    assert one.options == {"nothing": "nichts", "mine": "mine"}
    assert made(desk, lambda: choice("Ski", {"a": "nothing"}, None), "de").options == {"a": "nichts"}
    assert said_options({"a": "b"}) == {"a": "b"}


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


def test_html_of_reports_is_translated_but_for_names(desk: Desk) -> None:
    html = "<p>Depth (mm)</p><p>Skis</p>"
    assert made(desk, lambda: html_words(html, {"Skis"}), "de").content == "<p>Tiefe (mm)</p><p>Skis</p>"
    assert made(desk, lambda: html_words(html), "de").content == "<p>Tiefe (mm)</p><p>Ski</p>"
    assert made(desk, lambda: html_words(html)).content == html
    assert made(desk, lambda: html_words(html)).props["sanitize"] is False  # charts of reports stay whole


# Charts


def test_a_chart_tells_its_extent_and_its_names(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    chart = made(desk, lambda: LineChart("Depth (mm)", "Load (N)", "Load over depth", height=77, ends=("tail", "tip")))
    empty = {
        "x": "Depth (mm)", "y": "Load (N)", "ends": ["tail", "tip"], "mark": ".",
        "label": "Load over depth: nothing yet", "range": None, "from_zero": "", "lines": [],
    }  # fmt: skip
    assert chart.props["panel"] == empty
    assert (chart.props["height"], chart.props["styles"]) == (77, STYLES)
    lines = [
        ChartLine([0.0, 1.0, 2.0], [3.0, None, -1.25], 1, name="a"),
        ChartLine([5.0], [math.inf], 3, points=True),
        ChartLine([5.0], [7.123456789], name="b"),
    ]
    desk.do(lambda: chart.show(lines, range_=(0.0, 9.0), from_zero="xy"))
    assert chart.props["panel"] == empty | {
        "label": "Load over depth: −1.25 to 7.12 (a, b)",
        "range": (0.0, 9.0),
        "from_zero": "xy",
        "lines": [
            {"x": [0.0, 1.0, 2.0], "y": [3.0, None, -1.25], "style": 1, "points": False, "name": "a"},
            {"x": [5.0], "y": [None], "style": 3, "points": True, "name": ""},
            {"x": [5.0], "y": [7.1235], "style": 0, "points": False, "name": "b"},
        ],
    }
    shortened: list[object] = []
    own = [*lines[::-1], ChartLine([0.0], [0.0])]

    def short(values: Sequence[float | None]) -> list[float | None]:
        if any(values is known for line in own for known in (line.x, line.y)):  # a page before may still be drawn
            shortened.append(values)
        return list(values)

    monkeypatch.setattr("skisnow.web.line_chart._short", short)
    desk.do(lambda: chart.show(own))
    again = chart.props["panel"]["lines"]
    assert shortened == [[0.0], [0.0]]  # what was there is not rounded again
    assert [each["y"] for each in again] == [[7.1235], [None], [3.0, None, -1.25], [0.0]]
    assert (chart.props["panel"]["range"], chart.props["panel"]["from_zero"]) == (None, "")


def test_a_chart_in_german(desk: Desk) -> None:
    chart = made(desk, lambda: LineChart("Depth (mm)", "Load (N)", "EI (N m²) along the ski"), "de")
    panel = chart.props["panel"]
    assert (panel["x"], panel["y"], panel["mark"], panel["ends"]) == ("Tiefe (mm)", "Last (N)", ",", ["", ""])
    desk.do(lambda: chart.show([ChartLine([0.0, 1.0], [0.5, 2.25], name="nothing")]))
    panel = chart.props["panel"]
    assert panel["label"] == "EI (N m²) entlang des Skis: 0,500 bis 2,25 (nichts)"
    assert panel["lines"][0]["name"] == "nichts"
    assert [each["read"] for each in STYLES] == [True, True, True, False]


# Words


@pytest.mark.parametrize(("name", "words"), [*LABELS.items(), *TABLES.items()])
def test_columns_and_tables_are_called_as_on_the_pages(name: str, words: str) -> None:
    if "_" in name or "." in name:
        assert in_words(f"{name} is {name}, {name}s and x.{name}") == f"{words} is {words}, {name}s and x.{name}"
    else:
        assert in_words(f"a {name} here") == f"a {name} here"
    assert label(name) == LABELS.get(name, name)


ROW = {
    "H_V_N_per_mm3": 0.2, "H_V_interval_N_per_mm3": [0.15, 0.25],
    "n_unloading": 3, "unloading_ratio": 12.0, "unloading_ratio_interval": None,
    "S_f_N_per_mm2": 0.034412, "S_f_interval_N_per_mm2": [0.03, 0.04],
    "shear_displacement_mm": 1.5, "shear_displacement_interval_mm": [1.0, 2.0],
}  # fmt: skip


def test_results_in_words() -> None:
    assert hardness_words(ROW) == "0.200 N/mm³, [0.150, 0.250]"
    assert unloading_words(ROW) == "k_u/H_V = 12.0, interval not known"
    assert stress_words(ROW) == "0.0344 N/mm², [0.0300, 0.0400]"
    assert displacement_words(ROW) == "u_y = 1.50 mm, [1.00, 2.00]"
    assert unloading_words(ROW | {"n_unloading": 0}) == ""
    assert displacement_words(ROW | {"shear_displacement_mm": None}) == ""
    assert estimate_words(None, [1.0, 2.0], "mm") == "not defined"


# Languages


@pytest.mark.parametrize(
    ("chosen", "accepted", "code"),
    [
        (None, "", "en"),
        (None, "fr", "en"),
        (None, "DE-at;q=0.9", "de"),
        (None, "fr-CH, de-AT;q=0.9, en;q=0.5", "de"),
        (None, "en-US,de", "en"),
        ("de", "en", "de"),
        ("en", "de", "en"),
        ("fr", " de ;q=1", "de"),
        ("", "de", "de"),
    ],
)
def test_a_language_that_was_chosen_comes_before_those_of_the_browser(
    chosen: str | None, accepted: str, code: str
) -> None:
    assert language_asked(chosen, accepted) == code


def request(**headers: str) -> Request:
    given = [(name.replace("_", "-").encode(), value.encode()) for name, value in headers.items()]
    return Request({"type": "http", "headers": given})


def test_a_request_asks_by_its_cookie_or_its_header() -> None:
    assert language_of_request(request()) == "en"
    assert language_of_request(request(accept_language="de")) == "de"
    assert language_of_request(request(accept_language="de", cookie="skisnow-language=en")) == "en"


def test_texts_in_the_language_of_a_page(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    german, english = desk.open("/carve", "de").client, desk.open("/carve").client
    assert (language_of(german), language_of(english)) == ("de", "en")
    assert said("Depth (mm) 1.5", german) == "Depth (mm) 1,5"
    assert said("Depth (mm)", german) == "Tiefe (mm)"
    assert said("Depth (mm)", english) == "Depth (mm)"
    assert desk.do(lambda: said("Depth (mm)"), german) == "Tiefe (mm)"
    assert desk.do(lambda: said_as_written("Skis", {"Depth (mm)"}), german) == "Ski"
    assert desk.do(lambda: said_as_written("Skis", {"Skis"}), german) == "Skis"
    assert desk.do(lambda: said_as_written("1.5", set()), german) == "1.5"
    listed = "Load (N): 400 to 1200, 4 values; Skis: Skis: 0.5; Depth (mm)"
    assert said_list(listed, german) == "Last (N): 400 bis 1200, 4 Werte; Ski: Skis: 0,5; Tiefe (mm)"
    assert said_list(listed, english) == listed
    monkeypatch.setattr(web_language, "language_of_request", lambda _: pytest.fail("asked twice"))
    assert language_of(german) == "de"


def test_what_belongs_to_no_page_is_in_english(monkeypatch: pytest.MonkeyPatch) -> None:
    class Nobody:
        @property
        def client(self) -> Client:
            raise RuntimeError

    monkeypatch.setattr(web_language, "ui", SimpleNamespace(context=Nobody()))
    assert language_of() == "en"
    assert said("Depth (mm) 1.5") == "Depth (mm) 1.5"


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


@pytest.mark.usefixtures("in_vienna")
def test_times_in_german(desk: Desk) -> None:
    assert made(desk, lambda: minute_words("2026-03-05T09:07"), "de") == "5. 3. 2026, 10:07"


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


# The application


@pytest.mark.parametrize(
    ("path", "kind"),
    [("/lab.css", "text/css"), ("/lab.js", "text/javascript"), ("/kept.js", "text/javascript")],
)
def test_own_files_are_asked_for_again(desk: Desk, path: str, kind: str) -> None:
    answer = desk.get(path)
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith(kind)
    assert answer.headers["cache-control"] == "no-cache"
    assert answer.content == (HERE / path[1:]).read_bytes()


@pytest.mark.parametrize("path", ["/docs", "/redoc", "/openapi.json", "/nowhere"])
def test_there_are_no_other_pages(desk: Desk, path: str) -> None:
    answer = desk.get(path, "de")
    assert answer.status_code == 404
    assert "Keine solche Seite" in answer.text


@pytest.mark.parametrize("path", ["/import", "/skis/add"])
def test_a_form_without_a_file_is_refused(desk: Desk, path: str) -> None:
    answer = desk.post(path, data={"name": ""})
    assert answer.status_code == 400
    assert "This was not taken in" in answer.text


def test_the_framework_is_set_up_for_pages_that_last(desk: Desk) -> None:
    config = pages_app.config
    assert config.title == "skisnow"
    assert config.language == "en-US"
    assert (config.tailwind, config.show_welcome_message, config.reconnect_timeout) == (False, False, RECONNECT_S)
    assert config.socket_io_js_transports == ["websocket"]
    assert config.quasar_config["loadingBar"] == {"skipHijack": True}
    assert use_heartbeat in pages_app._startup_handlers
    assert all(hasattr(each, "__wrapped__") for each in core.sio.handlers["/"].values())
    guard: Any = vars(desk._browser._transport)["app"]
    access = guard.access
    assert (access.host, access.token, access.body_bytes) == ("127.0.0.1", None, desk.lab.limits.upload_bytes)
    files = [each for each in logging.getLogger("skisnow.web").handlers if isinstance(each, logging.FileHandler)]
    assert str(desk.lab.runs / "lab.log") in [each.baseFilename for each in files]


def test_a_language_is_chosen_at_an_address(desk: Desk) -> None:
    answer = desk.get("/language/xx?back=%2Flab.css")
    assert [each.headers["location"] for each in answer.history] == ["/lab.css"]
    assert answer.headers["content-type"].startswith("text/css")


@pytest.mark.parametrize(
    ("back", "place"),
    [
        ("/skis?ski=a", "/skis?ski=a"),
        ("//evil.example", "/"),
        ("/\\evil.example", "/"),
        ("https://evil.example", "/"),
        ("", "/"),
    ],
)
def test_a_language_is_kept_and_leads_back_to_a_page_of_the_lab(back: str, place: str) -> None:
    answer = _chosen("de", back)
    assert (answer.status_code, answer.headers["location"]) == (303, place)
    parts = answer.headers["set-cookie"].split("; ")
    assert parts[0] == "skisnow-language=de"
    assert sorted(parts[1:]) == ["HttpOnly", "Max-Age=31536000", "Path=/", "SameSite=lax"]
    assert all(code in _chosen(code).headers["set-cookie"] for code in languages())
    assert "set-cookie" not in _chosen("xx").headers


# The token


def scope_of(language: str = "en", scheme: str = "http") -> Scope:
    headers = [(b"accept-language", language.encode())]
    return {"type": "http", "method": "POST", "path": "/token", "headers": headers, "scheme": scheme}


def answered(*messages: Message, scope: Scope | None = None, token: str = "snow in may") -> Response:
    """What the page of the token answers to a body."""
    waiting = list(messages)

    async def receive() -> Message:
        return waiting.pop(0)

    return finished(
        answer_to_token(scope or scope_of(), receive, lambda text: text == token, ("the-cookie", "its-value"))
    )


def body(text: bytes, *, more: bool = False) -> Message:
    return {"type": "http.request", "body": text, "more_body": more}


@pytest.fixture
def waits(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """For how long a wrong token is held, without waiting."""
    heard: list[float] = []

    async def slept(seconds: float) -> None:
        heard.append(seconds)

    monkeypatch.setattr("skisnow.web.token_page.asyncio.sleep", slept)
    return heard


def test_the_right_token_is_let_in_at_once(waits: list[float]) -> None:
    answer = answered(body(b"token=snow", more=True), body(b"+in+may"))
    assert (answer.status_code, answer.headers["location"], waits) == (303, "/", [])
    parts = answer.headers["set-cookie"].split("; ")
    assert parts[0] == "the-cookie=its-value"
    assert sorted(parts[1:]) == ["HttpOnly", "Path=/", "SameSite=strict"]
    assert answered(body(b"token=snow+in+may&token=x")).status_code == 303  # the first one counts
    secure = answered(body(b"token=snow+in+may"), scope=scope_of(scheme="https"))
    assert "; Secure" in secure.headers["set-cookie"]


@pytest.mark.parametrize("text", [b"token=snow", b"", b"other=snow+in+may", b"token=\xff"])
def test_a_wrong_token_is_held_a_while(waits: list[float], text: bytes) -> None:
    answer = answered(body(text))
    assert (answer.status_code, waits) == (403, [0.5])
    assert '<p role="status">This is not the token.</p>' in text_of(answer)
    assert "set-cookie" not in answer.headers


def text_of(answer: Response) -> str:
    return bytes(answer.body).decode()


@pytest.mark.parametrize(("size", "status"), [(2000, 403), (2001, 413)])
def test_a_body_that_is_too_long_for_a_token_is_not_read_on(waits: list[float], size: int, status: int) -> None:
    answer = answered(body(b"x" * 1000, more=True), body(b"x" * (size - 1000)))
    assert answer.status_code == status
    assert ("This is too long for a token." in text_of(answer)) is (status == 413)
    assert len(waits) == (1 if status == 403 else 0)


def test_who_leaves_gets_nothing(waits: list[float]) -> None:
    answer = answered(body(b"token=snow+in+may", more=True), {"type": "http.disconnect"})
    assert (answer.status_code, text_of(answer), waits) == (400, "", [])


def test_the_form_of_the_token_in_both_languages() -> None:
    answer = token_page(scope_of(), 401)
    page = text_of(answer)
    assert (answer.status_code, answer.headers["cache-control"]) == (401, "no-store")
    assert page.startswith('<!doctype html><html lang="en"><meta charset="utf-8"><title>Token · skisnow</title>')
    assert '<p role="status">The lab asks for the token that it was started with.</p>' in page
    assert '<form method="post" action="/token">\n<label for="token">Token</label>' in page
    assert "<button>Open the lab</button>" in page
    german = text_of(token_page(scope_of("de"), 403, "This is not the token."))
    assert '<html lang="de"><meta charset="utf-8"><title>Wort · skisnow</title>' in german
    assert '<p role="status">Das ist nicht das Wort.</p>' in german


@pytest.mark.parametrize(("wait_s", "seconds"), [(0.1, 1), (30.0, 30), (59.2, 60)])
def test_too_many_tries_are_told_how_long_to_wait(wait_s: float, seconds: int) -> None:
    answer = too_many_tries(scope_of(), wait_s)
    assert (answer.status_code, answer.headers["retry-after"]) == (429, str(seconds))
    assert f"Those were 10 tries in a minute. Wait {seconds} seconds, then try again." in text_of(answer)
    german = text_of(too_many_tries(scope_of("de"), wait_s))
    assert f"Das waren 10 Versuche in einer Minute. Warte {seconds} Sekunden, dann noch einmal." in german


def test_tries_are_forgotten_after_a_minute_each() -> None:
    clock = [0.0]
    tries = Tries(lambda: clock[0])
    for second in range(10):
        clock[0] = float(second)
        assert tries.wait_s("a") == 0.0
    assert [tries.wait_s("a"), tries.wait_s("a")] == [51.0, 51.0]
    clock[0] = 59.5
    assert tries.wait_s("a") == 0.5
    clock[0] = 60.0
    assert (tries.wait_s("a"), tries.wait_s("a")) == (0.0, 1.0)  # the first one is a minute old
    clock[0] = 130.0
    assert [tries.wait_s("a") for _ in range(11)] == [0.0] * 10 + [60.0]
    assert Tries().wait_s("a") == 0.0


def test_networks_have_tries_of_their_own() -> None:
    tries = Tries(lambda: 0.0)
    assert [tries.wait_s(f"2001:db8::{i:x}:1") for i in range(10)] == [0.0] * 10
    assert tries.wait_s("2001:db8:0:0:ffff:ffff:ffff:ffff") == 60.0
    assert tries.wait_s("2001:db8:0:1::") == 0.0
    assert [tries.wait_s("no address") for _ in range(11)] == [0.0] * 10 + [60.0]
    assert tries.wait_s("another") == 0.0


def test_ten_thousand_addresses_are_known_the_latest_ones() -> None:
    tries = Tries(lambda: 0.0)
    for _ in range(10):
        tries.wait_s("first")
        tries.wait_s("second")
    for number in range(9_998):
        tries.wait_s(f"other {number}")
    assert tries.wait_s("first") == 60.0  # known, and now the latest
    tries.wait_s("one more")  # the second one is forgotten for it
    assert tries.wait_s("first") == 60.0
    assert tries.wait_s("second") == 0.0


# Half requests


class Wire(asyncio.Transport):
    """A connection that hears what a server does with it."""

    def __init__(self) -> None:
        super().__init__()
        self.closed = False
        self.written = b""
        self.protocol: asyncio.BaseProtocol | None = None

    def write(self, data: Any) -> None:
        self.written += bytes(data)

    def close(self) -> None:
        self.closed = True

    def is_closing(self) -> bool:
        return self.closed

    def set_protocol(self, protocol: asyncio.BaseProtocol) -> None:
        self.protocol = protocol

    def get_protocol(self) -> asyncio.BaseProtocol:
        assert self.protocol is not None
        return self.protocol

    def pause_reading(self) -> None:
        """As if it did."""

    def resume_reading(self) -> None:
        """As if it did."""


class Timer:
    """What was to happen later."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.is_waiting = True

    def cancel(self) -> None:
        self.is_waiting = False


async def hi(_: Scope, receive: Receive, send: Send) -> None:
    while (await receive()).get("more_body"):
        pass
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"hi"})


class Patience:
    """The server's side of a connection, and for how long it waits with it."""

    def __init__(self) -> None:
        self.wire = Wire()
        self.state = ServerState()
        self.timers: list[Timer] = []
        loop = asyncio.get_running_loop()
        later = loop.call_later

        def call_later(seconds: float, act: Callable[..., Any], *given: Any, **named: Any) -> Any:
            if act != self.wire.close:
                return later(seconds, act, *given, **named)
            self.timers.append(Timer(seconds))
            return self.timers[-1]

        vars(loop)["call_later"] = call_later
        config = uvicorn.Config(hi, ws="none", lifespan="off", log_level="critical")
        config.load()
        self.protocol = PatientToAPoint(config, self.state, {})
        self.wire.set_protocol(self.protocol)
        self.protocol.connection_made(self.wire)

    @property
    def waits(self) -> list[float]:
        return [each.seconds for each in self.timers if each.is_waiting]

    async def hears(self, data: bytes) -> list[float]:
        """For how long it waits on what comes."""
        self.protocol.data_received(data)
        return self.waits

    async def answers(self, count: int) -> None:
        """Wait until so many answers are there."""
        while self.wire.written.count(b"hi") < count:
            await asyncio.sleep(0)


@asynccontextmanager
async def patience() -> AsyncIterator[Patience]:
    made = Patience()
    yield made
    made.protocol.connection_lost(None)
    assert made.waits == []
    assert made.state.connections == set()


GET = b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"
POST = b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n"


def test_a_head_has_twenty_seconds_from_its_connection_or_the_answer_before() -> None:
    async def talk() -> None:
        async with patience() as server:
            assert server.waits == [20.0]
            assert await server.hears(GET[:5]) == [20.0]
            assert len(server.timers) == 1  # not from the beginning: that would have no end
            assert await server.hears(GET[5:]) == []
            await server.answers(1)
            assert server.waits == [20.0]
            assert await server.hears(GET + GET[:5]) == []
            await server.answers(2)
            assert server.waits == [20.0]
            assert len(server.timers) == 3

    finished(talk())


def test_each_piece_of_a_body_has_two_minutes() -> None:
    async def talk() -> None:
        async with patience() as server:
            assert await server.hears(POST) == [120.0]
            before = len(server.timers)
            assert await server.hears(b"1234") == [120.0]
            assert len(server.timers) == before + 1
            assert await server.hears(b"56789") == []
            await server.answers(1)
            assert server.waits == [20.0]

    finished(talk())


def test_a_head_without_an_end_is_cut_off_and_each_request_is_counted_by_itself() -> None:
    async def talk() -> None:
        async with patience() as server:
            for number in (1, 2):
                start = b"GET / HTTP/1.1\r\nHost: x\r\nA: "
                await server.hears(start)
                await server.hears(b"a" * (65_536 - len(start)))
                assert not server.wire.closed
                assert await server.hears(b"\r\n\r\n") == []
                await server.answers(number)
            await server.hears(b"GET / HTTP/1.1\r\nA: ")
            await server.hears(b"a" * (65_536 - 19))
            assert not server.wire.closed
            await server.hears(b"a")
            assert server.wire.closed

    finished(talk())


def test_a_connection_that_ends_with_its_answer_is_not_waited_for() -> None:
    async def talk() -> None:
        async with patience() as server:
            await server.hears(GET.replace(b"Host: x", b"Connection: close"))
            await server.answers(1)
            assert server.wire.closed
            assert server.waits == []

    finished(talk())


def test_a_web_socket_may_be_silent() -> None:
    class Socket(asyncio.Protocol):
        def __init__(self, **_: object) -> None:
            super().__init__()

    async def talk() -> None:
        async with patience() as server:
            vars(server.protocol)["ws_protocol_class"] = Socket
            upgrade = b"Connection: Upgrade\r\nUpgrade: websocket"
            assert await server.hears(GET.replace(b"Host: x", upgrade)) == []
            assert isinstance(server.wire.get_protocol(), Socket)
            assert not server.wire.closed

    finished(talk())


def test_a_timer_that_ends_closes_the_connection() -> None:
    class Hasty(PatientToAPoint):
        head_s = 0.0

    async def talk() -> bool:
        wire = Wire()
        config = uvicorn.Config(hi, ws="none", lifespan="off", log_level="critical")
        config.load()
        Hasty(config, ServerState(), {}).connection_made(wire)
        while not wire.closed:
            await asyncio.sleep(0)
        return True

    assert finished(talk())
    assert (PatientToAPoint.head_s, PatientToAPoint.body_s) == (20.0, 120.0)
