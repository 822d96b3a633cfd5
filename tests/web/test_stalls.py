"""One side stands still, or the lab is killed, or the page is loaded again, while a hand types on: nothing is lost."""

import http.client
import json
import os
import signal
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest

from tests.key_names import SNOW_DENSITY

from .browser_types import Page
from .conftest import Served, entered, fill, has_text, ready
from .test_typing import begun, depths

if not hasattr(signal, "SIGSTOP"):
    pytest.skip("no process can be stopped here", allow_module_level=True)

STALL_S = 60.0
UNANSWERED = "Object.keys(localStorage).filter((key) => key.startsWith('skisnow.reading'))"


@contextmanager
def stopped(served: Served, seconds: float) -> Iterator[None]:
    """The lab's process stands still while a hand types, and then for the rest of these seconds."""
    assert served.process is not None and served.process.pid is not None
    os.kill(served.process.pid, signal.SIGSTOP)
    until = time.monotonic() + seconds
    try:
        yield
        time.sleep(max(0.0, until - time.monotonic()))
    finally:
        os.kill(served.process.pid, signal.SIGCONT)


def of_seconds(*normal: float) -> pytest.MarkDecorator:
    slow = [seconds for seconds in (2.0, 8.0, 20.0, STALL_S) if seconds not in normal]
    return pytest.mark.parametrize("seconds", [*normal, *(pytest.param(s, marks=pytest.mark.slow) for s in slow)])


def rows(served: Served, file: str, *columns: str) -> list[list[str]]:
    tests = entered(served).of_file(file)
    return [[row.cells[column] for column in columns] for test in tests for row in test.rows]


def opened(page: Page, served: Served, table: str = "") -> None:
    page.goto(begun(served) + table)
    page.get_by_label("Site", exact=True).and_(page.locator(":focus")).wait_for()
    ready(page)


def test_the_heartbeat_outlasts_a_stall(served: Served) -> None:
    """The server's message to a socket that opens: the browser gives it up after both together, in ms."""
    parts = urlsplit(served.address)
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=300)
    connection.request("GET", "/_nicegui_ws/socket.io/?EIO=4&transport=polling")
    said = json.loads(connection.getresponse().read().decode().removeprefix("0"))
    connection.close()
    assert said["pingTimeout"] > 1000 * STALL_S
    assert said["pingInterval"] <= 30_000  # or a connection that broke would not be noticed for long


@of_seconds(2.0)
def test_a_series_while_the_lab_stands_still(page: Page, served: Served, seconds: float) -> None:
    opened(page, served)
    page.keyboard.type("A\n30\n1.5\n")
    page.get_by_text("Stored: 1.5 mm under 20 N.").wait_for()
    page.evaluate("window.isSamePage = true")
    with stopped(served, seconds):
        page.keyboard.type("2.15\n2,6\n\n45\n1.9\n2.")
    page.keyboard.type("7\n3.3\n")
    page.get_by_text("Stored: 3.3 mm under 60 N.").wait_for()
    assert depths(served) == {"1": ["1.5", "2.15", "2.6"], "2": ["1.9", "2.7", "3.3"]}
    assert page.evaluate("window.isSamePage")
    page.wait_for_function(f"{UNANSWERED}.length === 0")


def test_all_rows_outlive_a_reload_and_a_kill(page: Page, served: Served) -> None:
    page.goto(f"{served.address}describe")
    fill(page, {"Name of the campaign": "one", "Disc loads (N), with blanks between": "20 40"})
    fill(page, {"Name of tool 1": "piece", "Length (mm) of tool 1": "200", "Width (mm) of tool 1": "62"})
    for name, length in (("round", "50"), ("third", "70")):
        page.get_by_role("button", name="Another tool").press("Enter")
        ready(page)
        page.keyboard.type(f"{name}\n{length}")
    page.get_by_label("Shape of tool 2", exact=True).click()
    page.get_by_role("option", name="disc", exact=True).click()
    fill(page, {"Diameter (mm) of tool 2": "30", "Width (mm) of tool 3": "40"})
    page.get_by_role("button", name="Another plate").press("Enter")
    ready(page)
    page.keyboard.type("second")
    page.reload()
    ready(page)
    page.locator("[aria-label='Name of plate 2']:focus").wait_for()
    with stopped(served, 0.0):
        page.get_by_role("button", name="Another plate").press("Enter")
        page.keyboard.type("thi")
        killed_while(page, served, "rd\n9")
    page.get_by_label("Name of plate 3", exact=True).wait_for()
    ready(page)
    fill(page, {f"Length (mm) of plate {number}": f"{number}00" for number in (2, 3)})
    page.get_by_role("button", name="Store and enter tests").press("Enter")
    page.get_by_role("heading", name="New series").wait_for()
    described = tomllib.loads(entered(served).description)
    assert [tuple(each.values()) for each in described["tool"]] == [
        ("piece", "ski", 200.0, 62.0),
        ("round", "disc", 30.0),
        ("third", "ski", 70.0, 40.0),
    ]
    plates = [tuple(each.values()) for each in described["plate"]]
    assert plates == [("plate", 100.0), ("second", 200.0), ("third", 300.0)]  # the first one was there


