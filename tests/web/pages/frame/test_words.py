"""Words, languages, times and names on the pages."""

from __future__ import annotations

import time
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta, timezone
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest
from starlette.requests import Request

from skisnow.web import language as web_language
from skisnow.web.language import (
    language_asked,
    language_of,
    language_of_request,
    minute_words,
    said,
    said_as_written,
    said_list,
)
from skisnow.web.page_addresses import plain_stem
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

from .shared import made

if TYPE_CHECKING:
    from nicegui import Client

    from ..desk import Desk


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


@pytest.mark.parametrize(
    ("chosen", "accepted", "code"),
    [
        (None, "", "en"),
        (None, "fr", "en"),
        (None, "DE-at;q=0.9", "de"),
        (None, "fr-CH, de-AT;q=0.9", "de"),
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
    assert said_list(listed, german).startswith("Last (N): 400 bis 1200, 4 Werte; Ski: Skis: 0,5")
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
