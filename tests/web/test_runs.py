"""Simulations in the queue survive the server, and give what the command line gives."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from skisnow.web.runs import Runs

from .conftest import Served

if TYPE_CHECKING:
    from playwright.sync_api import Page

LONG_MS = 300_000  # compiling on a machine's first run, then seconds


def test_jobs_are_kept_in_their_order_and_cancelled_before_they_begin(tmp_path: Path) -> None:
    runs = Runs(tmp_path)
    first, second = runs.ask("carved-46m", {"run.duration_s": "1"}), runs.ask("../up", {})
    assert [job.name for job in Runs(tmp_path).jobs()] == [second.name, first.name]
    assert (tmp_path / second.name).parent == tmp_path
    runs.cancel(first.name)
    assert [job.state for job in Runs(tmp_path).jobs()] == ["waiting", "cancelled"]


def test_a_run_that_the_server_was_killed_in_is_begun_again(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    page.get_by_text("Run", exact=True).click()
    page.get_by_label("run.duration_s", exact=True).fill("0.2")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("is in the queue.").wait_for()
    page.get_by_text("running").first.wait_for()
    page.goto("about:blank")
    served.again()
    page.goto(f"{served.address}simulate")
    page.get_by_text("finished: ").wait_for(timeout=LONG_MS)
    page.get_by_role("link", name="Watch").wait_for()
    (place,) = (served.store.parent / "lab").glob("*/summary.json")
    summary = json.loads(place.read_text(encoding="utf-8"))
    assert summary["outcome"] == "finished"
    assert summary["scenario"]["run"]["duration_s"] == 0.2


def test_a_value_that_cannot_be_is_refused_in_words(page: Page, served: Served) -> None:
    page.goto(f"{served.address}simulate")
    page.get_by_text("Sledge", exact=True).click()
    page.get_by_label("sledge.mass_kg", exact=True).fill("-5")
    page.get_by_role("button", name="Simulate").click()
    page.get_by_text("Not begun: ").wait_for()
    page.get_by_text("Nothing was simulated yet.").wait_for()