def killed_while(page: Page, served: Served, typed: str) -> None:
    """Kill the lab, type on, and start it again; the page comes back by itself."""
    page.evaluate("window.isSamePage = true")
    served.kill()
    page.locator("html.not-connected").wait_for()
    page.keyboard.type(typed)
    served.start()
    page.wait_for_function("!window.isSamePage")
    ready(page)


@pytest.mark.slow
def test_a_lab_that_is_killed_in_a_series(page: Page, served: Served) -> None:
    """Even before its first reading; what is typed meanwhile goes where it was typed."""
    opened(page, served)
    page.keyboard.type("A\n30\n1.")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    ready(page)
    killed_while(page, served, "5\n2.15\n2.")
    has_text(page.get_by_label("Depth under 60 N (mm)"), "2.")
    page.get_by_text("A · ski piece · 30°").wait_for()
    page.keyboard.type("6\n")
    page.get_by_text("Stored: 2.6 mm under 60 N.").wait_for()
    assert depths(served) == {"1": ["1.5", "2.15", "2.6"]}


def test_readings_that_nobody_answered_are_sent_again(page: Page, served: Served) -> None:
    """They are lost on their way when the lab, which stands still, is killed."""
    opened(page, served)
    page.keyboard.type("A\n30\n1.5\n")
    page.get_by_text("Stored: 1.5 mm under 20 N.").wait_for()
    page.wait_for_function(f"{UNANSWERED}.length === 0")  # the answer comes after the words
    with stopped(served, 0.0):
        page.keyboard.type("2.15\n2.6\n")
        page.wait_for_function(f"{UNANSWERED}.length === 2")
        killed_while(page, served, "")
    page.locator(".reading:nth-child(3) .stored", has_text="stored").wait_for()
    assert depths(served) == {"1": ["1.5", "2.15", "2.6"]}
    page.wait_for_function(f"{UNANSWERED}.length === 0")


def test_half_typed_text_outlives_a_reload_and_a_restart(page: Page, served: Served) -> None:
    opened(page, served, "?table=shear.csv")
    fill(page, {"Site": "B", "Depth (mm)": "6", "Moment (N m)": "30,"})
    page.reload()
    ready(page)
    for name, text in (("Site", "B"), ("Depth (mm)", "6"), ("Moment (N m)", "30,")):
        has_text(page.get_by_label(name, exact=True), text)
    page.goto(page.url.split("?")[0])
    ready(page)
    page.keyboard.type("A\n30\n1.5\n2.1")
    page.get_by_text("Stored: 1.5 mm under 20 N.").wait_for()
    served.again()
    page.get_by_label("Depth under 40 N (mm)").and_(page.locator(":focus:enabled")).wait_for()
    ready(page)
    page.keyboard.type("5\n")
    page.get_by_text("Stored: 2.15 mm under 40 N.").wait_for()
    assert depths(served) == {"1": ["1.5", "2.15"]}


@pytest.mark.parametrize("was_stored", [pytest.param(False, marks=pytest.mark.slow), True])
def test_a_test_sent_when_the_lab_was_killed_is_stored_once(page: Page, served: Served, was_stored: bool) -> None:
    """The answer does not come; Enter is pressed again by the page, and later text follows it."""
    opened(page, served, "?table=density.csv")
    page.keyboard.type("A\n310")
    ready(page)
    if was_stored:
        page.evaluate("['update', 'run_javascript'].forEach((message) => socket.off(message))")
        page.keyboard.type("\n320\n")
        while not rows(served, "density.csv", "sample"):
            page.wait_for_timeout(50)
        killed_while(page, served, "33")
    else:
        with stopped(served, 0.0):
            page.keyboard.type("\n320\n")
            page.locator("html.holding").wait_for()
            killed_while(page, served, "33")
    page.get_by_text("Stored: test 2.").wait_for()
    ready(page)
    has_text(page.get_by_label("Density (kg/m³)"), "33")
    assert rows(served, "density.csv", "sample", SNOW_DENSITY) == [["1", "310"], ["2", "320"]]
