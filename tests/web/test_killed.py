"""The server is killed at any moment of entering: what was shown as stored is in the store, and nothing half.

The browser types a series as fast as it can; the server gets SIGKILL after a random delay. Then the page, which is
still on the screen, is compared with the store's file.
"""

from __future__ import annotations

import threading
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from skisnow.campaign.store import Journals, Store, replay_journal

from .conftest import Served, fill
from .test_day import create

if TYPE_CHECKING:
    from playwright.sync_api import Page

LOADS = (20, 40, 60, 80)
UNANSWERED = """() => Object.fromEntries(Object.entries(localStorage)
    .filter(([key]) => key.startsWith('skisnow.reading'))
    .map(([, text]) => JSON.parse(text).cells).map((cells) => [cells.load_N, cells.depth_mm]))"""
LONGEST_S = 0.6  # a series takes about as long to type


def shown_as_stored(page: Page) -> dict[str, str]:
    """Depth by load, of the readings that the page calls stored."""
    rows: list[list[str]] = page.evaluate(
        """() => [...document.querySelectorAll('.reading')].map(row => [row.querySelector('.load').innerText,
             row.querySelector('input').value, row.querySelector('.stored').innerText])"""
    )
    return {load.removesuffix(" N"): depth for load, depth, stored in rows if stored == "stored"}


def in_the_store(place: Path, test: str) -> dict[str, str]:
    with Store.open(place) as store:
        assert store.verify() == ()
        (head,) = Journals(store).list()
        rows = replay_journal(Journals(store).entries(head.id)).test("penetration.csv", test).rows
    return {row.cells["load_N"]: row.cells["depth_mm"] for row in rows}


def killed_while_entering(page: Page, served: Served, test: str, delay_s: float) -> tuple[int, int]:
    """How many readings were shown as stored, and how many will be in the store: the browser sends again the others."""
    fill(page, {"Name of the test": test, "Site": "A", "Edge angle (°)": "30"})
    page.keyboard.press("Enter")
    page.get_by_label("Depth under 20 N (mm)").and_(page.locator(":focus")).wait_for()
    assert served.process is not None
    timer = threading.Timer(delay_s, served.process.kill)
    timer.start()
    for number in range(len(LOADS)):
        page.keyboard.type(f"{number + 1}.{test}")
        page.keyboard.press("Enter")
    timer.join()
    served.wait()
    shown, kept = shown_as_stored(page), in_the_store(served.store, test)
    assert shown.items() <= kept.items()
    wanted = {str(load): f"{number + 1}.{test}" for number, load in enumerate(LOADS)}
    unanswered: dict[str, str] = page.evaluate(UNANSWERED)
    assert kept.items() | unanswered.items() <= wanted.items()
    return len(shown), len(kept | unanswered)


@pytest.mark.slow
@pytest.mark.parametrize("trials", [pytest.param(4, id="a few times"), pytest.param(50, id="fifty times")])
def test_nothing_that_was_shown_as_stored_is_lost(trials: int, page: Page, served: Served) -> None:
    create(page, served)
    place = page.url.split("?")[0]
    delays = np.random.default_rng(1).uniform(0.0, LONGEST_S, trials)
    counts = []
    for trial, delay_s in enumerate(delays.tolist(), start=1):
        counts.append(killed_while_entering(page, served, str(trial), delay_s))
        page.goto("about:blank")  # else the page would come back by itself, at the same time
        served.again()
        page.goto(place)
        page.get_by_role("heading", name="New series").wait_for()
        page.wait_for_function(f"Object.keys(({UNANSWERED})()).length === 0")
    with Store.open(served.store) as store:
        (head,) = Journals(store).list()
        tests = replay_journal(Journals(store).entries(head.id)).of_file("penetration.csv")
    assert sum(len(test.rows) for test in tests) == sum(kept for _, kept in counts)
    if trials == 50:  # the moments of death were spread over the entering
        assert len({shown for shown, _ in counts}) >= 3
