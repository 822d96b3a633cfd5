"""The table of the web lab, as Markdown."""

from __future__ import annotations

import os
import platform
import shutil
import statistics
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime

from . import opening, reacting
from .filled_lab import filled_lab
from .opening import Times

ABSENT = "no table of the web lab: it needs Chromium and Playwright (pip install playwright; Debian: chromium)"


def print_tables(readings: int, tries: int) -> None:
    """Serve a filled lab, drive it, print the table."""
    place = os.environ.get("SKISNOW_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError:
        print(ABSENT)
        return
    if place is None:
        print(ABSENT)
        return
    busy = os.getloadavg()[0]
    with filled_lab(readings, tries) as lab, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=place, args=["--no-sandbox"])
        print(
            f"{datetime.now(UTC):%Y-%m-%d}, Python {platform.python_version()}, Chromium {browser.version}, "
            f"{os.cpu_count()} cores, {platform.machine()}; {busy:.1f} processes were busy before\n"
        )
        print("| what | median | worst | of | goal |\n| --- | ---: | ---: | ---: | ---: |")
        for line in _lines(opening.opened(browser, lab, tries=tries), opening.GOAL_S):
            print(line, flush=True)
        for part in (reacting.entry_form, reacting.slider):
            for line in _lines(part(browser, lab), reacting.GOAL_S):
                print(line, flush=True)
        browser.close()


def _lines(found: Iterable[Times], goal_s: float) -> Iterator[str]:
    for each in found:
        middle, worst = statistics.median(each.seconds), max(each.seconds)
        yield f"| {each.what} | {_told(middle)} | {_told(worst)} | {len(each.seconds)} | {_told(goal_s)} |"


def _told(seconds: float) -> str:
    return f"{seconds:.2f} s" if seconds >= 1.0 else f"{seconds * 1e3:.0f} ms"
